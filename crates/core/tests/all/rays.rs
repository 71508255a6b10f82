//! Rays against the limit surface: known points of solids, parity, and a mesh five levels finer, triangle by triangle.

#![allow(clippy::unwrap_used, missing_docs)]

use std::ops::ControlFlow;

use crate::support::{Random, crease, cross, dot, lumpy, minus, octahedron, sheet, torus};
use limitmesh::mesh::CreaseTag;
use limitmesh::refine::limit_reference;
use limitmesh::scheme::{Loop, ModifiedButterfly};
use limitmesh::{Crossing, FaceId, Hit, LimitSurface, Mesh, Ray, RayCaster, RayError, RayOptions};

fn tetrahedron() -> Mesh {
    let positions = vec![
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    Mesh::from_triangles(positions, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]).unwrap()
}

fn tagged(mesh: &Mesh, edges: &[[u32; 2]], sharpness: f64) -> Mesh {
    let mut creases: Vec<CreaseTag> = edges
        .iter()
        .map(|&[a, b]| crease([a.min(b), a.max(b)], sharpness))
        .collect();
    creases.sort_by_key(|crease| crease.vertices);
    mesh.clone()
        .with_tags(crate::support::creases(creases))
        .unwrap()
}

/// Faces of valence 3, 5 and 7 among others: cones over rings of so many vertices, closed below by the mirror image.
fn double_cone(valence: u32) -> Mesh {
    let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(valence);
    let mut positions: Vec<[f64; 3]> = (0..valence)
        .map(|i| [turn(i).cos(), turn(i).sin(), 0.0])
        .collect();
    positions.extend([[0.0, 0.0, 0.8], [0.1, 0.0, -0.7]]);
    let (top, bottom) = (valence, valence + 1);
    let triangles = (0..valence).flat_map(|i| {
        let next = (i + 1) % valence;
        [[i, next, top], [next, i, bottom]]
    });
    Mesh::from_triangles(positions, triangles.collect()).unwrap()
}

fn random_ray(random: &mut Random, (middle, size): ([f64; 3], f64)) -> Ray {
    let mut place = |size: f64| [0; 3].map(|_: i32| size * random.signed());
    let (through, direction) = (place(0.5 * size), place(1.0));
    let through = [0, 1, 2].map(|i| middle[i] + through[i]);
    let length = dot(direction, direction).sqrt().max(1e-3);
    Ray {
        origin: [0, 1, 2].map(|i| through[i] - 10.0 * size * direction[i] / length),
        direction,
    }
}

/// Where a ray meets a triangle, by Möller and Trumbore's formula, and how far from its border that is, as a weight.
fn on_triangle(ray: &Ray, [a, b, c]: [[f64; 3]; 3]) -> Option<(f64, f64)> {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let across = cross(ray.direction, ac);
    let determinant = dot(ab, across);
    let from = minus(ray.origin, a);
    let u = dot(from, across) / determinant;
    let beside = cross(from, ab);
    let v = dot(ray.direction, beside) / determinant;
    let inside = u.min(v).min(1.0 - u - v);
    (inside >= 0.0).then(|| (dot(ac, beside) / determinant, inside))
}

/// A mesh that can be asked for rays: triangles in a grid of boxes, by halves.
pub(crate) struct Fine {
    corners: Vec<[[f64; 3]; 3]>,
    nodes: Vec<BoxNode>,
}

/// A box, the triangles in it, and its halves, if it has any.
struct BoxNode {
    low: [f64; 3],
    high: [f64; 3],
    range: std::ops::Range<usize>,
    children: Option<[usize; 2]>,
}

impl Fine {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let surface = mesh.as_triangles();
        let mut fine = Self {
            corners: (0..mesh.face_count())
                .map(|face| surface.corners(face))
                .collect(),
            nodes: Vec::new(),
        };
        fine.node(0..mesh.face_count());
        fine
    }

    fn node(&mut self, range: std::ops::Range<usize>) -> usize {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &p in self.corners[range.clone()].as_flattened() {
            low = [0, 1, 2].map(|i| p[i].min(low[i]));
            high = [0, 1, 2].map(|i| p[i].max(high[i]));
        }
        let own = self.nodes.len();
        self.nodes.push(BoxNode {
            low,
            high,
            range: range.clone(),
            children: None,
        });
        if range.len() > 8 {
            let sides = minus(high, low);
            let axis = (0..3)
                .max_by(|&a, &b| sides[a].total_cmp(&sides[b]))
                .unwrap();
            self.corners[range.clone()].sort_by(|a, b| a[0][axis].total_cmp(&b[0][axis]));
            let half = range.start + range.len() / 2;
            let children = [self.node(range.start..half), self.node(half..range.end)];
            self.nodes[own].children = Some(children);
        }
        own
    }

    /// How often a ray meets the mesh, and whether that is a close thing: near a border of a front with a back.
    fn count(&self, ray: &Ray) -> (usize, bool) {
        let (mut count, mut is_close, mut waiting) = (0, false, vec![0]);
        while let Some(node) = waiting.pop() {
            let BoxNode {
                low,
                high,
                range,
                children,
            } = &self.nodes[node];
            let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
            for i in 0..3 {
                let [a, b] = [low, high].map(|end| (end[i] - ray.origin[i]) / ray.direction[i]);
                (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
            }
            if first > last * (1.0 + 1e-9) {
                continue;
            }
            if let Some(children) = children {
                waiting.extend(children);
                continue;
            }
            for &corners in &self.corners[range.clone()] {
                let [a, b, c] = corners;
                let normal = cross(minus(b, a), minus(c, a));
                let slope = dot(normal, ray.direction).abs()
                    / (dot(normal, normal) * dot(ray.direction, ray.direction)).sqrt();
                let Some((_, inside)) = on_triangle(ray, corners) else {
                    continue;
                };
                count += 1;
                // Nearly edge-on: the fine mesh may be on the other side of the surface's outline.
                is_close |= slope < 0.03 || inside < 1e-9;
            }
        }
        (count, is_close)
    }
}

pub(crate) fn checked(surface: &LimitSurface<'_>, ray: &Ray, hits: &[Hit], name: &str) {
    for hit in hits {
        let on_ray = [0, 1, 2].map(|i| ray.origin[i] + hit.t * ray.direction[i]);
        let off = minus(on_ray, hit.position);
        assert!(dot(off, off).sqrt() < 1e-7, "{name}: {hit:?} {ray:?}");
        let there = surface.at(hit.face, hit.barycentric);
        assert_eq!(
            (there.position, there.normal),
            (hit.position, hit.normal),
            "{name}"
        );
        let along = dot(hit.normal, ray.direction);
        match hit.crossing {
            Crossing::Entering => assert!(along < 0.0, "{name}: {hit:?}"),
            Crossing::Leaving => assert!(along > 0.0, "{name}: {hit:?}"),
            Crossing::Grazing => {}
        }
    }
    assert!(hits.windows(2).all(|pair| pair[0].t <= pair[1].t));
}

/// Random rays through a mesh and one some levels finer.
fn agrees(name: &str, mesh: &Mesh, count: usize, levels: usize) {
    let surface = LimitSurface::new(mesh, &Loop).unwrap();
    let fine = Fine::of(&limit_reference(mesh, &Loop, levels).unwrap());
    agrees_with(name, &surface, &fine, count);
}

/// Random rays through a surface and a fine mesh of it; few may be a close thing.
pub(crate) fn agrees_with(name: &str, surface: &LimitSurface<'_>, fine: &Fine, count: usize) {
    let (rays, mesh) = (RayCaster::new(surface).unwrap(), surface.control());
    let is_closed = mesh.topology().boundary_edge_count() == 0;
    let [low, high] = mesh.as_triangles().bounding_box().unwrap();
    let middle = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
    let size = 0.5 * mesh.diagonal();
    let (mut random, mut close, mut hit, mut grazed) = (Random::new(31), 0, 0, 0);
    for _ in 0..count {
        let ray = random_ray(&mut random, (middle, size));
        let hits = rays.intersections(&ray, &RayOptions::default());
        checked(surface, &ray, &hits, name);
        grazed += usize::from(hits.iter().any(|hit| hit.crossing == Crossing::Grazing));
        if is_closed {
            assert!(hits.len().is_multiple_of(2), "{name}: {hits:?}");
            let alternate = |(i, hit): (usize, &Hit)| {
                hit.crossing
                    == if i % 2 == 0 {
                        Crossing::Entering
                    } else {
                        Crossing::Leaving
                    }
            };
            assert!(hits.iter().enumerate().all(alternate), "{name}: {hits:?}");
        }
        let (expected, is_close) = fine.count(&ray);
        // A ray that passes an outline by little meets the one and not the other.
        let may_differ = is_close
            || hits.iter().any(|hit| {
                dot(hit.normal, ray.direction).abs()
                    < 0.05 * dot(ray.direction, ray.direction).sqrt()
            });
        assert!(
            may_differ || hits.len() == expected,
            "{name}: {} {expected} {ray:?}",
            hits.len()
        );
        close += usize::from(hits.len() != expected);
        hit += hits.len();
        let first = rays.first(&ray, &RayOptions::default());
        assert_eq!(
            first.map(|hit| hit.t),
            hits.first().map(|hit| hit.t),
            "{name}"
        );
    }
    println!(
        "{name}: {count} rays, {hit} hits, {grazed} grazing, {close} at outlines where the counts differ"
    );
    above!(hit, count / 10, "{name}");
    at_most!(close, count / 100, "{name}");
    assert_eq!(grazed, 0, "{name}");
}

/// In all.
const RAYS: usize = 10_000;

#[test]
fn random_rays_agree_with_a_mesh_five_levels_finer() {
    for valence in [3, 5, 7] {
        agrees(
            &format!("double cone of {valence}"),
            &double_cone(valence),
            RAYS / 5,
            5,
        );
    }
    agrees("lumpy", &lumpy(12, 7), RAYS / 5, 5);
    agrees("torus", &torus(5, 4), RAYS / 5, 5);
}

#[test]
fn boundaries_and_creases_are_met_as_well() {
    agrees("sheet", &sheet(4, 5, 3), 400, 5);
    let edges = [[0, 2], [2, 1], [1, 3], [3, 0]];
    agrees(
        "octahedron with a crease all round",
        &tagged(&octahedron(), &edges, f64::INFINITY),
        400,
        5,
    );
    agrees(
        "one that fades",
        &tagged(&octahedron(), &edges, 1.7),
        300,
        5,
    );
    agrees(
        "a dart",
        &tagged(&octahedron(), &edges[..1], f64::INFINITY),
        300,
        5,
    );
}

/// By closed forms of Loop's limits: vertices, middles of edges and of faces of the solids.
#[test]
fn rays_through_known_points_of_solids() {
    let far = |p: [f64; 3]| Ray {
        origin: p.map(|x| 10.0 * x),
        direction: p.map(|x| -x),
    };
    let radii = |mesh: &Mesh, towards: [f64; 3]| {
        let surface = LimitSurface::new(mesh, &Loop).unwrap();
        let length = dot(towards, towards).sqrt();
        let ray = far(towards.map(|x| x / length));
        let hits = surface.intersections(&ray, &RayOptions::default()).unwrap();
        checked(&surface, &ray, &hits, "solid");
        let [first, last] = [hits[0], hits[hits.len() - 1]];
        assert_eq!(
            (hits.len(), first.crossing, last.crossing),
            (2, Crossing::Entering, Crossing::Leaving),
            "{hits:?}"
        );
        [10.0 - first.t, last.t - 10.0]
    };
    let near =
        |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    let near_all =
        |found: [f64; 2], expected: f64| found.into_iter().for_each(|found| near(found, expected));
    let octahedron = octahedron();
    for axis in 0..3 {
        let towards = [0, 1, 2].map(|i| if i == axis { 1.0 } else { 0.0 });
        near_all(radii(&octahedron, towards), 24.0 / 55.0);
        let towards = [0, 1, 2].map(|i| if i == axis { 0.0 } else { 1.0 });
        near_all(radii(&octahedron, towards), 75.0 * 2f64.sqrt() / 256.0);
    }
    near_all(radii(&octahedron, [1.0; 3]), 271.0 * 3f64.sqrt() / 1152.0);
    let tetrahedron = tetrahedron();
    let [vertex, face] = radii(&tetrahedron, [1.0; 3]);
    near(vertex, 3f64.sqrt() / 5.0);
    near(face, 97.0 * 3f64.sqrt() / 648.0);
    near_all(radii(&tetrahedron, [1.0, 0.0, 0.0]), 7.0 / 24.0);
}

#[test]
fn the_search_can_be_cancelled_while_it_is_prepared() {
    let mesh = lumpy(12, 7);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let mut never = |_: &limitmesh::progress::Progress| ControlFlow::Break(());
    assert!(matches!(
        RayCaster::new_observed(&surface, &mut never),
        Err(RayError::Cancelled(_))
    ));
}

#[test]
fn ranges_of_rays_count() {
    let mesh = octahedron();
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let ray = Ray {
        origin: [0.0, 0.01, 0.02],
        direction: [2.0, 0.1, 0.0],
    };
    let count = |from, to| {
        rays.intersections(&ray, &RayOptions::default().between(from, to))
            .len()
    };
    assert_eq!(
        (
            count(0.0, f64::INFINITY),
            count(f64::NEG_INFINITY, f64::INFINITY)
        ),
        (1, 2)
    );
    assert_eq!(
        (count(0.0, 0.1), count(0.3, 9.0), count(-0.1, 0.1)),
        (0, 0, 0)
    );
    let hit = rays.first(&ray, &RayOptions::default()).unwrap();
    assert!(hit.crossing == Crossing::Leaving && (hit.position[0] - 2.0 * hit.t).abs() < 1e-9);
}

/// At any size and place, from afar.
#[test]
fn sizes_and_places_do_not_matter() {
    let base = lumpy(7, 4);
    let hits = |size: f64, shift: f64, away: f64| {
        let positions = base.positions().iter().map(|p| p.map(|x| size * x + shift));
        let mesh = Mesh::from_triangles(positions.collect(), base.triangles().to_vec()).unwrap();
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let at = |p: [f64; 3]| p.map(|x| size * x + shift);
        let ray = Ray {
            origin: at([-away, 0.03, 0.05]),
            direction: [size * 1e3, 0.0, 0.0],
        };
        let hits = surface.intersections(&ray, &RayOptions::default()).unwrap();
        hits.iter()
            .map(|hit| (hit.face, hit.crossing, hit.barycentric))
            .collect::<Vec<_>>()
    };
    let plain = hits(1.0, 0.0, 3.0);
    assert!(plain.len() >= 2);
    for (size, shift, away) in [
        (1e-120, 0.0, 3.0),
        (1e120, 0.0, 3.0),
        (1.0, 1000.0, 3.0),
        (1.0, 0.0, 1e5),
    ] {
        let found = hits(size, shift, away);
        assert_eq!(found.len(), plain.len(), "{size} {shift} {away}");
        for (found, plain) in found.iter().zip(&plain) {
            assert_eq!(
                (found.0, found.1),
                (plain.0, plain.1),
                "{size} {shift} {away}"
            );
            assert!(
                (0..3).all(|i| (found.2[i] - plain.2[i]).abs() < 1e-6),
                "{found:?} {plain:?}"
            );
        }
    }
}

/// A square that is flat in z = 0, seen edge-on, and rays that touch a lattice's paraboloid.
#[test]
fn what_is_grazed_is_told() {
    let flat = {
        let mesh = sheet(3, 3, 1);
        let positions = mesh.positions().iter().map(|p| [p[0], p[1], 0.0]).collect();
        Mesh::from_triangles(positions, mesh.triangles().to_vec()).unwrap()
    };
    let surface = LimitSurface::new(&flat, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let ray = Ray {
        origin: [-5.0, 1.43, 0.0],
        direction: [1.0, 0.013, 0.0],
    };
    let hits = rays.intersections(&ray, &RayOptions::default());
    assert!(!hits.is_empty());
    assert!(hits.iter().all(|hit| hit.crossing == Crossing::Grazing));
    let above = Ray {
        origin: [-5.0, 1.43, 1e-6],
        direction: [1.0, 0.013, 0.0],
    };
    assert!(
        rays.intersections(&above, &RayOptions::default())
            .is_empty()
    );

    // The outline of a smooth body: from a point of it along a tangent.
    let mesh = lumpy(7, 4);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let at = surface.derivatives(FaceId(3), [0.31, 0.27, 0.42]).unwrap();
    let curvature = at.curvature().unwrap();
    let direction = curvature.directions[0];
    let origin = [0, 1, 2].map(|i| at.position[i] - direction[i]);
    let options = RayOptions::default().tolerance(1e-8);
    let hits = rays.intersections(&Ray { origin, direction }, &options);
    let grazes = hits
        .iter()
        .any(|hit| hit.crossing == Crossing::Grazing && (hit.t - 1.0).abs() < 1e-3);
    assert!(grazes, "{hits:?}");
}

#[test]
fn many_rays_at_once_are_each_one_by_one() {
    let mesh = lumpy(9, 5);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let (mut random, options) = (Random::new(2), RayOptions::default());
    let many: Vec<Ray> = (0..300)
        .map(|_| random_ray(&mut random, ([0.0; 3], 1.0)))
        .collect();
    let all = rays.intersections_of_all(&many, &options);
    assert!(all.iter().any(|hits| hits.is_empty()) && all.iter().any(|hits| hits.len() > 1));
    assert_eq!(
        all,
        many.iter()
            .map(|ray| rays.intersections(ray, &options))
            .collect::<Vec<_>>()
    );
    let mut told = 0;
    let found = rays.intersections_of_all_observed(&many, &options, &mut |progress| {
        told = progress.done;
        ControlFlow::Continue(())
    });
    assert!(found.is_ok() && told == many.len(), "{told}");
    let stopped =
        rays.intersections_of_all_observed(&many, &options, &mut |_| ControlFlow::Break(()));
    assert!(stopped.is_err());
}

#[test]
fn what_cannot_be_met_is_not() {
    let mesh = octahedron();
    let butterfly = LimitSurface::new(&mesh, &ModifiedButterfly).unwrap();
    assert!(matches!(
        RayCaster::new(&butterfly),
        Err(RayError::Scheme { .. })
    ));
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    for (origin, direction) in [
        ([0.0; 3], [0.0; 3]),
        ([f64::NAN; 3], [1.0; 3]),
        ([0.0; 3], [f64::NAN; 3]),
        ([f64::INFINITY; 3], [1.0; 3]),
        ([9.0; 3], [1.0; 3]),
    ] {
        assert!(
            rays.intersections(&Ray { origin, direction }, &RayOptions::default())
                .is_empty()
        );
    }
    let ray = Ray {
        origin: [9.0; 3],
        direction: [-1.0; 3],
    };
    for tolerance in [f64::NAN, -1.0, 0.0] {
        assert_eq!(
            rays.intersections(&ray, &RayOptions::default().tolerance(tolerance))
                .len(),
            2
        );
    }
    let empty = Mesh::from_triangles(Vec::new(), Vec::new()).unwrap();
    let surface = LimitSurface::new(&empty, &Loop).unwrap();
    assert!(
        surface
            .intersections(&ray, &RayOptions::default())
            .unwrap()
            .is_empty()
    );
}
