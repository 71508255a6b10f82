//! The little of vectors that reports need.

use std::ops::Range;

/// `a` − `b`.
pub(crate) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// The first three numbers of a channel's value, such as a normal.
pub(crate) fn vector(value: &[f64]) -> [f64; 3] {
    [value[0], value[1], value[2]]
}

/// The scalar product.
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Squares between these have lost nothing that counts.
const SAFE: Range<f64> = 1e-280..1e300;

/// The length, without overflow on the way.
pub(crate) fn length(a: [f64; 3]) -> f64 {
    let squared = dot(a, a);
    if SAFE.contains(&squared) {
        squared.sqrt()
    } else {
        a[0].hypot(a[1]).hypot(a[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_of_any_size_have_a_length() {
        for size in [0.0, 5e-324, 1e-200, 1.0, 3.7e149, 1e200] {
            let (found, expected) = (length([2.0 * size, -3.0 * size, 6.0 * size]), 7.0 * size);
            assert!(
                (found - expected).abs() <= 1e-15 * expected,
                "{size}: {found}"
            );
        }
        assert!(length([f64::NAN, 1.0, 1.0]).is_nan());
        assert_eq!(length([f64::NEG_INFINITY, 1.0, 1.0]), f64::INFINITY);
    }
}
