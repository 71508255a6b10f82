//! The modified butterfly scheme (Zorin, Schröder and Sweldens 1996), with the boundary rules of Zorin's course
//! notes ("Subdivision for Modeling and Animation", SIGGRAPH 1998–2000).
//!
//! Vertices keep their positions. The point of an edge inside follows the kinds of its ends, where
//! a boundary vertex is regular with four edges and an interior one with six:
//!
//! | ends | rule |
//! |---|---|
//! | both regular, inside | eight points: 1/2, 1/8, −1/16 |
//! | both regular, one on a boundary | the eight points with the one outside the mesh replaced |
//! | both regular, both on a boundary | see [`between_boundaries`] |
//! | one extraordinary | its own rule, on its ring alone |
//! | both extraordinary | the mean of both their rules |
//!
//! The own rules reproduce linear functions on a regular fan (the full circle inside, half of it at a boundary)
//! and have the eigenvalues 1/2, 1/2, 1/4 and 0.
//!
//! A boundary is refined by the four-point rule (−1, 9, 9, −1)/16. At a corner of it the curve ends: the edge next
//! to the corner uses the parabola through the three points on its own side, (3, 6, −1)/8, and an edge between
//! two corners is halved. Course notes are silent on corners; the rule for edges that leave one into the mesh is
//! [`corner_rule`]. A corner inside the mesh is a vertex like any other, as every vertex keeps its place.

use core::f64::consts::{PI, TAU};

use super::{EdgeMask, Scheme, Support, VertexMask, stay};
use crate::math;
use crate::ring::{EdgeShape, RingShape};

/// The modified butterfly scheme: interpolating, with rules for extraordinary vertices and boundaries.
#[derive(Clone, Copy, Debug, Default)]
pub struct ModifiedButterfly;

impl Scheme for ModifiedButterfly {
    fn name(&self) -> &str {
        "butterfly"
    }

    fn support(&self) -> Support {
        Support::TwoRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        stay(shape)
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        let mut mask = EdgeMask::zero(&shape);
        let [mut origin, mut target] = ends(&shape, &mut mask);
        if shape.is_boundary() {
            boundary_rule(&mut origin, &mut target);
            return mask;
        }
        match (origin.is_regular(), target.is_regular()) {
            (false, true) => origin.own_rule(1.0),
            (true, false) => target.own_rule(1.0),
            (false, false) => {
                origin.own_rule(0.5);
                target.own_rule(0.5);
            }
            (true, true) => match (origin.shape.open, target.shape.open) {
                (false, false) => eight_point_rule(&mut origin, &mut target),
                (true, false) => beside_boundary(&mut origin, &mut target),
                (false, true) => beside_boundary(&mut target, &mut origin),
                (true, true) => between_boundaries(&mut origin, &mut target),
            },
        }
        mask
    }
}

/// One end of an edge, with the weights that a rule puts on it and on its ring.
struct End<'m> {
    shape: RingShape,
    /// The slot of the other end in the ring.
    slot: usize,
    centre: &'m mut f64,
    ring: &'m mut [f64],
}

fn ends<'m>(shape: &EdgeShape, mask: &'m mut EdgeMask) -> [End<'m>; 2] {
    let EdgeMask {
        origin,
        target,
        origin_ring,
        target_ring,
    } = mask;
    [
        End {
            shape: shape.origin,
            slot: shape.origin_slot as usize,
            centre: origin,
            ring: origin_ring,
        },
        End {
            shape: shape.target,
            slot: shape.target_slot as usize,
            centre: target,
            ring: target_ring,
        },
    ]
}

impl End<'_> {
    fn is_regular(&self) -> bool {
        self.shape.is_regular() && !self.is_boundary_corner()
    }

    fn is_boundary_corner(&self) -> bool {
        self.shape.open && self.shape.corner
    }

    /// Adds a weight to the neighbour `steps` counter-clockwise from the other end.
    fn add(&mut self, steps: isize, weight: f64) {
        let k = self.ring.len();
        let slot = (self.slot as isize + steps).rem_euclid(k as isize) as usize;
        self.ring[slot] += weight;
    }

    /// The rule of an extraordinary end, times `scale`.
    fn own_rule(&mut self, scale: f64) {
        if self.is_boundary_corner() {
            corner_rule(self, scale);
        } else if self.shape.open {
            boundary_vertex_rule(self, scale);
        } else {
            interior_vertex_rule(self, scale);
        }
    }
}

/// Both ends regular and inside.
fn eight_point_rule<'m>(origin: &mut End<'m>, target: &mut End<'m>) {
    for end in [&mut *origin, &mut *target] {
        *end.centre += 0.5;
        end.add(2, -0.0625);
        end.add(-2, -0.0625);
    }
    // Both ends know the two vertices opposite the edge.
    origin.add(1, 0.125);
    origin.add(-1, 0.125);
}

/// Both ends regular, `boundary` on a boundary and `inside` not: one of the eight points lies outside the mesh.
/// On a regular mesh with V the boundary's end and e, f the directions of its first two edges (V + f the other
/// end) it is V + e − f, and stands as 2V − 2(V+f) + (V+e) − (V+f−e) + (V+2f−e).
fn beside_boundary(boundary: &mut End<'_>, inside: &mut End<'_>) {
    *boundary.centre += 0.375;
    *inside.centre += 0.625;
    // Towards the boundary edge that shares a face with this one, as seen from either end.
    let near: isize = if boundary.slot == 1 { -1 } else { 1 };
    boundary.add(near, 0.0625);
    boundary.add(-near, 0.1875);
    boundary.add(-2 * near, -0.0625);
    inside.add(-2 * near, -0.0625);
    inside.add(2 * near, -0.125);
}

/// Both ends regular and on a boundary. Where the edge cuts off the tip of a sheet (a face with two boundary
/// edges): 1/2 on both ends, 1/4 on the vertex opposite in the other face, −1/8 on the next boundary vertices.
/// Across a strip between two boundaries: the midpoint.
fn between_boundaries(origin: &mut End<'_>, target: &mut End<'_>) {
    *origin.centre += 0.5;
    *target.centre += 0.5;
    if origin.slot != target.slot {
        let away: isize = if origin.slot == 1 { 1 } else { -1 };
        origin.add(away, 0.25);
        origin.add(2 * away, -0.125);
        target.add(-2 * away, -0.125);
    }
}

/// An extraordinary interior end: 3/4 on it, (1/4 + cos 2πj/k + ½ cos 4πj/k)/k on its neighbours from the other
/// end on, and the values in between for k = 3 and 4. Two edges have no pattern of frequency 2 either: theirs
/// follow from the eigenvalues 1/4 of frequency 0 and 1/2 of frequency 1.
fn interior_vertex_rule(end: &mut End<'_>, scale: f64) {
    *end.centre += 0.75 * scale;
    let k = end.ring.len();
    for j in 0..k {
        let weight = match (k, j) {
            (2 | 4, 0) => 3.0 / 8.0,
            (2, _) | (4, 2) => -1.0 / 8.0,
            (4, _) => 0.0,
            (3, 0) => 5.0 / 12.0,
            (3, _) => -1.0 / 12.0,
            _ => {
                let angle = TAU * j as f64 / k as f64;
                (0.25 + math::cos(angle) + 0.5 * math::cos(2.0 * angle)) / k as f64
            }
        };
        end.add(j as isize, weight * scale);
    }
}

/// An extraordinary boundary end with K faces and θ = π/K, for the edge at slot i of its ring 0 … K:
///
/// ```text
/// itself      1 − (1/K) sin θ sin iθ / (1 − cos θ)
/// slot 0      ¼ cos iθ − (1/4K) sin 2θ sin 2iθ / (cos θ − cos 2θ),   slot K its negative
/// slot j      (1/K)(sin iθ sin jθ + ½ sin 2iθ sin 2jθ)
/// ```
fn boundary_vertex_rule(end: &mut End<'_>, scale: f64) {
    let last = end.ring.len() - 1;
    let faces = last as f64;
    let theta = PI / faces;
    let (sine, cosine) = math::sin_cos(end.slot as f64 * theta);
    let double_sine = 2.0 * sine * cosine;
    *end.centre += scale * (1.0 - sine * math::sin(theta) / (1.0 - math::cos(theta)) / faces);
    let skew = math::sin(2.0 * theta) * double_sine / (math::cos(theta) - math::cos(2.0 * theta));
    let first = 0.25 * (cosine - skew / faces);
    end.ring[0] += scale * first;
    end.ring[last] -= scale * first;
    for j in 1..last {
        let (sine_j, cosine_j) = math::sin_cos(j as f64 * theta);
        end.ring[j] += scale * (sine * sine_j + double_sine * sine_j * cosine_j) / faces;
    }
}

/// An end that is a corner of the boundary: with d_i the edge from the corner and d_{i−1}, d_{i+1}
/// its neighbours, ½ d_i + ⅛ (d_{i−1} + d_{i+1} − 2 cos φ d_i).
///
/// The bracket vanishes for linear functions on a fan of K equal angles φ; with φ = 120°/K that includes the
/// corner of a grid cut by its diagonal (K = 2). Patterns of the edges inside shrink by ½ + ¼(cos(mπ/K) − cos φ),
/// faster than the two boundary edges, whose plane is therefore the tangent plane.
fn corner_rule(end: &mut End<'_>, scale: f64) {
    let angle = 2.0 * PI / (3.0 * end.shape.faces() as f64);
    let own = 0.5 - 0.25 * math::cos(angle);
    *end.centre += scale * (0.75 - own);
    end.add(0, scale * own);
    end.add(1, scale * 0.125);
    end.add(-1, scale * 0.125);
}

/// The four-point rule, and its one-sided forms next to corners.
fn boundary_rule<'m>(origin: &mut End<'m>, target: &mut End<'m>) {
    let corners = [origin.is_boundary_corner(), target.is_boundary_corner()];
    let weights = match corners {
        [false, false] => [9.0 / 16.0, 9.0 / 16.0],
        [true, false] => [3.0 / 8.0, 6.0 / 8.0],
        [false, true] => [6.0 / 8.0, 3.0 / 8.0],
        [true, true] => [0.5, 0.5],
    };
    let beyond = if corners == [false, false] {
        -1.0 / 16.0
    } else {
        -1.0 / 8.0
    };
    for ((end, corner), weight) in [origin, target].into_iter().zip(corners).zip(weights) {
        *end.centre += weight;
        if !corner {
            // The other boundary neighbour is at the other end of the ring.
            let other = if end.slot == 0 { end.ring.len() - 1 } else { 0 };
            end.ring[other] += beyond;
        }
    }
}
