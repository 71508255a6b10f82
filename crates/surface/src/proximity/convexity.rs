//! How the squared distance of a point from a regular piece bends at least, which bounds it from below.
//!
//! With ½|S − q|² = f, the second derivatives are f_ij = (S_i·S_j + S·S_ij) − q·S_ij. For S of degree n the first term is a polynomial of
//! degree 2n − 2 that does not depend on q, S_ij one of degree n − 2; both are in the hull of their Bézier coefficients. In parameters that are orthonormal amid the piece f_ij is
//! nearly the identity where the point is near. Intervals around its three entries give a bound λ from below on its eigenvalues, so that
//! f(y) ≥ f(x) + ∇f(x)·(y − x) + ½ λ |y − x|² in these parameters. The least value of the linear part over the piece is at a corner (Frank and
//! Wolfe, "An algorithm for quadratic programming", 1956); with λ above 0 f is convex, and at least f(x) − |∇f(x)|² / 2λ anywhere.

use core::array::from_fn;

use crate::geometry::box_tree::{Bounds, NO_BOUNDS, grown};
use crate::math;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::normal_net::{differences, multinomials, place, size};
use crate::patch::sextic::SexticTriangle;
use crate::vector::DVec3;

/// The part of a piece that decides how its distance from points bends.
#[derive(Clone, Debug)]
pub(super) struct Convexity {
    /// The least and greatest of `S_i·S_j + S·S_ij`: both by the first parameter, one by each, both by the second.
    products: [[f64; 2]; 3],
    /// Boxes around `S_ij`, alike.
    second: [Bounds; 3],
    /// Factors `p`, `r`, `s` so that `p·S_u` and `r·S_u + s·S_v` are orthonormal amid the piece;
    /// NaN where they do not exist.
    factors: [f64; 3],
}

impl Convexity {
    /// Of a net that stands about the origin.
    pub(crate) fn of_quartic(net: &BezierTriangle) -> Self {
        Self::of::<15, 10, 6, 28>(&net.0)
    }

    /// Of a net of degree six.
    pub(crate) fn of_sextic(net: &SexticTriangle) -> Self {
        Self::of::<28, 21, 15, 66>(&net.0)
    }

    /// Of any net; `FIRST` and `SECOND` coefficients have its derivatives, `PRODUCT` their products.
    fn of<const NET: usize, const FIRST: usize, const SECOND: usize, const PRODUCT: usize>(
        net: &[DVec3; NET],
    ) -> Self {
        let degree = const { degree_of(NET) };
        let (n, factor) = (degree - 1, degree as f64);
        let [by_u, by_v] =
            differences::<FIRST>(degree, net).map(|net| scaled(net.map(|by| factor * by)));
        let second = second::<SECOND>(degree, net);
        let mut products = [[0.0; PRODUCT]; 3];
        add_product(&mut products[0], (n, &by_u), (n, &by_u));
        add_product(&mut products[1], (n, &by_u), (n, &by_v));
        add_product(&mut products[2], (n, &by_v), (n, &by_v));
        // The mean over the piece is that of the coefficients.
        let [e, f, g] =
            products.map(|product| unscaled(product).iter().sum::<f64>() / PRODUCT as f64);
        let factors = orthonormal(e, f, g);
        let whole = scaled(*net);
        for (products, second) in products.iter_mut().zip(&second) {
            add_product(products, (degree, &whole), (n - 1, &scaled(*second)));
            *products = unscaled(*products);
        }
        let [uu, uv, vv] = &products;
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for ((&uu, &uv), &vv) in uu.iter().zip(uv).zip(vv) {
            ends.iter_mut()
                .zip(turned(factors, [uu, uv, vv]))
                .for_each(|([low, high], value)| {
                    (*low, *high) = (low.min(value), high.max(value));
                });
        }
        let [uu, uv, vv] = &second;
        let mut boxes = [NO_BOUNDS; 3];
        for ((&uu, &uv), &vv) in uu.iter().zip(uv).zip(vv) {
            let by_axis: [[f64; 3]; 3] =
                from_fn(|axis| turned(factors, [uu[axis], uv[axis], vv[axis]]));
            for (entry, bounds) in boxes.iter_mut().enumerate() {
                *bounds = grown(
                    *bounds,
                    DVec3::from_array(from_fn(|axis| by_axis[axis][entry])),
                );
            }
        }
        Self {
            products: ends,
            second: boxes,
            factors,
        }
    }

    /// A bound from below on the eigenvalues of the second derivatives of half the squared distance
    /// from a point, all over the piece, in the orthonormal parameters; NaN where unknown.
    pub(super) fn least_eigenvalue(&self, point: DVec3) -> f64 {
        let [uu, uv, vv] = from_fn(|entry| {
            let ([low, high], [least, most]) = (self.products[entry], self.second[entry]);
            let (a, b) = (point * least, point * most);
            [low - a.max(b).element_sum(), high - a.min(b).element_sum()]
        });
        let across = uv[0].abs().max(uv[1].abs());
        let (mean, half) = (0.5 * (uu[0] + vv[0]), 0.5 * (uu[0] - vv[0]));
        mean - math::hypot(half, across)
    }

    /// A bound from below on half the squared distance all over the piece, given that at a place, its derivatives there, and
    /// [`Self::least_eigenvalue`].
    pub(super) fn bound(
        &self,
        value: f64,
        at: [f64; 2],
        gradient: [f64; 2],
        eigenvalue: f64,
    ) -> f64 {
        let ways =
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[u, v]: [f64; 2]| [u - at[0], v - at[1]]);
        let fall = ways
            .iter()
            .map(|[u, v]| -u * gradient[0] - v * gradient[1])
            .fold(0.0, f64::max);
        let [p, r, s] = self.factors;
        if eigenvalue > 0.0 {
            let turned = [p * gradient[0], r * gradient[0] + s * gradient[1]];
            let most = (turned[0] * turned[0] + turned[1] * turned[1]) / (2.0 * eigenvalue);
            return value - fall.min(most);
        }
        // (u, v) = (p a + r b, s b) in the orthonormal parameters (a, b).
        let reach = |[u, v]: [f64; 2]| {
            let (b, a) = (v / s, (u - r * v / s) / p);
            a * a + b * b
        };
        let farthest = ways.into_iter().map(reach).fold(0.0, f64::max);
        value - fall + 0.5 * eigenvalue * farthest
    }
}

/// Factors `p`, `r`, `s` so that `p·S_u` and `r·S_u + s·S_v` are orthonormal, given the first fundamental form.
fn orthonormal(e: f64, f: f64, g: f64) -> [f64; 3] {
    let s = (g - f * f / e).sqrt().recip();
    [e.sqrt().recip(), -f / e * s, s]
}

/// Second derivatives in the parameters given by the factors.
fn turned([p, r, s]: [f64; 3], [uu, uv, vv]: [f64; 3]) -> [f64; 3] {
    [
        p * p * uu,
        p * (r * uu + s * uv),
        r * r * uu + 2.0 * r * s * uv + s * s * vv,
    ]
}

/// The nets of the second derivatives.
fn second<const SECOND: usize>(degree: usize, net: &[DVec3]) -> [[DVec3; SECOND]; 3] {
    let mut derivatives = [[DVec3::ZERO; SECOND]; 3];
    let factor = (degree * (degree - 1)) as f64;
    for k in 0..degree - 1 {
        for j in 0..degree - 1 - k {
            let at = |by_j: usize, by_k: usize| net[place(degree, j + by_j, k + by_k)];
            let own = place(degree - 2, j, k);
            derivatives[0][own] = factor * ((at(2, 0) - at(1, 0)) - (at(1, 0) - at(0, 0)));
            derivatives[1][own] = factor * ((at(1, 1) - at(1, 0)) - (at(0, 1) - at(0, 0)));
            derivatives[2][own] = factor * ((at(0, 2) - at(0, 1)) - (at(0, 1) - at(0, 0)));
        }
    }
    derivatives
}

/// The degree of a net by the number of its points.
const fn degree_of(points: usize) -> usize {
    let mut degree = 0;
    while size(degree) < points {
        degree += 1;
    }
    degree
}

/// A net times its multinomial coefficients: products of such are sums.
fn scaled<const SIZE: usize>(mut net: [DVec3; SIZE]) -> [DVec3; SIZE] {
    let weights = const { &multinomials::<SIZE>(degree_of(SIZE)) };
    net.iter_mut()
        .zip(weights)
        .for_each(|(point, &weight)| *point *= weight);
    net
}

fn unscaled<const SIZE: usize>(mut net: [f64; SIZE]) -> [f64; SIZE] {
    let weights = const { &multinomials::<SIZE>(degree_of(SIZE)) };
    net.iter_mut()
        .zip(weights)
        .for_each(|(value, weight)| *value /= weight);
    net
}

/// Adds the scalar product of two scaled nets (Farin, on products in Bernstein form).
fn add_product(net: &mut [f64], (m, a): (usize, &[DVec3]), (n, b): (usize, &[DVec3])) {
    for (ka, kb) in (0..=m).flat_map(|ka| (0..=n).map(move |kb| (ka, kb))) {
        for ja in 0..=m - ka {
            let own = a[place(m, ja, ka)];
            let others = &b[place(n, 0, kb)..=place(n, n - kb, kb)];
            let first = place(m + n, ja, ka + kb);
            net[first..]
                .iter_mut()
                .zip(others)
                .for_each(|(sum, other)| *sum += own.dot(*other));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::bicubic::Bicubic;
    use crate::patch::polynomial::Polynomial;
    use crate::patch::{ParamTriangle, Quartic};

    fn bent(height: f64) -> BezierTriangle {
        let places = (0..5)
            .flat_map(|k| (0..5 - k).map(move |j| (0.25 * f64::from(j), 0.25 * f64::from(k))));
        let points: Vec<DVec3> = places
            .map(|(u, v)| {
                let (x, y) = (u + 0.5 * v - 0.5, 0.866 * v - 0.289);
                DVec3::new(
                    x + 0.1 * y * y,
                    y,
                    height * (x * x + y * y - 0.6 * x * x * y),
                )
            })
            .collect();
        BezierTriangle(from_fn(|i| points[i]))
    }

    /// Half of a bicubic piece that bends alike, about the origin.
    fn bent_half(height: f64) -> Bicubic {
        let at = |i: usize, j: usize| {
            let (x, y) = (0.9 * i as f64 - 1.2, 0.8 * j as f64 - 1.1);
            let z = height * (x * x + y * y - 0.6 * x * x * y);
            DVec3::new(x + 0.1 * y * y, y + 0.2 * x, z)
        };
        Bicubic {
            points: std::sync::Arc::new(from_fn(|j| from_fn(|i| at(i, j)))),
            part: ParamTriangle::WHOLE.child(3),
        }
    }

    fn pieces() -> Vec<(f64, Convexity, Polynomial)> {
        let of_height = |height: f64| {
            let (net, half) = (bent(height), bent_half(height));
            let quartic = Polynomial::Quartic(Quartic::of(&net, 0));
            let sextic = Convexity::of_sextic(&half.part_net());
            [
                (height, Convexity::of_quartic(&net), quartic),
                (height, sextic, Polynomial::Bicubic(half)),
            ]
        };
        [0.0, 0.3, 1.0].into_iter().flat_map(of_height).collect()
    }

    fn places() -> impl Iterator<Item = [f64; 2]> {
        let steps = (0..=12)
            .flat_map(|i| (0..=12 - i).map(move |j| (f64::from(i) / 12.0, f64::from(j) / 12.0)));
        steps.map(|(u, v)| [u, v])
    }

    /// Against the distance itself, at many places: by values, and where it is called convex by differences.
    #[test]
    fn no_place_is_below_the_bound() {
        let mut answers = [0, 0];
        for (height, convexity, piece) in pieces() {
            for i in 0..200 {
                let at = |step: f64| 3.0 * (0.3 + step * f64::from(i)).fract() - 1.5;
                let point = DVec3::new(at(0.618), at(0.7548), at(0.5698));
                let eigenvalue = convexity.least_eigenvalue(point);
                answers[usize::from(eigenvalue > 0.0)] += 1;
                let half = |[u, v]: [f64; 2]| 0.5 * piece.point(u, v).distance_squared(point);
                let least = places().map(half).fold(f64::INFINITY, f64::min);
                for from in [[0.0, 0.0], [0.2, 0.3], [0.5, 0.5], [0.0, 0.9]] {
                    let away = piece.point(from[0], from[1]) - point;
                    let gradient = piece.tangents(from[0], from[1]).map(|by| away.dot(by));
                    let bound = convexity.bound(half(from), from, gradient, eigenvalue);
                    assert!(
                        bound <= least + 1e-12,
                        "height {height}, point {point}: {bound} and {least}"
                    );
                }
                // Where f is least no value is far below it: the bound must not be trivial.
                let nearest = places()
                    .min_by(|a, b| half(*a).total_cmp(&half(*b)))
                    .unwrap_or_default();
                let away = piece.point(nearest[0], nearest[1]) - point;
                let gradient = piece
                    .tangents(nearest[0], nearest[1])
                    .map(|by| away.dot(by));
                let bound = convexity.bound(least, nearest, gradient, eigenvalue);
                assert!(
                    eigenvalue < 0.5 || bound > least - 0.1,
                    "height {height}, point {point}: {bound} and {least}"
                );
                for [u, v] in places().map(|[u, v]| [0.02 + 0.94 * u, 0.02 + 0.94 * v]) {
                    for [du, dv] in [
                        [1e-3, 0.0],
                        [0.0, 1e-3],
                        [1e-3, -1e-3],
                        [1e-3, 1e-3],
                        [2e-3, -1e-3],
                    ] {
                        let difference =
                            half([u + du, v + dv]) + half([u - du, v - dv]) - 2.0 * half([u, v]);
                        assert!(
                            eigenvalue <= 0.0 || difference > -1e-12,
                            "height {height}, point {point}"
                        );
                    }
                }
            }
        }
        assert!(answers.iter().all(|&count| count > 50), "{answers:?}");
    }

    #[test]
    fn a_piece_without_area_is_not_called_convex() {
        let net = BezierTriangle([DVec3::ZERO; 15]);
        let eigenvalue = Convexity::of_quartic(&net).least_eigenvalue(DVec3::ONE);
        assert!(eigenvalue.is_nan() || eigenvalue <= 0.0, "{eigenvalue}");
    }
}
