use limitmesh::mesh::Tags;
use limitmesh::refine::{RefineError, Refinement, Stop, UniformOptions};
use limitmesh::sqrt3::uniform;
use limitmesh::{Mesh, VertexId};

use crate::sqrt3::models::{creased, junction, sharp, smooth, tetrahedron};
use crate::sqrt3::plain::{Plain, step};
use crate::support::{crease, distance, octahedron, sheet, unnumbered};

pub(crate) fn levels(mesh: &Mesh, levels: usize) -> Refinement {
    let options = UniformOptions::default()
        .levels(levels)
        .origins(true)
        .max_triangles(None);
    uniform(mesh, &options).unwrap()
}

#[test]
fn steps_are_those_of_a_plain_implementation() {
    for (name, mesh) in smooth() {
        let mut plain = Plain {
            positions: mesh.positions().to_vec(),
            triangles: mesh.triangles().to_vec(),
        };
        for level in 1..=4 {
            plain = step(&plain, level % 2 == 0);
            let expected =
                Mesh::from_triangles(plain.positions.clone(), plain.triangles.clone()).unwrap();
            let found = levels(&mesh, level).mesh;
            found.validate().unwrap();
            assert_eq!(
                unnumbered(&found, 9),
                unnumbered(&expected, 9),
                "{name}, level {level}"
            );
        }
    }
}

#[test]
fn faces_triple_and_boundary_edges_every_second_time() {
    for (name, mesh) in smooth().into_iter().chain(sharp()) {
        let (faces, edges) = (mesh.face_count(), mesh.topology().boundary_edge_count());
        let euler = mesh.topology().euler_characteristic();
        let creases = mesh.tags().creases.len();
        for level in 0..=5usize {
            let refined = levels(&mesh, level).mesh;
            refined.validate().unwrap();
            assert_eq!(
                refined.face_count(),
                faces * 3usize.pow(level as u32),
                "{name}"
            );
            assert_eq!(
                refined.topology().boundary_edge_count(),
                edges * 3usize.pow(level as u32 / 2),
                "{name}"
            );
            assert_eq!(refined.topology().euler_characteristic(), euler, "{name}");
            assert_eq!(
                refined.tags().creases.len(),
                creases * 3usize.pow(level as u32 / 2),
                "{name}"
            );
        }
    }
}

/// A crease that cuts a sheet in two is a boundary of both parts.
#[test]
fn creases_are_boundaries_of_both_sides() {
    let n = 4;
    let whole = sheet(4, n, 3);
    let middle: Vec<[u32; 2]> = (0..n)
        .map(|j| [2 * (n + 1) + j, 2 * (n + 1) + j + 1])
        .collect();
    let ends = [middle[0][0], middle[n as usize - 1][1]];
    let whole = creased(whole, &middle, &ends);
    let side = |keeps: &dyn Fn(u32) -> bool| {
        let triangles = whole
            .triangles()
            .iter()
            .copied()
            .filter(|t| t.iter().all(|&v| keeps(v / (n + 1))));
        let mut triangles: Vec<[u32; 3]> = triangles.collect();
        let mut used: Vec<u32> = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let number = |v: u32| used.binary_search(&v).unwrap() as u32;
        triangles.iter_mut().for_each(|t| *t = t.map(number));
        let positions = used
            .iter()
            .map(|&v| whole.positions()[v as usize])
            .collect();
        creased(
            Mesh::from_triangles(positions, triangles).unwrap(),
            &[],
            &ends.map(number),
        )
    };
    let [left, right] = [side(&|row| row <= 2), side(&|row| row >= 2)];
    for level in 0..=4 {
        let mut parts = unnumbered(&levels(&left, level).mesh, 9);
        parts.extend(unnumbered(&levels(&right, level).mesh, 9));
        parts.sort_unstable();
        assert_eq!(
            unnumbered(&levels(&whole, level).mesh, 9),
            parts,
            "level {level}"
        );
    }
}

#[test]
fn sheets_that_were_cut_apart_stay_together() {
    let mesh = junction();
    let edges: usize = mesh.junctions().edges.iter().map(|group| group.len()).sum();
    for level in 1..=4usize {
        let refined = levels(&mesh, level).mesh;
        refined.validate().unwrap();
        let found: usize = refined
            .junctions()
            .edges
            .iter()
            .map(|group| group.len())
            .sum();
        assert_eq!(found, edges * 3usize.pow(level as u32 / 2), "level {level}");
        assert!(
            refined
                .junctions()
                .edges
                .iter()
                .all(|group| group.len() == 3)
        );
        let options = UniformOptions::default().levels(level).limit(true);
        uniform(&mesh, &options).unwrap().mesh.validate().unwrap();
    }
}

#[test]
fn tags_that_fade_are_refused_by_name() {
    let refuses = |tags: Tags, name: &str| {
        let mesh = octahedron().with_tags(tags).unwrap();
        let error = uniform(&mesh, &UniformOptions::default()).unwrap_err();
        assert!(matches!(error, RefineError::FadingTag { .. }));
        assert!(error.to_string().starts_with(name), "{error}");
    };
    let creases = vec![crease([0, 2], 2.5)];
    refuses(
        Tags {
            creases,
            corners: Vec::new(),
        },
        "the edge from vertex 0 to vertex 2 has the sharpness 2.5",
    );
    let corners = vec![crate::support::corner(3, 9.9)];
    refuses(
        Tags {
            creases: Vec::new(),
            corners,
        },
        "vertex 3 has the sharpness 9.9",
    );
}

#[test]
fn caps_end_before_they_are_passed() {
    let options = UniformOptions::default().levels(5).max_triangles(Some(107));
    let refined = uniform(&tetrahedron(), &options).unwrap();
    assert_eq!(
        (refined.mesh.face_count(), refined.stop),
        (36, Stop::TriangleCap { needed: 108 })
    );
    assert_eq!(refined.steps.len(), 2);
}

/// Two steps split a control face in nine, so that at even levels each triangle is a known part of its own.
#[test]
fn origins_are_places_in_control_faces() {
    for (name, mesh) in smooth().into_iter().chain(sharp()) {
        for level in 0..=4usize {
            let refined = levels(&mesh, level);
            assert_eq!(refined.origins.len(), refined.mesh.vertex_count(), "{name}");
            for v in 0..mesh.vertex_count() {
                let origin = refined.origins[v];
                let corner = origin.barycentric.iter().position(|&w| w == 1.0).unwrap();
                assert_eq!(mesh.triangles()[origin.face as usize][corner], v as u32);
            }
            let share = 9f64.powi(-(level as i32 / 2));
            for (face, &parent) in refined.parents.iter().enumerate() {
                let corners = refined.mesh.triangles()[face];
                let own =
                    corners.map(|v| refined.origins[v as usize].in_face(mesh.triangles(), parent));
                if level % 2 == 0 {
                    let [a, b, c] = own.map(|origin| origin.unwrap().barycentric);
                    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                    below!((area - share).abs(), 1e-12, "{name}, level {level}: {area}");
                } else {
                    assert!(own.iter().flatten().count() >= 2, "{name}, level {level}");
                }
            }
            // Smooth vertices on flat even ground would stay where their origins say; here they are near that.
            for (v, origin) in refined.origins.iter().enumerate() {
                let corners =
                    mesh.triangles()[origin.face as usize].map(|v| mesh.positions()[v as usize]);
                let place = std::array::from_fn(|axis| {
                    (0..3)
                        .map(|i| origin.barycentric[i] * corners[i][axis])
                        .sum()
                });
                let off = distance(place, refined.mesh.positions()[v]);
                assert!(off < 0.5 * mesh.diagonal(), "{name}, level {level}: {off}");
            }
        }
    }
}

/// On a flat regular lattice nothing moves inside, so places are positions.
#[test]
fn origins_are_positions_on_a_flat_lattice() {
    let mesh = crate::sqrt3::limits::lattice(6, |_, _| 0.0);
    for level in 1..=4 {
        let refined = levels(&mesh, level);
        let mut compared = 0;
        for (v, origin) in refined.origins.iter().enumerate() {
            let corners = mesh.triangles()[origin.face as usize];
            let is_inside = |v: u32| {
                let ring: Vec<VertexId> = mesh.topology().ring(VertexId(v)).collect();
                !mesh.topology().is_boundary(VertexId(v))
                    && !ring.iter().any(|&v| mesh.topology().is_boundary(v))
            };
            if !corners.iter().all(|&v| is_inside(v)) {
                continue;
            }
            let place = std::array::from_fn(|axis| {
                (0..3)
                    .map(|i| origin.barycentric[i] * mesh.positions()[corners[i] as usize][axis])
                    .sum()
            });
            assert!(distance(place, refined.mesh.positions()[v]) < 1e-12);
            compared += 1;
        }
        assert!(compared > 10, "{compared}");
    }
}
