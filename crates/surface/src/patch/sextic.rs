//! Bézier nets of degree six: the points whose convex hull holds a triangular part of a bicubic piece.
//!
//! Points `b_ijk`, i + j + k = 6, stand in the order of k, then of j, as those of [`super::bezier_triangle`].

use crate::vector::{Blend, DVec3};

/// The points of a net.
#[derive(Clone, Copy, Debug)]
pub struct SexticTriangle<V = DVec3>(pub [V; 28]);

/// The degree.
const DEGREE: usize = 6;

/// Where each row of constant k starts.
const ROWS: [usize; DEGREE + 1] = [0, 7, 13, 18, 22, 25, 27];

/// The points along each edge, from its first corner to its second.
pub const SEXTIC_EDGES: [[usize; 7]; 3] = [
    [0, 1, 2, 3, 4, 5, 6],
    [6, 12, 17, 21, 24, 26, 27],
    [27, 25, 22, 18, 13, 7, 0],
];

/// The points that lie on no edge.
pub const SEXTIC_INNER: [usize; 10] = [8, 9, 10, 11, 14, 15, 16, 19, 20, 23];

/// The place of a point by how often it has each corner.
const fn place([_, j, k]: [usize; 3]) -> usize {
    ROWS[k] + j
}

/// The place of each point with corner `r` as the first.
const TURNED: [[usize; 28]; 3] = [turned(0), turned(1), turned(2)];

const fn turned(turn: usize) -> [usize; 28] {
    let mut places = [0; 28];
    let mut k = 0;
    while k <= DEGREE {
        let mut j = 0;
        while j <= DEGREE - k {
            let own = [DEGREE - j - k, j, k];
            let mut counts = [0; 3];
            counts[turn] = own[0];
            counts[(turn + 1) % 3] = own[1];
            counts[(turn + 2) % 3] = own[2];
            places[place(own)] = place(counts);
            j += 1;
        }
        k += 1;
    }
    places
}

impl<V: Blend> SexticTriangle<V> {
    /// A net by the points for how often each corner is an argument of its blossom.
    pub(crate) fn by(point: impl Fn([usize; 3]) -> V) -> Self {
        let mut net = [V::default(); 28];
        for k in 0..=DEGREE {
            for j in 0..=DEGREE - k {
                let counts = [DEGREE - j - k, j, k];
                net[place(counts)] = point(counts);
            }
        }
        Self(net)
    }

    /// The corners.
    pub fn corners(&self) -> [V; 3] {
        [self.0[0], self.0[6], self.0[27]]
    }

    /// The two halves that the line from the middle of the edge from corner `edge` to the corner opposite cuts: the first
    /// with the edge's start, the second with its end. Corners keep their places; the middle takes the other end's.
    pub fn halves(&self, edge: usize) -> [Self; 2] {
        let mut halves = [[V::default(); 28]; 2];
        let turned = &TURNED[edge];
        for (k, start) in ROWS.into_iter().enumerate() {
            let degree = DEGREE - k;
            let mut row = [V::default(); DEGREE + 1];
            for j in 0..=degree {
                row[j] = self.0[turned[start + j]];
            }
            for step in 0..=degree {
                halves[0][turned[start + step]] = row[0];
                halves[1][turned[start + degree - step]] = row[degree - step];
                for j in 0..degree - step {
                    row[j] = (row[j] + row[j + 1]) * 0.5;
                }
            }
        }
        halves.map(Self)
    }

    /// The points of the piece in the middles of its edges, and in its middle.
    pub fn middles(&self) -> [V; 4] {
        let on_edge = |edge: usize| {
            let [a, b, c, d, e, f, g] = SEXTIC_EDGES[edge].map(|at| self.0[at]);
            ((a + g) + (b + f) * 6.0 + (c + e) * 15.0 + d * 20.0) / 64.0
        };
        let mut middle = V::default();
        for k in 0..=DEGREE {
            for j in 0..=DEGREE - k {
                let counts = [DEGREE - j - k, j, k];
                let ways = FACTORIALS[6]
                    / counts
                        .map(|count| FACTORIALS[count])
                        .iter()
                        .product::<f64>();
                middle = middle + self.0[place(counts)] * (ways / 729.0);
            }
        }
        [on_edge(0), on_edge(1), on_edge(2), middle]
    }
}

const FACTORIALS: [f64; 7] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0];

impl SexticTriangle {
    /// A point by the weights of the corners, by de Casteljau's algorithm.
    #[cfg(test)]
    pub(crate) fn point(&self, weights: [f64; 3]) -> DVec3 {
        let at = |points: &[DVec3], j: usize, k: usize| points[ROWS[k] + j];
        let mut points = self.0.to_vec();
        for degree in (0..DEGREE).rev() {
            let mut next = vec![DVec3::ZERO; 28];
            for k in 0..=degree {
                for j in 0..=degree - k {
                    next[ROWS[k] + j] = weights[0] * at(&points, j, k)
                        + weights[1] * at(&points, j + 1, k)
                        + weights[2] * at(&points, j, k + 1);
                }
            }
            points = next;
        }
        points[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_halves() {
        let whole = SexticTriangle::by(|[i, j, k]| {
            let t = (3 * i + 5 * j * j + 7 * k) as f64;
            DVec3::new((t * 1.7).sin(), (t * 0.31).cos(), (t * 2.9 + 0.4).sin())
        });
        let weights = [0.2, 0.5, 0.3];
        for edge in 0..3 {
            let halves = whole.halves(edge);
            for (half, other) in [(0, 1), (1, 0)] {
                // The middle stands at the place of the end that the half lost.
                let (lost, kept) = ((edge + 1 - half) % 3, (edge + 1 - other) % 3);
                let mut there = weights;
                there[kept] += weights[lost] / 2.0;
                there[lost] = weights[lost] / 2.0;
                let found = halves[half].point(weights);
                assert!(
                    found.distance(whole.point(there)) < 1e-13,
                    "edge {edge}, half {half}"
                );
            }
        }
        let [a, b, c, middle] = whole.middles();
        assert!(middle.distance(whole.point([1.0 / 3.0; 3])) < 1e-13);
        for (found, at) in
            [a, b, c]
                .into_iter()
                .zip([[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]])
        {
            assert!(found.distance(whole.point(at)) < 1e-13);
        }
    }
}
