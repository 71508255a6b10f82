//! Control meshes of the shared models against the numbers in their `MODELS.md`, which were computed from the
//! files by other means. The folder is named by `LIMITMESH_MODELS`.

use super::support::shared;
use std::collections::HashSet;
use std::path::Path;

use limitmesh::Mesh;
use limitmesh::mesh::{BuildOptions, Diagnosis, Weld};

/// File, triangles, Euler characteristic, boundary loops, components, edges with more than two faces.
type Row = (&'static str, usize, i64, usize, usize, usize);

const MODELS: [Row; 34] = [
    ("mannequin.off", 839, 1, 1, 1, 0),
    ("mannequin_142.off", 142, 1, 1, 1, 0),
    ("boot_684.off", 684, 2, 0, 1, 0),
    ("teddy.obj", 3192, 2, 0, 1, 0),
    ("bunny_3674.obj", 3674, 2, 0, 1, 0),
    ("bunny_1k.off", 1000, 2, 0, 1, 0),
    ("fish_cage.obj", 220, 2, 0, 1, 0),
    ("cup_standin.obj", 720, 0, 0, 1, 0),
    ("radish_standin.obj", 640, 2, 0, 1, 0),
    ("cusp_standin.obj", 480, 2, 0, 1, 0),
    ("sphere_360.obj", 360, 2, 0, 1, 0),
    ("sphere_320.ply", 320, 2, 0, 1, 0),
    ("bob_cage.obj", 668, 0, 0, 1, 0),
    ("skull_low.obj", 10_312, -2, 0, 1, 0),
    ("monsterfrog.obj", 2584, 16, 0, 9, 0),
    ("plane_holes.obj", 16_747, -25, 27, 1, 0),
    ("goathead_be.ply", 5522, 2, 0, 1, 0),
    ("teapot.obj", 6320, -34, 10, 4, 0),
    ("beetle.obj", 2053, -3, 23, 2, 47),
    ("featuretype.stl", 3476, -16, 16, 1, 0),
    ("gcanyon_530k.ply", 530_450, 1, 1, 1, 0),
    ("rook_creased.obj", 1510, 1, 1, 1, 0),
    ("mechpart_creased.obj", 238, -4, 0, 1, 0),
    ("loop_icos_semisharp.obj", 80, 8, 0, 4, 0),
    ("loop_saddle_edgecorner.obj", 4, 1, 1, 1, 0),
    ("loop_pole64.obj", 192, 1, 1, 1, 0),
    ("defects/fan3.obj", 3, 1, 1, 1, 1),
    ("defects/hourglass_ico.obj", 40, 3, 0, 1, 0),
    ("defects/triple_vierbein.obj", 108, 1, 1, 1, 20),
    ("defects/moebius.obj", 448, 0, 1, 1, 0),
    ("defects/deg_faces.obj", 3, 1, 1, 1, 0),
    ("defects/extra_vertex.obj", 3, 3, 3, 3, 0),
    // 56 of 1,368 faces have a repeated corner.
    ("defects/spider_ascii.stl", 1312, 30, 6, 18, 0),
    ("defects/mannequin_flipped.off", 839, 1, 1, 1, 0),
];

fn build(folder: &Path, name: &str, weld: Weld) -> (Mesh, Diagnosis) {
    let soup = limitmesh_io::read(folder.join(name)).unwrap();
    let (mesh, diagnosis) = Mesh::from_soup(&soup, &BuildOptions::default().weld(weld)).unwrap();
    mesh.validate().unwrap();
    (mesh, diagnosis)
}

fn root(parents: &mut [u32], mut v: u32) -> u32 {
    while parents[v as usize] != v {
        parents[v as usize] = parents[parents[v as usize] as usize];
        v = parents[v as usize];
    }
    v
}

fn unite(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

/// Boundary loops and components of a mesh whose cuts are glued together again.
fn loops_and_components(mesh: &Mesh) -> (usize, usize) {
    let topology = mesh.topology();
    let mut glued: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
    for group in mesh.junctions().vertices.iter() {
        group.iter().for_each(|&v| unite(&mut glued, group[0], v));
    }
    let cut: HashSet<u32> = mesh.junctions().edges.iter().flatten().copied().collect();
    let mut loops = glued.clone();
    let mut on_loops = Vec::new();
    for h in topology
        .half_edges()
        .filter(|h| topology.twin(*h).is_none() && !cut.contains(&h.0))
    {
        let [a, b] = topology.ends(h);
        unite(&mut loops, a.0, b.0);
        on_loops.push(a.0);
    }
    for t in mesh.triangles() {
        unite(&mut glued, t[0], t[1]);
        unite(&mut glued, t[0], t[2]);
    }
    let count = |parents: &mut [u32], of: &[u32]| {
        let mut roots: Vec<u32> = of.iter().map(|&v| root(parents, v)).collect();
        roots.sort_unstable();
        roots.dedup();
        roots.len()
    };
    let all: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
    (count(&mut loops, &on_loops), count(&mut glued, &all))
}

#[test]
fn shared_models_have_the_topology_on_record() {
    let Some(folder) = shared("") else { return };
    for (name, faces, characteristic, boundary_loops, components, non_manifold) in MODELS {
        // The record counts the vertices as stored, but those of STL by position.
        let weld = if name.ends_with("stl") {
            Weld::Exact
        } else {
            Weld::Never
        };
        let (mesh, diagnosis) = build(&folder, name, weld);
        let junctions = mesh.junctions();
        let copies: usize = junctions.vertices.iter().map(|group| group.len() - 1).sum();
        let edges: usize = junctions.edges.iter().map(|group| group.len() - 1).sum();
        let whole = mesh.topology().euler_characteristic() - copies as i64 + edges as i64;
        assert_eq!(whole, characteristic, "{name}");
        assert_eq!(
            loops_and_components(&mesh),
            (boundary_loops, components),
            "{name}"
        );
        assert_eq!(diagnosis.non_manifold_edges.count, non_manifold, "{name}");
        // Two of the beetle's edges have both ends inside one sheet: their three faces each are split in two.
        let split = if name == "beetle.obj" { 6 } else { 0 };
        assert_eq!(mesh.face_count(), faces + split, "{name}");
    }
}

/// A head with a fifth of its faces reversed becomes the head again, with these faces named.
#[test]
fn reversed_faces_are_turned_back() {
    let Some(folder) = shared("") else { return };
    let (head, _) = build(&folder, "mannequin.off", Weld::Exact);
    let (repaired, diagnosis) = build(&folder, "defects/mannequin_flipped.off", Weld::Exact);
    assert_eq!(repaired.positions(), head.positions());
    let rotated = |mesh: &Mesh| -> Vec<[u32; 3]> {
        let lowest_first = |mut t: [u32; 3]| {
            while t[0] > t[1] || t[0] > t[2] {
                t.rotate_left(1);
            }
            t
        };
        mesh.triangles().iter().map(|&t| lowest_first(t)).collect()
    };
    assert_eq!(rotated(&repaired), rotated(&head));
    let soup = limitmesh_io::read(folder.join("defects/mannequin_flipped.off")).unwrap();
    let reversed = soup
        .faces
        .iter()
        .zip(head.triangles())
        .filter(|(face, triangle)| {
            let next = |v: u32| face[(face.iter().position(|&w| w == v).unwrap() + 1) % 3];
            next(triangle[0]) != triangle[1]
        });
    assert_eq!(diagnosis.flipped_faces.count, reversed.count());
}
