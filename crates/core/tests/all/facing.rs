//! Which way the surface over whole faces looks, and cones of its normals, against many sampled points and normals.

#![allow(clippy::unwrap_used, missing_docs)]

use std::ops::ControlFlow;

use crate::support::{Random, dot, lumpy, octahedron, samples};
use limitmesh::criterion::Viewpoint;
use limitmesh::mesh::CreaseTag;
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly};
use limitmesh::{FaceId, Facing, LimitSurface, Mesh, SurfacePoint};

/// Points a side of a face.
const SIDE: u32 = 16;

/// A mesh with some of its edges sharp, for ever and for a while.
fn creased() -> Mesh {
    let mesh = lumpy(9, 3);
    let crease =
        |[a, b]: [u32; 2], sharpness| crate::support::crease([a.min(b), a.max(b)], sharpness);
    let edges = [[0, 2], [1, 2], [1, 3], [0, 3], [0, 4]];
    let is_edge = |[a, b]: [u32; 2]| {
        mesh.triangles()
            .iter()
            .any(|t| t.contains(&a) && t.contains(&b))
    };
    let mut creases: Vec<CreaseTag> = edges
        .into_iter()
        .filter(|&edge| is_edge(edge))
        .enumerate()
        .map(|(i, edge)| crease(edge, if i % 2 == 0 { f64::INFINITY } else { 2.5 }))
        .collect();
    assert!(creases.len() > 2);
    creases.sort_by_key(|crease| crease.vertices);
    mesh.with_tags(crate::support::creases(creases)).unwrap()
}

fn models() -> Vec<(&'static str, Mesh)> {
    let mut all = samples();
    all.push(("creased", creased()));
    for name in ["head", "torus"] {
        let soup = limitmesh_models::find(name).unwrap().soup();
        all.push((name, Mesh::from_soup(&soup, &Default::default()).unwrap().0));
    }
    all
}

/// Sampled points of each face.
fn sampled(surface: &LimitSurface<'_>, mesh: &Mesh) -> Vec<Vec<SurfacePoint>> {
    let side = f64::from(SIDE);
    let place = |i: u32, j: u32| {
        let (u, v) = (f64::from(i) / side, f64::from(j) / side);
        [1.0 - u - v, u, v]
    };
    let places: Vec<[f64; 3]> = (0..=SIDE)
        .flat_map(|i| (0..=SIDE - i).map(move |j| (i, j)))
        .map(|(i, j)| place(i, j))
        .collect();
    (0..mesh.face_count() as u32)
        .map(|face| {
            surface.at_all(
                &places
                    .iter()
                    .map(|&at| (FaceId(face), at))
                    .collect::<Vec<_>>(),
            )
        })
        .collect()
}

fn viewpoint(random: &mut Random) -> Viewpoint {
    let mut place = |size: f64| [0; 3].map(|_: i32| size * random.signed());
    let (near, far, direction) = (place(2.0), place(20.0), place(1.0));
    [
        Viewpoint::Eye(near),
        Viewpoint::Eye(far),
        Viewpoint::Direction(direction),
    ][random.below(3)]
}

/// How much of the front a viewer sees: above 0 where a point shows its front.
fn side(viewpoint: &Viewpoint, point: &SurfacePoint) -> f64 {
    match *viewpoint {
        Viewpoint::Direction(sight) => -dot(sight, point.normal),
        Viewpoint::Eye(eye) => dot([0, 1, 2].map(|i| eye[i] - point.position[i]), point.normal),
    }
}

/// The facing by samples; `None` where there are both sides.
fn by_samples(viewpoint: &Viewpoint, points: &[SurfacePoint]) -> Option<Facing> {
    let fronts = points
        .iter()
        .filter(|point| side(viewpoint, point) > 0.0)
        .count();
    match fronts {
        0 => Some(Facing::Back),
        _ => (fronts == points.len()).then_some(Facing::Front),
    }
}

#[test]
fn facing_is_never_wrong_and_seldom_undecided() {
    let mut random = Random::new(8);
    for (name, mesh) in models() {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let points = sampled(&surface, &mesh);
        let cones: Vec<_> = (0..mesh.face_count() as u32)
            .map(|face| surface.normal_cone(FaceId(face)))
            .collect();
        let (mut decided, mut mixed, mut undecided, mut by_cone) = ([0, 0], 0, 0, 0);
        for _ in 0..25 {
            let viewpoint = viewpoint(&mut random);
            for (face, points) in points.iter().enumerate() {
                let truth = by_samples(&viewpoint, points);
                let found = surface.facing(FaceId(face as u32), &viewpoint);
                let cone = cones[face].map_or(Facing::Undecided, |cone| cone.facing(&viewpoint));
                for facing in [found, cone]
                    .into_iter()
                    .filter(|&facing| facing != Facing::Undecided)
                {
                    assert_eq!(
                        Some(facing),
                        truth,
                        "{name}, face {face} from {viewpoint:?}"
                    );
                }
                match truth {
                    None => mixed += 1,
                    Some(side) => decided[usize::from(side == Facing::Back)] += 1,
                }
                undecided += usize::from(truth.is_some() && found == Facing::Undecided);
                by_cone += usize::from(truth.is_some() && cone == Facing::Undecided);
            }
        }
        println!(
            "{name}: {decided:?} one side, {mixed} both; undecided of the former {undecided}, by cones {by_cone}"
        );
        above!(decided[0], 20, "{name}");
        above!(decided[1], 20, "{name}");
        above!(mixed, 5, "{name}");
        // At creases and boundaries irregular vertices stay undecided.
        let is_smooth = !["sheet", "creased"].contains(&name);
        assert!(
            !is_smooth || undecided <= mixed / 5,
            "{name}: {undecided} undecided, {decided:?} {mixed}"
        );
    }
}

#[test]
fn all_faces_at_once_are_each_one_by_one() {
    for (name, mesh) in models() {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let viewpoint = Viewpoint::Eye([2.0, -7.0, 3.0]);
        let each =
            (0..mesh.face_count() as u32).map(|face| surface.facing(FaceId(face), &viewpoint));
        assert_eq!(
            surface.facing_of_all(&viewpoint),
            each.collect::<Vec<_>>(),
            "{name}"
        );
        let mut told = 0;
        let found = surface.facing_of_all_observed(&viewpoint, &mut |progress| {
            told = progress.done;
            ControlFlow::Continue(())
        });
        assert!(found.is_ok() && told == mesh.face_count(), "{name}: {told}");
        assert!(
            surface
                .facing_of_all_observed(&viewpoint, &mut |_| ControlFlow::Break(()))
                .is_err()
        );
    }
}

#[test]
fn cones_hold_the_normals_and_are_hardly_wider_than_needed() {
    let mut ratios = Vec::new();
    let mut half_angles = Vec::new();
    for (name, mesh) in models() {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        for (face, points) in sampled(&surface, &mesh).iter().enumerate() {
            let Some(cone) = surface.normal_cone(FaceId(face as u32)) else {
                continue;
            };
            assert!((dot(cone.axis, cone.axis) - 1.0).abs() < 1e-14);
            let angles = points
                .iter()
                .map(|point| dot(cone.axis, point.normal).clamp(-1.0, 1.0).acos());
            let sampled = angles.fold(0.0, f64::max);
            // An arc cosine near 1 keeps half of the digits.
            at_most!(sampled, cone.half_angle + 2e-8, "{name}, face {face}");
            ratios.push(cone.half_angle / sampled);
            half_angles.push(cone.half_angle);
        }
    }
    ratios.sort_by(f64::total_cmp);
    half_angles.sort_by(f64::total_cmp);
    let median = |all: &[f64]| all[all.len() / 2];
    println!(
        "{} cones: half angles {:.2} degrees at the median, {:.3} times sampled ones, {:.3} at most",
        ratios.len(),
        median(&half_angles).to_degrees(),
        median(&ratios),
        ratios[ratios.len() - 1]
    );
    above!(ratios.len(), 80);
    below!(median(&ratios), 1.35);
}

/// At the size of atoms and of galaxies, and far from the origin, the answers are those at size 1, or none.
#[test]
fn sizes_and_places_do_not_matter() {
    let mesh = octahedron();
    let viewpoint =
        |size: f64, from: f64| Viewpoint::Eye([2.0 * size + from, 0.3 * size, 0.1 * size]);
    let all = |size: f64, from: f64| {
        let positions = mesh
            .positions()
            .iter()
            .map(|p| [p[0] * size + from, p[1] * size, p[2] * size]);
        let mesh = Mesh::from_triangles(positions.collect(), mesh.triangles().to_vec()).unwrap();
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        (0..8)
            .map(|face| surface.facing(FaceId(face), &viewpoint(size, from)))
            .collect::<Vec<_>>()
    };
    let plain = all(1.0, 0.0);
    assert!(plain.contains(&Facing::Back));
    for (size, from) in [
        (1e-120, 0.0),
        (1e120, 0.0),
        (1.0, 1e6),
        (1e-200, 0.0),
        (1.0, 1e15),
    ] {
        for (found, expected) in all(size, from).into_iter().zip(&plain) {
            assert!(
                found == *expected || found == Facing::Undecided,
                "{size} {from}"
            );
        }
    }
    assert_eq!(all(1e-120, 0.0), plain);
    assert_eq!(all(1.0, 10.0), plain);
}

#[test]
fn what_is_not_known_is_undecided() {
    let mesh = octahedron();
    let viewpoint = Viewpoint::Eye([5.0, 5.0, 5.0]);
    let butterfly = LimitSurface::new(&mesh, &ModifiedButterfly).unwrap();
    assert_eq!(butterfly.facing(FaceId(0), &viewpoint), Facing::Undecided);
    assert_eq!(butterfly.normal_cone(FaceId(0)), None);
    let warren = LimitSurface::new(&mesh, &LoopWarren).unwrap();
    assert_eq!(warren.facing(FaceId(0), &viewpoint), Facing::Front);
    assert_eq!(warren.facing(FaceId(99), &viewpoint), Facing::Undecided);
    for nonsense in [f64::NAN, f64::INFINITY] {
        assert_eq!(
            warren.facing(FaceId(0), &Viewpoint::Eye([nonsense; 3])),
            Facing::Undecided
        );
        assert_eq!(
            warren.facing(FaceId(0), &Viewpoint::Direction([nonsense; 3])),
            Facing::Undecided
        );
    }
    assert_eq!(
        warren.facing(FaceId(0), &Viewpoint::Direction([0.0; 3])),
        Facing::Undecided
    );
    // All points are one.
    let speck = Mesh::from_triangles(vec![[1.0; 3]; 6], mesh.triangles().to_vec()).unwrap();
    let surface = LimitSurface::new(&speck, &Loop).unwrap();
    assert_eq!(surface.facing(FaceId(0), &viewpoint), Facing::Undecided);
    assert_eq!(surface.normal_cone(FaceId(0)), None);
}
