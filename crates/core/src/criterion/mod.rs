//! Criteria: which faces stand badly for the surface and are to be divided.
//!
//! A criterion sees a mesh and the limit table of its scheme and answers with a flag for each face. It never
//! changes anything.

mod limit_normal;
mod neighbour_normal;
mod view;

pub use limit_normal::LimitNormal;
pub use neighbour_normal::NeighbourNormal;
pub use view::{Sight, Threshold, View};

use crate::limit::{LimitError, LimitTable};
use crate::mesh::Mesh;

/// Why a criterion has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CriterionError {
    /// The limit normals that it needs do not exist.
    #[error(transparent)]
    Limit(#[from] LimitError),
    /// One of its parameters is out of range.
    #[error("{name} is {value}, expected {expected}")]
    BadParameter {
        /// The parameter's name.
        name: &'static str,
        /// The value met.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
}

/// Refuses what is no angle, in radians.
fn check_angle(angle: f64) -> Result<(), CriterionError> {
    if (0.0..=core::f64::consts::PI).contains(&angle) {
        return Ok(());
    }
    Err(CriterionError::BadParameter { name: "angle", value: angle, expected: "radians from 0 to π" })
}

/// Decides which faces to divide.
pub trait Criterion: Sync {
    /// A short name, as on the command line.
    fn name(&self) -> &str;

    /// For each face of `mesh`, whether it is to be divided.
    ///
    /// # Errors
    /// The limit normals that it needs do not exist, or a parameter is out of range.
    fn divisible(&self, mesh: &Mesh, limits: &LimitTable<'_>) -> Result<Vec<bool>, CriterionError>;
}
