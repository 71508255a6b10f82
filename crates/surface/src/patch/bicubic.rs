//! Regular pieces: a quad whose corners have four quads each, or lie on straight creases or at square corners, carries a bicubic
//! polynomial. Points beyond creases are mirror images.
//!
//! Takes the sixteen control points around a quad; gives points, normals and nets of triangular parts of the quad. The net of a part is
//! of degree six. Its points are means of blossoms: of the six arguments that a point has, three at a time are taken for u and the
//! others for v. All weights are at least 0 and sum to 1, as the arguments lie in the quad.

use std::sync::Arc;

use super::polynomial::RegularPiece;
use super::sextic::SexticTriangle;
use super::{LimitPoint, ParamTriangle};
use crate::vector::{Blend, DVec3, unit_or_zero};

/// The control points of a bicubic piece, by row (v) and column (u); the quad's corners are in the middle. `part` is the triangle of
/// the quad's domain that the piece covers; its parts share the points.
#[derive(Clone, Debug)]
pub struct Bicubic {
    pub(crate) points: Arc<[[DVec3; 4]; 4]>,
    pub part: ParamTriangle,
}

/// Weights of four points in a row.
type Weights = [f64; 4];

const THIRD: f64 = 1.0 / 3.0;

/// The weights of the blossom of a uniform cubic spline on its middle segment, for three arguments in any order.
fn blossom([a, b, c]: [f64; 3]) -> Weights {
    // Between the knots −1, 0, 1 and 2: first by a, then by b, then by c.
    let first = [
        [THIRD * (1.0 - a), THIRD * (a + 2.0)],
        [THIRD * (2.0 - a), THIRD * (a + 1.0)],
        [THIRD * (3.0 - a), THIRD * a],
    ];
    let second = [
        [0.5 * (1.0 - b), 0.5 * (b + 1.0)],
        [0.5 * (2.0 - b), 0.5 * b],
    ];
    let third = [1.0 - c, c];
    let mut weights = [0.0; 4];
    for (i, share) in third.into_iter().enumerate() {
        for (j, part) in second[i].into_iter().enumerate() {
            for (k, own) in first[i + j].into_iter().enumerate() {
                weights[i + j + k] += share * part * own;
            }
        }
    }
    weights
}

/// The derivative of a uniform cubic spline on its middle segment.
fn derivative(t: f64) -> Weights {
    let s = 1.0 - t;
    let b = [0.5 * s * s, 0.5 + t * s, 0.5 * t * t];
    [-b[0], b[0] - b[1], b[1] - b[2], b[2]]
}

/// The second derivative of a uniform cubic spline on its middle segment.
fn second_derivative(t: f64) -> Weights {
    [1.0 - t, 3.0 * t - 2.0, 1.0 - 3.0 * t, t]
}

/// The multisets of three of the numbers 0 to 2, by how often each occurs.
const TRIPLES: [[usize; 3]; 10] = [
    [3, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 3, 0],
    [2, 0, 1],
    [1, 1, 1],
    [0, 2, 1],
    [1, 0, 2],
    [0, 1, 2],
    [0, 0, 3],
];

/// The place of a multiset among [`TRIPLES`].
fn triple([_, second, third]: [usize; 3]) -> usize {
    [0, 4, 7, 9][third] + second
}

/// The number of ways to take some of a number of things.
const CHOICES: [[f64; 4]; 7] = [
    [1.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0],
    [1.0, 3.0, 3.0, 1.0],
    [1.0, 4.0, 6.0, 4.0],
    [1.0, 5.0, 10.0, 10.0],
    [1.0, 6.0, 15.0, 20.0],
];

/// The points of the net of the first half of a square, each by the square's Bézier points: those by row and column, and their weights.
static SHARES: [(u8, f64); 100] = SHARES_AND_STARTS.0;

/// Where those of each point start, and the end.
static STARTS: [u8; 29] = SHARES_AND_STARTS.1;

const SHARES_AND_STARTS: ([(u8, f64); 100], [u8; 29]) = shares();

const fn shares() -> ([(u8, f64); 100], [u8; 29]) {
    let (mut shares, mut starts, mut count) = ([(0, 0.0); 100], [0; 29], 0);
    let (mut at, mut k, mut j) = (0, 0, 0);
    while k <= 6 {
        let counts = [6 - j - k, j, k];
        let (mut weights, mut number) = ([0.0; 16], 0);
        while number < TRIPLES.len() {
            // The second corner has 1 for u, the third for v, and all else is 0.
            let taken = TRIPLES[number];
            if taken[0] <= counts[0] && taken[1] <= counts[1] && taken[2] <= counts[2] {
                let [a, b, c] = [CHOICES[counts[0]], CHOICES[counts[1]], CHOICES[counts[2]]];
                weights[4 * (k - taken[2]) + taken[1]] +=
                    a[taken[0]] * b[taken[1]] * c[taken[2]] / 20.0;
            }
            number += 1;
        }
        let mut point = 0;
        while point < 16 {
            if weights[point] > 0.0 {
                shares[count] = (point as u8, weights[point]);
                count += 1;
            }
            point += 1;
        }
        at += 1;
        starts[at] = count as u8;
        (k, j) = if j + k == 6 { (k + 1, 0) } else { (k, j + 1) };
    }
    (shares, starts)
}

impl Bicubic {
    /// The sum of all points by weights.
    fn sum(&self, u: Weights, v: Weights) -> DVec3 {
        combined(self.points.map(|row| combined(row, u)), v)
    }

    /// The point at a place of the quad.
    pub fn point(&self, [u, v]: [f64; 2]) -> DVec3 {
        self.sum(blossom([u; 3]), blossom([v; 3]))
    }

    /// The derivatives along both edges of the quad.
    pub fn derivatives(&self, [u, v]: [f64; 2]) -> [DVec3; 2] {
        [
            self.sum(derivative(u), blossom([v; 3])),
            self.sum(blossom([u; 3]), derivative(v)),
        ]
    }

    /// The second derivatives: along the first edge of the quad twice, along both edges, along the other twice.
    pub fn second_derivatives(&self, [u, v]: [f64; 2]) -> [DVec3; 3] {
        [
            self.sum(second_derivative(u), blossom([v; 3])),
            self.sum(derivative(u), derivative(v)),
            self.sum(blossom([u; 3]), second_derivative(v)),
        ]
    }

    /// The point at a place of the quad, and the unit normal there.
    pub fn limit(&self, at: [f64; 2]) -> LimitPoint {
        let [[u, by_u], [v, by_v]] = at.map(|t| [blossom([t; 3]), derivative(t)]);
        let [rows, slopes] = [u, by_u].map(|u| self.points.map(|row| combined(row, u)));
        LimitPoint {
            position: combined(rows, v),
            normal: unit_or_zero(combined(slopes, v).cross(combined(rows, by_v))),
        }
    }

    /// The control point of a corner of the half that the quad's first part is.
    pub(crate) fn control_point(&self, corner: usize) -> DVec3 {
        self.points[[1, 1, 2][corner]][[1, 2, 1][corner]]
    }

    /// Moves the piece so that one of its points is at the origin, and gives where that was.
    pub(crate) fn moved_to_origin(&mut self) -> DVec3 {
        let from = self.points[1][1];
        *self = self.moved(|point| point - from);
        from
    }

    /// The limits in the middles of the edges of its part.
    pub fn middle(&self, edge: usize) -> LimitPoint {
        self.limit(self.part.along(edge, 0.5))
    }

    /// A part of its part.
    pub fn child(&self, child: usize) -> Self {
        self.over(self.part.child(child))
    }

    /// The piece over another part of the quad.
    pub fn over(&self, part: ParamTriangle) -> Self {
        Self {
            points: self.points.clone(),
            part,
        }
    }

    /// The net of its part.
    pub fn part_net(&self) -> SexticTriangle {
        self.part_net_of(|point| point)
    }

    /// The net of its part, of points as somebody sees them.
    pub fn part_net_of<V: Blend>(&self, seen: impl Fn(DVec3) -> V) -> SexticTriangle<V> {
        let ParamTriangle { u, v, size } = self.part;
        let weights = |from: f64| {
            let to = from + size;
            [[from; 3], [from, from, to], [from, to, to], [to; 3]].map(blossom)
        };
        let (by_u, by_v) = (weights(u), weights(v));
        let [a, b, c, d] = self
            .points
            .map(|row| by_u.map(|u| combined(row.map(&seen), u)));
        let rows = by_v.map(|v| [0, 1, 2, 3].map(|i| combined([a[i], b[i], c[i], d[i]], v)));
        let bezier = rows.as_flattened();
        SexticTriangle(core::array::from_fn(|at| {
            let own = usize::from(STARTS[at])..usize::from(STARTS[at + 1]);
            let of = |&(point, weight): &(u8, f64)| bezier[usize::from(point & 15)] * weight;
            SHARES[own]
                .iter()
                .map(of)
                .fold(V::default(), |sum, own| sum + own)
        }))
    }

    /// The net of a triangle in the quad's domain.
    pub fn net<V: Blend>(
        &self,
        places: [[f64; 2]; 3],
        seen: impl Fn(DVec3) -> V,
    ) -> SexticTriangle<V> {
        let points = self.points.map(|row| row.map(&seen));
        let weights = |axis: usize| {
            TRIPLES.map(|counts| {
                let mut arguments = [0.0; 3];
                let all = (0..3).flat_map(|i| core::iter::repeat_n(places[i][axis], counts[i]));
                arguments
                    .iter_mut()
                    .zip(all)
                    .for_each(|(to, argument)| *to = argument);
                blossom(arguments)
            })
        };
        let (by_u, by_v) = (weights(0), weights(1));
        let rows = by_u.map(|u| points.map(|row| combined(row, u)));
        let blossom = |u: usize, v: usize| combined(rows[u], by_v[v]);
        SexticTriangle::by(|counts| {
            let mut sum = V::default();
            for (number, taken) in TRIPLES.iter().enumerate() {
                let Some(left) = less(counts, *taken) else {
                    continue;
                };
                let ways: f64 = (0..3).map(|i| CHOICES[counts[i]][taken[i]]).product();
                sum = sum + blossom(number, triple(left)) * (ways / 20.0);
            }
            sum
        })
    }
}

#[inline(always)]
fn combined<V: Blend>([a, b, c, d]: [V; 4], weights: Weights) -> V {
    a * weights[0] + b * weights[1] + (c * weights[2] + d * weights[3])
}

fn less(all: [usize; 3], taken: [usize; 3]) -> Option<[usize; 3]> {
    let [a, b, c] = [0, 1, 2].map(|i| all[i].checked_sub(taken[i]));
    Some([a?, b?, c?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arbitrary(part: ParamTriangle) -> Bicubic {
        let at = |i: usize| {
            let t = i as f64;
            DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
        };
        Bicubic {
            points: Arc::new([0, 1, 2, 3].map(|j| [0, 1, 2, 3].map(|i| at(4 * j + i)))),
            part,
        }
    }

    /// Against the spline's own polynomials.
    #[test]
    fn points_are_those_of_the_spline() {
        let piece = arbitrary(ParamTriangle::WHOLE);
        let basis = |t: f64| {
            let s = 1.0 - t;
            [
                s * s * s / 6.0,
                (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
                (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
                t * t * t / 6.0,
            ]
        };
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, 0.5)] {
            assert!(piece.point([u, v]).distance(piece.sum(basis(u), basis(v))) < 1e-14);
            let step = 1e-5;
            let near = |du: f64, dv: f64| piece.point([u + du, v + dv]);
            let [along, across] = piece.derivatives([u, v]);
            assert!(along.distance((near(step, 0.0) - near(-step, 0.0)) / (2.0 * step)) < 1e-9);
            assert!(across.distance((near(0.0, step) - near(0.0, -step)) / (2.0 * step)) < 1e-9);
            let slopes = |du: f64, dv: f64| piece.derivatives([u + du, v + dv]);
            let [uu, uv, vv] = piece.second_derivatives([u, v]);
            let [by_u, by_v] = [[step, 0.0], [0.0, step]].map(|[du, dv]| {
                let (more, less) = (slopes(du, dv), slopes(-du, -dv));
                [0, 1].map(|i| (more[i] - less[i]) / (2.0 * step))
            });
            for (found, expected) in [(uu, by_u[0]), (uv, by_u[1]), (uv, by_v[0]), (vv, by_v[1])] {
                assert!(found.distance(expected) < 1e-9);
            }
        }
    }

    /// Nets of any triangles in the quad give its points, by convex combinations.
    #[test]
    fn nets_are_nets_of_the_piece() {
        for places in [
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            [[1.0, 1.0], [0.0, 1.0], [1.0, 0.0]],
            [[0.25, 0.5], [0.75, 0.5], [0.5, 0.625]],
        ] {
            let piece = arbitrary(ParamTriangle::WHOLE);
            let net = piece.net(places, |point| point);
            for weights in [[1.0, 0.0, 0.0], [0.2, 0.5, 0.3], [0.0, 0.4, 0.6]] {
                let at = [0, 1].map(|axis| (0..3).map(|i| weights[i] * places[i][axis]).sum());
                assert!(
                    net.point(weights).distance(piece.point(at)) < 1e-13,
                    "{places:?}"
                );
            }
            for part in [0, 1, 2, 3].map(|part| piece.part.child(part).child(3)) {
                let own = Bicubic {
                    part,
                    ..piece.clone()
                };
                let (found, expected) = (own.part_net(), own.net(part.corners(), |point| point));
                for (a, b) in found.0.iter().zip(expected.0) {
                    assert!(a.distance(b) < 1e-14, "{part:?}");
                }
            }
            for i in 0..16 {
                let mut points = [[DVec3::ZERO; 4]; 4];
                points[i / 4][i % 4] = DVec3::X;
                let own = Bicubic {
                    points: Arc::new(points),
                    ..piece
                };
                let net = own.net(places, |point| point);
                assert!(net.0.iter().all(|point| point.x >= 0.0), "{i}");
            }
        }
    }
}
