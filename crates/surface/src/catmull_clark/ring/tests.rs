//! Limits beside what many steps give, and beside values known as fractions.

use super::*;
use crate::ring::RingShape;

fn smooth(valence: u32) -> SharpRing {
    SharpRing::of(RingShape::interior(valence))
}

/// A ring with some sharp edges.
fn sharp(edges: usize, open: bool, vertex: f64, spokes: &[(usize, f64)]) -> SharpRing {
    let mut all = vec![0.0; edges];
    spokes
        .iter()
        .for_each(|&(slot, sharpness)| all[slot] = sharpness);
    if open {
        (all[0], all[edges - 1]) = (f64::INFINITY, f64::INFINITY);
    }
    SharpRing {
        open,
        vertex,
        spokes: all,
    }
}

/// The points of a ring after a step, one by one as the rules say.
fn refined(points: &[f64], ring: &SharpRing) -> Vec<f64> {
    let all = Points::of(ring);
    let n = all.edges;
    let centroid = |slot: usize| all.quad(slot % n).map(|at| points[at]).iter().sum::<f64>() / 4.0;
    let own: f64 = vertex_weights(ring)
        .iter()
        .zip(points)
        .map(|(w, p)| w * p)
        .sum();
    let mut next = vec![own];
    for slot in 0..n {
        let s = sharpness(ring, slot).min(1.0);
        let middle = 0.5 * (points[0] + points[all.neighbour(slot)]);
        let faces = if s < 1.0 {
            0.5 * (centroid(slot) + centroid(slot + n - 1))
        } else {
            0.0
        };
        next.push(s * middle + (1.0 - s) * 0.5 * (middle + faces));
    }
    next.extend((0..all.quads()).map(centroid));
    next
}

fn rings() -> Vec<SharpRing> {
    let inf = f64::INFINITY;
    let mut rings: Vec<SharpRing> = (3..13).map(smooth).collect();
    for edges in 2..5 {
        rings.push(sharp(edges, true, 0.0, &[]));
        rings.push(sharp(edges, true, inf, &[]));
    }
    for edges in 3..9 {
        rings.push(sharp(edges, false, 0.0, &[(0, inf)]));
        rings.push(sharp(edges, false, 0.0, &[(1, inf), (edges - 1, inf)]));
        rings.push(sharp(edges, false, 0.0, &[(0, 1.7)]));
        rings.push(sharp(edges, false, 0.0, &[(0, 2.3), (2, 0.6)]));
        rings.push(sharp(edges, false, 1.4, &[(0, inf), (1, 0.5)]));
        rings.push(sharp(edges, false, 0.0, &[(0, inf), (1, 3.0), (2, inf)]));
    }
    rings.push(sharp(4, true, 0.7, &[(1, 2.2)]));
    rings
}

/// The difference of two functionals that are the same up to a factor.
fn off(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let factor = dot(a, b) / dot(b, b);
    let difference = a.iter().zip(b).map(|(a, b)| (a - factor * b).abs());
    difference.fold(0.0, f64::max) / dot(a, a).sqrt()
}

/// Against steps one by one, by the rules as they are written.
#[test]
fn positions_are_where_many_steps_lead() {
    for ring in rings() {
        let limits = RingLimits::of(&ring);
        for seed in 0..3 {
            let value = |i: usize| (1.7 * (i * i + 3 * seed) as f64).sin();
            let mut points: Vec<f64> = (0..Points::of(&ring).count()).map(value).collect();
            let found: f64 = limits
                .position
                .iter()
                .zip(&points)
                .map(|(w, p)| w * p)
                .sum();
            let mut now = ring.clone();
            for _ in 0..120 {
                points = refined(&points, &now);
                now = now.refined();
            }
            assert!(
                (found - points[0]).abs() < 1e-13,
                "{ring:?}: {found} {}",
                points[0]
            );
        }
    }
}

/// A step multiplies tangents by a number.
#[test]
fn tangents_are_eigenvectors() {
    for ring in rings().iter().filter(|ring| ring.semi_sharpness() == 0.0) {
        for side in &RingLimits::of(ring).sides {
            let Some(tangents) = &side.tangents else {
                panic!("{ring:?}");
            };
            for tangent in tangents {
                assert!(tangent.iter().sum::<f64>().abs() < 1e-12, "{ring:?}");
                let error = off(&pulled_back(tangent, ring), tangent);
                assert!(error < 1e-12, "{ring:?}: {error}");
            }
        }
    }
}

/// Fractions of the design, from exact arithmetic.
#[test]
fn darts_have_their_fractions() {
    let expected: [(&[f64], &[f64]); 3] = [
        (
            &[81.0 / 200.0, 0.2, 0.15, 0.15],
            &[11.0 / 400.0, 0.04, 11.0 / 400.0],
        ),
        (
            &[
                94.0 / 201.0,
                35.0 / 268.0,
                20.0 / 201.0,
                15.0 / 134.0,
                20.0 / 201.0,
            ],
            &[29.0 / 1608.0, 11.0 / 402.0, 11.0 / 402.0, 29.0 / 1608.0],
        ),
        (
            &[
                615.0 / 1186.0,
                55.0 / 593.0,
                42.0 / 593.0,
                48.0 / 593.0,
                48.0 / 593.0,
                42.0 / 593.0,
            ],
            &[
                38.0 / 2965.0,
                58.0 / 2965.0,
                121.0 / 5930.0,
                58.0 / 2965.0,
                38.0 / 2965.0,
            ],
        ),
    ];
    for (edges, (near, far)) in (3..).zip(expected) {
        let ring = sharp(edges, false, 0.0, &[(0, f64::INFINITY)]);
        let position = RingLimits::of(&ring).position;
        for (found, expected) in position.iter().zip(near.iter().chain(far)) {
            assert!((found - expected).abs() < 1e-14, "{edges}: {position:?}");
        }
    }
}

/// On a flat ring, counter-clockwise in the plane of x and y, tangents turn as z does, except at corners that are not convex.
#[test]
fn normals_point_outwards() {
    for ring in rings() {
        let points = Points::of(&ring);
        let n = points.edges;
        let turn = if ring.open {
            PI / (n - 1) as f64
        } else {
            TAU / n as f64
        };
        let place = |point: usize| match point {
            0 => [0.0, 0.0],
            _ if point <= n => {
                let angle = turn * (point - 1) as f64;
                [angle.cos(), angle.sin()]
            }
            _ => {
                let angle = turn * ((point - 1 - n) as f64 + 0.5);
                [1.4 * angle.cos(), 1.4 * angle.sin()]
            }
        };
        let widest = |side: &RingSide| turn * side.quads as f64;
        for side in RingLimits::of(&ring).sides {
            // At corners the angle between both edges decides.
            let is_wide = ring.rule() == VertexRule::Corner && widest(&side) > 0.99 * PI;
            let Some([first, second]) = &side.tangents else {
                continue;
            };
            let sum = |weights: &[f64], axis: usize| {
                (0..points.count())
                    .map(|i| weights[i] * place(i)[axis])
                    .sum::<f64>()
            };
            let cross = sum(first, 0) * sum(second, 1) - sum(first, 1) * sum(second, 0);
            assert!(cross > 0.0 || is_wide, "{ring:?}: {cross}");
        }
    }
}
