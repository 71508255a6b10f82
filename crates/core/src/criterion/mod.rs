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

/// Decides which faces to divide.
pub trait Criterion: Sync {
    /// A short name, as on the command line.
    fn name(&self) -> &str;

    /// For each face of `mesh`, whether it is to be divided.
    ///
    /// # Errors
    /// The limit normals that it needs do not exist.
    fn divisible(&self, mesh: &Mesh, limits: &LimitTable<'_>) -> Result<Vec<bool>, LimitError>;
}
