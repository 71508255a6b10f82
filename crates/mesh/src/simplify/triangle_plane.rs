//! A triangle prepared for many distances to it.
//!
//! A point straight above the triangle is measured along its normal, others to its nearest side.

use crate::vector::DVec3;

/// A triangle with its unit normal and the gradients of two of its barycentric coordinates.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    pub(super) corners: [DVec3; 3],
    pub(super) normal: DVec3,
    along: [DVec3; 2],
    /// Twice the area over the squared length of the longest side: 0.87 for an equilateral triangle, 0 for a sliver.
    pub(super) shape: f64,
}

impl Plane {
    /// `None` where the corners do not span a plane.
    #[inline]
    pub(crate) fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let (ab, ac) = (b - a, c - a);
        let cross = ab.cross(ac);
        let squared = cross.length_squared();
        let longest = ab
            .length_squared()
            .max(ac.length_squared())
            .max((c - b).length_squared());
        // Rounding has eaten up the direction of the normal of a triangle thinner than this.
        if squared.is_nan() || squared <= 1e-24 * longest * longest {
            return None;
        }
        let inverse = 1.0 / squared;
        let area = squared.sqrt();
        Some(Self {
            corners,
            normal: cross / area,
            along: [ac.cross(cross) * inverse, cross.cross(ab) * inverse],
            shape: area / longest,
        })
    }

    /// The distance of `point` if it is straight above or below the triangle.
    #[inline]
    pub(super) fn height(&self, point: DVec3) -> Option<f64> {
        let from = point - self.corners[0];
        let (b, c) = (from.dot(self.along[0]), from.dot(self.along[1]));
        // A little slack: a point between two triangles is above one of them in spite of rounding.
        const SLACK: f64 = 1e-9;
        let above = b >= -SLACK && c >= -SLACK && b + c <= 1.0 + SLACK;
        above.then(|| from.dot(self.normal).abs())
    }

    /// The distance of `point` from a point of the triangle, the nearest within rounding.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        let from = point - a;
        let (v, w) = (from.dot(self.along[0]), from.dot(self.along[1]));
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            let projection = a * (1.0 - v - w) + b * v + c * w;
            return point.distance(projection);
        }
        self.squared_to_sides(point).sqrt()
    }

    /// The mean of the corners.
    pub(super) fn centroid(&self) -> DVec3 {
        (self.corners[0] + self.corners[1] + self.corners[2]) / 3.0
    }

    /// The squared distance of `point` to the nearest side.
    pub(super) fn squared_to_sides(&self, point: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        squared_to_segment(point, a, b)
            .min(squared_to_segment(point, b, c))
            .min(squared_to_segment(point, c, a))
    }
}

/// The squared distance of a point to a segment.
#[inline]
pub(super) fn squared_to_segment(point: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (along, from) = (b - a, point - a);
    let squared = along.length_squared();
    let t = if squared > 0.0 {
        (from.dot(along) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from - along * t).length_squared()
}

/// The distance of `point` to the nearest of some triangles, and which one that is.
#[inline]
pub(super) fn nearest(planes: &[Plane], point: DVec3) -> (f64, usize) {
    let mut best = (f64::INFINITY, 0);
    for (i, plane) in planes.iter().enumerate() {
        if let Some(height) = plane.height(point)
            && height < best.0
        {
            best = (height, i);
        }
    }
    if best.0 == f64::INFINITY {
        nearest_side(planes, point)
    } else {
        best
    }
}

/// The nearest side for a point that is above none of them.
#[cold]
fn nearest_side(planes: &[Plane], point: DVec3) -> (f64, usize) {
    let mut best = (f64::INFINITY, 0);
    for (i, plane) in planes.iter().enumerate() {
        let squared = plane.squared_to_sides(point);
        if squared < best.0 {
            best = (squared, i);
        }
    }
    (best.0.sqrt(), best.1)
}
