//! Conversions between the public `[f64; 3]` and the vector type used inside.

pub(crate) use glam::DVec3;

/// A point or vector from its public form.
#[inline]
pub(crate) fn vector(a: [f64; 3]) -> DVec3 {
    DVec3::from_array(a)
}

/// The unit vector along `v`, or zero where `v` has no direction.
#[inline]
pub(crate) fn unit_or_zero(v: DVec3) -> DVec3 {
    v.normalize_or_zero()
}
