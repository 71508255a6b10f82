use limitmesh::refine::{ExactStop, RefineError, UniformOptions};
use limitmesh::sqrt3::{Sqrt3, Sqrt3Options, adaptive, uniform};
use limitmesh::{HalfEdgeId, Mesh};

use crate::sqrt3::models::{icosahedron, junction, sharp, smooth, tetrahedron};
use crate::support::{Point, crease, distance, octahedron, unnumbered};

fn cone(mesh: &Mesh, degrees: f64) -> Sqrt3 {
    let options = Sqrt3Options::default()
        .angle(Some(degrees.to_radians()))
        .origins(true);
    adaptive(mesh, &options).unwrap()
}

/// Icosahedron, octahedron, tetrahedron, and the icosahedron three times as high.
fn solids() -> [(&'static str, Mesh); 4] {
    let high = icosahedron();
    let positions = high
        .positions()
        .iter()
        .map(|&[x, y, z]| [x, y, 3.0 * z])
        .collect();
    [
        ("icosahedron", icosahedron()),
        ("octahedron", octahedron()),
        ("tetrahedron", tetrahedron()),
        ("high icosahedron", high.with_positions(positions).unwrap()),
    ]
}

/// As a prototype in another language counted them, without common code: the least set is unique.
#[test]
fn cones_give_the_known_numbers_of_triangles() {
    let known = [
        [180, 540, 1620],
        [216, 648, 1944],
        [204, 972, 3036],
        [268, 1036, 4044],
    ];
    for ((name, mesh), expected) in solids().iter().zip(known) {
        let found = [20.0, 10.0, 5.0].map(|degrees| cone(mesh, degrees).mesh.face_count());
        assert_eq!(found, expected, "{name}");
    }
}

/// All that is uneven: closed, open, creased, of one triangle, cut apart.
fn all() -> Vec<(&'static str, Mesh)> {
    let mut all = smooth();
    all.extend(sharp());
    all.push(("junction", junction()));
    all
}

/// Everything divided to a level is that level of uniform refinement.
#[test]
fn everything_divided_is_uniform() {
    for (name, mesh) in all() {
        for level in 0..=4 {
            let options = Sqrt3Options::default()
                .angle(Some(1e-12))
                .max_levels(level)
                .origins(true);
            let found = adaptive(&mesh, &options).unwrap();
            let options = UniformOptions::default()
                .levels(level)
                .limit(true)
                .origins(true);
            let expected = uniform(&mesh, &options).unwrap();
            let [found_faces, all] = [&found.mesh, &expected.mesh].map(|mesh| unnumbered(mesh, 9));
            if ["single", "one edge"].contains(&name) && level > 0 {
                // Planar regions need no division; the vertices of divided regions are those of
                // uniform refinement.
                let all: Vec<_> = all.as_flattened().to_vec();
                assert!(
                    found_faces.as_flattened().iter().all(|at| all.contains(at)),
                    "{name}, level {level}"
                );
                assert!(
                    found_faces.len() <= expected.mesh.face_count(),
                    "{name}, level {level}"
                );
                continue;
            }
            assert_eq!(found.stop, ExactStop::LevelCap, "{name}, level {level}");
            assert_eq!(found_faces, all, "{name}, level {level}");
        }
    }
}

/// Conforming, of the same topology, with the limits, normals and places of uniform refinement.
#[test]
fn results_are_made_of_uniform_levels() {
    for (name, mesh) in all() {
        let found = cone(&mesh, 12.0);
        found.mesh.validate().unwrap();
        assert_eq!(
            found.mesh.topology().euler_characteristic(),
            mesh.topology().euler_characteristic(),
            "{name}"
        );
        let closed = mesh.topology().boundary_edge_count() == 0;
        assert_eq!(
            found.mesh.topology().boundary_edge_count() == 0,
            closed,
            "{name}"
        );
        if closed {
            assert_eq!(
                (found.mesh.face_count() - mesh.face_count()) % 2,
                0,
                "{name}"
            );
        }
        let level = found.levels.min(6);
        let options = UniformOptions::default()
            .levels(level)
            .limit(true)
            .normals(true)
            .origins(true);
        let tower = uniform(&mesh, &options).unwrap();
        let by_place = |v: usize| {
            let origin = tower.origins[v];
            (tower.mesh.positions()[v], origin)
        };
        let normals = tower.normals.as_ref().unwrap().by_vertex();
        let near = |p: Point| {
            (0..tower.mesh.vertex_count()).find(|&v| distance(tower.mesh.positions()[v], p) < 1e-12)
        };
        let mut compared = 0;
        for (v, &p) in found.mesh.positions().iter().enumerate().take(150) {
            let Some(other) = near(p) else {
                assert!(found.levels > level, "{name}: {p:?}");
                continue;
            };
            compared += 1;
            let (_, origin) = by_place(other);
            let own = found.origins[v];
            if let Some(same) = own.in_face(mesh.triangles(), origin.face) {
                assert!(
                    (0..3).all(|i| (same.barycentric[i] - origin.barycentric[i]).abs() < 1e-9),
                    "{name}, {v}"
                );
            }
            let [a, b] = [found.normals.by_vertex()[v], normals[other]];
            let dot: f64 = (0..3).map(|i| a[i] * b[i]).sum();
            let plain = found.mesh.tags().creases.is_empty()
                && !found.mesh.tags().corners.iter().any(|_| true);
            assert!(
                !plain || dot > 1.0 - 1e-9 || v < mesh.vertex_count(),
                "{name}, {v}: {dot}"
            );
        }
        assert!(compared > 0, "{name}");
        for (face, &parent) in found.parents.iter().enumerate() {
            let corners = found.mesh.triangles()[face];
            let inside = corners.iter().filter(|&&v| {
                found.origins[v as usize]
                    .in_face(mesh.triangles(), parent)
                    .is_some()
            });
            assert!(inside.count() >= 2, "{name}, face {face}");
        }
    }
}

/// The criterion holds for all triangles that there are, with the limit normals of uniform refinement.
#[test]
fn no_triangle_leaves_its_cone() {
    for (name, mesh) in solids() {
        let found = cone(&mesh, 10.0);
        assert_eq!(found.stop, ExactStop::Met);
        for face in 0..found.mesh.face_count() as u32 {
            let normal = found.mesh.face_normal(limitmesh::FaceId(face));
            let length = distance(normal, [0.0; 3]);
            for corner in 0..3 {
                let h = HalfEdgeId(3 * face + corner);
                let limit = found.normals.at(found.mesh.topology(), h);
                let dot: f64 = (0..3).map(|i| normal[i] * limit[i]).sum();
                assert!(dot / length >= 10f64.to_radians().cos() - 1e-12, "{name}");
            }
        }
    }
}

/// The result of a criterion is the least mesh that meets it: a tolerance that is always met adds
/// nothing to an angle, and a mesh with its faces in another order gives an equal result.
#[test]
fn results_do_not_depend_on_the_order() {
    for (name, mesh) in [
        ("lumpy", crate::support::lumpy(12, 7)),
        ("sheet", crate::support::sheet(3, 3, 3)),
    ] {
        let expected = unnumbered(&cone(&mesh, 12.0).mesh, 9);
        let both = Sqrt3Options::default().angle(Some(12f64.to_radians()));
        let both = adaptive(&mesh, &both.tolerance(Some(mesh.diagonal()))).unwrap();
        assert_eq!(unnumbered(&both.mesh, 9), expected, "{name}");
        for turn in [1, 5, 7] {
            let mut triangles = mesh.triangles().to_vec();
            triangles.rotate_left(turn);
            triangles
                .iter_mut()
                .for_each(|corners| corners.rotate_left(turn % 3));
            let turned = Mesh::from_triangles(mesh.positions().to_vec(), triangles).unwrap();
            assert_eq!(
                unnumbered(&cone(&turned, 12.0).mesh, 9),
                expected,
                "{name}, {turn}"
            );
        }
    }
}

/// The estimate is a distance that is found, and not far below the greatest.
#[test]
fn tolerances_hold_about() {
    for (name, mesh) in solids() {
        let tolerance = 0.003 * mesh.diagonal();
        let found = adaptive(&mesh, &Sqrt3Options::default().tolerance(Some(tolerance))).unwrap();
        let estimate = found.estimated_distance.unwrap();
        at_most!(estimate, tolerance, "{name}");
        above!(estimate, 0.2 * tolerance, "{name}");
        let fine = uniform(&mesh, &UniformOptions::default().levels(7).limit(true))
            .unwrap()
            .mesh;
        let options = limitmesh::measure::SamplingOptions::default().samples(20_000);
        let measured =
            limitmesh::measure::hausdorff(found.mesh.as_triangles(), fine.as_triangles(), &options)
                .unwrap();
        let measured = measured.symmetric();
        below!(measured, 1.3 * estimate, "{name}");
        above!(measured, 0.7 * estimate, "{name}");
    }
}

#[test]
fn caps_and_budgets_are_not_passed() {
    let mesh = icosahedron();
    for triangles in [20, 21, 100, 333, 1000] {
        let found = adaptive(&mesh, &Sqrt3Options::default().triangles(Some(triangles))).unwrap();
        assert_eq!(found.stop, ExactStop::Triangles);
        let count = found.mesh.face_count();
        at_most!(count, triangles);
        above!(count + 12, triangles.min(1000));
        found.mesh.validate().unwrap();
    }
    let options = Sqrt3Options::default()
        .angle(Some(0.01))
        .max_triangles(Some(500));
    let found = adaptive(&mesh, &options).unwrap();
    assert_eq!(found.stop, ExactStop::TriangleCap);
    assert!(found.mesh.face_count() <= 500 && found.worst > 1.0);
    for (name, mesh) in all() {
        for most in [3, 50, 77] {
            let options = Sqrt3Options::default().triangles(Some(most));
            let found = adaptive(&mesh, &options).unwrap();
            found.mesh.validate().unwrap();
            assert!(
                found.mesh.face_count() <= most.max(mesh.face_count()),
                "{name}"
            );
        }
    }
}

#[test]
fn options_that_mean_nothing_are_errors() {
    let refused = |options: Sqrt3Options| adaptive(&octahedron(), &options).is_err();
    assert!(refused(Sqrt3Options::default()));
    assert!(refused(Sqrt3Options::default().angle(Some(0.0))));
    assert!(refused(Sqrt3Options::default().angle(Some(f64::NAN))));
    assert!(refused(
        Sqrt3Options::default().tolerance(Some(f64::INFINITY))
    ));
    assert!(refused(
        Sqrt3Options::default().triangles(Some(9)).max_levels(49)
    ));
    let creases = vec![crease([0, 2], 1.0)];
    let fading = octahedron()
        .with_tags(crate::support::creases(creases))
        .unwrap();
    let error = adaptive(&fading, &Sqrt3Options::default().angle(Some(0.1))).unwrap_err();
    assert!(matches!(error, RefineError::FadingTag { .. }));
}

/// Observers can stop it, and get true reports.
#[test]
fn observers_can_stop_it() {
    use core::ops::ControlFlow;
    let options = Sqrt3Options::default().angle(Some(0.02));
    let mut calls = 0;
    let mut observer = |_: &limitmesh::progress::Progress| {
        calls += 1;
        if calls > 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let result = limitmesh::sqrt3::adaptive_observed(&icosahedron(), &options, &mut observer);
    assert!(matches!(result, Err(RefineError::Cancelled(_))));
}
