//! Keeps the copies of cut vertices and edges together through a step: they are split alike and
//! have equal bits.

use super::split::{SplitEdges, SplitTopology};
use crate::index::HalfEdgeId;
use crate::mesh::{Groups, Mesh};

/// The vertex groups after a step: the old ones, and the new vertices on the copies of each split edge.
pub(super) fn vertex_groups(mesh: &Mesh, split: &SplitEdges, numbered: &SplitTopology) -> Groups {
    let mut groups = mesh.junctions().vertices.clone();
    for edge in split_groups(mesh, split) {
        groups.push(edge.iter().map(|&h| numbered.vertex_on(HalfEdgeId(h))));
    }
    groups
}

/// The edge groups after a step: the halves of each split edge, and unsplit edges under their new names.
pub(super) fn edge_groups(mesh: &Mesh, split: &SplitEdges, numbered: &SplitTopology) -> Groups {
    let place = mesh.junctions().first_copies();
    let origin_place = |h: HalfEdgeId| {
        let v = mesh.topology().origin(h).0;
        place.get(&v).copied().unwrap_or(v)
    };
    let mut groups = Groups::default();
    for edge in mesh.junctions().edges.iter() {
        let members = || edge.iter().map(|&h| HalfEdgeId(h));
        let Some(first) = members().next() else {
            continue;
        };
        let start = origin_place(first);
        // Sheets may run along the edge either way; a half belongs to the end that it touches.
        let half = |h: HalfEdgeId, near_start: bool| {
            numbered.halves(split, h)[usize::from((origin_place(h) == start) != near_start)]
        };
        groups.push(members().map(|h| half(h, true)));
        if split.contains(first) {
            groups.push(members().map(|h| half(h, false)));
        }
    }
    groups
}

/// Gives all copies of a vertex the position of the first, whose sums may have been taken in another order.
pub(super) fn join_copies(positions: &mut [[f64; 3]], groups: &Groups) {
    for group in groups.iter() {
        let Some((&first, others)) = group.split_first() else {
            continue;
        };
        let position = positions[first as usize];
        others
            .iter()
            .for_each(|&v| positions[v as usize] = position);
    }
}

/// Makes the flags of all copies of a vertex agree: set on all where `combine` of all is true.
pub(super) fn agree(flags: &mut [bool], groups: &Groups, combine: fn(bool, bool) -> bool) {
    for group in groups.iter() {
        let Some(flag) = group.iter().map(|&v| flags[v as usize]).reduce(combine) else {
            continue;
        };
        group.iter().for_each(|&v| flags[v as usize] = flag);
    }
}

fn split_groups<'a>(mesh: &'a Mesh, split: &'a SplitEdges) -> impl Iterator<Item = &'a [u32]> {
    mesh.junctions()
        .edges
        .iter()
        .filter(|edge| edge.first().is_some_and(|&h| split.contains(HalfEdgeId(h))))
}
