//! Whether what is around a flat region encloses something that can stand for its surface where that folds.
//!
//! The limit curves of its rim are looked at, each divided into as many chords whatever else is asked for: so it is the same surface at
//! each tolerance, and for those who measure against it.

use std::collections::HashMap;

use super::super::chains::first_of;
use super::super::control::Control;
use super::super::quadtree::Edges;
use super::super::surface::Surface;
use super::FlatRegions;
use super::flattened::Flattened;
use super::merge::SAME_AREA;
use crate::node::along_edge;
use crate::parallel::IsStopped;
use crate::vector::DVec3;

/// Curves are divided so many times at most, and into so many chords all together, about.
const MOST_DIVISIONS: u32 = 6;
const MOST_CHORDS: usize = 1 << 16;

impl FlatRegions {
    /// Whether the limit curves around a region, none of which is smooth and which do not cross then, enclose all of its vertices, and nothing twice.
    pub(super) fn is_enclosed(
        &self,
        mesh: (&Control<'_>, &Edges<'_>),
        region: u32,
        is_stopped: &IsStopped<'_>,
    ) -> bool {
        let find = || self.enclosed(mesh, region, is_stopped).is_some();
        *self.enclosed[region as usize].get_or_init(find)
    }

    /// How often curves of so many edges are divided for that.
    pub(super) fn divisions(rim: usize) -> u32 {
        (MOST_CHORDS / rim.max(1)).max(1).ilog2().min(MOST_DIVISIONS)
    }

    fn enclosed(
        &self,
        (control, edges): (&Control<'_>, &Edges<'_>),
        region: u32,
        is_stopped: &IsStopped<'_>,
    ) -> Option<()> {
        let (faces, plane) = &self.regions[region as usize];
        // Where the surface goes on smoothly it may be the folded triangles that are near to what lies beyond.
        if self.has_smooth_rim((control, edges), region) {
            return None;
        }
        let rim: Vec<u32> = self.rim((control, edges), region).collect();
        let levels = Self::divisions(rim.len());
        let (mut numbers, mut positions) = (HashMap::new(), Vec::new());
        for &vertex in faces.iter().flat_map(|&face| &control.mesh.triangles()[face as usize]) {
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
            let is_known = curves.contains_key(&first_of(edges, h));
            let curve: &mut Vec<u32> = curves.entry(first_of(edges, h)).or_default();
            if is_known {
                curve.reverse();
            } else {
                let mut points = Vec::new();
                along(control.piece(face).surface(control.rules), edge, levels, &mut points);
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
        for vertex in 0..positions.len() as u32 {
            flat.number(vertex);
            // None is off the plane.
            flat.area([vertex; 3])?;
        }
        let (_, found) = flat.triangulated(&chords, is_stopped)?;
        let expected =
            chords.iter().try_fold(0.0, |sum, &[from, to]| Some(sum + flat.area([0, from, to])?))?;
        ((found - expected).abs() <= SAME_AREA * expected.abs()).then_some(())
    }
}

/// Points inside the curve over an edge, in order.
fn along(surface: Surface<'_>, edge: usize, levels: u32, points: &mut Vec<DVec3>) {
    if levels == 0 {
        return;
    }
    let middle = surface.middles()[edge].position;
    along(surface.child(along_edge(edge, false)), edge, levels - 1, points);
    points.push(middle);
    along(surface.child(along_edge(edge, true)), edge, levels - 1, points);
}
