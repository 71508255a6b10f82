//! A triangle of the result, prepared for the distances of many points to it, its plane and its edges.

use crate::measure::closest_to_origin;
use crate::vector::{DVec3, unit_or_zero};

/// Triangles with a smaller sine of the angle between their first edges have no plane to speak of: rounding turns it by
/// up to 1e-16 over this.
const FLAT: f64 = 1e-7;

/// A triangle with what its distances need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    corners: [DVec3; 3],
    /// Unit vectors along the edges, zero where one has no length.
    along: [DVec3; 3],
    lengths: [f64; 3],
    /// Unit normal; zero for a triangle without area.
    normal: DVec3,
    /// In the plane, at right angles to the edges, pointing outwards.
    outward: [DVec3; 3],
    /// What is no farther outside an edge than this stands on it, but for rounding.
    on_edge: f64,
}

/// Distances below this part of a triangle's size are what rounding leaves of zero where points coincide.
const ROUNDING: f64 = 1e-12;

/// Where a point stands to an edge, within the triangle's plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beside {
    /// How far outside the edge's line; 0 inside.
    pub(crate) outside: f64,
    /// How far along the edge from its start.
    pub(crate) along: f64,
}

impl Facet {
    /// The triangle with those corners.
    pub(crate) fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let edges = [b - a, c - b, a - c];
        let along = edges.map(unit_or_zero);
        let normal = along[0].cross(along[1]);
        let normal = if normal.length_squared() > FLAT * FLAT { normal.normalize() } else { DVec3::ZERO };
        Self {
            corners,
            along,
            lengths: [0, 1, 2].map(|edge| edges[edge].dot(along[edge])),
            normal,
            outward: along.map(|edge| edge.cross(normal)),
            on_edge: ROUNDING
                * edges.iter().chain(&corners).map(|v| v.abs().max_element()).fold(0.0, f64::max),
        }
    }

    /// The unit normal; zero for a triangle without area.
    pub(crate) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Whether the triangle has no plane to speak of.
    pub(crate) fn is_flat(&self) -> bool {
        self.normal == DVec3::ZERO
    }

    /// Length of the edge from corner `edge`.
    pub(crate) fn length(&self, edge: usize) -> f64 {
        self.lengths[edge]
    }

    /// Height of a point over the plane.
    #[inline]
    pub(crate) fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.corners[0])
    }

    /// Where a point stands to the edge from corner `edge`.
    #[inline]
    pub(crate) fn beside(&self, edge: usize, point: DVec3) -> Beside {
        let offset = point - self.corners[edge];
        let outside = self.outward[edge].dot(offset);
        Beside {
            outside: if outside > self.on_edge { outside } else { 0.0 },
            along: self.along[edge].dot(offset),
        }
    }

    /// Squared distance of a point to the edge from corner `edge`.
    #[inline]
    pub(crate) fn squared_to_edge(&self, edge: usize, point: DVec3) -> f64 {
        let offset = point - self.corners[edge];
        let foot = offset.dot(self.along[edge]).clamp(0.0, self.lengths[edge]);
        (offset - foot * self.along[edge]).length_squared()
    }

    /// Squared distance of a point to the triangle.
    #[inline]
    pub(crate) fn squared(&self, point: DVec3) -> f64 {
        let inside = (0..3).all(|edge| self.outward[edge].dot(point - self.corners[edge]) <= 0.0);
        if inside && self.normal != DVec3::ZERO {
            let height = self.height(point);
            return height * height;
        }
        let [a, b, c] = self.corners.map(|corner| corner - point);
        closest_to_origin(a, b, c).squared
    }

    /// Tangent of the least angle; 0 for a triangle without area.
    pub(crate) fn least_slope(&self) -> f64 {
        let slope = |corner: usize| {
            let (out, back) = (self.along[corner], -self.along[(corner + 2) % 3]);
            let cosine = out.dot(back);
            if cosine <= 0.0 { f64::INFINITY } else { out.cross(back).length() / cosine }
        };
        slope(0).min(slope(1)).min(slope(2))
    }
}
