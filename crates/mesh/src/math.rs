//! Elementary functions, the same to the bit on every platform.
//!
//! The standard library leaves sine, logarithm and the like to the platform, and platforms round them differently: a
//! mesh refined in a browser would differ from the same mesh refined by the program. These are of the crate `libm`
//! everywhere. What the standard library rounds correctly, such as square roots, needs no place here.

pub use libm::{
    acos, asin, atan, atan2, cos, exp2, hypot, log as ln, log2, pow as powf, sin,
    sincos as sin_cos, tan,
};

/// The logarithm of `x` to a base.
#[inline]
pub fn log(x: f64, base: f64) -> f64 {
    ln(x) / ln(base)
}

/// A whole power of `x`, by squaring.
#[inline]
pub fn powi(mut x: f64, exponent: i32) -> f64 {
    let mut left = exponent.unsigned_abs();
    let mut power = 1.0;
    loop {
        if left & 1 == 1 {
            power *= x;
        }
        left >>= 1;
        if left == 0 {
            break;
        }
        x *= x;
    }
    if exponent < 0 { 1.0 / power } else { power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_and_logarithms_of_two_are_exact() {
        for exponent in [-1022, -3, -1, 0, 1, 2, 5, 1023] {
            let power = powi(2.0, exponent);
            assert_eq!(power, f64::from_bits(((1023 + exponent) as u64) << 52));
            assert_eq!(log2(power), f64::from(exponent));
            assert_eq!(exp2(f64::from(exponent)), power);
        }
        assert_eq!(powi(-3.0, 3), -27.0);
        assert!((log(81.0, 3.0) - 4.0).abs() < 1e-15);
    }

    #[test]
    fn functions_are_those_of_the_platform_but_for_rounding() {
        let near = |ours: f64, theirs: f64| {
            (ours - theirs).abs() <= 4.0 * f64::EPSILON * theirs.abs().max(1.0)
        };
        for step in -50..=50 {
            let x = f64::from(step) / 51.0;
            assert!(near(sin(x), x.sin()) && near(cos(x), x.cos()) && near(tan(x), x.tan()));
            assert!(near(asin(x), x.asin()) && near(acos(x), x.acos()) && near(atan(x), x.atan()));
            assert!(near(atan2(x, 0.3), x.atan2(0.3)) && near(hypot(x, 0.3), x.hypot(0.3)));
            assert!(
                near(powf(2.0 + x, 1.7), (2.0 + x).powf(1.7)) && near(ln(2.0 + x), (2.0 + x).ln())
            );
            assert_eq!(sin_cos(x), (sin(x), cos(x)));
        }
    }
}
