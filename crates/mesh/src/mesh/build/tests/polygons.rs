//! Polygons into triangles: the area in space and the sides must be those of the polygon.

use proptest::prelude::*;

use super::*;

fn triangles_of(positions: &[[f64; 3]], faces: &[&[u32]]) -> Vec<[u32; 3]> {
    build_soup(&soup(positions, faces)).0.triangles().to_vec()
}

/// Rotated so that the lowest index comes first, and in ascending order.
fn normal_form(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    for t in &mut triangles {
        while t[0] > t[1] || t[0] > t[2] {
            t.rotate_left(1);
        }
    }
    triangles.sort_unstable();
    triangles
}

fn flat(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    // A plane that no axis is perpendicular to.
    points
        .iter()
        .map(|&[x, y]| [x + y, y - 2.0 * x, x + 3.0])
        .collect()
}

fn area(p: &[[f64; 2]], [a, b, c]: [u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|v| p[v as usize]);
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
}

/// The shoelace formula.
fn polygon_area(p: &[[f64; 2]]) -> f64 {
    let n = p.len();
    (0..n)
        .map(|i| p[i][0] * p[(i + 1) % n][1] - p[(i + 1) % n][0] * p[i][1])
        .sum::<f64>()
        / 2.0
}

/// Triangles of non-negative area that add up to the polygon, each side once and each diagonal twice.
fn assert_tiles(p: &[[f64; 2]], triangles: &[[u32; 3]]) {
    let n = p.len() as u32;
    assert_eq!(triangles.len(), p.len() - 2);
    let areas: Vec<f64> = triangles.iter().map(|&t| area(p, t)).collect();
    assert!(areas.iter().all(|&a| a >= -1e-12), "{areas:?}");
    assert!((areas.iter().sum::<f64>() - polygon_area(p)).abs() < 1e-9 * polygon_area(p));
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for t in triangles {
        for i in 0..3 {
            assert_eq!(
                *edges
                    .entry([t[i], t[(i + 1) % 3]])
                    .and_modify(|c| *c += 1)
                    .or_insert(1),
                1
            );
        }
    }
    for &[a, b] in edges.keys() {
        assert_eq!(
            edges.contains_key(&[b, a]),
            (a + 1) % n != b,
            "edge {a} {b}"
        );
    }
    assert!((0..n).all(|i| edges.contains_key(&[i, (i + 1) % n])));
}

#[test]
fn quads_take_the_diagonal_inside_or_the_shorter_one() {
    let cut = |points: &[[f64; 2]]| normal_form(triangles_of(&flat(points), &[&[0, 1, 2, 3]]));
    let along_02 = vec![[0, 1, 2], [0, 2, 3]];
    let along_13 = vec![[0, 1, 3], [1, 2, 3]];
    // Concave at corner 2, then at corner 1; the outside diagonal would be the shorter one.
    assert_eq!(
        cut(&[[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]]),
        along_02
    );
    assert_eq!(
        cut(&[[0.0, 4.0], [1.0, 1.0], [4.0, 0.0], [5.0, 5.0]]),
        along_13
    );
    // A corner on the side between its neighbours.
    assert_eq!(
        cut(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 3.0]]),
        along_13
    );
    let p = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [3.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
    ];
    assert_eq!(normal_form(triangles_of(&p, &[&[0, 1, 2, 3]])), along_13);
    let square = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    for start in 0..4 {
        let mut face = [0, 1, 2, 3];
        face.rotate_left(start);
        assert_eq!(
            normal_form(triangles_of(&square, &[&face])),
            along_02,
            "a tie goes to the lowest index"
        );
    }
}

#[test]
fn concave_polygons_are_tiled() {
    // An L, a comb with straight corners, an arrow with its tip at the origin.
    let shapes: [&[[f64; 2]]; 3] = [
        &[
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ],
        &[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [2.5, 1.0],
            [2.0, 1.0],
            [2.0, 3.0],
            [1.0, 3.0],
            [1.0, 1.0],
            [0.5, 1.0],
            [0.0, 1.0],
        ],
        &[[0.0, 0.0], [5.0, 5.0], [0.0, 1.0], [-5.0, 5.0], [-1.0, 1.0]],
    ];
    for points in shapes {
        let face: Vec<u32> = (0..points.len() as u32).collect();
        let (mesh, diagnosis) = build_soup(&soup(&flat(points), &[&face]));
        assert_eq!(found(&diagnosis), [("polygons", finding(&[0]))]);
        assert!(diagnosis.is_clean());
        assert_tiles(points, mesh.triangles());
    }
}

#[test]
fn a_straight_corner_stays_joined_to_the_neighbour() {
    // A square whose right side has a corner in its middle, and two triangles that use it.
    let p = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
        [3.0, 1.0, 0.0],
    ];
    let (mesh, diagnosis) = build_soup(&soup(&p, &[&[0, 1, 2, 3, 4], &[1, 5, 2], &[2, 5, 3]]));
    assert!(diagnosis.is_clean());
    assert_eq!(mesh.face_count(), 5);
    assert_eq!(mesh.topology().boundary_edge_count(), 5);
    assert_eq!(mesh.topology().euler_characteristic(), 1);
}

#[test]
fn repeated_corners_and_spikes_are_cleaned() {
    let p = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [5.0, 5.0, 5.0],
    ];
    for face in [
        &[0u32, 0, 1, 1, 2][..],
        &[0, 1, 2, 0],
        &[0, 1, 3, 1, 2],
        &[3, 0, 1, 2, 0],
        &[0, 1, 2, 0, 3],
        &[2, 3, 3, 2, 0, 1],
    ] {
        let (mesh, diagnosis) = build_soup(&soup(&p, &[face]));
        assert_eq!(
            normal_form(mesh.triangles().to_vec()),
            [[0, 1, 2]],
            "{face:?}"
        );
        assert!(diagnosis.collapsed_faces.is_empty());
    }
    for face in [
        &[0u32, 1][..],
        &[0, 1, 0, 1],
        &[0, 1, 2, 1],
        &[],
        &[0, 0, 0],
    ] {
        let (_, diagnosis) = build_soup(&soup(&p, &[&[0, 1, 2], face]));
        assert_eq!(diagnosis.collapsed_faces, finding(&[1]), "{face:?}");
    }
}

#[test]
fn twisted_polygons_are_bridged_and_told() {
    // A planar bow-tie quad, and a pentagram.
    let quad = [
        [0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.1],
    ];
    let star: Vec<[f64; 3]> = (0..5)
        .map(|i| f64::from(i) * 0.8 * core::f64::consts::PI)
        .map(|t| [t.cos(), t.sin(), 0.0])
        .collect();
    for positions in [&quad[..], &star] {
        let face: Vec<u32> = (0..positions.len() as u32).collect();
        let (mesh, diagnosis) = build_soup(&soup(positions, &[&face]));
        assert_eq!(mesh.face_count(), positions.len() - 2);
        assert_eq!(mesh.topology().euler_characteristic(), 1);
        assert_eq!(mesh.topology().boundary_edge_count(), positions.len());
        assert_eq!(diagnosis.twisted_polygons, finding(&[0]));
    }
}

#[test]
fn polygons_far_from_unit_size_are_tiled() {
    let points = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    for scale in [1e-140, 1e-20, 1e20, 1e150] {
        let p: Vec<[f64; 3]> = flat(&points).iter().map(|p| p.map(|x| x * scale)).collect();
        let (mesh, diagnosis) = build_soup(&soup(&p, &[&[0, 1, 2, 3, 4, 5]]));
        assert!(diagnosis.is_clean());
        assert_tiles(&points, mesh.triangles());
    }
}

/// Points of a small grid, sorted by angle about a point between them: a simple polygon with many straight and
/// level corners.
fn simple_polygons() -> impl Strategy<Value = Vec<[f64; 2]>> {
    prop::collection::vec((-6..=6i32, -6..=6i32), 5..60).prop_filter_map(
        "too few directions",
        |points| {
            let mut points: Vec<[f64; 2]> = points
                .iter()
                .map(|&(x, y)| [f64::from(x), f64::from(y)])
                .collect();
            let centre = [0.25, 0.25];
            let angle = |p: &[f64; 2]| (p[1] - centre[1]).atan2(p[0] - centre[0]);
            points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            points.dedup_by(|a, b| (angle(a) - angle(b)).abs() < 1e-9);
            // The centre must be inside.
            let n = points.len();
            let turns = (0..n).all(|i| {
                let step = angle(&points[(i + 1) % n]) - angle(&points[i]);
                step.rem_euclid(core::f64::consts::TAU) < 3.1
            });
            (n >= 5 && turns).then_some(points)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn simple_polygons_are_tiled(points in simple_polygons()) {
        let face: Vec<u32> = (0..points.len() as u32).collect();
        let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
        prop_assert!(diagnosis.is_clean());
        prop_assert!(diagnosis.twisted_polygons.is_empty());
        // Triangles over straight corners were exchanged for proper ones, which changes neither area nor count.
        assert_tiles(&points, mesh.triangles());
    }
}

/// Seen in its tilted plane, corners on one line are so only within rounding.
#[test]
fn corners_on_one_line_in_a_tilted_plane_are_no_twist() {
    let points = [
        [-5, 0],
        [-6, -1],
        [-3, -1],
        [-2, -1],
        [0, 0],
        [-2, -3],
        [0, -1],
        [0, -3],
        [0, -4],
        [3, -6],
        [6, -3],
        [3, -1],
        [5, 1],
        [6, 2],
        [5, 4],
        [2, 4],
        [1, 2],
        [0, 5],
        [-1, 3],
        [-1, 2],
        [-4, 6],
        [-3, 4],
        [-5, 3],
        [-3, 1],
        [-4, 1],
    ]
    .map(|point| point.map(f64::from));
    let face: Vec<u32> = (0..points.len() as u32).collect();
    let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
    assert!(diagnosis.is_clean());
    assert_tiles(&points, mesh.triangles());
}

#[test]
fn many_corners_take_little_time() {
    let n = 50_000u32;
    let comb = |i: u32| {
        [
            f64::from(i),
            if i.is_multiple_of(2) {
                0.0
            } else {
                1000.0 + f64::from(i % 7)
            },
        ]
    };
    let mut points: Vec<[f64; 2]> = (0..n).map(comb).collect();
    points.extend([[f64::from(n), -1.0], [-1.0, -1.0]]);
    points.reverse();
    let face: Vec<u32> = (0..points.len() as u32).collect();
    let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
    assert!(diagnosis.twisted_polygons.is_empty());
    assert_tiles(&points, mesh.triangles());
}

/// A polygon that goes round three vertices thousands of times bounds nothing, and is not processed
/// corner by corner.
#[test]
fn going_round_and_round_is_a_twist() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let face: Vec<u32> = (0..30_000).map(|corner| corner % 3).collect();
    let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
    assert_eq!(diagnosis.twisted_polygons.count, 1);
    assert_eq!(mesh.triangles().len(), 1);
}

/// Holes that are joined to the rim by slits, which come twice to the vertices at their ends.
#[test]
fn polygons_with_slits_are_no_twists() {
    let (mut points, mut face) = (vec![[0.0, 0.0]], vec![0u32]);
    // Thirty triangular holes, each reached from the first corner along a ray.
    for hole in 0..30 {
        let angle = 0.02 + 0.05 * f64::from(hole);
        let at = |turn: f64, far: f64| [far * (angle + turn).cos(), far * (angle + turn).sin()];
        let first = points.len() as u32;
        points.extend([at(0.0, 1.0), at(0.01, 2.0), at(0.02, 1.5)]);
        face.extend([first, first + 1, first + 2, first, 0]);
    }
    let first = points.len() as u32;
    points.extend([[0.0, 9.0], [9.0, 9.0], [9.0, 0.0]]);
    face.extend([first, first + 1, first + 2]);
    // Clockwise so far.
    face.reverse();
    assert!(face.len() > 64);
    let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
    assert!(
        diagnosis.twisted_polygons.is_empty(),
        "{:?}",
        found(&diagnosis)
    );
    assert_eq!(mesh.triangles().len(), face.len() - 2);
}

/// Thousands of holes, each joined to the same corner by a slit: the triangles cover the region
/// between them.
#[test]
fn thousands_of_slits_to_one_corner_are_no_twist() {
    let (mut points, mut face) = (vec![[0.0, 0.0]], vec![0u32]);
    let mut holes = 0.0;
    for hole in 0..3000 {
        let angle = 0.0001 + 0.0005 * f64::from(hole);
        let at = |turn: f64, far: f64| [far * (angle + turn).cos(), far * (angle + turn).sin()];
        let first = points.len() as u32;
        points.extend([at(0.0, 1.0), at(0.0001, 2.0), at(0.0002, 1.5)]);
        holes += area(&points, [first, first + 1, first + 2]).abs();
        face.extend([first, first + 1, first + 2, first, 0]);
    }
    let first = points.len() as u32;
    points.extend([[0.0, 9.0], [9.0, 9.0], [9.0, 0.0]]);
    face.extend([first, first + 1, first + 2]);
    // Clockwise so far.
    face.reverse();
    let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
    assert!(
        diagnosis.twisted_polygons.is_empty(),
        "{:?}",
        found(&diagnosis)
    );
    assert_eq!(mesh.triangles().len(), face.len() - 2);
    let areas: Vec<f64> = mesh
        .triangles()
        .iter()
        .map(|&triangle| area(&points, triangle))
        .collect();
    assert!(areas.iter().all(|&area| area > 0.0));
    assert!((areas.iter().sum::<f64>() - (81.0 - holes)).abs() < 1e-9);
}

/// Two turns of a strip, ten thousand corners on either side.
#[test]
fn a_long_spiral_is_tiled() {
    let arm = |far: f64| (0..10_000).map(move |i| (0.1 * f64::from(i), far + 0.02 * f64::from(i)));
    let points = arm(1.0).map(|(turn, far)| [far * turn.cos(), far * turn.sin()]);
    let back = arm(1.05).map(|(turn, far)| [far * turn.cos(), far * turn.sin()]);
    let mut points: Vec<[f64; 2]> = points
        .chain(back.collect::<Vec<_>>().into_iter().rev())
        .collect();
    points.reverse();
    if polygon_area(&points) < 0.0 {
        points.reverse();
    }
    let face: Vec<u32> = (0..points.len() as u32).collect();
    let (mesh, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
    assert!(diagnosis.twisted_polygons.is_empty());
    assert_tiles(&points, mesh.triangles());
}

/// Curves of ten thousand corners that cross themselves a few times, everywhere, or at corners alone. Each ends in well under a second.
#[test]
fn large_polygons_that_cross_are_twisted() {
    const CORNERS: u32 = 10_000;
    let turn = |i: u32| core::f64::consts::TAU * f64::from(i) / f64::from(CORNERS);
    let scattered = |i: u32, step: f64| (step * f64::from(i)).fract();
    let circles = |i: u32| {
        let (half, turn) = (CORNERS / 2, 2.0 * turn(i));
        let far = if i < half { 1.0 } else { -1.3 };
        [far * (1.0 - turn.cos()), turn.sin()]
    };
    let curves: [&dyn Fn(u32) -> [f64; 2]; 5] = [
        &|i| [(7.0 * turn(i) + 0.3).sin(), (6.0 * turn(i)).sin()],
        &|i| [turn(i).sin(), (2.0 * turn(i)).sin() + 0.3 * turn(i).cos()],
        &|i| [scattered(i, 0.618_033_988_7), scattered(i, 0.754_877_666_2)],
        &|i| [(4999.0 * turn(i)).cos(), (4999.0 * turn(i)).sin()],
        &circles,
    ];
    for (number, curve) in curves.into_iter().enumerate() {
        let points: Vec<[f64; 2]> = (0..CORNERS).map(curve).collect();
        let face: Vec<u32> = (0..CORNERS).collect();
        let (_, diagnosis) = build_soup(&soup(&flat(&points), &[&face]));
        assert_eq!(diagnosis.twisted_polygons.count, 1, "curve {number}");
    }
}
