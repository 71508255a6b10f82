//! Each step of the sculpting against what a ball, an ellipsoid and exact shapes require.

use super::collapse::{collapse_to, shape};
use super::contour::contour;
use super::field::{at, ball, blade, difference, ellipsoid, limb, rod, union};
use super::polish::{polish, project};
use super::{Grid, Surface, mirrored_with_limit_through, sculpt};
use glam::DVec3;
use limitmesh_mesh::Mesh;

const RADIUS: f64 = 0.7;

fn unit_ball(p: DVec3) -> f64 {
    ball(p, DVec3::ZERO, RADIUS)
}

fn grid() -> Grid {
    Grid::new([-0.9, -0.9], [0.9, 0.9, 0.9], 0.07)
}

fn mesh(surface: &Surface) -> Mesh {
    let positions = surface.positions.iter().map(|p| p.to_array()).collect();
    let mesh = Mesh::from_triangles(positions, surface.triangles.clone()).unwrap();
    mesh.validate().unwrap();
    mesh
}

/// A half must be a disc whose boundary lies in the mirror plane, and nothing else may.
fn assert_half(half: &Surface) {
    let mesh = mesh(half);
    assert_eq!(mesh.topology().euler_characteristic(), 1);
    for v in mesh.topology().vertices() {
        let x = mesh.positions()[v.index()][0];
        assert!(x >= 0.0);
        assert_eq!(mesh.topology().is_boundary(v), x == 0.0);
    }
}

#[test]
fn the_contour_of_a_ball_is_a_hemisphere_that_looks_outwards() {
    let half = contour(&unit_ball, &grid());
    assert_half(&half);
    for p in &half.positions {
        // Crossings may be pushed off the surface by a part of a cell's diagonal.
        assert!(
            (p.length() - RADIUS).abs() < 0.07 * 3.0_f64.sqrt() * 0.2,
            "{p}"
        );
    }
    for t in &half.triangles {
        let [a, b, c] = t.map(|v| half.positions[v as usize]);
        assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
    }
}

#[test]
fn a_tunnel_survives_contouring() {
    // A ball drilled through along z is a torus: Euler characteristic 0.
    let drilled =
        |p: DVec3| difference(unit_ball(p), DVec3::new(p.x, p.y, 0.0).length() - 0.3, 0.02);
    let whole = contour(&drilled, &grid()).mirrored();
    assert_eq!(mesh(&whole).topology().euler_characteristic(), 0);
}

#[test]
fn collapsing_reaches_any_count_and_keeps_the_half_sound() {
    let fine = contour(&unit_ball, &grid());
    for triangles in [400, 151, 150, 71, 24] {
        let mut half = fine.clone();
        collapse_to(&mut half, triangles);
        assert_eq!(half.triangles.len(), triangles);
        assert_half(&half);
    }
}

#[test]
fn collapsing_a_plane_leaves_it_flat() {
    // The top of a box far wider than the grid is the plane y = 0.1.
    let below = |p: DVec3| p.y - 0.1;
    let mut sheet = contour(&below, &grid());
    polish(&mut sheet, &below);
    let before = sheet.triangles.len();
    collapse_to(&mut sheet, before / 2);
    assert!(sheet.positions.iter().all(|p| (p.y - 0.1).abs() < 1e-9));
}

#[test]
fn polishing_improves_shapes_and_puts_vertices_on_the_body() {
    let mut half = contour(&unit_ball, &grid());
    collapse_to(&mut half, 150);
    let worst = |half: &Surface| {
        half.triangles
            .iter()
            .map(|t| shape(t.map(|v| half.positions[v as usize])))
            .fold(1.0, f64::min)
    };
    let before = worst(&half);
    polish(&mut half, &unit_ball);
    assert_half(&half);
    assert!(
        worst(&half) > before.max(0.3),
        "{before} to {}",
        worst(&half)
    );
    assert!(
        half.positions
            .iter()
            .all(|p| (p.length() - RADIUS).abs() < 1e-6)
    );
}

#[test]
fn the_limit_of_a_sculpted_ball_is_a_ball() {
    let whole = sculpt(&unit_ball, &grid(), 300);
    assert_eq!(whole.triangles.len(), 300);
    let mesh = mesh(&whole);
    let neighbours = whole.neighbours();
    for (&p, (all, _)) in whole.positions.iter().zip(&neighbours) {
        let mean = all
            .iter()
            .map(|&u| whole.positions[u as usize])
            .sum::<DVec3>()
            / all.len() as f64;
        // Loop's limit mask with Warren's β = 3/(8k) is the middle between the vertex and the mean of its
        // neighbours; with β = 3/16 for k = 3 it is 2 to 3.
        let part = if all.len() == 3 { 0.6 } else { 0.5 };
        let limit = p.lerp(mean, part).length();
        assert!((limit - RADIUS).abs() < 0.01, "{limit}");
    }
    assert_eq!(mesh.topology().euler_characteristic(), 2);
}

#[test]
fn fitting_keeps_the_mirror_exactly() {
    let mut half = contour(&unit_ball, &grid());
    collapse_to(&mut half, 90);
    let whole = mirrored_with_limit_through(&half, 5);
    let in_plane = half.positions.iter().filter(|p| p.x == 0.0).count();
    assert_eq!(whole.positions.len(), 2 * half.positions.len() - in_plane);
    for p in &whole.positions {
        assert!(whole.positions.contains(&DVec3::new(-p.x, p.y, p.z)));
    }
}

#[test]
fn fields_are_zero_on_their_surfaces_and_negative_inside() {
    assert!(ellipsoid(at(0.0, 2.0, 0.0), DVec3::ZERO, at(1.0, 2.0, 3.0)).abs() < 1e-15);
    assert!(ellipsoid(DVec3::ZERO, DVec3::ZERO, at(1.0, 2.0, 3.0)) < 0.0);
    let (a, b) = (at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0));
    assert!((rod(at(0.5, 0.3, 0.0), a, 0.2, b, 0.4)).abs() < 1e-15);
    assert!((rod(at(1.4, 0.0, 0.0), a, 0.2, b, 0.4)).abs() < 1e-15);
    assert!(
        limb(
            at(1.0, 0.5, 0.0),
            &[(a, 0.1), (b, 0.1), (at(1.0, 1.0, 0.0), 0.1)],
            0.05
        ) < 0.0
    );
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    assert!(blade([0.5, 0.5, 0.0], &square, 0.1, 0.02) < 0.0);
    assert!(blade([0.5, 0.5, 0.2], &square, 0.1, 0.02) > 0.0);
    assert!(blade([1.2, 0.5, 0.0], &square, 0.1, 0.02) > 0.0);
    // A smooth union is the union away from the fillet and larger in it.
    assert_eq!(union(0.3, 0.5, 0.1), 0.3);
    assert!((union(0.3, 0.3, 0.1) - 0.275).abs() < 1e-15);
}

#[test]
fn projection_finds_the_surface_and_stays_in_the_mirror_plane() {
    let body = |p: DVec3| ellipsoid(p, DVec3::ZERO, at(0.5, 0.7, 0.9));
    let p = project(&body, at(0.3, 0.5, 0.6), 1e-4);
    assert!(body(p).abs() < 1e-6);
    assert_eq!(project(&body, at(0.0, 0.6, 0.5), 1e-4).x, 0.0);
}
