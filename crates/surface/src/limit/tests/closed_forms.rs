//! Loop's limits in closed form: the paper's normal weights, limit positions, and the boundary tangents that
//! belong to the rules 3/4, 1/8, 1/8.

use core::f64::consts::{PI, TAU};
use std::time::Instant;

use super::{assert_close, stencil};
use crate::limit::TangentPlane;
use crate::ring::RingShape;
use crate::scheme::{Loop, LoopWarren, Scheme};

/// Equation (10) with the left eigenvector: the weight of d_i × d_j is sin(2π(j−i)/k).
#[test]
fn pair_weights_of_loop_are_sines() {
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        for k in 3..=100 {
            let stencil = stencil(scheme, RingShape::interior(k));
            let weights = stencil.normal_weights().unwrap();
            let pairs = (1..=k).flat_map(|i| (i + 1..=k).map(move |j| (i, j)));
            assert_eq!(weights.len() as u32, k * (k - 1) / 2);
            for (weight, (i, j)) in weights.into_iter().zip(pairs) {
                let expected = (TAU * f64::from(j - i) / f64::from(k)).sin();
                assert_close(
                    weight,
                    expected,
                    1e-12,
                    &format!("{} k={k} ({i},{j})", scheme.name()),
                );
            }
            let eigenvalue = 0.375 + 0.25 * (TAU / f64::from(k)).cos();
            for met in stencil.tangent_eigenvalues() {
                assert_close(met, eigenvalue, 1e-14, "eigenvalue");
            }
            assert_eq!(stencil.tangent_plane(), TangentPlane::Surface);
        }
    }
}

/// A neighbour's weight is 1/(k + 3/(8β)).
#[test]
fn limit_positions_of_loop() {
    for k in (2..=100).chain([360, 1000]) {
        let shape = RingShape::interior(k);
        let beta = Loop.vertex_mask(shape).ring[0];
        let stencil = stencil(&Loop, shape);
        let expected = 1.0 / (f64::from(k) + 0.375 / beta);
        let weights = stencil.position_weights();
        assert_close(weights[0], 1.0 - f64::from(k) * expected, 1e-13, "vertex");
        weights[1..]
            .iter()
            .for_each(|&weight| assert_close(weight, expected, 1e-14, &format!("k={k}")));
    }
}

#[test]
fn boundary_positions_of_loop() {
    for k in 2..=20 {
        let stencil = stencil(&Loop, RingShape::boundary(k));
        for (i, &weight) in stencil.position_weights().iter().enumerate() {
            let expected = match i as u32 {
                0 => 2.0 / 3.0,
                1 => 1.0 / 6.0,
                i if i == k => 1.0 / 6.0,
                _ => 0.0,
            };
            assert_close(weight, expected, 1e-14, &format!("k={k} point {i}"));
        }
    }
}

/// The tangent across the boundary: sin(iθ) inside, x = (sin θ − σ)/(1 + 2cos θ) at both ends, and at the vertex
/// minus the sum of all weights, y = −2x − σ.
#[test]
fn boundary_tangents_of_loop() {
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        for k in 3..=12u32 {
            let stencil = stencil(scheme, RingShape::boundary(k));
            let theta = PI / f64::from(k - 1);
            let sigma = 1.0 / (theta / 2.0).tan();
            // At θ = 2π/3 numerator and denominator would vanish; k = 2 has no interior neighbour anyway.
            let end = (theta.sin() - sigma) / (1.0 + 2.0 * theta.cos());
            let tangents = stencil.tangent_weights().unwrap();
            let mut sum = 0.0;
            for (i, &[along, across]) in tangents.iter().enumerate() {
                let last = k as usize - 1;
                let (along_expected, expected) = match i {
                    0 => (1.0, end),
                    i if i == last => (-1.0, end),
                    i => (0.0, (i as f64 * theta).sin()),
                };
                assert_close(along, along_expected, 1e-12, &format!("k={k} along {i}"));
                assert_close(across, expected, 1e-12, &format!("k={k} across {i}"));
                sum += across;
            }
            assert_close(-sum, -2.0 * end - sigma, 1e-12, "vertex");
            let [half, across] = stencil.tangent_eigenvalues();
            assert_close(half, 0.5, 1e-14, "eigenvalue along");
            assert_close(
                across,
                0.375 + 0.25 * theta.cos(),
                1e-14,
                "eigenvalue across",
            );
            let plane = if k < 7 {
                TangentPlane::Surface
            } else {
                TangentPlane::BoundaryRibbon
            };
            assert_eq!(stencil.tangent_plane(), plane, "k={k}");
        }
        // v_1 − v_2 and v_1 + v_2 − 2v.
        let stencil = stencil(scheme, RingShape::boundary(2));
        for (met, expected) in stencil
            .tangent_weights()
            .unwrap()
            .iter()
            .zip([[1.0, 1.0], [-1.0, 1.0]])
        {
            (0..2).for_each(|axis| assert_close(met[axis], expected[axis], 1e-14, "k=2"));
        }
    }
}

/// Open corners of two to four edges have the plane of their boundary edges; with more the interior neighbours
/// shrink more slowly, and there is no plane. A closed corner is the tip of a cone.
#[test]
fn corners_of_loop() {
    let corner = |valence, open| RingShape {
        valence,
        open,
        corner: true,
        dart: false,
    };
    for k in 2..=12 {
        let open = stencil(&Loop, corner(k, true));
        assert_eq!(open.position_weights()[0], 1.0);
        assert_eq!(
            open.tangent_plane() == TangentPlane::Surface,
            k <= 4,
            "k={k}"
        );
        if let Some(weights) = open.normal_weights() {
            // Of the first neighbour and the last alone.
            for (place, &met) in (1..).zip(&weights) {
                let expected = if place == k - 1 { 1.0 } else { 0.0 };
                assert_close(met, expected, 1e-14, "corner");
            }
        }
    }
    for k in 3..=12 {
        let closed = stencil(&Loop, corner(k, false));
        assert_eq!(closed.position_weights()[0], 1.0);
        assert_eq!(closed.tangent_plane(), TangentPlane::None, "k={k}");
    }
}

/// Two faces on one interior vertex fold onto each other: no outside, no plane.
#[test]
fn interior_valence_two_has_no_plane() {
    assert_eq!(
        stencil(&Loop, RingShape::interior(2)).tangent_plane(),
        TangentPlane::None
    );
}

#[test]
fn high_valences_are_quick() {
    let start = Instant::now();
    for k in [64, 360, 1000, 20_000] {
        let stencil = stencil(&Loop, RingShape::interior(k));
        for (j, &[u, w]) in stencil.tangent_weights().unwrap().iter().enumerate() {
            let (sine, cosine) = (TAU * j as f64 / f64::from(k)).sin_cos();
            assert_close(u, cosine, 1e-12, "u");
            assert_close(w, sine, 1e-12, "w");
        }
    }
    assert!(
        stencil(&Loop, RingShape::boundary(360))
            .tangent_weights()
            .is_some()
    );
    // 20 times the time without optimisation: it guards against a cubic cost in the valence.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}
