//! The distances of hull points from a triangle, its plane and its edges: the bounds of
//! [`super::bounds`] are the greatest of these.
//!
//! Points are taken in space, for any triangle, or as the triangle sees them ([`Trilinear`]), several together.

use super::borders::{Borders, Corner, INSIDE, corner};
use super::deviation::Deviation;
use super::greatest;
use super::triangle_frame::{EdgePosition, TriangleFrame};
use super::trilinear::{Trilinear, TrilinearFrame};
use super::{exceeds, greater};
use crate::patch::bezier_triangle::{BezierTriangle, EDGES, INNER};
use crate::vector::{Blend, DVec3, hypotenuse};

/// A point of a bound, in space or relative to its triangle.
pub(super) trait HullPoint: Blend {
    /// The triangle, prepared for such points.
    type Frame;

    /// A point of space.
    fn of(frame: &Self::Frame, point: DVec3) -> Self;

    /// Whether the triangle has no plane to speak of.
    fn is_flat(frame: &Self::Frame) -> bool;

    /// The length of one of its edges.
    fn length(frame: &Self::Frame, edge: usize) -> f64;

    /// Height over the triangle's plane.
    fn height(self, frame: &Self::Frame) -> f64;

    /// The position of the point relative to an edge.
    fn edge_position(self, frame: &Self::Frame, edge: usize) -> EdgePosition;

    /// Squared distance to the triangle.
    fn squared(self, frame: &Self::Frame) -> f64;

    /// Squared distance to an edge.
    fn squared_to_edge(self, frame: &Self::Frame, edge: usize) -> f64;

    /// The squared length of a difference.
    fn length_squared(self, frame: &Self::Frame) -> f64;

    /// The bound of a net if its points can be tested together, and a height that the piece itself
    /// attains.
    fn net_together(
        frame: &Self::Frame,
        net: &BezierTriangle<Self>,
        borders: Borders,
    ) -> (Option<Deviation>, f64);

    /// The bound of points of the surface, and of curves over edges, if they can be tested
    /// together.
    fn points_together(
        frame: &Self::Frame,
        inner: &[Self],
        curves: &[(usize, Self)],
    ) -> Option<Deviation>;
}

impl HullPoint for DVec3 {
    type Frame = TriangleFrame;

    fn of(_: &TriangleFrame, point: DVec3) -> Self {
        point
    }

    fn is_flat(frame: &TriangleFrame) -> bool {
        frame.is_flat()
    }

    fn length(frame: &TriangleFrame, edge: usize) -> f64 {
        frame.length(edge)
    }

    fn height(self, frame: &TriangleFrame) -> f64 {
        frame.height(self)
    }

    fn edge_position(self, frame: &TriangleFrame, edge: usize) -> EdgePosition {
        frame.edge_position(edge, self)
    }

    fn squared(self, frame: &TriangleFrame) -> f64 {
        frame.squared(self)
    }

    fn squared_to_edge(self, frame: &TriangleFrame, edge: usize) -> f64 {
        frame.squared_to_edge(edge, self)
    }

    fn length_squared(self, _: &TriangleFrame) -> f64 {
        DVec3::length_squared(self)
    }

    fn net_together(_: &TriangleFrame, _: &BezierTriangle, _: Borders) -> (Option<Deviation>, f64) {
        (None, 0.0)
    }

    fn points_together(_: &TriangleFrame, _: &[Self], _: &[(usize, Self)]) -> Option<Deviation> {
        None
    }
}

impl HullPoint for Trilinear {
    type Frame = TrilinearFrame;

    #[inline(always)]
    fn of(frame: &TrilinearFrame, point: DVec3) -> Self {
        frame.see(point)
    }

    fn is_flat(_: &TrilinearFrame) -> bool {
        false
    }

    fn length(frame: &TrilinearFrame, edge: usize) -> f64 {
        frame.lengths[edge]
    }

    fn height(self, _: &TrilinearFrame) -> f64 {
        self.split().0
    }

    fn edge_position(self, frame: &TrilinearFrame, edge: usize) -> EdgePosition {
        self.edge_position(frame, edge)
    }

    fn squared(self, frame: &TrilinearFrame) -> f64 {
        self.squared(frame)
    }

    fn squared_to_edge(self, frame: &TrilinearFrame, edge: usize) -> f64 {
        self.squared_to_edge(frame, edge)
    }

    #[inline(always)]
    fn length_squared(self, frame: &TrilinearFrame) -> f64 {
        frame.length_squared(self)
    }

    fn net_together(
        frame: &TrilinearFrame,
        net: &BezierTriangle<Self>,
        borders: Borders,
    ) -> (Option<Deviation>, f64) {
        greatest::of_net(frame, net, borders)
    }

    fn points_together(
        frame: &TrilinearFrame,
        inner: &[Self],
        curves: &[(usize, Self)],
    ) -> Option<Deviation> {
        greatest::of_points(frame, inner, curves)
    }
}

/// A triangle and which of its edges have no neighbour.
pub(super) struct DeviationBound<'a, P: HullPoint = DVec3> {
    pub(super) frame: &'a P::Frame,
    pub(super) open: [bool; 3],
    /// Whether nothing counts but the curves over those edges.
    pub(super) rim_alone: bool,
}

impl<P: HullPoint> Clone for DeviationBound<'_, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P: HullPoint> Copy for DeviationBound<'_, P> {}

impl<P: HullPoint> DeviationBound<'_, P> {
    /// The deviation of a net's points, and a height that the piece itself attains.
    pub(super) fn net(&self, net: &BezierTriangle<P>, borders: Borders) -> (Deviation, f64) {
        let (together, attained) = P::net_together(self.frame, net, borders);
        (
            together.unwrap_or_else(|| self.each_of_net(net, borders)),
            attained,
        )
    }

    /// The deviation of points of the surface, and of curves over edges.
    pub(super) fn points(&self, inner: &[P], curves: &[(usize, P)]) -> Deviation {
        P::points_together(self.frame, inner, curves).unwrap_or_else(|| {
            let mut deviation = Deviation::default();
            inner
                .iter()
                .for_each(|&point| self.inner_point(point, &mut deviation));
            curves
                .iter()
                .for_each(|&(edge, point)| self.curve_point(edge, point, &mut deviation));
            deviation
        })
    }

    /// The deviation of a net's points, one by one, for any triangle.
    fn each_of_net(&self, net: &BezierTriangle<P>, borders: Borders) -> Deviation {
        let mut deviation = Deviation::default();
        for at in INNER {
            self.inner_point(net.0[at], &mut deviation);
        }
        for (edge, points) in EDGES.iter().enumerate() {
            for &at in &points[1..4] {
                if borders[edge] == INSIDE {
                    self.inner_point(net.0[at], &mut deviation);
                } else {
                    self.curve_point(borders[edge] as usize, net.0[at], &mut deviation);
                }
            }
            match corner(borders, edge) {
                Corner::Own => {}
                Corner::On(border) => self.curve_point(border, net.0[points[0]], &mut deviation),
                Corner::Inside => self.inner_point(net.0[points[0]], &mut deviation),
            }
        }
        deviation
    }

    /// A hull point of the surface.
    pub(super) fn inner_point(&self, point: P, deviation: &mut Deviation) {
        if self.rim_alone {
            return;
        }
        if P::is_flat(self.frame) {
            self.found_alone(point.squared(self.frame).sqrt(), deviation);
            return;
        }
        let height = point.height(self.frame).abs();
        let mut own = height;
        let mut alone = height;
        for edge in 0..3 {
            let position = point.edge_position(self.frame, edge);
            if exceeds(position.outside, 0.0) {
                own = f64::INFINITY;
                if self.open[edge] {
                    alone = greater(alone, hypotenuse(height, position.outside));
                } else {
                    let known = &mut deviation.edge_heights[edge];
                    *known = greater(*known, height);
                    self.displaced(edge, position, deviation);
                }
            }
        }
        if own.is_infinite() {
            own = point.squared(self.frame).sqrt();
            if alone > height {
                alone = greater(alone, own);
                deviation.across = greater(deviation.across, alone);
            }
        }
        deviation.own = greater(deviation.own, own);
        deviation.height = greater(deviation.height, alone);
    }

    /// A hull point of the curve over an edge of the triangle.
    pub(super) fn curve_point(&self, edge: usize, point: P, deviation: &mut Deviation) {
        let own = point.squared_to_edge(self.frame, edge).sqrt();
        if self.rim_alone {
            if self.open[edge] {
                *deviation = deviation.max(Deviation::alone(own));
            }
            return;
        }
        if P::is_flat(self.frame) {
            self.found_alone(own, deviation);
            return;
        }
        deviation.own = greater(deviation.own, own);
        if self.open[edge] {
            deviation.height = greater(deviation.height, own);
            deviation.across = greater(deviation.across, own);
        } else {
            let height = point.height(self.frame).abs();
            deviation.height = greater(deviation.height, height);
            deviation.edge_heights[edge] = greater(deviation.edge_heights[edge], height);
            let position = point.edge_position(self.frame, edge);
            if exceeds(position.outside, 0.0) {
                self.displaced(edge, position, deviation);
            }
        }
        for other in [(edge + 1) % 3, (edge + 2) % 3] {
            if exceeds(point.edge_position(self.frame, other).outside, 0.0) {
                deviation.slopes = [f64::INFINITY; 3];
            }
        }
    }

    /// For a triangle that has no plane.
    fn found_alone(&self, distance: f64, deviation: &mut Deviation) {
        let slopes = [f64::INFINITY; 3];
        *deviation = deviation.max(Deviation {
            slopes,
            ..Deviation::alone(distance)
        });
    }

    fn displaced(&self, edge: usize, position: EdgePosition, deviation: &mut Deviation) {
        let room = position
            .along
            .min(P::length(self.frame, edge) - position.along);
        let reach = &mut deviation.displacements[edge];
        *reach = greater(*reach, position.outside);
        let slope = if room > 0.0 {
            position.outside / room
        } else {
            f64::INFINITY
        };
        deviation.slopes[edge] = greater(deviation.slopes[edge], slope);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bound of points tested together equals the bound one by one, whatever the net's edges
    /// are.
    #[test]
    fn nets_come_to_what_their_points_come_to() {
        let mut count = 0.0;
        let mut number = || {
            count += 1.0;
            let t: f64 = count;
            (t * t * 0.37 + t * 1.9).sin()
        };
        let (mut reported, mut compared) = (0, 0);
        for case in 0..4000 {
            // A net over the triangle or a part of it, stirred.
            let noise = 0.15 * 0.5f64.powi(case % 12);
            let mut point = |x: f64, y: f64| {
                DVec3::new(x, y, 0.0) + noise * DVec3::new(number(), number(), number())
            };
            let frame = TriangleFrame::new([point(0.0, 0.0), point(1.0, 0.1), point(0.2, 0.9)]);
            let (size, from) = (
                [1.0, 0.5, 0.25][case as usize % 3],
                [0.0, 0.2][case as usize % 2],
            );
            let mut net = BezierTriangle([DVec3::ZERO; 15]);
            let places = (0..5).flat_map(|k| (0..5 - k).map(move |j| (f64::from(j), f64::from(k))));
            for (at, (j, k)) in net.0.iter_mut().zip(places) {
                let (s, t) = (0.25 * size * j + from, 0.25 * size * k + from);
                *at = point(s + 0.2 * t, 0.1 * s + 0.9 * t);
            }
            let borders = [0, 2, 4].map(|shift| [0, 1, 2, INSIDE][(case as usize >> shift) % 4]);
            let in_space = DeviationBound {
                frame: &frame,
                open: [false; 3],
                rim_alone: false,
            };
            let own = TrilinearFrame::of(&frame).unwrap();
            let from_triangle = DeviationBound::<Trilinear> {
                frame: &own,
                open: [false; 3],
                rim_alone: false,
            };
            let seen = BezierTriangle(net.0.map(|point| own.see(point)));
            let (found, each) = (
                from_triangle.net(&seen, borders).0,
                in_space.each_of_net(&net, borders),
            );
            let each_seen = from_triangle.each_of_net(&seen, borders);
            assert!(
                (each_seen.own - each.own).abs() <= 1e-12,
                "{case}: {each_seen:?} {each:?}"
            );
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs()) || a == b;
            if each.slopes.iter().all(|slope| slope.is_finite()) {
                compared += 1;
                assert!(
                    near(found.own, each.own) || found.own >= each.own,
                    "{case}: {found:?} {each:?}"
                );
                assert!(
                    near(found.height, each.height)
                        && (0..3).all(|edge| near(
                            found.displacements[edge],
                            each.displacements[edge]
                        ) && near(
                            found.edge_heights[edge],
                            each.edge_heights[edge]
                        )),
                    "{case}: {found:?} {each:?}"
                );
                assert!(
                    // Distances from the ends have lost digits, which those of next to nothing show.
                    (0..3).all(|edge| near(1e-2 * found.slopes[edge], 1e-2 * each.slopes[edge])),
                    "{case}: {found:?} {each:?}"
                );
            } else {
                // A crossing of an edge far off shows in the angles at its own edge or at each
                // point.
                reported += usize::from(found.slopes == each.slopes);
            }
        }
        assert!(compared > 500 && reported > 100, "{compared}, {reported}");
    }
}
