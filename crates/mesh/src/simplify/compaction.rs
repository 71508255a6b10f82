//! The mesh after collapses: its vertices renumbered, with the tags and junctions that still exist.

use super::editable_mesh::EditableMesh;
use super::kept_features::Kind;
use crate::index::VertexId;
use crate::mesh::{CornerTag, CreaseTag, Junctions, Mesh, MeshError, NONE, Tags, Topology};

/// Builds the mesh, and gives the fine vertex of each of its vertices.
pub(super) fn mesh(
    fine: &Mesh,
    surface: &EditableMesh,
    kinds: &[Kind],
) -> Result<(Mesh, Vec<u32>), MeshError> {
    let vertices: Vec<u32> = (0..fine.vertex_count() as u32)
        .filter(|&v| surface.is_alive(v))
        .collect();
    let mut numbers = vec![NONE; fine.vertex_count()];
    for (number, &v) in vertices.iter().enumerate() {
        numbers[v as usize] = number as u32;
    }
    let number = |v: u32| numbers[v as usize];
    let triangles = surface
        .faces()
        .map(|face| surface.corners(face).map(number))
        .collect();
    let topology = Topology::from_triangles(triangles, vertices.len())?;
    let tags = Tags {
        creases: creases(fine, surface, kinds, number),
        corners: corners(fine, number),
    };
    let junctions = junctions(fine, &topology, number);
    let positions = vertices
        .iter()
        .map(|&v| fine.positions()[v as usize])
        .collect();
    Ok((
        Mesh::from_parts(topology, positions, tags, junctions),
        vertices,
    ))
}

/// Each crease edge of the coarse mesh once, with the sharpness of the fine ones that it replaces.
fn creases(
    fine: &Mesh,
    surface: &EditableMesh,
    kinds: &[Kind],
    number: impl Fn(u32) -> u32,
) -> Vec<CreaseTag> {
    let mut creases = Vec::new();
    for tag in &fine.tags().creases {
        let [a, b] = tag.vertices;
        for [start, step] in [[a, b], [b, a]] {
            if surface.is_alive(start) {
                let end = super::kept_features::end_of_chain(start, step, surface, kinds);
                let ends = [number(start), number(end)];
                // Seen from both ends, handled from one.
                if ends[0] < ends[1] {
                    creases.push(CreaseTag {
                        vertices: ends,
                        sharpness: tag.sharpness,
                    });
                }
            }
        }
    }
    creases
}

/// The corners, all of which are still there.
fn corners(fine: &Mesh, number: impl Fn(u32) -> u32) -> Vec<CornerTag> {
    let renumbered = |tag: &CornerTag| CornerTag {
        vertex: number(tag.vertex),
        ..*tag
    };
    fine.tags().corners.iter().map(renumbered).collect()
}

/// The junctions, none of whose vertices and edges has gone.
fn junctions(fine: &Mesh, topology: &Topology, number: impl Fn(u32) -> u32) -> Junctions {
    let mut junctions = Junctions::default();
    for group in fine.junctions().vertices.iter() {
        junctions.vertices.push(group.iter().map(|&v| number(v)));
    }
    for group in fine.junctions().edges.iter() {
        let renumbered = group.iter().filter_map(|&h| {
            let [a, b] = fine
                .topology()
                .ends(crate::index::HalfEdgeId(h))
                .map(|v| VertexId(number(v.0)));
            topology.edge_between(a, b).map(|h| h.0)
        });
        junctions.edges.push(renumbered);
    }
    junctions
}
