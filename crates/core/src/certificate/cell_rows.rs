//! All parts of a regular piece that a number of divisions into four gives, tested together, row by
//! row.
//!
//! The bound is that of [`super::quartic_cell`], written for rows of numbers: the height of the
//! quadratic part by each part's own plane, the rest by one bound for all parts, which shrinks with
//! the cube of their size; normal deviations against the limit normals at the corners; tangential
//! displacements and slopes by the second derivatives in the middles of the edges. A part passes,
//! or fails for sure, or has to be tested alone. Places and normals are computed in double
//! precision, everything else in single ([`part_bounds`]).

mod few_parts;
mod part_bounds;

use core::array::from_fn;

use super::quartic_cell::{
    CUBIC, CURVE_CUBIC, Domain, QUARTIC, QUARTIC_SLOPE, QuarticJet, edge_range, quadratic,
    quadratic_height,
};
use crate::patch::{Quartic, reciprocal_power};
use crate::vector::DVec3;
use crate::vector::Extremes;
use few_parts::{FEW, FEW_DIVISIONS, FewParts};
use part_bounds::{Found, LANES, Parts, Remainder, Slices, above, measure};
use wide::f32x4;

/// Divisions at most.
pub(crate) const MOST_DIVISIONS: u32 = 6;

/// Numbers in a row: corners of the most parts, rounded up for whole registers.
const WIDTH: usize = (1 << MOST_DIVISIONS) + 16;

/// Bounds that do not leave more than this part of the target to the remainder are worth while.
const REMAINDER: f64 = 0.5;

/// Numbers by axis and place.
type Row = [[f64; WIDTH]; 3];

/// A row of points in single precision.
type NarrowRow = [[f32; WIDTH]; 3];

/// The test outcome of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Mark {
    /// Within the target.
    Passes,
    /// Not within the target for sure.
    Fails,
    /// To be tested alone.
    Open,
}

/// The target of the tests of parts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowTarget {
    /// Greatest bound of the distance.
    pub(crate) distance: f64,
    /// The weight of the range of heights, relative to the greatest height on one side; 0 where it
    /// does not count.
    pub(crate) range_share: f64,
    /// The greatest normal deviation of the adjacent triangles, as a chord.
    pub(crate) normal_deviation: f64,
    /// The least tangent of the angles of the adjacent triangles.
    pub(crate) slope: f64,
    /// The share of the least of 1 and the tangents of a part's own angles that tangential
    /// displacements over an edge may have ([`TriangleFrame::slope_at`]).
    ///
    /// [`TriangleFrame::slope_at`]: super::triangle_frame::TriangleFrame::slope_at
    pub(crate) displacement_share: f64,
}

/// The greatest bounds of the parts that passed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowExtent {
    pub(crate) normal_deviation: f64,
    pub(crate) slope: f64,
    pub(crate) displacement_slope: f64,
    pub(crate) bound: f64,
}

impl RowExtent {
    pub(crate) const NONE: Self = Self {
        normal_deviation: 0.0,
        slope: f64::INFINITY,
        displacement_slope: 0.0,
        bound: 0.0,
    };
}

/// Marks of the parts of a level: upright ones and inverted ones, by row and column.
#[derive(Default)]
pub(crate) struct Marks {
    n: usize,
    upright: Vec<Mark>,
    inverted: Vec<Mark>,
}

impl Marks {
    /// The mark of the part in column i and row j.
    pub(crate) fn at(&self, i: usize, j: usize, is_inverted: bool) -> Mark {
        let list = if is_inverted {
            &self.inverted
        } else {
            &self.upright
        };
        list[j * self.n + i]
    }

    /// Whether all parts pass.
    pub(crate) fn are_all_passing(&self) -> bool {
        (0..self.n).all(|j| {
            let count = self.n - j;
            let upright = &self.upright[j * self.n..j * self.n + count];
            let inverted = &self.inverted[j * self.n..j * self.n + count - 1];
            upright
                .iter()
                .chain(inverted)
                .all(|&mark| mark == Mark::Passes)
        })
    }
}

/// Second derivatives along the edges of a row, in single precision.
struct Bends {
    along: NarrowRow,
    /// A bound of the sums of the absolute coordinates.
    size: f32,
}

/// A row of corners, its limit normals, and its edges.
struct CornerRow {
    points: Row,
    normals: NarrowRow,
    edges: NarrowRow,
    bends: Bends,
}

/// The differences between two rows of corners: edges from row to row, and the second derivatives
/// along these and along those of the third kind.
struct Between {
    edges: NarrowRow,
    upward: Bends,
    across: Bends,
}

/// Memory for the rows of a level, used again from call to call.
pub(crate) struct CellRows {
    /// The row at hand and the next, by turns.
    corners: [CornerRow; 2],
    between: Between,
    /// Normals before they are rounded.
    normals: Row,
    few: Box<FewParts>,
    found: Found,
}

impl Default for CellRows {
    fn default() -> Self {
        let (row, narrow) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        let bends = || Bends {
            along: narrow,
            size: 0.0,
        };
        let corners = [0; 2].map(|_| CornerRow {
            points: row,
            normals: narrow,
            edges: narrow,
            bends: bends(),
        });
        Self {
            corners,
            between: Between {
                edges: narrow,
                upward: bends(),
                across: bends(),
            },
            normals: row,
            few: Box::default(),
            found: Found::default(),
        }
    }
}

/// A node of a regular piece, and bounds of the derivatives over it.
pub(crate) struct RowBlock<'a> {
    piece: &'a Quartic,
    jet: &'a QuarticJet,
    at: Domain,
    size: f64,
    /// The tangents in the middle.
    tangents: [DVec3; 2],
    /// The remainder's height for parts of size 1, by the third and the fourth derivatives.
    height: [f64; 2],
}

impl<'a> RowBlock<'a> {
    /// The node whose first corner is given, with edges of this length in the domain, negative for inverted nodes.
    pub(crate) fn of(piece: &'a Quartic, jet: &'a QuarticJet, at: Domain, size: f64) -> Self {
        // Third derivatives along edges and of the bubble are linear: greatest in a corner.
        let corners = [at, [at[0] + size, at[1]], [at[0], at[1] + size]];
        let (mut third, mut bubble) = (0.0f64, 0.0f64);
        for corner in corners {
            let [a, b, c, d] = jet.third_at(corner);
            let across = d - a + 3.0 * (b - c);
            let most = a
                .length_squared()
                .larger(d.length_squared())
                .larger(across.length_squared());
            third = third.larger(most);
            bubble =
                bubble.larger((-0.25 * (a + 2.0 * (b - a)) + (across + d) / 12.0).length_squared());
        }
        let [a, b, c, d, e] = *jet.fourth();
        let pairs = [
            a,
            e,
            a - 4.0 * b + 6.0 * c - 4.0 * d + e,
            c,
            a - 2.0 * b + c,
            e - 2.0 * d + c,
        ];
        let fourth = pairs
            .iter()
            .map(|pair| pair.length_squared())
            .fold(0.0, f64::max);
        let middle = at.map(|from| from + size / 3.0);
        Self {
            piece,
            jet,
            at,
            size,
            tangents: piece.tangents(middle[0], middle[1]),
            height: [
                CUBIC * third.sqrt() + bubble.sqrt() / 27.0,
                QUARTIC * fourth.sqrt(),
            ],
        }
    }

    /// The divisions below which parts certainly fail by the second derivatives in a few places,
    /// and those at which they pass.
    pub(crate) fn levels(
        &self,
        &RowTarget {
            distance,
            range_share,
            ..
        }: &RowTarget,
    ) -> (u32, u32) {
        let [u, v] = self.tangents;
        let normal = u.cross(v).normalize_or_zero();
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        let square = self.size * self.size;
        for [s, t] in [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
        ] {
            let place = [self.at[0] + s * self.size, self.at[1] + t * self.size];
            let [uu, uv, vv] = self.jet.second_at(place).map(|c| normal.dot(c) * square);
            let bends = [uu, uu - 2.0 * uv + vv, vv];
            let height = quadratic_height(bends).larger(range_share * edge_range(bends));
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

    /// A bound of the height of the surface over the quadratic part.
    fn rest(&self, step: f64) -> f64 {
        let cube = step * step * step;
        self.height[0] * cube + self.height[1] * cube * step
    }

    /// The bound of all parts of a size, times a factor.
    fn remainder(&self, step: f64, scale: f64) -> Remainder {
        let (third, fourth) = self.jet.most(step);
        let bounds = [
            self.rest(step),
            CURVE_CUBIC * third + fourth / 384.0,
            third / 12.0 + fourth / 48.0,
            0.5 * third + QUARTIC_SLOPE * fourth,
        ];
        let [height, curve, steep, first] = bounds.map(|bound| above(scale * bound));
        Remainder {
            height,
            curve,
            steep,
            first,
        }
    }

    /// The power of two that makes edges of parts about 1.
    fn scale(&self, step: f64) -> f64 {
        let [u, v] = self.tangents;
        reciprocal_power(step * u.abs().max(v.abs()).max_element())
    }

    /// The size of the parts of a level.
    fn step(&self, divisions: u32) -> f64 {
        (self.size / f64::from(1u32 << divisions)).abs()
    }

    /// Whether parts of a level are small enough for their remainders not to matter.
    pub(crate) fn is_fine(&self, divisions: u32, distance: f64) -> bool {
        self.rest(self.step(divisions)) <= REMAINDER * distance
    }
}

impl CellRows {
    /// Tests the parts of so many divisions.
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
        for list in [&mut marks.upright, &mut marks.inverted] {
            list.clear();
            list.resize(n * n, Mark::Passes);
        }
        let scale = block.scale(block.step(divisions));
        let rest = block.remainder(block.step(divisions), scale);
        if divisions <= FEW_DIVISIONS {
            let few = &mut self.few;
            few.fill(block, n, scale);
            measure(n * n, &few.parts(), &rest, target, &mut self.found);
            let mut found = [Mark::Passes; FEW];
            self.found.mark(scale, target, extent, &mut found[..n * n]);
            for (number, &(i, j, is_inverted)) in few.places[..n * n].iter().enumerate() {
                let list = if is_inverted {
                    &mut marks.inverted
                } else {
                    &mut marks.upright
                };
                list[j * n + i] = found[number];
            }
            return;
        }
        self.corners[0].fill(block, scale, 0, n, &mut self.normals);
        for j in 0..n {
            let count = n - j;
            let [first, second] = &mut self.corners;
            let (lower, upper) = if j % 2 == 0 {
                (first, second)
            } else {
                (second, first)
            };
            upper.fill(block, scale, j + 1, n, &mut self.normals);
            self.between
                .fill(block, scale, j, n, [&lower.points, &upper.points]);
            let rows =
                [false, true].map(|is_inverted| self.between.parts(lower, upper, is_inverted));
            let lists = [&mut marks.upright, &mut marks.inverted];
            for (is_inverted, (parts, list)) in
                [false, true].into_iter().zip(rows.iter().zip(lists))
            {
                let count = count - usize::from(is_inverted);
                if count == 0 {
                    continue;
                }
                measure(count, parts, &rest, target, &mut self.found);
                let own = &mut list[j * n..j * n + count];
                self.found.mark(scale, target, extent, own);
            }
        }
    }
}

impl CornerRow {
    /// Row j of a node whose edges are cut into n: its corners, its edges, and the second derivatives along them.
    fn fill(&mut self, block: &RowBlock<'_>, scale: f64, j: usize, n: usize, wide: &mut Row) {
        let (step, count) = (block.size / n as f64, n - j);
        let v = block.at[1] + step * j as f64;
        block.piece.by_axis_along(
            v,
            block.at[0],
            step,
            count + 1,
            [&mut self.points, &mut *wide],
        );
        for (points, edges) in self.points.iter().zip(&mut self.edges) {
            differences(&points[..count], &points[1..count + 1], scale, edges);
        }
        for (rounded, normals) in self.normals.iter_mut().zip(wide) {
            let normals = rounded.iter_mut().zip(&normals[..count + 1]);
            normals.for_each(|(rounded, &normal)| *rounded = normal as f32);
        }
        let ([uu, ..], factor) = (block.jet.second(), step * step * scale);
        self.bends
            .fill(uu, [block.at[0] + 0.5 * step, v], step, count, factor);
    }
}

impl Between {
    /// Fills the differences between row j of a node whose edges are cut into n and the next row, by the corners of both.
    fn fill(
        &mut self,
        block: &RowBlock<'_>,
        scale: f64,
        j: usize,
        n: usize,
        [lower, upper]: [&Row; 2],
    ) {
        let (step, count) = (block.size / n as f64, n - j);
        for axis in 0..3 {
            differences(
                &lower[axis][..count],
                &upper[axis][..count],
                scale,
                &mut self.edges[axis],
            );
        }
        let (u, v) = (block.at[0], block.at[1] + step * (j as f64 + 0.5));
        let [uu, uv, vv] = block.jet.second();
        let across: [DVec3; 6] = from_fn(|i| uu[i] - 2.0 * uv[i] + vv[i]);
        let factor = step * step * scale;
        self.across
            .fill(&across, [u + 0.5 * step, v], step, count, factor);
        self.upward.fill(vv, [u, v], step, count + 1, factor);
    }

    /// The parts between two rows: the upright ones, or the inverted ones.
    fn parts<'r>(
        &'r self,
        lower: &'r CornerRow,
        upper: &'r CornerRow,
        is_inverted: bool,
    ) -> Parts<'r> {
        // Inverted ones have their edge along a row in the upper one, and the others turned.
        let (own, turned) = if is_inverted { (upper, 1) } else { (lower, 0) };
        let size = self
            .across
            .size
            .larger(self.upward.size)
            .larger(own.bends.size);
        let normals = match is_inverted {
            false => [
                at(&lower.normals, 0),
                at(&lower.normals, 1),
                at(&upper.normals, 0),
            ],
            true => [
                at(&upper.normals, 1),
                at(&upper.normals, 0),
                at(&lower.normals, 1),
            ],
        };
        Parts {
            edges: [at(&own.edges, 0), at(&self.edges, turned)],
            is_turned: is_inverted,
            normals,
            bends: [
                at(&own.bends.along, 0),
                at(&self.across.along, 0),
                at(&self.upward.along, turned),
            ],
            size,
        }
    }
}

/// From each number to the other, times a factor.
#[inline]
fn differences(from: &[f64], to: &[f64], factor: f64, out: &mut [f32]) {
    for ((out, from), to) in out.iter_mut().zip(from).zip(to) {
        *out = ((to - from) * factor) as f32;
    }
}

impl Bends {
    /// A quadratic polynomial in `count` places along a row, times a factor. Values are off by ten roundings of the size at most.
    fn fill(&mut self, c: &[DVec3; 6], [u, v]: Domain, step: f64, count: usize, factor: f64) {
        // By the number of the place over that of all.
        let length = step * count as f64;
        let (square, linear) = (c[3] * factor, (c[1] + c[4] * v) * factor);
        let constant = (c[0] + (c[2] + c[5] * v) * v) * factor;
        let from = (square * u + linear) * u + constant;
        let (by_one, by_two) = (
            (2.0 * u * square + linear) * length,
            square * (length * length),
        );
        let share = 1.0 / count as f32;
        self.size = 0.0;
        for axis in 0..3 {
            let (a, b, c) = (by_two[axis] as f32, by_one[axis] as f32, from[axis] as f32);
            self.size += a.abs() + b.abs() + c.abs();
            let mut number = f32x4::from([0.0, 1.0, 2.0, 3.0]);
            let fours = self.along[axis].as_chunks_mut::<LANES>().0.iter_mut();
            for four in fours.take(count.div_ceil(LANES)) {
                let t = number * share;
                *four = ((a * t + b) * t + c).to_array();
                number += LANES as f32;
            }
        }
    }
}

fn at(row: &NarrowRow, from: usize) -> Slices<'_> {
    let [x, y, z] = row;
    [&x[from..], &y[from..], &z[from..]]
}

impl QuarticJet {
    fn second_at(&self, place: Domain) -> [DVec3; 3] {
        let [uu, uv, vv] = self.second();
        [
            quadratic(uu, place),
            quadratic(uv, place),
            quadratic(vv, place),
        ]
    }
}

#[cfg(test)]
mod tests;
