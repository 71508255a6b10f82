//! The options of adaptive √3-subdivision.

use crate::mesh::MeshError;
use crate::options;
use crate::refine::RefineError;

/// Steps that a control face can be divided by at most.
const MOST_LEVELS: usize = 48;

options! {
    /// Goals and caps of adaptive √3-subdivision; at least one of angle, tolerance and triangles is needed.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Sqrt3Options {
        /// The cone around the limit normals of a triangle's corners that its normal may not leave: radians above 0, at most π.
        pub angle: Option<f64> = None,
        /// The greatest distance of the limit surface from a triangle, **estimated** from vertices of later levels.
        pub tolerance: Option<f64> = None,
        /// The wanted number of triangles: the worst are divided first.
        pub triangles: Option<usize> = None,
        /// Give no more triangles.
        pub max_triangles: Option<usize> = None,
        /// Steps by which a control face is divided at most; two of them divide a triangle in nine.
        pub max_levels: usize = 20,
        /// Whether to report the origins of vertices ([`Sqrt3::origins`](super::Sqrt3::origins)).
        pub origins: bool = false,
    }
}

impl Sqrt3Options {
    /// # Errors
    /// A goal is out of range, or there is none.
    pub(super) fn check(&self) -> Result<(), RefineError> {
        let bad = |name, value, expected| {
            Err(MeshError::BadOption {
                name,
                value,
                expected,
            }
            .into())
        };
        if let Some(tolerance) = self.tolerance
            && !(tolerance > 0.0 && tolerance.is_finite())
        {
            return bad("tolerance", tolerance, "a length above 0");
        }
        if let Some(angle) = self.angle
            && !(angle > 0.0 && angle <= core::f64::consts::PI)
        {
            return bad("angle", angle, "radians above 0, at most π");
        }
        if self.max_levels > MOST_LEVELS {
            return bad("number of levels", self.max_levels as f64, "at most 48");
        }
        match (self.angle, self.tolerance, self.triangles) {
            (None, None, None) => bad(
                "number of goals",
                0.0,
                "an angle, a tolerance or a number of triangles",
            ),
            _ => Ok(()),
        }
    }
}
