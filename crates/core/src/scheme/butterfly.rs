//! The modified butterfly scheme (Zorin, Schröder and Sweldens 1996).

use super::{EdgeMask, Scheme, Support, VertexMask, stay};
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
        (mask.origin, mask.target) = (0.5, 0.5);
        mask
    }
}
