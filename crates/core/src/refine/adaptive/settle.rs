//! The leaves that pass on conditions, with their neighbours as they are emitted.
//!
//! Most triangles pass whatever is beside them ([`super::judge`]). What is left counted on neighbours like itself; here the
//! angles between the emitted triangles say whether that was right.

use std::collections::HashSet;

use super::emit::Emission;
use super::judge::{Condition, Goal};
use super::quadtree::Place;
use crate::mesh::NONE;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// A slope beyond all that can be met.
const STEEP: f64 = f64::MAX;

/// The squared chord and the slope next to a triangle without a plane: they leave only the bound that needs no
/// neighbours.
const UNSETTLED: (f64, f64) = (4.0, 0.0);

/// Leaves that one call takes together.
const BLOCK: usize = 1024;

/// The leaves whose conditions do not hold, and what they come to. Where all of a control face do, `settled` gets the greatest bound of one, and the
/// leaf; faces that have it already are passed over.
pub(super) fn settle(
    emission: &Emission,
    goal: &Goal,
    settled: &mut [Option<(f64, Place)>],
) -> Vec<(Place, f64)> {
    let mut sharp = HashSet::new();
    for (h, _) in &emission.sharp {
        sharp.extend(emission.borders.along(*h).iter().copied());
    }
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

/// [`around`] of an emitted triangle. Sharp edges have nobody beyond.
fn beside(emission: &Emission, sharp: &HashSet<u32>, triangle: u32) -> (f64, f64) {
    let at = |vertex: u32| vector(emission.positions[vertex as usize]);
    let opposite = [0, 1, 2].map(|edge| {
        let h = 3 * triangle + edge;
        let twin = emission.twins[h as usize];
        let is_open = twin == NONE || !sharp.is_empty() && sharp.contains(&h);
        (!is_open).then(|| at(emission.triangles[twin as usize / 3][(twin as usize + 2) % 3]))
    });
    around(emission.triangles[triangle as usize].map(at), &opposite)
}

/// The greatest squared chord of the angles between the planes of a triangle and its neighbours, given by their corners
/// opposite, and the greatest slope at which points may drift over them.
fn around(own: [DVec3; 3], opposite: &[Option<DVec3>; 3]) -> (f64, f64) {
    let edges = [own[1] - own[0], own[2] - own[1], own[0] - own[2]];
    let Some((normal, area)) = plane(edges[0], edges[1]) else { return UNSETTLED };
    let lengths = edges.map(DVec3::length);
    // Half of what the angle at a corner leaves of π, at most π/2: its tangent is the cotangent of half the angle.
    let free = [0, 1, 2].map(|corner| {
        let before = (corner + 2) % 3;
        (lengths[corner] * lengths[before] - edges[corner].dot(edges[before])) / area
    });
    let (mut squared, mut slope) = (0.0f64, STEEP);
    for edge in 0..3 {
        let Some(opposite) = opposite[edge] else { continue };
        let out = opposite - own[edge];
        // The neighbour runs along the edge the other way.
        let Some((other, area)) = plane(out, edges[edge]) else { return UNSETTLED };
        squared = squared.max(normal.distance_squared(other));
        // Tangents of the neighbour's angles at both ends: the lesser is that of the greater product.
        let at_start = out.dot(edges[edge]);
        let product = at_start.max(lengths[edge] * lengths[edge] - at_start);
        slope = slope.min(free[edge]).min(free[(edge + 1) % 3]).min(area / product);
    }
    (squared, slope)
}

/// The unit vector at right angles to two edges, and the area of their parallelogram; `None` if that is nothing, or
/// so small or great that rounding decides it.
fn plane(a: DVec3, b: DVec3) -> Option<(DVec3, f64)> {
    let across = a.cross(b);
    let squared = across.length_squared();
    let area = squared.sqrt();
    (1e-290..1e290).contains(&squared).then(|| (across / area, area))
}
