//! All parts of a regular piece that a number of divisions into four gives, tested at once, row by row.
//!
//! The bound is that of [`super::quartic_cell`], written for rows of numbers: the height of the quadratic part by each
//! part's own plane, what is left by one bound for all parts, which shrinks with the cube of their size; tilts against the limit
//! normals at the corners; drifts and slopes by the second derivatives in the middles of the edges. A part passes, or
//! fails for sure, or has to be looked at by itself.

mod few_parts;

use core::array::from_fn;

use super::quartic_cell::{
    CUBIC, CURVE_CUBIC, DIRECTIONS, Domain, NEARLY_ONE, QUARTIC, QuarticJet, quadratic,
};
use crate::patch::Quartic;
use crate::vector::DVec3;
use crate::vector::Extremes;
use few_parts::{FEW, FEW_DIVISIONS, FewParts};

/// Divisions at most.
pub(crate) const MOST_DIVISIONS: u32 = 6;

/// Numbers in a row: corners of the most parts, rounded up for whole registers.
const WIDTH: usize = (1 << MOST_DIVISIONS) + 16;

/// Bounds that do not leave more than this part of the target to the remainder are worth while.
const REMAINDER: f64 = 0.06;

/// What is added to a tilt for rounding.
const ROUNDING: f64 = 1e-12;

/// The greatest squared chord of the angle between triangles that help each other, as in [`super::deviation`].
const SHARPEST: f64 = 3.464;

type Row = [[f64; WIDTH]; 3];

/// What becomes of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Mark {
    /// Within the target.
    Passes,
    /// Not within the target for sure.
    Fails,
    /// To be looked at by itself.
    Open,
}

/// What parts are tested for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowTarget {
    /// Greatest bound of the distance.
    pub(crate) distance: f64,
    /// Tilt of the triangles beside a part at most, as a chord.
    pub(crate) tilt: f64,
    /// Tangents of the angles of the triangles beside a part at least.
    pub(crate) slope: f64,
    /// Drifts over an edge may have so much of the least of 1 and the tangents of a part's own angles there ([`TriangleFrame::slope_at`]).
    ///
    /// [`TriangleFrame::slope_at`]: super::triangle_frame::TriangleFrame::slope_at
    pub(crate) drift_share: f64,
}

/// What the parts that passed come to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowExtent {
    pub(crate) tilt: f64,
    pub(crate) slope: f64,
    pub(crate) drift_slope: f64,
    pub(crate) bound: f64,
    /// The part with that bound, by column and row, whether it stands on its head, and the divisions.
    pub(crate) worst: Option<(usize, usize, bool, u32)>,
}

impl RowExtent {
    pub(crate) const NONE: Self =
        Self { tilt: 0.0, slope: f64::INFINITY, drift_slope: 0.0, bound: 0.0, worst: None };
}

/// Marks of the parts of a level: upright ones and those on their heads, by row and column.
#[derive(Default)]
pub(crate) struct Marks {
    n: usize,
    upright: Vec<Mark>,
    headlong: Vec<Mark>,
}

impl Marks {
    /// The mark of the part in column i and row j.
    pub(crate) fn at(&self, i: usize, j: usize, is_headlong: bool) -> Mark {
        let list = if is_headlong { &self.headlong } else { &self.upright };
        list[j * self.n + i]
    }

    /// Whether all parts pass.
    pub(crate) fn are_all_passing(&self) -> bool {
        (0..self.n).all(|j| {
            let count = self.n - j;
            let upright = &self.upright[j * self.n..j * self.n + count];
            let headlong = &self.headlong[j * self.n..j * self.n + count - 1];
            upright.iter().chain(headlong).all(|&mark| mark == Mark::Passes)
        })
    }
}

/// Rows of what a level needs, kept from call to call.
pub(crate) struct CellRows {
    points: [Row; 2],
    normals: [Row; 2],
    along: [Row; 2],
    diagonal: Row,
    upward: Row,
    few: Box<FewParts>,
    found: Found,
}

/// By part of a row.
struct Found {
    bound: [f64; WIDTH],
    low: [f64; WIDTH],
    tilt: [f64; WIDTH],
    slope: [f64; WIDTH],
    drift_slope: [f64; WIDTH],
}

impl Default for CellRows {
    fn default() -> Self {
        let row = [[0.0; WIDTH]; 3];
        let [bound, low, tilt, slope, drift_slope] = [[0.0; WIDTH]; 5];
        Self {
            points: [row; 2],
            normals: [row; 2],
            along: [row; 2],
            diagonal: row,
            upward: row,
            few: Box::default(),
            found: Found { bound, low, tilt, slope, drift_slope },
        }
    }
}

/// Bounds that hold for all parts of a level.
#[derive(Clone, Copy)]
struct Remainder {
    height: f64,
    /// Of the distance of curves from their edges, and of the slope towards their ends.
    curve: f64,
    steep: f64,
    /// Of first derivatives along edges.
    first: f64,
}

/// A node of a regular piece, and what bounds derivatives all over it.
pub(crate) struct RowBlock<'a> {
    piece: &'a Quartic,
    jet: &'a QuarticJet,
    at: Domain,
    size: f64,
    /// The remainder's height for parts of size 1, by the third and the fourth derivatives.
    height: [f64; 2],
}

impl<'a> RowBlock<'a> {
    /// The node whose first corner is given, with edges of this length in the domain, negative for nodes on their heads.
    pub(crate) fn of(piece: &'a Quartic, jet: &'a QuarticJet, at: Domain, size: f64) -> Self {
        // Third derivatives along edges and of the bubble are linear: greatest in a corner.
        let corners = [at, [at[0] + size, at[1]], [at[0], at[1] + size]];
        let (mut third, mut bubble) = (0.0f64, 0.0f64);
        for corner in corners {
            let [a, b, c, d] = jet.third_at(corner);
            let across = d - a + 3.0 * (b - c);
            let most = a.length_squared().larger(d.length_squared()).larger(across.length_squared());
            third = third.larger(most);
            bubble = bubble.larger((-0.25 * (a + 2.0 * (b - a)) + (across + d) / 12.0).length_squared());
        }
        let [a, b, c, d, e] = *jet.fourth();
        let pairs = [a, e, a - 4.0 * b + 6.0 * c - 4.0 * d + e, c, a - 2.0 * b + c, e - 2.0 * d + c];
        let fourth = pairs.iter().map(|pair| pair.length_squared()).fold(0.0, f64::max);
        Self {
            piece,
            jet,
            at,
            size,
            height: [CUBIC * third.sqrt() + bubble.sqrt() / 27.0, QUARTIC * fourth.sqrt()],
        }
    }

    /// The divisions below which parts certainly fail, as far as the second derivatives in a few places tell, and those by which
    /// they pass.
    pub(crate) fn levels(&self, distance: f64) -> (u32, u32) {
        let third = self.size / 3.0;
        let [u, v] = self.piece.tangents(self.at[0] + third, self.at[1] + third);
        let normal = u.cross(v).normalize_or_zero();
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        let square = self.size * self.size;
        for [s, t] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]] {
            let place = [self.at[0] + s * self.size, self.at[1] + t * self.size];
            let [uu, uv, vv] = self.jet.second_at(place).map(|c| normal.dot(c) * square);
            let height = super::quartic_cell::quadratic_height([uu, uu - 2.0 * uv + vv, vv]);
            (least, most) = (least.smaller(height), most.larger(height));
        }
        let levels = |height: f64| {
            let (mut height, mut levels) = (height, 0);
            while height > distance && levels < 3 * MOST_DIVISIONS {
                height *= 0.25;
                levels += 1;
            }
            levels
        };
        (levels(least), levels(most))
    }

    fn remainder(&self, divisions: u32) -> Remainder {
        let step = (self.size / f64::from(1u32 << divisions)).abs();
        let cube = step * step * step;
        let (third, fourth) = self.jet.most(step);
        Remainder {
            height: self.height[0] * cube + self.height[1] * cube * step,
            curve: CURVE_CUBIC * third + fourth / 384.0,
            steep: third / 12.0 + fourth / 48.0,
            first: 0.5 * third + fourth,
        }
    }

    /// Whether parts of a level are small enough for their remainders not to matter.
    pub(crate) fn is_fine(&self, divisions: u32, distance: f64) -> bool {
        self.remainder(divisions).height <= REMAINDER * distance
    }
}

impl CellRows {
    /// Tests the parts that so many divisions give.
    pub(crate) fn test(
        &mut self,
        block: &RowBlock<'_>,
        divisions: u32,
        target: &RowTarget,
        extent: &mut RowExtent,
        marks: &mut Marks,
    ) {
        let n = 1usize << divisions;
        marks.n = n;
        for list in [&mut marks.upright, &mut marks.headlong] {
            list.clear();
            list.resize(n * n, Mark::Passes);
        }
        let rest = block.remainder(divisions);
        if divisions <= FEW_DIVISIONS {
            let few = &mut self.few;
            few.fill(block, n);
            measure(n * n, &few.parts(), &rest, target, &mut self.found);
            let mut found = [Mark::Passes; FEW];
            let worst = self.found.mark(n * n, target, extent, &mut found);
            for (number, &(i, j, is_headlong)) in few.places[..n * n].iter().enumerate() {
                let list = if is_headlong { &mut marks.headlong } else { &mut marks.upright };
                list[j * n + i] = found[number];
                if worst == Some(number) {
                    extent.worst = Some((i, j, is_headlong, divisions));
                }
            }
            return;
        }
        let step = block.size / n as f64;
        self.row(block, step, 0, n, 0);
        for j in 0..n {
            let (count, now) = (n - j, j % 2);
            self.row(block, step, j + 1, n, 1 - now);
            self.middles(block, step, j, count);
            let (lower, upper) = (&self.points[now], &self.points[1 - now]);
            let (lower_normals, upper_normals) = (&self.normals[now], &self.normals[1 - now]);
            let upright = Parts {
                corners: [at(lower, 0), at(lower, 1), at(upper, 0)],
                normals: [at(lower_normals, 0), at(lower_normals, 1), at(upper_normals, 0)],
                bends: [at(&self.along[now], 0), at(&self.diagonal, 0), at(&self.upward, 0)],
            };
            measure(count, &upright, &rest, target, &mut self.found);
            let found = &self.found;
            if let Some(i) = found.mark(count, target, extent, &mut marks.upright[j * n..j * n + count]) {
                extent.worst = Some((i, j, false, divisions));
            }
            if count > 1 {
                let headlong = Parts {
                    corners: [at(upper, 1), at(upper, 0), at(lower, 1)],
                    normals: [at(upper_normals, 1), at(upper_normals, 0), at(lower_normals, 1)],
                    bends: [at(&self.along[1 - now], 0), at(&self.diagonal, 0), at(&self.upward, 1)],
                };
                measure(count - 1, &headlong, &rest, target, &mut self.found);
                let (found, own) = (&self.found, &mut marks.headlong[j * n..j * n + count - 1]);
                if let Some(i) = found.mark(count - 1, target, extent, own) {
                    extent.worst = Some((i, j, true, divisions));
                }
            }
        }
    }

    /// The corners in row j, and the second derivatives along its edges.
    fn row(&mut self, block: &RowBlock<'_>, step: f64, j: usize, n: usize, slot: usize) {
        let v = block.at[1] + step * j as f64;
        let out = [&mut self.points[slot], &mut self.normals[slot]];
        block.piece.by_axis_along(v, block.at[0], step, n - j + 1, out);
        let [uu, ..] = block.jet.second();
        quadratic_row(uu, [block.at[0] + 0.5 * step, v], step, n - j, step * step, &mut self.along[slot]);
    }

    /// The second derivatives along the edges between rows.
    fn middles(&mut self, block: &RowBlock<'_>, step: f64, j: usize, count: usize) {
        let v = block.at[1] + step * (j as f64 + 0.5);
        let [uu, uv, vv] = block.jet.second();
        let across: [DVec3; 6] = from_fn(|i| uu[i] - 2.0 * uv[i] + vv[i]);
        let square = step * step;
        quadratic_row(&across, [block.at[0] + 0.5 * step, v], step, count, square, &mut self.diagonal);
        quadratic_row(vv, [block.at[0], v], step, count + 1, square, &mut self.upward);
    }
}

/// A quadratic polynomial along a row, times a factor.
fn quadratic_row(c: &[DVec3; 6], [u, v]: Domain, step: f64, count: usize, factor: f64, out: &mut Row) {
    let (square, linear) = (c[3] * factor, (c[1] + c[4] * v) * factor);
    let constant = (c[0] + (c[2] + c[5] * v) * v) * factor;
    let count = count.next_multiple_of(8).min(WIDTH);
    for axis in 0..3 {
        let (a, b, c) = (square[axis], linear[axis], constant[axis]);
        for (i, value) in out[axis][..count].iter_mut().enumerate() {
            let t = u + step * i as f64;
            *value = (a * t + b) * t + c;
        }
    }
}

type Slices<'a> = [&'a [f64]; 3];

fn at(row: &Row, from: usize) -> Slices<'_> {
    let [x, y, z] = row;
    [&x[from..], &y[from..], &z[from..]]
}

/// Parts of a row: their corners, the limit normals there, and the second derivatives along their edges.
struct Parts<'a> {
    corners: [Slices<'a>; 3],
    normals: [Slices<'a>; 3],
    bends: [Slices<'a>; 3],
}

/// Bounds of the first `count` parts.
#[inline(never)]
fn measure(count: usize, parts: &Parts<'_>, rest: &Remainder, target: &RowTarget, found: &mut Found) {
    let n = count.next_multiple_of(4).min(WIDTH - 8);
    let [p0, p1, p2] = parts.corners.map(|slices| shortened(&slices, n));
    let [m0, m1, m2] = parts.normals.map(|slices| shortened(&slices, n));
    let [w0, w1, w2] = parts.bends.map(|slices| shortened(&slices, n));
    let (bound, low) = (&mut found.bound[..n], &mut found.low[..n]);
    let (tilt_out, slope_out, drift_out) =
        (&mut found.tilt[..n], &mut found.slope[..n], &mut found.drift_slope[..n]);
    let (allowed, share, neighbour) = (target.slope, target.drift_share, target.tilt);
    for i in 0..n {
        let at = |s: &Slices<'_>| [s[0][i], s[1][i], s[2][i]];
        let (a, b) = (minus(at(&p1), at(&p0)), minus(at(&p2), at(&p0)));
        let c = minus(b, a);
        let across = cross(a, b);
        let square = dot(across, across);
        let area = square.sqrt();
        let normal = scaled(across, 1.0 / area);
        // Heights of the quadratic part.
        let (wa, wc, wb) = (at(&w0), at(&w1), at(&w2));
        let (p, q, s) = (dot(wa, normal), dot(wc, normal), dot(wb, normal));
        let edges = 0.125 * p.abs().larger(q.abs()).larger(s.abs());
        let (l2, l1, l0) = (p * (q + s - p), s * (p + q - s), q * (p + s - q));
        let total = l0 + l1 + l2;
        let inner = (0.5 * p * q * s / total).abs();
        let is_inside = (l0 * total > 0.0) & (l1 * total > 0.0) & (l2 * total > 0.0);
        let height = if is_inside { edges.larger(inner) } else { edges };
        low[i] = height - rest.height;
        // Tilts.
        let off = |m: &Slices<'_>| {
            let d = minus(at(m), normal);
            dot(d, d)
        };
        let tilt = off(&m0).larger(off(&m1)).larger(off(&m2)).sqrt() + ROUNDING;
        let chord = tilt + neighbour;
        // Angles.
        let (la, lb, lc) = (dot(a, a), dot(b, b), dot(c, c));
        let (first, second, third) = (dot(a, b), -dot(a, c), dot(b, c));
        let slope = area / first.larger(second).larger(third);
        // Beside the edges: the second derivatives outwards, times the edges' lengths.
        let out = [-dot(wa, cross(a, normal)), -dot(wc, cross(c, normal)), dot(wb, cross(b, normal))];
        let longest = la.larger(lb).larger(lc);
        let steep = rest.steep * longest.sqrt();
        let ratio = |out: f64, bend: [f64; 3], edge: [f64; 3], square: f64| {
            (0.5 * out.abs() + steep) / (square - 0.5 * dot(bend, edge).abs() - steep)
        };
        let (ra, rc, rb) = (ratio(out[0], wa, a, la), ratio(out[1], wc, c, lc), ratio(out[2], wb, b, lb));
        let drift_slope = ra.larger(rb).larger(rc);
        // Negative where there is no room at all.
        let is_roomy = (ra >= 0.0) & (rb >= 0.0) & (rc >= 0.0);
        let reach = out[0].larger(out[1]).larger(out[2]).larger(0.0);
        let drift = 0.125 * (reach * reach / la.smaller(lb).smaller(lc)).sqrt() + rest.curve;
        // Within the angles at each edge.
        let (first, second, third) = (first.abs(), second.abs(), third.abs());
        let most = share * area;
        let stays = (ra * first.larger(second).larger(area) <= most)
            & (rc * second.larger(third).larger(area) <= most)
            & (rb * third.larger(first).larger(area) <= most);
        // No two points in one place: see `quartic_cell`. Changes of barycentric coordinates times the area.
        let (oa, ob) = (cross(a, normal), cross(b, normal));
        let stretched = |w: [f64; 3]| {
            let (x, y) = (dot(w, oa), dot(w, ob));
            x * x + y * y - x * y
        };
        let most = stretched(wa).larger(stretched(wb)).larger(stretched(wc)).sqrt();
        let stretch = (0.5 * (la + lb + lc)).sqrt();
        let is_apart = most + DIRECTIONS * rest.first * stretch < NEARLY_ONE * area;
        let is_plain = is_roomy & stays & is_apart & (drift_slope <= allowed) & (chord * chord <= SHARPEST);
        let value = (height + rest.height) * (1.0 + 0.5 * chord * chord) + chord * drift;
        bound[i] = if is_plain { value } else { f64::INFINITY };
        tilt_out[i] = tilt;
        slope_out[i] = slope;
        drift_out[i] = drift_slope;
    }
}

fn shortened<'a>([x, y, z]: &Slices<'a>, n: usize) -> Slices<'a> {
    [&x[..n], &y[..n], &z[..n]]
}

impl Found {
    /// Marks parts, and keeps what those that pass come to. Gives the number of one with a greater bound than any before.
    fn mark(
        &self,
        count: usize,
        target: &RowTarget,
        extent: &mut RowExtent,
        marks: &mut [Mark],
    ) -> Option<usize> {
        let mut worst = None;
        for (i, mark) in marks.iter_mut().enumerate().take(count) {
            let bound = self.bound[i];
            *mark = if bound <= target.distance {
                extent.tilt = extent.tilt.larger(self.tilt[i]);
                extent.slope = extent.slope.smaller(self.slope[i]);
                extent.drift_slope = extent.drift_slope.larger(self.drift_slope[i]);
                if bound > extent.bound {
                    (extent.bound, worst) = (bound, Some(i));
                }
                Mark::Passes
            } else if self.low[i] > target.distance {
                Mark::Fails
            } else {
                Mark::Open
            };
        }
        worst
    }
}

#[inline(always)]
fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn scaled(a: [f64; 3], by: f64) -> [f64; 3] {
    [a[0] * by, a[1] * by, a[2] * by]
}

impl QuarticJet {
    fn second_at(&self, place: Domain) -> [DVec3; 3] {
        let [uu, uv, vv] = self.second();
        [quadratic(uu, place), quadratic(uv, place), quadratic(vv, place)]
    }
}

#[cfg(test)]
mod tests;
