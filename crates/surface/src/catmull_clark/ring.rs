//! The ring of a vertex among quads: what a step of Catmull–Clark makes of it, and its limits.
//!
//! Takes the sharpness of the edges at a vertex; gives weights on the ring's points. These are the vertex (0), its n neighbours
//! (1 … n, counter-clockwise) and the corners opposite it in its quads (n + 1 …, that between neighbours i and i + 1 at n + 1 + i).
//!
//! A functional of the points after a step is one of the points before it ([`pulled_back`]). Limits are functionals that a step
//! multiplies by a number only: by 1 for positions, by the subdominant eigenvalues for tangents. Where those are known in closed form
//! (Halstead, Kass and DeRose 1993 for smooth vertices, and our own for the sides of creases) they are taken; those of darts are
//! found by iteration. Semi-sharp tags end: limits are those of the ring without them, pulled back through the steps before.

use core::f64::consts::{PI, TAU};

use crate::math;
use crate::ring::{SharpRing, VertexRule};

/// Steps of the iteration for darts. It converges like the ratio of two eigenvalues, 0.9 and less up to nine edges.
const MOST_STEPS: usize = 20_000;

/// The iteration has converged where nothing changes by more than this part of the greatest weight.
const CONVERGED: f64 = 1e-15;

/// The weights of a vertex's limits on the points of its ring.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RingLimits {
    /// Of the position; they sum to 1.
    pub(crate) position: Vec<f64>,
    /// One where the surface is smooth, else one for each part of the ring between two sharp edges.
    pub(crate) sides: Vec<RingSide>,
}

/// A side of the sharp edges at a vertex.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RingSide {
    /// The slot of its first edge, and its quads, counter-clockwise from there.
    pub(crate) first: usize,
    pub(crate) quads: usize,
    /// The weights of two tangents, which sum to 0: the surface's outside is where their cross product points. `None` without a
    /// tangent plane.
    pub(crate) tangents: Option<[Vec<f64>; 2]>,
}

/// The points of a ring, by number.
#[derive(Clone, Copy)]
struct Points {
    edges: usize,
    open: bool,
}

impl Points {
    fn of(ring: &SharpRing) -> Self {
        Self {
            edges: ring.spokes.len(),
            open: ring.open,
        }
    }

    fn quads(self) -> usize {
        self.edges - usize::from(self.open)
    }

    fn count(self) -> usize {
        1 + self.edges + self.quads()
    }

    fn neighbour(self, slot: usize) -> usize {
        1 + slot % self.edges
    }

    fn opposite(self, slot: usize) -> usize {
        1 + self.edges + slot % self.edges
    }

    /// The corners of the quad between an edge and the next one.
    fn quad(self, slot: usize) -> [usize; 4] {
        [
            0,
            self.neighbour(slot),
            self.opposite(slot),
            self.neighbour(slot + 1),
        ]
    }
}

/// The weights on the points before a step, given those on the points after it.
pub(crate) fn pulled_back(after: &[f64], ring: &SharpRing) -> Vec<f64> {
    let points = Points::of(ring);
    let n = points.edges;
    let mut before = vertex_weights(ring);
    before.iter_mut().for_each(|weight| *weight *= after[0]);
    let mut add_centroid = |quad: usize, weight: f64| {
        for corner in points.quad(quad) {
            before[corner] += 0.25 * weight;
        }
    };
    for slot in 0..points.quads() {
        add_centroid(slot, after[points.opposite(slot)]);
    }
    for slot in 0..n {
        let weight = after[points.neighbour(slot)];
        let smooth = (1.0 - sharpness(ring, slot).min(1.0)) * weight;
        if smooth != 0.0 {
            add_centroid(slot, 0.25 * smooth);
            add_centroid((slot + n - 1) % n, 0.25 * smooth);
        }
    }
    for slot in 0..n {
        let weight = after[points.neighbour(slot)];
        let sharp = sharpness(ring, slot).min(1.0) * weight;
        let ends = 0.25 * (weight - sharp) + 0.5 * sharp;
        before[0] += ends;
        before[points.neighbour(slot)] += ends;
    }
    before
}

/// The sharpness of an edge; those of a boundary are infinitely sharp.
fn sharpness(ring: &SharpRing, slot: usize) -> f64 {
    match ring.open && (slot == 0 || slot + 1 == ring.spokes.len()) {
        true => f64::INFINITY,
        false => ring.spokes[slot],
    }
}

/// The weights of a vertex's new place.
pub(crate) fn vertex_weights(ring: &SharpRing) -> Vec<f64> {
    let now = ring.present_weight();
    let mut weights = vertex_weights_by(ring);
    if now < 1.0 {
        let later = vertex_weights_by(&ring.refined());
        for (weight, later) in weights.iter_mut().zip(later) {
            *weight = now * *weight + (1.0 - now) * later;
        }
    }
    weights
}

/// Those by the rule of the ring as it is.
fn vertex_weights_by(ring: &SharpRing) -> Vec<f64> {
    let points = Points::of(ring);
    let n = points.edges as f64;
    let mut weights = vec![0.0; points.count()];
    match ring.rule() {
        VertexRule::Smooth | VertexRule::Dart => {
            weights[0] = 1.0 - 1.75 / n;
            weights[1..=points.edges].fill(1.5 / (n * n));
            weights[points.edges + 1..].fill(0.25 / (n * n));
        }
        VertexRule::Crease => along_crease(ring, points, [0.75, 0.125], &mut weights),
        VertexRule::Corner => weights[0] = 1.0,
    }
    weights
}

/// Weights of the vertex and of the ends of both sharp edges.
fn along_crease(ring: &SharpRing, points: Points, [own, end]: [f64; 2], weights: &mut [f64]) {
    weights[0] = own;
    let sharp = (0..points.edges).filter(|&slot| ring.is_sharp(slot));
    sharp.for_each(|slot| weights[points.neighbour(slot)] += end);
}

impl RingLimits {
    /// The limits of a vertex, whatever its tags.
    pub(crate) fn of(ring: &SharpRing) -> Self {
        let mut steps = Vec::new();
        let mut last = ring.clone();
        while last.semi_sharpness() > 0.0 {
            let next = last.refined();
            steps.push(core::mem::replace(&mut last, next));
        }
        let mut limits = Self::settled(&last);
        for before in steps.iter().rev() {
            let back = |weights: &mut Vec<f64>| *weights = pulled_back(weights, before);
            back(&mut limits.position);
            let tangents = limits
                .sides
                .iter_mut()
                .filter_map(|side| side.tangents.as_mut());
            tangents.flatten().for_each(back);
        }
        limits
    }

    /// The side of the quad between an edge of a ring of so many and the next one.
    pub(crate) fn side_of(&self, slot: usize, edges: usize) -> &RingSide {
        let holds = |side: &&RingSide| (slot + edges - side.first) % edges < side.quads;
        self.sides.iter().find(holds).unwrap_or(&self.sides[0])
    }

    /// Those of a ring without semi-sharp tags.
    fn settled(ring: &SharpRing) -> Self {
        let points = Points::of(ring);
        let n = points.edges as f64;
        let mut position = vec![0.0; points.count()];
        let rule = ring.rule();
        match rule {
            VertexRule::Smooth => {
                position[0] = n / (n + 5.0);
                position[1..=points.edges].fill(4.0 / (n * (n + 5.0)));
                position[points.edges + 1..].fill(1.0 / (n * (n + 5.0)));
            }
            VertexRule::Dart => position = dart(ring, points),
            VertexRule::Crease => along_crease(ring, points, [2.0 / 3.0, 1.0 / 6.0], &mut position),
            VertexRule::Corner => position[0] = 1.0,
        }
        let sides = ring.sectors().into_iter().map(|sector| {
            let edges = sector.shape.valence as usize;
            let tangents = match rule {
                VertexRule::Dart => dart_tangents(ring, points),
                _ if !sector.shape.open => closed(points),
                VertexRule::Corner => Some(corner(points, sector.first, edges)),
                _ => Some(side(points, sector.first, edges)),
            };
            RingSide {
                first: sector.first,
                quads: sector.shape.faces() as usize,
                tangents,
            }
        });
        Self {
            position,
            sides: sides.collect(),
        }
    }
}

/// A(θ), of which the eigenvalue of that frequency is (A + 4)/16.
fn amplitude(angle: f64) -> f64 {
    let cosine = math::cos(angle);
    1.0 + cosine + math::cos(0.5 * angle) * (2.0 * (9.0 + cosine)).sqrt()
}

/// The subdominant eigenvalue of a smooth vertex with so many edges.
pub(crate) fn subdominant(edges: usize) -> f64 {
    (amplitude(TAU / edges as f64) + 4.0) / 16.0
}

/// The tangents of a smooth vertex; `None` for two edges, at which the surface has no tangent plane.
fn closed(points: Points) -> Option<[Vec<f64>; 2]> {
    let n = points.edges;
    if n < 3 {
        return None;
    }
    let angle = TAU / n as f64;
    let amplitude = amplitude(angle);
    let weights = |wave: fn(f64) -> f64| {
        let at = |slot: usize| wave(angle * (slot % n) as f64);
        let mut weights = vec![0.0; points.count()];
        for slot in 0..n {
            weights[points.neighbour(slot)] = amplitude * at(slot);
            weights[points.opposite(slot)] = at(slot) + at(slot + 1);
        }
        weights
    };
    Some([weights(math::cos), weights(math::sin)])
}

/// The tangents of a corner's side: its two sharp edges.
fn corner(points: Points, first: usize, edges: usize) -> [Vec<f64>; 2] {
    [first, first + edges - 1].map(|slot| {
        let mut weights = vec![0.0; points.count()];
        weights[points.neighbour(slot)] = 1.0;
        weights[0] = -1.0;
        weights
    })
}

/// The tangents of a side of a crease or boundary, along it and across it. From five edges on another functional is as strong as that
/// along it; these are those of the ribbon along the crease.
fn side(points: Points, first: usize, edges: usize) -> [Vec<f64>; 2] {
    let (start, end) = (points.neighbour(first), points.neighbour(first + edges - 1));
    let (mut along, mut across) = (vec![0.0; points.count()], vec![0.0; points.count()]);
    along[start] += 1.0;
    along[end] -= 1.0;
    if edges == 2 {
        across[start] += 1.0;
        across[end] += 1.0;
        across[0] = -2.0;
        return [along, across];
    }
    let angle = PI / (edges - 1) as f64;
    let (amplitude, cotangent) = (amplitude(angle), 1.0 / math::tan(0.5 * angle));
    let eigenvalue = (amplitude + 4.0) / 16.0;
    let sine = |slot: usize| math::sin(angle * slot as f64);
    for slot in 1..edges - 1 {
        across[points.neighbour(first + slot)] = amplitude * sine(slot);
    }
    for slot in 0..edges - 1 {
        across[points.opposite(first + slot)] = sine(slot) + sine(slot + 1);
    }
    let ends = (eigenvalue * sine(1) - (amplitude + 2.0) * cotangent / 8.0) / (eigenvalue - 0.25);
    across[start] += ends;
    across[end] += ends;
    across[0] = -2.0 * ends - (amplitude + 2.0) * cotangent;
    [along, across]
}

/// The position of a dart.
fn dart(ring: &SharpRing, points: Points) -> Vec<f64> {
    let mut own = vec![0.0; points.count()];
    own[0] = 1.0;
    // Weights sum to 1 in each step, whether they have converged or not.
    iterated(own, |weights| pulled_back(weights, ring)).0
}

/// The tangents of a dart, along its crease and across it: the dominant functionals that are even and odd under the reflection there.
fn dart_tangents(ring: &SharpRing, points: Points) -> Option<[Vec<f64>; 2]> {
    let n = points.edges;
    let crease = (0..n).find(|&slot| ring.is_sharp(slot))?;
    let angle = |slot: f64| TAU * (slot - crease as f64) / n as f64;
    // The numbers of the points at the other side of the crease.
    let mirrored = |point: usize| match point {
        0 => 0,
        _ if point <= n => points.neighbour(2 * (crease + n) - (point - 1)),
        _ => points.opposite(2 * (crease + n) - 1 - (point - 1 - n)),
    };
    let found = |wave: fn(f64) -> f64, sign: f64| {
        // Rounding brings in others, which may grow faster.
        let kept = |weights: &[f64]| {
            let of = |point: usize| 0.5 * (weights[point] + sign * weights[mirrored(point)]);
            let mut kept: Vec<f64> = (0..points.count()).map(of).collect();
            kept[0] -= kept.iter().sum::<f64>();
            let greatest = kept.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
            kept.iter_mut().for_each(|weight| *weight /= greatest);
            kept
        };
        let mut weights = vec![0.0; points.count()];
        for slot in 0..n {
            weights[points.neighbour(slot)] = wave(angle(slot as f64));
            weights[points.opposite(slot)] = wave(angle(slot as f64 + 0.5));
        }
        let step = |weights: &Vec<f64>| kept(&pulled_back(weights, ring));
        let (weights, has_converged) = iterated(kept(&weights), step);
        has_converged.then_some(weights)
    };
    Some([found(math::cos, 1.0)?, found(math::sin, -1.0)?])
}

/// The result of a step repeated until nothing changes, and whether that was reached.
fn iterated(mut weights: Vec<f64>, step: impl Fn(&Vec<f64>) -> Vec<f64>) -> (Vec<f64>, bool) {
    for _ in 0..MOST_STEPS {
        let next = step(&weights);
        let change = |(a, b): (&f64, &f64)| (a - b).abs();
        let greatest = next.iter().zip(&weights).map(change).fold(0.0, f64::max);
        weights = next;
        if greatest <= CONVERGED {
            return (weights, true);
        }
    }
    (weights, false)
}

#[cfg(test)]
mod tests;
