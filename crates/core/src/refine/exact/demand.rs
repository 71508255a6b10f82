//! What is asked of the triangles, as one number: how many times over a triangle fails.

use crate::surface::{Facet, LimitPoint};
use crate::vector::DVec3;

/// The demands; without any, values are plain distances.
#[derive(Clone, Debug, Default)]
pub(super) struct Demand {
    /// Greatest distance between the triangles and the surface.
    pub(super) tolerance: Option<f64>,
    /// Greatest angle between a triangle's normal and the limit normals of its corners, in radians.
    pub(super) angle: Option<f64>,
}

impl Demand {
    /// Whether anything is demanded.
    pub(super) fn is_some(&self) -> bool {
        self.tolerance.is_some() || self.angle.is_some()
    }

    /// Whether limit normals matter.
    pub(super) fn needs_normals(&self) -> bool {
        self.angle.is_some()
    }

    /// What distances are multiplied by; `None` where they do not matter.
    pub(super) fn distance_scale(&self) -> Option<f64> {
        match self.tolerance {
            Some(tolerance) => Some(1.0 / tolerance),
            None => self.angle.is_none().then_some(1.0),
        }
    }

    /// The share of the cone's angle that a triangle takes (the paper's equation 2): above 1 outside.
    pub(super) fn cone(&self, facet: &Facet, corners: &[LimitPoint; 3]) -> f64 {
        let Some(angle) = self.angle else { return 0.0 };
        let normal = facet.normal();
        if normal == DVec3::ZERO {
            return 0.0;
        }
        let cosine = corners
            .iter()
            .filter(|corner| corner.normal != DVec3::ZERO)
            .map(|corner| corner.normal.dot(normal))
            .fold(1.0, f64::min);
        cosine.clamp(-1.0, 1.0).acos() / angle
    }
}
