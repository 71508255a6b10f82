//! One step of refinement: a mesh, its split edges and its moving vertices give the next mesh.
//!
//! All points are computed from the old positions and committed together.

use super::junctions::{edge_groups, join_copies, vertex_groups};
use super::split::{SplitEdges, SplitTopology};
use super::tags::refined_tags;
use super::{RefineError, quad_order};
use crate::index::VertexId;
use crate::masks::Masks;
use crate::mesh::{Junctions, Mesh};
use crate::parallel;
use crate::progress::{Cancelled, Watch};
use crate::scheme::Scheme;

/// The mesh after one step, and how its elements were numbered. `moves` says which old vertices take their new position; `None` means all.
pub(super) fn advance(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    mut split: SplitEdges,
    moves: Option<&[bool]>,
    watch: &mut Watch<'_>,
) -> Result<(Mesh, SplitTopology), RefineError> {
    let numbered = SplitTopology::number(mesh, &split, watch)?;
    let mut positions = new_positions(mesh, scheme, &numbered, moves, watch)?;
    let vertices = vertex_groups(mesh, &split, &numbered);
    join_copies(&mut positions, &vertices);
    split.choose_diagonals(mesh, &numbered, &positions);
    let mut junctions = Junctions {
        vertices,
        edges: edge_groups(mesh, &split, &numbered),
    };
    let mut topology = numbered.connect(mesh, &split, watch)?;
    if mesh.topology().has_quads() {
        topology = quad_order::in_order(topology, watch)?.with_quads()?;
        junctions.edges.rename(quad_order::moved);
    }
    let tags = refined_tags(mesh, &split, &numbered, moves);
    Ok((
        Mesh::from_parts(topology, positions, tags, junctions),
        numbered,
    ))
}

/// Old vertices, moved or not, and then the new ones.
fn new_positions(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    numbered: &SplitTopology,
    moves: Option<&[bool]>,
    watch: &mut Watch<'_>,
) -> Result<Vec<[f64; 3]>, Cancelled> {
    let masks = Masks::new(mesh, scheme);
    let old = mesh.vertex_count();
    parallel::map_polled(old + numbered.edges.len(), &mut |_| watch.poll(), |v| {
        if v >= old {
            masks.edge_point(numbered.edges[v - old]).to_array()
        } else if moves.is_none_or(|moves| moves[v]) {
            masks.vertex_point(VertexId(v as u32)).to_array()
        } else {
            mesh.positions()[v]
        }
    })
}
