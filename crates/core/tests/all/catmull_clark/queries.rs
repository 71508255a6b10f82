//! Rays, closest points, what is inside, area, volume and curvature of Catmull–Clark's surfaces, beside plain subdivision and closed forms.

use core::f64::consts::{PI, SQRT_2};

use limitmesh::criterion::Viewpoint;
use limitmesh::mesh::{BuildOptions, CreaseTag, PolygonSoup};
use limitmesh::scheme::CatmullClark;
use limitmesh::{
    Crossing, FaceId, Facing, LimitSurface, Membership, Mesh, Proximity, QuadControl, Ray,
    RayCaster, RayOptions,
};

use super::{Plain, creased_cube, cube, distance, mean, near, random_cage, times};
use crate::rays::{Fine, agrees_with, checked};
use crate::support::{Point, Random, cross, dot, minus};

fn control(soup: &PolygonSoup) -> Mesh {
    QuadControl::from_soup(soup, &BuildOptions::default())
        .unwrap()
        .0
        .mesh
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// A cube with each face in nine, the first and the last pulled out: vertices of three, four and five edges.
fn jack() -> PolygonSoup {
    let mut plain = Plain::of(&cube());
    for face in [0, 0, 3] {
        let rim = plain.faces.swap_remove(face);
        let centre = mean(
            &rim.iter()
                .map(|&v| plain.points[v as usize])
                .collect::<Vec<_>>(),
        );
        let first = plain.points.len() as u32;
        for &v in &rim {
            let p = plain.points[v as usize];
            plain
                .points
                .push([0, 1, 2].map(|i| 1.4 * (p[i] + centre[i]) - 0.7 * p[i]));
        }
        for i in 0..4 {
            let next = (i + 1) % 4;
            plain.faces.push(vec![
                rim[i as usize],
                rim[next as usize],
                first + next,
                first + i,
            ]);
        }
        plain.faces.push((first..first + 4).collect());
    }
    let faces: Vec<&[u32]> = plain.faces.iter().map(Vec::as_slice).collect();
    super::soup(&plain.points, &faces)
}

/// Closed surfaces, with and without sharp edges.
fn closed() -> Vec<(&'static str, PolygonSoup)> {
    let mut ridged = jack();
    for at in 0..4 {
        let face = ridged.faces.iter().last().unwrap();
        let vertices = [face[at], face[(at + 1) % 4]];
        ridged.creases.push(CreaseTag {
            vertices,
            sharpness: 10.0,
        });
    }
    vec![
        ("cube", cube()),
        ("creased cube", creased_cube(2.5)),
        ("jack", jack()),
        ("ridged jack", ridged),
    ]
}

/// A cube without two of its sides, and some random cages with holes, triangles, and tags.
fn open() -> Vec<(String, PolygonSoup)> {
    let sides = cube();
    let mut half = sides.clone();
    half.faces = Default::default();
    sides
        .faces
        .iter()
        .skip(2)
        .for_each(|face| half.faces.push(face));
    let cages = (0..6).map(|seed| (format!("cage {seed}"), random_cage(&mut Random::new(seed))));
    [("open cube".to_owned(), half)]
        .into_iter()
        .chain(cages)
        .collect()
}

fn all() -> Vec<(String, PolygonSoup)> {
    let closed = closed().into_iter();
    closed
        .map(|(name, soup)| (name.to_owned(), soup))
        .chain(open())
        .collect()
}

/// Plain subdivision, and how far that is from its own limit.
fn fine(soup: &PolygonSoup, levels: usize) -> (Mesh, f64) {
    let plain = (1..levels).fold(Plain::of(soup), |plain, _| plain.refined());
    let ((coarse, few), (points, triangles)) = (plain.mesh(), plain.refined().mesh());
    let rest = 2.0 * distance((&coarse, &few), (&points, &triangles));
    let faces: Vec<&[u32]> = triangles.iter().map(|corners| &corners[..]).collect();
    let soup = super::soup(&points, &faces);
    let (mesh, _) = Mesh::from_soup(&soup, &BuildOptions::default()).unwrap();
    (mesh, rest)
}

/// Points in and around a mesh.
fn scattered(mesh: &Mesh, count: usize) -> Vec<Point> {
    let [low, high] = mesh.as_triangles().bounding_box().unwrap();
    let mut random = Random::new(5);
    let mut at = |axis: usize| {
        let (middle, half) = (
            0.5 * (low[axis] + high[axis]),
            0.5 * (high[axis] - low[axis]),
        );
        middle + 1.4 * half * random.signed()
    };
    (0..count).map(|_| [0, 1, 2].map(&mut at)).collect()
}

#[test]
fn random_rays_agree_with_plain_subdivision() {
    for (name, soup) in all() {
        let mesh = control(&soup);
        let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
        agrees_with(&name, &surface, &Fine::of(&fine(&soup, 5).0), 400);
    }
}

/// Vertices of three edges and middles of edges and faces, by exact arithmetic.
#[test]
fn rays_through_known_points_of_the_cube() {
    let mesh = control(&cube());
    let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    for (towards, radius) in [
        ([1.0, 0.0, 0.0], 68.0 / 81.0),
        ([0.0, 1.0, -1.0], 395.0 / 648.0 * SQRT_2),
        ([1.0, -1.0, 1.0], 0.75f64.sqrt()),
    ] {
        let direction = towards.map(|x: f64| -x / length(towards));
        let ray = Ray {
            origin: direction.map(|x| -10.0 * x),
            direction,
        };
        let hits = rays.intersections(&ray, &RayOptions::default());
        checked(&surface, &ray, &hits, "cube");
        let [first, last] = hits[..] else {
            panic!("{towards:?}: {hits:?}")
        };
        for (hit, t) in [(first, 10.0 - radius), (last, 10.0 + radius)] {
            assert!((hit.t - t).abs() < 1e-9, "{towards:?}: {hit:?}");
        }
        let crossings = (first.crossing, last.crossing);
        assert_eq!(
            crossings,
            (Crossing::Entering, Crossing::Leaving),
            "{towards:?}"
        );
    }
}

/// Rays along the normals of all vertices, of three, four and five edges, meet them once, and cross the surface there.
#[test]
fn rays_through_vertices_cross_the_surface() {
    let mesh = control(&jack());
    let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    for h in mesh.topology().half_edges() {
        let mut place = [0.0; 3];
        place[h.corner()] = 1.0;
        let point = surface.at(h.face(), place);
        let ray = Ray {
            origin: [0, 1, 2].map(|i| point.position[i] + 2.0 * point.normal[i]),
            direction: point.normal.map(|x| -x),
        };
        let hits = rays.intersections(&ray, &RayOptions::default().between(1.9, 2.1));
        checked(&surface, &ray, &hits, "jack");
        let [hit] = hits[..] else {
            panic!("{h:?}: {hits:?}")
        };
        assert!((hit.t - 2.0).abs() < 1e-9, "{h:?}: {hit:?}");
        assert_eq!(hit.crossing, Crossing::Entering, "{h:?}");
    }
}

/// No point of plain subdivision is nearer than what is certain, and one is about as near as what was found.
#[test]
fn closest_points_are_those_of_plain_subdivision() {
    for (name, soup) in all() {
        let mesh = control(&soup);
        let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
        let proximity = Proximity::new(&surface).unwrap();
        let (fine, rest) = fine(&soup, 5);
        let longest = (0..fine.face_count())
            .map(|face| {
                let [a, b, c] = fine.as_triangles().corners(face);
                [minus(a, b), minus(b, c), minus(c, a)]
                    .map(length)
                    .into_iter()
                    .fold(0.0, f64::max)
            })
            .fold(0.0, f64::max);
        let points = scattered(&mesh, 60);
        for tolerance in [1e-3, 1e-9] {
            for (&point, found) in points
                .iter()
                .zip(proximity.closest(&points, tolerance).unwrap())
            {
                let nearest = fine
                    .positions()
                    .iter()
                    .map(|&at| length(minus(at, point)))
                    .fold(f64::INFINITY, f64::min);
                at_most!(found.lower, nearest + rest, "{name}, {point:?}");
                at_most!(
                    nearest,
                    found.distance + rest + longest,
                    "{name}, {point:?}"
                );
                at_most!(found.lower, found.distance);
                at_most!(
                    found.distance - found.lower,
                    tolerance * 1.000_001,
                    "{name}"
                );
                let there = surface.at(found.face, found.barycentric).position;
                below!(
                    length(minus(there, found.point)),
                    1e-12,
                    "{name}: {there:?}"
                );
                below!(
                    (length(minus(point, there)) - found.distance).abs(),
                    1e-12,
                    "{name}"
                );
            }
        }
    }
}

#[test]
fn the_cube_s_surface_is_as_far_as_it_is() {
    let mesh = control(&cube());
    let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
    let proximity = Proximity::new(&surface).unwrap();
    let corner = [3.0, -3.0, 3.0];
    for (point, distance) in [
        ([0.0, 5.0, 0.0], 5.0 - 68.0 / 81.0),
        ([0.0; 3], 68.0 / 81.0),
        (corner, length(corner) - 0.75f64.sqrt()),
    ] {
        let [found] = proximity.closest(&[point], 1e-11).unwrap()[..] else {
            panic!()
        };
        assert!(
            (found.distance - distance).abs() < 1e-10,
            "{point:?}: {found:?}"
        );
    }
    assert_eq!(
        proximity.membership([0.0, 0.83, 0.0]),
        Ok(Membership::Inside)
    );
    assert_eq!(
        proximity.membership([0.0, 0.85, 0.0]),
        Ok(Membership::Outside)
    );
    let on = surface.at(FaceId(1), [0.2, 0.3, 0.5]).position;
    assert_eq!(proximity.membership(on), Ok(Membership::Near));
}

/// The solid angles of plain subdivision's triangles (van Oosterom and Strackee 1983).
#[test]
fn inside_is_what_plain_subdivision_winds_around() {
    let mut counts = [0; 2];
    for (name, soup) in closed() {
        let mesh = control(&soup);
        let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
        let proximity = Proximity::new(&surface).unwrap();
        let (fine, rest) = fine(&soup, 4);
        for point in scattered(&mesh, 80) {
            let angles = (0..fine.face_count()).map(|face| {
                let [a, b, c] = fine.as_triangles().corners(face).map(|at| minus(at, point));
                let [x, y, z] = [a, b, c].map(length);
                let below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
                2.0 * dot(a, cross(b, c)).atan2(below)
            });
            let turns = (angles.sum::<f64>() / (4.0 * PI)).round();
            let [found] = proximity.closest(&[point], 1e-3).unwrap()[..] else {
                panic!()
            };
            if found.lower <= rest {
                continue;
            }
            counts[usize::from(turns == 1.0)] += 1;
            let winding = proximity.winding_number(point).unwrap().map(f64::from);
            assert_eq!(winding, Some(turns), "{name}: {point:?}");
        }
    }
    assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
}

/// Values of the design for the cube; of others by plain subdivision at two levels, whose errors fall by 4.
#[test]
fn areas_and_volumes_are_those_of_plain_subdivision() {
    let mesh = control(&cube());
    let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
    assert!((surface.area().unwrap() - 9.197_59).abs() < 1e-5);
    assert!((surface.volume().unwrap() - 2.620_419).abs() < 1e-6);
    for (name, soup) in closed() {
        let sizes = [4, 5].map(|levels| {
            let (fine, _) = fine(&soup, levels);
            let corners = (0..fine.face_count()).map(|face| fine.as_triangles().corners(face));
            corners.fold([0.0; 2], |[area, volume], [a, b, c]| {
                let across = cross(minus(b, a), minus(c, a));
                [area + 0.5 * length(across), volume + dot(a, across) / 6.0]
            })
        });
        let mesh = control(&soup);
        let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
        let found = [surface.area().unwrap(), surface.volume().unwrap()];
        for i in 0..2 {
            let [coarse, fine] = sizes.map(|size| size[i]);
            let (expected, error) = (fine + (fine - coarse) / 3.0, 0.02 * (fine - coarse).abs());
            assert!(
                (found[i] - expected).abs() < error,
                "{name}: {found:?} {sizes:?}"
            );
        }
    }
}

/// Curvatures of the design, by exact arithmetic; derivatives everywhere by differences.
#[test]
fn derivatives_are_those_of_the_points() {
    let mesh = control(&cube());
    let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
    for (place, gaussian, mean) in [
        ([0.0, 0.5, 0.5], 0.972_435_132_3, 0.986_121_256_4),
        ([0.5, 0.5, 0.0], 1.922_583_947_2, 1.393_046_881_6),
        ([0.5, 0.0, 0.5], 1.922_583_947_2, 1.393_046_881_6),
    ] {
        for face in 0..12 {
            let found = surface.derivatives(FaceId(face), place).unwrap();
            let bend = found.curvature().unwrap();
            assert!((bend.gaussian - gaussian).abs() < 1e-9, "{bend:?}");
            assert!((bend.mean + mean).abs() < 1e-9, "{bend:?}");
        }
    }
    assert_eq!(surface.derivatives(FaceId(0), [0.0, 1.0, 0.0]), None);
    for (name, soup) in all() {
        let mesh = control(&soup);
        let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
        for face in (0..mesh.face_count() as u32).map(FaceId) {
            let (u, v, step) = (0.31, 0.27, 1e-4);
            let at = |u: f64, v: f64| surface.at(face, [1.0 - u - v, u, v]).position;
            let found = surface.derivatives(face, [1.0 - u - v, u, v]).unwrap();
            let half = |a: Point, b: Point| minus(a, b).map(|x| x / (2.0 * step));
            let first = [
                half(at(u + step, v), at(u - step, v)),
                half(at(u, v + step), at(u, v - step)),
            ];
            for (found, expected) in found.first.into_iter().zip(first) {
                assert!(
                    near(found, expected, 1e-6),
                    "{name}: {found:?} {expected:?}"
                );
            }
            assert!(near(found.position, at(u, v), 1e-13), "{name}");
        }
    }
}

/// What is proven to show one side shows no other, and most faces that do are proven to.
#[test]
fn sides_are_those_of_all_points() {
    let (mut known, mut all_faces) = (0, 0);
    for (name, soup) in all() {
        let mesh = control(&soup);
        let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
        let mut random = Random::new(9);
        for face in (0..mesh.face_count() as u32).map(FaceId) {
            let eye = [0; 3].map(|_| 6.0 * random.signed());
            let viewpoint = match random.below(2) {
                0 => Viewpoint::Eye(eye),
                _ => Viewpoint::Direction(eye),
            };
            let before = |[u, v]: [f64; 2]| {
                let point = surface.at(face, [1.0 - u - v, u, v]);
                match viewpoint {
                    Viewpoint::Eye(_) => dot(minus(eye, point.position), point.normal),
                    Viewpoint::Direction(_) => -dot(eye, point.normal),
                }
            };
            let steps = |i: u32| (0..=20 - i).map(move |j| [i, j].map(|k| f64::from(k) / 20.0));
            let places = (0..=20).flat_map(steps);
            let sides: Vec<f64> = places.map(before).filter(|&side| side != 0.0).collect();
            let side = match () {
                () if sides.iter().all(|&side| side > 0.0) => Facing::Front,
                () if sides.iter().all(|&side| side < 0.0) => Facing::Back,
                () => Facing::Undecided,
            };
            let found = surface.facing(face, &viewpoint);
            assert!(
                found == Facing::Undecided || found == side,
                "{name}, {face:?}"
            );
            if let Some(cone) = surface.normal_cone(face) {
                let by_cone = cone.facing(&viewpoint);
                assert!(by_cone == Facing::Undecided || by_cone == side, "{name}");
            }
            known += usize::from(found != Facing::Undecided);
            all_faces += usize::from(side != Facing::Undecided);
        }
    }
    println!("{known} of {all_faces} sides known");
    assert!(
        all_faces > 100 && 10 * known > 8 * all_faces,
        "{known} of {all_faces}"
    );
}

/// The point is the weighted sum of control points, by another cage's points as well.
#[test]
fn weights_give_the_points() {
    for seed in 0..12 {
        let soup = random_cage(&mut Random::new(seed));
        let mesh = control(&soup);
        let bent = |[x, y, z]: &Point| [x + 0.2 * y * y, y - 0.3 * z * x, 0.7 * z];
        let positions = mesh.positions().iter().map(bent).collect();
        let moved = mesh.clone().with_positions(positions).unwrap();
        let [surface, elsewhere] =
            [&mesh, &moved].map(|mesh| LimitSurface::new(mesh, &CatmullClark).unwrap());
        let weights = [
            [1.0, 0.0, 0.0],
            [0.0, 0.5, 0.5],
            [0.3, 0.6, 0.1],
            [0.01, 0.0, 0.99],
        ];
        let faces = mesh.topology().faces().step_by(5);
        let places: Vec<_> = faces
            .flat_map(|face| weights.map(|place| (face, place)))
            .collect();
        let found = surface.weights_at(&places).unwrap();
        for (&(face, place), weights) in places.iter().zip(&found) {
            let sum: f64 = weights.iter().map(|&(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-12, "cage {seed}: {sum}");
            assert!(weights.iter().all(|&(_, weight)| weight > -1e-15));
            for (mesh, surface) in [(&mesh, &surface), (&moved, &elsewhere)] {
                let points = weights
                    .iter()
                    .map(|&(v, weight)| times(weight, mesh.positions()[v.index()]));
                let expected = surface.at(face, place).position;
                let found = super::sum(points);
                assert!(
                    near(found, expected, 1e-12),
                    "cage {seed}, {face:?}, {place:?}"
                );
            }
        }
    }
}
