//! The features that stay: crease edges and boundaries, corners, ends of creases.

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, MeshError, NONE};

use super::editable_mesh::EditableMesh;

/// Edges that stay edges and vertices that stay, in addition to boundaries and the mesh's own tags,
/// which always stay.
///
/// Along a chain of edges vertices may go; where a chain ends or branches they stay.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// Edges by their ends.
    pub edges: Vec<[u32; 2]>,
    /// Vertices that stay.
    pub vertices: Vec<u32>,
}

/// Where a vertex may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Along any of its edges.
    Smooth,
    /// Only to these two fine vertices and beyond, along its crease or boundary.
    Chain([u32; 2]),
    /// Nowhere.
    Fixed,
}

/// Marks the edges in `surface` and gives the kind of each vertex of `fine`.
pub(super) fn kinds(
    fine: &Mesh,
    features: &Features,
    surface: &mut EditableMesh,
) -> Result<Vec<Kind>, MeshError> {
    let topology = fine.topology();
    let broken = |place: String, what| MeshError::Broken { place, what };
    let exists = |v: u32| (v as usize) < topology.vertex_count();
    let tagged = fine.tags().creases.iter().map(|crease| crease.vertices);
    for [a, b] in features.edges.iter().copied().chain(tagged) {
        let edge = if exists(a) && exists(b) {
            topology.edge_between(VertexId(a), VertexId(b))
        } else {
            None
        };
        let Some(edge) = edge else {
            return Err(broken(
                format!("edge from vertex {a} to vertex {b}"),
                "a feature is an edge of the mesh",
            ));
        };
        surface.sharpen(edge.0);
    }
    let mut kinds: Vec<Kind> = (0..topology.vertex_count() as u32)
        .map(|v| chain_at(v, surface))
        .collect();
    let corners = fine.tags().corners.iter().map(|corner| corner.vertex);
    for v in features.vertices.iter().copied().chain(corners) {
        *kinds
            .get_mut(v as usize)
            .ok_or_else(|| broken(format!("vertex {v}"), "a feature is a vertex of the mesh"))? =
            Kind::Fixed;
    }
    // Sheets that were cut apart meet in the copies of their vertices.
    for group in fine.junctions().vertices.iter() {
        group.iter().for_each(|&v| kinds[v as usize] = Kind::Fixed);
    }
    for group in fine.junctions().edges.iter() {
        for &h in group {
            topology
                .ends(HalfEdgeId(h))
                .iter()
                .for_each(|v| kinds[v.index()] = Kind::Fixed);
        }
    }
    // A chain whose tag changes ends there, so that each of its edges has one tag.
    end_chains_at_changes(fine, &mut kinds);
    Ok(kinds)
}

/// The kind of a vertex by its sharp edges alone.
fn chain_at(vertex: u32, surface: &EditableMesh) -> Kind {
    let mut ends = [NONE; 2];
    let mut count = 0;
    let mut meet = |v: u32| {
        if count < 2 {
            ends[count] = v;
        }
        count += 1;
    };
    for h in surface.outgoing_ring(vertex) {
        if surface.is_sharp(h) {
            meet(surface.target(h));
        }
        let before = super::editable_mesh::previous(h);
        if surface.twin(before) == NONE {
            meet(surface.origin(before));
        }
    }
    match count {
        0 => Kind::Smooth,
        2 => Kind::Chain(ends),
        _ => Kind::Fixed,
    }
}

/// The vertex that is still there at which a walk from `start` to its neighbour on a chain, `step`, and on along the chain
/// ends.
pub(super) fn end_of_chain(start: u32, step: u32, surface: &EditableMesh, kinds: &[Kind]) -> u32 {
    walk_chain(start, step, surface, kinds, |_| {})
}

/// Walks the chain; calls `gone` for each vertex on the way, which no longer exists.
pub(super) fn walk_chain(
    start: u32,
    step: u32,
    surface: &EditableMesh,
    kinds: &[Kind],
    mut gone: impl FnMut(u32),
) -> u32 {
    let (mut before, mut at) = (start, step);
    while !surface.is_alive(at) {
        gone(at);
        // Only vertices inside chains go.
        let Kind::Chain(ways) = kinds[at as usize] else {
            break;
        };
        (before, at) = (at, if ways[0] == before { ways[1] } else { ways[0] });
    }
    at
}

/// Fixes the vertices of chains at which the sharpness of the tag differs between the two edges.
fn end_chains_at_changes(fine: &Mesh, kinds: &mut [Kind]) {
    let mut sharpness: Vec<(u32, u64)> = Vec::with_capacity(2 * fine.tags().creases.len());
    for crease in &fine.tags().creases {
        sharpness.extend(crease.vertices.map(|v| (v, crease.sharpness.to_bits())));
    }
    sharpness.sort_unstable();
    for at_vertex in sharpness.chunk_by(|a, b| a.0 == b.0) {
        let changes = at_vertex.iter().any(|tag| tag.1 != at_vertex[0].1);
        // One tag alone ends here, though the chain may go on untagged or along a boundary.
        if changes || at_vertex.len() != 2 {
            kinds[at_vertex[0].0 as usize] = Kind::Fixed;
        }
    }
}
