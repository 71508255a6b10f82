//! Hits of two pieces on their common edge are merged to one.

use super::Crossing;
use super::search::Found;

/// Weights that differ by no more are those of one place, and corners with no more weight than this count for none.
const SAME: f64 = 1e-6;

/// Sorts the hits along the ray and merges those at one place. Depths up to `tolerance` apart may
/// be one.
pub(super) fn merged(mut found: Vec<Found>, triangles: &[[u32; 3]], tolerance: f64) -> Vec<Found> {
    found.sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.face.cmp(&b.face)));
    let mut kept: Vec<Found> = Vec::with_capacity(found.len());
    // The last of the merged hits counts on: a grazed region is a chain of pieces.
    let mut last: Vec<Found> = Vec::with_capacity(found.len());
    for one in found {
        let near = last
            .iter()
            .rposition(|other| is_one(other, &one, triangles, tolerance));
        match near {
            Some(at) => last[at] = one,
            None => {
                kept.push(one);
                last.push(one);
            }
        }
    }
    kept
}

fn is_one(a: &Found, b: &Found, triangles: &[[u32; 3]], tolerance: f64) -> bool {
    // Pieces that are grazed are up to ten times as large as the tolerance.
    let reach = if a.crossing == Crossing::Grazing {
        20.0 * tolerance
    } else {
        tolerance
    };
    a.crossing == b.crossing
        && b.depth - a.depth <= reach
        && (a.crossing == Crossing::Grazing || is_adjacent(a, b, triangles))
}

/// Whether two places in one face, or in two that share a vertex, are the same.
fn is_adjacent(a: &Found, b: &Found, triangles: &[[u32; 3]]) -> bool {
    if a.face == b.face {
        return (0..3).all(|corner| (a.weights[corner] - b.weights[corner]).abs() <= SAME);
    }
    let [own, other] = [a, b].map(|found| triangles[found.face as usize]);
    // The weight of each of one's corners is that of the same vertex in the other.
    let is_same = |own: &[u32; 3], weights: &[f64; 3], other: &[u32; 3], others: &[f64; 3]| {
        own.iter().zip(weights).all(|(vertex, weight)| {
            let there = other
                .iter()
                .position(|v| v == vertex)
                .map_or(0.0, |at| others[at]);
            (weight - there).abs() <= SAME
        })
    };
    is_same(&own, &a.weights, &other, &b.weights) && is_same(&other, &b.weights, &own, &a.weights)
}
