//! A triangle of the result, prepared for the distances of many points to it, its plane and its edges.

use super::exceeds;
use crate::geometry::closest_to_origin;
use crate::math;
use crate::vector::Extremes;
use crate::vector::{DVec3, unit_or_zero};

/// Triangles with a smaller sine of the angle between their first edges have no plane to speak of: rounding turns it by
/// up to 1e-16 over this.
const FLAT: f64 = 1e-7;

/// Triangles with a smaller sine are slivers, whose plane is straightened.
pub(super) const SLIVER: f64 = 1e-2;

/// Squared lengths between these neither overflow nor vanish in further computations.
const SAFE: core::ops::Range<f64> = 1e-140..1e140;

/// A triangle with the data for distances from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleFrame {
    corners: [DVec3; 3],
    /// Unit vectors along the edges, zero where one has no length.
    along: [DVec3; 3],
    lengths: [f64; 3],
    /// Unit normal; zero for a triangle without area.
    normal: DVec3,
    /// In the plane, at right angles to the edges, pointing outwards.
    outward: [DVec3; 3],
    /// A point no farther outside an edge than this is on it, within rounding.
    on_edge: f64,
    /// Where the edges' lines stand outwards of the first corner.
    offsets: [f64; 3],
    /// By corner, the tangent of its angle, or of an obtuse one's complement to π.
    tangents: [f64; 3],
    least_slope: f64,
}

/// The position of a point relative to an edge, within the triangle's plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgePosition {
    /// How far outside the edge's line; 0 inside.
    pub(crate) outside: f64,
    /// How far along the edge from its start.
    pub(crate) along: f64,
}

/// [`TriangleFrame::least_slope`] of a triangle without a frame.
#[inline]
pub(crate) fn least_slope([a, b, c]: [DVec3; 3]) -> f64 {
    let edges = [b - a, c - b, a - c];
    let product = |corner: usize| -edges[corner].dot(edges[(corner + 2) % 3]);
    edges[0].cross(edges[1]).length() / product(0).larger(product(1)).larger(product(2))
}

/// The greatest size of a coordinate.
#[inline]
fn greatest_coordinate<'a>(vectors: impl Iterator<Item = &'a DVec3>) -> f64 {
    let larger = |most: DVec3, v: &DVec3| {
        DVec3::new(
            most.x.larger(v.x.abs()),
            most.y.larger(v.y.abs()),
            most.z.larger(v.z.abs()),
        )
    };
    let most = vectors.fold(DVec3::ZERO, larger);
    most.x.larger(most.y).larger(most.z)
}

impl TriangleFrame {
    /// Distances below this part of the coordinates' size are within rounding where points
    /// coincide.
    pub(crate) const ROUNDING: f64 = 5e-14;

    /// The triangle with those corners.
    pub(crate) fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let edges = [b - a, c - b, a - c];
        let squares = edges.map(DVec3::length_squared);
        let (along, lengths) = if squares.iter().all(|square| SAFE.contains(square)) {
            let lengths = squares.map(f64::sqrt);
            ([0, 1, 2].map(|edge| edges[edge] / lengths[edge]), lengths)
        } else {
            let along = edges.map(unit_or_zero);
            (along, [0, 1, 2].map(|edge| edges[edge].dot(along[edge])))
        };
        let across = along[0].cross(along[1]);
        let sine = across.length();
        let mut normal = if sine > FLAT {
            across / sine
        } else {
            DVec3::ZERO
        };
        if sine < SLIVER && normal != DVec3::ZERO {
            // Rounding must not turn the normal of a sliver along its length.
            let longest = (1..3).fold(0, |longest, edge| {
                if lengths[edge] > lengths[longest] {
                    edge
                } else {
                    longest
                }
            });
            normal = unit_or_zero(normal - normal.dot(along[longest]) * along[longest]);
        }
        let outward = along.map(|edge| edge.cross(normal));
        let from_first = [DVec3::ZERO, edges[0], -edges[2]];
        // The tangent of an angle is the parallelogram's area over the product of its edges; the greatest product
        // belongs to the least angle.
        let cosine = |corner: usize| {
            let before = (corner + 2) % 3;
            -along[corner].dot(along[before]) * (lengths[corner] * lengths[before])
        };
        let area = sine * (lengths[0] * lengths[1]);
        let cosines = [0, 1, 2].map(cosine);
        Self {
            corners,
            along,
            lengths,
            normal,
            on_edge: Self::ROUNDING * greatest_coordinate(edges.iter().chain(&corners)),
            outward,
            offsets: [0, 1, 2].map(|edge| outward[edge].dot(from_first[edge])),
            // NaN allows nothing.
            tangents: cosines.map(|cosine| (area / cosine.abs()).max(0.0)),
            least_slope: area / cosines[0].larger(cosines[1]).larger(cosines[2]),
        }
    }

    /// The unit normal; zero for a triangle without area.
    pub(crate) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Whether all coordinates are numbers.
    pub(crate) fn is_finite(&self) -> bool {
        self.corners.iter().all(|corner| corner.is_finite())
    }

    /// Whether the triangle has no plane to speak of.
    pub(crate) fn is_flat(&self) -> bool {
        self.normal == DVec3::ZERO
    }

    /// Length of the edge from corner `edge`.
    pub(crate) fn length(&self, edge: usize) -> f64 {
        self.lengths[edge]
    }

    /// Unit vector along the edge from corner `edge`; zero where it has no length.
    #[inline]
    pub(crate) fn along(&self, edge: usize) -> DVec3 {
        self.along[edge]
    }

    /// Unit vector in the plane, at right angles to an edge, that points out of the triangle.
    #[inline]
    pub(crate) fn outward(&self, edge: usize) -> DVec3 {
        self.outward[edge]
    }

    /// Height of a point over the plane.
    #[inline]
    pub(crate) fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.corners[0])
    }

    /// The position of a point relative to the edge from corner `edge`.
    #[inline]
    pub(crate) fn edge_position(&self, edge: usize, point: DVec3) -> EdgePosition {
        let offset = point - self.corners[edge];
        let outside = self.outward[edge].dot(offset);
        EdgePosition {
            outside: if exceeds(outside, self.on_edge) {
                outside
            } else {
                0.0
            },
            along: self.along[edge].dot(offset),
        }
    }

    /// Squared distance of a point to the edge from corner `edge`.
    #[inline]
    pub(crate) fn squared_to_edge(&self, edge: usize, point: DVec3) -> f64 {
        let offset = point - self.corners[edge];
        let along = offset
            .dot(self.along[edge])
            .max(0.0)
            .min(self.lengths[edge]);
        (offset - along * self.along[edge]).length_squared()
    }

    /// Squared distance of a point to the triangle.
    #[inline]
    pub(crate) fn squared(&self, point: DVec3) -> f64 {
        if !point.is_finite() {
            return f64::INFINITY;
        }
        let inside = (0..3).all(|edge| self.outward[edge].dot(point - self.corners[edge]) <= 0.0);
        if inside && self.normal != DVec3::ZERO {
            let height = self.height(point);
            return height * height;
        }
        let [a, b, c] = self.corners.map(|corner| corner - point);
        closest_to_origin(a, b, c).squared
    }

    /// Tangent of the least angle; 0 or NaN for a triangle without area.
    #[inline]
    pub(crate) fn least_slope(&self) -> f64 {
        self.least_slope
    }

    /// Tangent of the lesser of the angles at an edge, or of an obtuse one's complement to π: a
    /// curve that leaves the edge by less than this from either end crosses no line of another
    /// edge.
    #[inline]
    pub(crate) fn slope_at(&self, edge: usize) -> f64 {
        self.tangents[edge].min(self.tangents[(edge + 1) % 3])
    }

    /// The squared length of a vector's part within the plane, in the metric in which the triangle has three edges of length 1: half
    /// the sum of the squares by which the vector changes barycentric coordinates.
    #[inline]
    pub(super) fn stretched_squared(&self, vector: DVec3) -> f64 {
        let changes = [0, 1, 2].map(|edge| self.outward[edge].dot(vector) * self.lengths[edge]);
        0.5 * changes.iter().map(|change| change * change).sum::<f64>()
            / math::powi(self.parallelogram(), 2)
    }

    /// The greatest stretch by that metric of lengths within the plane. It follows from the
    /// barycentric gradients' squares, whose sum is twice the trace of the metric, and from the
    /// areas of both triangles, whose ratio is the root of its determinant.
    #[inline]
    pub(super) fn stretch(&self) -> f64 {
        let square = math::powi(self.parallelogram(), 2);
        let half_trace = 0.25
            * self
                .lengths
                .iter()
                .map(|length| length * length)
                .sum::<f64>()
            / square;
        let determinant = 0.75 / square;
        (half_trace + (half_trace * half_trace - determinant).max(0.0).sqrt()).sqrt()
    }

    /// The height of the corner opposite over an edge.
    #[inline]
    pub(super) fn altitude(&self, edge: usize) -> f64 {
        self.parallelogram() / self.lengths[edge]
    }

    /// Twice the area.
    #[inline]
    fn parallelogram(&self) -> f64 {
        self.offsets[1] * self.lengths[1]
    }

    /// A point no farther outside an edge than this is on it, within rounding.
    pub(crate) fn on_edge(&self) -> f64 {
        self.on_edge
    }

    /// The first corner.
    pub(crate) fn first(&self) -> DVec3 {
        self.corners[0]
    }

    /// Where an edge's line stands outwards of the first corner.
    pub(crate) fn offset(&self, edge: usize) -> f64 {
        self.offsets[edge]
    }
}
