//! The greatest bounds of points over a triangle that has a plane and neighbours all round, by
//! their heights and trilinear coordinates.
//!
//! Most points of the surface are inside the lines of all edges: only where the greatest
//! coordinates are not, points are tested one after the other. Points of curves over edges are
//! taken four at a time.

use core::array::from_fn;

use super::borders::{Borders, Corner, INSIDE, corner, inner_points};
use super::deviation::Deviation;
use super::exceeds;
use super::trilinear::{Trilinear, TrilinearFrame};
use crate::patch::bezier_triangle::{BezierTriangle, EDGES, INNER};
use crate::vector::{Extremes, hypotenuse};
use wide::f64x4;

/// Points of curves that are taken together.
const TOGETHER: usize = 4;

/// The greatest values of the points so far. All points are finite.
struct Greatest<'a> {
    frame: &'a TrilinearFrame,
    /// The greatest size of a height, and the greatest distances outside the lines of the edges.
    most: f64x4,
    /// Squared distance from the triangle, or for points of curves from the edge; that by heights alone left out.
    squared: f64,
    /// The part of that distance within the plane.
    side: f64,
    /// By edge, the greatest height of curve points and of points outside it, and how far outside these are.
    edge_heights: [f64; 3],
    displacements: [f64; 3],
    slopes: [f64; 3],
    /// By edge, the ratio of a curve point's distance from its edge's line, on either side, to the distance from the ends.
    swings: [f64; 3],
    /// A projection is beyond the ends of its edge.
    beyond: bool,
}

/// All bits of trilinear coordinates, and those of a height but its sign.
const UNSIGNED_HEIGHT: [u64; 4] = [u64::MAX >> 1, u64::MAX, u64::MAX, u64::MAX];

/// The point with the absolute height.
#[inline(always)]
fn with_size(Trilinear(point): Trilinear) -> f64x4 {
    point & f64x4::new(UNSIGNED_HEIGHT.map(f64::from_bits))
}

/// The bound of a net, `None` if its points have to be tested one by one, and a height that the
/// piece itself attains.
pub(super) fn of_net(
    frame: &TrilinearFrame,
    net: &BezierTriangle<Trilinear>,
    borders: Borders,
) -> (Option<Deviation>, f64) {
    let points = &net.0;
    let (attained, is_finite) = attained(net);
    if !is_finite {
        return (Some(Deviation::alone(f64::INFINITY)), 0.0);
    }
    let mut greatest = Greatest::over(frame);
    let corners = [0, 1, 2].map(|edge| corner(borders, edge));
    for edge in 0..3 {
        let [start, second, middle, fourth, end] = EDGES[edge];
        greatest.most([second, middle, fourth].map(|at| points[at]));
        // The triangle's own corners are on the surface, except for rounding.
        if !matches!(corners[edge], Corner::Own) {
            greatest.most([points[start]]);
        }
        if borders[edge] != INSIDE {
            let over = usize::from(borders[edge]);
            let first = if matches!(corners[edge], Corner::On(_)) {
                start
            } else {
                middle
            };
            greatest.curve(over, [first, second, middle, fourth].map(|at| &points[at]));
            if matches!(corners[(edge + 1) % 3], Corner::On(_)) {
                greatest.curve(over, [&points[end]; TOGETHER]);
            }
        }
    }
    greatest.most(INNER.map(|at| points[at]));
    if greatest.may_be_outside() {
        let mut bits = inner_points(borders);
        while bits != 0 {
            greatest.outside_edges(points[bits.trailing_zeros() as usize]);
            bits &= bits - 1;
        }
    }
    (greatest.deviation(), attained)
}

/// The bound of points of the surface, and of curves over edges; `None` if they have to be tested
/// one by one.
pub(super) fn of_points(
    frame: &TrilinearFrame,
    inner: &[Trilinear],
    curves: &[(usize, Trilinear)],
) -> Option<Deviation> {
    let all = inner.iter().chain(curves.iter().map(|(_, point)| point));
    let sum = all.fold(f64x4::ZERO, |sum, point| sum + point.0);
    if !sum.to_array().iter().all(|sum| sum.is_finite()) {
        return None;
    }
    let mut greatest = Greatest::over(frame);
    inner.iter().for_each(|&point| greatest.most([point]));
    if greatest.may_be_outside() {
        inner
            .iter()
            .for_each(|&point| greatest.outside_edges(point));
    }
    for (edge, own) in curves
        .chunk_by(|a, b| a.0 == b.0)
        .map(|own| (own[0].0, own))
    {
        for some in own.chunks(TOGETHER) {
            let four = from_fn(|at| &some[at.min(some.len() - 1)].1);
            greatest.most(four.map(|&point| point));
            greatest.curve(edge, four);
        }
    }
    greatest.deviation()
}

/// The greatest height in the middle of a piece and of its edges, and whether all points are finite.
#[inline]
fn attained(net: &BezierTriangle<Trilinear>) -> (f64, bool) {
    let (mut on_edges, mut middle) = (f64x4::ZERO, f64x4::ZERO);
    for edge in EDGES {
        let [a, b, c, d, e] = edge.map(|at| net.0[at].0);
        let most = (b + d) * 4.0 + c * 6.0;
        on_edges = on_edges.fast_max((a + e + most).abs());
        middle += a + most;
    }
    middle += INNER.iter().fold(f64x4::ZERO, |sum, &at| sum + net.0[at].0) * 12.0;
    let (on_edges, middle) = (on_edges.to_array(), middle.to_array());
    // Weights are positive: a number that is none, or infinite, is left in the sum.
    let is_finite = middle.iter().all(|sum| sum.is_finite());
    (
        (on_edges[0] / 16.0).larger(middle[0].abs() / 81.0),
        is_finite,
    )
}

impl<'a> Greatest<'a> {
    fn over(frame: &'a TrilinearFrame) -> Self {
        Self {
            frame,
            most: f64x4::ZERO,
            squared: 0.0,
            side: 0.0,
            edge_heights: [0.0; 3],
            displacements: [0.0; 3],
            slopes: [0.0; 3],
            swings: [0.0; 3],
            beyond: false,
        }
    }

    /// Heights of points, and the positions of the surface's points relative to the edges.
    #[inline(always)]
    fn most<const N: usize>(&mut self, points: [Trilinear; N]) {
        self.most = points
            .into_iter()
            .fold(self.most, |most, point| most.fast_max(with_size(point)));
    }

    /// Whether one of these may be outside an edge.
    #[inline]
    fn may_be_outside(&self) -> bool {
        let (_, outside) = Trilinear(self.most).split();
        outside.iter().any(|&outside| outside > self.frame.on_edge)
    }

    /// Adds a point of the surface that may be outside an edge.
    #[inline]
    fn outside_edges(&mut self, point: Trilinear) {
        let on_edge = self.frame.on_edge;
        if !point
            .0
            .simd_gt(f64x4::new([f64::INFINITY, on_edge, on_edge, on_edge]))
            .any()
        {
            return;
        }
        let (height, outside) = point.split();
        let mut side = 0.0f64;
        for (edge, outside) in outside
            .into_iter()
            .enumerate()
            .filter(|&(_, outside)| outside > on_edge)
        {
            let along = point.edge_position(self.frame, edge).along;
            let room = along.min(self.frame.lengths[edge] - along);
            side = side.larger(outside);
            self.edge_heights[edge] = self.edge_heights[edge].larger(height.abs());
            self.displacements[edge] = self.displacements[edge].larger(outside);
            self.slopes[edge] = self.slopes[edge].larger(outside / room);
            self.beyond |= exceeds(0.0, room);
        }
        self.side = self.side.larger(side);
        self.squared = self.squared.larger(height * height + side * side);
    }

    /// Points of the curve over an edge, some perhaps more than once.
    #[inline]
    fn curve(&mut self, edge: usize, points: [&Trilinear; TOGETHER]) {
        let row = |at: usize| f64x4::new(points.map(|point| point.0.as_array()[at % 4]));
        let (heights, out, before) = (row(0), row(1 + edge), row(1 + (edge + 2) % 3));
        let [by_before, by_own] = self.frame.shares_along(edge);
        let along = before * by_before + out * by_own;
        let room = along.fast_min(f64x4::splat(self.frame.lengths[edge]) - along);
        let on_edge = f64x4::splat(self.frame.on_edge);
        let side = out.abs();
        let is_off = side.simd_gt(on_edge);
        let swings = is_off & (side / room);
        let outside = out.simd_gt(on_edge);
        self.squared = self.squared.larger(greatest(heights * heights + out * out));
        self.side = self.side.larger(greatest(side));
        self.swings[edge] = self.swings[edge].larger(greatest(swings));
        self.slopes[edge] = self.slopes[edge].larger(greatest(outside & swings));
        self.displacements[edge] = self.displacements[edge].larger(greatest(outside & out));
        self.edge_heights[edge] = self.edge_heights[edge].larger(greatest(heights.abs()));
        let rooms = is_off.bitselect(room, room + on_edge);
        self.beyond |= rooms.simd_lt(f64x4::ZERO).any();
    }

    /// The deviation; `None` if the points have to be tested one by one.
    #[inline]
    fn deviation(self) -> Option<Deviation> {
        let Self {
            frame,
            most,
            squared,
            side,
            edge_heights,
            displacements,
            slopes,
            ..
        } = self;
        let (height, _) = Trilinear(most).split();
        let squared = squared.larger(height * height);
        // Squares of tiny lengths vanish.
        let own = if squared > 1e-280 {
            squared.sqrt()
        } else {
            hypotenuse(height, side)
        };
        // A curve that swings less than the angles at its edge open crosses no other edge.
        let stays = (0..3).all(|edge| self.swings[edge] <= frame.slopes[edge]);
        (stays && !self.beyond).then_some(Deviation {
            own,
            height,
            edge_heights,
            displacements,
            slopes,
            ..Deviation::default()
        })
    }
}

/// The greatest of four numbers, or 0.
#[inline(always)]
fn greatest(numbers: f64x4) -> f64 {
    let [a, b, c, d] = numbers.to_array();
    a.larger(b).larger(c.larger(d)).larger(0.0)
}
