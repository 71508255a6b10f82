//! Places on a face as weights of its corners with few digits, corrected to a sum of 1.

use crate::error_messages;

/// How far the sum of weights may be from 1: three of four decimals each, such as 0.3333, are off by up to 1.5e-4 together.
const OF_SUMS: f64 = 2e-4;

/// How far below 0 a weight may be that counts as 0, such as one that came out of a computation.
const OF_WEIGHTS: f64 = 1e-6;

/// The rounding error of three weights' sum of 1: weights with such a sum are kept to the bit.
const OF_DOUBLES: f64 = 4.0 * f64::EPSILON;

/// An error of barycentric coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum BarycentricError {
    /// A weight is below 0.
    Outside {
        /// The weight.
        weight: f64,
    },
    /// The weights do not add up to 1, or are no numbers.
    Sum {
        /// The sum of the weights.
        sum: f64,
    },
}

error_messages! {
    BarycentricError {
        Self::Outside { weight } => ("the weight {weight:?} is below 0: the place is not on the face"),
        Self::Sum { sum } => ("the weights add up to {sum:?} rather than 1 (to {OF_SUMS:?})"),
    }
}

/// Weights of the corners of a face that add up to 1, of weights that nearly do: divided by their sum, if that is within 2e-4 of 1.
/// Weights that are below 0 by no more than 1e-6 count as 0.
///
/// ```
/// let middle = limitmesh_surface::barycentric([0.3333, 0.3333, 0.3333])?;
/// assert_eq!(middle, [1.0 / 3.0; 3]);
/// let why = limitmesh_surface::barycentric([0.5, 0.25, 0.0]).unwrap_err();
/// assert_eq!(why.to_string(), "the weights add up to 0.75 rather than 1 (to 0.0002)");
/// # Ok::<(), limitmesh_surface::BarycentricError>(())
/// ```
///
/// # Errors
/// The weights are no place on the face.
pub fn barycentric(weights: [f64; 3]) -> Result<[f64; 3], BarycentricError> {
    if let Some(&weight) = weights.iter().find(|&&weight| weight < -OF_WEIGHTS) {
        return Err(BarycentricError::Outside { weight });
    }
    let sum: f64 = weights.iter().sum();
    let is_sum = (sum - 1.0).abs() <= OF_SUMS;
    if !is_sum {
        return Err(BarycentricError::Sum { sum });
    }
    let weights = weights.map(|weight| weight.max(0.0));
    let sum: f64 = weights.iter().sum();
    Ok(if (sum - 1.0).abs() <= OF_DOUBLES {
        weights
    } else {
        weights.map(|weight| weight / sum)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_with_few_digits_are_those_that_were_meant() {
        for third in [0.3333, 0.333333, 0.3333333333] {
            assert_eq!(barycentric([third; 3]), Ok([1.0 / 3.0; 3]));
        }
        let [a, b, c] = barycentric([0.6667, 0.3334, 0.0]).expect("a place");
        assert!(
            (a + b - 1.0).abs() <= f64::EPSILON
                && c == 0.0
                && (a / b - 0.6667 / 0.3334).abs() < 1e-14
        );
    }

    #[test]
    fn weights_that_add_up_stay_to_the_bit() {
        for weights in [
            [1.0, 0.0, 0.0],
            [0.5, 0.3, 0.2],
            [0.1, 0.2, 0.7],
            [1.0 / 3.0; 3],
        ] {
            assert_eq!(barycentric(weights), Ok(weights));
        }
    }

    #[test]
    fn a_little_below_nothing_is_nothing() {
        assert_eq!(barycentric([0.25, 0.75, -1e-17]), Ok([0.25, 0.75, 0.0]));
        let [a, b, c] = barycentric([0.25, 0.75, -9e-7]).expect("a place");
        assert_eq!([a, b, c], [0.25, 0.75, 0.0]);
        assert_eq!(
            barycentric([0.5, 0.51, -0.01]),
            Err(BarycentricError::Outside { weight: -0.01 })
        );
    }

    #[test]
    fn others_are_refused_with_their_sum() {
        for (weights, words) in [
            ([0.333, 0.333, 0.333], "add up to 0.999"),
            ([0.5, 0.6, 0.0], "add up to 1.1 "),
            ([1e300, 0.0, 0.0], "add up to 1e300 "),
            ([f64::NAN, 0.5, 0.5], "add up to NaN "),
            ([f64::INFINITY, 0.5, 0.5], "add up to inf "),
            ([f64::NEG_INFINITY, 0.5, 0.5], "-inf is below 0"),
        ] {
            let why = barycentric(weights).expect_err("no place").to_string();
            assert!(why.contains(words), "{why}");
        }
    }
}
