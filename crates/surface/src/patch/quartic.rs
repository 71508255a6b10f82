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
use crate::vector::{Blend, DVec3};

/// Points that are computed together: enough for several in a register and several registers in flight.
const LANES: usize = 8;

/// Short ends of rows take fewer.
const HALF: usize = LANES / 2;

/// `4!/(p! k! (4−p−k)!)` in the order of the coefficients.
const MULTINOMIAL: [f64; 15] = [
    1.0, 4.0, 6.0, 4.0, 1.0, 4.0, 12.0, 12.0, 4.0, 6.0, 12.0, 6.0, 4.0, 4.0, 1.0,
];

/// Rounding leaves no more of a cross product that is zero than this, where the greatest coefficient is 1 and the
/// piece stands at the origin: either tangent is some twenty terms of up to four times that, each off by 1e-16.
const CROSS_ROUNDING: f64 = 1e-13;

/// Pieces whose size is within these need no scaling: fourth powers of it neither vanish nor overflow.
const SAFE_SIZES: core::ops::Range<f64> = 1e-60..1e60;

/// A regular piece of the limit surface.
#[derive(Clone, Copy, Debug)]
pub struct Quartic {
    /// `a_pk` by axis, in the order of p, then of k.
    coefficients: [[f64; 15]; 3],
    /// A power of two that keeps squares of tangents' cross products from vanishing and overflowing, where it is not 1.
    tangent_scale: f64,
    /// Cross products of scaled tangents whose squared length is not above this have no direction.
    least_square: f64,
}

impl Quartic {
    /// The polynomial of a net, with the net's corner `first` (0 to 2) at (0, 0), the next at (1, 0), the last at (0, 1).
    pub fn of(net: &BezierTriangle, first: usize) -> Self {
        Self::with_scale(coefficients(net, first))
    }

    /// The polynomial with the given coefficients, in the order of p, then of k.
    #[inline]
    pub fn with_scale(coefficients: [DVec3; 15]) -> Self {
        let others = coefficients[1..].iter();
        let size = others
            .fold(DVec3::ZERO, |most, a| most.max(a.abs()))
            .max_element();
        let tangent_scale = if SAFE_SIZES.contains(&size) {
            1.0
        } else {
            reciprocal_power(size)
        };
        let scaled = tangent_scale * size;
        // Coordinates far from the origin have fewer digits to spare for differences.
        let least = CROSS_ROUNDING
            * scaled
            * (scaled + tangent_scale * coefficients[0].abs().max_element());
        Self {
            coefficients: by_axis(&coefficients),
            tangent_scale,
            least_square: least * least,
        }
    }

    /// The coefficients, in the order of [`Self::with_scale`].
    pub fn coefficients(&self) -> [DVec3; 15] {
        let [x, y, z] = &self.coefficients;
        from_fn(|i| DVec3::new(x[i], y[i], z[i]))
    }

    /// The coefficients of u², uv, v², of u³ to v³, and of u⁴ to v⁴.
    pub fn powers(&self) -> ([DVec3; 3], [DVec3; 4], [DVec3; 5]) {
        let [x, y, z] = &self.coefficients;
        let a = |i: usize| DVec3::new(x[i], y[i], z[i]);
        (
            [a(9), a(6), a(2)],
            [a(12), a(10), a(7), a(3)],
            [a(14), a(13), a(11), a(8), a(4)],
        )
    }

    /// The point at (u, v).
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let mut points = [[0.0; 3]];
        self.points_along(v, u, 0.0, &mut points);
        DVec3::from_array(points[0])
    }

    /// The unit normal at (u, v), on the side from which the corners run counter-clockwise; zero where the tangents span
    /// no plane.
    pub fn normal(&self, u: f64, v: f64) -> DVec3 {
        let mut normals = [[0.0; 3]];
        self.points_and_normals_along(v, u, 0.0, &mut [[0.0; 3]], &mut normals);
        DVec3::from_array(normals[0])
    }

    /// The net of the part whose corners are the given one and those `size` along u and along v from it; negative
    /// for inverted parts.
    pub fn net(&self, [u, v]: [f64; 2], size: f64) -> BezierTriangle {
        let mut powers = [1.0; 5];
        (1..5).for_each(|i| powers[i] = size * powers[i - 1]);
        let mut net = [DVec3::ZERO; 15];
        for (axis, coefficients) in self.coefficients.iter().enumerate() {
            // By powers of u and v, as seen from the part's first corner; then forward differences of the net.
            let mut rows = [[0.0; 5]; 5];
            for (p, row) in rows.iter_mut().enumerate() {
                row[..5 - p].copy_from_slice(&coefficients[STARTS[p]..STARTS[p] + 5 - p]);
                shift(&mut row[..5 - p], v);
            }
            by_columns(&mut rows, |column| shift(column, u));
            for (p, row) in rows.iter_mut().enumerate() {
                for (k, value) in row[..5 - p].iter_mut().enumerate() {
                    *value *= powers[p + k] / MULTINOMIAL[STARTS[p] + k];
                }
                sum(&mut row[..5 - p]);
            }
            by_columns(&mut rows, sum);
            let places = (0..5).flat_map(|k| (0..5 - k).map(move |p| (p, k)));
            net.iter_mut()
                .zip(places)
                .for_each(|(point, (p, k))| point[axis] = rows[p][k]);
        }
        BezierTriangle(net)
    }

    /// The derivatives by u and by v at (u, v).
    pub fn tangents(&self, u: f64, v: f64) -> [DVec3; 2] {
        let [mut by_u, mut by_v] = [DVec3::ZERO; 2];
        for (axis, a) in self.coefficients.iter().enumerate() {
            by_u[axis] = horner(&derivative::<5, 4>(&positions(a, v)), u);
            by_v[axis] = horner(&slopes(a, v), u);
        }
        [by_u, by_v]
    }

    /// The second derivatives at (u, v): by u twice, by u and v, by v twice.
    pub(crate) fn second_derivatives(&self, u: f64, v: f64) -> [DVec3; 3] {
        let [mut by_uu, mut by_uv, mut by_vv] = [DVec3::ZERO; 3];
        for (axis, a) in self.coefficients.iter().enumerate() {
            let e = [
                (12.0 * a[4] * v + 6.0 * a[3]) * v + 2.0 * a[2],
                6.0 * a[8] * v + 2.0 * a[7],
                2.0 * a[11],
            ];
            by_uu[axis] = horner(&second_derivative(&positions(a, v)), u);
            by_uv[axis] = horner(&derivative::<4, 3>(&slopes(a, v)), u);
            by_vv[axis] = horner(&e, u);
        }
        [by_uu, by_uv, by_vv]
    }

    /// The points at u = `start` + i · `step` along constant v.
    pub fn points_along(&self, v: f64, start: f64, step: f64, points: &mut [[f64; 3]]) {
        fill(&self.point_row(v), start, step, points);
    }

    /// The points at u = `start` + i · `step` along constant v, and their unit normals on the side from which the corners
    /// run counter-clockwise; zero where the tangents span no plane. The slices may differ in length.
    pub fn points_and_normals_along(
        &self,
        v: f64,
        start: f64,
        step: f64,
        points: &mut [[f64; 3]],
        normals: &mut [[f64; 3]],
    ) {
        let row = self.point_row(v);
        fill(&row, start, step, points);
        fill(&self.normal_row(&row, v), start, step, normals);
    }

    /// The result of [`Self::points_and_normals_along`] by axis; `count` places, rounded up to a multiple of eight.
    pub fn by_axis_along<const N: usize>(
        &self,
        v: f64,
        start: f64,
        step: f64,
        count: usize,
        [points, normals]: [&mut [[f64; N]; 3]; 2],
    ) {
        let row = self.point_row(v);
        let normal_row = self.normal_row(&row, v);
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

    /// The first `axes` coordinates of the points at several places (u, v), by axis: to the bit what rows give there.
    #[inline]
    pub fn points_at<const N: usize>(
        &self,
        u: &[f64; N],
        v: &[f64; N],
        axes: usize,
    ) -> [[f64; N]; 3] {
        let mut points = [[0.0; N]; 3];
        for (points, a) in points.iter_mut().zip(&self.coefficients).take(axes) {
            *points = values_at(a, u, v);
        }
        points
    }

    /// The points at several places (u, v) and their unit normals, by axis: to the bit what rows give there.
    #[inline]
    pub fn points_and_normals_at<const N: usize>(
        &self,
        u: &[f64; N],
        v: &[f64; N],
    ) -> [[[f64; N]; 3]; 2] {
        let [mut points, mut by_u, mut by_v] = [[[0.0; N]; 3]; 3];
        let scale = self.tangent_scale;
        for (axis, a) in self.coefficients.iter().enumerate() {
            for l in 0..N {
                let (u, v) = (u[l], v[l]);
                let [c0, c1, c2, c3, c4] = positions(a, v);
                points[axis][l] = (((c4 * u + c3) * u + c2) * u + c1) * u + c0;
                let (c2, c3, c4) = (2.0 * c2, 3.0 * c3, 4.0 * c4);
                by_u[axis][l] = ((c4 * scale * u + c3 * scale) * u + c2 * scale) * u + c1 * scale;
                let [d0, d1, d2, d3] = slopes(a, v);
                by_v[axis][l] = ((d3 * scale * u + d2 * scale) * u + d1 * scale) * u + d0 * scale;
            }
        }
        [points, normals(&by_u, &by_v, self.least_square)]
    }

    /// Positions along constant v.
    #[inline]
    fn point_row(&self, v: f64) -> PointRow {
        let [x, y, z] = &self.coefficients;
        PointRow([positions(x, v), positions(y, v), positions(z, v)])
    }

    /// The normals of a row of positions along constant v.
    #[inline]
    fn normal_row(&self, PointRow(positions): &PointRow, v: f64) -> NormalRow {
        let mut tangents = [[[0.0; 4]; 3]; 2];
        for axis in 0..3 {
            tangents[0][axis] = derivative(&positions[axis]);
            tangents[1][axis] = slopes(&self.coefficients[axis], v);
        }
        if self.tangent_scale != 1.0 {
            tangents
                .as_flattened_mut()
                .as_flattened_mut()
                .iter_mut()
                .for_each(|a| *a *= self.tangent_scale);
        }
        NormalRow {
            tangents,
            least_square: self.least_square,
        }
    }
}

/// The coefficients of a net's polynomial, as [`Quartic::of`] counts them.
#[inline]
pub fn coefficients<V: Blend>(net: &BezierTriangle<V>, first: usize) -> [V; 15] {
    let mut b = net.0;
    b.iter_mut()
        .zip(&TURNED[first])
        .for_each(|(b, &at)| *b = net.0[at]);
    let d0 = differences([b[0], b[1], b[2], b[3], b[4]]);
    let d1 = differences([b[5], b[6], b[7], b[8]]);
    let d2 = differences([b[9], b[10], b[11]]);
    let d3 = differences([b[12], b[13]]);
    let [a00, a01, a02, a03, a04] = differences([d0[0], d1[0], d2[0], d3[0], b[14]]);
    let [a10, a11, a12, a13] = differences([d0[1], d1[1], d2[1], d3[1]]);
    let [a20, a21, a22] = differences([d0[2], d1[2], d2[2]]);
    let [a30, a31] = differences([d0[3], d1[3]]);
    let mut all = [
        a00, a01, a02, a03, a04, a10, a11, a12, a13, a20, a21, a22, a30, a31, d0[4],
    ];
    all.iter_mut()
        .zip(MULTINOMIAL)
        .for_each(|(a, factor)| *a = *a * factor);
    all
}

/// The values at several places (u, v) of a polynomial by its coefficients, in the order of p, then of k.
#[inline]
pub(crate) fn values_at<const N: usize>(a: &[f64; 15], u: &[f64; N], v: &[f64; N]) -> [f64; N] {
    let mut values = [0.0; N];
    for l in 0..N {
        let [c0, c1, c2, c3, c4] = positions(a, v[l]);
        values[l] = (((c4 * u[l] + c3) * u[l] + c2) * u[l] + c1) * u[l] + c0;
    }
    values
}

/// Where the coefficients of each power of u start.
const STARTS: [usize; 5] = [0, 5, 9, 12, 14];

/// The coefficients of a polynomial as seen from `by`, by synthetic division.
#[inline]
fn shift(coefficients: &mut [f64], by: f64) {
    for from in 0..coefficients.len() {
        for k in (from + 1..coefficients.len()).rev() {
            coefficients[k - 1] += by * coefficients[k];
        }
    }
}

/// Values from their first forward differences of each order.
#[inline]
fn sum(differences: &mut [f64]) {
    for order in (1..differences.len()).rev() {
        for k in order..differences.len() {
            differences[k] += differences[k - 1];
        }
    }
}

/// Does something with the columns of a triangle of rows.
#[inline]
fn by_columns(rows: &mut [[f64; 5]; 5], change: impl Fn(&mut [f64])) {
    for k in 0..5 {
        let mut column = [0.0; 5];
        column
            .iter_mut()
            .zip(rows.iter())
            .for_each(|(value, row)| *value = row[k]);
        change(&mut column[..5 - k]);
        rows.iter_mut()
            .zip(column)
            .take(5 - k)
            .for_each(|(row, value)| row[k] = value);
    }
}

/// The coefficients of powers of u along constant v, of one axis.
#[inline]
fn positions(a: &[f64; 15], v: f64) -> [f64; 5] {
    [
        (((a[4] * v + a[3]) * v + a[2]) * v + a[1]) * v + a[0],
        ((a[8] * v + a[7]) * v + a[6]) * v + a[5],
        (a[11] * v + a[10]) * v + a[9],
        a[13] * v + a[12],
        a[14],
    ]
}

/// The coefficients of the derivative by v along constant v.
#[inline]
fn slopes(a: &[f64; 15], v: f64) -> [f64; 4] {
    [
        ((4.0 * a[4] * v + 3.0 * a[3]) * v + 2.0 * a[2]) * v + a[1],
        (3.0 * a[8] * v + 2.0 * a[7]) * v + a[6],
        2.0 * a[11] * v + a[10],
        a[13],
    ]
}

/// A function along constant v.
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
        normals(&s, &t, self.least_square)
    }
}

/// Unit vectors at right angles to pairs of tangents; zero where their cross product's square is too little.
#[inline]
pub(crate) fn normals<const N: usize>(
    s: &[[f64; N]; 3],
    t: &[[f64; N]; 3],
    least_square: f64,
) -> [[f64; N]; 3] {
    let mut normals = [[0.0; N]; 3];
    for l in 0..N {
        let x = s[1][l] * t[2][l] - s[2][l] * t[1][l];
        let y = s[2][l] * t[0][l] - s[0][l] * t[2][l];
        let z = s[0][l] * t[1][l] - s[1][l] * t[0][l];
        let square = x * x + y * y + z * z;
        let factor = if square > least_square {
            1.0 / square.sqrt()
        } else {
            0.0
        };
        (normals[0][l], normals[1][l], normals[2][l]) = (x * factor, y * factor, z * factor);
    }
    normals
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

/// The values at N places from number `first` on.
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
fn horner<const N: usize>(c: &[f64; N], t: f64) -> f64 {
    c.iter()
        .rev()
        .copied()
        .reduce(|sum, c| sum * t + c)
        .unwrap_or_default()
}

/// The coefficients of a polynomial's derivative.
#[inline]
fn derivative<const N: usize, const M: usize>(c: &[f64; N]) -> [f64; M] {
    let mut d = [0.0; M];
    for (p, d) in d.iter_mut().enumerate() {
        *d = (p + 1) as f64 * c[p + 1];
    }
    d
}

/// The coefficients of a quartic's second derivative.
#[inline]
fn second_derivative(c: &[f64; 5]) -> [f64; 3] {
    derivative(&derivative::<5, 4>(c))
}

/// Coefficients of points by axis.
#[inline]
fn by_axis<const N: usize>(points: &[DVec3; N]) -> [[f64; N]; 3] {
    let [mut x, mut y, mut z] = [[0.0; N]; 3];
    for (i, point) in points.iter().enumerate() {
        (x[i], y[i], z[i]) = (point.x, point.y, point.z);
    }
    [x, y, z]
}

/// The first forward differences of each order.
#[inline]
fn differences<V: Blend, const N: usize>(mut values: [V; N]) -> [V; N] {
    for order in 1..N {
        for i in (order..N).rev() {
            values[i] -= values[i - 1];
        }
    }
    values
}

/// The reciprocal of the greatest power of two that is no greater than `size`, as far as that is a normal number.
#[inline]
pub fn reciprocal_power(size: f64) -> f64 {
    const BITS: u32 = f64::MANTISSA_DIGITS - 1;
    let exponent = size.to_bits() >> BITS;
    f64::from_bits(2046u64.saturating_sub(exponent).max(1) << BITS)
}

#[cfg(test)]
mod tests;
