//! The length that is 100 per cent of others.

use serde::Serialize;

use crate::format::{lower_bound, number, upper_bound};

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

/// A certified distance: the true one lies between these.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct IntervalReport {
    /// The distance is at least this, in the mesh's unit.
    pub(crate) lower: f64,
    /// The distance is at most this.
    pub(crate) upper: f64,
    /// In per cent of the diagonal of the control mesh's bounding box.
    pub(crate) lower_percent: f64,
    /// In per cent of that diagonal.
    pub(crate) upper_percent: f64,
}

impl IntervalReport {
    /// An interval where the control mesh has that diagonal.
    pub(crate) fn new(lower: f64, upper: f64, diagonal: f64) -> Self {
        Self {
            lower,
            upper,
            lower_percent: percent(lower, diagonal),
            upper_percent: percent(upper, diagonal),
        }
    }

    /// `within 0.8123 % of the diagonal (0.01234) of the input, certified; at least 0.7901 %`, with a unit after lengths.
    pub(crate) fn near_in_words(&self, unit: &str) -> String {
        format!(
            "within {} % of the diagonal ({}{unit}) of the input, either way, certified; at least {} %",
            upper_bound(self.upper_percent),
            upper_bound(self.upper),
            lower_bound(self.lower_percent)
        )
    }

    /// `moved by 0.7901 % to 0.8123 % of the diagonal (0.01234) from the input, certified`, with a unit after lengths.
    pub(crate) fn in_words(&self, unit: &str) -> String {
        format!(
            "moved by {} % to {} % of the diagonal ({}{unit}) from the input, certified",
            lower_bound(self.lower_percent),
            upper_bound(self.upper_percent),
            upper_bound(self.upper)
        )
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
