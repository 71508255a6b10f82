//! Quartic Bézier nets of regular pieces: the fifteen points whose convex hull holds the piece.
//!
//! A regular piece of Loop's surface is a quartic polynomial over its triangle. Its net follows from the twelve
//! points by a matrix of integers over 24, all of them at least 0 (the box spline's conversion). Points `b_ijk`, i + j + k = 4, stand in the order of k, then of j.

use super::box_spline::{CORNERS, RINGS};
use crate::vector::{Blend, DVec3};

/// The fifteen points of a net, or some of their coordinates.
#[derive(Clone, Copy, Debug)]
pub struct BezierTriangle<V = DVec3>(pub [V; 15]);

/// The points along each edge, from its first corner to its second.
pub const EDGES: [[usize; 5]; 3] = [[0, 1, 2, 3, 4], [4, 8, 11, 13, 14], [14, 12, 9, 5, 0]];

/// The points that lie on no edge.
pub const INNER: [usize; 3] = [6, 7, 10];

/// The net seen with corner `r` as the first.
pub(super) const TURNED: [[usize; 15]; 3] = [
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14],
    [4, 8, 11, 13, 14, 3, 7, 10, 12, 2, 6, 9, 1, 5, 0],
    [14, 12, 9, 5, 0, 13, 10, 6, 1, 11, 7, 2, 8, 3, 4],
];

/// Where each row of constant k starts, and its degree.
const ROWS: [(usize, usize); 5] = [(0, 4), (5, 3), (9, 2), (12, 1), (14, 0)];

impl<V: Blend> BezierTriangle<V> {
    /// The net of a regular piece.
    #[inline]
    pub fn of(points: &[V; 12]) -> Self {
        let mut net = [V::default(); 15];
        for corner in 0..3 {
            let at = points[CORNERS[corner]];
            let ring = |slot: usize| points[RINGS[corner][slot] as usize];
            let [a, b, c, d, e, f] = [ring(0), ring(1), ring(2), ring(3), ring(4), ring(5)];
            let turned = &TURNED[corner];
            let (across, along) = (a + d, (b + e) + (c + f));
            let all = across + along;
            // (6 v + Σ n)/12, and the derivatives towards both neighbours.
            let position = (at * 6.0 + all) / 12.0;
            net[turned[0]] = position;
            net[turned[1]] = (at * 12.0 + a * 4.0 + (b + f) * 3.0 + (c + e)) / 24.0;
            net[turned[5]] = (at * 12.0 + b * 4.0 + (a + c) * 3.0 + (d + f)) / 24.0;
            net[turned[2]] = ((at + a) * 2.0 + (b + f)) / 6.0;
            net[turned[6]] = (at * 10.0 + (a + b) * 6.0 + (c + f)) / 24.0;
        }
        Self(net)
    }
}

impl<V: Blend> BezierTriangle<V> {
    /// The two halves that the line from the middle of the edge from corner `edge` to the corner opposite cuts: the first
    /// with the edge's start, the second with its end. Corners keep their places; the middle takes the other end's.
    pub fn halves(&self, edge: usize) -> [Self; 2] {
        let mut halves = [[V::default(); 15]; 2];
        let [first, second] = &mut halves;
        self.halved(
            edge,
            |at, point| first[at] = point,
            |at, point| second[at] = point,
        );
        halves.map(Self)
    }

    /// One of the [`Self::halves`].
    pub fn half(&self, edge: usize, second: bool) -> Self {
        let mut half = [V::default(); 15];
        if second {
            self.halved(edge, |_, _| (), |at, point| half[at] = point);
        } else {
            self.halved(edge, |at, point| half[at] = point, |_, _| ());
        }
        Self(half)
    }

    #[inline]
    fn halved(
        &self,
        edge: usize,
        mut first: impl FnMut(usize, V),
        mut second: impl FnMut(usize, V),
    ) {
        let turned = &TURNED[edge];
        for &(start, degree) in &ROWS {
            let mut row = [V::default(); 5];
            for j in 0..=degree {
                row[j] = self.0[turned[start + j]];
            }
            for step in 0..=degree {
                first(turned[start + step], row[0]);
                second(turned[start + degree - step], row[degree - step]);
                for j in 0..degree - step {
                    row[j] = (row[j] + row[j + 1]) * 0.5;
                }
            }
        }
    }

    /// The points of the piece in the middles of its edges.
    pub fn middles(&self) -> [V; 3] {
        EDGES.map(|[a, b, c, d, e]| {
            let [a, b, c, d, e] = [self.0[a], self.0[b], self.0[c], self.0[d], self.0[e]];
            ((a + e) + (b + d) * 4.0 + c * 6.0) / 16.0
        })
    }

    /// The corners.
    pub fn corners(&self) -> [V; 3] {
        [self.0[0], self.0[4], self.0[14]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::box_spline::{Points, Refined};

    fn arbitrary() -> Points {
        core::array::from_fn(|i| {
            let t = i as f64;
            DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
        })
    }

    /// A point of the net by de Casteljau's algorithm.
    fn point(net: &BezierTriangle, weights: [f64; 3]) -> DVec3 {
        let place = |j: usize, k: usize| ROWS[k].0 + j;
        let mut points = net.0.to_vec();
        for degree in (0..4).rev() {
            let mut next = vec![DVec3::ZERO; 15];
            for k in 0..=degree {
                for j in 0..=degree - k {
                    next[place(j, k)] = weights[0] * points[place(j, k)]
                        + weights[1] * points[place(j + 1, k)]
                        + weights[2] * points[place(j, k + 1)];
                }
            }
            points = next;
        }
        points[0]
    }

    #[test]
    fn nets_of_parts_are_parts_of_the_net() {
        let points = arbitrary();
        let (whole, refined) = (BezierTriangle::of(&points), Refined::of(&points));
        for (weights, part, there) in [
            ([0.2, 0.5, 0.3], 0, [0.6, 0.25, 0.15]),
            ([0.2, 0.5, 0.3], 1, [0.1, 0.75, 0.15]),
            ([0.2, 0.5, 0.3], 2, [0.1, 0.25, 0.65]),
            ([0.2, 0.5, 0.3], 3, [0.4, 0.25, 0.35]),
        ] {
            let found = point(&BezierTriangle::of(&refined.part(part)), weights);
            assert!(found.distance(point(&whole, there)) < 1e-14, "part {part}");
        }
    }

    #[test]
    fn halves_are_halves() {
        let whole = BezierTriangle::of(&arbitrary());
        for edge in 0..3 {
            let halves = whole.halves(edge);
            let weights = [0.2, 0.5, 0.3];
            for (half, other) in [(0, 1), (1, 0)] {
                // The middle stands at the place of the end that the half lost.
                let lost = (edge + 1 - half) % 3;
                let kept = (edge + 1 - other) % 3;
                let mut there = weights;
                there[kept] += weights[lost] / 2.0;
                there[lost] = weights[lost] / 2.0;
                let found = point(&halves[half], weights);
                assert!(
                    found.distance(point(&whole, there)) < 1e-14,
                    "edge {edge}, half {half}"
                );
            }
        }
    }

    #[test]
    fn the_matrix_is_a_convex_combination() {
        for i in 0..12 {
            let mut points = [DVec3::ZERO; 12];
            points[i] = DVec3::X;
            assert!(BezierTriangle::of(&points).0.iter().all(|b| b.x >= 0.0));
        }
        let net = BezierTriangle::of(&[DVec3::ONE; 12]);
        assert!(net.0.iter().all(|b| b.distance(DVec3::ONE) < 1e-15));
    }
}
