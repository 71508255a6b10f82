//! Regular pieces of Loop's surface as polynomials, evaluated point by point or in rows.
//!
//! Takes a [`BezierTriangle`] and gives positions, derivatives and unit normals at parameters (u, v): u is the weight of
//! the second corner and v that of the third, counted from any corner of the piece. Rows run along constant v. A value
//! depends on the net, the first corner, u and v alone: not on the row in which it is asked for, nor on its place there,
//! so that whoever shares an edge or the work gets the same bits.
//!
//! The polynomial is `Σ a_pk uᵖ vᵏ` with `a_pk = 4!/(p! k! (4−p−k)!) · Δᵤᵖ Δᵥᵏ b` by forward differences of the net at its
//! first corner (Farin, Curves and Surfaces for CAGD, on derivatives of triangular patches). It is evaluated by Horner's
//! rule, for which the unit triangle is benign: the error is some 1e-15 of the piece's size.

use core::array::from_fn;

use super::bezier_triangle::{BezierTriangle, TURNED};
use crate::vector::DVec3;

/// Points that are computed together: enough for several in a register and several registers in flight.
const LANES: usize = 8;

/// Short ends of rows take fewer.
const HALF: usize = LANES / 2;

/// `4!/(p! k! (4−p−k)!)` in the order of the coefficients.
const MULTINOMIAL: [f64; 15] = [1.0, 4.0, 6.0, 4.0, 1.0, 4.0, 12.0, 12.0, 4.0, 6.0, 12.0, 6.0, 4.0, 4.0, 1.0];

/// Rounding leaves no more of a cross product that is zero than this, where the greatest coefficient is 1 and the
/// piece stands at the origin: either tangent is some twenty terms of up to four times that, each off by 1e-16.
const CROSS_ROUNDING: f64 = 1e-13;

/// Pieces whose size is within these need no scaling: fourth powers of it neither vanish nor overflow.
const SAFE_SIZES: core::ops::Range<f64> = 1e-60..1e60;

/// A regular piece of the limit surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quartic {
    /// `a_pk` in the order of p, then of k.
    coefficients: [DVec3; 15],
    /// A power of two that keeps squares of tangents' cross products from vanishing and overflowing, where it is not 1.
    tangent_scale: f64,
    /// Cross products of scaled tangents whose squared length is not above this have no direction.
    least_square: f64,
}

impl Quartic {
    /// The polynomial of a net, with the net's corner `first` (0 to 2) at (0, 0), the next at (1, 0), the last at (0, 1).
    pub(crate) fn of(net: &BezierTriangle, first: usize) -> Self {
        let b = TURNED[first].map(|at| net.0[at]);
        let d0 = differences([b[0], b[1], b[2], b[3], b[4]]);
        let d1 = differences([b[5], b[6], b[7], b[8]]);
        let d2 = differences([b[9], b[10], b[11]]);
        let d3 = differences([b[12], b[13]]);
        let [a00, a01, a02, a03, a04] = differences([d0[0], d1[0], d2[0], d3[0], b[14]]);
        let [a10, a11, a12, a13] = differences([d0[1], d1[1], d2[1], d3[1]]);
        let [a20, a21, a22] = differences([d0[2], d1[2], d2[2]]);
        let [a30, a31] = differences([d0[3], d1[3]]);
        let all = [a00, a01, a02, a03, a04, a10, a11, a12, a13, a20, a21, a22, a30, a31, d0[4]];
        Self::with_scale(from_fn(|i| MULTINOMIAL[i] * all[i]))
    }

    #[inline]
    fn with_scale(coefficients: [DVec3; 15]) -> Self {
        let others = coefficients[1..].iter();
        let size = others.fold(DVec3::ZERO, |most, a| most.max(a.abs())).max_element();
        let tangent_scale = if SAFE_SIZES.contains(&size) { 1.0 } else { reciprocal_power(size) };
        let scaled = tangent_scale * size;
        // Coordinates far from the origin have fewer digits to spare for differences.
        let least = CROSS_ROUNDING * scaled * (scaled + tangent_scale * coefficients[0].abs().max_element());
        Self { coefficients, tangent_scale, least_square: least * least }
    }

    /// The coefficients of u², uv, v², of u³ to v³, and of u⁴ to v⁴.
    pub(crate) fn powers(&self) -> ([DVec3; 3], [DVec3; 4], [DVec3; 5]) {
        let a = &self.coefficients;
        ([a[9], a[6], a[2]], [a[12], a[10], a[7], a[3]], [a[14], a[13], a[11], a[8], a[4]])
    }

    /// The point at (u, v).
    pub(crate) fn point(&self, u: f64, v: f64) -> DVec3 {
        let mut points = [[0.0; 3]];
        self.points_along(v, u, 0.0, &mut points);
        DVec3::from_array(points[0])
    }

    /// The unit normal at (u, v), on the side from which the corners run counter-clockwise; zero where the tangents span
    /// no plane.
    pub(crate) fn normal(&self, u: f64, v: f64) -> DVec3 {
        let mut normals = [[0.0; 3]];
        self.points_and_normals_along(v, u, 0.0, &mut [[0.0; 3]], &mut normals);
        DVec3::from_array(normals[0])
    }

    /// The derivatives by u and by v at (u, v).
    pub(crate) fn tangents(&self, u: f64, v: f64) -> [DVec3; 2] {
        let (c, d) = (self.positions(v), self.slopes(v));
        [horner(&derivative::<5, 4>(&c), u), horner(&d, u)]
    }

    /// The second derivatives at (u, v): by u twice, by u and v, by v twice.
    pub(crate) fn second_derivatives(&self, u: f64, v: f64) -> [DVec3; 3] {
        let (c, d) = (self.positions(v), self.slopes(v));
        let a = &self.coefficients;
        let e = [(12.0 * a[4] * v + 6.0 * a[3]) * v + 2.0 * a[2], 6.0 * a[8] * v + 2.0 * a[7], 2.0 * a[11]];
        [horner(&second_derivative(&c), u), horner(&derivative::<4, 3>(&d), u), horner(&e, u)]
    }

    /// The points at u = `start` + i · `step` along constant v.
    pub(crate) fn points_along(&self, v: f64, start: f64, step: f64, points: &mut [[f64; 3]]) {
        fill(&PointRow(by_axis(&self.positions(v))), start, step, points);
    }

    /// The points at u = `start` + i · `step` along constant v, and their unit normals on the side from which the corners
    /// run counter-clockwise; zero where the tangents span no plane. The slices may differ in length.
    pub(crate) fn points_and_normals_along(
        &self,
        v: f64,
        start: f64,
        step: f64,
        points: &mut [[f64; 3]],
        normals: &mut [[f64; 3]],
    ) {
        let by_u = self.positions(v);
        fill(&PointRow(by_axis(&by_u)), start, step, points);
        let [mut by_u, mut by_v] = [derivative(&by_u), self.slopes(v)];
        if self.tangent_scale != 1.0 {
            by_u.iter_mut().chain(&mut by_v).for_each(|a| *a *= self.tangent_scale);
        }
        let tangents = [by_axis(&by_u), by_axis(&by_v)];
        fill(&NormalRow { tangents, least_square: self.least_square }, start, step, normals);
    }

    /// What [`Self::points_and_normals_along`] gives, by axis; `count` places, rounded up to a multiple of eight.
    pub(crate) fn by_axis_along<const N: usize>(
        &self,
        v: f64,
        start: f64,
        step: f64,
        count: usize,
        [points, normals]: [&mut [[f64; N]; 3]; 2],
    ) {
        let by_u = self.positions(v);
        let row = PointRow(by_axis(&by_u));
        let [mut by_u, mut by_v] = [derivative(&by_u), self.slopes(v)];
        if self.tangent_scale != 1.0 {
            by_u.iter_mut().chain(&mut by_v).for_each(|a| *a *= self.tangent_scale);
        }
        let tangents = [by_axis(&by_u), by_axis(&by_v)];
        let normal_row = NormalRow { tangents, least_square: self.least_square };
        for first in (0..count.min(N)).step_by(LANES) {
            let mut u = [0.0; LANES];
            for (l, u) in u.iter_mut().enumerate() {
                *u = start + (first + l) as f64 * step;
            }
            let (at, normal) = (row.at_each(&u), normal_row.at_each(&u));
            for axis in 0..3 {
                let length = LANES.min(N - first);
                points[axis][first..first + length].copy_from_slice(&at[axis][..length]);
                normals[axis][first..first + length].copy_from_slice(&normal[axis][..length]);
            }
        }
    }

    /// The coefficients of powers of u along constant v.
    #[inline]
    fn positions(&self, v: f64) -> [DVec3; 5] {
        let a = &self.coefficients;
        [horner(&a[..5], v), horner(&a[5..9], v), horner(&a[9..12], v), horner(&a[12..14], v), a[14]]
    }

    /// The same for the derivative by v.
    #[inline]
    fn slopes(&self, v: f64) -> [DVec3; 4] {
        let a = &self.coefficients;
        let cubic = ((4.0 * a[4] * v + 3.0 * a[3]) * v + 2.0 * a[2]) * v + a[1];
        [cubic, (3.0 * a[8] * v + 2.0 * a[7]) * v + a[6], 2.0 * a[11] * v + a[10], a[13]]
    }
}

/// What stands along constant v.
trait Row {
    /// At several values of u, by axis.
    fn at_each<const N: usize>(&self, u: &[f64; N]) -> [[f64; N]; 3];
}

/// Positions, by axis and power of u.
struct PointRow([[f64; 5]; 3]);

/// Unit normals, by scaled tangents.
struct NormalRow {
    /// The derivatives by u and by v, by axis and power of u.
    tangents: [[[f64; 4]; 3]; 2],
    least_square: f64,
}

impl Row for PointRow {
    #[inline]
    fn at_each<const N: usize>(&self, u: &[f64; N]) -> [[f64; N]; 3] {
        let mut points = [[0.0; N]; 3];
        for (points, [c0, c1, c2, c3, c4]) in points.iter_mut().zip(self.0) {
            for l in 0..N {
                points[l] = (((c4 * u[l] + c3) * u[l] + c2) * u[l] + c1) * u[l] + c0;
            }
        }
        points
    }
}

impl Row for NormalRow {
    #[inline]
    fn at_each<const N: usize>(&self, u: &[f64; N]) -> [[f64; N]; 3] {
        let [mut s, mut t] = [[[0.0; N]; 3]; 2];
        for axis in 0..3 {
            let [[c0, c1, c2, c3], [d0, d1, d2, d3]] = self.tangents.map(|tangent| tangent[axis]);
            for l in 0..N {
                s[axis][l] = ((c3 * u[l] + c2) * u[l] + c1) * u[l] + c0;
                t[axis][l] = ((d3 * u[l] + d2) * u[l] + d1) * u[l] + d0;
            }
        }
        let mut normals = [[0.0; N]; 3];
        for l in 0..N {
            let x = s[1][l] * t[2][l] - s[2][l] * t[1][l];
            let y = s[2][l] * t[0][l] - s[0][l] * t[2][l];
            let z = s[0][l] * t[1][l] - s[1][l] * t[0][l];
            let square = x * x + y * y + z * z;
            let factor = if square > self.least_square { 1.0 / square.sqrt() } else { 0.0 };
            (normals[0][l], normals[1][l], normals[2][l]) = (x * factor, y * factor, z * factor);
        }
        normals
    }
}

/// Fills slots with what stands at u = `start` + i · `step`.
#[inline]
fn fill(row: &impl Row, start: f64, step: f64, slots: &mut [[f64; 3]]) {
    let mut first = 0.0;
    let (chunks, rest) = slots.as_chunks_mut::<LANES>();
    for chunk in chunks {
        *chunk = chunk_at(row, start, step, first);
        first += LANES as f64;
    }
    let (chunks, rest) = rest.as_chunks_mut::<HALF>();
    for chunk in chunks {
        *chunk = chunk_at(row, start, step, first);
        first += HALF as f64;
    }
    if !rest.is_empty() {
        let chunk: [_; HALF] = chunk_at(row, start, step, first);
        rest.copy_from_slice(&chunk[..rest.len()]);
    }
}

/// What stands at N places from number `first` on.
#[inline]
fn chunk_at<const N: usize>(row: &impl Row, start: f64, step: f64, first: f64) -> [[f64; 3]; N] {
    let mut u = [0.0; N];
    for (l, u) in u.iter_mut().enumerate() {
        *u = start + (first + l as f64) * step;
    }
    let [x, y, z] = row.at_each(&u);
    from_fn(|l| [x[l], y[l], z[l]])
}

/// A polynomial by its coefficients of powers, from the lowest.
#[inline]
fn horner(c: &[DVec3], t: f64) -> DVec3 {
    c.iter().rev().copied().reduce(|sum, c| sum * t + c).unwrap_or_default()
}

/// The coefficients of a polynomial's derivative.
#[inline]
fn derivative<const N: usize, const M: usize>(c: &[DVec3; N]) -> [DVec3; M] {
    from_fn(|p| (p + 1) as f64 * c[p + 1])
}

/// The coefficients of a quartic's second derivative.
#[inline]
fn second_derivative(c: &[DVec3; 5]) -> [DVec3; 3] {
    derivative(&derivative::<5, 4>(c))
}

/// Coefficients of points by axis.
#[inline]
fn by_axis<const N: usize>(points: &[DVec3; N]) -> [[f64; N]; 3] {
    from_fn(|axis| points.map(|p| p[axis]))
}

/// The first forward differences of each order.
#[inline]
fn differences<const N: usize>(mut values: [DVec3; N]) -> [DVec3; N] {
    for order in 1..N {
        for i in (order..N).rev() {
            values[i] -= values[i - 1];
        }
    }
    values
}

/// The reciprocal of the greatest power of two that is no greater than `size`, as far as that is a normal number.
#[inline]
fn reciprocal_power(size: f64) -> f64 {
    const BITS: u32 = f64::MANTISSA_DIGITS - 1;
    let exponent = size.to_bits() >> BITS;
    f64::from_bits(2046u64.saturating_sub(exponent).max(1) << BITS)
}

#[cfg(test)]
mod tests;
