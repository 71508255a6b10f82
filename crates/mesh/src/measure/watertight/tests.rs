//! Surfaces whose counts are known by hand.

use super::*;

fn examine(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Watertightness {
    watertightness(Triangles {
        positions,
        triangles,
    })
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

const CORNERS: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];
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
    let positions = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
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

/// A square whose left half is one triangle pair and whose right half is cut in two along the
/// shared side, so that vertex 6 is in the middle of the left half's edge.
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

    // At other scales and positions, too: the tolerance is relative to the edge.
    for (scale, offset) in [(1e-200, 0.0), (1e-6, 3.0), (1e6, -1e7), (1e150, 0.0)] {
        let moved: Vec<_> = positions
            .iter()
            .map(|p| p.map(|x| x * scale + offset))
            .collect();
        assert_eq!(
            examine(&moved, &triangles).t_junctions,
            1,
            "{scale} {offset}"
        );
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
        assert_eq!(
            examine(&positions, &triangles).t_junctions,
            expected,
            "{middle:?}"
        );
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
            [
                [0.0, 0.0, 1.0],
                [0.0, 0.0, 2.0],
                [3.0 * on_circle(i)[0], 3.0 * on_circle(i)[1], 1.5],
            ],
        ] {
            let first = positions.len() as u32;
            positions.extend(corners);
            triangles.push([first, first + 1, first + 2]);
        }
    }
    let start = std::time::Instant::now();
    let w = examine(&positions, &triangles);
    assert_eq!(
        counts(&w),
        (
            6 * count as usize,
            0,
            0,
            0,
            2 * count as usize,
            2 * i64::from(count)
        )
    );
    assert!(start.elapsed().as_secs() < 20);
}

#[test]
fn a_torus_grid_with_and_without_a_hole() {
    let n = 60u32;
    let vertex = |i: u32, j: u32| (i % n) * n + j % n;
    let positions: Vec<_> = (0..n * n)
        .map(|v| {
            let [a, b] =
                [v / n, v % n].map(|k| f64::from(k) / f64::from(n) * core::f64::consts::TAU);
            [
                (2.0 + b.cos()) * a.cos(),
                (2.0 + b.cos()) * a.sin(),
                b.sin(),
            ]
        })
        .collect();
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let (a, b, c, d) = (
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            );
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    assert_eq!(counts(&examine(&positions, &triangles)), (0, 0, 0, 0, 1, 0));
    triangles.remove(100);
    assert_eq!(
        counts(&examine(&positions, &triangles)),
        (3, 0, 0, 0, 1, -1)
    );
}

#[test]
fn bad_indices_and_collapsed_faces_are_no_trouble() {
    let w = examine(&[[f64::NAN; 3], [0.0; 3]], &[[0, 1, u32::MAX], [1, 1, 0]]);
    assert_eq!(counts(&w), (3, 0, 0, 0, 1, 1));
    assert_eq!(w.degenerate_faces, 1);
    assert_eq!(counts(&examine(&[], &[])), (0, 0, 0, 0, 0, 0));
}

/// Numbers from 0 to 1 that look like any.
fn scattered(i: usize) -> [f64; 3] {
    [0.618_033_988_7, 0.754_877_666_2, 0.569_840_290_9].map(|step| (0.3 + step * i as f64).fract())
}

/// Vertices on many edges to two common vertices, and on overlapping edges of a line, found one by
/// one.
#[test]
fn t_junctions_are_those_that_looking_at_all_finds() {
    for count in [5usize, 40, 300] {
        let mut positions = vec![[0.0; 3], [0.0, 0.0, 1.0]];
        positions.extend((0..count).map(scattered));
        let mut triangles: Vec<[u32; 3]> = (0..count as u32).map(|i| [0, 1, i + 2]).collect();
        // Some in the middle of an edge, some next to one.
        for i in (0..count).step_by(3) {
            let shift = if i % 2 == 0 { 0.0 } else { 1e-3 };
            let on_edge = scattered(i).map(|x| 0.4 * x);
            let first = positions.len() as u32;
            positions.extend([
                [on_edge[0] + shift, on_edge[1], on_edge[2]],
                [2.0 + i as f64, 0.0, 0.0],
                [3.0, 1.0, 0.0],
            ]);
            triangles.push([first, first + 1, first + 2]);
        }
        let surface = Triangles {
            positions: &positions,
            triangles: &triangles,
        };
        let sides: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        let is_boundary = |&&[a, b]: &&[u32; 2]| {
            sides
                .iter()
                .filter(|&&[c, d]| [c, d] == [a, b] || [d, c] == [a, b])
                .count()
                == 1
        };
        let boundary: Vec<[[f64; 3]; 2]> = sides
            .iter()
            .filter(is_boundary)
            .map(|side| side.map(|v| positions[v as usize]))
            .collect();
        let lies_inside = |p: &&[f64; 3]| {
            boundary.iter().any(|&[a, b]| {
                let (along, from) = (
                    [0, 1, 2].map(|i| b[i] - a[i]),
                    [0, 1, 2].map(|i| p[i] - a[i]),
                );
                let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                let t = dot(from, along) / dot(along, along);
                let apart = [0, 1, 2].map(|i| from[i] - t * along[i]);
                t > 1e-5 && t < 1.0 - 1e-5 && dot(apart, apart) < 1e-10 * dot(along, along)
            })
        };
        let expected = positions.iter().filter(lies_inside).count();
        assert!(expected > 0);
        assert_eq!(watertightness(surface).t_junctions, expected, "{count}");
    }
}

/// Sixty thousand triangles on one edge, whose apexes are everywhere or on a circle, and as many on a line whose edges hold one
/// another: each ends in well under a second.
#[test]
fn very_many_edges_side_by_side_take_little_time() {
    const COUNT: usize = 60_000;
    // Directions a hundredth apart, every other one twice as far: no edge comes near to a vertex of another.
    let around = |i: usize| {
        // None leads along the edge that all share.
        let (turn, z) = (
            2.399_963_229_728_653 * i as f64,
            0.9 - 0.9 * (2 * i + 1) as f64 / COUNT as f64,
        );
        let (far, (s, c)) = ((1 + i % 2) as f64, turn.sin_cos());
        [c * (1.0 - z * z).sqrt(), s * (1.0 - z * z).sqrt(), z].map(|x| far * x)
    };
    let mut positions = vec![[0.0; 3], [0.0, 0.0, 1e-3]];
    positions.extend((0..COUNT).map(around));
    let triangles: Vec<[u32; 3]> = (0..COUNT as u32).map(|i| [0, 1, i + 2]).collect();
    let w = examine(&positions, &triangles);
    assert_eq!(
        (w.non_manifold_edges, w.boundary_edges, w.t_junctions),
        (1, 2 * COUNT, 0)
    );
    // Apexes on a circle around the line, farther apart than any edge reaches.
    let apex = |i: usize| {
        let (s, c) = (core::f64::consts::TAU * i as f64 / COUNT as f64).sin_cos();
        [0.0, 1e4 * c, 1e4 * s]
    };
    let mut positions = vec![[0.0; 3]];
    positions.extend((0..COUNT).flat_map(|i| [[1.0 + i as f64, 0.0, 0.0], apex(i)]));
    let triangles: Vec<[u32; 3]> = (0..COUNT as u32)
        .map(|i| [0, 2 * i + 1, 2 * i + 2])
        .collect();
    // All on the line but its ends.
    assert_eq!(examine(&positions, &triangles).t_junctions, COUNT - 1);
    // Apexes on a circle, all edges to which lead through its middle's surroundings.
    let positions: Vec<[f64; 3]> = [[0.0; 3], [1.0, 0.0, 0.0]]
        .into_iter()
        .chain((0..COUNT).map(|i| {
            let [_, y, z] = apex(i);
            [0.5, 1e-4 * y, 1e-4 * z]
        }))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..COUNT as u32).map(|i| [0, 1, i + 2]).collect();
    assert_eq!(examine(&positions, &triangles).t_junctions, 0);
}
