//! Edge collapses in the order of the error that they leave behind, up to a threshold that rises from round to round.
//!
//! A round passes over the vertices in their order, so that neighbours are near in memory, and
//! collapses those whose best collapse stays below the threshold. The costs of the others are kept;
//! since they almost only rise while the stars grow, they are left alone until the threshold has
//! reached it.

use super::Goals;
use super::edge_flip::{Flipper, edges};
use super::editable_mesh::EditableMesh;
use super::fine_samples::FineSamples;
use super::history::History;
use super::kept_features::Kind;
use super::proof::Prover;
use super::reference::Reference;
use super::vertex_star::{VertexStar, Way};
use crate::geometry::NONE;
use crate::math;
use crate::progress::{Cancelled, Watch};

/// Growth of the threshold far from the goal. In a round of that growth the order hardly matters
/// yet: its cost is recovered later, and larger steps save little more time.
const FAST: f64 = 1.4;

/// Growth of the threshold when the number of triangles is near: the last round decides how even the errors are.
const SLOW: f64 = 1.03;

/// A number of triangles is far above the requested one from this factor on.
const FAR: usize = 2;

/// How often collapses and flips take turns: later ones find next to nothing.
const MOST_RESUMPTIONS: usize = 4;

/// Vertices with more edges than this wait until they have fewer: the time for one grows with the square.
const MOST_EDGES: usize = 64;

/// Where a number of triangles stops the collapses: the greatest proven distance of a new triangle
/// over the threshold.
const UNEVEN: f64 = 1.03;

/// Changes between two calls of the observer: some milliseconds.
const OBSERVED: usize = 256;

/// The mesh on its way from fine to coarse.
pub(super) struct Collapser<'t, 's, 'a> {
    pub(super) surface: EditableMesh,
    pub(super) samples: FineSamples,
    pub(super) reference: Reference<'a>,
    star: VertexStar,
    /// For each vertex a lower bound of the cost of its best collapse; infinite if it has none.
    costs: Vec<f64>,
    /// Greatest error that a collapse has left so far.
    pub(super) reached: f64,
    /// Errors up to this are rounding.
    flat: f64,
    flipper: Flipper,
    /// Proves each change before it is made.
    prover: Option<Prover<'t, 's, 'a>>,
    /// The cost below which a collapse is proven in the end.
    sure: f64,
    /// Kept where there may be anything to take back.
    history: Option<History>,
    /// Vertices that stay because their going was not proven to be within the goal.
    refused: Vec<bool>,
    /// Changes since the observer was last called.
    unobserved: usize,
    /// The part of the tolerance that collapses may cost by now.
    share: f64,
}

impl<'t, 's, 'a> Collapser<'t, 's, 'a> {
    pub(crate) fn new(
        surface: EditableMesh,
        samples: FineSamples,
        reference: Reference<'a>,
        flat: f64,
        prover: Option<Prover<'t, 's, 'a>>,
        sure: f64,
    ) -> Self {
        let costs = vec![0.0; reference.kinds.len()];
        let refused = vec![false; costs.len()];
        let may_fail = prover.is_some() && sure > 0.0;
        let history = may_fail.then(|| History::new(reference.fine.face_count()));
        Self {
            surface,
            samples,
            reference,
            star: VertexStar::default(),
            costs,
            reached: 0.0,
            flat,
            flipper: Flipper::default(),
            refused,
            prover,
            sure,
            history,
            unobserved: 0,
            share: 0.0,
        }
    }

    /// Collapses edges until a goal is reached, even after flips.
    pub(super) fn run(&mut self, goals: Goals, watch: &mut Watch<'_>) -> Result<(), Cancelled> {
        for _ in 0..MOST_RESUMPTIONS {
            self.collapse_up_to(goals, watch)?;
            if self.surface.faces_left() <= goals.triangles || !self.flip_all(goals, watch)? {
                break;
            }
        }
        Ok(())
    }

    /// Does the proofs that were put off, and takes back changes without proof.
    pub(super) fn finish(&mut self, goals: Goals, watch: &mut Watch<'_>) -> Result<(), Cancelled> {
        let mut back = Vec::new();
        if let Some(prover) = &mut self.prover {
            while let Some(failing) =
                prover.finish(&self.surface, &self.samples, goals.tolerance, watch)?
            {
                let Some(history) = &mut self.history else {
                    break;
                };
                let Some(change) = history.latest(failing.into_iter()) else {
                    break;
                };
                history.take_back(
                    change,
                    &mut self.surface,
                    &mut self.samples,
                    |faces, vertex| {
                        prover.reopen(faces);
                        back.push(vertex);
                    },
                );
            }
        }
        back.retain(|&vertex| vertex != NONE && self.surface.is_alive(vertex));
        if back.is_empty() {
            return Ok(());
        }
        // Most of it may be collapsed after all, now that no proof is put off.
        (self.sure, self.history) = (0.0, None);
        for vertex in back {
            self.costs[vertex as usize] = 0.0;
            let costs = &mut self.costs;
            self.surface
                .for_each_neighbour(vertex, |v| costs[v as usize] = 0.0);
        }
        self.run(goals, watch)
    }

    /// The greatest distance that is proven; `None` where there is no proof of all of the mesh.
    pub(super) fn bound(&self) -> Option<f64> {
        let bound = self.prover.as_ref()?.bound(&self.surface);
        bound.is_finite().then_some(bound)
    }

    /// Number of vertices that stay because no proof was found for their going.
    pub(super) fn refused(&self) -> usize {
        let is_refused = |&v: &usize| self.refused[v] && self.surface.is_alive(v as u32);
        (0..self.refused.len()).filter(is_refused).count()
    }

    /// Counts the trial of a change, and calls the observer after every few hundred.
    fn observe(&mut self, goals: Goals, watch: &mut Watch<'_>) -> Result<(), Cancelled> {
        self.unobserved += 1;
        if self.unobserved < OBSERVED {
            return Ok(());
        }
        self.unobserved = 0;
        let (all, left) = (self.reference.fine.face_count(), self.surface.faces_left());
        watch.triangles(left);
        // The number left at a cost falls with its reciprocal: heights grow with the square of a
        // triangle's size.
        let expected = (left as f64 * self.share) as usize;
        watch.done_of(all - left, all - expected.max(goals.triangles).min(left))
    }

    fn collapse_up_to(&mut self, goals: Goals, watch: &mut Watch<'_>) -> Result<(), Cancelled> {
        let mut left: Vec<u32> = (0..self.costs.len() as u32)
            .filter(|&v| self.surface.is_alive(v))
            .collect();
        let mut threshold = self.flat.min(goals.tolerance);
        while self.surface.faces_left() > goals.triangles {
            self.share = if goals.tolerance < f64::MAX {
                threshold / goals.tolerance
            } else {
                0.0
            };
            let least = self.round(&left, threshold, goals, watch)?;
            left.retain(|&v| self.surface.is_alive(v));
            if least > goals.tolerance {
                break;
            }
            let near = self.surface.faces_left() / FAR <= goals.triangles;
            let growth = if near { SLOW } else { FAST };
            threshold = self
                .rung_above((threshold * growth).max(least), growth)
                .min(goals.tolerance);
        }
        Ok(())
    }

    /// The least of the thresholds `flat`, `flat`·`growth`, `flat`·`growth`², … from `cost` on. Were it the cost itself, a
    /// change in one place would alter the order of the collapses everywhere.
    fn rung_above(&self, cost: f64, growth: f64) -> f64 {
        // A little less than a whole number by rounding is that number.
        const SLACK: f64 = 1e-9;
        let rung = (math::ln(cost / self.flat) / math::ln(growth) - SLACK).ceil();
        let threshold = self.flat * math::powf(growth, rung.max(0.0));
        if threshold.is_finite() {
            threshold
        } else {
            cost
        }
    }

    /// Flips edges where that brings the mesh nearer to the surface; whether there were any.
    fn flip_all(&mut self, goals: Goals, watch: &mut Watch<'_>) -> Result<bool, Cancelled> {
        let mut any = false;
        for h in edges(&self.surface) {
            self.observe(goals, watch)?;
            let history = self.history.as_mut();
            let proof = self
                .prover
                .as_mut()
                .map(|prover| (prover, goals.tolerance, history));
            let (flat, surface, samples) = (self.flat, &mut self.surface, &mut self.samples);
            let flipped = self
                .flipper
                .flip(h, flat, surface, samples, &self.reference, proof);
            any |= flipped.is_some();
            for v in flipped.into_iter().flatten() {
                self.costs[v as usize] = 0.0;
            }
        }
        Ok(any)
    }

    /// One pass over the vertices; gives the least cost of a collapse that is left.
    fn round(
        &mut self,
        vertices: &[u32],
        threshold: f64,
        goals: Goals,
        watch: &mut Watch<'_>,
    ) -> Result<f64, Cancelled> {
        let mut least = f64::INFINITY;
        for &vertex in vertices {
            if self.costs[vertex as usize] <= threshold && self.surface.is_alive(vertex) {
                if self.surface.faces_left() <= goals.triangles {
                    return Ok(least);
                }
                self.observe(goals, watch)?;
                self.costs[vertex as usize] = self.consider(vertex, threshold, goals);
            }
            least = least.min(self.costs[vertex as usize]);
        }
        Ok(least)
    }

    /// Collapses a vertex if that costs no more than `threshold`, and gives the cost; infinite if
    /// it was removed, or cannot be within the tolerance.
    fn consider(&mut self, vertex: u32, threshold: f64, goals: Goals) -> f64 {
        self.refused[vertex as usize] = false;
        if self.reference.kind(vertex) == Kind::Fixed
            || self
                .surface
                .outgoing_ring(vertex)
                .take(MOST_EDGES + 1)
                .count()
                > MOST_EDGES
        {
            return f64::INFINITY;
        }
        self.star
            .gather(vertex, &self.surface, &self.samples, &self.reference);
        self.star.find_ways(&self.reference);
        let Some((way, cost)) = self.best_way(threshold, goals.tolerance) else {
            return f64::INFINITY;
        };
        if cost > threshold {
            return cost;
        }
        self.star.collapse_into(way.slot, &self.reference);
        let change = self.star.change(&self.surface);
        if let Some(prover) = &mut self.prover {
            // Where their number stops the collapses, no triangle is to be much worse than the others.
            let goal = if goals.tolerance < f64::MAX {
                goals.tolerance
            } else {
                threshold * UNEVEN
            };
            if cost < self.sure {
                prover.defer(&change, &self.surface, &self.samples);
            } else if prover.prove(&change, &self.surface, &self.samples, goal) {
                prover.commit(&change);
            } else {
                self.refused[vertex as usize] = true;
                return if goal < goals.tolerance {
                    goal
                } else {
                    f64::INFINITY
                };
            }
        }
        if let Some(history) = &mut self.history {
            let change = self.star.change(&self.surface);
            history.record(
                change.old,
                vertex,
                change.region.samples(),
                &self.surface,
                &self.samples,
            );
        }
        self.surface.collapse(self.star.edge(way.slot), vertex);
        self.star.hand_over(&mut self.samples);
        self.reached = self.reached.max(cost);
        for &neighbour in &self.star.ring {
            // A collapse that was refused may be possible now.
            let known = &mut self.costs[neighbour as usize];
            if known.is_infinite() {
                *known = cost;
            }
        }
        f64::INFINITY
    }

    /// The best neighbour to collapse the gathered vertex into.
    fn best_way(&mut self, threshold: f64, tolerance: f64) -> Option<(Way, f64)> {
        let mut best: Option<(Way, f64)> = None;
        let mut best_shape = 0.0;
        let mut bound = tolerance.next_up();
        let mut place = 0;
        while let Some(way) = self.star.way(place).filter(|way| way.bulge < bound) {
            place += 1;
            if !self.star.collapse_into(way.slot, &self.reference) {
                continue;
            }
            let Some(cost) = self.star.cost(way, &self.reference, bound) else {
                continue;
            };
            // Where it is flat, all collapses are equal in distance.
            let shape = self.star.shape();
            if best.is_some_and(|best| best.1 <= self.flat && shape <= best_shape) {
                continue;
            }
            // Whether the mesh stays a manifold takes long to find out, and matters only for
            // collapses to be done now.
            if cost > threshold
                || self
                    .surface
                    .can_collapse(self.star.edge(way.slot), self.star.centre)
            {
                best = Some((way, cost));
                best_shape = shape;
                bound = if cost <= self.flat {
                    bound.min(self.flat.next_up())
                } else {
                    cost
                };
            }
        }
        best
    }
}
