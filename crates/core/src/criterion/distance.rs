//! The tolerance: how far triangles and surface may be from each other.

/// Lengths below it have no reciprocal.
const LEAST: f64 = 1e-300;

/// A greatest distance between triangles and the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distance {
    /// The greatest allowed bound, not counting rounding.
    allowed: f64,
}

impl Distance {
    /// `rounding` is the greatest rounding error of a bound. Bounds below it need no more
    /// triangles; a tolerance below it is not called met.
    pub(crate) fn new(tolerance: f64, rounding: f64) -> Self {
        Self {
            allowed: (tolerance - rounding).max(rounding).max(LEAST),
        }
    }

    /// The greatest bound that is good enough.
    pub(crate) fn allowed(&self) -> f64 {
        self.allowed
    }
}
