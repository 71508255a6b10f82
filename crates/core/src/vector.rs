//! Conversions between the public `[f64; 3]` and the vector type used inside.

pub(crate) use glam::DVec3;

/// A point or vector from its public form.
#[inline]
pub(crate) fn vector(a: [f64; 3]) -> DVec3 {
    DVec3::from_array(a)
}

/// The unit vector along `v`, for any size of `v` that is finite; zero where it has no direction.
#[inline]
pub(crate) fn unit_or_zero(v: DVec3) -> DVec3 {
    let squared = v.length_squared();
    if (1e-200..1e200).contains(&squared) {
        return v / squared.sqrt();
    }
    // Scaled first: squares of very large or small coordinates overflow or vanish.
    let greatest = v.abs().max_element();
    if greatest > 0.0 && greatest.is_finite() { (v / greatest).normalize_or_zero() } else { DVec3::ZERO }
}
