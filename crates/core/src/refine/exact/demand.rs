//! What is asked of the triangles, as one number: how many times over a triangle fails.

use crate::surface::{Facet, LimitPoint, Patch};

/// The demands; without any, values are plain distances.
#[derive(Clone, Debug, Default)]
pub(super) struct Demand {
    /// Greatest distance between the triangles and the surface.
    pub(super) tolerance: Option<f64>,
    /// Greatest angle between a triangle's normal and the limit normals of its corners, in radians.
    pub(super) angle: Option<f64>,
}

impl Demand {
    /// Whether limit normals matter.
    pub(super) fn needs_normals(&self) -> bool {
        self.angle.is_some()
    }

    /// What distances are multiplied by, for a piece of the surface.
    pub(super) fn scale(&self, _patch: &Patch) -> f64 {
        match self.tolerance {
            Some(tolerance) => 1.0 / tolerance,
            None if self.angle.is_some() => 0.0,
            None => 1.0,
        }
    }

    /// The share of the cone's angle that a triangle takes (the paper's equation 2): above 1 outside.
    pub(super) fn cone(&self, facet: &Facet, corners: &[LimitPoint; 3]) -> f64 {
        let Some(angle) = self.angle else { return 0.0 };
        let normal = facet.normal();
        if normal == crate::vector::DVec3::ZERO {
            return 0.0;
        }
        let cosine = corners
            .iter()
            .filter(|corner| corner.normal != crate::vector::DVec3::ZERO)
            .map(|corner| corner.normal.dot(normal))
            .fold(1.0, f64::min);
        cosine.clamp(-1.0, 1.0).acos() / angle
    }
}
