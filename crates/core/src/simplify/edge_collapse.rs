//! Edge collapses in the order of the error that they leave behind, up to a threshold that rises from round to round.
//!
//! A round passes over the vertices in their order, so that what is near in the mesh is near in memory, and collapses
//! those whose best collapse stays below the threshold. What the others would cost is remembered; since that almost only
//! rises while the stars grow, they are left alone until the threshold has reached it.

use super::Goals;
use super::edge_flip::{Flipper, edges};
use super::editable_mesh::EditableMesh;
use super::fine_samples::FineSamples;
use super::kept_features::Kind;
use super::reference::Reference;
use super::vertex_star::{VertexStar, Way};

/// Growth of the threshold far from the goal. In a round of that growth the order hardly matters yet: what it costs is
/// made good for later, and larger steps save little more time.
const FAST: f64 = 1.4;

/// Growth of the threshold when the number of triangles is near: the last round decides how even the errors are.
const SLOW: f64 = 1.03;

/// How many times as many triangles as asked for count as far.
const FAR: usize = 2;

/// How often collapses and flips take turns: later ones find next to nothing.
const MOST_RESUMPTIONS: usize = 4;

/// Vertices with more edges than this wait until they have fewer: the time for one grows with the square.
const MOST_EDGES: usize = 64;

/// The mesh on its way from fine to coarse.
pub(super) struct Collapser<'a> {
    pub(super) surface: EditableMesh,
    pub(super) samples: FineSamples,
    pub(super) ground: Reference<'a>,
    star: VertexStar,
    /// For each vertex what its best collapse would cost, or less; infinite if it has none.
    costs: Vec<f64>,
    /// Greatest error that a collapse has left so far.
    pub(super) reached: f64,
    /// Errors up to this are rounding.
    flat: f64,
    flipper: Flipper,
}

/// A mesh on its way, to come back to.
#[derive(Clone)]
pub(super) struct Snapshot {
    surface: EditableMesh,
    samples: FineSamples,
    costs: Vec<f64>,
}

impl<'a> Collapser<'a> {
    pub(super) fn new(surface: EditableMesh, samples: FineSamples, ground: Reference<'a>, flat: f64) -> Self {
        let costs = vec![0.0; ground.kinds.len()];
        Self {
            surface,
            samples,
            ground,
            star: VertexStar::default(),
            costs,
            reached: 0.0,
            flat,
            flipper: Flipper::default(),
        }
    }

    /// Collapses edges until a goal is reached, even after flips.
    pub(super) fn run(&mut self, goals: Goals) {
        for _ in 0..MOST_RESUMPTIONS {
            self.collapse_up_to(goals, goals);
            if !self.flip_all() || self.surface.faces_left() <= goals.triangles {
                break;
            }
        }
    }

    /// Collapses edges on the way to `goals` until `stop` is reached.
    pub(super) fn collapse_up_to(&mut self, stop: Goals, goals: Goals) {
        let mut left: Vec<u32> = (0..self.costs.len() as u32).filter(|&v| self.surface.is_alive(v)).collect();
        let mut threshold = self.flat.min(stop.tolerance);
        while self.surface.faces_left() > stop.triangles {
            let least = self.round(&left, threshold, stop.triangles, goals.tolerance);
            left.retain(|&v| self.surface.is_alive(v));
            if least > stop.tolerance {
                break;
            }
            let near = self.surface.faces_left() / FAR <= goals.triangles;
            let growth = if near { SLOW } else { FAST };
            threshold = self.rung_above((threshold * growth).max(least), growth).min(stop.tolerance);
        }
    }

    /// The least of the thresholds `flat`, `flat`·`growth`, `flat`·`growth`², … from `cost` on. Were it the cost itself, a
    /// change in one place would alter the order of the collapses everywhere.
    fn rung_above(&self, cost: f64, growth: f64) -> f64 {
        // A little less than a whole number by rounding is that number.
        const SLACK: f64 = 1e-9;
        let rung = ((cost / self.flat).ln() / growth.ln() - SLACK).ceil();
        let threshold = self.flat * growth.powf(rung.max(0.0));
        if threshold.is_finite() { threshold } else { cost }
    }

    /// What it takes to come back to this state.
    pub(super) fn snapshot(&self) -> Snapshot {
        Snapshot { surface: self.surface.clone(), samples: self.samples.clone(), costs: self.costs.clone() }
    }

    /// Comes back to an earlier state, with other reserves from there on.
    pub(super) fn restore(&mut self, snapshot: &Snapshot, reserves: &[f64]) {
        let Snapshot { surface, samples, costs } = snapshot.clone();
        (self.surface, self.samples, self.costs) = (surface, samples, costs);
        self.samples.reserve(reserves.to_vec());
        self.reached = 0.0;
    }

    /// Flips edges where that brings the mesh nearer to the surface; whether there were any.
    fn flip_all(&mut self) -> bool {
        let mut any = false;
        for h in edges(&self.surface) {
            let flipped = self.flipper.flip(h, self.flat, &mut self.surface, &mut self.samples, &self.ground);
            any |= flipped.is_some();
            for v in flipped.into_iter().flatten() {
                self.costs[v as usize] = 0.0;
            }
        }
        any
    }

    /// One pass over the vertices; gives the least cost of a collapse that is left.
    fn round(&mut self, vertices: &[u32], threshold: f64, triangles: usize, tolerance: f64) -> f64 {
        let mut least = f64::INFINITY;
        for &vertex in vertices {
            if self.costs[vertex as usize] <= threshold && self.surface.is_alive(vertex) {
                if self.surface.faces_left() <= triangles {
                    return least;
                }
                self.costs[vertex as usize] = self.consider(vertex, threshold, tolerance);
            }
            least = least.min(self.costs[vertex as usize]);
        }
        least
    }

    /// Collapses a vertex if that costs no more than `threshold`, and gives what it costs; infinite if it is gone, or
    /// cannot go within `tolerance`.
    fn consider(&mut self, vertex: u32, threshold: f64, tolerance: f64) -> f64 {
        if self.ground.kind(vertex) == Kind::Fixed
            || self.surface.outgoing_ring(vertex).take(MOST_EDGES + 1).count() > MOST_EDGES
        {
            return f64::INFINITY;
        }
        self.star.gather(vertex, &self.surface, &self.samples, &self.ground);
        self.star.find_ways(&self.ground);
        let Some((way, cost)) = self.best_way(threshold, tolerance) else { return f64::INFINITY };
        if cost > threshold {
            return cost;
        }
        self.star.collapse_into(way.slot, &self.ground);
        self.surface.collapse(self.star.edge(way.slot), vertex);
        self.star.hand_over(&mut self.samples);
        self.reached = self.reached.max(cost - self.star.reserve());
        for &neighbour in &self.star.ring {
            // What could not go may do so now.
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
            if !self.star.collapse_into(way.slot, &self.ground) {
                continue;
            }
            let Some(cost) = self.star.cost(way, &self.ground, bound) else { continue };
            // Where it is flat, one way is as good as another for the distance.
            let shape = self.star.shape();
            if best.is_some_and(|best| best.1 <= self.flat && shape <= best_shape) {
                continue;
            }
            // Whether the mesh stays a manifold takes long to find out, and matters only for what is to be done now.
            if cost > threshold || self.surface.can_collapse(self.star.edge(way.slot), self.star.centre) {
                best = Some((way, cost));
                best_shape = shape;
                bound = if cost <= self.flat { bound.min(self.flat.next_up()) } else { cost };
            }
        }
        best
    }
}
