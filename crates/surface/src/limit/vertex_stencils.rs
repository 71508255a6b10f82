//! The limit stencils of a mesh's vertices, each kind once, to be applied to other positions of the
//! mesh.
//!
//! Takes a mesh and a table of a scheme with one-ring support; gives the weights of positions and of tangents by side.

use std::collections::HashMap;
use std::sync::Arc;

use super::evaluate::{Stencil, Stencils};
use super::{LimitError, LimitTable};
use crate::catmull_clark::quads::{Connected, MeshQuads, spoke};
use crate::catmull_clark::ring::RingLimits;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::progress::uncancelled;

/// The stencils of a mesh's vertices.
#[doc(hidden)]
pub struct VertexStencils<'m> {
    mesh: &'m Mesh,
    sharpness: Sharpness<'m>,
    #[doc(hidden)]
    pub list: Vec<VertexStencil>,
    /// Each vertex's in the list.
    #[doc(hidden)]
    pub by_vertex: Vec<u32>,
}

/// Weights on a vertex and its ring, in ring order; among quads, the corners opposite to it follow.
#[doc(hidden)]
pub struct VertexStencil {
    /// The edges of the vertex.
    #[doc(hidden)]
    pub edges: usize,
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
    pub fn vertex_stencils<'m>(&self, mesh: &'m Mesh) -> Result<VertexStencils<'m>, LimitError> {
        if mesh.topology().has_quads() {
            return Ok(VertexStencils::of_quads(mesh));
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
                    edges: stencil.position().len() - 1,
                    position: stencil.position().to_vec(),
                    sides: sides.collect(),
                });
                list.len() as u32 - 1
            })
        });
        let by_vertex = by_vertex.collect();
        Ok(VertexStencils {
            mesh,
            sharpness: Sharpness::of(mesh),
            list,
            by_vertex,
        })
    }
}

impl<'m> VertexStencils<'m> {
    /// Those of a mesh of quads.
    fn of_quads(mesh: &'m Mesh) -> Self {
        let sharpness = Sharpness::of(mesh);
        let quads = MeshQuads {
            mesh,
            sharpness: &sharpness,
        };
        let (mut list, mut known) = (Vec::new(), HashMap::new());
        let by_vertex = mesh.topology().vertices().map(|vertex| {
            let (ring, _) = quads.ring(quads.outgoing(vertex));
            let sharp = ring.spokes.iter().chain([&ring.vertex]);
            let key: Vec<u64> = sharp.map(|sharp| sharp.to_bits()).collect();
            *known.entry((ring.open, key)).or_insert_with(|| {
                let limits = RingLimits::of(&ring);
                let sides = limits.sides.into_iter().map(|side| {
                    let [first, second] = side.tangents.unwrap_or_default();
                    let tangents = first.into_iter().zip(second).skip(1);
                    StencilSide {
                        first: side.first,
                        faces: side.quads,
                        tangents: tangents.map(|(first, second)| [first, second]).collect(),
                    }
                });
                list.push(VertexStencil {
                    edges: ring.spokes.len(),
                    position: limits.position,
                    sides: sides.collect(),
                });
                list.len() as u32 - 1
            })
        });
        let by_vertex = by_vertex.collect();
        Self {
            mesh,
            sharpness,
            list,
            by_vertex,
        }
    }

    /// The mesh as quads, if it is one of these.
    fn quads(&self) -> Option<MeshQuads<'_>> {
        let has_quads = self.mesh.topology().has_quads();
        has_quads.then_some(MeshQuads {
            mesh: self.mesh,
            sharpness: &self.sharpness,
        })
    }

    /// A vertex's stencil.
    #[doc(hidden)]
    pub fn at(&self, vertex: VertexId) -> &VertexStencil {
        &self.list[self.by_vertex[vertex.index()] as usize]
    }

    /// The points that a vertex's stencil is of.
    #[doc(hidden)]
    pub fn points(&self, vertex: VertexId) -> Vec<u32> {
        if let Some(quads) = self.quads() {
            return quads.ring(quads.outgoing(vertex)).1;
        }
        let ring = self.mesh.topology().ring(vertex);
        [vertex].into_iter().chain(ring).map(|v| v.0).collect()
    }

    /// The number of the side on which the face of a half-edge is that leaves a vertex.
    #[doc(hidden)]
    pub fn side_of(&self, h: HalfEdgeId) -> u32 {
        let topology = self.mesh.topology();
        let stencil = self.at(topology.origin(h));
        if stencil.sides.len() < 2 {
            return 0;
        }
        let (edges, at) = match self.quads() {
            Some(quads) => {
                let first = quads.first(quads.outgoing(topology.origin(h)));
                let before = quads.around(first).take_while(|&other| other != spoke(h));
                (stencil.edges, before.count())
            }
            None => {
                let faces = topology.outgoing_ring(topology.origin(h)).count();
                (faces, topology.slot(h))
            }
        };
        let is_before = |side: &&StencilSide| (at + edges - side.first) % edges >= side.faces;
        stencil.sides.iter().take_while(is_before).count() as u32
    }
}
