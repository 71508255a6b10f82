//! Points on one line.

use glam::Vec3Swizzles;

use crate::vector::vector;

/// Sides of lengths within these bounds have a cross product that neither overflows nor vanishes.
const MIDDLING: core::ops::Range<f64> = 1e-120..1e120;

/// Powers of two that bring the least and the greatest lengths there: 2⁶⁰⁰ and 2⁻⁶⁰⁰.
const MAGNIFIED: f64 = 4.149_515_568_880_993e180;
const REDUCED: f64 = 1.0 / MAGNIFIED;

/// Whether three points lie on one line within rounding: the cross product of two sides is no
/// larger than its rounding error. Points are in any unit; equal ones lie on a line with every
/// other.
pub fn are_on_one_line(points: [[f64; 3]; 3]) -> bool {
    // Each factor carries half an ulp from its subtraction, the product and the difference half an ulp each:
    // below 2.5 ulp together, rounded up to 4.
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    let sides = |scale: f64| {
        let [a, b, c] = points.map(|point| vector(point) * scale);
        (b - a, c - a)
    };
    let (u, v) = sides(1.0);
    let size = u.abs().max(v.abs()).max_element();
    let (u, v) = match size {
        0.0 => return true,
        size if size < MIDDLING.start => sides(MAGNIFIED),
        size if size > MIDDLING.end => sides(REDUCED),
        _ => (u, v),
    };
    let (left, right) = (u.yzx() * v.zxy(), u.zxy() * v.yzx());
    let bound = (left.abs() + right.abs()) * ROUNDING;
    (left - right).abs().cmple(bound).all()
}
