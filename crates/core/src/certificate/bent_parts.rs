//! Parts of regular pieces and triangles over them, four at a time: how far a triangle is from its part, however its corners are moved.
//!
//! The data of a part in [`super::quartic_cell`] do not depend on the plane of projection: the
//! second derivatives along the edges in their middles, as vectors, and bounds of third and fourth
//! ones. They are derived once ([`Bender`]) and kept ([`BentFour`]), and each time that corners
//! were moved their triangles are bounded by it, without the surface ([`MovedFour`]).
//!
//! Numbers are kept in single precision, in a unit that makes the edges of control faces about 1.
//! That turns a bend W by 2⁻²⁴|W|₁ at most, and so the height of the quadratic part, distances of
//! curves from their edges, their slopes times the edges' lengths, and first derivatives by no more
//! than that: it is added to the bound of the rest ([`ROUNDED`]). NaN and values too great for
//! single precision have no bound.

mod moved;

use core::array::from_fn;

use super::quartic_cell::{CUBIC, CURVE_CUBIC, QUARTIC, QUARTIC_SLOPE, QuarticJet};
use crate::vector::DVec3;
pub(crate) use moved::MovedFour;
use wide::f64x4;

/// Parts that are taken together.
pub(crate) const FOUR: usize = 4;

/// Bends may be off by this times the sum of their absolute coordinates: twice the rounding error.
const ROUNDED: f64 = 1.0 / (1 << 23) as f64;

/// Rounds up values that are stored in single precision.
const A_LITTLE_MORE: f64 = 1.0 + 1e-6;

/// Bends whose coordinates' sizes sum up to more have no bound.
const TOO_GREAT: f64 = 1e30;

/// A vector for each of four parts.
type Vectors = [f64x4; 3];

/// Places in the domain of a piece.
pub(crate) type Places = [f64x4; 2];

/// A regular piece, prepared for parts of it.
pub(crate) struct Bender<'a> {
    jet: &'a QuarticJet,
    /// The second derivatives along the third kind of edges of even parts.
    across: [DVec3; 6],
    /// The bound of the fourth derivatives along pairs of edges of even parts of size 1.
    fourth: f64,
}

/// The bend of four parts.
pub(crate) struct Bent {
    /// The second derivatives along the edges in their middles.
    bends: [Vectors; 3],
    /// The share of third and fourth derivatives.
    rest: Rest,
}

/// The bounds of the share of third and fourth derivatives of four parts.
struct Rest {
    /// How far heights over any plane may be off those of the quadratic part.
    height: f64x4,
    /// How far curves may be off their edges, and their slopes towards the ends times the edges' lengths.
    curve: f64x4,
    steep: f64x4,
    /// The greatest error of first derivatives along edges.
    first: f64x4,
}

/// The data kept of four parts. Bends are those along the edges in their middles, by edge, axis and
/// part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BentFour {
    bends: [[[f32; FOUR]; 3]; 3],
    /// Further data: bounds of heights, of distances of curves from their edges, of these curves'
    /// slopes times the edges' lengths, and of first derivatives.
    rest: [f32; FOUR],
    curve: [f32; FOUR],
    steep: [f32; FOUR],
    first: [f32; FOUR],
}

impl<'a> Bender<'a> {
    pub(crate) fn of(jet: &'a QuarticJet) -> Self {
        let [uu, uv, vv] = jet.second();
        let [a, b, c, d, e] = *jet.fourth();
        let pairs = [
            a,
            e,
            a - 4.0 * b + 6.0 * c - 4.0 * d + e,
            c,
            a - 2.0 * b + c,
            e - 2.0 * d + c,
        ];
        Self {
            jet,
            across: from_fn(|i| uu[i] - 2.0 * uv[i] + vv[i]),
            fourth: pairs
                .iter()
                .map(|pair| pair.length_squared())
                .fold(0.0, f64::max)
                .sqrt(),
        }
    }

    /// Parts with edges along the axes of the domain, given by their first corners, with sizes that are negative for inverted ones.
    #[inline]
    pub(crate) fn even(&self, [u, v]: Places, size: f64x4) -> Bent {
        let ([uu, _, vv], half, third) = (self.jet.second(), 0.5 * size, size * (1.0 / 3.0));
        let (square, reach) = (size * size, size.abs());
        let bend = |c: &[DVec3; 6], at: Places| quadratic(c, at).map(|bend| bend * square);
        let bends = [
            bend(uu, [u + half, v]),
            bend(&self.across, [u + half, v + half]),
            bend(vv, [u, v + half]),
        ];
        let [third, bubble] =
            thirds(&self.third([u + third, v + third])).map(|length| length * (square * reach));
        Bent {
            bends,
            rest: Rest::of([third, bubble], self.fourth * (square * square)),
        }
    }

    /// Parts with any corners.
    #[inline]
    pub(crate) fn any(&self, [a, b, c]: [Places; 3]) -> Bent {
        let [uu, uv, vv] = self.jet.second();
        let mut reach = f64x4::ZERO;
        let mut bend = |from: Places, to: Places| {
            let [du, dv] = [to[0] - from[0], to[1] - from[1]];
            reach = reach.fast_max(du.abs()).fast_max(dv.abs());
            let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
            let by = [uu, uv, vv].map(|c| quadratic(c, middle));
            let shares = [du * du, 2.0 * du * dv, dv * dv];
            from_fn(|axis| (0..3).fold(f64x4::ZERO, |sum, i| sum + by[i][axis] * shares[i]))
        };
        let bends = [bend(a, b), bend(b, c), bend(c, a)];
        let square = reach * reach;
        let fourth = self.jet.most(1.0).1 * (square * square);
        let centroid = from_fn(|axis| (a[axis] + b[axis] + c[axis]) * (1.0 / 3.0));
        let [s, r] = [b, c].map(|to| [to[0] - a[0], to[1] - a[1]]);
        let form = self.third(centroid);
        let mut along = [[f64x4::ZERO; 3]; 4];
        for axis in 0..3 {
            let form = form.map(|c| c[axis]);
            let (twice_s, twice_r) = (along_twice(form, s), along_twice(form, r));
            let values = [
                inner(twice_s, s),
                inner(twice_s, r),
                inner(twice_r, s),
                inner(twice_r, r),
            ];
            along
                .iter_mut()
                .zip(values)
                .for_each(|(along, value)| along[axis] = value);
        }
        Bent {
            bends,
            rest: Rest::of(thirds(&along), fourth),
        }
    }

    /// The third derivatives at places: by u three times to v three times.
    #[inline]
    fn third(&self, [u, v]: Places) -> [Vectors; 4] {
        let third = self.jet.third();
        from_fn(|i| {
            let [c, by_u, by_v] = &third[i];
            from_fn(|axis| c[axis] + by_u[axis] * u + by_v[axis] * v)
        })
    }
}

impl Rest {
    /// The bounds by the length of the greatest third derivative along an edge at the centroid,
    /// that of the bubble's coefficient B, and the bound of fourth derivatives along pairs of
    /// edges, as in [`super::quartic_cell`].
    ///
    /// Let s and r be edges from one corner, t = r − s, and F that bound. In the middle of s, a sixth of s − 2r from the centroid,
    /// the third derivative is off by ssss/6 − sssr/3; and sssr = ½(ssss + ssrr − sstt), so by no more than ⅔ F.
    #[inline]
    fn of([third, bubble]: [f64x4; 2], fourth: f64x4) -> Self {
        let in_middle = third + fourth * (2.0 / 3.0);
        Self {
            height: CUBIC * third + bubble * (1.0 / 27.0) + QUARTIC * fourth,
            curve: CURVE_CUBIC * in_middle + fourth * (1.0 / 384.0),
            steep: in_middle * (1.0 / 12.0) + fourth * (1.0 / 48.0),
            first: 0.25 * (third + bubble) + QUARTIC_SLOPE * fourth,
        }
    }
}

impl Bent {
    /// The least and the greatest height of the quadratic parts over the planes of the corners, given their unit normals, and how far
    /// off heights may be from them at most.
    #[inline]
    pub(crate) fn heights(&self, normals: &Vectors) -> (f64x4, f64x4, f64x4) {
        let bends = self.bends.map(|bend| dot(&bend, normals));
        let (low, high) = moved::quadratic_range(bends, [f64x4::ZERO; 3]);
        (low, high, self.rest.height)
    }

    /// The data to keep, in a unit that multiplies lengths by `scale`.
    #[inline]
    pub(crate) fn kept(&self, scale: f64) -> BentFour {
        let bends = self.bends.map(|bend| bend.map(|axis| axis * scale));
        let size = bends.iter().fold(f64x4::ZERO, |size, [x, y, z]| {
            size.fast_max(x.abs() + y.abs() + z.abs())
        });
        let Rest {
            height,
            curve,
            steep,
            first,
        } = &self.rest;
        let [height, curve, steep, first] =
            [height, curve, steep, first].map(|&bound| bound * scale);
        let off = ROUNDED * size;
        let above = |bound: f64x4| (bound + off) * A_LITTLE_MORE;
        let single = |numbers: f64x4| numbers.to_array().map(|number| number as f32);
        // NaN is not below it.
        let sum = bends
            .iter()
            .flatten()
            .fold(height + first, |sum, axis| sum + axis.abs());
        let is_known = (sum + curve + steep).simd_lt(f64x4::splat(TOO_GREAT));
        BentFour {
            bends: bends.map(|bend| bend.map(single)),
            rest: single(is_known.bitselect(above(height), f64x4::splat(f64::INFINITY))),
            curve: single(above(curve)),
            steep: single(above(steep)),
            first: single(above(first)),
        }
    }
}

impl BentFour {
    /// Parts without bounds.
    pub(crate) const UNKNOWN: Self = Self {
        bends: [[[0.0; FOUR]; 3]; 3],
        rest: [f32::INFINITY; FOUR],
        curve: [0.0; FOUR],
        steep: [0.0; FOUR],
        first: [0.0; FOUR],
    };

    /// Takes the part with number `from` of others as that with number `to`; its edge 0 becomes edge `turn`.
    #[inline]
    pub(crate) fn take(&mut self, to: usize, other: &Self, from: usize, turn: usize) {
        for (edge, bends) in other.bends.iter().enumerate() {
            let own = &mut self.bends[(edge + turn) % 3];
            own.iter_mut()
                .zip(bends)
                .for_each(|(own, other)| own[to] = other[from]);
        }
        (self.rest[to], self.curve[to]) = (other.rest[from], other.curve[from]);
        (self.steep[to], self.first[to]) = (other.steep[from], other.first[from]);
    }
}

/// The lengths of the greatest third derivative along an edge and of the bubble's coefficient, for the third derivatives at the
/// centroid, given along the edges from the first corner, s and r: sss, ssr, srr, rrr. See [`super::quartic_cell`].
#[inline]
fn thirds([a, b, c, d]: &[Vectors; 4]) -> [f64x4; 2] {
    let across: Vectors = from_fn(|axis| d[axis] - a[axis] + 3.0 * (b[axis] - c[axis]));
    let bubble: Vectors =
        from_fn(|axis| 0.25 * a[axis] - 0.5 * b[axis] + (across[axis] + d[axis]) * (1.0 / 12.0));
    let most = dot(a, a)
        .fast_max(dot(d, d))
        .fast_max(dot(&across, &across));
    [most.sqrt(), dot(&bubble, &bubble).sqrt()]
}

/// A form of third degree with one direction put in twice.
#[inline]
fn along_twice([a, b, c, d]: [f64x4; 4], [u, v]: Places) -> [f64x4; 2] {
    let [p, q, r] = [a * u + b * v, b * u + c * v, c * u + d * v];
    [p * u + q * v, q * u + r * v]
}

#[inline]
fn inner([a, b]: [f64x4; 2], [u, v]: Places) -> f64x4 {
    a * u + b * v
}

/// The values of a quadratic polynomial.
#[inline]
fn quadratic(c: &[DVec3; 6], [u, v]: Places) -> Vectors {
    from_fn(|axis| {
        let c = c.map(|c| c[axis]);
        c[0] + (c[1] + c[3] * u + c[4] * v) * u + (c[2] + c[5] * v) * v
    })
}

#[inline]
fn dot(a: &Vectors, b: &Vectors) -> f64x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn cross(a: &Vectors, b: &Vectors) -> Vectors {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline]
fn minus(a: &Vectors, b: &Vectors) -> Vectors {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The unit normals of triangles with these edges from a corner; not numbers where they have none.
#[inline]
pub(crate) fn normals(a: &Vectors, b: &Vectors) -> Vectors {
    let across = cross(a, b);
    let share = 1.0 / dot(&across, &across).sqrt();
    across.map(|axis| axis * share)
}

#[cfg(test)]
mod tests;
