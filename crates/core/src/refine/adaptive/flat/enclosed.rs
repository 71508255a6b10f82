//! Whether the rim of a flat region encloses an area that can approximate its surface, also where the surface folds.
//!
//! The limit curves of its rim are looked at, each divided into as many chords whatever else is asked for: so it is the same surface at
//! each tolerance, and for those who measure against it.

use std::collections::HashMap;

use super::super::chains::first_of;
use super::super::control::Control;
use super::super::surface::Surface;
use super::flattened::Flattened;
use super::merge::SAME_AREA;
use super::regions::FlatRegions;
use crate::node::along_edge;
use crate::parallel::{IsStopped, asking};
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, unit_or_zero, vector};

impl FlatRegions {
    /// By region, whether the limit curves around it, none of which is smooth and which do not cross then, enclose all of its vertices, and
    /// nothing twice. What is off a straight line by less than `rounding` is none.
    pub(super) fn enclosed(
        &self,
        control: &Control<'_>,
        rounding: f64,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<bool>, Cancelled> {
        let found = watch.long_pieces(self.regions.len(), 16, |block, is_stopped| {
            let is_enclosed = |region| {
                self.encloses(control, region as u32, rounding, is_stopped)
                    .is_some()
            };
            block.map(is_enclosed).collect::<Vec<_>>()
        })?;
        Ok(found.concat())
    }

    /// How often curves of so many edges are divided for that.
    pub(super) fn divisions(rim: usize) -> u32 {
        // Curves are divided four times at most, and into 65,536 chords all together, about.
        ((1 << 16) / rim.max(1)).max(1).ilog2().min(4)
    }

    fn encloses(
        &self,
        control: &Control<'_>,
        region: u32,
        rounding: f64,
        is_stopped: &IsStopped<'_>,
    ) -> Option<()> {
        let (faces, plane) = &self.regions[region as usize];
        // Where the surface goes on smoothly it may be the folded triangles that are near to what lies beyond.
        if self.has_smooth_rim(control, region) {
            return None;
        }
        let rim: Vec<u32> = asking(self.rim(control, region), is_stopped).collect();
        let levels = Self::divisions(rim.len());
        let (mut numbers, mut positions) = (HashMap::with_capacity(faces.len()), Vec::new());
        let corners = faces
            .iter()
            .flat_map(|&face| &control.mesh.triangles()[face as usize]);
        for &vertex in asking(corners, is_stopped) {
            numbers.entry(vertex).or_insert_with(|| {
                positions.push(control.positions[vertex as usize]);
                positions.len() as u32 - 1
            });
        }
        let (mut curves, mut chords) = (HashMap::new(), Vec::new());
        for h in rim {
            if is_stopped() {
                return None;
            }
            let (face, edge) = (h / 3, h as usize % 3);
            // Both sides of a slit have the same points.
            let is_known = curves.contains_key(&first_of(&control.edges, h));
            let curve: &mut Vec<u32> = curves.entry(first_of(&control.edges, h)).or_default();
            if is_known {
                curve.reverse();
            } else {
                let points = curve_over(control, h, levels, rounding);
                let first = positions.len() as u32;
                positions.extend(points.iter().map(DVec3::to_array));
                curve.extend(first..positions.len() as u32);
            }
            let corners = control.mesh.triangles()[face as usize];
            let [from, to] = [edge, (edge + 1) % 3].map(|corner| numbers[&corners[corner]]);
            let ends = curve.iter().copied().chain([to]);
            let starts = [from].into_iter().chain(curve.iter().copied());
            chords.extend(starts.zip(ends).map(<[u32; 2]>::from));
        }
        let mut flat = Flattened::new(plane, self.off_planes, &positions);
        for vertex in asking(0..positions.len() as u32, is_stopped) {
            flat.number(vertex);
            // None is off the plane.
            flat.area([vertex; 3])?;
        }
        let (_, found) = flat.triangulated(&chords, is_stopped)?;
        let expected = chords.iter().try_fold(0.0, |sum, &[from, to]| {
            Some(sum + flat.area([0, from, to])?)
        })?;
        ((found - expected).abs() <= SAME_AREA * expected.abs()).then_some(())
    }
}

/// Points inside the curve over a half-edge, in order, so many times divided; none where it is straight.
fn curve_over(control: &Control<'_>, h: u32, levels: u32, rounding: f64) -> Vec<DVec3> {
    let mut points = Vec::new();
    let triangle = control.mesh.triangles()[h as usize / 3];
    let ends = [0, 1].map(|end| triangle[(h as usize + end) % 3] as usize);
    // Corners stay, and elsewhere the two adjacent vertices are on one line, equally far on either side.
    if ends
        .iter()
        .all(|&end| control.positions[end] == control.mesh.positions()[end])
    {
        return points;
    }
    let (piece, edge) = (control.piece(h / 3), h as usize % 3);
    // Two vertices beyond the edge's ends have a say: not both can be off the line where three points are on it.
    along(piece.surface(control.rules), edge, 2, &mut points);
    let [from, to] = ends.map(|end| vector(control.positions[end]));
    let direction = unit_or_zero(to - from);
    let is_straight = points
        .iter()
        .all(|&point| direction.cross(point - from).length() <= rounding);
    points.clear();
    if !is_straight {
        along(piece.surface(control.rules), edge, levels, &mut points);
    }
    points
}

/// Points inside the curve over an edge, in order.
fn along(surface: Surface<'_>, edge: usize, levels: u32, points: &mut Vec<DVec3>) {
    if levels == 0 {
        return;
    }
    let middle = surface.middles()[edge].position;
    along(
        surface.child(along_edge(edge, false)),
        edge,
        levels - 1,
        points,
    );
    points.push(middle);
    along(
        surface.child(along_edge(edge, true)),
        edge,
        levels - 1,
        points,
    );
}
