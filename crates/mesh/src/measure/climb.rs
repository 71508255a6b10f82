//! A greater maximum near the farthest samples.
//!
//! Samples meet the point of greatest distance only by chance. Around the farthest ones it is searched for: in the
//! triangle of each, a lattice of points is measured, the triangle shrunk by half about the best of them, and so on
//! until the lattice is about a thousandth of the triangle. Every value is that of a point of the surface, so that the
//! result remains a lower bound, only a better one.

use super::bvh::Bvh;
use super::samples::Samples;
use crate::parallel;
use crate::progress::{Cancelled, Watch};
use crate::vector::DVec3;

/// Triangles in which a first lattice is measured, and the best of them that are searched further: as many as make
/// the search a small part of the work for usual numbers of samples.
const SCREENED: usize = 2048;
const SEARCHED: usize = 256;

/// The lattice has this many steps along a side: 15 points, among them corners and middles of the sides.
const STEPS: u32 = 4;

/// Halvings: the last lattice's step is 1 / (4 · 2^8) of a side.
const ROUNDS: usize = 8;

/// A triangle being searched: where it has been shrunk to, and the best point so far.
#[derive(Clone, Copy)]
struct Candidate {
    corners: [DVec3; 3],
    best: DVec3,
    distance: f64,
}

/// The farthest point found around the samples of `from`, whose `distances` to `to` are given;
/// `None` if there are no samples but the vertices.
pub(super) fn climb(
    samples: &Samples<'_, '_>,
    distances: &[f64],
    from: &Bvh<'_>,
    to: &Bvh<'_>,
    watch: &mut Watch<'_>,
) -> Result<Option<(DVec3, f64)>, Cancelled> {
    let mut candidates: Vec<Candidate> = farthest_triangles(samples, distances)
        .into_iter()
        .map(|slot| {
            let corners = from.corners(slot);
            Candidate {
                corners,
                best: corners[0],
                distance: f64::NEG_INFINITY,
            }
        })
        .collect();
    let lattice = lattice();
    for _ in 0..ROUNDS {
        let points: Vec<DVec3> = candidates
            .iter()
            .flat_map(|candidate| {
                let [a, b, c] = candidate.corners;
                lattice
                    .iter()
                    .map(move |[u, v, w]| a * *u + b * *v + c * *w)
            })
            .collect();
        // Each triangle is measured alone: the next one may be far away.
        let mut distances = vec![0.0; points.len()];
        let poll = &mut |_| watch.poll();
        parallel::for_each_chunk_polled(&mut distances, lattice.len(), poll, |i, distances| {
            to.distances(
                &points[i * lattice.len()..(i + 1) * lattice.len()],
                distances,
            );
        })?;
        for (i, candidate) in candidates.iter_mut().enumerate() {
            let own = i * lattice.len()..(i + 1) * lattice.len();
            for (&point, &distance) in points[own.clone()].iter().zip(&distances[own]) {
                if distance > candidate.distance {
                    (candidate.best, candidate.distance) = (point, distance);
                }
            }
            candidate.corners = candidate
                .corners
                .map(|corner| candidate.best * 0.5 + corner * 0.5);
        }
        // Stable, so that equal ones keep their order.
        candidates.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        candidates.truncate(SEARCHED);
    }
    Ok(candidates.first().map(|best| (best.best, best.distance)))
}

/// The triangles of the farthest samples, each once, in the tree's order.
fn farthest_triangles(samples: &Samples<'_, '_>, distances: &[f64]) -> Vec<usize> {
    let mut farthest: Vec<usize> = samples.beside_vertices().collect();
    // Several of the farthest samples may be of one triangle; four times as many samples as
    // triangles are used.
    let wanted = 4 * SCREENED;
    if farthest.len() > wanted {
        farthest.select_nth_unstable_by(wanted, |&a, &b| {
            distances[b].total_cmp(&distances[a]).then(a.cmp(&b))
        });
        farthest.truncate(wanted);
    }
    farthest.sort_unstable_by(|&a, &b| distances[b].total_cmp(&distances[a]).then(a.cmp(&b)));
    let mut triangles = Vec::with_capacity(SCREENED);
    let mut taken = std::collections::HashSet::new();
    for index in farthest {
        let triangle = samples.triangle(index);
        if triangles.len() < SCREENED && taken.insert(triangle) {
            triangles.push(triangle);
        }
    }
    triangles.sort_unstable();
    triangles
}

/// Weights of the lattice's points.
fn lattice() -> Vec<[f64; 3]> {
    let step = |i: u32| f64::from(i) / f64::from(STEPS);
    (0..=STEPS)
        .flat_map(|i| (0..=STEPS - i).map(move |j| [step(i), step(j), step(STEPS - i - j)]))
        .collect()
}
