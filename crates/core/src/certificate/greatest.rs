//! The greatest of what points come to over a triangle that has a plane and neighbours all round, several points at once.
//!
//! Heights and distances from the lines of the edges are products with a few directions, taken for all points in rows. Most points
//! stand inside most edges: only where a row's greatest does not is one looked at after the other.

use super::deviation::Deviation;
use super::exceeds;
use super::triangle_frame::TriangleFrame;
use crate::vector::DVec3;
use crate::vector::Extremes;

/// Points that are seen together: those of a net, rounded up to whole registers.
pub(super) const SEEN: usize = 16;

/// Points of a curve that are seen together: the five of a net, and one again for whole registers.
pub(super) const CURVE: usize = 6;

/// Numbers that are compared together.
const LANES: usize = 4;

/// Points as a triangle sees them from its first corner, by axis and point. Where there are fewer than [`SEEN`] the others stand in
/// that corner.
pub(super) struct SeenPoints {
    offsets: [[f64; SEEN]; 3],
    pub(super) heights: [f64; SEEN],
    /// How far outside the lines of the edges.
    outside: [[f64; SEEN]; 3],
    /// Whether all of them are.
    pub(super) is_finite: bool,
}

impl SeenPoints {
    /// No points.
    pub(super) const NONE: Self =
        Self { offsets: [[0.0; SEEN]; 3], heights: [0.0; SEEN], outside: [[0.0; SEEN]; 3], is_finite: true };

    /// Looks at some points, as many of them as there is room for.
    #[inline]
    pub(super) fn look(&mut self, frame: &TriangleFrame, points: impl Iterator<Item = DVec3>) {
        let [x, y, z] = &mut self.offsets;
        for (((x, y), z), point) in x.iter_mut().zip(y).zip(z).zip(points) {
            let offset = frame.seen_from_first(point);
            (*x, *y, *z) = (offset.x, offset.y, offset.z);
        }
        self.follow(frame);
    }

    /// What follows from the offsets. (In line with what fills them it is mixed up with that, and twice as long.)
    #[inline(never)]
    fn follow(&mut self, frame: &TriangleFrame) {
        let Self { offsets: [x, y, z], heights, outside: [first, second, third], is_finite } = self;
        let (up, [a, b, c]) = (frame.normal(), [0, 1, 2].map(|edge| frame.outward(edge)));
        let [from_a, from_b, from_c] = [0, 1, 2].map(|edge| frame.offset(edge));
        for at in 0..SEEN {
            heights[at] = up.x * x[at] + up.y * y[at] + up.z * z[at];
            first[at] = a.x * x[at] + a.y * y[at] + a.z * z[at] - from_a;
            second[at] = b.x * x[at] + b.y * y[at] + b.z * z[at] - from_b;
            third[at] = c.x * x[at] + c.y * y[at] + c.z * z[at] - from_c;
        }
        let mut sums = [0.0; LANES];
        for row in [x, y, z] {
            for chunk in row.as_chunks::<LANES>().0 {
                (0..LANES).for_each(|l| sums[l] += chunk[l]);
            }
        }
        *is_finite = sums.iter().sum::<f64>().is_finite();
    }

    #[inline]
    fn offset(&self, at: usize) -> DVec3 {
        let ([x, y, z], at) = (&self.offsets, at % SEEN);
        DVec3::new(x[at], y[at], z[at])
    }
}

/// The greatest of what was met. All points are finite.
#[derive(Default)]
pub(super) struct Greatest {
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
        self.side = self.side.larger(side.abs());
        self.squared = self.squared.larger(height * height + side * side);
    }

    /// Points of the surface, one bit each; the heights of all points that are seen count.
    #[inline]
    pub(super) fn inner(&mut self, frame: &TriangleFrame, seen: &SeenPoints, points: u16) {
        let mut sides = [0.0; SEEN];
        let mut beside = 0u16;
        for edge in 0..3 {
            if !exceeds(most(&seen.outside[edge]), frame.on_edge()) {
                continue;
            }
            for at in each(points) {
                let outside = seen.outside[edge][at];
                if exceeds(outside, frame.on_edge()) {
                    let room = frame.room_from_first(edge, seen.offset(at));
                    sides[at] = outside.larger(sides[at]);
                    beside |= 1 << at;
                    self.drift = self.drift.larger(outside);
                    self.slopes[edge] = self.slopes[edge].larger(outside / room);
                    self.beyond |= exceeds(0.0, room);
                }
            }
        }
        each(beside).for_each(|at| self.stands(seen.heights[at], sides[at]));
        self.heights(seen);
    }

    /// The heights of all points that are seen.
    #[inline]
    pub(super) fn heights(&mut self, seen: &SeenPoints) {
        let mut heights = seen.heights;
        heights.iter_mut().for_each(|height| *height = height.abs());
        let height = most(&heights);
        self.height = self.height.larger(height);
        self.squared = self.squared.larger(height * height);
    }

    /// Points of the curve over an edge, by their numbers, some perhaps more than once; their heights are not taken.
    #[inline(never)]
    pub(super) fn curve(
        &mut self,
        frame: &TriangleFrame,
        edge: usize,
        seen: &SeenPoints,
        points: [u8; CURVE],
    ) {
        let [mut x, mut y, mut z, mut heights, mut outside] = [[0.0; CURVE]; 5];
        let row = &seen.outside[edge];
        for (l, at) in points.into_iter().enumerate() {
            let at = usize::from(at) % SEEN;
            (x[l], y[l], z[l]) = (seen.offsets[0][at], seen.offsets[1][at], seen.offsets[2][at]);
            (heights[l], outside[l]) = (seen.heights[at], row[at]);
        }
        let (along, start, length) = (frame.along(edge), frame.start(edge), frame.length(edge));
        let on_edge = frame.on_edge();
        let [mut squares, mut sides, mut swings, mut slopes, mut drifts, mut rooms] = [[0.0; CURVE]; 6];
        for l in 0..CURVE {
            let at = along.x * x[l] + along.y * y[l] + along.z * z[l] - start;
            let (rest, out) = (length - at, outside[l]);
            let room = if at < rest { at } else { rest };
            let side = out.abs();
            squares[l] = heights[l] * heights[l] + out * out;
            sides[l] = side;
            let swing = side / room;
            swings[l] = if side > on_edge { swing } else { 0.0 };
            slopes[l] = if out > on_edge { swing } else { 0.0 };
            drifts[l] = if out > on_edge { out } else { 0.0 };
            rooms[l] = if side > on_edge { room } else { room + on_edge };
        }
        self.squared = greatest(squares, self.squared);
        self.side = greatest(sides, self.side);
        self.swings[edge] = greatest(swings, self.swings[edge]);
        self.slopes[edge] = greatest(slopes, self.slopes[edge]);
        self.drift = greatest(drifts, self.drift);
        self.beyond |= exceeds(greatest(rooms.map(|room| -room), -f64::INFINITY), 0.0);
    }

    /// What that comes to; `None` if the points have to be looked at one by one.
    #[inline]
    pub(super) fn deviation(self, frame: &TriangleFrame) -> Option<Deviation> {
        let Self { height, squared, side, drift, slopes, .. } = self;
        // Squares of tiny lengths vanish.
        let own = if squared > 1e-280 { squared.sqrt() } else { height.hypot(side) };
        // A curve that swings less than the angles at its edge open crosses no other edge.
        let stays = (0..3).all(|edge| self.swings[edge] <= frame.slope_at(edge));
        (stays && !self.beyond).then_some(Deviation { own, height, drift, slopes, across: 0.0 })
    }
}

/// The numbers of the bits that are set.
#[inline]
fn each(mut bits: u16) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let at = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (at < SEEN).then_some(at)
    })
}

/// The greatest of a row, or 0.
#[inline]
fn most(row: &[f64; SEEN]) -> f64 {
    let mut most = [0.0; LANES];
    for chunk in row.as_chunks::<LANES>().0 {
        for l in 0..LANES {
            most[l] = if chunk[l] > most[l] { chunk[l] } else { most[l] };
        }
    }
    greatest(most, 0.0)
}

/// The greatest of some numbers.
#[inline]
fn greatest<const N: usize>(numbers: [f64; N], known: f64) -> f64 {
    numbers.into_iter().fold(known, |most, x| if x > most { x } else { most })
}
