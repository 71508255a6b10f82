//! Faces that certainly face away are not divided for their own error: counts against those where
//! backs are seen, and control faces far from anything that shows, found by sampling the limit
//! surface.

#![allow(clippy::unwrap_used, missing_docs)]

use crate::support::{Point, Random, cross, dot, exact, minus};
use limitmesh::criterion::{Camera, View, Viewpoint};
use limitmesh::measure::distances_to;
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Finish, limit_reference};
use limitmesh::scheme::{Loop, ModifiedButterfly};
use limitmesh::{FaceId, LimitSurface, Mesh};

fn built_in(name: &str) -> Mesh {
    Mesh::from_soup(
        &limitmesh_models::find(name).unwrap().soup(),
        &Default::default(),
    )
    .unwrap()
    .0
}

/// Loop's refinement of the control mesh: its surface, with four faces for each one.
fn refined(mesh: &Mesh) -> Mesh {
    let fine = crate::support::brute_force_loop(mesh.positions(), mesh.triangles());
    Mesh::from_triangles(fine.positions, fine.triangles).unwrap()
}

/// Closed ones.
fn models() -> Vec<(&'static str, Mesh)> {
    vec![
        ("octahedron", crate::support::octahedron()),
        ("torus", crate::support::torus(8, 6)),
        ("lumpy", crate::support::lumpy(12, 7)),
        ("cup", built_in("cup")),
        (
            "creased cup",
            built_in("cup")
                .with_creases_above(40f64.to_radians())
                .unwrap(),
        ),
        ("bunny", built_in("bunny")),
    ]
}

/// A camera outside that has all of a mesh in its picture.
fn camera(mesh: &Mesh, random: &mut Random) -> Camera {
    let [low, high] = mesh.as_triangles().bounding_box().unwrap();
    let target = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
    let mut any = || [0, 1, 2].map(|_| random.signed());
    let (away, up) = (any(), any());
    let distance = mesh.diagonal() * (1.0 + 3.0 * random.signed().abs()) / dot(away, away).sqrt();
    let eye = [0, 1, 2].map(|i| target[i] + distance * away[i]);
    let fov_degrees =
        2.0 * (0.55 * mesh.diagonal() / dot(minus(eye, target), minus(eye, target)).sqrt()).atan();
    Camera {
        eye,
        target,
        up,
        fov_degrees: fov_degrees.to_degrees(),
        width: 640,
        height: 640,
    }
}

/// The mesh with an open triangle behind the camera, far away: with it backs may be seen.
fn with_a_stray_triangle(mesh: &Mesh, camera: &Camera) -> Mesh {
    let mut positions = mesh.positions().to_vec();
    let mut triangles = mesh.triangles().to_vec();
    let [x, y, z] = [0, 1, 2].map(|i| camera.eye[i] + 9.0 * (camera.eye[i] - camera.target[i]));
    let first = positions.len() as u32;
    positions.extend([[x, y, z], [x + 1e-3, y, z], [x, y + 1e-3, z + 1e-3]]);
    triangles.push([first, first + 1, first + 2]);
    let tags = mesh.tags().clone();
    Mesh::from_triangles(positions, triangles)
        .unwrap()
        .with_tags(tags)
        .unwrap()
}

#[test]
fn backs_save_triangles_and_never_cost_any() {
    let mut random = Random::new(5);
    for (name, mesh) in models() {
        let (mut closed, mut open) = (0, 0);
        for limit in [0.3, 1.0, 4.0] {
            for finish in [Finish::OnSurface, Finish::Balanced] {
                let camera = camera(&mesh, &mut random);
                let options = ExactOptions::default()
                    .pixels(limit, vec![camera])
                    .finish(finish);
                let seen = exact(&mesh, &Loop, &options).unwrap();
                let all = exact(&with_a_stray_triangle(&mesh, &camera), &Loop, &options).unwrap();
                assert_eq!((seen.stop, all.stop), (ExactStop::Met, ExactStop::Met));
                let [own, other] = [seen, all].map(|result| result.mesh.face_count());
                below!(own, other, "{name}, {limit}, {finish:?}, {camera:?}");
                (closed, open) = (closed + own, open + other);
            }
        }
        println!("{name}: {closed} triangles, {open} where backs are seen");
        assert!(10 * closed < 9 * open, "{name}: {closed} of {open}");
    }
}

/// Parts that one of several cameras sees are refined for it.
#[test]
fn cameras_on_both_sides_see_all() {
    let mesh = crate::support::torus(8, 6);
    let front = camera(&mesh, &mut Random::new(3));
    let eye = [0, 1, 2].map(|i| 2.0 * front.target[i] - front.eye[i]);
    let back = Camera { eye, ..front };
    let count = |cameras: Vec<Camera>| {
        exact(&mesh, &Loop, &ExactOptions::default().pixels(0.3, cameras))
            .unwrap()
            .mesh
            .face_count()
    };
    let (both, one) = (
        count(vec![front, back]),
        count(vec![front]).max(count(vec![back])),
    );
    assert!(4 * both > 5 * one, "{both} {one}");
}

/// The reported distance in space holds for invisible parts, too.
#[test]
fn distances_count_what_nobody_sees() {
    let mut random = Random::new(11);
    for (name, mesh) in models() {
        let camera = camera(&mesh, &mut random);
        let limit = limit_reference(&mesh, &Loop, 4).unwrap();
        for tolerance in [None, Some(1e-3 * mesh.diagonal())] {
            let mut options = ExactOptions::default().pixels(2.0, vec![camera]);
            options.goals.tolerance = tolerance;
            let result = exact(&mesh, &Loop, &options).unwrap();
            let found = distances_to(limit.positions(), result.mesh.as_triangles()).unwrap();
            let found = found.into_iter().fold(0.0, f64::max);
            at_most!(found, result.error.upper, "{name}");
            assert!(
                tolerance.is_none_or(|tolerance| result.error.upper <= tolerance),
                "{name}"
            );
        }
    }
}

/// Sampled points of the surface over a control face and their normals.
const SIDE: u32 = 12;

/// Which control faces look away with a margin: their surface, by samples, and the triangles of their limit corners.
fn looking_away(mesh: &Mesh, viewpoint: &Viewpoint) -> Vec<bool> {
    let surface = LimitSurface::new(mesh, &Loop).unwrap();
    let at = |i: u32, j: u32| [i, j, SIDE - i - j].map(|x| f64::from(x) / f64::from(SIDE));
    let places: Vec<Point> = (0..=SIDE)
        .flat_map(|i| (0..=SIDE - i).map(move |j| at(i, j)))
        .collect();
    let away = |point: Point, normal: Point| {
        let sight = match *viewpoint {
            Viewpoint::Direction(sight) => sight,
            Viewpoint::Eye(eye) => minus(point, eye),
        };
        dot(sight, normal) > 0.02 * dot(sight, sight).sqrt() * dot(normal, normal).sqrt()
    };
    let is_away = |face: usize| {
        let face = FaceId(face as u32);
        let points = surface.at_all(&places.iter().map(|&at| (face, at)).collect::<Vec<_>>());
        let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|at| surface.at(face, at).position);
        away(a, cross(minus(b, a), minus(c, a)))
            && points
                .iter()
                .all(|point| away(point.position, point.normal))
    };
    (0..mesh.face_count()).map(is_away).collect()
}

/// How many faces each face is away from one that is not marked.
fn rings(mesh: &Mesh, marked: &[bool]) -> Vec<usize> {
    let mut rings: Vec<usize> = marked
        .iter()
        .map(|&marked| if marked { usize::MAX } else { 0 })
        .collect();
    let topology = mesh.topology();
    for ring in 0..mesh.face_count() {
        for face in 0..mesh.face_count() {
            if rings[face] != ring {
                continue;
            }
            for corner in 0..3 {
                let twin = topology.twin(limitmesh::HalfEdgeId::of(FaceId(face as u32), corner));
                let Some(beside) = twin.map(|h| h.face().index()) else {
                    continue;
                };
                rings[beside] = rings[beside].min(ring + 1);
            }
        }
    }
    rings
}

/// Neighbours of visible triangles are used as they are, and neighbouring leaves are at most one
/// level apart. So faces farther than that from visible ones are neither divided nor closed.
fn assert_untouched(name: &str, mesh: &Mesh, result: &Exact, viewpoint: &Viewpoint) -> usize {
    let mut counts = vec![0; mesh.face_count()];
    result
        .parents
        .iter()
        .for_each(|&face| counts[face as usize] += 1);
    let away = looking_away(mesh, viewpoint);
    let mut untouched = 0;
    for (face, ring) in rings(mesh, &away).into_iter().enumerate() {
        if away[face] && ring > result.statistics.levels + 1 {
            assert_eq!(
                counts[face], 1,
                "{name}: face {face}, {ring} from what shows, {viewpoint:?}"
            );
            untouched += 1;
        }
    }
    untouched
}

#[test]
fn what_looks_away_is_divided_for_its_neighbours_only() {
    let mut random = Random::new(21);
    let models = [
        (
            "octahedron",
            refined(&refined(&crate::support::octahedron())),
            0.5,
        ),
        ("torus", refined(&crate::support::torus(8, 6)), 0.6),
        (
            "lumpy",
            refined(&refined(&crate::support::lumpy(12, 7))),
            0.5,
        ),
        ("bunny", refined(&built_in("bunny")), 1.0),
    ];
    for (name, mesh, limit) in models {
        let mut untouched = 0;
        for _ in 0..4 {
            let camera = camera(&mesh, &mut random);
            let options = ExactOptions::default().pixels(limit, vec![camera]);
            let result = exact(&mesh, &Loop, &options).unwrap();
            assert!(result.statistics.levels > 0 && result.pixels.unwrap() <= limit);
            untouched += assert_untouched(name, &mesh, &result, &Viewpoint::Eye(camera.eye));
            for viewpoint in [
                Viewpoint::Eye(camera.eye),
                Viewpoint::Direction(minus(camera.target, camera.eye)),
            ] {
                let view = View {
                    viewpoint,
                    dilatation: 1.0,
                };
                let options = ExactOptions::default().angle_seen(12f64.to_radians(), view);
                let result = exact(&mesh, &Loop, &options).unwrap();
                assert_eq!(
                    (result.stop, result.statistics.open_cones),
                    (ExactStop::Met, 0),
                    "{name}"
                );
                untouched += assert_untouched(name, &mesh, &result, &viewpoint);
            }
        }
        println!("{name}: {untouched} faces far from what shows");
        assert!(untouched > mesh.face_count() / 4, "{name}: {untouched}");
    }
}

/// Schemes of which nothing is proven go by the normals at corners.
#[test]
fn other_schemes_leave_backs_coarse_too() {
    let mesh = crate::support::octahedron();
    let camera = camera(&mesh, &mut Random::new(2));
    let options = ExactOptions::default().pixels(1.0, vec![camera]);
    let seen = exact(&mesh, &ModifiedButterfly, &options).unwrap();
    let all = exact(
        &with_a_stray_triangle(&mesh, &camera),
        &ModifiedButterfly,
        &options,
    )
    .unwrap();
    assert!(10 * seen.mesh.face_count() < 9 * all.mesh.face_count());
}
