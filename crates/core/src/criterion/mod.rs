//! Criteria: the error of a triangle relative to the allowed one. At 1 it is just good enough, at 2
//! it is twice as large.
//!
//! The paper's criteria ([`LimitNormal`], [`NeighbourNormal`]) compute the ratio of each face from
//! a mesh and the limit table of its scheme; stepwise refinement divides the faces above 1. Exact
//! refinement computes the ratio of a triangle and the piece of the surface that it approximates
//! (`Criteria`), and divides the worst first. A criterion changes nothing.

mod cone;
mod criteria;
mod distance;
mod neighbour;
mod pixels;
mod region;
mod view;

pub use crate::facing::Viewpoint;
pub use cone::LimitNormal;
pub(crate) use cone::ratio as cone_ratio;
pub(crate) use criteria::{Apart, Criteria};
pub(crate) use distance::Distance;
pub use neighbour::NeighbourNormal;
pub use pixels::Camera;
pub(crate) use pixels::{Backs, Lens, Pixels};
pub(crate) use region::Region;
pub use view::{AngleLimit, View};

use crate::error_messages;
use crate::limit::{LimitError, LimitTable};
use crate::math;
use crate::mesh::Mesh;

/// An error of a criterion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum CriterionError {
    /// The limit normals that it needs do not exist.
    Limit(LimitError),
    /// One of its parameters is out of range.
    BadParameter {
        /// The parameter's name.
        name: &'static str,
        /// The value met.
        value: f64,
        /// The range of valid values.
        expected: &'static str,
    },
}

error_messages! {
    CriterionError {
        Self::BadParameter { name, value, expected } => ("{name} must be {expected}, but is {value}"),
    }
    from { Limit(LimitError) }
}

/// Refuses values that are no angles in radians.
fn check_angle(angle: f64) -> Result<(), CriterionError> {
    if (0.0..=core::f64::consts::PI).contains(&angle) {
        return Ok(());
    }
    Err(CriterionError::BadParameter {
        name: "angle",
        value: angle,
        expected: "radians from 0 to π",
    })
}

/// The least ratio that fails.
const JUST_TOO_BAD: f64 = 1.0 + f64::EPSILON;

/// How many times over an angle passes its limit, both in radians; the angle is given by its cosine.
///
/// Whether it passes is decided by the cosines, so that the arc's rounding does not count.
fn angle_ratio(cosine: f64, limit: f64) -> f64 {
    let ratio = math::acos(cosine.clamp(-1.0, 1.0)) / limit;
    if cosine < math::cos(limit) {
        ratio.max(JUST_TOO_BAD)
    } else {
        ratio.min(1.0)
    }
}

/// The ratio of a face's error to the allowed one.
pub trait Criterion: Sync {
    /// A short name, as on the command line.
    fn name(&self) -> &str;

    /// The ratio of each face of `mesh`: 1 is just good enough, faces above are to be divided;
    /// infinite where nothing is good enough.
    ///
    /// # Errors
    /// The limit normals that it needs do not exist, or a parameter is out of range.
    fn ratios(&self, mesh: &Mesh, limits: &LimitTable<'_>) -> Result<Vec<f64>, CriterionError>;

    /// For each face of `mesh`, whether it is to be divided: whether it fails.
    ///
    /// # Errors
    /// Those of [`Self::ratios`].
    fn divisible(&self, mesh: &Mesh, limits: &LimitTable<'_>) -> Result<Vec<bool>, CriterionError> {
        Ok(self
            .ratios(mesh, limits)?
            .into_iter()
            .map(|ratio| ratio > 1.0)
            .collect())
    }
}
