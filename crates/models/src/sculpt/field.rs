//! Fields to sculpt from: round primitives and smooth combinations of them.
//!
//! Each takes a point and gives a signed value, negative inside and close to the distance near the surface.

use glam::DVec3;

/// A point, written short because bodies are tables of them.
pub(crate) const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// `p` with its x made positive: the other side of a symmetric body.
pub(crate) fn fold(p: DVec3) -> DVec3 {
    DVec3::new(p.x.abs(), p.y, p.z)
}

/// A ball.
pub(crate) fn ball(p: DVec3, centre: DVec3, radius: f64) -> f64 {
    p.distance(centre) - radius
}

/// An ellipsoid with the given semi-axes, scaled so that the value is a distance to first order.
pub(crate) fn ellipsoid(p: DVec3, centre: DVec3, axes: DVec3) -> f64 {
    let scaled = (p - centre) / axes;
    let gradient = (scaled / axes).length();
    let level = scaled.length();
    if gradient > 0.0 {
        level * (level - 1.0) / gradient
    } else {
        -axes.min_element()
    }
}

/// A rod from `a` to `b` whose radius runs linearly from `radius_a` to `radius_b`, with round ends.
pub(crate) fn rod(p: DVec3, a: DVec3, radius_a: f64, b: DVec3, radius_b: f64) -> f64 {
    let axis = b - a;
    let along = ((p - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    p.distance(a + axis * along) - (radius_a + (radius_b - radius_a) * along)
}

/// A chain of rods through points with radii, blended at the joints by `blend`.
pub(crate) fn limb(p: DVec3, joints: &[(DVec3, f64)], blend: f64) -> f64 {
    joints.windows(2).fold(f64::INFINITY, |value, pair| {
        union(
            value,
            rod(p, pair[0].0, pair[0].1, pair[1].0, pair[1].1),
            blend,
        )
    })
}

/// A flat blade: the convex polygon with `corners` (counter-clockwise, in the coordinates `u`, `v`), as thick as
/// twice `half_thickness` across, its edges rounded by `blend`.
pub(crate) fn blade(
    [u, v, across]: [f64; 3],
    corners: &[[f64; 2]],
    half_thickness: f64,
    blend: f64,
) -> f64 {
    let mut value = across.abs() - half_thickness;
    for (i, [u0, v0]) in corners.iter().enumerate() {
        let [u1, v1] = corners[(i + 1) % corners.len()];
        let (along_u, along_v) = (u1 - u0, v1 - v0);
        let length = (along_u * along_u + along_v * along_v).sqrt();
        let outside = ((u - u0) * along_v - (v - v0) * along_u) / length;
        value = intersection(value, outside, blend);
    }
    value
}

/// Smooth union: where the two values differ by less than `blend`, a fillet (quadratic polynomial minimum).
pub(crate) fn union(a: f64, b: f64, blend: f64) -> f64 {
    let low = a.min(b);
    let overlap = blend - (a - b).abs();
    if overlap > 0.0 {
        low - overlap * overlap / (4.0 * blend)
    } else {
        low
    }
}

/// Smooth intersection.
pub(crate) fn intersection(a: f64, b: f64, blend: f64) -> f64 {
    -union(-a, -b, blend)
}

/// What is in `a` and not in `b`, with a rounded edge.
pub(crate) fn difference(a: f64, b: f64, blend: f64) -> f64 {
    intersection(a, -b, blend)
}
