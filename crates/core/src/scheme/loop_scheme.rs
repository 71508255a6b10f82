//! Loop's scheme with his own vertex weights (the paper's equation 1) and with Warren's.
//!
//! Boundaries are cubic B-splines: 1/8, 3/4, 1/8 and 1/2, 1/2.

use core::f64::consts::TAU;

use super::{EdgeMask, Scheme, Support, VertexMask, stay};
use crate::ring::{EdgeShape, RingShape, VertexKind};

/// Loop's scheme, equation (1): `β = (5/8 − (3/8 + cos(2π/k)/4)²)/k`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loop;

/// Loop's scheme with Warren's weights: `β = 3/(8k)`, and 3/16 for valence 3 (Warren 1995).
///
/// Valence 3 needs the exception: 3/(8·3) makes all three eigenvalues of the difference matrix 1/4, and the
/// normal undefined.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoopWarren;

fn loop_beta(valence: u32) -> f64 {
    let k = f64::from(valence);
    let inner = 0.375 + 0.25 * (TAU / k).cos();
    (0.625 - inner * inner) / k
}

fn warren_beta(valence: u32) -> f64 {
    if valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * f64::from(valence)) }
}

fn vertex_mask(shape: RingShape, beta: fn(u32) -> f64) -> VertexMask {
    let k = shape.valence as usize;
    match shape.kind() {
        VertexKind::Corner => stay(shape),
        VertexKind::Boundary => {
            let mut ring = vec![0.0; k];
            ring[0] = 0.125;
            ring[k - 1] = 0.125;
            VertexMask { centre: 0.75, ring }
        }
        VertexKind::Interior => {
            let beta = beta(shape.valence);
            VertexMask { centre: 1.0 - k as f64 * beta, ring: vec![beta; k] }
        }
    }
}

fn edge_mask(shape: EdgeShape) -> EdgeMask {
    let mut mask = EdgeMask::zero(&shape);
    if shape.is_boundary() {
        (mask.origin, mask.target) = (0.5, 0.5);
    } else {
        (mask.origin, mask.target) = (0.375, 0.375);
        let (slot, k) = (shape.origin_slot as usize, shape.origin.valence as usize);
        mask.origin_ring[(slot + 1) % k] += 0.125;
        mask.origin_ring[(slot + k - 1) % k] += 0.125;
    }
    mask
}

impl Scheme for Loop {
    fn name(&self) -> &str {
        "loop"
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        vertex_mask(shape, loop_beta)
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        edge_mask(shape)
    }
}

impl Scheme for LoopWarren {
    fn name(&self) -> &str {
        "loop-warren"
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        vertex_mask(shape, warren_beta)
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        edge_mask(shape)
    }
}
