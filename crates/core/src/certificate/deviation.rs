//! How far hull points stand from a triangle, its plane and its edges: what the bounds of [`super::bounds`] are the
//! greatest of.

use super::greatest::{CURVE, Greatest, SEEN, SeenPoints};
use super::triangle_frame::{Beside, TriangleFrame};
use super::{exceeds, greater};
use crate::criterion::Apart;
use crate::patch::bezier_triangle::{BezierTriangle, EDGES, INNER};
use crate::vector::DVec3;
use crate::vector::Extremes;

/// For each edge of a piece the edge of the triangle that it is part of, or [`INSIDE`].
pub(crate) type Borders = [u8; 3];

/// The edge lies inside the triangle's piece of surface.
pub(crate) const INSIDE: u8 = 3;

/// The square of the greatest chord of the angle between neighbours that help each other, 2√3: 137°. Where they meet in
/// a sharper fold, both may reach beyond the surface (see [`super::bounds`]).
const SHARPEST: f64 = 3.464;

/// How far a triangle and its piece of the surface can be from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Deviation {
    /// The bound that needs no neighbours.
    pub(crate) own: f64,
    /// The greatest height over the triangle's plane, and distance to edges without a neighbour.
    pub(crate) height: f64,
    /// How far pieces reach over edges with a neighbour.
    pub(crate) drift: f64,
    /// The greatest ratio of that to the distance from the edge's ends, by edge.
    pub(crate) slopes: [f64; 3],
    /// How much of the height may point in any direction rather than along normals.
    pub(crate) across: f64,
}

impl Deviation {
    /// The greater of each.
    pub(crate) fn max(self, other: Self) -> Self {
        Self {
            own: greater(self.own, other.own),
            height: greater(self.height, other.height),
            drift: greater(self.drift, other.drift),
            slopes: [0, 1, 2].map(|edge| greater(self.slopes[edge], other.slopes[edge])),
            across: greater(self.across, other.across),
        }
    }

    /// That of a piece which is as far from the triangle, its curves from their edges, and counts on its own.
    pub(crate) fn alone(own: f64) -> Self {
        Self { own, height: own, drift: 0.0, slopes: [0.0; 3], across: own }
    }

    /// The same for a triangle whose corners were moved off the surface by up to `moved`, up to `aside` of that along
    /// its plane.
    ///
    /// At such a corner the projections on the planes around it lie up to `aside` from it, and up to twice that apart;
    /// whatever they leave uncovered near it is that far from the surface's corner's foot. Curves may reach by `aside` over
    /// other edges there.
    pub(crate) fn off(self, moved: f64, aside: f64) -> Self {
        if moved == 0.0 {
            return self;
        }
        let height = greater(self.height, moved).hypot(2.0 * aside);
        let across = self.across + 2.0 * aside;
        Self { own: greater(self.own, moved), height, drift: self.drift + aside, across, ..self }
    }

    /// That of a piece each of whose points is within `distance` of one of the piece that this is for, and the other way round.
    ///
    /// So pieces at irregular vertices are bounded ([`super::bounds`]), and triangles whose corners were moved off the surface:
    /// let the piece be moved within the triangle's plane so that each corner stands over that of the triangle, points between as
    /// barycentric coordinates say. Its curves stand to the triangle's edges as those of the surface stand to its own chords, its
    /// heights over the plane are what they were; and no point was moved farther than a corner.
    pub(crate) fn grown(self, distance: f64) -> Self {
        let Self { own, height, across, .. } = self;
        Self { own: own + distance, height: height + distance, across: across + distance, ..self }
    }

    /// The greatest of the slopes.
    #[inline]
    pub(crate) fn steepest(&self) -> f64 {
        self.slopes.into_iter().fold(0.0, greater)
    }

    /// Whether all slopes are known to be within limits.
    #[inline]
    pub(crate) fn is_within(&self, slopes: [f64; 3]) -> bool {
        (0..3).all(|edge| self.slopes[edge] <= slopes[edge])
    }

    /// The bound where the neighbours' planes are turned by angles with this chord (2 sin(θ/2)) at most, and `slopes`
    /// are the greatest that are allowed, by edge.
    #[inline]
    pub(crate) fn bound(&self, chord: f64, slopes: [f64; 3]) -> f64 {
        self.among_neighbours(chord, slopes).map_or(self.own, |bound| self.own.min(bound))
    }

    /// The part of the bound that takes help of the neighbours; `None` where they can't help.
    #[inline]
    fn among_neighbours(&self, chord: f64, slopes: [f64; 3]) -> Option<f64> {
        let can_help = self.is_within(slopes) && chord * chord <= SHARPEST;
        can_help.then_some(self.height * (1.0 + 0.5 * chord * chord) + chord * self.drift)
    }

    /// The height for which that would be no more than this.
    pub(crate) fn height_within(&self, limit: f64, chord: f64) -> f64 {
        (limit - chord * self.drift) / (1.0 + 0.5 * chord * chord)
    }

    /// The bounds with and without neighbours, and which part of the former is along normals.
    ///
    /// That is all that stems from heights over the planes of the triangle and its neighbours and from drifts over
    /// edges between them: what covers a point stands within [`super::bounds`]' |h| + σg along the normals of both planes and
    /// the chord between them; and where it is a strip that covers, at the tangent of half their angle beside it at
    /// most, all of which is within that angle of the triangle's own normal or counts as little.
    pub(crate) fn apart(&self, chord: f64, slopes: [f64; 3]) -> Apart {
        let bound = self.among_neighbours(chord, slopes).unwrap_or(f64::INFINITY);
        let across = if bound.is_finite() { self.across.min(bound) } else { self.own };
        let height = if bound.is_finite() { bound - across } else { 0.0 };
        Apart { own: self.own, height, across }
    }
}

/// A triangle and which of its edges have no neighbour.
#[derive(Clone, Copy)]
pub(crate) struct DeviationBound<'a> {
    pub(crate) frame: &'a TriangleFrame,
    pub(crate) open: [bool; 3],
    /// Whether nothing counts but the curves over those edges.
    pub(crate) rim_alone: bool,
}

impl DeviationBound<'_> {
    /// The deviation of a net's points, and a height that the piece itself attains.
    pub(crate) fn net(&self, net: &BezierTriangle, borders: Borders) -> (Deviation, f64) {
        if self.frame.is_flat() || self.rim_alone || self.open != [false; 3] {
            return (self.each_of_net(net, borders), 0.0);
        }
        let frame = self.frame;
        let mut seen = SeenPoints::NONE;
        seen.look(frame, net.0.iter().copied());
        if !seen.is_finite {
            return (Deviation::alone(f64::INFINITY), 0.0);
        }
        let attained = attained(&seen.heights);
        let mut greatest = Greatest::default();
        let corners = [0, 1, 2].map(|edge| corner(borders, edge));
        for edge in 0..3 {
            if matches!(corners[edge], Corner::Own) {
                // On the surface, but for rounding.
                seen.heights[EDGES[edge][0]] = 0.0;
            }
        }
        for edge in 0..3 {
            if borders[edge] == INSIDE {
                continue;
            }
            let [start, second, middle, fourth, end] = EDGES[edge];
            let or_middle = |at, corner| if matches!(corner, Corner::On(_)) { at } else { middle };
            let (start, end) = (or_middle(start, corners[edge]), or_middle(end, corners[(edge + 1) % 3]));
            let points = [start, second, middle, fourth, end, middle].map(|at| at as u8);
            greatest.curve(frame, usize::from(borders[edge]), &seen, points);
        }
        let inside = (0..3).fold(0, |bits, edge| bits | usize::from(borders[edge] == INSIDE) << edge);
        greatest.inner(frame, &seen, INNER_POINTS[inside]);
        let deviation = greatest.deviation(frame).unwrap_or_else(|| self.each_of_net(net, borders));
        (deviation, attained)
    }

    /// The deviation of points of the surface, and of curves over edges.
    pub(crate) fn points(
        &self,
        inner: impl Iterator<Item = DVec3> + Clone,
        curves: &[(usize, DVec3)],
    ) -> Deviation {
        let frame = self.frame;
        if !frame.is_flat()
            && !self.rim_alone
            && self.open == [false; 3]
            && let Some(greatest) = greatest_of(frame, inner.clone(), curves)
            && let Some(deviation) = greatest.deviation(frame)
        {
            return deviation;
        }
        let mut deviation = Deviation::default();
        inner.for_each(|point| self.inner_point(point, &mut deviation));
        curves.iter().for_each(|&(edge, point)| self.curve_point(edge, point, &mut deviation));
        deviation
    }

    /// The deviation of a net's points, one by one, for any triangle.
    fn each_of_net(&self, net: &BezierTriangle, borders: Borders) -> Deviation {
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
    pub(crate) fn inner_point(&self, point: DVec3, deviation: &mut Deviation) {
        if self.rim_alone {
            return;
        }
        if self.frame.is_flat() {
            self.found_alone(self.frame.squared(point).sqrt(), deviation);
            return;
        }
        let height = self.frame.height(point).abs();
        let mut own = height;
        let mut alone = height;
        for edge in 0..3 {
            let beside = self.frame.beside(edge, point);
            if exceeds(beside.outside, 0.0) {
                own = f64::INFINITY;
                if self.open[edge] {
                    alone = greater(alone, height.hypot(beside.outside));
                } else {
                    self.drifted(edge, beside, deviation);
                }
            }
        }
        if own.is_infinite() {
            own = self.frame.squared(point).sqrt();
            if alone > height {
                alone = greater(alone, own);
                deviation.across = greater(deviation.across, alone);
            }
        }
        deviation.own = greater(deviation.own, own);
        deviation.height = greater(deviation.height, alone);
    }

    /// A hull point of the curve over an edge of the triangle.
    pub(crate) fn curve_point(&self, edge: usize, point: DVec3, deviation: &mut Deviation) {
        let own = self.frame.squared_to_edge(edge, point).sqrt();
        if self.rim_alone {
            if self.open[edge] {
                *deviation = deviation.max(Deviation::alone(own));
            }
            return;
        }
        if self.frame.is_flat() {
            self.found_alone(own, deviation);
            return;
        }
        deviation.own = greater(deviation.own, own);
        if self.open[edge] {
            deviation.height = greater(deviation.height, own);
            deviation.across = greater(deviation.across, own);
        } else {
            deviation.height = greater(deviation.height, self.frame.height(point).abs());
            let beside = self.frame.beside(edge, point);
            if exceeds(beside.outside, 0.0) {
                self.drifted(edge, beside, deviation);
            }
        }
        for other in [(edge + 1) % 3, (edge + 2) % 3] {
            if exceeds(self.frame.beside(other, point).outside, 0.0) {
                deviation.slopes = [f64::INFINITY; 3];
            }
        }
    }

    /// For a triangle that has no plane.
    fn found_alone(&self, distance: f64, deviation: &mut Deviation) {
        let slopes = [f64::INFINITY; 3];
        *deviation = deviation.max(Deviation { slopes, ..Deviation::alone(distance) });
    }

    fn drifted(&self, edge: usize, beside: Beside, deviation: &mut Deviation) {
        let room = beside.along.min(self.frame.length(edge) - beside.along);
        deviation.drift = greater(deviation.drift, beside.outside);
        let slope = if room > 0.0 { beside.outside / room } else { f64::INFINITY };
        deviation.slopes[edge] = greater(deviation.slopes[edge], slope);
    }
}

/// What a corner of a piece is to the triangle.
#[derive(Clone, Copy)]
enum Corner {
    /// One of its own, which lies on the surface.
    Own,
    /// A point of the curve over an edge.
    On(usize),
    /// A point like others.
    Inside,
}

/// What the corner is that an edge of a piece starts at.
#[inline]
fn corner(borders: Borders, edge: usize) -> Corner {
    match (borders[(edge + 2) % 3], borders[edge]) {
        (INSIDE, INSIDE) => Corner::Inside,
        (INSIDE, on) | (on, INSIDE) => Corner::On(on as usize),
        (last, next) if last == next => Corner::On(next as usize),
        _ => Corner::Own,
    }
}

/// The points of a net that stand for the surface rather than for its curve over an edge of the triangle, one bit each, by which
/// of its edges are [`INSIDE`], one bit each.
const INNER_POINTS: [u16; 8] = {
    let mut all = [0; 8];
    let mut inside = 0;
    while inside < 8 {
        all[inside] = 1 << INNER[0] | 1 << INNER[1] | 1 << INNER[2];
        let mut edge = 0;
        while edge < 3 {
            let [start, second, middle, fourth, _] = EDGES[edge];
            if inside & 1 << edge != 0 {
                all[inside] |= 1 << second | 1 << middle | 1 << fourth;
                if inside & 1 << ((edge + 2) % 3) != 0 {
                    all[inside] |= 1 << start;
                }
            }
            edge += 1;
        }
        inside += 1;
    }
    all
};

/// What some points of the surface, and of curves over edges, come to; `None` if not all of them are finite.
fn greatest_of(
    frame: &TriangleFrame,
    mut inner: impl Iterator<Item = DVec3>,
    curves: &[(usize, DVec3)],
) -> Option<Greatest> {
    let mut greatest = Greatest::default();
    loop {
        let mut points = inner.by_ref().take(SEEN).peekable();
        if points.peek().is_none() {
            break;
        }
        let mut seen = SeenPoints::NONE;
        seen.look(frame, points);
        greatest.inner(frame, &seen, u16::MAX);
        if !seen.is_finite {
            return None;
        }
    }
    for of_some in curves.chunks(SEEN) {
        let mut seen = SeenPoints::NONE;
        seen.look(frame, of_some.iter().map(|&(_, point)| point));
        for (at, &(edge, _)) in of_some.iter().enumerate() {
            greatest.curve(frame, edge, &seen, [at as u8; CURVE]);
        }
        greatest.heights(&seen);
        if !seen.is_finite {
            return None;
        }
    }
    Some(greatest)
}

/// The greatest height in the middle of a piece and of its edges, from those of its net.
#[inline]
fn attained(heights: &[f64; SEEN]) -> f64 {
    let mut greatest = 0.0f64;
    let (mut outer, mut halves, mut inner) = (0.0, 0.0, 0.0);
    for &[a, b, c, d, e] in &EDGES {
        let [a, b, c, d, e] = [heights[a], heights[b], heights[c], heights[d], heights[e]];
        let (ends, seconds) = (a + e, b + d);
        greatest = greatest.larger((ends + 4.0 * seconds + 6.0 * c).abs() / 16.0);
        outer += a + 4.0 * seconds;
        halves += 6.0 * c;
    }
    for at in INNER {
        inner += 12.0 * heights[at];
    }
    greatest.larger((outer + halves + inner).abs() / 81.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that are seen together come to what they come to one by one, whatever the net's edges are.
    #[test]
    fn nets_come_to_what_their_points_come_to() {
        let mut count = 0.0;
        let mut number = || {
            count += 1.0;
            let t: f64 = count;
            (t * t * 0.37 + t * 1.9).sin()
        };
        let (mut told, mut compared) = (0, 0);
        for case in 0..4000 {
            // A net over the triangle or a part of it, stirred.
            let noise = 0.15 * 0.5f64.powi(case % 12);
            let mut point =
                |x: f64, y: f64| DVec3::new(x, y, 0.0) + noise * DVec3::new(number(), number(), number());
            let frame = TriangleFrame::new([point(0.0, 0.0), point(1.0, 0.1), point(0.2, 0.9)]);
            let (size, from) = ([1.0, 0.5, 0.25][case as usize % 3], [0.0, 0.2][case as usize % 2]);
            let mut net = BezierTriangle([DVec3::ZERO; 15]);
            let places = (0..5).flat_map(|k| (0..5 - k).map(move |j| (f64::from(j), f64::from(k))));
            for (at, (j, k)) in net.0.iter_mut().zip(places) {
                let (s, t) = (0.25 * size * j + from, 0.25 * size * k + from);
                *at = point(s + 0.2 * t, 0.1 * s + 0.9 * t);
            }
            let borders = [0, 2, 4].map(|shift| [0, 1, 2, INSIDE][(case as usize >> shift) % 4]);
            let bound = DeviationBound { frame: &frame, open: [false; 3], rim_alone: false };
            let (found, each) = (bound.net(&net, borders).0, bound.each_of_net(&net, borders));
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs()) || a == b;
            if each.slopes.iter().all(|slope| slope.is_finite()) {
                compared += 1;
                assert!(near(found.own, each.own) || found.own >= each.own, "{case}: {found:?} {each:?}");
                assert!(
                    near(found.height, each.height) && near(found.drift, each.drift),
                    "{case}: {found:?} {each:?}"
                );
                assert!(
                    (0..3).all(|edge| near(found.slopes[edge], each.slopes[edge])),
                    "{case}: {found:?} {each:?}"
                );
            } else {
                // What crosses an edge far off is seen by the angles at its own edge or by each point.
                told += usize::from(found.slopes == each.slopes);
            }
        }
        assert!(compared > 500 && told > 100, "{compared}, {told}");
    }
}
