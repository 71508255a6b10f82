//! Whether edges of 30° to 52° are those between the facets of something round, as on a peg of eight, or edges that are meant, as where a
//! roof lies on a wall.
//!
//! Facets of round things come in rows: a facet meets the next at about the angle at which it meets the one before, on the same side, and
//! all are about as large. A chamfer is narrower than the faces that it is between, and a roof meets one wall only.

use std::ops::RangeInclusive;

use super::look::Bends;
use crate::geometry::DisjointSets;
use crate::mesh::Mesh;

/// Edges between faces in one plane, to rounding, in degrees.
const FLAT: f64 = 1.0;

/// Facets of one row meet at the same angle to this part of it, and none is so many times as large as the next.
const SAME_ANGLE: f64 = 0.2;
const SAME_AREA: f64 = 2.5;

/// Where the length of edges between finer facets is this part (one in so many) of that of coarse ones, there are finer facets.
const FINER: f64 = 4.0;

/// An edge between two plane faces, seen from one of them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    face: u32,
    is_concave: bool,
    /// Whole degrees.
    degrees: u32,
    other: u32,
}

/// Whether most of the length of edges whose degrees are within some `degrees` is between facets of round things. Where other facets
/// are finer, those were meant to be seen.
pub(super) fn are_of_round_things(mesh: &Mesh, bends: &[Bends], degrees: RangeInclusive<usize>) -> bool {
    let mut planes = DisjointSets::new(mesh.face_count());
    let faces = |bend: &Bends| [bend.edge, bend.twin].map(|h| h.face().0);
    bends.iter().filter(|bend| bend.degrees < FLAT).for_each(|bend| {
        let [a, b] = faces(bend);
        planes.unite(a, b);
    });
    let planes = planes.into_roots();
    let mut areas = vec![0.0; mesh.face_count()];
    planes.iter().enumerate().for_each(|(face, &root)| {
        areas[root as usize] += mesh.face_normal_vector(face).length();
    });
    let is_as_large = |a: u32, b: u32| {
        let [a, b] = [a, b].map(|plane| areas[plane as usize]);
        a <= SAME_AREA * b && b <= SAME_AREA * a
    };
    let doubtful: Vec<&Bends> =
        bends.iter().filter(|bend| degrees.contains(&(bend.degrees as usize))).collect();
    let side = |bend: &Bends, [face, other]: [u32; 2]| {
        let [face, other] = [face, other].map(|face| planes[face as usize]);
        Side { face, is_concave: bend.is_concave, degrees: bend.degrees as u32, other }
    };
    let sides = |bend: &Bends| {
        let [a, b] = faces(bend);
        [side(bend, [a, b]), side(bend, [b, a])]
    };
    let mut rows: Vec<Side> = doubtful.iter().flat_map(|bend| sides(bend)).collect();
    rows.retain(|side| is_as_large(side.face, side.other));
    rows.sort_unstable();
    rows.dedup();
    let goes_on = |side: Side| {
        let off = (SAME_ANGLE * f64::from(side.degrees)).round() as u32;
        let first = rows.partition_point(|one| {
            *one < Side { degrees: side.degrees.saturating_sub(off), other: 0, ..side }
        });
        let same = |one: &&Side| {
            (one.face, one.is_concave) == (side.face, side.is_concave) && one.degrees <= side.degrees + off
        };
        rows[first..].iter().take_while(same).any(|one| one.other != side.other)
    };
    let is_of_row = |bend: &Bends| {
        let [a, b] = sides(bend);
        is_as_large(a.face, a.other) && (goes_on(a) && goes_on(b))
    };
    let mut is_coarse = vec![false; mesh.face_count()];
    let all_planes = |bend: &Bends| faces(bend).map(|face| planes[face as usize] as usize);
    doubtful.iter().flat_map(|bend| all_planes(bend)).for_each(|plane| is_coarse[plane] = true);
    let is_finer = |bend: &&Bends| {
        (FLAT..*degrees.start() as f64).contains(&bend.degrees)
            && !all_planes(bend).iter().any(|&plane| is_coarse[plane])
    };
    let length = |bends: &mut dyn Iterator<Item = &Bends>| bends.map(|bend| bend.length).sum::<f64>();
    let coarse = length(&mut doubtful.iter().copied());
    let of_rows = length(&mut doubtful.iter().copied().filter(|bend| is_of_row(bend)));
    2.0 * of_rows > coarse && FINER * length(&mut bends.iter().filter(is_finer)) < coarse
}
