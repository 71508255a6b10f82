//! The point of a triangle closest to the origin, in double precision, for any triangle: slivers, needles and
//! triangles without area included.
//!
//! The Voronoi regions of the triangle's corners, sides and inside are distinguished by the signs
//! of dot products (Ericson, Real-Time Collision Detection, section 5.1.5). Their products of
//! products lose too many digits on slivers and far away from small triangles; there the three
//! sides are measured one by one and the inside through the triangle's normal.

use crate::math;
use crate::vector::DVec3;

/// The closest point as a convex combination of the corners, and its squared distance from the origin.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Weights of the corners: none negative, their sum 1.
    pub weights: [f64; 3],
    /// Squared distance.
    pub squared: f64,
}

/// The region tests are trusted where the squared sine of the triangle, as seen against the greater of its size
/// and its distance, exceeds this: their relative error, some 1e-16 divided by this value, is then below 1e-9
/// of the height, and its effect on the distance below rounding.
const WELL_SHAPED: f64 = 1e-7;

/// The projection with these corner weights.
#[inline]
fn projection(weights: [f64; 3], at: DVec3) -> Projection {
    Projection {
        weights,
        squared: at.length_squared(),
    }
}

/// The point of triangle `a`, `b`, `c` closest to the origin.
#[inline]
pub fn closest_to_origin(a: DVec3, b: DVec3, c: DVec3) -> Projection {
    let (ab, ac) = (b - a, c - a);
    let (ab_a, ac_a) = (-ab.dot(a), -ac.dot(a));
    if ab_a <= 0.0 && ac_a <= 0.0 {
        return projection([1.0, 0.0, 0.0], a);
    }
    let (ab_b, ac_b) = (-ab.dot(b), -ac.dot(b));
    if ab_b >= 0.0 && ac_b <= ab_b {
        return projection([0.0, 1.0, 0.0], b);
    }
    let (ab_c, ac_c) = (-ab.dot(c), -ac.dot(c));
    if ac_c >= 0.0 && ab_c <= ac_c {
        return projection([0.0, 0.0, 1.0], c);
    }
    let size = ab.length_squared() + ac.length_squared();
    let reach = a.length_squared() + b.length_squared() + c.length_squared();
    let normal = ab.cross(ac);
    let well_shaped = normal.length_squared() > WELL_SHAPED * size * reach;
    if !well_shaped {
        return closest_by_parts(a, b, c);
    }
    let weight_c = ab_a * ac_b - ab_b * ac_a;
    if weight_c <= 0.0 && ab_a >= 0.0 && ab_b <= 0.0 {
        let t = ab_a / (ab_a - ab_b);
        return projection([1.0 - t, t, 0.0], a + ab * t);
    }
    let weight_b = ab_c * ac_a - ab_a * ac_c;
    if weight_b <= 0.0 && ac_a >= 0.0 && ac_c <= 0.0 {
        let t = ac_a / (ac_a - ac_c);
        return projection([1.0 - t, 0.0, t], a + ac * t);
    }
    let weight_a = ab_b * ac_c - ab_c * ac_b;
    let (from_b, from_c) = (ac_b - ab_b, ab_c - ac_c);
    if weight_a <= 0.0 && from_b >= 0.0 && from_c >= 0.0 {
        let t = from_b / (from_b + from_c);
        return projection([0.0, 1.0 - t, t], b + (c - b) * t);
    }
    // Inside, the distance is that to the plane: it has more digits than the difference of the weighted corners.
    let sum = weight_a + weight_b + weight_c;
    let height = a.dot(normal);
    Projection {
        weights: [weight_a / sum, weight_b / sum, weight_c / sum],
        squared: height * height / normal.length_squared(),
    }
}

/// The lesser of a squared distance and that of triangle `a`, `b`, `c` from the origin; most triangles are too far away for their box
/// already.
#[inline]
pub fn nearer(least: f64, [a, b, c]: [DVec3; 3]) -> f64 {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    if low.max(-high).max(DVec3::ZERO).length_squared() < least {
        return least.min(closest_to_origin(a, b, c).squared);
    }
    least
}

/// The closest point of triangles whose region tests cannot be trusted: the best of the three sides and the inside.
#[cold]
fn closest_by_parts(a: DVec3, b: DVec3, c: DVec3) -> Projection {
    let mut best = projection([1.0, 0.0, 0.0], a);
    let mut offer = |candidate: Projection| {
        if candidate.squared < best.squared {
            best = candidate;
        }
    };
    for (from, to, slots) in [(a, b, [0, 1]), (b, c, [1, 2]), (c, a, [2, 0])] {
        let t = along_segment(from, to);
        let mut weights = [0.0; 3];
        weights[slots[0]] = 1.0 - t;
        weights[slots[1]] = t;
        offer(projection(weights, from + (to - from) * t));
    }
    let normal = (b - a).cross(c - a);
    let weight_a = normal.dot((c - b).cross(-b));
    let weight_b = normal.dot((a - c).cross(-c));
    let weight_c = normal.dot((b - a).cross(-a));
    let sum = weight_a + weight_b + weight_c;
    if weight_a >= 0.0 && weight_b >= 0.0 && weight_c >= 0.0 && sum > 0.0 {
        let weights = [weight_a / sum, weight_b / sum, weight_c / sum];
        if weights.iter().all(|w| w.is_finite()) {
            offer(projection(
                weights,
                a * weights[0] + b * weights[1] + c * weights[2],
            ));
        }
    }
    best
}

/// Where on the segment the point closest to the origin lies: 0 at `from`, 1 at `to`.
fn along_segment(from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let (numerator, denominator) = (-from.dot(along), along.length_squared());
    if numerator > 0.0 && denominator > 0.0 {
        (numerator / denominator).min(1.0)
    } else {
        0.0
    }
}
/// The solid angle of a triangle as seen from a point (Van Oosterom and Strackee 1983): above 0 where its corners run clockwise
/// from there, as those of a closed surface around the point do, whose angles add up to 4π.
pub fn solid_angle(corners: [DVec3; 3], from: DVec3) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - from);
    let [la, lb, lc] = [a, b, c].map(DVec3::length);
    let across = a.dot(b.cross(c));
    let along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * math::atan2(across, along)
}
