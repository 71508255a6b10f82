//! How far hull points stand from a triangle, its plane and its edges: what the bounds of [`super::bounds`] are the
//! greatest of.

use super::triangle_frame::{Beside, TriangleFrame};
use super::{exceeds, greater};
use crate::criterion::Apart;
use crate::patch::bezier_triangle::{BezierTriangle, EDGES, INNER};
use crate::vector::DVec3;

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

/// A point as a triangle sees it from its first corner.
struct Seen {
    offset: DVec3,
    height: f64,
    /// How far outside the lines of the edges.
    outside: [f64; 3],
}

impl Seen {
    fn of(point: DVec3, frame: &TriangleFrame) -> Self {
        let offset = frame.seen_from_first(point);
        let outside = [0, 1, 2].map(|edge| frame.outside_from_first(edge, offset));
        Self { offset, height: frame.height_from_first(offset), outside }
    }
}

/// The points of a net likewise, by axis and point, so that several are looked at together.
struct SeenNet {
    offsets: [[f64; SEEN]; 3],
    heights: [f64; SEEN],
    outside: [[f64; SEEN]; 3],
}

/// The points of a net, rounded up to whole registers.
const SEEN: usize = 16;

impl SeenNet {
    /// `None` if not all points are finite.
    #[inline]
    fn of(net: &BezierTriangle, frame: &TriangleFrame) -> Option<Self> {
        let mut offsets = [[0.0; SEEN]; 3];
        let mut sum = DVec3::ZERO;
        for (at, &point) in net.0.iter().enumerate() {
            let offset = frame.seen_from_first(point);
            sum += offset;
            (offsets[0][at], offsets[1][at], offsets[2][at]) = (offset.x, offset.y, offset.z);
        }
        let along = |direction: DVec3, from: f64| {
            let mut values = [0.0; SEEN];
            let [x, y, z] = &offsets;
            for (at, value) in values.iter_mut().enumerate() {
                *value = direction.x * x[at] + direction.y * y[at] + direction.z * z[at] - from;
            }
            values
        };
        let outside = [0, 1, 2].map(|edge| along(frame.outward(edge), frame.offset(edge)));
        sum.is_finite().then(|| Self { offsets, heights: along(frame.normal(), 0.0), outside })
    }

    #[inline]
    fn at(&self, at: usize) -> Seen {
        let ([x, y, z], [a, b, c]) = (&self.offsets, &self.outside);
        Seen {
            offset: DVec3::new(x[at], y[at], z[at]),
            height: self.heights[at],
            outside: [a[at], b[at], c[at]],
        }
    }
}

/// A triangle and which of its edges have no neighbour.
#[derive(Clone, Copy)]
pub(crate) struct DeviationBound<'a> {
    pub(crate) frame: &'a TriangleFrame,
    pub(crate) open: [bool; 3],
}

/// The greatest of what was met, for a triangle that has a plane and neighbours all round. All points are finite.
#[derive(Default)]
struct Greatest {
    height: f64,
    /// Squared distance from the triangle, or for points of curves from the edge.
    squared: f64,
    /// The part of that distance within the plane.
    side: f64,
    drift: f64,
    slopes: [f64; 3],
    /// By edge, the ratio of a curve point's distance from its edge's line, on either side, to the distance from the ends.
    swings: [f64; 3],
    /// A foot stood beyond the ends of its edge.
    beyond: bool,
}

impl Greatest {
    #[inline]
    fn stands(&mut self, height: f64, side: f64) {
        self.height = self.height.max(height.abs());
        self.side = self.side.max(side.abs());
        self.squared = self.squared.max(height * height + side * side);
    }

    /// A point of the surface.
    #[inline]
    fn inner(&mut self, frame: &TriangleFrame, seen: &Seen) {
        let mut side = 0.0f64;
        for edge in 0..3 {
            let outside = seen.outside[edge];
            if exceeds(outside, frame.on_edge()) {
                let room = frame.room_from_first(edge, seen.offset);
                side = side.max(outside);
                self.drift = self.drift.max(outside);
                self.slopes[edge] = self.slopes[edge].max(outside / room);
                self.beyond |= exceeds(0.0, room);
            }
        }
        self.stands(seen.height, side);
    }

    /// The same for a point of the curve over an edge.
    #[inline]
    fn curve(&mut self, frame: &TriangleFrame, edge: usize, seen: &Seen) {
        let Seen { offset, height, outside } = *seen;
        let outside = outside[edge];
        let room = frame.room_from_first(edge, offset);
        self.stands(height, outside);
        if outside.abs() <= frame.on_edge() {
            self.beyond |= exceeds(-room, frame.on_edge());
            return;
        }
        self.beyond |= exceeds(0.0, room);
        self.swings[edge] = self.swings[edge].max(outside.abs() / room);
        if exceeds(outside, 0.0) {
            self.drift = self.drift.max(outside);
            self.slopes[edge] = self.slopes[edge].max(outside / room);
        }
    }
}

impl Greatest {
    /// What that comes to; `None` if the points have to be looked at one by one.
    fn deviation(self, frame: &TriangleFrame) -> Option<Deviation> {
        let Self { height, squared, side, drift, slopes, .. } = self;
        // Squares of tiny lengths vanish.
        let own = if squared > 1e-280 { squared.sqrt() } else { height.hypot(side) };
        // A curve that swings less than the angles at its edge open crosses no other edge.
        let stays = (0..3).all(|edge| self.swings[edge] <= frame.slope_at(edge));
        (stays && !self.beyond).then_some(Deviation { own, height, drift, slopes, across: 0.0 })
    }
}

impl DeviationBound<'_> {
    /// The deviation of a net's points, and a height that the piece itself attains.
    pub(crate) fn net(&self, net: &BezierTriangle, borders: Borders) -> (Deviation, f64) {
        if self.frame.is_flat() || self.open != [false; 3] {
            return (self.each_of_net(net, borders), 0.0);
        }
        let frame = self.frame;
        let Some(seen) = SeenNet::of(net, frame) else {
            return (Deviation::alone(f64::INFINITY), 0.0);
        };
        let mut greatest = Greatest::default();
        for at in INNER {
            greatest.inner(frame, &seen.at(at));
        }
        for (edge, points) in EDGES.iter().enumerate() {
            let border = borders[edge];
            for &at in &points[1..4] {
                if border == INSIDE {
                    greatest.inner(frame, &seen.at(at));
                } else {
                    greatest.curve(frame, border as usize, &seen.at(at));
                }
            }
            let at = points[0];
            match corner(borders, edge) {
                Corner::Own => {}
                Corner::On(border) => greatest.curve(frame, border, &seen.at(at)),
                Corner::Inside => greatest.inner(frame, &seen.at(at)),
            }
        }
        let deviation = greatest.deviation(frame).unwrap_or_else(|| self.each_of_net(net, borders));
        (deviation, attained(&seen.heights))
    }

    /// The deviation of points of the surface, and of curves over edges.
    pub(crate) fn points(
        &self,
        inner: impl Iterator<Item = DVec3> + Clone,
        curves: &[(usize, DVec3)],
    ) -> Deviation {
        let frame = self.frame;
        let is_finite =
            inner.clone().chain(curves.iter().map(|&(_, point)| point)).sum::<DVec3>().is_finite();
        if is_finite && !frame.is_flat() && self.open == [false; 3] {
            let mut greatest = Greatest::default();
            inner.clone().for_each(|point| greatest.inner(frame, &Seen::of(point, frame)));
            curves.iter().for_each(|&(edge, point)| greatest.curve(frame, edge, &Seen::of(point, frame)));
            if let Some(deviation) = greatest.deviation(frame) {
                return deviation;
            }
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

/// The greatest height in the middle of a piece and of its edges, from those of its net.
#[inline]
fn attained(heights: &[f64; SEEN]) -> f64 {
    let mut greatest = 0.0f64;
    let (mut outer, mut halves, mut inner) = (0.0, 0.0, 0.0);
    for &[a, b, c, d, e] in &EDGES {
        let [a, b, c, d, e] = [heights[a], heights[b], heights[c], heights[d], heights[e]];
        let (ends, seconds) = (a + e, b + d);
        greatest = greatest.max((ends + 4.0 * seconds + 6.0 * c).abs() / 16.0);
        outer += a + 4.0 * seconds;
        halves += 6.0 * c;
    }
    for at in INNER {
        inner += 12.0 * heights[at];
    }
    greatest.max((outer + halves + inner).abs() / 81.0)
}
