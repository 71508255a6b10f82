//! Regular pieces of Loop's surface as polynomials, evaluated point by point or in rows.
//!
//! Takes a [`BezierTriangle`] and gives positions, derivatives and unit normals at parameters (u, v): u is the weight of the second
//! corner and v that of the third, counted from any corner of the piece. Rows run along constant v. A value depends on
//! the net, the first corner, u and v alone: not on the row in which it is asked for, nor on its place there, so that
//! whoever shares an edge or the work gets the same bits.
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

/// `4!/(p! k! (4−p−k)!)` by p and k.
const MULTINOMIAL: [[f64; 5]; 5] = [
    [1.0, 4.0, 6.0, 4.0, 1.0],
    [4.0, 12.0, 12.0, 4.0, 0.0],
    [6.0, 12.0, 6.0, 0.0, 0.0],
    [4.0, 4.0, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, 0.0],
];

/// Rounding leaves no more of a cross product that is zero than this, where the greatest coefficient is near 1 and the
/// piece stands at the origin: either tangent is some twenty terms of up to four times that, each off by 1e-16.
const CROSS_ROUNDING: f64 = 1e-13;

/// A regular piece of the limit surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quartic {
    /// `a_pk` by p and k; zero for p + k > 4.
    coefficients: [[DVec3; 5]; 5],
    /// The power of two that brings derivatives near the size of 1, where squares of them neither vanish nor overflow.
    tangent_scale: f64,
    /// Cross products of scaled tangents whose squared length is not above this have no direction.
    least_square: f64,
}

impl Quartic {
    /// The polynomial of a net, with the net's corner `first` (0 to 2) at (0, 0), the next at (1, 0), the last at (0, 1).
    pub(crate) fn of(net: &BezierTriangle, first: usize) -> Self {
        let mut a = [[DVec3::ZERO; 5]; 5];
        let mut points = TURNED[first].iter().map(|&at| net.0[at]);
        for (k, degree) in (0..5).rev().enumerate() {
            let row = from_fn(|p| if p <= degree { points.next().unwrap_or_default() } else { DVec3::ZERO });
            for (by_v, along_u) in a.iter_mut().zip(differences(row, degree)) {
                by_v[k] = along_u;
            }
        }
        for (p, column) in a.iter_mut().enumerate() {
            let along_v = differences(*column, 4 - p);
            *column = from_fn(|k| MULTINOMIAL[p][k] * along_v[k]);
        }
        Self::with_scale(a)
    }

    fn with_scale(coefficients: [[DVec3; 5]; 5]) -> Self {
        let others = coefficients.as_flattened()[1..].iter();
        let size = others.fold(DVec3::ZERO, |most, a| most.max(a.abs())).max_element();
        let tangent_scale = reciprocal_power(size);
        // Coordinates far from the origin have fewer digits to spare for differences.
        let distance = tangent_scale * coefficients[0][0].abs().max_element();
        let least = CROSS_ROUNDING * (1.0 + distance);
        Self { coefficients, tangent_scale, least_square: least * least }
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
        let e: [DVec3; 3] = from_fn(|p| horner(&second_derivative(&self.coefficients[p]), v));
        [horner(&second_derivative(&c), u), horner(&derivative::<4, 3>(&d), u), horner(&e, u)]
    }

    /// The points at u = `start` + i · `step` along constant v.
    pub(crate) fn points_along(&self, v: f64, start: f64, step: f64, points: &mut [[f64; 3]]) {
        let row = PointRow::of(&self.positions(v));
        for (chunk, points) in points.chunks_mut(LANES).enumerate() {
            let u = parameters(start, step, chunk);
            match u.first_chunk::<HALF>().filter(|_| points.len() <= HALF) {
                Some(u) => row.points(u, points),
                None => row.points(&u, points),
            }
        }
    }

    /// The points at u = `start` + i · `step` along constant v, and their unit normals on the side from which the corners
    /// run counter-clockwise; zero where the tangents span no plane. Both slices have the same length.
    pub(crate) fn points_and_normals_along(
        &self,
        v: f64,
        start: f64,
        step: f64,
        points: &mut [[f64; 3]],
        normals: &mut [[f64; 3]],
    ) {
        let (c, d) = (self.positions(v), self.slopes(v));
        let (row, normal_row) = (PointRow::of(&c), NormalRow::of(&c, &d, self));
        let chunks = points.chunks_mut(LANES).zip(normals.chunks_mut(LANES));
        for (chunk, (points, normals)) in chunks.enumerate() {
            let u = parameters(start, step, chunk);
            match u.first_chunk::<HALF>().filter(|_| points.len() <= HALF) {
                Some(u) => {
                    row.points(u, points);
                    normal_row.normals(u, normals);
                }
                None => {
                    row.points(&u, points);
                    normal_row.normals(&u, normals);
                }
            }
        }
    }

    /// The coefficients of powers of u along constant v.
    #[inline]
    fn positions(&self, v: f64) -> [DVec3; 5] {
        from_fn(|p| horner(self.powers_of_v(p), v))
    }

    /// The same for the derivative by v.
    #[inline]
    fn slopes(&self, v: f64) -> [DVec3; 4] {
        from_fn(|p| horner(&derivative::<5, 4>(&self.coefficients[p])[..4 - p], v))
    }

    #[inline]
    fn powers_of_v(&self, p: usize) -> &[DVec3] {
        &self.coefficients[p][..5 - p]
    }
}

/// The positions along constant v.
struct PointRow([[f64; 5]; 3]);

impl PointRow {
    #[inline]
    fn of(by_u: &[DVec3; 5]) -> Self {
        Self(by_axis(by_u))
    }

    /// The points at the first of the given parameters, as many as there are slots.
    #[inline]
    fn points<const N: usize>(&self, u: &[f64; N], slots: &mut [[f64; 3]]) {
        let [x, y, z] = self.0.map(|c| horner_of_each(&c, u));
        for (l, slot) in slots.iter_mut().take(N).enumerate() {
            *slot = [x[l], y[l], z[l]];
        }
    }
}

/// The normals along constant v, by scaled tangents.
struct NormalRow {
    by_u: [[f64; 4]; 3],
    by_v: [[f64; 4]; 3],
    least_square: f64,
}

impl NormalRow {
    #[inline]
    fn of(c: &[DVec3; 5], d: &[DVec3; 4], piece: &Quartic) -> Self {
        let scaled = |a: DVec3| piece.tangent_scale * a;
        let by_u = by_axis(&derivative::<5, 4>(c).map(scaled));
        Self { by_u, by_v: by_axis(&d.map(scaled)), least_square: piece.least_square }
    }

    /// The unit normals at the first of the given parameters, as many as there are slots.
    #[inline]
    fn normals<const N: usize>(&self, u: &[f64; N], slots: &mut [[f64; 3]]) {
        let [ux, uy, uz] = self.by_u.map(|c| horner_of_each(&c, u));
        let [vx, vy, vz] = self.by_v.map(|c| horner_of_each(&c, u));
        let mut unit = [[0.0; N]; 3];
        for l in 0..N {
            let x = uy[l] * vz[l] - uz[l] * vy[l];
            let y = uz[l] * vx[l] - ux[l] * vz[l];
            let z = ux[l] * vy[l] - uy[l] * vx[l];
            let square = x * x + y * y + z * z;
            let length = if square > self.least_square { 1.0 / square.sqrt() } else { 0.0 };
            unit[0][l] = x * length;
            unit[1][l] = y * length;
            unit[2][l] = z * length;
        }
        let [x, y, z] = unit;
        for (l, slot) in slots.iter_mut().take(N).enumerate() {
            *slot = [x[l], y[l], z[l]];
        }
    }
}

/// The parameters of one chunk of a row.
#[inline]
fn parameters(start: f64, step: f64, chunk: usize) -> [f64; LANES] {
    from_fn(|l| start + (chunk * LANES + l) as f64 * step)
}

/// A polynomial by its coefficients of powers, from the lowest.
#[inline]
fn horner(c: &[DVec3], t: f64) -> DVec3 {
    c.iter().rev().copied().reduce(|sum, c| sum * t + c).unwrap_or_default()
}

/// One coordinate of a polynomial at several parameters.
#[inline]
fn horner_of_each<const C: usize, const N: usize>(c: &[f64; C], t: &[f64; N]) -> [f64; N] {
    t.map(|t| c.iter().rev().copied().reduce(|sum, c| sum * t + c).unwrap_or_default())
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

/// The first forward differences of each order of the first `degree` + 1 values.
#[inline]
fn differences(mut values: [DVec3; 5], degree: usize) -> [DVec3; 5] {
    for order in 1..=degree {
        for i in (order..=degree).rev() {
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
