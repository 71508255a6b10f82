//! The heights of a part of a regular piece over the plane of its corners: a quartic that is 0 at
//! the corners, and the bounds of its greatest size: by the parts q, c and r of [`super`], or by
//! its coefficients in Bernstein's basis, halved as often as needed.

use super::{CUBIC, Cell, Domain, Jet, QUARTIC, minus, quadratic};
use crate::vector::Extremes;

/// The heights of a quartic over the plane of its corners: coefficients of sⁱrʲ, s and r running from the first corner
/// to the second and to the third.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heights {
    pub(super) ss: f64,
    pub(super) sr: f64,
    pub(super) rr: f64,
    pub(super) sss: f64,
    pub(super) ssr: f64,
    pub(super) srr: f64,
    pub(super) rrr: f64,
    pub(super) ssss: f64,
    pub(super) sssr: f64,
    pub(super) ssrr: f64,
    pub(super) srrr: f64,
    pub(super) rrrr: f64,
}

impl Heights {
    #[inline]
    pub(super) fn of(jet: &Jet<f64>, cell: &Cell) -> Self {
        let Cell([at, second, third]) = *cell;
        let (s, r) = (minus(second, at), minus(third, at));
        let fourth = jet.fourth;
        let (mut cubic, mut square) = ([0.0; 4], [0.0; 3]);
        for (value, [c, u, v]) in cubic.iter_mut().zip(&jet.third) {
            *value = c + u * at[0] + v * at[1];
        }
        (0..3).for_each(|i| square[i] = quadratic(&jet.second[i], at));
        let (cubic_s, cubic_r) = (contracted4(cubic, s), contracted4(cubic, r));
        let (square_s, square_r) = (contracted3(square, s), contracted3(square, r));
        let (fourth_s, fourth_r) = (contracted5(fourth, s), contracted5(fourth, r));
        let (ss, rr) = (contracted4(fourth_s, s), contracted4(fourth_r, r));
        Self {
            ss: contracted2(square_s, s) / 2.0,
            sr: contracted2(square_s, r),
            rr: contracted2(square_r, r) / 2.0,
            sss: contracted2(contracted3(cubic_s, s), s) / 6.0,
            ssr: contracted2(contracted3(cubic_s, s), r) / 2.0,
            srr: contracted2(contracted3(cubic_r, r), s) / 2.0,
            rrr: contracted2(contracted3(cubic_r, r), r) / 6.0,
            ssss: contracted2(contracted3(ss, s), s) / 24.0,
            sssr: contracted2(contracted3(ss, s), r) / 6.0,
            ssrr: contracted2(contracted3(ss, r), r) / 4.0,
            srrr: contracted2(contracted3(rr, r), s) / 6.0,
            rrrr: contracted2(contracted3(rr, r), r) / 24.0,
        }
    }

    /// The greatest height lies between these.
    pub(crate) fn range(&self) -> (f64, f64) {
        let (quadratic, rest) = (quadratic_height(self.bends()), self.rest());
        ((quadratic - rest).larger(0.0), quadratic + rest)
    }

    /// A lower bound, by the edges, of the range of heights from one side to the other.
    pub(crate) fn least_range(&self) -> f64 {
        edge_range(self.bends())
    }

    /// The least and the greatest value of the quadratic part, and how far off the heights may be from it at most.
    pub(crate) fn about(&self) -> (f64, f64, f64) {
        let (low, high) = quadratic_range(self.bends(), [0.0; 3]);
        (low, high, self.rest())
    }

    /// The greatest height on either side if the surface's corners have the given heights over the
    /// plane, and its greatest error.
    pub(crate) fn lifted_range(&self, lifts: [f64; 3]) -> (f64, f64) {
        let (low, high) = quadratic_range(self.bends(), lifts);
        (high.larger(-low), self.rest())
    }

    /// Second derivatives along the edges in their middles: from the first corner to the second, on to the third, and back.
    #[inline]
    fn bends(&self) -> [f64; 3] {
        let Self {
            ss,
            sr,
            rr,
            sss,
            ssr,
            srr,
            rrr,
            ssss,
            ssrr,
            rrrr,
            ..
        } = *self;
        let first = 2.0 * ss + 3.0 * (sss + ssss);
        let last = 2.0 * rr + 3.0 * (rrr + rrrr);
        let both = 2.0 * (ss + rr - sr) + 3.0 * (sss + rrr + ssss + rrrr) - (ssr + srr) - ssrr;
        [first, both, last]
    }

    /// The bound of the parts of third and fourth degree.
    #[inline]
    fn rest(&self) -> f64 {
        let Self {
            sss,
            ssr,
            srr,
            rrr,
            ssss,
            sssr,
            ssrr,
            srrr,
            rrrr,
            ..
        } = *self;
        // Third derivatives along the edges at the centroid, and the bubble's.
        let [a, b, c, d] = [
            6.0 * sss + 8.0 * ssss + 2.0 * sssr,
            2.0 * ssr + 2.0 * sssr + 4.0 / 3.0 * ssrr,
            2.0 * srr + 4.0 / 3.0 * ssrr + 2.0 * srrr,
            6.0 * rrr + 2.0 * srrr + 8.0 * rrrr,
        ];
        let across = d - a + 3.0 * (b - c);
        let bubble = -0.25 * (a + 2.0 * (b - a)) + (across + d) / 12.0;
        let cubic = CUBIC * a.abs().larger(d.abs()).larger(across.abs()) + bubble.abs() / 27.0;
        // Fourth derivatives along pairs of edges.
        let pairs = [
            24.0 * ssss,
            24.0 * rrrr,
            24.0 * (ssss - sssr + ssrr - srrr + rrrr),
            4.0 * ssrr,
            24.0 * ssss - 12.0 * sssr + 4.0 * ssrr,
            24.0 * rrrr - 12.0 * srrr + 4.0 * ssrr,
        ];
        cubic + QUARTIC * pairs.iter().fold(0.0f64, |most, x| most.larger(x.abs()))
    }

    /// A bound for the greatest height by Bernstein coefficients over the parts that `levels` divisions into four give; parts that
    /// are no higher than is good enough are not divided.
    pub(crate) fn refined(&self, levels: u32, enough: f64) -> f64 {
        self.lifted([0.0; 3], levels, enough)
    }

    /// The least and the greatest height in a few places.
    pub(crate) fn sampled(&self) -> (f64, f64) {
        let Self {
            ss,
            sr,
            rr,
            sss,
            ssr,
            srr,
            rrr,
            ssss,
            sssr,
            ssrr,
            srrr,
            rrrr,
        } = *self;
        let (by_s, by_r) = (ss + sss + ssss, rr + rrr + rrrr);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (j, k) in (0..=4).flat_map(|k| (0..=4 - k).map(move |j| (j, k))) {
            let (s, r) = (0.25 * f64::from(j), 0.25 * f64::from(k));
            let along = (((ssss * s + sss) * s + ss) * s - by_s) * s;
            let across = (((rrrr * r + rrr) * r + rr) * r - by_r) * r;
            let mixed = (sr + (ssr + sssr * s) * s + (srr + srrr * r) * r + ssrr * s * r) * s * r;
            let height = along + across + mixed;
            (low, high) = (low.smaller(height), high.larger(height));
        }
        (low, high)
    }

    /// [`Self::refined`] if the surface's corners have these heights over the plane.
    pub(crate) fn lifted(&self, [first, second, third]: [f64; 3], levels: u32, enough: f64) -> f64 {
        let mut coefficients = self.bernstein();
        let (along, across) = (0.25 * (second - first), 0.25 * (third - first));
        for (k, row) in ROWS.iter().enumerate() {
            for j in 0..5 - k {
                coefficients[row + j] += first + along * j as f64 + across * k as f64;
            }
        }
        halved(&coefficients, 2 * levels, enough)
    }

    /// The coefficients in Bernstein's basis, in rows of constant power of r.
    fn bernstein(&self) -> [f64; 15] {
        let Self {
            ss,
            sr,
            rr,
            sss,
            ssr,
            srr,
            rrr,
            ssss,
            sssr,
            ssrr,
            srrr,
            rrrr,
        } = *self;
        // Heights of 0 at the corners fix the first derivatives.
        let s = -(ss + sss + ssss);
        let r = -(rr + rrr + rrrr);
        let power = [
            [0.0, r, rr, rrr, rrrr],
            [s, sr, srr, srrr, 0.0],
            [ss, ssr, ssrr, 0.0, 0.0],
            [sss, sssr, 0.0, 0.0, 0.0],
            [ssss, 0.0, 0.0, 0.0, 0.0],
        ];
        let mut coefficients = [0.0; 15];
        let mut at = 0;
        for (k, of_r) in SHARES.iter().enumerate() {
            for (j, of_s) in SHARES.iter().enumerate().take(5 - k) {
                for p in 0..=j {
                    for q in 0..=k {
                        coefficients[at] += power[p][q] * of_s[p] * of_r[q] * WEIGHTS[p][q];
                    }
                }
                at += 1;
            }
        }
        coefficients
    }
}

/// Binomial coefficients.
const SHARES: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// p! q! (4 − p − q)!/4! by p and q.
const WEIGHTS: [[f64; 5]; 5] = [
    [1.0, 1.0 / 4.0, 1.0 / 6.0, 1.0 / 4.0, 1.0],
    [1.0 / 4.0, 1.0 / 12.0, 1.0 / 12.0, 1.0 / 4.0, 0.0],
    [1.0 / 6.0, 1.0 / 12.0, 1.0 / 6.0, 0.0, 0.0],
    [1.0 / 4.0, 1.0 / 4.0, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, 0.0],
];

/// Where each row of a net starts.
const ROWS: [usize; 5] = [0, 5, 9, 12, 14];

/// The greatest size of a coefficient after `halvings` halvings, except for parts with none above
/// `enough`.
pub(super) fn halved(net: &[f64; 15], halvings: u32, enough: f64) -> f64 {
    let most = net.iter().fold(0.0f64, |most, x| most.larger(x.abs()));
    if halvings == 0 || most <= enough {
        return most;
    }
    halves(net).iter().fold(0.0, |most, half| {
        most.larger(halved(half, halvings - 1, enough))
    })
}

/// The halves of a net, each with the middle of its first edge between the corner that it keeps and the third, so that
/// the next halving cuts another edge, and two of them divide into four.
fn halves(net: &[f64; 15]) -> [[f64; 15]; 2] {
    let mut halves = [[0.0; 15]; 2];
    halved_row::<0>(net, &mut halves);
    halved_row::<1>(net, &mut halves);
    halved_row::<2>(net, &mut halves);
    halved_row::<3>(net, &mut halves);
    halved_row::<4>(net, &mut halves);
    halves
}

/// The halves of the K-th row of a net. (With K known no index needs a check.)
#[inline(always)]
fn halved_row<const K: usize>(net: &[f64; 15], halves: &mut [[f64; 15]; 2]) {
    let degree = 4 - K;
    let mut row = [0.0; 5];
    row[..=degree].copy_from_slice(&net[ROWS[K]..=ROWS[K] + degree]);
    for step in 0..=degree {
        // Number of the coefficient in the half: `step` towards the middle, K towards the third corner.
        halves[0][ROWS[step] + degree - step] = row[0];
        halves[1][ROWS[step] + K] = row[degree - step];
        for j in 0..degree - step {
            row[j] = 0.5 * (row[j] + row[j + 1]);
        }
    }
}

/// The least and the greatest value of a quadratic, by its second derivatives along the edges as in [`quadratic_height`] and its
/// values at the corners.
fn quadratic_range([p, q, s]: [f64; 3], [a, b, c]: [f64; 3]) -> (f64, f64) {
    let (mut low, mut high) = (a.smaller(b).smaller(c), a.larger(b).larger(c));
    let mut take = |value: f64| (low, high) = (low.smaller(value), high.larger(value));
    for (bend, from, to) in [(p, a, b), (q, b, c), (s, c, a)] {
        let rise = to - from;
        // Where the derivative along the edge vanishes.
        if 2.0 * rise.abs() < bend.abs() {
            take(0.5 * (from + to) - 0.125 * bend - 0.5 * rise * rise / bend);
        }
    }
    // Where both derivatives from the first corner do; between the values along the edges if the quadratic is a saddle.
    let mixed = p + s - q;
    let determinant = 4.0 * p * s - mixed * mixed;
    if determinant > 0.0 {
        let (by_second, by_third) = (p - 2.0 * (b - a), s - 2.0 * (c - a));
        let second = (2.0 * s * by_second - mixed * by_third) / determinant;
        let third = (2.0 * p * by_third - mixed * by_second) / determinant;
        if second > 0.0 && third > 0.0 && second + third < 1.0 {
            take(a - 0.25 * (second * by_second + third * by_third));
        }
    }
    (low, high)
}

/// The range of the heights over the edges of a quadratic that is 0 at the corners, by its second derivatives along these.
pub(crate) fn edge_range([p, q, s]: [f64; 3]) -> f64 {
    let (low, high) = (p.smaller(q).smaller(s), p.larger(q).larger(s));
    0.125 * (high.larger(0.0) - low.smaller(0.0))
}

/// The greatest height of a quadratic that is 0 at the corners, by its second derivatives along the edges from the first
/// corner to the second, on to the third, and back.
pub(crate) fn quadratic_height([p, q, s]: [f64; 3]) -> f64 {
    let edges = 0.125 * p.abs().larger(q.abs()).larger(s.abs());
    // Where the derivatives along two edges vanish.
    let (l2, l1, l0) = (p * (q + s - p), s * (p + q - s), q * (p + s - q));
    let total = l0 + l1 + l2;
    let is_inside = l0 * total > 0.0 && l1 * total > 0.0 && l2 * total > 0.0;
    if is_inside {
        edges.larger((0.5 * p * q * s / total).abs())
    } else {
        edges
    }
}

/// A form of second degree with one direction put in.
#[inline]
fn contracted3([a, b, c]: [f64; 3], [u, v]: Domain) -> [f64; 2] {
    [a * u + b * v, b * u + c * v]
}

#[inline]
fn contracted2([a, b]: [f64; 2], [u, v]: Domain) -> f64 {
    a * u + b * v
}

#[inline]
fn contracted4([a, b, c, d]: [f64; 4], [u, v]: Domain) -> [f64; 3] {
    [a * u + b * v, b * u + c * v, c * u + d * v]
}

#[inline]
fn contracted5([a, b, c, d, e]: [f64; 5], [u, v]: Domain) -> [f64; 4] {
    [a * u + b * v, b * u + c * v, c * u + d * v, d * u + e * v]
}
