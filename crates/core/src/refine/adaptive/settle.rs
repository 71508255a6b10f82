//! The leaves that pass on conditions, with their neighbours as they are emitted.
//!
//! Most triangles pass whatever is beside them ([`super::judge`]). What is left counted on neighbours like itself; here the
//! angles between the emitted triangles say whether that was right.

use std::collections::HashSet;

use super::emit::Emission;
use super::judge::{Condition, Goal};
use super::quadtree::Place;
use crate::certificate::{STEEP, around};
use crate::mesh::NONE;
use crate::parallel;
use crate::vector::vector;

/// Leaves that one call takes together.
const BLOCK: usize = 1024;

/// The leaves whose conditions do not hold, and what they come to. Where all of a control face do, `settled` gets the greatest bound of one, and the
/// leaf; faces that have it already are passed over.
pub(super) fn settle(
    emission: &Emission,
    goal: &Goal,
    settled: &mut [Option<(f64, Place)>],
) -> Vec<(Place, f64)> {
    let sharp = sharp_edges(emission);
    let conditions =
        emission.conditions.iter().filter(|(condition, ..)| settled[condition.place.face as usize].is_none());
    let conditions: Vec<&(Condition, u32, u32)> = conditions.collect();
    let found = parallel::pieces_of(conditions.len(), BLOCK, |block| {
        let bounds = conditions[block].iter().map(|(condition, first, last)| {
            let (mut squared, mut slope) = (0.0f64, STEEP);
            for triangle in *first..*last {
                let (turn, room) = beside(emission, &sharp, triangle);
                squared = squared.max(turn);
                slope = slope.min(room);
            }
            let bound = condition.deviation.bound(squared.sqrt(), slope);
            (bound, bound <= goal.allowed(condition.place.face), condition.place)
        });
        bounds.collect::<Vec<_>>()
    });
    let (mut failing, mut failed) = (Vec::new(), HashSet::new());
    for (bound, holds, place) in found.into_iter().flatten() {
        let known = &mut settled[place.face as usize];
        if !holds {
            failing.push((place, bound));
            failed.insert(place.face);
        } else if known.is_none_or(|(known, _)| bound > known) {
            *known = Some((bound, place));
        }
    }
    failed.into_iter().for_each(|face| settled[face as usize] = None);
    failing
}

/// The half-edges along sharp edges.
pub(super) fn sharp_edges(emission: &Emission) -> HashSet<u32> {
    emission.sharp.iter().flat_map(|(h, _)| emission.borders.along(*h).iter().copied()).collect()
}

/// [`around`] of an emitted triangle. Sharp edges have nobody beyond.
pub(super) fn beside(emission: &Emission, sharp: &HashSet<u32>, triangle: u32) -> (f64, f64) {
    let at = |vertex: u32| vector(emission.positions[vertex as usize]);
    let opposite = [0, 1, 2].map(|edge| {
        let h = 3 * triangle + edge;
        let twin = emission.twins[h as usize];
        let is_open = twin == NONE || !sharp.is_empty() && sharp.contains(&h);
        (!is_open).then(|| at(emission.triangles[twin as usize / 3][(twin as usize + 2) % 3]))
    });
    around(emission.triangles[triangle as usize].map(at), &opposite)
}
