//! Creases by angle and boundary rules, against exact shapes.

use std::f64::consts::TAU;

use limitmesh::mesh::{BoundaryRule, BuildOptions, PolygonFaces};
use limitmesh::refine::limit_reference;
use limitmesh::scheme::{Loop, ModifiedButterfly, Scheme};
use limitmesh::{Mesh, PolygonSoup};

use crate::support::*;

const DEGREE: f64 = TAU / 360.0;

fn refined(mesh: &Mesh, scheme: &dyn Scheme, levels: usize) -> Mesh {
    let mesh = limit_reference(mesh, scheme, levels).unwrap();
    mesh.validate().unwrap();
    mesh
}

#[test]
fn a_cube_with_creases_stays_the_cube() {
    let soup = limitmesh_models::find("cube").unwrap().soup();
    let cube = Mesh::from_soup(&soup, &BuildOptions::default()).unwrap().0;
    let cube = cube.with_creases_above(30.0 * DEGREE).unwrap();
    assert_eq!(cube.tags().creases.len(), 12);
    for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
        let mesh = refined(&cube, scheme, 4);
        let mut volume = 0.0;
        for p in mesh.positions() {
            let far = p.iter().fold(0.0, |far: f64, x| far.max(x.abs()));
            assert!(
                (far - 0.5).abs() < 1e-15,
                "{}: {p:?} is off the cube",
                scheme.name()
            );
        }
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|v| mesh.positions()[v as usize]);
            let cross = [
                b[1] * c[2] - b[2] * c[1],
                b[2] * c[0] - b[0] * c[2],
                b[0] * c[1] - b[1] * c[0],
            ];
            volume += (0..3).map(|axis| a[axis] * cross[axis]).sum::<f64>() / 6.0;
        }
        assert!(
            (volume - 1.0).abs() < 1e-13,
            "{}: volume {volume}",
            scheme.name()
        );
    }
}

const SEGMENTS: u32 = 16;

/// A closed cylinder around the z axis, from −1 to 1: rings of vertices, and flat caps round a middle vertex each.
fn cylinder() -> Mesh {
    const RINGS: u32 = 5;
    let mut positions = Vec::new();
    for ring in 0..RINGS {
        for i in 0..SEGMENTS {
            let (sine, cosine) = (TAU * f64::from(i) / f64::from(SEGMENTS)).sin_cos();
            positions.push([cosine, sine, f64::from(ring) / 2.0 - 1.0]);
        }
    }
    let at = |ring: u32, i: u32| ring * SEGMENTS + i % SEGMENTS;
    let middle = RINGS * SEGMENTS;
    positions.extend([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]);
    let mut triangles = Vec::new();
    for i in 0..SEGMENTS {
        for ring in 1..RINGS {
            let [a, b, c, d] = [
                at(ring - 1, i),
                at(ring - 1, i + 1),
                at(ring, i + 1),
                at(ring, i),
            ];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([middle, at(0, i + 1), at(0, i)]);
        triangles.push([middle + 1, at(RINGS - 1, i), at(RINGS - 1, i + 1)]);
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// A closed polygon after so many refinements as a cubic B-spline, and then its points on the limit curve.
fn spline(mut points: Vec<[f64; 2]>, levels: usize) -> Vec<[f64; 2]> {
    let weigh = |weights: [f64; 3], points: &[[f64; 2]], i: usize| -> [f64; 2] {
        let n = points.len();
        let around = [points[(i + n - 1) % n], points[i], points[(i + 1) % n]];
        [0, 1].map(|axis| (0..3).map(|j| weights[j] * around[j][axis]).sum())
    };
    for _ in 0..levels {
        let refined = |i: usize| {
            [
                weigh([0.125, 0.75, 0.125], &points, i),
                weigh([0.0, 0.5, 0.5], &points, i),
            ]
        };
        points = (0..points.len()).flat_map(refined).collect();
    }
    (0..points.len())
        .map(|i| weigh([1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0], &points, i))
        .collect()
}

#[test]
fn a_cylinder_with_creases_gets_round_and_keeps_its_flat_caps_and_sharp_rims() {
    let cylinder = cylinder().with_creases_above(30.0 * DEGREE).unwrap();
    assert_eq!(cylinder.tags().creases.len(), 2 * SEGMENTS as usize);
    const LEVELS: usize = 4;
    let mesh = refined(&cylinder, &Loop, LEVELS);
    let polygon: Vec<[f64; 2]> = cylinder.positions()[..SEGMENTS as usize]
        .iter()
        .map(|p| [p[0], p[1]])
        .collect();
    let rim = spline(polygon, LEVELS);
    for z in [-1.0, 1.0] {
        let on_cap: Vec<Point> = mesh
            .positions()
            .iter()
            .copied()
            .filter(|p| (p[2] - z).abs() < 1e-12)
            .collect();
        // The middle's fan of the cap, refined as a disc of triangles.
        let side = 1 << LEVELS;
        assert_eq!(on_cap.len(), SEGMENTS as usize * side * (side + 1) / 2 + 1);
        for q in &rim {
            let nearest = on_cap
                .iter()
                .map(|&p| distance(p, [q[0], q[1], z]))
                .fold(f64::MAX, f64::min);
            assert!(nearest < 1e-13, "the rim passes {q:?} at {nearest}");
        }
        let reach = on_cap.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
        assert!(
            rim.iter().any(|q| (q[0].hypot(q[1]) - reach).abs() < 1e-13),
            "nothing beyond the rim"
        );
    }
    // Between the rims it is round: all points between the spline's least and greatest radius.
    let radii = || rim.iter().map(|q| q[0].hypot(q[1]));
    let (least, most) = (
        radii().fold(f64::MAX, f64::min),
        radii().fold(0.0, f64::max),
    );
    assert!(most - least < 1e-3);
    for p in mesh.positions().iter().filter(|p| p[2].abs() < 0.999_999) {
        let radius = p[0].hypot(p[1]);
        above!(radius, least - 5e-3, "{p:?}");
        below!(radius, most + 5e-3, "{p:?}");
    }
}

#[test]
fn an_angle_above_all_gives_no_creases_and_angles_out_of_range_are_refused() {
    assert!(
        octahedron()
            .with_creases_above(3.1)
            .unwrap()
            .tags()
            .is_empty()
    );
    assert_eq!(
        octahedron()
            .with_creases_above(1.0)
            .unwrap()
            .tags()
            .creases
            .len(),
        12
    );
    for angle in [-0.1, 3.2, f64::NAN] {
        assert!(octahedron().with_creases_above(angle).is_err());
    }
}

#[test]
fn fixed_boundaries_keep_their_polygon() {
    let sheet = sheet(3, 4, 5);
    let topology = sheet.topology();
    let edges: Vec<[Point; 2]> = topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none())
        .map(|h| topology.ends(h).map(|v| sheet.positions()[v.index()]))
        .collect();
    let off = |p: Point| {
        let to_edge = |[a, b]: [Point; 2]| distance(a, p) + distance(p, b) - distance(a, b);
        edges
            .iter()
            .map(|&edge| to_edge(edge))
            .fold(f64::MAX, f64::min)
    };
    for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
        let mesh = refined(&sheet.clone().with_boundary(BoundaryRule::Fixed), scheme, 4);
        let mut count = 0;
        for v in mesh
            .topology()
            .vertices()
            .filter(|&v| mesh.topology().is_boundary(v))
        {
            count += 1;
            assert!(
                off(mesh.positions()[v.index()]) < 1e-12,
                "{}: {v} is off",
                scheme.name()
            );
        }
        assert_eq!(count, 16 * edges.len());
    }
}

#[test]
fn corners_of_a_boundary_are_kept_and_the_rest_is_smooth() {
    let sheet = sheet(3, 4, 5);
    let kept = sheet.clone().with_boundary(BoundaryRule::Corners);
    let topology = sheet.topology();
    let (with, without) = (refined(&kept, &Loop, 2), refined(&sheet, &Loop, 2));
    for v in topology.vertices().filter(|&v| topology.is_boundary(v)) {
        let in_one_face = topology.outgoing_ring(v).count() == 1;
        let (kept, smooth) = (with.positions()[v.index()], without.positions()[v.index()]);
        assert_eq!(kept == sheet.positions()[v.index()], in_one_face);
        if !in_one_face {
            assert!(distance(kept, smooth) < 1e-15);
        }
    }
    assert_eq!(sheet.clone().with_boundary(BoundaryRule::Smooth), sheet);
}

#[test]
fn cut_sheets_stay_together_where_creases_run_into_the_cut() {
    // Three bent sheets on one polyline, with creases of all kinds that end on it.
    let mut positions: Vec<Point> = (0..5)
        .map(|i| [f64::from(i), 0.2 * f64::from(i * i % 3), 0.1 * f64::from(i)])
        .collect();
    let mut faces = PolygonFaces::default();
    for sheet in 0..3u32 {
        let (sine, cosine) = (TAU * f64::from(sheet) / 3.0).sin_cos();
        let first = positions.len() as u32;
        positions
            .extend((0..5).map(|i| [f64::from(i) + 0.3, cosine + 0.1 * f64::from(i % 2), sine]));
        for i in 0..4 {
            faces.push(&[i, i + 1, first + i + 1]);
            faces.push(&[i, first + i + 1, first + i]);
        }
    }
    let crease = |a: u32, b: u32, sharpness| crate::support::crease([a, b], sharpness);
    let creases = vec![
        crease(1, 6, 0.5),
        crease(1, 7, 1.7),
        crease(2, 7, f64::INFINITY),
        crease(2, 12, 1.3),
        crease(3, 18, 2.0),
    ];
    let soup = PolygonSoup {
        positions,
        faces,
        creases: creases.clone(),
        ..PolygonSoup::default()
    };
    let (mesh, diagnosis) = Mesh::from_soup(&soup, &BuildOptions::default()).unwrap();
    assert!(!mesh.junctions().is_empty() && diagnosis.dropped_tags.is_empty());
    for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
        for levels in 0..=4 {
            // Checks that copies coincide and cut edges have the same ends.
            let mesh = divided(&mesh, scheme, levels);
            mesh.validate().unwrap();
            // Nothing had to be joined: each copy alone has the common limit.
            let limits = limitmesh::limit::LimitTable::new(scheme)
                .positions(&mesh)
                .unwrap();
            for group in mesh.junctions().vertices.iter() {
                let off = group
                    .iter()
                    .map(|&v| distance(limits[v as usize], limits[group[0] as usize]));
                let off = off.fold(0.0, f64::max);
                assert!(
                    off < 1e-13,
                    "{} at level {levels}: copies {group:?} are {off} apart",
                    scheme.name()
                );
            }
        }
    }
    let tagged = mesh
        .clone()
        .with_tags(crate::support::creases(vec![crease(1, 6, 2.5)]));
    refined(&tagged.unwrap_or(mesh), &Loop, 2);
}

/// A sheet with a needle in its middle that stands across it by so much; to the right it is folded by an angle along the needle, and ever less
/// on the way round to the left.
fn needle(height: f64, fold: f64) -> Mesh {
    let right = |x: f64, y: f64, z: f64, part: f64| {
        let (s, c) = (part * fold).sin_cos();
        [c * x - s * z, y, s * x + c * z]
    };
    let mut positions = vec![
        [0.0, 0.0, 0.0],
        [-0.01, -2.0, -height],
        right(0.01, -2.0, height, 1.0),
    ];
    let around = [
        (-45.0, 1.0),
        (-15.0, 0.96),
        (15.0, 0.83),
        (45.0, 0.63),
        (70.0, 0.375),
        (90.0, 0.0),
    ];
    positions.extend(around.map(|(turn, part)| {
        let (s, c) = (turn * DEGREE).sin_cos();
        right(2.5 * c, 2.5 * s, 0.0, part)
    }));
    positions.extend([[-2.0, 2.0, 0.0], [-2.0, -2.0, 0.0]]);
    let last = positions.len() as u32 - 1;
    let triangles = (1..=last)
        .map(|i| [0, i, if i == last { 1 } else { i + 1 }])
        .collect();
    Mesh::from_triangles(positions, triangles).unwrap()
}

#[test]
fn the_sides_of_a_needle_are_no_crease_that_turns_back() {
    let above = |mesh: &Mesh| {
        let found = mesh.creases_above(21.0 * DEGREE).unwrap();
        let ends = found
            .edges
            .iter()
            .map(|&h| mesh.topology().ends(h).map(|v| v.0));
        let mut ends: Vec<[u32; 2]> = ends.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        ends.sort_unstable();
        (ends, found.along_needles)
    };
    // The faces beyond it lie in one plane.
    let flat = needle(0.02, 0.0);
    assert_eq!(above(&flat), (vec![], 2));
    assert!(flat.creases_above(f64::NAN).is_err());
    assert_eq!(
        flat.with_creases_above(20.0 * DEGREE)
            .unwrap()
            .tags()
            .creases
            .len(),
        0
    );
    // Between faces that meet at 48° there is one edge, the sharper one: on the side that the needle leans away from.
    assert_eq!(above(&needle(0.0002, 48.0 * DEGREE)), (vec![[0, 1]], 1));
    assert_eq!(above(&needle(-0.0002, 48.0 * DEGREE)), (vec![[0, 2]], 1));
    // Sides that are not sharp stay so.
    assert_eq!(above(&needle(0.001, 0.0)), (vec![], 0));
}
