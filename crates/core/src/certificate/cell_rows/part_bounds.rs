//! Bounds of many parts of a regular piece at once, in single precision: a register holds twice as
//! many parts, and the rounding errors are added to the bounds.
//!
//! **Rounding.** Let u = 2⁻²⁴, η = 16u L/A ([`UNSURE`]) for a part whose longest edge has the
//! square L and whose edges span the parallelogram A ≤ √(3/4) L, and w a bound of the sums of the
//! absolute coordinates of bends. Edges and limit normals come rounded once, bends are off by 10uw.
//! Then
//!
//! * a × b is off by 8u|a||b| at most, so the unit normal by 8u|a||b|/A + 4u ≤ ¾η, products of bends with it by ¾ηw + 14uw ≤ 1.6ηw, and
//!   the greatest height of the quadratic part, ½ Σ λᵢλⱼWᵢⱼ with Σ λᵢλⱼ ≤ 1/3, by 0.3ηw;
//! * distances between the normal and limit normals are off by less than 2η;
//! * A and the products of edges are off by 8u|a||b|: A by the part η of it, and the greatest product, at least L/4, by 3η;
//! * products of bends with edges, or with vectors perpendicular to them, are off by 2ηw√L.
//!
//! **The quadratic's greatest height** is an eighth of the greatest bend W, or that of the point
//! where both derivatives vanish, if it is inside. The point's barycentric coordinates are the
//! three products of [`quadratic_height`] over their sum. Each of them is off by 12uW², the sum by
//! 40uW²: where the sum is more than W²/256, coordinates are off by less than 2⁻¹⁰, and so is the
//! height, relatively ([`NEARLY`]). Where it is less, the quadratic is nearly one of one direction.
//! If there is a greatest height inside, then the ridge through the middle of the edge that bends
//! most is concave and starts with the slope ¼(W₁ + W₂ − W), the other bends relative to the sign of W:
//! its height is W/8 plus the rise by that slope, and never more than W/6.
//!
//! [`quadratic_height`]: super::super::quartic_cell::quadratic_height

use super::super::quartic_cell::{DIRECTIONS, NEARLY_ONE};
use super::{Mark, RowExtent, RowTarget, WIDTH};
use crate::vector::Extremes;
use wide::f32x4;

/// Parts that are measured together.
pub(super) const LANES: usize = 4;

/// By this times L/A a part is known less well than it is: 16 times 2⁻²⁴.
const UNSURE: f32 = 1.0 / (1 << 20) as f32;

/// The error of coordinates of the highest point, and of the height as a part of it.
const NEARLY: f32 = 1.0 / (1 << 10) as f32;

/// Sums of products of bends below this part of the greatest bend's square do not determine the
/// highest point.
const UNKNOWN: f32 = 1.0 / (1 << 8) as f32;

/// The absolute bound for sums: products below vanish.
const VANISHING: f32 = 1e-24;

/// A margin for the last few operations.
const A_LITTLE_MORE: f32 = 1.0 + 1.0 / (1 << 18) as f32;

/// The greatest squared chord of the angle between triangles that help each other, as in [`super::super::deviation`].
const SHARPEST: f32 = 3.464;

/// Rows of numbers, by axis.
pub(super) type Slices<'a> = [&'a [f32]; 3];

/// Parts in a row, in a unit in which their edges are about 1.
pub(super) struct Parts<'a> {
    /// The edges to the second and the third corner from the first.
    pub(super) edges: [Slices<'a>; 2],
    /// Whether they run the other way.
    pub(super) is_turned: bool,
    /// The limit normals at the corners.
    pub(super) normals: [Slices<'a>; 3],
    /// The second derivatives along the edges from the first corner to the second, on to the third, and back.
    pub(super) bends: [Slices<'a>; 3],
    /// A bound of the sums of the absolute coordinates.
    pub(super) size: f32,
}

/// Bounds that hold for all parts of a level, in that unit.
#[derive(Clone, Copy)]
pub(super) struct Remainder {
    pub(super) height: f32,
    /// Of the distance of curves from their edges, and of the slope towards their ends.
    pub(super) curve: f32,
    pub(super) steep: f32,
    /// Of first derivatives along edges.
    pub(super) first: f32,
}

/// By part of a row, in that unit.
pub(super) struct Found {
    bound: [f32; WIDTH],
    low: [f32; WIDTH],
    normal_deviation: [f32; WIDTH],
    slope: [f32; WIDTH],
    displacement_slope: [f32; WIDTH],
}

impl Default for Found {
    fn default() -> Self {
        let [bound, low, normal_deviation, slope, displacement_slope] = [[0.0; WIDTH]; 5];
        Self {
            bound,
            low,
            normal_deviation,
            slope,
            displacement_slope,
        }
    }
}

/// A number that is no less.
pub(super) fn above(x: f64) -> f32 {
    (x * (1.0 + 1e-6)) as f32
}

/// A positive number that is no greater.
fn below(x: f64) -> f32 {
    (x * (1.0 - 1e-6)) as f32
}

/// Bounds of the first `count` parts.
#[inline(never)]
pub(super) fn measure(
    count: usize,
    parts: &Parts<'_>,
    rest: &Remainder,
    target: &RowTarget,
    found: &mut Found,
) {
    let fours = count.div_ceil(LANES);
    let [e0, e1] = parts.edges.map(|row| by_fours(row, fours));
    let [m0, m1, m2] = parts.normals.map(|row| by_fours(row, fours));
    let [w0, w1, w2] = parts.bends.map(|row| by_fours(row, fours));
    let Found {
        bound,
        low,
        normal_deviation: normal_deviations,
        slope: slopes,
        displacement_slope: displacement_slopes,
    } = found;
    let [bound, low, normal_deviations, slopes, displacement_slopes] =
        [bound, low, normal_deviations, slopes, displacement_slopes]
            .map(|row| &mut row.as_chunks_mut::<LANES>().0[..fours]);
    let (allowed, share) = (below(target.slope), below(target.displacement_share));
    let neighbour = above(target.normal_deviation);
    let range_share = below(target.range_share);
    let size = f32x4::splat(parts.size);
    let facing: f32 = if parts.is_turned { -1.0 } else { 1.0 };
    for i in 0..fours {
        let at = |row: &Fours<'_>| row.map(|axis| f32x4::from(axis[i]));
        let triangle = Triangle::of(at(&e0), at(&e1), facing);
        let bends = [at(&w0), at(&w1), at(&w2)];
        let off = 2.0 * triangle.unsure * size * triangle.length;
        let seen = bends.map(|bend| dot(bend, triangle.normal));
        let (mut least, most) = heights(seen);
        if range_share > 0.0 {
            // Of ranges the quadratic part counts alone: the remainder is taken away below.
            least = least.fast_max(range_share * edge_range(seen) + rest.height);
        }
        let height = most + 0.3 * triangle.unsure * size + rest.height;
        let normal_deviation = triangle.normal_deviation([at(&m0), at(&m1), at(&m2)]);
        let chord = normal_deviation + neighbour;
        let edges = triangle.edge_bounds(&bends, off, rest, share);
        let (turn, room) = triangle.turn(&bends, off, rest);
        let is_plain = edges.is_plain
            & turn.simd_lt(room)
            & edges.slope.simd_le(f32x4::splat(allowed))
            & (chord * chord).simd_le(f32x4::splat(SHARPEST));
        // What reaches over an edge, as `share_beyond` in `quartic_cell` has it.
        let bend = larger(seen.map(f32x4::abs)) + 1.6 * triangle.unsure * size;
        let inside = room - DIRECTIONS as f32 * turn;
        let reach = edges.displacement * triangle.length;
        let beyond = inside.simd_gt(reach).bitselect(reach / inside, f32x4::ONE);
        let at_edges = 0.125 * bend + rest.curve + (bend + rest.first) * beyond;
        let among =
            at_edges.fast_min(height) * (1.0 + 0.5 * chord * chord) + chord * edges.displacement;
        let value = height.fast_max(among) * A_LITTLE_MORE;
        bound[i] = is_plain
            .bitselect(value, f32x4::splat(f32::INFINITY))
            .to_array();
        low[i] = (least - rest.height).to_array();
        normal_deviations[i] = normal_deviation.to_array();
        slopes[i] = triangle.slope().to_array();
        displacement_slopes[i] = edges.slope.to_array();
    }
}

/// Four triangles.
struct Triangle {
    /// The edges from the first corner, and from the second to the third.
    a: [f32x4; 3],
    b: [f32x4; 3],
    c: [f32x4; 3],
    /// 1, or −1 where they run the other way.
    facing: f32,
    /// Of the parallelogram.
    area: f32x4,
    normal: [f32x4; 3],
    /// The squares of the edges' lengths, in that order.
    squares: [f32x4; 3],
    /// The longest edge's.
    longest: f32x4,
    length: f32x4,
    /// The products of the edges that meet in each corner.
    products: [f32x4; 3],
    /// η.
    unsure: f32x4,
}

/// The distances of parts of the surface from the edges of their triangles.
struct EdgeDeviations {
    /// How far they reach over them.
    displacement: f32x4,
    /// The greatest slope of that displacement, or of the inner part.
    slope: f32x4,
    /// Whether each curve stays within the angles at its edge.
    is_plain: f32x4,
}

impl Triangle {
    #[inline(always)]
    fn of(a: [f32x4; 3], b: [f32x4; 3], facing: f32) -> Self {
        let c = minus(b, a);
        let across = cross(a, b);
        let area = dot(across, across).sqrt();
        let normal = scaled(across, 1.0 / area);
        let squares = [dot(a, a), dot(b, b), dot(c, c)];
        let longest = larger(squares);
        let (length, unsure) = (longest.sqrt(), UNSURE * longest / area);
        let products = [dot(a, b), -dot(a, c), dot(b, c)];
        Self {
            a,
            b,
            c,
            facing,
            area,
            normal,
            squares,
            longest,
            length,
            products,
            unsure,
        }
    }

    /// The chord between the triangle's normal and those at its corners.
    #[inline(always)]
    fn normal_deviation(&self, normals: [[f32x4; 3]; 3]) -> f32x4 {
        let apart = normals.map(|normal| {
            let d = minus(normal, self.normal);
            dot(d, d)
        });
        larger(apart).sqrt() + 2.0 * self.unsure
    }

    /// The tangent of its least angle.
    #[inline(always)]
    fn slope(&self) -> f32x4 {
        self.area * (1.0 - 4.0 * self.unsure) / larger(self.products)
    }

    /// By the second derivatives outwards, times the edges' lengths.
    #[inline(always)]
    fn edge_bounds(
        &self,
        [wa, wc, wb]: &[[f32x4; 3]; 3],
        off: f32x4,
        rest: &Remainder,
        share: f32,
    ) -> EdgeDeviations {
        let Self {
            a,
            b,
            c,
            normal,
            area,
            squares: [la, lb, lc],
            ..
        } = *self;
        let out = [
            -dot(*wa, cross(a, normal)),
            dot(*wb, cross(b, normal)),
            -dot(*wc, cross(c, normal)),
        ];
        let out = out.map(|out| self.facing * out);
        let steep = rest.steep * self.length + off;
        let less = steep + self.unsure * self.longest;
        let ratio = |out: f32x4, bend: &[f32x4; 3], edge: [f32x4; 3], square: f32x4| {
            (0.5 * out.abs() + steep) / (square - 0.5 * dot(*bend, edge).abs() - less)
        };
        let (ra, rb, rc) = (
            ratio(out[0], wa, a, la),
            ratio(out[1], wb, b, lb),
            ratio(out[2], wc, c, lc),
        );
        // Negative where there is no room at all.
        let zero = f32x4::ZERO;
        let is_roomy = ra.simd_ge(zero) & rb.simd_ge(zero) & rc.simd_ge(zero);
        let reach = larger(out).fast_max(zero) + off;
        let displacement = 0.125 * reach / la.fast_min(lb).fast_min(lc).sqrt() + rest.curve;
        let [first, second, third] = self.products.map(f32x4::abs);
        let most = share * area * (1.0 - 8.0 * self.unsure);
        let stays = (ra * larger([first, second, area])).simd_le(most)
            & (rc * larger([second, third, area])).simd_le(most)
            & (rb * larger([third, first, area])).simd_le(most);
        EdgeDeviations {
            displacement,
            slope: larger([ra, rb, rc]) * A_LITTLE_MORE,
            is_plain: is_roomy & stays,
        }
    }

    /// ‖A‖ of `quartic_cell`, by changes of barycentric coordinates times the area, and its limit.
    #[inline(always)]
    fn turn(&self, bends: &[[f32x4; 3]; 3], off: f32x4, rest: &Remainder) -> (f32x4, f32x4) {
        let across = [self.a, self.b].map(|edge| cross(edge, self.normal));
        let stretched = bends.map(|bend| {
            let [x, y] = across.map(|across| dot(bend, across));
            x * x + y * y - x * y
        });
        let most = larger(stretched).sqrt() + 2.0 * off;
        let [la, lb, lc] = self.squares;
        let stretch = (0.5 * (la + lb + lc)).sqrt();
        let room = NEARLY_ONE as f32 * self.area * (1.0 - 2.0 * self.unsure);
        (most + DIRECTIONS as f32 * rest.first * stretch, room)
    }
}

/// An approximation and an upper bound of the greatest height of a quadratic that is 0 at the
/// corners, by its second derivatives along the edges from the first corner to the second, on to
/// the third, and back.
#[inline(always)]
fn heights([p, q, s]: [f32x4; 3]) -> (f32x4, f32x4) {
    let most = larger([p, q, s].map(f32x4::abs));
    let edges = 0.125 * most;
    let (l2, l1, l0) = (p * (q + s - p), s * (p + q - s), q * (p + s - q));
    let total = l0 + l1 + l2;
    let share = 1.0 / total;
    let inner = (0.5 * (p * share) * q * s).abs();
    let is_known = total
        .abs()
        .simd_gt((UNKNOWN * most * most).fast_max(f32x4::splat(VANISHING)));
    let outside = f32x4::splat(-NEARLY);
    let is_inside = [l0, l1, l2].map(|l| (l * share).simd_gt(outside));
    let known = is_known & is_inside[0] & is_inside[1] & is_inside[2] & inner;
    // The greatest bend of either sign, and all as it counts.
    let bends_up = larger([p, q, s]).simd_ge(most);
    let all = p + q + s;
    let slope = 0.25 * (bends_up.bitselect(all, -all) - 2.0 * most);
    let unknown = edges + slope.fast_max(f32x4::ZERO).fast_min(most * (1.0 / 24.0));
    let above = is_known.bitselect(known * (1.0 + NEARLY), unknown);
    (edges.fast_max(known), edges.fast_max(above) * A_LITTLE_MORE)
}

/// The range of the heights of such a quadratic over the edges.
#[inline(always)]
fn edge_range([p, q, s]: [f32x4; 3]) -> f32x4 {
    let (low, high) = (p.fast_min(q).fast_min(s), p.fast_max(q).fast_max(s));
    0.125 * (high.fast_max(f32x4::ZERO) - low.fast_min(f32x4::ZERO))
}

/// Rows of numbers, four at a time, by axis.
type Fours<'a> = [&'a [[f32; LANES]]; 3];

/// The first of them.
fn by_fours([x, y, z]: Slices<'_>, count: usize) -> Fours<'_> {
    [x, y, z].map(|axis| &axis.as_chunks().0[..count])
}

impl Found {
    /// Marks parts, and adds those that pass to an extent, `scale` being the factor of lengths in
    /// their unit.
    pub(super) fn mark(
        &self,
        scale: f64,
        target: &RowTarget,
        extent: &mut RowExtent,
        marks: &mut [Mark],
    ) {
        // A part without a bound, which is infinite, must not pass, however great the target is.
        let most = (target.distance * scale).smaller(f64::from(f32::MAX));
        let mut greatest = 0.0f64;
        for (i, mark) in marks.iter_mut().enumerate() {
            let bound = f64::from(self.bound[i]);
            *mark = if f64::from(self.low[i]) > most {
                Mark::Fails
            } else if bound <= most {
                extent.normal_deviation = extent
                    .normal_deviation
                    .larger(f64::from(self.normal_deviation[i]));
                extent.slope = extent.slope.smaller(f64::from(self.slope[i]));
                extent.displacement_slope = extent
                    .displacement_slope
                    .larger(f64::from(self.displacement_slope[i]));
                greatest = greatest.larger(bound);
                Mark::Passes
            } else {
                Mark::Open
            };
        }
        extent.bound = extent.bound.larger(greatest / scale);
    }
}

#[inline(always)]
fn minus(a: [f32x4; 3], b: [f32x4; 3]) -> [f32x4; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: [f32x4; 3], b: [f32x4; 3]) -> f32x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: [f32x4; 3], b: [f32x4; 3]) -> [f32x4; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
fn scaled(a: [f32x4; 3], by: f32x4) -> [f32x4; 3] {
    a.map(|a| a * by)
}

/// The greatest of three.
#[inline(always)]
fn larger([a, b, c]: [f32x4; 3]) -> f32x4 {
    a.fast_max(b).fast_max(c)
}

#[cfg(test)]
mod tests;
