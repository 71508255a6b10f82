//! Helpers of the tests of building: small soups, and a count of the elements of a mesh.

mod cuts;
mod fans;
mod inside_out;
mod polygons;
mod random;
mod repairs;

use std::collections::{HashMap, HashSet};

use super::*;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{CornerTag, CreaseTag, Finding, PolygonFaces, Topology};

fn soup(positions: &[[f64; 3]], faces: &[&[u32]]) -> PolygonSoup {
    PolygonSoup {
        positions: positions.to_vec(),
        faces: faces.iter().copied().collect::<PolygonFaces>(),
        ..PolygonSoup::default()
    }
}

fn build_soup(soup: &PolygonSoup) -> (Mesh, Diagnosis) {
    let (mesh, diagnosis) = Mesh::from_soup(soup, &BuildOptions::default()).unwrap();
    check_mesh(&mesh);
    (mesh, diagnosis)
}

fn finding(places: &[u32]) -> Finding {
    Finding {
        count: places.len(),
        first: places.to_vec(),
    }
}

/// The non-empty findings.
fn found(diagnosis: &Diagnosis) -> Vec<(&'static str, Finding)> {
    diagnosis
        .findings()
        .filter(|(_, f)| !f.is_empty())
        .map(|(name, f)| (name, f.clone()))
        .collect()
}

/// Checks all that every built mesh promises.
fn check_mesh(mesh: &Mesh) {
    mesh.validate().unwrap();
    let topology = mesh.topology();
    // Indices alone decide which half-edges are twins.
    let rebuilt = Topology::from_triangles(mesh.triangles().to_vec(), mesh.vertex_count()).unwrap();
    assert_eq!(&rebuilt, topology);
    check_junctions_hold(mesh);
}

/// Computes one step of refinement of the copies by boundary and corner rules, from the definition:
/// the members of a vertex group must end at one place, and so must the midpoints of an edge group.
fn check_junctions_hold(mesh: &Mesh) {
    let topology = mesh.topology();
    let p = mesh.positions();
    let mut seen = HashSet::new();
    for group in mesh.junctions().vertices.iter() {
        assert!(group.len() > 1);
        assert!(group.is_sorted());
        let moved: Vec<[f64; 3]> = group
            .iter()
            .map(|&v| {
                assert!(seen.insert(v), "vertex {v} is in two groups");
                let v = VertexId(v);
                if mesh.tags().is_corner(v) {
                    return p[v.index()];
                }
                assert!(topology.is_boundary(v), "an interior copy must be a corner");
                let ring: Vec<VertexId> = topology.ring(v).collect();
                let mut ends = [ring[0], ring[ring.len() - 1]].map(|u| p[u.index()]);
                ends.sort_by(|a, b| a.partial_cmp(b).unwrap());
                [0, 1, 2].map(|i| 0.75 * p[v.index()][i] + 0.125 * ends[0][i] + 0.125 * ends[1][i])
            })
            .collect();
        assert!(
            moved.iter().all(|q| *q == moved[0]),
            "copies {group:?} part: {moved:?}"
        );
    }
    let mut seen = HashSet::new();
    for group in mesh.junctions().edges.iter() {
        assert!(group.len() > 1);
        for &h in group {
            assert!(seen.insert(h), "half-edge {h} is in two groups");
            assert!(topology.twin(HalfEdgeId(h)).is_none());
        }
    }
}

/// Undirected edges of triangles by corner positions, with the number of faces at each.
fn edges_by_place(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> HashMap<[[u64; 3]; 2], usize> {
    let mut edges = HashMap::new();
    for t in triangles {
        for i in 0..3 {
            let mut ends =
                [t[i], t[(i + 1) % 3]].map(|v| positions[v as usize].map(|x| (x + 0.0).to_bits()));
            ends.sort_unstable();
            *edges.entry(ends).or_insert(0) += 1;
        }
    }
    edges
}
