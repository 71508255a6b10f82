//! The distance of a part of a regular piece, by parameter, from any triangles that may approximate
//! it: a value of the part alone.
//!
//! Let S be the surface over a domain triangle with corners vᵢ, T the linear map with S's values there, and λ barycentric coordinates.
//! For divided differences ∫[…, a, b] ∂(a − b)g = ∫[…, a] g − ∫[…, b] g holds. Taken at x, vᵢ, vⱼ with g = ∂(vᵢ − vⱼ)S, times
//! λᵢλⱼ and summed over all pairs, it is (Waldron, "The error in linear interpolation at the vertices of a simplex", 1998)
//!
//! > T(x) − S(x) = Σ λᵢλⱼ ∫[x, vᵢ, vⱼ] ∂²S/∂(vᵢ − vⱼ)², the measure's mass being ½,
//!
//! so |S − T| ≤ ½ Σ λᵢλⱼ Mᵢⱼ, Mᵢⱼ bounding the second derivative along the edge all over the triangle. For a quartic that derivative is a
//! quadratic, bounded by its six Bézier points. The right side is a quadratic with a known maximum ([`quadratic_height`]).
//!
//! **Closing triangles.** A triangle some of whose edges are split is covered by halves (a median, half an edge, an edge), quarters (a median
//! and halves of the two edges at its corner) and corners (three half edges, never worse than the whole). Their edges' derivatives are
//! those of the whole, a quarter of them, and along a median to edge c ½Q(a) + ½Q(b) − ¼Q(c), by the parallelogram law. Where Mₘ ≤ min(Mₐ, M_b)
//! none is worse than the whole: a half because its edges are no worse, one by one; a quarter since
//! ½(Mₘλ₀λ₁ + ¼ max(Mₐ, M_b) λ₂(λ₀ + λ₁)) ≤ max(Mₐ, M_b)(1 − λ₂)/8.

use super::greater;
use super::quartic_cell::{Domain, quadratic_height};
use crate::patch::Quartic;
use crate::vector::DVec3;

/// The second derivatives of a regular piece: by u twice, by u and v, by v twice; coefficients of 1, u, v, u², uv, v².
#[derive(Clone, Debug)]
pub(crate) struct SecondDerivatives([[DVec3; 6]; 3]);

impl SecondDerivatives {
    pub(crate) fn of(piece: &Quartic) -> Self {
        let ([uu, uv, vv], [uuu, uuv, uvv, vvv], [uuuu, uuuv, uuvv, uvvv, vvvv]) = piece.powers();
        Self([
            [
                2.0 * uu,
                6.0 * uuu,
                2.0 * uuv,
                12.0 * uuuu,
                6.0 * uuuv,
                2.0 * uuvv,
            ],
            [uv, 2.0 * uuv, 2.0 * uvv, 3.0 * uuuv, 4.0 * uuvv, 3.0 * uvvv],
            [
                2.0 * vv,
                2.0 * uvv,
                6.0 * vvv,
                2.0 * uuvv,
                6.0 * uvvv,
                12.0 * vvvv,
            ],
        ])
    }

    fn at(&self, [u, v]: Domain) -> [DVec3; 3] {
        let value = |&[c, cu, cv, cuu, cuv, cvv]: &[DVec3; 6]| {
            (cuu * u + cuv * v + cu) * u + (cvv * v + cv) * v + c
        };
        [value(&self.0[0]), value(&self.0[1]), value(&self.0[2])]
    }

    /// A bound of how far the surface over a part is from the triangle of its corners, or from triangles that close it where some
    /// of its edges are split: place by place. The part's edges are parallel to the piece's, `size` times as long.
    pub(crate) fn off_triangles(&self, corners: [Domain; 3], size: f64) -> f64 {
        let [a, b, c] = corners;
        let middle = |a: Domain, b: Domain| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let ends = [self.at(a), self.at(b), self.at(c)];
        let between = [
            self.at(middle(a, b)),
            self.at(middle(b, c)),
            self.at(middle(c, a)),
        ];
        let [mut along, mut medians] = [[0.0f64; 3]; 2];
        let mut take = |[uu, uv, vv]: [DVec3; 3]| {
            let edges = [uu, uu - 2.0 * uv + vv, vv];
            for edge in 0..3 {
                let median =
                    0.5 * (edges[(edge + 1) % 3] + edges[(edge + 2) % 3]) - 0.25 * edges[edge];
                along[edge] = greater(along[edge], edges[edge].length_squared());
                medians[edge] = greater(medians[edge], median.length_squared());
            }
        };
        for edge in 0..3 {
            take(ends[edge]);
            let (from, to) = (&ends[edge], &ends[(edge + 1) % 3]);
            take(core::array::from_fn(|i| {
                2.0 * between[edge][i] - 0.5 * (from[i] + to[i])
            }));
        }
        size * size * worst(along.map(f64::sqrt), medians.map(f64::sqrt))
    }
}

/// The greatest of |S − T| over the whole and its closing triangles, by bounds along the edges and
/// along the medians to them.
fn worst(along: [f64; 3], medians: [f64; 3]) -> f64 {
    let mut most = quadratic_height(along);
    for edge in 0..3 {
        let (own, [a, b]) = (along[edge], [along[(edge + 1) % 3], along[(edge + 2) % 3]]);
        let median = medians[edge];
        if median > a.min(b) {
            for [p, q] in [[0.25 * own, a], [0.25 * own, b], [0.25 * a, 0.25 * b]] {
                most = greater(most, quadratic_height([median, p, q]));
            }
        }
    }
    // A value that overflowed on the way is no bound.
    greater(0.0, most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closure::{Diagonal, closure};
    use crate::patch::bezier_triangle::BezierTriangle;

    fn arbitrary(seed: f64) -> Quartic {
        let net = core::array::from_fn(|i| {
            let t = seed + i as f64;
            DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
        });
        Quartic::of(&BezierTriangle(net), 0)
    }

    fn mixed<const N: usize>(points: [[f64; N]; 3], weights: [f64; 3]) -> [f64; N] {
        core::array::from_fn(|i| (0..3).map(|k| weights[k] * points[k][i]).sum())
    }

    /// Samples over every closure of parts of pieces stay below the bound, and come near it.
    #[test]
    fn no_closure_is_farther() {
        let mut nearest = 0.0f64;
        for seed in 0..20 {
            let piece = arbitrary(f64::from(seed) * 3.3);
            let derivatives = SecondDerivatives::of(&piece);
            let parts = [
                ([0.0, 0.0], 1.0),
                ([0.25, 0.5], 0.25),
                ([0.5, 0.5], -0.5),
                ([0.125, 0.25], 0.0625),
            ];
            for ([u, v], size) in parts {
                let corners = [[u, v], [u + size, v], [u, v + size]];
                let bound = derivatives.off_triangles(corners, size);
                let place = |label: u8| match usize::from(label) {
                    corner @ 0..3 => corners[corner],
                    new => {
                        let edge = new - 3;
                        mixed(
                            [corners[edge], corners[(edge + 1) % 3], [0.0; 2]],
                            [0.5, 0.5, 0.0],
                        )
                    }
                };
                let closures = (0..8).flat_map(|split| {
                    [Diagonal::FromStart, Diagonal::FromEnd]
                        .map(|diagonal| closure(split, diagonal))
                });
                for triangle in closures.flat_map(|pattern| pattern.triangles()) {
                    let places = triangle.map(place);
                    let points = places.map(|[u, v]| piece.point(u, v).to_array());
                    for (i, j) in (0..=8).flat_map(|i| (0..=8 - i).map(move |j| (i, j))) {
                        let weights = [i, j, 8 - i - j].map(|w| f64::from(w) / 8.0);
                        let [u, v] = mixed(places, weights);
                        let there = DVec3::from_array(mixed(points, weights));
                        let apart = piece.point(u, v).distance(there);
                        assert!(
                            apart <= bound * (1.0 + 1e-12) + 1e-14,
                            "{apart} beyond {bound}"
                        );
                        nearest = nearest.max(apart / bound);
                    }
                }
            }
        }
        assert!(nearest > 0.8, "{nearest}");
    }
}
