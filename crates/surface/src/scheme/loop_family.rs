//! The Loop family: Loop's scheme with his own vertex weights (the paper's equation 1) and with Warren's.
//!
//! Its members share all masks but the weight β(k) of each of the k neighbours of a vertex inside the surface: regular
//! pieces are quartic box splines, boundaries and creases cubic B-splines (1/8, 3/4, 1/8 and 1/2, 1/2). 0 < β(k) ≤ 1/k for
//! every k, so that all masks are convex combinations and pieces lie in the hulls of their points: distances from these
//! surfaces can be proven.

use core::f64::consts::TAU;

use super::{EdgeMask, Family, Scheme, Support, VertexMask, stay};
use crate::math;
use crate::ring::{EdgeShape, RingShape, VertexKind};

/// A member of the Loop family: [`Loop`] or [`LoopWarren`]. There are no others, as only their
/// formulas guarantee the weights at every valence.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LoopFamily {
    weights: Weights,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Weights {
    Loop,
    Warren,
}

/// Loop's scheme, equation (1): `β = (5/8 − (3/8 + cos(2π/k)/4)²)/k`.
#[expect(
    non_upper_case_globals,
    reason = "schemes without parameters read like unit structs"
)]
pub const Loop: LoopFamily = LoopFamily {
    weights: Weights::Loop,
};

/// Loop's scheme with Warren's weights: `β = 3/(8k)`, and 3/16 for valence 3 (Warren 1995).
///
/// Valence 3 needs the exception: 3/(8·3) makes all three eigenvalues of the difference matrix 1/4, and the
/// normal undefined.
#[expect(
    non_upper_case_globals,
    reason = "schemes without parameters read like unit structs"
)]
pub const LoopWarren: LoopFamily = LoopFamily {
    weights: Weights::Warren,
};

impl LoopFamily {
    /// The weight of each neighbour of a vertex inside the surface with `valence` edges, at least 2.
    #[inline]
    pub(crate) fn beta(self, valence: u32) -> f64 {
        let k = f64::from(valence);
        match self.weights {
            Weights::Loop => {
                let inner = 0.375 + 0.25 * math::cos(TAU / k);
                (0.625 - inner * inner) / k
            }
            Weights::Warren if valence == 3 => 3.0 / 16.0,
            Weights::Warren => 3.0 / (8.0 * k),
        }
    }

    /// This family member as a static reference.
    pub(crate) fn scheme(self) -> &'static dyn Scheme {
        match self.weights {
            Weights::Loop => &Loop,
            Weights::Warren => &LoopWarren,
        }
    }
}

impl Scheme for LoopFamily {
    fn name(&self) -> &str {
        match self.weights {
            Weights::Loop => "loop",
            Weights::Warren => "loop-warren",
        }
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
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
                let beta = self.beta(shape.valence);
                VertexMask {
                    centre: 1.0 - k as f64 * beta,
                    ring: vec![beta; k],
                }
            }
        }
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
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

    fn family(&self) -> Option<Family> {
        Some(Family::Loop(*self))
    }
}
