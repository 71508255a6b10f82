//! The control faces whose pieces look away from a viewer as a whole ([`super::backs`] finds them).

/// The control faces whose pieces look away as a whole, by viewer: so do all parts of them.
#[derive(Clone, Debug, Default)]
pub(super) struct BackFaces {
    viewers: usize,
    /// By control face and viewer, how far from its corners that is not certain; NaN where it does not look away.
    rests: Vec<f64>,
}

impl BackFaces {
    pub(super) fn new(viewers: usize, rests: Vec<f64>) -> Self {
        Self { viewers, rests }
    }

    /// How far from a face's corners it is not certain that it looks away; `None` where it does not.
    pub(super) fn rest(&self, face: u32, viewer: usize) -> Option<f64> {
        let rest = self.rests.get(face as usize * self.viewers + viewer)?;
        (!rest.is_nan()).then_some(*rest)
    }
}
