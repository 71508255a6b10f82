//! How far a point is from the emitted mesh: from the nearest of its triangles, which are looked for by boxes.

use std::sync::OnceLock;

use super::super::emitted::Sources;
use crate::geometry::box_tree::{Bounds, NO_BOUNDS, distance_squared_to, grown};
use crate::geometry::nearer;
use crate::parallel::IsStopped;
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, vector};

/// Control faces whose boxes are looked at together: those with consecutive numbers are often near each other.
const GROUP: usize = 64;

/// The nearest points of the emitted triangles.
pub(super) struct Nearest<'a> {
    sources: Sources<'a>,
    /// Boxes that hold the surface over [`GROUP`] control faces, and so the corners of their triangles.
    groups: Vec<Bounds>,
    /// Those over each of them.
    boxes: Vec<OnceLock<Box<[Bounds]>>>,
}

impl<'a> Nearest<'a> {
    pub(super) fn of(sources: Sources<'a>, watch: &SharedWatch<'_>) -> Result<Self, Cancelled> {
        let faces = sources.covers.len();
        let joined = |a: Bounds, [low, high]: Bounds| grown(grown(a, low), high);
        // Where control faces have 16 triangles in the mean, their boxes are kept as they are found first; others are found anew where points
        // come near.
        let is_kept = sources.emission.triangles.len() >= 16 * faces;
        let found = watch.pieces(faces, GROUP, |group| {
            let boxes = group.map(|face| bounds(&sources, face as u32));
            if is_kept {
                let boxes: Box<[Bounds]> = boxes.collect();
                return (
                    boxes.iter().copied().fold(NO_BOUNDS, joined),
                    OnceLock::from(boxes),
                );
            }
            (boxes.fold(NO_BOUNDS, joined), OnceLock::new())
        })?;
        let (groups, boxes) = found.into_iter().unzip();
        Ok(Self {
            sources,
            groups,
            boxes,
        })
    }

    /// The distance of a point to the mesh, or more where it is no longer needed; `face` is likely to be nearest.
    pub(super) fn distance(&self, point: DVec3, face: u32, is_stopped: &IsStopped<'_>) -> f64 {
        let mut least = f64::INFINITY;
        self.within(face, point, &mut least, is_stopped);
        for (group, bounds) in self.groups.iter().enumerate() {
            if group.is_multiple_of(1 << 8) && is_stopped() {
                break;
            }
            if distance_squared_to(bounds, point) < least {
                for (other, bounds) in (GROUP as u32 * group as u32..).zip(self.boxes_of(group)) {
                    if distance_squared_to(bounds, point) < least && other != face {
                        self.within(other, point, &mut least, is_stopped);
                    }
                }
            }
        }
        least.sqrt()
    }

    /// The boxes over the control faces of a group.
    fn boxes_of(&self, group: usize) -> &[Bounds] {
        self.boxes[group].get_or_init(|| {
            let faces = (GROUP * group..self.sources.covers.len()).take(GROUP);
            faces
                .map(|face| bounds(&self.sources, face as u32))
                .collect()
        })
    }

    /// Lowers the square of a distance to that to the triangles of a control face.
    fn within(&self, face: u32, point: DVec3, least: &mut f64, is_stopped: &IsStopped<'_>) {
        let emission = self.sources.emission;
        for (i, triangle) in (1u32..).zip(&emission.triangles[emission.triangles_of(face)]) {
            if i.is_multiple_of(1 << 14) && is_stopped() {
                return;
            }
            let corners =
                triangle.map(|vertex| vector(emission.positions[vertex as usize]) - point);
            *least = nearer(*least, corners);
        }
    }
}

/// A box that holds the corners of the triangles of a control face.
fn bounds(sources: &Sources<'_>, face: u32) -> Bounds {
    let positions = &sources.emission.positions;
    let corners = sources.control.mesh.triangles()[face as usize];
    let bounds = corners
        .into_iter()
        .map(|vertex| vector(positions[vertex as usize]))
        .fold(NO_BOUNDS, grown);
    let runs = (3 * face..3 * face + 3).map(|h| sources.chains.vertices(&sources.control.edges, h));
    let runs = runs.chain([sources.emission.vertices_inside(face)]);
    runs.fold(bounds, |bounds, run| {
        positions[run]
            .iter()
            .map(|&point| vector(point))
            .fold(bounds, grown)
    })
}
