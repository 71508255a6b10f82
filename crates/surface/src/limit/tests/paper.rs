//! The paper's construction to the letter (equations 5 to 10), as an oracle for the eigenvectors of D alone.
//!
//! Proved here: the weights of equation (10) are the LEFT dominant eigenvector of ΛD_k. The paper's
//! ΛD_k = V⁻¹AV makes the column of V⁻¹ that it tabulates the right one, which is the same for Loop's interior
//! rings (there ΛD_k is symmetric) and wrong elsewhere.

use core::f64::consts::TAU;

use super::{cross, distance, stencil, unit};
use crate::limit::{TangentPlane, difference_matrix, ring_matrix};
use crate::ring::RingShape;
use crate::scheme::{Loop, LoopWarren};
use limitmesh_testing::Random;

type Matrix = Vec<Vec<f64>>;

/// ΛD: 2×2 minors of D, rows and columns in the order (1,2), (1,3), …, (2,3), … .
fn second_compound(matrix: &Matrix) -> Matrix {
    let n = matrix.len();
    let pairs: Vec<(usize, usize)> = (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
        .collect();
    let minor = |(a, b): (usize, usize), (i, j): (usize, usize)| {
        matrix[a][i] * matrix[b][j] - matrix[a][j] * matrix[b][i]
    };
    pairs
        .iter()
        .map(|&rows| pairs.iter().map(|&columns| minor(rows, columns)).collect())
        .collect()
}

/// The dominant right eigenvector by plain iteration, of unit length.
fn dominant(matrix: &Matrix, steps: usize) -> Vec<f64> {
    let mut random = Random::new(5);
    let mut vector: Vec<f64> = matrix.iter().map(|_| random.signed()).collect();
    for _ in 0..steps {
        vector = matrix
            .iter()
            .map(|row| row.iter().zip(&vector).map(|(a, b)| a * b).sum())
            .collect();
        let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|x| *x /= length);
    }
    vector
}

fn transposed(a: &Matrix) -> Matrix {
    (0..a[0].len())
        .map(|j| a.iter().map(|row| row[j]).collect())
        .collect()
}

/// Scaled to unit length, and to a positive first pair (v_1, v_2).
fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let length = weights
        .iter()
        .map(|x| x * x)
        .sum::<f64>()
        .sqrt()
        .copysign(weights[0]);
    weights.iter_mut().for_each(|x| *x /= length);
    weights
}

fn greatest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |greatest, (a, b)| greatest.max((a - b).abs()))
}

fn compound_of(shape: RingShape) -> Matrix {
    second_compound(&difference_matrix(&ring_matrix(&Loop, shape).unwrap()))
}

#[test]
fn ring_matrix_is_equation_3() {
    for k in 3..=12usize {
        let shape = RingShape::interior(k as u32);
        let beta = (0.625 - (0.375 + 0.25 * (TAU / k as f64).cos()).powi(2)) / k as f64;
        let ring = ring_matrix(&Loop, shape).unwrap();
        for (i, row) in ring.iter().enumerate() {
            for (j, &met) in row.iter().enumerate() {
                let apart = (i + k - j) % k;
                let expected = match (i, j) {
                    (0, 0) => 1.0 - k as f64 * beta,
                    (0, _) => beta,
                    (_, 0) => 0.375,
                    _ if apart == 0 => 0.375,
                    _ if apart == 1 || apart == k - 1 => 0.125,
                    _ => 0.0,
                };
                assert!(
                    (met - expected).abs() < 1e-15,
                    "k={k} ({i},{j}): {met}, {expected}"
                );
            }
        }
    }
}

/// Interior rings: the stencil's weights, the closed form and the paper's eigenproblem agree.
#[test]
fn compound_has_the_weights_as_left_eigenvector() {
    for k in 3..=20 {
        let shape = RingShape::interior(k);
        let left = normalised(dominant(&transposed(&compound_of(shape)), 1500));
        let weights = normalised(stencil(&Loop, shape).normal_weights().unwrap());
        let error = greatest_difference(&left, &weights);
        assert!(error < 1e-12, "k={k}: {error:e}");
    }
}

/// Boundary rings up to six edges, where the compound's dominant eigenvalue is simple and the surface smooth.
#[test]
fn boundary_weights_are_the_left_eigenvector_too() {
    for k in 2..=6 {
        let shape = RingShape::boundary(k);
        let left = normalised(dominant(&transposed(&compound_of(shape)), 600));
        let weights = normalised(stencil(&Loop, shape).normal_weights().unwrap());
        let error = greatest_difference(&left, &weights);
        assert!(error < 1e-12, "k={k}: {error:e}");
    }
}

/// Equation (10) as printed tabulates the right eigenvector. On a boundary ring of four edges or more its normal
/// is off by many degrees; the normal that the faces tend to is the left one's.
#[test]
fn equation_10_as_printed_is_wrong_on_boundary_rings() {
    for k in 4..=6u32 {
        let shape = RingShape::boundary(k);
        let compound = compound_of(shape);
        let right = normalised(dominant(&compound, 600));
        let left = stencil(&Loop, shape).normal_weights().unwrap();
        let matrix = difference_matrix(&ring_matrix(&Loop, shape).unwrap());
        let mut random = Random::new(u64::from(k));
        let start: Vec<[f64; 3]> = (0..k).map(|_| random.vector().to_array()).collect();
        let pairs: Vec<[f64; 3]> = (0..start.len())
            .flat_map(|i| (i + 1..k as usize).map(move |j| (i, j)))
            .map(|(i, j)| cross(start[i], start[j]))
            .collect();
        let normal = |weights: &[f64]| {
            let sum = |axis: usize| {
                pairs
                    .iter()
                    .zip(weights)
                    .map(|(n, w)| w * n[axis])
                    .sum::<f64>()
            };
            unit([sum(0), sum(1), sum(2)])
        };
        // Twelve plain steps bring the first face's normal closer than any confusion of the two.
        let mut differences = start.clone();
        for _ in 0..40 {
            let row = |row: &Vec<f64>| {
                [0, 1, 2].map(|axis| row.iter().zip(&differences).map(|(w, d)| w * d[axis]).sum())
            };
            differences = matrix.iter().map(row).collect();
        }
        let truth = unit(cross(differences[0], differences[1]));
        let (right_error, left_error) = (
            distance(normal(&right), truth),
            distance(normal(&left), truth),
        );
        let right_error = right_error.min(2.0 - right_error);
        assert!(left_error < 1e-3, "k={k}: {left_error}");
        assert!(right_error > 0.05, "k={k}: {right_error}");
    }
}

/// Erratum: at seven edges the compound's dominant eigenvalue is double and equation (10) has no meaning; from
/// eight on its plane is not that of the boundary.
#[test]
fn seven_boundary_edges_have_a_double_eigenvalue() {
    let planes = (2..=10).map(|k| stencil(&Loop, RingShape::boundary(k)));
    for (k, stencil) in (2..=10).zip(planes) {
        let [along, across] = stencil.tangent_eigenvalues();
        assert!((along - 0.5).abs() < 1e-13);
        let next = stencil.next_eigenvalue();
        match k {
            2..=6 => {
                assert!(
                    next < along.min(across) - 1e-3
                        && stencil.tangent_plane() == TangentPlane::Surface
                )
            }
            7 => assert!((next - along).abs() < 1e-13),
            _ => assert!(
                next > along + 1e-3 && stencil.tangent_plane() == TangentPlane::BoundaryRibbon
            ),
        }
    }
}

/// Loop's and Warren's weights share all normals: β only moves the frequency 0.
#[test]
fn normals_do_not_depend_on_beta() {
    for k in 3..=30 {
        let [a, b] = [
            stencil(&Loop, RingShape::interior(k)),
            stencil(&LoopWarren, RingShape::interior(k)),
        ];
        let error = greatest_difference(&a.normal_weights().unwrap(), &b.normal_weights().unwrap());
        assert!(error < 1e-13, "k={k}: {error:e}");
    }
}
