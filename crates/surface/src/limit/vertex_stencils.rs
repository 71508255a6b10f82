//! The limit stencils of a mesh's vertices, each kind once, to be applied to other positions of the
//! mesh.
//!
//! Takes a mesh and a table of a scheme with one-ring support; gives the weights of positions and of tangents by side.

use std::collections::HashMap;
use std::sync::Arc;

use super::evaluate::{Stencil, Stencils};
use super::{LimitError, LimitTable};
use crate::mesh::Mesh;
use crate::progress::uncancelled;

/// The stencils of a mesh's vertices.
#[doc(hidden)]
pub struct VertexStencils {
    #[doc(hidden)]
    pub list: Vec<VertexStencil>,
    /// Each vertex's in the list.
    #[doc(hidden)]
    pub by_vertex: Vec<u32>,
}

/// Weights on a vertex and its ring, in ring order.
#[doc(hidden)]
pub struct VertexStencil {
    /// Of the limit position, the vertex's own first.
    #[doc(hidden)]
    pub position: Vec<f64>,
    /// One where the surface is smooth.
    #[doc(hidden)]
    pub sides: Vec<StencilSide>,
}

/// A side of the infinitely sharp edges at a vertex.
#[doc(hidden)]
pub struct StencilSide {
    /// The slot of its first edge, and its number of faces, counter-clockwise from there.
    #[doc(hidden)]
    pub first: usize,
    #[doc(hidden)]
    pub faces: usize,
    /// Weights of both tangents on the differences to the vertex; empty without a tangent plane.
    #[doc(hidden)]
    pub tangents: Vec<[f64; 2]>,
}

impl LimitTable<'_> {
    /// The stencils of the vertices of `mesh`, for a scheme with one-ring support.
    #[doc(hidden)]
    pub fn vertex_stencils(&self, mesh: &Mesh) -> Result<VertexStencils, LimitError> {
        if mesh.topology().has_quads() {
            return Err(LimitError::Cells {
                what: "a replay".to_owned(),
                expected: "triangles",
            });
        }
        let stencils = uncancelled(|_| Stencils::of(self, mesh, &mut |_| Ok(())))?;
        let (mut list, mut known) = (Vec::new(), HashMap::new());
        let by_vertex = (0..mesh.vertex_count()).map(|v| {
            let stencil = stencils.at(v);
            let address = match stencil {
                Stencil::Plain(stencil) => Arc::as_ptr(stencil).cast::<()>(),
                Stencil::Sharp(stencil) => Arc::as_ptr(stencil).cast::<()>(),
            };
            *known.entry(address).or_insert_with(|| {
                let sides = stencil.sides().map(|side| StencilSide {
                    first: side.first,
                    faces: side.faces,
                    tangents: side.tangents.to_vec(),
                });
                list.push(VertexStencil {
                    position: stencil.position().to_vec(),
                    sides: sides.collect(),
                });
                list.len() as u32 - 1
            })
        });
        let by_vertex = by_vertex.collect();
        Ok(VertexStencils { list, by_vertex })
    }
}
