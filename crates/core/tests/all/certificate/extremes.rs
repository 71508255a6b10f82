//! Input at the edge of what there can be: no panic, no endless division, an honest reason for the end.

use std::time::{Duration, Instant};

use limitmesh::mesh::Mesh;
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Finish};
use limitmesh::scheme::Loop;

use crate::support::{Point, corner, exact, octahedron, sheet, within};

/// More than enough for each of these, for an unoptimised build on a busy machine too.
const PATIENCE: Duration = Duration::from_secs(120);

fn refined(control: &Mesh, options: &ExactOptions) -> Exact {
    let start = Instant::now();
    let result = exact(control, &Loop, options).unwrap();
    below!(start.elapsed(), PATIENCE, "{}", control.face_count());
    result.mesh.validate().unwrap();
    let [before, after] =
        [control, &result.mesh].map(|mesh| mesh.topology().euler_characteristic());
    assert_eq!(before, after);
    assert!(
        result.error.lower <= result.error.upper && result.error.upper.is_finite(),
        "{:?}, {:?}",
        result.error,
        control.as_triangles().bounding_box()
    );
    if let (ExactStop::Met, Some(tolerance)) = (result.stop, options.goals.tolerance) {
        at_most!(result.error.upper, tolerance);
    }
    result
}

fn mesh(positions: &[Point], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::from_triangles(positions.to_vec(), triangles.to_vec()).unwrap()
}

fn tetrahedron() -> Mesh {
    let positions = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    mesh(&positions, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

fn triangle() -> Mesh {
    mesh(
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.3]],
        &[[0, 1, 2]],
    )
}

fn scaled(control: &Mesh, factor: f64) -> Mesh {
    let positions = control
        .positions()
        .iter()
        .map(|p| p.map(|x| factor * x))
        .collect();
    control.clone().with_positions(positions).unwrap()
}

fn both_balances(mut check: impl FnMut(ExactOptions)) {
    [Finish::OnSurface, Finish::Balanced]
        .into_iter()
        .for_each(|finish| check(ExactOptions::default().finish(finish)));
}

#[test]
fn the_smallest_meshes_are_refined() {
    let two = mesh(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.3],
            [1.0, 1.0, -0.5],
        ],
        &[[0, 1, 2], [2, 1, 3]],
    );
    for control in [tetrahedron(), triangle(), two] {
        both_balances(|options| {
            let result = refined(&control, &options.tolerance(1e-3));
            assert_eq!(result.stop, ExactStop::Met);
            assert!(result.mesh.face_count() > control.face_count());
        });
    }
}

#[test]
fn tolerances_no_number_can_meet_end_honestly() {
    for (control, levels) in [(tetrahedron(), 5), (triangle(), 6)] {
        both_balances(|options| {
            let options = options.tolerance(1e-300);
            let shallow = refined(&control, &options.clone().max_levels(levels));
            assert_eq!(
                (shallow.stop, shallow.statistics.levels),
                (ExactStop::LevelCap, levels)
            );
            let capped = refined(&control, &options.max_triangles(Some(3000)));
            assert_eq!(capped.stop, ExactStop::TriangleCap);
            assert!(capped.statistics.worst > 1.0);
        });
    }
}

#[test]
fn tolerances_beyond_every_size_are_met_at_once() {
    for control in [tetrahedron(), triangle(), octahedron()] {
        both_balances(|options| {
            let result = refined(&control, &options.tolerance(1e300));
            assert_eq!(
                (result.stop, result.mesh.face_count()),
                (ExactStop::Met, control.face_count())
            );
        });
    }
}

#[test]
fn tiny_and_huge_coordinates_give_the_same_triangles() {
    for control in [tetrahedron(), octahedron(), sheet(3, 3, 5)] {
        let tolerance = 1e-3 * control.diagonal();
        both_balances(|options| {
            let usual = refined(&control, &options.clone().tolerance(tolerance));
            for power in [-900, -500, -140, -60, 60, 140, 500, 900] {
                let factor = 2f64.powi(power);
                let result = refined(
                    &scaled(&control, factor),
                    &options.clone().tolerance(factor * tolerance),
                );
                assert_eq!(result.stop, ExactStop::Met, "2^{power}");
                let counts = [&usual, &result].map(|result| result.mesh.face_count() as f64);
                assert!(
                    (counts[1] / counts[0] - 1.0).abs() < 0.1,
                    "2^{power}: {counts:?}"
                );
            }
        });
    }
}

#[test]
fn budgets_that_leave_no_room_change_nothing() {
    let control = octahedron();
    for budget in [0, 1, 7, 8] {
        both_balances(|options| {
            let result = refined(&control, &options.clone().triangles(budget));
            assert_eq!(
                (result.stop, result.mesh.face_count()),
                (ExactStop::Triangles, 8)
            );
            let result = refined(
                &control,
                &options.tolerance(1e-6).max_triangles(Some(budget)),
            );
            assert_eq!(
                (result.stop, result.mesh.face_count()),
                (ExactStop::TriangleCap, 8)
            );
        });
    }
    both_balances(|options| {
        let result = refined(&control, &options.tolerance(1e-6).max_levels(0));
        assert_eq!(
            (result.stop, result.mesh.face_count()),
            (ExactStop::LevelCap, 8)
        );
    });
}

/// All in one plane, to the last bit: the inside is exact as it is, the outline needs triangles where it bends.
#[test]
fn flat_meshes_are_divided_only_along_their_outlines() {
    let bumpy = sheet(12, 12, 3);
    let flat = |p: &Point| [p[0], p[1], 0.0];
    let control = mesh(
        &bumpy.positions().iter().map(flat).collect::<Vec<_>>(),
        bumpy.triangles(),
    );
    both_balances(|options| {
        let result = refined(&control, &options.clone().tolerance(1e-3));
        assert_eq!(result.stop, ExactStop::Met);
        below!(result.mesh.face_count(), 2000);
        let result = refined(
            &control,
            &options.tolerance(1e-300).max_triangles(Some(2000)),
        );
        assert_ne!(result.stop, ExactStop::Met);
    });
    // All edges sharp: nothing ever bends, and only rounding stands against any tolerance.
    let creases = |mesh: &Mesh| {
        let tags = limitmesh::mesh::Tags {
            corners: (0..mesh.vertex_count() as u32)
                .map(|vertex| corner(vertex, f64::INFINITY))
                .collect(),
            ..Default::default()
        };
        mesh.clone().with_tags(tags).unwrap()
    };
    let control = mesh(
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.3, 0.9, 0.7]],
        &[[0, 1, 2]],
    );
    let result = refined(&creases(&control), &within(1e-300));
    assert_eq!(result.stop, ExactStop::Rounding);
    below!(result.mesh.face_count(), 100);
    assert!(result.statistics.worst > 1.0);
}

/// Both sides of a star, one on the other: at the dents the triangles reach beyond the surface, and no height shows it.
#[test]
fn folds_in_one_plane_are_not_called_exact() {
    let (mut positions, mut triangles) = (vec![[0.0; 3]; 2], Vec::new());
    for i in 0..10u32 {
        let (angle, radius) = (
            0.2 * f64::from(i) * std::f64::consts::PI,
            [1.0, 0.4][i as usize % 2],
        );
        positions.push([radius * angle.cos(), radius * angle.sin(), 0.0]);
        let (a, b) = (2 + i, 2 + (i + 1) % 10);
        triangles.extend([[0, a, b], [1, b, a]]);
    }
    let control = mesh(&positions, &triangles);
    let result = refined(&control, &ExactOptions::default().triangles(20));
    assert!(result.error.upper > 1e-3, "{:?}", result.error);
    assert_eq!(refined(&control, &within(1e-3)).stop, ExactStop::Met);
}

#[test]
fn faces_without_area_are_refined() {
    // A line, a point, and a sliver between two proper faces.
    let line = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.4, 0.0, 0.0]];
    for positions in [line, [[0.5; 3]; 3], [[0.0; 3]; 3]] {
        both_balances(|options| {
            let options = options.tolerance(1e-3).max_triangles(Some(2000));
            assert_eq!(
                refined(&mesh(&positions, &[[0, 1, 2]]), &options).stop,
                ExactStop::Met
            );
        });
    }
    let strip = mesh(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.5, 0.0, 0.0],
            [0.5, -1.0, 0.2],
            [0.5, 1.0, 0.1],
        ],
        &[[0, 1, 2], [1, 0, 3], [2, 1, 4]],
    );
    both_balances(|options| {
        assert_eq!(
            refined(&strip, &options.tolerance(1e-2).max_triangles(Some(20_000))).stop,
            ExactStop::Met
        );
    });
}

#[test]
fn thousands_of_faces_around_a_vertex_are_refined() {
    let n = 3_000u32;
    let mut positions = vec![[0.0, 0.0, 0.5]];
    let mut triangles = Vec::new();
    for i in 0..n {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        positions.push([angle.cos(), angle.sin(), 0.0]);
        triangles.push([0, 1 + i, 1 + (i + 1) % n]);
    }
    let options = ExactOptions::default().triangles(4_000);
    let result = refined(&mesh(&positions, &triangles), &options);
    assert!(result.mesh.face_count() <= 4_000);
}

#[test]
fn thousands_of_components_are_refined() {
    let one = tetrahedron();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..3000u32 {
        positions.extend(
            one.positions()
                .iter()
                .map(|p| [p[0] + 3.0 * f64::from(i), p[1], p[2]]),
        );
        triangles.extend(one.triangles().iter().map(|t| t.map(|v| v + 4 * i)));
    }
    both_balances(|options| {
        let result = refined(&mesh(&positions, &triangles), &options.tolerance(0.2));
        assert_eq!(result.stop, ExactStop::Met);
    });
}
