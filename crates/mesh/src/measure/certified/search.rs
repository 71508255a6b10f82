//! Branch and bound over the pieces of a surface's triangles.
//!
//! Takes the surface that is measured and the one it is measured to; gives the interval of the
//! greatest distance. First the vertices, and samples and a climb on a large surface measured to a
//! finer one, give a lower bound, from which most triangles can be dropped at once; the pieces of
//! the others are split, the worst first, until all that is left is within the gap of the lower
//! bound. Pieces are treated in batches between which alone the lower bound changes, so that
//! threads do not matter.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::piece::{Piece, Sample, Worker};
use super::target::Target;
use super::{Bounds, CertifiedOptions};
use crate::measure::bvh::Bvh;
use crate::measure::climb::climb;
use crate::measure::samples::Samples;
use crate::parallel;
use crate::progress::{Cancelled, Stage, Watch};
use crate::vector::{DVec3, vector};

/// Points that the first lower bound is sampled at, in addition to the vertices, where that pays:
/// enough for the climb to start near the maximum on most surfaces, few compared with the rest of
/// the work.
const SAMPLES: usize = 50_000;

/// The least number of triangles for which sampling pays. Smaller ones are searched whole in about
/// the time that samples and climb take, which spare a third of the work at most. They spare
/// nothing where the surface itself is the finer one, whose triangles are hardly ever split.
const LARGE: usize = 100_000;

/// Samples measured, and triangles bounded, in one go.
const RUN: usize = 1024;

/// Pieces split before the lower bound is updated, and those of one block.
const BATCH: usize = 4096;
const PIECES: usize = 32;

/// Pieces waiting at most, in addition to the triangles; each takes about 100 bytes.
const WAITING: usize = 1 << 22;

/// A sheet has at most this many triangles, and this many times as many as the surface searched has for one of the
/// surface measured: a piece over more is split first, so that no number of triangles as large as the surface takes
/// time with the product of both.
const SHEET: usize = 256;

/// A waiting piece, ordered by its bound and then by age.
struct Waiting {
    piece: Piece,
    number: u64,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.piece
            .upper
            .total_cmp(&other.piece.upper)
            .then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

/// The result of a run over pieces.
struct Found {
    kept: Vec<Piece>,
    /// The greatest bound of the dropped pieces.
    dropped: f64,
    farthest: Sample,
    work: u64,
}

/// The search in one direction.
pub(crate) struct Search<'t, 's, 'a> {
    from: &'s Bvh<'a>,
    target: &'t Target<'s, 'a>,
    /// In the common unit.
    gap: f64,
    relative_gap: f64,
    most_work: u64,
    /// The least value of the distance; where it is known, the search considers only pieces and
    /// vertices.
    known: Option<f64>,
    farthest: Sample,
    waiting: BinaryHeap<Waiting>,
    number: u64,
    /// Greatest bound of the pieces that are done with.
    dropped: f64,
    work: u64,
}

impl<'t, 's, 'a> Search<'t, 's, 'a> {
    /// The greatest distance from `from` to the target, or the `known` one, if that is more. `gap`
    /// and `known` are in the surfaces' unit.
    pub(super) fn run(
        from: &'s Bvh<'a>,
        target: &'t Target<'s, 'a>,
        (gap, known): (f64, Option<f64>),
        options: &CertifiedOptions,
        watch: &mut Watch<'_>,
    ) -> Result<(Bounds, u64), Cancelled> {
        // No interval can be narrower than the allowance for rounding.
        let least = 4.0 * (target.scale.slack + target.scale.search_slack);
        let mut search = Self {
            from,
            target,
            gap: target.scale.length(gap).max(least),
            relative_gap: options.relative_gap.max(0.0),
            most_work: options.max_work,
            known: known.map(|known| target.scale.length(known)),
            farthest: Sample {
                point: DVec3::ZERO,
                distance: f64::NEG_INFINITY,
            },
            waiting: BinaryHeap::new(),
            number: 0,
            dropped: f64::NEG_INFINITY,
            work: 0,
        };
        watch.triangles(from.surface().triangles.len());
        let faces = search.sample(watch)?;
        search.first_pass(&faces, watch)?;
        search.refine(watch)?;
        Ok((search.bounds(), search.work))
    }

    /// The proven lower bound so far.
    fn lower(&self) -> f64 {
        let distance = self.farthest.distance;
        let found = distance - self.target.scale.search_slack - distance * f64::EPSILON;
        found.max(self.known.unwrap_or(0.0))
    }

    /// The bound that pieces need not exceed.
    fn goal(&self) -> f64 {
        let lower = self.lower();
        lower + self.gap.max(self.relative_gap * lower)
    }

    /// Measures vertices and, where that pays, samples, and climbs from the farthest of these; returns the triangle nearest
    /// to each vertex in use.
    fn sample(&mut self, watch: &mut Watch<'_>) -> Result<Vec<u32>, Cancelled> {
        let is_large = self.from.surface().triangles.len() >= LARGE;
        let is_sampled = self.known.is_none() && is_large && self.is_coarser();
        let samples = match is_sampled {
            true => Samples::new(self.from, SAMPLES),
            false => Samples::of_vertices(self.from),
        };
        watch.stage(Stage::Sampling, Some(samples.len()))?;
        let runs =
            parallel::pieces_polled(samples.len(), RUN, &mut |done| watch.done(done), |range| {
                let mut points = Vec::with_capacity(range.len());
                samples.visit(range, |point| points.push(point));
                let mut near = Vec::with_capacity(points.len());
                self.target
                    .bvh
                    .each_nearest(&points, |_, distance, face| near.push((distance, face)));
                near
            })?;
        let near = runs.concat();
        let mut faces = vec![0; self.from.surface().positions.len()];
        for (&vertex, &(_, face)) in samples.vertices().iter().zip(&near) {
            faces[vertex as usize] = face;
        }
        let distances: Vec<f64> = near.into_iter().map(|(distance, _)| distance).collect();
        let (mut best, mut most) = (0, f64::NEG_INFINITY);
        for (index, &distance) in distances.iter().enumerate() {
            if distance > most {
                (best, most) = (index, distance);
            }
        }
        let scale = self.target.scale;
        let sample = |point, distance| Sample {
            point: scale.point(point),
            distance: scale.length(distance),
        };
        self.farthest = sample(samples.point(best), most);
        if is_sampled
            && let Some((point, distance)) =
                climb(&samples, &distances, self.from, self.target.bvh, watch)?
        {
            self.farthest = self.farthest.farther(sample(point, distance));
        }
        Ok(faces)
    }

    /// Triangles in a sheet at most.
    fn limit(&self) -> usize {
        let count = |bvh: &Bvh<'_>| bvh.surface().triangles.len();
        SHEET * (1 + count(self.target.bvh) / count(self.from) / 4)
    }

    fn worker(&self) -> Worker<'t, 's, 'a> {
        Worker::new(self.target, self.limit(), self.is_coarser())
    }

    /// Whether the surface has fewer triangles than the one it is measured to.
    fn is_coarser(&self) -> bool {
        self.from.surface().triangles.len() < self.target.bvh.surface().triangles.len()
    }

    /// Bounds every triangle and keeps those that may be farther away than the goal.
    fn first_pass(&mut self, faces: &[u32], watch: &mut Watch<'_>) -> Result<(), Cancelled> {
        let goal = self.goal();
        let count = self.from.surface().triangles.len();
        watch.stage(Stage::Bounding, Some(count))?;
        let runs = parallel::pieces_polled(count, RUN, &mut |done| watch.done(done), |range| {
            let mut worker = self.worker();
            let (mut kept, mut dropped) = (Vec::new(), f64::NEG_INFINITY);
            for slot in range {
                let corners = self.from.corners(slot).map(|p| self.target.scale.point(p));
                let faces = self.from.in_order(slot).map(|v| faces[v as usize]);
                let upper = worker.bound(corners, faces, goal);
                if upper <= goal {
                    dropped = f64::max(dropped, upper);
                } else {
                    kept.push(Piece {
                        upper,
                        corners,
                        faces,
                        depth: 0,
                    });
                }
            }
            Found {
                kept,
                dropped,
                farthest: worker.farthest,
                work: worker.work(),
            }
        })?;
        self.take(runs);
        Ok(())
    }

    /// Splits pieces until all are within the goal or the work is used up.
    fn refine(&mut self, watch: &mut Watch<'_>) -> Result<(), Cancelled> {
        let mut split = 0;
        watch.stage(Stage::Bounding, None)?;
        let mut batch = Vec::with_capacity(BATCH);
        let most_waiting = self.waiting.len() + WAITING;
        while self.work < self.most_work && self.waiting.len() < most_waiting {
            let goal = self.goal();
            batch.clear();
            while batch.len() < BATCH
                && self
                    .waiting
                    .peek()
                    .is_some_and(|worst| worst.piece.upper > goal)
            {
                let Some(Waiting { piece, .. }) = self.waiting.pop() else {
                    break;
                };
                if piece.is_deepest() {
                    self.dropped = self.dropped.max(piece.upper);
                } else {
                    batch.push(piece);
                }
            }
            if batch.is_empty() {
                break;
            }
            let poll = &mut |done| watch.done(split + done);
            let runs = parallel::pieces_polled(batch.len(), PIECES, poll, |range| {
                let mut worker = self.worker();
                let (mut kept, mut dropped) = (Vec::new(), f64::NEG_INFINITY);
                for piece in &batch[range] {
                    dropped = dropped.max(worker.split(piece, goal, &mut kept));
                }
                Found {
                    kept,
                    dropped,
                    farthest: worker.farthest,
                    work: worker.work(),
                }
            })?;
            split += batch.len();
            self.take(runs);
        }
        Ok(())
    }

    /// Takes in the results of the runs, in order.
    fn take(&mut self, runs: Vec<Found>) {
        for run in runs {
            self.dropped = self.dropped.max(run.dropped);
            self.farthest = self.farthest.farther(run.farthest);
            self.work += run.work;
            for piece in run.kept {
                self.waiting.push(Waiting {
                    piece,
                    number: self.number,
                });
                self.number += 1;
            }
        }
    }

    /// The interval in the surfaces' unit.
    fn bounds(&self) -> Bounds {
        let scale = self.target.scale;
        let lower = self.lower();
        let left = self
            .waiting
            .peek()
            .map_or(f64::NEG_INFINITY, |worst| worst.piece.upper);
        let upper = self.dropped.max(left).max(lower);
        let at = scale.back(self.farthest.point).to_array();
        Bounds {
            lower: scale.length_back(lower),
            upper: scale.length_back(upper),
            at,
            to: vector(self.target.bvh.closest(at).point).to_array(),
            converged: upper <= self.goal(),
        }
    }
}
