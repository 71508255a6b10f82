//! The criteria of Zorin, Schröder and Sweldens and of Müller and Jaeschke: their forest is that of
//! a tower of uniform levels, by brute force.

#![allow(missing_docs, clippy::unwrap_used)]

use std::collections::BTreeSet;

use crate::support::{
    Random, crease, cross, dot, lumpy, minus, octahedron, sheet, tagged_obj, torus,
};
use limitmesh::criterion::Camera;
use limitmesh::front::{Demand, Front, Measure, Snapshot};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::Tags;
use limitmesh::refine::Traced;
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{FaceId, HalfEdgeId, LimitSurface, Mesh, VertexId};

const MEASURES: [Measure; 3] = [
    Measure::PlanarityAngle,
    Measure::PlanarityDistance,
    Measure::VertexError,
];

/// Levels of the towers.
const LEVELS: usize = 4;

fn models() -> Vec<(&'static str, Mesh)> {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n\
        t crease 2/1/0 0 1 2.5\nt crease 2/1/0 1 2 1.5\nt crease 2/1/0 4 5 9\n";
    vec![
        ("octahedron", octahedron()),
        ("torus", torus(6, 5)),
        ("sheet", sheet(3, 4, 3)),
        ("lumpy", lumpy(9, 7)),
        ("creased", creased()),
        ("fading", tagged_obj(cube)),
    ]
}

/// A closed mesh with a crease of two edges that ends in darts. (Corners of four faces and more
/// have no normal, only a substitute, which depends on the level.)
fn creased() -> Mesh {
    let mesh = lumpy(6, 5);
    let h = HalfEdgeId(0);
    let topology = mesh.topology();
    let around: Vec<HalfEdgeId> = topology.outgoing_ring(topology.origin(h)).collect();
    let creases = [around[0], around[around.len() / 2]]
        .map(|h| crease(topology.ends(h).map(|v| v.0), f64::INFINITY));
    let tags = Tags {
        creases: creases.to_vec(),
        corners: Vec::new(),
    };
    mesh.with_tags(tags).unwrap()
}

/// A level of uniform refinement, with the limits of its vertices.
struct Level {
    mesh: Mesh,
    limits: Vec<[f64; 3]>,
    /// By face and corner, on the face's side.
    normals: Vec<[[f64; 3]; 3]>,
}

fn tower(control: &Mesh, scheme: &dyn Scheme) -> Vec<Level> {
    let level = |levels: usize| {
        let mesh = crate::support::divided(control, scheme, levels);
        let table = LimitTable::new(scheme);
        let sided = table.sided_normals(&mesh).unwrap();
        let normals = (0..mesh.face_count())
            .map(|face| {
                [0, 1, 2].map(|i| sided.at(mesh.topology(), HalfEdgeId::of(FaceId(face as u32), i)))
            })
            .collect();
        Level {
            limits: table.positions(&mesh).unwrap(),
            normals,
            mesh,
        }
    };
    (0..=LEVELS).map(level).collect()
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    length(cross(a, b)).atan2(dot(a, b))
}

/// The value of a measure for a face of a level, by its definition.
fn value(tower: &[Level], level: usize, face: usize, measure: Measure) -> f64 {
    let own = &tower[level];
    let triangle = own.mesh.triangles()[face];
    let corners = triangle.map(|v| own.limits[v as usize]);
    let normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    // The middle one of the four faces has the new vertices.
    let finer = &tower[level + 1];
    let middle = 4 * face + 3;
    let values: Vec<f64> = match measure {
        Measure::PlanarityAngle => {
            let all = own.normals[face].into_iter().chain(finer.normals[middle]);
            all.map(|there| angle(normal, there)).collect()
        }
        Measure::PlanarityDistance => finer.mesh.triangles()[middle]
            .map(|v| {
                dot(minus(finer.limits[v as usize], corners[0]), normal).abs() / length(normal)
            })
            .to_vec(),
        _ => triangle
            .map(|v| {
                length(minus(
                    own.mesh.positions()[v as usize],
                    own.limits[v as usize],
                ))
            })
            .to_vec(),
    };
    values.into_iter().fold(0.0, f64::max)
}

/// The least set of faces to divide, by level: what fails, and what must be for neighbours to be one level apart at most.
fn divided(tower: &[Level], limit: f64, measure: Measure) -> Vec<BTreeSet<usize>> {
    let mut all = vec![BTreeSet::new(); LEVELS];
    let mut waiting: Vec<(usize, usize)> = (0..tower[0].mesh.face_count())
        .map(|face| (0, face))
        .collect();
    let mut forced = Vec::new();
    while let Some((level, face)) = waiting.pop() {
        if level < LEVELS && value(tower, level, face, measure) > limit {
            forced.push((level, face));
        }
        while let Some((level, face)) = forced.pop() {
            if !all[level].insert(face) {
                continue;
            }
            waiting.extend((4 * face..4 * face + 4).map(|child| (level + 1, child)));
            if level > 0 {
                forced.push((level - 1, face / 4));
                let topology = tower[level].mesh.topology();
                let edges = [0, 1, 2].map(|i| HalfEdgeId::of(FaceId(face as u32), i));
                let beyond = edges.into_iter().filter_map(|h| topology.twin(h));
                forced.extend(beyond.map(|twin| (level - 1, twin.face().index() / 4)));
            }
        }
    }
    all
}

/// Places in quarters of quarters of a control face, from a vertex's coordinates there; of a vertex of several faces, all.
fn places(control: &Mesh, found: &Snapshot) -> BTreeSet<[(u32, u64); 3]> {
    let scale = f64::from(1u32 << LEVELS);
    let place = |origin: &limitmesh::refine::Origin| {
        let corners = control.triangles()[origin.face as usize];
        let mut named = [0, 1, 2].map(|i| (corners[i], (scale * origin.barycentric[i]) as u64));
        // A point of an edge or a vertex is named by its ends alone, so that it is the same from all sides.
        named
            .iter_mut()
            .filter(|own| own.1 == 0)
            .for_each(|own| own.0 = u32::MAX);
        named.sort_unstable();
        named
    };
    found.origins.iter().map(place).collect()
}

#[test]
fn forests_are_those_of_a_tower_of_uniform_levels() {
    for (name, control) in models() {
        let tower = tower(&control, &Loop);
        for measure in MEASURES {
            let greatest = (0..control.face_count())
                .map(|face| value(&tower, 0, face, measure))
                .fold(0.0, f64::max);
            for part in [0.7, 0.3, 0.08] {
                // No node's value is as near to that as rounding.
                let limit = part * greatest * (1.0 + 1e-7);
                let mut front = Front::measured_by(&control, &Loop, measure).unwrap();
                front
                    .update(&Demand::tolerance(limit).max_levels(LEVELS as u32))
                    .unwrap();
                let found = front.snapshot().unwrap();
                let expected = divided(&tower, limit, measure);
                // Vertices: the control mesh's, and those of the middles of divided faces.
                let mut positions: Vec<[f64; 3]> = tower[0].limits.clone();
                for (level, faces) in expected.iter().enumerate() {
                    let finer = &tower[level + 1];
                    let new: BTreeSet<u32> = faces
                        .iter()
                        .flat_map(|face| finer.mesh.triangles()[4 * face + 3])
                        .collect();
                    positions.extend(new.iter().map(|&v| finer.limits[v as usize]));
                }
                assert_eq!(
                    found.mesh.vertex_count(),
                    positions.len(),
                    "{name} {measure:?} {part}"
                );
                assert_eq!(
                    places(&control, &found).len(),
                    positions.len(),
                    "{name} {measure:?} {part}"
                );
                // Every vertex is one of the tower.
                let near = |p: &[f64; 3]| {
                    positions
                        .iter()
                        .any(|q| length(minus(*p, *q)) < 1e-9 * control.diagonal())
                };
                assert!(
                    found.mesh.positions().iter().all(near),
                    "{name} {measure:?} {part}"
                );
            }
        }
    }
}

#[test]
fn planarity_holds_where_triangles_are_whole_nodes() {
    for (name, control) in models() {
        let limit = 0.25;
        let mut front = Front::measured_by(&control, &Loop, Measure::PlanarityAngle).unwrap();
        front
            .update(&Demand::tolerance(limit).max_levels(7))
            .unwrap();
        let found = front.snapshot().unwrap();
        let surface = LimitSurface::new(&control, &Loop).unwrap();
        let mut whole = 0;
        for face in 0..found.mesh.face_count() {
            let corners = found.mesh.as_triangles().corners(face);
            let origins = [0, 1, 2]
                .map(|i| HalfEdgeId::of(FaceId(face as u32), i))
                .map(|h| found.corner_origin(control.triangles(), h).unwrap());
            // A node's edges are as long as each other in its control face, up to the directions' names.
            let side = |a: usize, b: usize| {
                (0..3)
                    .map(|i| (origins[a].barycentric[i] - origins[b].barycentric[i]).abs())
                    .fold(0.0, f64::max)
            };
            if side(0, 1) != side(1, 2) || side(1, 2) != side(2, 0) || side(0, 1) < 2f64.powi(-6) {
                continue;
            }
            whole += 1;
            let normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
            for origin in origins {
                let there = surface.at(FaceId(origin.face), origin.barycentric);
                // The cone of the paper, without its cosines.
                assert!(
                    angle(normal, there.normal) <= limit + 1e-9,
                    "{name}: {origin:?}"
                );
            }
        }
        assert!(4 * whole > found.mesh.face_count(), "{name}: {whole}");
    }
}

#[test]
fn zero_divides_all_that_is_curved() {
    let control = torus(6, 5);
    for measure in MEASURES {
        let mut front = Front::measured_by(&control, &Loop, measure).unwrap();
        front.update(&Demand::tolerance(0.0).max_levels(3)).unwrap();
        assert_eq!(front.triangles().len(), 64 * control.face_count());
        assert_eq!(
            (front.bound(), front.is_certified()),
            (f64::INFINITY, false)
        );
        assert!(front.worst() > 0.0 && front.worst().is_finite());
    }
    // A plane is flat, and its control points inside are on it; those of its corners, too.
    let plane = sheet(4, 4, 0);
    let flat = plane
        .positions()
        .iter()
        .map(|p| [p[0], p[1], 0.0])
        .collect();
    let plane = Mesh::from_triangles(flat, plane.triangles().to_vec()).unwrap();
    for measure in [Measure::PlanarityAngle, Measure::PlanarityDistance] {
        let mut front = Front::measured_by(&plane, &Loop, measure).unwrap();
        front.update(&Demand::tolerance(1e-9)).unwrap();
        assert_eq!(front.triangles().len(), plane.face_count());
    }
}

/// A control point of valence n comes nearer to its limit by 5/8 − nβ with each level, so the levels are known in advance.
#[test]
fn vertex_errors_shrink_by_the_second_eigenvalue() {
    // The high tip of a double cone over a polygon: others are on the way much faster.
    let valence = 12;
    let mut positions = vec![[0.0, 0.0, 9.0], [0.0, 0.0, -1.0]];
    let mut triangles = Vec::new();
    for i in 0..valence {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(valence);
        positions.push([turn.cos(), turn.sin(), 0.0]);
        let (a, b) = (2 + i, 2 + (i + 1) % valence);
        triangles.extend([[0, a, b], [1, b, a]]);
    }
    let control = Mesh::from_triangles(positions, triangles).unwrap();
    let n = f64::from(valence);
    let inner = 3.0 / 8.0 + (std::f64::consts::TAU / n).cos() / 4.0;
    let rate: f64 = inner * inner;
    let limit = LimitTable::new(&Loop).positions(&control).unwrap()[0];
    let first = length(minus(control.positions()[0], limit));
    for levels in 2..8 {
        // Just not on the level before.
        let tolerance = 0.99 * first * rate.powi(levels - 1);
        let mut front = Front::measured_by(&control, &Loop, Measure::VertexError).unwrap();
        front.update(&Demand::tolerance(tolerance)).unwrap();
        let found = front.snapshot().unwrap();
        // Edges at the tip are 2⁻ˡ as long as those of the control mesh.
        let topology = found.mesh.topology();
        for corner in topology.outgoing_ring(VertexId(0)) {
            let end = found
                .corner_origin(control.triangles(), corner.next())
                .unwrap();
            let tip = control.triangles()[end.face as usize]
                .iter()
                .position(|&v| v == 0)
                .unwrap();
            assert_eq!(1.0 - end.barycentric[tip], 0.5f64.powi(levels));
        }
        assert!(front.worst() <= tolerance);
    }
}

#[test]
fn updates_give_what_a_fresh_front_does() {
    let mut random = Random::new(11);
    let schemes: [&dyn Scheme; 3] = [&Loop, &LoopWarren, &ModifiedButterfly];
    for (name, control) in models() {
        for (measure, scheme) in MEASURES.into_iter().zip(schemes) {
            let unit = if measure == Measure::PlanarityAngle {
                3.0
            } else {
                control.diagonal()
            };
            let mut front = Front::measured_by(&control, scheme, measure).unwrap();
            for step in 0..6 {
                let tolerance = unit * 10f64.powf(-1.6 + 0.6 * random.signed());
                let demand = match step % 3 {
                    0 => Demand::tolerance(tolerance)
                        .triangles(control.face_count() + random.below(500)),
                    _ => Demand::tolerance(tolerance).max_levels(4),
                };
                front.update(&demand).unwrap();
                let mut fresh = Front::measured_by(&control, scheme, measure).unwrap();
                fresh.update(&demand).unwrap();
                assert_eq!(
                    front.mesh().unwrap(),
                    fresh.mesh().unwrap(),
                    "{name} {measure:?} {demand:?}"
                );
            }
        }
    }
}

#[test]
fn snapshots_keep_creases_and_know_where_vertices_are() {
    let control = lumpy(6, 5).with_creases_above(0.9).unwrap();
    let surface = LimitSurface::new(&control, &Loop).unwrap();
    let mut front = Front::measured_by(&control, &Loop, Measure::PlanarityAngle).unwrap();
    front.update(&Demand::tolerance(0.2).max_levels(5)).unwrap();
    let found = front.snapshot().unwrap();
    for (origin, &position) in found.origins.iter().zip(found.mesh.positions()) {
        let there = surface.at(FaceId(origin.face), origin.barycentric);
        assert!(length(minus(there.position, position)) < 1e-9 * control.diagonal());
    }
    // Each crease of the control mesh is one of as many pieces as there are vertices on it, and one.
    let on_edge = |a: u32, b: u32| {
        let inside = found.origins.iter().filter(|origin| {
            let corners = control.triangles()[origin.face as usize];
            let ends = (0..3).filter(|&i| corners[i] == a || corners[i] == b);
            let inner = ends.clone().filter(|&i| origin.barycentric[i] > 0.0);
            inner.count() == 2 && ends.map(|i| origin.barycentric[i]).sum::<f64>() == 1.0
        });
        inside.count() + 1
    };
    let expected: usize = control
        .tags()
        .creases
        .iter()
        .map(|tag| on_edge(tag.vertices[0], tag.vertices[1]))
        .sum();
    assert!(!control.tags().creases.is_empty());
    assert_eq!(found.mesh.tags().creases.len(), expected);
}

#[test]
fn cameras_go_with_distances_alone() {
    let control = octahedron();
    let mut front = Front::measured_by(&control, &Loop, Measure::VertexError).unwrap();
    let camera = Camera {
        eye: [0.0, 0.0, 5.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_degrees: 40.0,
        width: 64,
        height: 64,
    };
    let refused = front.update(&Demand::pixels(1.0, &[camera])).unwrap_err();
    assert!(
        refused.to_string().contains("does not go by distances"),
        "{refused}"
    );
    assert_eq!(front.triangles().len(), control.face_count());
}

#[test]
fn sizes_that_cannot_be_computed_with_are_refused() {
    for size in [1e-160, 1e160] {
        let control = octahedron();
        let positions = control
            .positions()
            .iter()
            .map(|p| p.map(|x| size * x))
            .collect();
        let control = Mesh::from_triangles(positions, control.triangles().to_vec()).unwrap();
        for measure in MEASURES.into_iter().chain([Measure::Distance]) {
            let refused = Front::measured_by(&control, &Loop, measure)
                .map(drop)
                .unwrap_err();
            assert!(refused.to_string().contains("diagonal"), "{refused}");
        }
        let options = limitmesh::sqrt3::Sqrt3Options::default().tolerance(Some(0.1 * size));
        let refused = limitmesh::sqrt3::adaptive(&control, &options)
            .map(drop)
            .unwrap_err();
        assert!(refused.to_string().contains("diagonal"), "{refused}");
    }
}
