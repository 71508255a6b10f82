//! Surfaces whose counts are known by hand.

use super::*;

fn examine(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Watertightness {
    watertightness(Triangles { positions, triangles })
}

/// Counts in the order boundary, non-manifold, inconsistent, T-junctions, components, Euler characteristic.
fn counts(w: &Watertightness) -> (usize, usize, usize, usize, usize, i64) {
    (
        w.boundary_edges,
        w.non_manifold_edges,
        w.inconsistent_edges,
        w.t_junctions,
        w.components,
        w.euler_characteristic,
    )
}

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

#[test]
fn tetrahedron_is_watertight() {
    let w = examine(&CORNERS, &TETRAHEDRON);
    assert_eq!(counts(&w), (0, 0, 0, 0, 1, 2));
    assert!(w.is_watertight());
}

#[test]
fn one_face_turned_over() {
    let mut triangles = TETRAHEDRON;
    triangles[2].swap(0, 1);
    let w = examine(&CORNERS, &triangles);
    assert_eq!(counts(&w), (0, 0, 3, 0, 1, 2));
    assert!(!w.is_watertight());
}

#[test]
fn an_open_sheet() {
    let w = examine(&CORNERS, &[[0, 1, 2], [1, 3, 2]]);
    assert_eq!(counts(&w), (4, 0, 0, 0, 1, 1));
}

#[test]
fn three_triangles_on_an_edge() {
    let positions = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
    let w = examine(&positions, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
    assert_eq!(counts(&w), (6, 1, 0, 0, 1, 5 - 7 + 3));
}

#[test]
fn two_parts_and_an_unused_vertex() {
    let mut positions = CORNERS.to_vec();
    positions.push([9.0; 3]);
    positions.extend(CORNERS.map(|p| p.map(|x| x + 5.0)));
    let mut triangles = TETRAHEDRON.to_vec();
    triangles.extend(TETRAHEDRON.map(|t| t.map(|v| v + 5)));
    assert_eq!(counts(&examine(&positions, &triangles)), (0, 0, 0, 0, 2, 4));
}

/// A square whose left half is one triangle pair and whose right half is cut in two along the shared side, so that
/// vertex 6 stands in the middle of the left half's edge.
fn cut_square(middle: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        middle,
    ];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [1, 4, 6], [4, 5, 6], [6, 5, 2]];
    (positions, triangles)
}

#[test]
fn a_square_cut_on_one_side_only() {
    let (positions, triangles) = cut_square([1.0, 0.5, 0.0]);
    let w = examine(&positions, &triangles);
    assert_eq!(w.t_junctions, 1);
    assert_eq!(w.boundary_edges, 1 + 2 + 6);

    // The same at other scales and places: the tolerance goes with the edge.
    for (scale, offset) in [(1e-200, 0.0), (1e-6, 3.0), (1e6, -1e7), (1e150, 0.0)] {
        let moved: Vec<_> = positions.iter().map(|p| p.map(|x| x * scale + offset)).collect();
        assert_eq!(examine(&moved, &triangles).t_junctions, 1, "{scale} {offset}");
    }
}

#[test]
fn a_vertex_beside_the_edge_is_no_t_junction() {
    for (middle, expected) in [
        ([1.000_001, 0.5, 0.0], 1),
        ([1.001, 0.5, 0.0], 0),
        ([1.0, 0.5, 1e-3], 0),
        // Nearer to the end than the tolerance.
        ([1.0, 1e-7, 0.0], 0),
    ] {
        let (positions, triangles) = cut_square(middle);
        assert_eq!(examine(&positions, &triangles).t_junctions, expected, "{middle:?}");
    }
}

#[test]
fn unwelded_neighbours_are_no_t_junction() {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, -0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let w = examine(&positions, &[[0, 1, 2], [3, 4, 5]]);
    assert_eq!(counts(&w), (6, 0, 0, 0, 2, 2));
}

#[test]
fn many_triangles_in_one_point_and_on_one_edge_stay_fast() {
    // 30,000 triangles without common indices, all with one corner in the origin and the opposite one on the circle,
    // and as many with one and the same side: comparing each with each would take minutes.
    let count = 30_000u32;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..count {
        let on_circle = |k: u32| {
            let angle = f64::from(k % count) / f64::from(count) * core::f64::consts::TAU;
            [angle.cos(), angle.sin(), 0.0]
        };
        for corners in [
            [[0.0; 3], on_circle(i), on_circle(i + 1)],
            [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [3.0 * on_circle(i)[0], 3.0 * on_circle(i)[1], 1.5]],
        ] {
            let first = positions.len() as u32;
            positions.extend(corners);
            triangles.push([first, first + 1, first + 2]);
        }
    }
    let start = std::time::Instant::now();
    let w = examine(&positions, &triangles);
    assert_eq!(counts(&w), (6 * count as usize, 0, 0, 0, 2 * count as usize, 2 * i64::from(count)));
    assert!(start.elapsed().as_secs() < 20);
}

#[test]
fn a_torus_grid_with_and_without_a_hole() {
    let n = 60u32;
    let vertex = |i: u32, j: u32| (i % n) * n + j % n;
    let positions: Vec<_> = (0..n * n)
        .map(|v| {
            let [a, b] = [v / n, v % n].map(|k| f64::from(k) / f64::from(n) * core::f64::consts::TAU);
            [(2.0 + b.cos()) * a.cos(), (2.0 + b.cos()) * a.sin(), b.sin()]
        })
        .collect();
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let (a, b, c, d) = (vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    assert_eq!(counts(&examine(&positions, &triangles)), (0, 0, 0, 0, 1, 0));
    triangles.remove(100);
    assert_eq!(counts(&examine(&positions, &triangles)), (3, 0, 0, 0, 1, -1));
}

#[test]
fn bad_indices_and_collapsed_faces_are_no_trouble() {
    let w = examine(&[[f64::NAN; 3], [0.0; 3]], &[[0, 1, u32::MAX], [1, 1, 0]]);
    assert_eq!(counts(&w), (3, 0, 0, 0, 1, 1));
    assert_eq!(w.degenerate_faces, 1);
    assert_eq!(counts(&examine(&[], &[])), (0, 0, 0, 0, 0, 0));
}
