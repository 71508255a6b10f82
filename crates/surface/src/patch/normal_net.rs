//! The normals of a regular piece, not of unit length, as a Bézier net: of degree 6 for a quartic, of degree 10 for half a bicubic piece.
//!
//! The derivatives of a quartic with the net b are cubics, with the nets `D1_a = b_(a+e1) − b_(a+e0)` and
//! `D2_a = b_(a+e2) − b_(a+e0)`, |a| = 3, but for a factor of 4. By the product of Bernstein polynomials (Farin, Curves and Surfaces
//! for CAGD) `N = S_1 × S_2` has the net
//!
//! > `N_t = Σ_(a+b=t) mult(a) mult(b)/mult(t) · D1_a × D2_b`, |t| = 6, `mult(a) = |a|!/(a_0! a_1! a_2!)`.

use super::bezier_triangle::BezierTriangle;
use crate::vector::DVec3;

/// Coefficients of a cubic.
pub const CUBIC: usize = size(3);

/// Coefficients of a form of degree 5.
pub(crate) const QUINTIC: usize = size(5);

/// Coefficients of a form of degree 6.
pub(crate) const SEXTIC: usize = size(6);

/// Coefficients of a form of degree 10.
pub(crate) const DECIC: usize = size(10);

static CUBICS: Products<CUBIC> = products::<CUBIC, CUBIC, SEXTIC>(3, 3);
static QUINTICS: Products<QUINTIC> = products::<QUINTIC, QUINTIC, DECIC>(5, 5);

type Products<const N: usize> = [[(u8, f64); N]; N];

/// The nets of the derivatives by the second and by the third corner's weight, a quarter of them.
pub fn tangents(net: &BezierTriangle) -> [[DVec3; CUBIC]; 2] {
    differences(4, &net.0)
}

/// The same for a net of any degree, divided by the degree.
pub(crate) fn differences<const LESS: usize>(degree: usize, net: &[DVec3]) -> [[DVec3; LESS]; 2] {
    let b = |j: usize, k: usize| net[place(degree, j, k)];
    let mut tangents = [[DVec3::ZERO; LESS]; 2];
    for k in 0..degree {
        for j in 0..degree - k {
            let (at, from) = (place(degree - 1, j, k), b(j, k));
            [tangents[0][at], tangents[1][at]] = [b(j + 1, k) - from, b(j, k + 1) - from];
        }
    }
    tangents
}

/// The net of the cross products of two cubics.
pub fn cross_products(tangents: &[[DVec3; CUBIC]; 2]) -> [DVec3; SEXTIC] {
    crossed(tangents, &CUBICS)
}

/// The net of the cross products of two forms of degree 5.
pub(crate) fn quintic_products(tangents: &[[DVec3; QUINTIC]; 2]) -> [DVec3; DECIC] {
    crossed(tangents, &QUINTICS)
}

fn crossed<const N: usize, const PRODUCT: usize>(
    [along, across]: &[[DVec3; N]; 2],
    table: &Products<N>,
) -> [DVec3; PRODUCT] {
    let mut products = [DVec3::ZERO; PRODUCT];
    for (a, row) in along.iter().zip(table) {
        for (b, &(at, part)) in across.iter().zip(row) {
            products[usize::from(at)] += part * a.cross(*b);
        }
    }
    products
}

/// Coefficients of a form of degree `n` in barycentric coordinates.
pub(crate) const fn size(n: usize) -> usize {
    (n + 1) * (n + 2) / 2
}

/// The place of `b_ijk`, i = n − j − k, in the order of [`BezierTriangle`]: of k, then of j.
pub(crate) const fn place(n: usize, j: usize, k: usize) -> usize {
    k * (n + 1) - k * k.saturating_sub(1) / 2 + j
}

const fn factorial(n: usize) -> f64 {
    if n == 0 {
        1.0
    } else {
        n as f64 * factorial(n - 1)
    }
}

/// `n!/(i! j! k!)` by place.
pub(crate) const fn multinomials<const SIZE: usize>(n: usize) -> [f64; SIZE] {
    let mut all = [0.0; SIZE];
    let mut k = 0;
    while k <= n {
        let mut j = 0;
        while j + k <= n {
            all[place(n, j, k)] =
                factorial(n) / (factorial(n - j - k) * factorial(j) * factorial(k));
            j += 1;
        }
        k += 1;
    }
    all
}

/// Where each pair of coefficients of two forms goes in their product, and by which part.
pub(crate) const fn products<const A: usize, const B: usize, const PRODUCT: usize>(
    a: usize,
    b: usize,
) -> [[(u8, f64); B]; A] {
    let (of_a, of_b): ([f64; A], [f64; B]) = (multinomials(a), multinomials(b));
    let of_product: [f64; PRODUCT] = multinomials(a + b);
    let mut all = [[(0, 0.0); B]; A];
    let (mut k, mut j) = (0, 0);
    while k <= a {
        while j + k <= a {
            let (mut l, mut m) = (0, 0);
            while l <= b {
                while m + l <= b {
                    let (first, second) = (place(a, j, k), place(b, m, l));
                    let at = place(a + b, j + m, k + l);
                    all[first][second] = (at as u8, of_a[first] * of_b[second] / of_product[at]);
                    m += 1;
                }
                (l, m) = (l + 1, 0);
            }
            j += 1;
        }
        (k, j) = (k + 1, 0);
    }
    all
}
