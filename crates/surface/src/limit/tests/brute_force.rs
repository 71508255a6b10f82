//! Limit positions and normals against iteration of the ring matrix: no eigenvector is computed here.
//!
//! Positions are points refined until they stand still. Normals are the paper's equation (9): the bivectors
//! `N_ij = d_i × d_j` of random differences are refined by `N ← D N Dᵀ`, which loses no digits where the two
//! tangents shrink at different rates, and rescaled; the normals of the faces are those of neighbours i, j.

use super::{distance, stencil, unit};
use crate::limit::{LimitStencil, TangentPlane, difference_matrix, ring_matrix};
use crate::ring::RingShape;
use crate::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh_testing::Random;

const SCHEMES: [&dyn Scheme; 3] = [&Loop, &LoopWarren, &ModifiedButterfly];
const TOLERANCE: f64 = 1e-10;

type Matrix = Vec<Vec<f64>>;

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |row: &[f64], j: usize| {
        row.iter()
            .zip(b)
            .filter(|(w, _)| **w != 0.0)
            .map(|(w, r)| w * r[j])
            .sum()
    };
    a.iter()
        .map(|row| (0..b[0].len()).map(|j| column(row, j)).collect())
        .collect()
}

fn transposed(a: &Matrix) -> Matrix {
    (0..a[0].len())
        .map(|j| a.iter().map(|row| row[j]).collect())
        .collect()
}

fn every_shape() -> Vec<RingShape> {
    let interior = (3..=12).map(RingShape::interior);
    let boundary = (2..=10).map(RingShape::boundary);
    let corners = [false, true].into_iter().flat_map(|open| {
        (2..=6).map(move |valence| RingShape {
            valence,
            open,
            corner: true,
            dart: false,
        })
    });
    interior.chain(boundary).chain(corners).collect()
}

/// Random points around the vertex on a bumpy fan: any differences will do, but those of a fan are of one size.
fn random_points(count: usize, seed: u64) -> Matrix {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| random.vector().to_array().to_vec())
        .collect()
}

#[test]
fn positions() {
    for scheme in SCHEMES {
        for shape in every_shape()
            .into_iter()
            .chain([RingShape::interior(64), RingShape::interior(2)])
        {
            let ring = ring_matrix(scheme, shape).unwrap();
            let start = random_points(ring.len(), u64::from(shape.valence));
            let weights = vec![stencil(scheme, shape).position_weights().to_vec()];
            let expected = product(&weights, &start);
            let mut points = start;
            for _ in 0..160 {
                points = product(&ring, &points);
            }
            for (axis, expected) in expected[0].iter().enumerate() {
                let met = points[0][axis];
                assert!(
                    (met - expected).abs() < TOLERANCE,
                    "{} {shape:?}: {met}, {expected}",
                    scheme.name()
                );
            }
        }
    }
}

/// The limit normal by the stencil's weights on differences.
fn predicted(stencil: &LimitStencil, differences: &Matrix) -> [f64; 3] {
    let mut tangents = [[0.0; 3]; 2];
    for (weights, difference) in stencil.tangent_weights().unwrap().iter().zip(differences) {
        for axis in 0..3 {
            tangents[0][axis] += weights[0] * difference[axis];
            tangents[1][axis] += weights[1] * difference[axis];
        }
    }
    unit(super::cross(tangents[0], tangents[1]))
}

/// One antisymmetric matrix for each coordinate of d_i × d_j.
fn bivectors(differences: &Matrix) -> [Matrix; 3] {
    [0, 1, 2].map(|axis| {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let entry = |p: &[f64], q: &[f64]| p[a] * q[b] - p[b] * q[a];
        differences
            .iter()
            .map(|p| differences.iter().map(|q| entry(p, q)).collect())
            .collect()
    })
}

/// D N Dᵀ. Its symmetric part is rounding, and would grow by the square of the greatest eigenvalue, faster than N.
fn refined(matrix: &Matrix, normal: &Matrix, transpose: &Matrix) -> Matrix {
    let next = product(&product(matrix, normal), transpose);
    let n = next.len();
    (0..n)
        .map(|i| (0..n).map(|j| (next[i][j] - next[j][i]) / 2.0).collect())
        .collect()
}

/// Normals of the faces at the vertex after many refinements, first to last.
fn iterated_normals(
    scheme: &dyn Scheme,
    shape: RingShape,
    differences: &Matrix,
    steps: usize,
) -> Vec<[f64; 3]> {
    let matrix = difference_matrix(&ring_matrix(scheme, shape).unwrap());
    let transpose = transposed(&matrix);
    let mut normals = bivectors(differences);
    for _ in 0..steps {
        normals = normals.map(|normal| refined(&matrix, &normal, &transpose));
        let size = normals
            .iter()
            .flatten()
            .flatten()
            .fold(0.0, |size: f64, x| size.max(x.abs()));
        normals
            .iter_mut()
            .flatten()
            .flatten()
            .for_each(|x| *x /= size);
    }
    let k = shape.valence as usize;
    let face = |j: usize| unit([0, 1, 2].map(|axis: usize| normals[axis][j][(j + 1) % k]));
    (0..shape.faces() as usize).map(face).collect()
}

/// Steps after which the other patterns have shrunk to nothing relative to the tangents: the rings
/// here shrink them by 0.95 a step at least (on a ribbon, where those that shrink more slowly than
/// one tangent do not enter the faces at its edges).
const STEPS: usize = 500;

#[test]
fn normals() {
    let mut checked = [0; 3];
    for (which, scheme) in SCHEMES.into_iter().enumerate() {
        for shape in every_shape() {
            let stencil = stencil(scheme, shape);
            let differences = random_points(
                stencil.position_weights().len() - 1,
                7 + u64::from(shape.valence),
            );
            let met = match stencil.tangent_plane() {
                TangentPlane::None => continue,
                // Converges like 1/steps; see `jordan_block_at_a_tip`.
                TangentPlane::Surface
                    if stencil.next_eigenvalue() == stencil.tangent_eigenvalues()[1] =>
                {
                    continue;
                }
                TangentPlane::Surface => iterated_normals(scheme, shape, &differences, STEPS),
                TangentPlane::BoundaryRibbon => {
                    let all = iterated_normals(scheme, shape, &differences, STEPS);
                    vec![all[0], all[all.len() - 1]]
                }
            };
            let expected = predicted(&stencil, &differences);
            for normal in met {
                let error = distance(normal, expected);
                assert!(
                    error < TOLERANCE,
                    "{} {shape:?}: off by {error:e}",
                    scheme.name()
                );
            }
            checked[which] += 1;
        }
    }
    // Interior 3 … 12, boundary 2 … 10, and the corners that have a plane.
    assert_eq!(checked, [10 + 9 + 2, 10 + 9 + 2, 10 + 8 + 5 + 4]);
}

/// Interior valence 64: 400 faces' normals, by the differences themselves (both tangents shrink alike).
#[test]
fn normals_at_valence_64() {
    for scheme in SCHEMES {
        let shape = RingShape::interior(64);
        let stencil = stencil(scheme, shape);
        let start = random_points(stencil.position_weights().len() - 1, 64);
        let matrix = difference_matrix(&ring_matrix(scheme, shape).unwrap());
        let mut differences = start.clone();
        for _ in 0..if scheme.name() == "butterfly" {
            80
        } else {
            5500
        } {
            differences = product(&matrix, &differences);
            let size = differences
                .iter()
                .flatten()
                .fold(0.0, |size: f64, x| size.max(x.abs()));
            differences.iter_mut().flatten().for_each(|x| *x /= size);
        }
        let expected = predicted(&stencil, &start);
        for j in 0..64 {
            let side = |j: usize| [0, 1, 2].map(|axis| differences[j % 64][axis]);
            let error = distance(unit(super::cross(side(j), side(j + 1))), expected);
            assert!(error < TOLERANCE, "{}: off by {error:e}", scheme.name());
        }
    }
}

/// The butterfly's boundary vertex with a single face: its second pattern belongs to a Jordan block
/// of the four-point rule for 1/4 and grows like n/4^n, so that d_0 × d_1 · 8^n is linear in n; the
/// difference of two steps is its limit.
#[test]
fn jordan_block_at_a_tip() {
    let shape = RingShape::boundary(2);
    let stencil = stencil(&ModifiedButterfly, shape);
    let start = random_points(stencil.position_weights().len() - 1, 2);
    let matrix = difference_matrix(&ring_matrix(&ModifiedButterfly, shape).unwrap());
    let transpose = transposed(&matrix);
    let mut normals = bivectors(&start);
    let mut last = [[0.0; 3]; 2];
    for _ in 0..60 {
        normals = normals.map(|normal| refined(&matrix, &normal, &transpose));
        normals
            .iter_mut()
            .flatten()
            .flatten()
            .for_each(|x| *x *= 8.0);
        last = [last[1], [0, 1, 2].map(|axis: usize| normals[axis][0][1])];
    }
    let growth = unit([0, 1, 2].map(|axis| last[1][axis] - last[0][axis]));
    let error = distance(growth, predicted(&stencil, &start));
    assert!(error < TOLERANCE, "off by {error:e}");
}

/// A corner of three faces: the boundary edges draw the neighbours inside into their plane, all three faces' normals
/// tend to its normal like 1/steps.
#[test]
fn boundary_edges_draw_along_the_inside_of_a_corner() {
    let shape = RingShape {
        corner: true,
        ..RingShape::boundary(4)
    };
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        let stencil = stencil(scheme, shape);
        let start = random_points(stencil.position_weights().len() - 1, 3);
        let expected = predicted(&stencil, &start);
        let off = |steps: usize| {
            let met = iterated_normals(scheme, shape, &start, steps);
            met.into_iter()
                .map(|normal| distance(normal, expected))
                .fold(0.0, f64::max)
        };
        let (early, late) = (off(2000), off(8000));
        assert!(
            early < 0.01 && (late / early - 0.25).abs() < 0.01,
            "{}: {early} {late}",
            scheme.name()
        );
    }
}

/// Patterns that do not single out a plane: Warren's weight without its exception makes all three eigenvalues of
/// a ring of three 1/4, and every step keeps the shape of the ring.
#[test]
fn no_plane_where_all_patterns_shrink_alike() {
    struct WithoutException;
    impl Scheme for WithoutException {
        fn name(&self) -> &str {
            "Warren's without exception"
        }
        fn support(&self) -> crate::scheme::Support {
            Loop.support()
        }
        fn vertex_mask(&self, shape: RingShape) -> crate::scheme::VertexMask {
            let mut mask = LoopWarren.vertex_mask(shape);
            if shape == RingShape::interior(3) {
                (mask.centre, mask.ring) = (0.625, vec![0.125; 3]);
            }
            mask
        }
        fn edge_mask(&self, shape: crate::ring::EdgeShape) -> crate::scheme::EdgeMask {
            Loop.edge_mask(shape)
        }
    }
    let three = stencil(&WithoutException, RingShape::interior(3));
    assert_eq!(three.tangent_plane(), TangentPlane::None);
    assert!(three.normal_weights().is_none());
    assert_eq!(
        stencil(&WithoutException, RingShape::interior(4)).tangent_plane(),
        TangentPlane::Surface
    );
}
