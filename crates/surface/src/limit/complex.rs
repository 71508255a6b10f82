//! Complex numbers.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Complex {
    pub(super) re: f64,
    pub(super) im: f64,
}

impl Complex {
    pub(super) const ZERO: Self = Self::new(0.0, 0.0);

    pub(super) const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    pub(super) fn conj(self) -> Self {
        Self::new(self.re, -self.im)
    }

    pub(super) fn modulus_squared(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    pub(super) fn modulus(self) -> f64 {
        self.modulus_squared().sqrt()
    }

    /// The square root with a real part that is not negative.
    pub(super) fn sqrt(self) -> Self {
        let modulus = self.modulus();
        let greater = ((modulus + self.re.abs()) / 2.0).sqrt();
        if greater == 0.0 {
            return Self::ZERO;
        }
        let smaller = self.im / (2.0 * greater);
        if self.re >= 0.0 {
            Self::new(greater, smaller)
        } else {
            Self::new(smaller.abs(), greater.copysign(self.im))
        }
    }
}

impl From<f64> for Complex {
    fn from(re: f64) -> Self {
        Self::new(re, 0.0)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.re * other.re - self.im * other.im,
            self.re * other.im + self.im * other.re,
        )
    }
}

impl Mul<f64> for Complex {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }
}

impl Div<f64> for Complex {
    type Output = Self;
    fn div(self, divisor: f64) -> Self {
        Self::new(self.re / divisor, self.im / divisor)
    }
}

/// By R. L. Smith, *Algorithm 116: Complex division*, 1962: real numbers are divided with one rounding.
impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let Self { re: a, im: b } = self;
        if other.re.abs() >= other.im.abs() {
            let ratio = other.im / other.re;
            let divisor = other.re + other.im * ratio;
            Self::new((a + b * ratio) / divisor, (b - a * ratio) / divisor)
        } else {
            let ratio = other.re / other.im;
            let divisor = other.re * ratio + other.im;
            Self::new((a * ratio + b) / divisor, (b * ratio - a) / divisor)
        }
    }
}

impl AddAssign for Complex {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Complex {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
