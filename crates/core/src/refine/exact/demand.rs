//! What is asked of the triangles, as one number: how many times over a triangle fails.

use super::camera::Lens;
use super::options::ExactOptions;
use crate::certificate::TriangleFrame;
use crate::criterion::{Threshold, View};
use crate::mesh::MeshError;
use crate::patch::LimitPoint;
use crate::vector::DVec3;

/// Where the viewer looks along the surface the paper divides without end; here the cone stays above this part of its
/// angle.
const LEAST_CONE: f64 = 1.0 / 16.0;

/// Lengths below it have no reciprocal.
const LEAST_TOLERANCE: f64 = 1e-300;

/// The demands; without any, values are plain distances.
#[derive(Clone, Debug, Default)]
pub(super) struct Demand {
    /// Greatest distance between the triangles and the surface.
    tolerance: Option<f64>,
    /// Greatest angle between a triangle's normal and the limit normals of its corners, in radians.
    angle: Option<f64>,
    view: Option<View>,
    /// Greatest distance in the pictures of the cameras, in pixels.
    pixels: Option<f64>,
    lenses: Vec<Lens>,
}

impl Demand {
    /// `rounding` is what rounding may do to a distance.
    ///
    /// # Errors
    /// A camera or a view that shows nothing.
    pub(super) fn of(options: &ExactOptions<'_>, rounding: f64) -> Result<Self, MeshError> {
        Ok(Self {
            // Bounds are increased by what rounding may have done. What is within that needs no more triangles; such
            // tolerances are not called met.
            tolerance: options.tolerance.map(|length| (length - rounding).max(rounding).max(LEAST_TOLERANCE)),
            angle: options.angle,
            view: options.view,
            pixels: options.pixels,
            lenses: options.cameras.iter().map(Lens::new).collect::<Result<_, _>>()?,
        })
    }

    /// Whether anything is demanded.
    pub(super) fn is_some(&self) -> bool {
        self.tolerance.is_some() || self.angle.is_some() || self.pixels.is_some()
    }

    /// Whether the limit normals on a triangle's own side matter.
    pub(super) fn needs_normals(&self) -> bool {
        self.angle.is_some() || self.pixels.is_some()
    }

    /// What the distance of a triangle to the surface is multiplied by: 0 where it does not matter.
    #[inline]
    pub(super) fn distance_scale(&self, frame: &TriangleFrame, corners: &[LimitPoint; 3]) -> f64 {
        let plain = match self.tolerance {
            Some(tolerance) => 1.0 / tolerance,
            None if self.is_some() => 0.0,
            None => 1.0,
        };
        let Some(pixels) = self.pixels else { return plain };
        let seen = self.lenses.iter().map(|lens| lens.one_pixel(frame, corners));
        plain.max(1.0 / (pixels * seen.fold(f64::INFINITY, f64::min)))
    }

    /// The share of the cone's angle that a triangle takes (the paper's equations 2 and 11): above 1 outside.
    pub(super) fn cone(&self, frame: &TriangleFrame, corners: &[LimitPoint; 3]) -> f64 {
        let Some(angle) = self.angle else { return 0.0 };
        let normal = frame.normal();
        if frame.is_flat() {
            return 0.0;
        }
        let angle = match self.view {
            None => angle,
            Some(view) => {
                let [a, b, c] = corners.map(|corner| corner.position);
                match view.threshold(angle, view.direction((a + b + c) / 3.0).dot(normal)) {
                    Threshold::Never => return 0.0,
                    Threshold::Always => LEAST_CONE * angle,
                    Threshold::Angle(seen) => seen.max(LEAST_CONE * angle),
                }
            }
        };
        let cosine = corners
            .iter()
            .filter(|corner| corner.normal != DVec3::ZERO)
            .map(|corner| corner.normal.dot(normal))
            .fold(1.0, f64::min);
        cosine.clamp(-1.0, 1.0).acos() / angle
    }
}
