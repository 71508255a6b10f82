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
        Some(percent(length, self.diagonal)).filter(|percent| percent.is_finite())
    }

    /// `the control mesh's diagonal 2.5`.
    pub(crate) fn in_words(self) -> String {
        format!("the {}'s diagonal {}", self.of, number(self.diagonal))
    }
}

/// A length in per cent of a diagonal, however long both are.
pub(crate) fn percent(length: f64, diagonal: f64) -> f64 {
    let hundredfold = 100.0 * length;
    if hundredfold.is_finite() {
        hundredfold / diagonal
    } else {
        100.0 * (length / diagonal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn per_cent_of_lengths_near_the_greatest_are_finite() {
        assert_eq!(percent(1.5, 3.0), 50.0);
        assert_eq!(percent(8e307, 1.6e308), 50.0);
        assert_eq!(percent(f64::INFINITY, 1.0), f64::INFINITY);
        assert_eq!(
            Whole {
                diagonal: 0.0,
                of: "mesh"
            }
            .percent(0.0),
            None
        );
    }
}
