//! Points relative to a triangle: the height over its plane, and the trilinear coordinates, the
//! distances of the point's projection from the lines of the edges, positive outside.
//!
//! All four are affine functions of the point. So combinations of points with weights whose sum is
//! 1 (refinements, nets, halves) can be made of these four numbers instead, in registers, and a
//! bound reads them at once. Its other values follow from the trilinear coordinates o₀, o₁, o₂,
//! edge e running along tₑ from the triangle's angle αₑ to the next:
//!
//! * the distance along edge e of the base point from its start: −(oₑ₋₁ + oₑ cos αₑ)/sin αₑ, for
//!   oₑ₋₁ falls by sin αₑ for each unit along the edge and by cos αₑ for each unit outwards, and
//!   vanishes at the start;
//! * the squared length of a vector: h² + Σ wₑoₑ² with wₑ = cos γₑ/(sin αₑ sin αₑ₊₁), γₑ being the angle opposite to the edge. For vectors along two
//!   edges j ≠ k the sum's bilinear form is wᵢ oᵢ(tⱼ) oᵢ(tₖ), as the other two terms vanish, and has to be tⱼ · tₖ.
//!
//! Both lose digits as angles get small, so triangles that lose more than rounding is given are left to points in space.

use super::exceeds;
use super::triangle_frame::{EdgePosition, SLIVER, TriangleFrame};
use crate::vector::{Blend, DVec3};
use core::ops::{Add, Div, Mul, Sub, SubAssign};
use wide::f64x4;

/// The squares of trilinear coordinates count at most this many times in a squared length:
/// cancellation leaves less than [`TriangleFrame::ROUNDING`].
const MOST_LOST: f64 = 128.0;

/// A point's height and trilinear coordinates, or the differences of two points'.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Trilinear(pub(super) f64x4);

/// A triangle without too small angles, prepared for points that are seen from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrilinearFrame {
    /// The first corner.
    origin: DVec3,
    pub(super) lengths: [f64; 3],
    /// As in [`TriangleFrame::on_edge`] and [`TriangleFrame::slope_at`].
    pub(super) on_edge: f64,
    pub(super) slopes: [f64; 3],
    /// The weights of a point's coordinates, by axis, and the constant that is subtracted.
    axes: [f64x4; 3],
    offsets: f64x4,
    /// Of the squares in a squared length.
    squares: f64x4,
    /// By edge, the weights of the trilinear coordinates of the edge before and of its own in the
    /// position along it.
    along: [[f64; 2]; 3],
}

impl TrilinearFrame {
    /// The frame of a triangle; `None` if too many digits would be lost, or it is not of numbers.
    pub(super) fn of(triangle: &TriangleFrame) -> Option<Self> {
        let (up, outward) = (
            triangle.normal(),
            [0, 1, 2].map(|edge| triangle.outward(edge)),
        );
        let along = [0, 1, 2].map(|edge| triangle.along(edge));
        // By corner, of the edges that meet there.
        let sines = [0, 1, 2].map(|corner| -outward[(corner + 2) % 3].dot(along[corner]));
        if !sines.iter().all(|&sine| sine > SLIVER) || triangle.is_flat() {
            return None;
        }
        let cosines = [0, 1, 2].map(|corner| -along[(corner + 2) % 3].dot(along[corner]));
        let lanes = |of: fn(DVec3) -> f64| {
            let [a, b, c] = outward.map(of);
            f64x4::new([of(up), a, b, c])
        };
        let [a, b, c] = [0, 1, 2].map(|edge| triangle.offset(edge));
        let weights =
            [0, 1, 2].map(|edge| cosines[(edge + 2) % 3] / (sines[edge] * sines[(edge + 1) % 3]));
        if !weights.iter().all(|weight| weight.abs() <= MOST_LOST) {
            return None;
        }
        let [u, v, w] = weights;
        Some(Self {
            origin: triangle.first(),
            lengths: [0, 1, 2].map(|edge| triangle.length(edge)),
            on_edge: triangle.on_edge(),
            slopes: [0, 1, 2].map(|edge| triangle.slope_at(edge)),
            axes: [lanes(|v| v.x), lanes(|v| v.y), lanes(|v| v.z)],
            offsets: f64x4::new([0.0, a, b, c]),
            squares: f64x4::new([1.0, u, v, w]),
            along: [0, 1, 2].map(|edge| {
                let share = -1.0 / sines[edge];
                [share, share * cosines[edge]]
            }),
        })
    }

    /// A point.
    #[inline(always)]
    pub(super) fn see(&self, point: DVec3) -> Trilinear {
        let offset = point - self.origin;
        let [x, y, z] = self.axes;
        Trilinear(x * offset.x + y * offset.y + z * offset.z - self.offsets)
    }

    /// The squared length of a difference.
    #[inline]
    pub(super) fn length_squared(&self, Trilinear(difference): Trilinear) -> f64 {
        (difference * difference * self.squares).reduce_add()
    }

    /// The weights of the distances from the lines of the edge before and of an edge itself in the
    /// position along that.
    #[inline]
    pub(super) fn shares_along(&self, edge: usize) -> [f64; 2] {
        self.along[edge]
    }
}

impl Trilinear {
    /// The height, and the distances from the lines of the edges.
    #[inline]
    pub(super) fn split(self) -> (f64, [f64; 3]) {
        let [height, a, b, c] = self.0.to_array();
        (height, [a, b, c])
    }

    /// The position of the projection relative to an edge.
    pub(super) fn edge_position(self, frame: &TrilinearFrame, edge: usize) -> EdgePosition {
        let (_, outside) = self.split();
        let own = outside[edge];
        let [by_before, by_own] = frame.shares_along(edge);
        let along = by_before * outside[(edge + 2) % 3] + by_own * own;
        EdgePosition {
            outside: if exceeds(own, frame.on_edge) {
                own
            } else {
                0.0
            },
            along,
        }
    }

    fn is_finite(self) -> bool {
        self.0.to_array().iter().all(|number| number.is_finite())
    }

    /// The squared distance to an edge; infinite for NaN.
    pub(super) fn squared_to_edge(self, frame: &TrilinearFrame, edge: usize) -> f64 {
        if !self.is_finite() {
            return f64::INFINITY;
        }
        let (height, outside) = self.split();
        let along = self.edge_position(frame, edge).along;
        let beyond = (-along).max(along - frame.lengths[edge]).max(0.0);
        height * height + outside[edge] * outside[edge] + beyond * beyond
    }

    /// The squared distance to the triangle; infinite for NaN.
    pub(super) fn squared(self, frame: &TrilinearFrame) -> f64 {
        if !self.is_finite() {
            return f64::INFINITY;
        }
        let (height, outside) = self.split();
        if outside.iter().all(|&outside| outside <= 0.0) {
            return height * height;
        }
        [0, 1, 2]
            .map(|edge| self.squared_to_edge(frame, edge))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }
}

impl Blend for Trilinear {}

impl Add for Trilinear {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Trilinear {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl SubAssign for Trilinear {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

impl Mul<f64> for Trilinear {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl Div<f64> for Trilinear {
    type Output = Self;

    #[inline(always)]
    fn div(self, divisor: f64) -> Self {
        // Divisors are constants, and quotients take ten times as long as products.
        Self(self.0 * (1.0 / divisor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The coordinates of a point agree with the triangle in space, whatever its shape.
    #[test]
    fn what_is_asked_of_a_point_is_what_it_is_in_space() {
        let mut count = 0.0;
        let mut vector = || {
            let mut number = || {
                count += 1.0;
                let t: f64 = count;
                (t * t * 0.37 + t * 1.9).sin()
            };
            DVec3::new(number(), number(), number())
        };
        let (mut seen, mut slivers) = (0, 0);
        for case in 0..3000 {
            let size = 10f64.powi(case % 7 - 3);
            let (a, b) = (size * vector(), size * vector());
            // Now and then a thin one.
            let thin = if case % 3 == 0 {
                0.3f64.powi(case % 8)
            } else {
                1.0
            };
            let triangle = TriangleFrame::new([a, a + b, a + 0.4 * b + thin * size * vector()]);
            let Some(frame) = TrilinearFrame::of(&triangle) else {
                slivers += 1;
                continue;
            };
            seen += 1;
            let near = |a: f64, b: f64, size: f64| {
                assert!(
                    (a - b).abs() <= 1e-12 * size.max(b.abs()),
                    "{case}: {a} {b} {triangle:?}"
                );
            };
            let (point, other) = (a + 2.0 * size * vector(), a + 2.0 * size * vector());
            let (own, second) = (frame.see(point), frame.see(other));
            near(own.split().0, triangle.height(point), size);
            for edge in 0..3 {
                let (found, expected) = (
                    own.edge_position(&frame, edge),
                    triangle.edge_position(edge, point),
                );
                near(found.outside, expected.outside, size);
                near(found.along, expected.along, size);
                let squared = triangle.squared_to_edge(edge, point);
                near(own.squared_to_edge(&frame, edge), squared, size * size);
            }
            near(own.squared(&frame), triangle.squared(point), size * size);
            near(
                frame.length_squared(own - second),
                point.distance_squared(other),
                size * size,
            );
        }
        assert!(seen > 2000 && slivers > 50, "{seen}, {slivers}");
    }

    #[test]
    fn what_is_not_a_number_is_near_nothing() {
        let corners = [
            DVec3::ZERO,
            DVec3::new(1.0, 0.0, 0.0),
            DVec3::new(0.3, 0.8, 0.0),
        ];
        let frame = TrilinearFrame::of(&TriangleFrame::new(corners)).unwrap();
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for axis in 0..3 {
                let mut point = DVec3::new(0.3, 0.2, 0.1);
                point[axis] = number;
                let seen = frame.see(point);
                assert_eq!(seen.squared(&frame), f64::INFINITY, "{point}");
                for edge in 0..3 {
                    assert_eq!(seen.squared_to_edge(&frame, edge), f64::INFINITY, "{point}");
                }
                // Nothing that fails closed takes any of these to be within something.
                let distances = [0, 1, 2].map(|edge| seen.edge_position(&frame, edge).outside);
                let height = seen.split().0.abs();
                let is_near = |&distance: &f64| distance <= f64::MAX;
                assert!(
                    !is_near(&height) || !distances.iter().all(is_near),
                    "{point}: {height} {distances:?}"
                );
                let length = frame.length_squared(seen - Trilinear::default());
                assert!(!is_near(&length), "{point}: {length}");
            }
        }
        let nothing = TriangleFrame::new(corners.map(|corner| corner * f64::NAN));
        assert!(TrilinearFrame::of(&nothing).is_none());
    }
}
