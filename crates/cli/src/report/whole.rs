//! What lengths are given in per cent of.

use crate::format::number;

/// The diagonal of the bounding box of the control mesh where one is known, of the mesh that is measured against else.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Whole {
    pub(crate) diagonal: f64,
    /// Whose diagonal it is.
    pub(crate) of: &'static str,
}

impl Whole {
    /// The share of a length; none where the mesh has no extent.
    pub(crate) fn percent(self, length: f64) -> Option<f64> {
        Some(100.0 * length / self.diagonal).filter(|percent| percent.is_finite())
    }

    /// `the control mesh's diagonal 2.5`.
    pub(crate) fn in_words(self) -> String {
        format!("the {}'s diagonal {}", self.of, number(self.diagonal))
    }
}
