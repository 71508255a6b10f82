//! Closest points and what is inside, against dense samples, closed forms, and rays through fine meshes.

#![allow(missing_docs, clippy::unwrap_used)]

use core::ops::ControlFlow;

use limitmesh::mesh::Tags;
use limitmesh::refine::limit_reference;
use limitmesh::scheme::{Loop, ModifiedButterfly};
use limitmesh::{Closest, FaceId, LimitSurface, Membership, Mesh, Proximity, ProximityError};

use crate::support::{Point, corner, crease, cross, distance, dot, minus, model, octahedron};

/// A double cone over a polygon: tips of any valence, the others of four.
fn spindle(valence: u32) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 1.3], [0.1, 0.0, -0.9]];
    let mut triangles = Vec::new();
    for i in 0..valence {
        let angle = core::f64::consts::TAU * f64::from(i) / f64::from(valence);
        positions.push([angle.cos(), 0.8 * angle.sin(), 0.2 * (3.0 * angle).sin()]);
        let (a, b) = (2 + i, 2 + (i + 1) % valence);
        triangles.extend([[0, a, b], [1, b, a]]);
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// With a crease, a semi-sharp one, and a corner.
fn tagged(mesh: &Mesh) -> Mesh {
    let [a, b, c] = mesh.triangles()[0];
    let [d, e, _] = mesh.triangles()[mesh.face_count() - 1];
    let creases = [
        ([a, b], f64::INFINITY),
        ([b, c], f64::INFINITY),
        ([d, e], 1.4),
    ]
    .map(|(vertices, sharpness)| crease(vertices, sharpness));
    let corners = vec![corner(c, f64::INFINITY)];
    mesh.clone()
        .with_tags(Tags {
            creases: creases.to_vec(),
            corners,
        })
        .unwrap()
}

fn meshes() -> Vec<(String, Mesh)> {
    let mut meshes: Vec<(String, Mesh)> = [3, 5, 7, 12]
        .map(|n| (format!("spindle {n}"), spindle(n)))
        .into();
    meshes.push(("octahedron".into(), octahedron()));
    meshes.push(("tagged spindle".into(), tagged(&spindle(6))));
    meshes.push(("sheet".into(), model("sheet")));
    meshes.push(("tagged octahedron".into(), tagged(&octahedron())));
    meshes
}

/// Points in and around a mesh.
fn scattered(mesh: &Mesh, count: usize) -> Vec<Point> {
    let [low, high] = mesh.as_triangles().bounding_box().unwrap();
    let at = |i: usize| {
        [0.618_033_988_75, 0.754_877_666_25, 0.569_840_290_99]
            .map(|step| 1.6 * (0.5 + step * i as f64).fract() - 0.3)
    };
    (0..count)
        .map(|i| [0, 1, 2].map(|k| low[k] + at(i)[k] * (high[k] - low[k])))
        .collect()
}

/// Places on every face.
fn samples(mesh: &Mesh, parts: u32) -> Vec<(FaceId, [f64; 3])> {
    let steps = (0..=parts).flat_map(|j| (0..=parts - j).map(move |k| (j, k)));
    let weights: Vec<[f64; 3]> = steps
        .map(|(j, k)| [j, k].map(|x| f64::from(x) / f64::from(parts)))
        .map(|[u, v]| [1.0 - u - v, u, v])
        .collect();
    (0..mesh.face_count() as u32)
        .flat_map(|face| weights.iter().map(move |&at| (FaceId(face), at)))
        .collect()
}

fn closest(mesh: &Mesh, points: &[Point], tolerance: f64) -> Vec<Closest> {
    let surface = LimitSurface::new(mesh, &Loop).unwrap();
    Proximity::new(&surface)
        .unwrap()
        .closest(points, tolerance)
        .unwrap()
}

#[test]
fn no_sample_is_nearer_and_the_point_is_on_the_surface() {
    for (name, mesh) in meshes() {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let proximity = Proximity::new(&surface).unwrap();
        let dense: Vec<Point> = surface
            .at_all(&samples(&mesh, 24))
            .iter()
            .map(|point| point.position)
            .collect();
        let points = scattered(&mesh, 60);
        for tolerance in [1e-3, 1e-9] {
            let found = proximity.closest(&points, tolerance).unwrap();
            for (&point, found) in points.iter().zip(&found) {
                let near = dense
                    .iter()
                    .map(|&at| distance(at, point))
                    .fold(f64::INFINITY, f64::min);
                at_most!(found.lower, near + 1e-12, "{name}, {point:?}");
                at_most!(found.distance, near + tolerance, "{name}, {point:?}");
                // As dense as the samples are.
                below!(near - found.distance, 0.1, "{name}, {point:?}");
                at_most!(found.lower, found.distance);
                at_most!(found.distance - found.lower, tolerance * 1.000_001);
                let there = surface.at(found.face, found.barycentric).position;
                below!(distance(there, found.point), 1e-12, "{name}: {there:?}");
                assert!((distance(point, found.point) - found.distance).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn where_the_nearest_point_is_smooth_the_way_there_is_along_the_normal() {
    let mesh = spindle(7);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let points = scattered(&mesh, 100);
    for (point, found) in points.iter().zip(
        Proximity::new(&surface)
            .unwrap()
            .closest(&points, 1e-12)
            .unwrap(),
    ) {
        let normal = surface.at(found.face, found.barycentric).normal;
        let way = minus(*point, found.point);
        assert!(
            distance(cross(way, normal), [0.0; 3]) < 1e-6,
            "{point:?}: {way:?} and {normal:?}"
        );
    }
}

/// Radii by closed forms of Loop's limits: a vertex at 24/55, the middle of a face nearest to the centre.
#[test]
fn the_octahedron_is_as_far_as_it_is() {
    let [corner, centre] = closest(&octahedron(), &[[3.0, 0.0, 0.0], [0.0; 3]], 1e-10)[..] else {
        unreachable!()
    };
    assert!((corner.distance - (3.0 - 24.0 / 55.0)).abs() < 1e-12);
    assert!(
        (centre.distance - 271.0 * 3f64.sqrt() / 1152.0).abs() < 1e-10,
        "{}",
        centre.distance
    );
}

/// A surface in a plane: the perpendicular projection, or the rim, which is straight where the
/// boundary is.
#[test]
fn a_plane_is_as_far_as_it_is_high() {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..5u32 {
        for i in 0..5u32 {
            positions.push([f64::from(i), f64::from(j), 2.0]);
            if i < 4 && j < 4 {
                let at = 5 * j + i;
                triangles.extend([[at, at + 1, at + 6], [at, at + 6, at + 5]]);
            }
        }
    }
    let mesh = Mesh::from_triangles(positions, triangles).unwrap();
    let found = closest(
        &mesh,
        &[[1.3, 2.1, 5.0], [2.0, -4.0, 2.0], [2.0, -3.0, -2.0]],
        1e-9,
    );
    for (found, expected) in found.iter().zip([3.0, 4.0, 5.0]) {
        below!((found.distance - expected).abs(), 1e-9, "{expected}");
    }
    assert!(distance(found[0].point, [1.3, 2.1, 2.0]) < 1e-9);
}

#[test]
fn places_and_sizes_change_nothing() {
    let mesh = spindle(5);
    let points = scattered(&mesh, 20);
    let plain = closest(&mesh, &points, 1e-8);
    for size in [1e-250, 1e-9, 1e6, 1e250] {
        let scaled = |p: Point| p.map(|x| x * size);
        let large = mesh
            .clone()
            .with_positions(mesh.positions().iter().map(|&p| scaled(p)).collect())
            .unwrap();
        let found = closest(
            &large,
            &points.iter().map(|&p| scaled(p)).collect::<Vec<_>>(),
            1e-8 * size,
        );
        for (plain, found) in plain.iter().zip(found) {
            assert!(
                (found.distance / size - plain.distance).abs() < 1e-8,
                "{size}"
            );
        }
    }
    let moved = |p: Point| [p[0] + 1e6, p[1] - 3e6, p[2] + 2e6];
    let far = mesh
        .clone()
        .with_positions(mesh.positions().iter().map(|&p| moved(p)).collect())
        .unwrap();
    for (plain, found) in plain.iter().zip(closest(
        &far,
        &points.iter().map(|&p| moved(p)).collect::<Vec<_>>(),
        1e-8,
    )) {
        assert!((found.distance - plain.distance).abs() < 1e-7);
    }
}

/// How often a ray meets triangles, those from behind counted as −1; `None` where it comes too near to an edge.
fn crossings(mesh: &Mesh, from: Point, direction: Point) -> Option<i32> {
    let mut count = 0;
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| minus(mesh.positions()[v as usize], from));
        // Signed volumes with the ray, by edges.
        let volumes = [[a, b], [b, c], [c, a]].map(|[p, q]| dot(direction, cross(p, q)));
        let normal = cross(minus(b, a), minus(c, a));
        let along = dot(a, normal) / dot(direction, normal);
        if volumes.iter().all(|&x| x > 1e-9) || volumes.iter().all(|&x| x < -1e-9) {
            if along > 0.0 {
                count += if volumes[0] > 0.0 { 1 } else { -1 };
            }
        } else if volumes.iter().all(|&x| x > -1e-9) || volumes.iter().all(|&x| x < 1e-9) {
            return None;
        }
    }
    Some(count)
}

#[test]
fn rays_through_a_fine_mesh_tell_the_same_inside() {
    let mut tested = [0, 0];
    for (name, mesh) in meshes().into_iter().filter(|(name, _)| name != "sheet") {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let proximity = Proximity::new(&surface).unwrap();
        let fine = limit_reference(&mesh, &Loop, 4).unwrap();
        // Also points that are near: some thousandths off the surface.
        let mut points = scattered(&mesh, 60);
        for (at, offset) in surface
            .at_all(&samples(&mesh, 3))
            .iter()
            .zip([0.02, -0.02, 0.01, -0.01].into_iter().cycle())
        {
            points.push([0, 1, 2].map(|k| at.position[k] + offset * at.normal[k]));
        }
        let distances = proximity.closest(&points, 1e-4).unwrap();
        for (&point, found) in points.iter().zip(distances) {
            // The fine mesh is off by some thousandths.
            let Some(count) =
                crossings(&fine, point, [0.567, 0.323, 0.757]).filter(|_| found.distance > 5e-3)
            else {
                continue;
            };
            assert_eq!(
                proximity.winding_number(point).unwrap(),
                Some(count),
                "{name}, {point:?}"
            );
            tested[usize::from(count != 0)] += 1;
        }
    }
    assert!(tested.iter().all(|&count| count > 100), "{tested:?}");
}

#[test]
fn surfaces_that_are_turned_inside_out_or_nested_wind_as_they_should() {
    let mesh = octahedron();
    let turned = mesh
        .triangles()
        .iter()
        .map(|&[a, b, c]| [a, c, b])
        .collect();
    let turned = Mesh::from_triangles(mesh.positions().to_vec(), turned).unwrap();
    let surface = LimitSurface::new(&turned, &Loop).unwrap();
    let proximity = Proximity::new(&surface).unwrap();
    assert_eq!(
        proximity.winding_number([0.1, 0.0, 0.05]).unwrap(),
        Some(-1)
    );
    assert_eq!(
        proximity.membership([0.1, 0.0, 0.05]).unwrap(),
        Membership::Inside
    );

    // A shell: one octahedron within another, turned.
    let mut positions: Vec<Point> = mesh.positions().to_vec();
    positions.extend(mesh.positions().iter().map(|p| p.map(|x| 0.5 * x)));
    let mut triangles = mesh.triangles().to_vec();
    triangles.extend(
        mesh.triangles()
            .iter()
            .map(|&[a, b, c]| [a + 6, c + 6, b + 6]),
    );
    let shell = Mesh::from_triangles(positions, triangles).unwrap();
    let surface = LimitSurface::new(&shell, &Loop).unwrap();
    let proximity = Proximity::new(&surface).unwrap();
    let along = [0.0, 0.1, 0.15, 0.25, 0.3, 0.42, 0.44, 2.0].map(|x| [x, 0.0, 0.0]);
    let found = proximity.memberships(&along).unwrap();
    use Membership::{Inside, Outside};
    assert_eq!(
        found,
        [
            Outside, Outside, Outside, Inside, Inside, Inside, Outside, Outside
        ]
    );
}

#[test]
fn points_on_the_surface_are_near_and_beside_it_they_are_not() {
    let mesh = spindle(5);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let proximity = Proximity::new(&surface).unwrap();
    let on = surface.at_all(&samples(&mesh, 5));
    let near = on
        .iter()
        .filter(|at| proximity.membership(at.position).unwrap() == Membership::Near)
        .count();
    assert!(10 * near > 9 * on.len(), "{near} of {}", on.len());
    for at in &on {
        for (offset, expected) in [(1e-6, Membership::Outside), (-1e-6, Membership::Inside)] {
            let point = [0, 1, 2].map(|k| at.position[k] + offset * at.normal[k]);
            assert_eq!(proximity.membership(point).unwrap(), expected, "{point:?}");
        }
    }
}

#[test]
fn errors_say_what_is_wrong() {
    let mesh = octahedron();
    let butterfly = LimitSurface::new(&mesh, &ModifiedButterfly).unwrap();
    assert!(matches!(
        Proximity::new(&butterfly),
        Err(ProximityError::Scheme { .. })
    ));
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let proximity = Proximity::new(&surface).unwrap();
    let error = proximity
        .closest(&[[0.0; 3], [0.0, f64::NAN, 0.0]], 1e-3)
        .unwrap_err();
    assert_eq!(error.to_string(), "point 1 is not finite: (0, NaN, 0)");
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            proximity.closest(&[], tolerance),
            Err(ProximityError::Tolerance { .. })
        ));
    }
    let mut triangles = mesh.triangles().to_vec();
    triangles.pop();
    let open = Mesh::from_triangles(mesh.positions().to_vec(), triangles).unwrap();
    let surface = LimitSurface::new(&open, &Loop).unwrap();
    let error = Proximity::new(&surface)
        .unwrap()
        .membership([0.0; 3])
        .unwrap_err();
    assert!(matches!(error, ProximityError::Open { .. }), "{error}");
}

#[test]
fn observers_are_asked_and_can_stop_it() {
    let mesh = octahedron();
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let proximity = Proximity::new(&surface).unwrap();
    let mut calls = 0;
    let mut stop = |_: &limitmesh::progress::Progress| {
        calls += 1;
        if calls > 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    // From the middle all of it is equally far.
    let found = proximity.closest_observed(&[[0.0; 3]; 4096], 1e-9, &mut stop);
    assert!(matches!(found, Err(ProximityError::Cancelled(_))));
    assert!(matches!(
        Proximity::new_observed(&surface, &mut |_| ControlFlow::Break(())),
        Err(ProximityError::Cancelled(_))
    ));
}

#[test]
fn points_whose_distance_is_no_number_are_named() {
    for (size, far) in [(1.0, 1e300), (1e-200, 1.0)] {
        let control = octahedron();
        let positions = control
            .positions()
            .iter()
            .map(|p| p.map(|x| size * x))
            .collect();
        let control = Mesh::from_triangles(positions, control.triangles().to_vec()).unwrap();
        let surface = LimitSurface::new(&control, &Loop).unwrap();
        let proximity = Proximity::new(&surface).unwrap();
        let found = proximity.closest(&[[0.0; 3], [far, 0.0, 0.0]], 1e-6 * size);
        assert!(
            matches!(found, Err(ProximityError::TooFar { index: 1, .. })),
            "{found:?}"
        );
    }
}
