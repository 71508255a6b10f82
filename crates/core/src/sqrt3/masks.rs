//! The masks of √3-subdivision (Kobbelt 2000): numbers alone, no meshes.
//!
//! A step gives each face its centre, smooths the old vertices and flips the old edges. Along a
//! boundary, and along an infinitely sharp edge, nothing happens in the first, third, … step, and
//! in the second, fourth, … the curve is cut in three by the cubic B-spline's rule
//! `(1 + z + z²)⁴ / 27`, so that two steps split a triangle in nine.
//!
//! These two steps have the ordinary topology, and ring matrices that are their own mirror images. So the limits of
//! [`crate::limit`] follow from them as from any other scheme's masks ([`DoubleStep`]), for a mesh of an even level.

use core::f64::consts::TAU;

use crate::math;
use crate::ring::{EdgeShape, RingShape, VertexKind};
use crate::scheme::{EdgeMask, Scheme, Support, VertexMask};
use crate::vector::DVec3;

/// How far an interior vertex with `valence` edges moves towards the mean of its neighbours in one step:
/// α = (4 − 2 cos(2π/n)) / 9.
pub(super) fn alpha(valence: u32) -> f64 {
    (4.0 - 2.0 * math::cos(TAU / f64::from(valence))) / 9.0
}

/// The factor of an interior vertex's distance from its limit in one step: 2/3 − α, the square of
/// the ring's first eigenvalue.
pub(super) fn shrinking(valence: u32) -> f64 {
    2.0 / 3.0 - alpha(valence)
}

/// An interior vertex after a step, from its `neighbours`, added up in their order.
pub(super) fn smoothed(vertex: DVec3, neighbours: impl Iterator<Item = DVec3>) -> DVec3 {
    let (sum, count) = neighbours.fold((DVec3::ZERO, 0u32), |(sum, count), p| (sum + p, count + 1));
    let alpha = alpha(count);
    (1.0 - alpha) * vertex + alpha / f64::from(count) * sum
}

/// The centre of a triangle.
pub(super) fn centre([a, b, c]: [DVec3; 3]) -> DVec3 {
    (a + b + c) / 3.0
}

/// A vertex of a curve after two steps, from both neighbours on it.
pub(super) fn on_curve(vertex: DVec3, [before, after]: [DVec3; 2]) -> DVec3 {
    (4.0 * (before + after) + 19.0 * vertex) / 27.0
}

/// The new point of the curve after two steps that is nearer to `near` on the edge to `far`. `beyond` is the other neighbour of
/// `near`; where the curve ends there, `2 near − far`.
pub(super) fn crease_point(beyond: DVec3, near: DVec3, far: DVec3) -> DVec3 {
    (beyond + 16.0 * near + 10.0 * far) / 27.0
}

/// Two steps as one scheme, which splits a triangle in nine: its [`Scheme::edge_mask`] is that of the point nearer to the edge's
/// origin. It is for the limits of meshes of even levels, and for nothing that splits triangles in four.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoubleStep;

impl Scheme for DoubleStep {
    fn name(&self) -> &str {
        "sqrt3"
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        let n = shape.valence;
        let mut ring = vec![0.0; n as usize];
        match shape.kind() {
            VertexKind::Corner => {}
            VertexKind::Boundary => {
                (ring[0], ring[n as usize - 1]) = (4.0 / 27.0, 4.0 / 27.0);
                return VertexMask {
                    centre: 19.0 / 27.0,
                    ring,
                };
            }
            VertexKind::Interior => {
                // v″ = v∞ + (2/3 − α)² (v − v∞) with v∞ = (v + 3α p̄) / (1 + 3α).
                let to_limit = 1.0 - shrinking(n) * shrinking(n);
                let moved = to_limit * 3.0 * alpha(n) / (1.0 + 3.0 * alpha(n));
                ring.fill(moved / f64::from(n));
                return VertexMask {
                    centre: 1.0 - moved,
                    ring,
                };
            }
        }
        VertexMask { centre: 1.0, ring }
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        let mut mask = EdgeMask::zero(&shape);
        let (slot, n) = (shape.origin_slot as usize, shape.origin.valence as usize);
        if shape.is_boundary() {
            let smooth = !shape.origin.corner;
            (mask.origin, mask.target) = if smooth {
                (16.0 / 27.0, 10.0 / 27.0)
            } else {
                (2.0 / 3.0, 1.0 / 3.0)
            };
            if smooth {
                mask.origin_ring[n - 1 - slot] += 1.0 / 27.0;
            }
            return mask;
        }
        // The centre of the origin, as the first step leaves it, and of the centres of both faces.
        let moves = shape.origin.kind() == VertexKind::Interior;
        let alpha = if moves {
            alpha(shape.origin.valence)
        } else {
            0.0
        };
        mask.origin_ring.fill(alpha / (3.0 * n as f64));
        mask.origin = (1.0 - alpha) / 3.0 + 2.0 / 9.0;
        mask.target = 2.0 / 9.0;
        mask.origin_ring[(slot + 1) % n] += 1.0 / 9.0;
        mask.origin_ring[(slot + n - 1) % n] += 1.0 / 9.0;
        mask
    }
}
