//! Conversions between the public `[f64; 3]` and the vector type used inside.

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Sub, SubAssign};

pub use glam::DVec3;

/// Values that can be blended: points, or some of their coordinates.
pub trait Blend:
    Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + SubAssign
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
}

impl Blend for DVec3 {}

/// The first coordinates of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates<const AXES: usize>(pub [f64; AXES]);

impl<const AXES: usize> Coordinates<AXES> {
    /// The coordinates of a point in space, of which there are at most 3.
    #[inline]
    pub fn of(point: DVec3) -> Self {
        Self(from_fn(|axis| point[axis]))
    }
}

impl<const AXES: usize> Blend for Coordinates<AXES> {}

impl<const AXES: usize> Default for Coordinates<AXES> {
    fn default() -> Self {
        Self([0.0; AXES])
    }
}

impl<const AXES: usize> Add for Coordinates<AXES> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self(from_fn(|axis| self.0[axis] + other.0[axis]))
    }
}

impl<const AXES: usize> Sub for Coordinates<AXES> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|axis| self.0[axis] - other.0[axis]))
    }
}

impl<const AXES: usize> SubAssign for Coordinates<AXES> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const AXES: usize> Mul<f64> for Coordinates<AXES> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

impl<const AXES: usize> Div<f64> for Coordinates<AXES> {
    type Output = Self;

    #[inline]
    fn div(self, divisor: f64) -> Self {
        Self(self.0.map(|x| x / divisor))
    }
}

/// A point or vector from its public form.
#[inline]
pub fn vector(a: [f64; 3]) -> DVec3 {
    DVec3::from_array(a)
}

/// The unit vector along `v`, for any size of `v` that is finite; zero where it has no direction.
#[inline]
pub fn unit_or_zero(v: DVec3) -> DVec3 {
    let squared = v.length_squared();
    if (1e-200..1e200).contains(&squared) {
        return v / squared.sqrt();
    }
    // Scaled first: squares of very large or small coordinates overflow or vanish.
    let greatest = v.abs().max_element();
    if greatest > 0.0 && greatest.is_finite() {
        (v / greatest).normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}

/// `√(a² + b²)`, also where squares vanish or overflow. Unlike the system's library, it gives the
/// same bytes everywhere, and takes a few instructions.
#[inline]
pub fn hypotenuse(a: f64, b: f64) -> f64 {
    let squared = a * a + b * b;
    if squared > 1e-280 && squared < 1e300 {
        squared.sqrt()
    } else {
        hypotenuse_of_any(a.abs(), b.abs())
    }
}

#[cold]
fn hypotenuse_of_any(a: f64, b: f64) -> f64 {
    let most = a.max(b);
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if most == 0.0 || most.is_infinite() {
        most
    } else {
        let (a, b) = (a / most, b / most);
        most * (a * a + b * b).sqrt()
    }
}

/// Comparisons of numbers by one instruction each: NaN is neither larger nor smaller than anything.
/// `f64::max` ignores NaN in either argument, which takes five.
pub trait Extremes {
    /// `other` if that is larger.
    fn larger(self, other: Self) -> Self;
    /// `other` if that is smaller.
    fn smaller(self, other: Self) -> Self;
}

macro_rules! extremes {
    ($($number:ty),*) => {$(
        impl Extremes for $number {
            #[inline]
            fn larger(self, other: Self) -> Self {
                if other > self { other } else { self }
            }

            #[inline]
            fn smaller(self, other: Self) -> Self {
                if other < self { other } else { self }
            }
        }
    )*};
}

extremes!(f64, f32);

/// The unit normal of a triangle of any size; zero where it has no area.
#[inline]
pub fn unit_normal(corners: [DVec3; 3]) -> DVec3 {
    unit_or_zero(normal(corners))
}

/// A normal of a triangle of any size, of any length; zero where it has no area.
#[inline]
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    // Scaled first: areas of very large or small triangles overflow or vanish.
    let size = ab.abs().max(ac.abs()).max_element();
    if size > 0.0 {
        (ab / size).cross(ac / size)
    } else {
        DVec3::ZERO
    }
}

/// The length of a box's diagonal, for any size whose length is finite.
pub fn diagonal(low: DVec3, high: DVec3) -> f64 {
    let sides = high - low;
    let length = sides.length();
    if (1e-150..1e150).contains(&length) {
        return length;
    }
    // Scaled first: squares of very large or small sides overflow or vanish.
    let greatest = sides.max_element();
    if greatest > 0.0 && greatest.is_finite() {
        greatest * (sides / greatest).length()
    } else {
        length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonals_of_any_size_have_a_length() {
        for size in [1e-310, 1e-200, 1.0, 1e200, 1e307] {
            let length = diagonal(DVec3::splat(-size), DVec3::new(2.0, 5.0, -1.0) * size);
            assert!(
                (length / size - 45f64.sqrt()).abs() < 1e-9,
                "{size}: {length}"
            );
        }
        assert_eq!(diagonal(DVec3::ONE, DVec3::ONE), 0.0);
    }
}
