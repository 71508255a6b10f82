//! The points of a mesh after one refinement by a scheme's masks, for the stencils of two-ring schemes.
//!
//! Either of the whole mesh, each edge point computed once, or on demand for single vertices; or not the points, but the
//! weights that the mesh's vertices have in them.

use crate::index::{HalfEdgeId, VertexId};
use crate::masks::Masks;
use crate::mesh::Mesh;
use crate::parallel::{self, Poll};
use crate::progress::Cancelled;
use crate::scheme::Scheme;
use crate::vector::DVec3;

/// Where points stand after one refinement.
pub(crate) trait Refined {
    /// The data of a point.
    type Point;
    /// The new position of a vertex.
    fn moved(&self, vertex: VertexId) -> Self::Point;
    /// The new vertex on the edge of a half-edge.
    fn on_edge(&self, edge: HalfEdgeId) -> Self::Point;
}

/// All points of a mesh.
pub(super) struct RefinedMesh {
    moved: Vec<DVec3>,
    /// By half-edge; those with a smaller twin look there.
    on_edges: Vec<DVec3>,
    twins: Vec<u32>,
}

impl RefinedMesh {
    pub(crate) fn new(
        scheme: &dyn Scheme,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Self, Cancelled> {
        let nowhere = &mut |_| poll(0);
        let topology = mesh.topology();
        let twins = topology.raw_twins().to_vec();
        let masks = Masks::new(mesh, scheme);
        let moved = parallel::map_polled(topology.vertex_count(), nowhere, |v| {
            masks.vertex_point(VertexId(v as u32))
        })?;
        let on_edges = parallel::map_polled(topology.half_edge_count(), nowhere, |h| {
            if twins[h] as usize > h {
                masks.edge_point(HalfEdgeId(h as u32))
            } else {
                DVec3::ZERO
            }
        })?;
        Ok(Self {
            moved,
            on_edges,
            twins,
        })
    }
}

impl Refined for RefinedMesh {
    type Point = DVec3;

    #[inline]
    fn moved(&self, vertex: VertexId) -> DVec3 {
        self.moved[vertex.index()]
    }

    #[inline]
    fn on_edge(&self, edge: HalfEdgeId) -> DVec3 {
        // A missing twin is the greatest index of all.
        self.on_edges[edge.index().min(self.twins[edge.index()] as usize)]
    }
}

/// Points are computed on demand.
impl Refined for Masks<'_> {
    type Point = DVec3;

    fn moved(&self, vertex: VertexId) -> DVec3 {
        self.vertex_point(vertex)
    }

    fn on_edge(&self, edge: HalfEdgeId) -> DVec3 {
        self.edge_point(edge)
    }
}

/// Weights on the mesh's vertices, computed on demand; a vertex may have several, which add up.
pub(super) struct RefinedWeights<'m>(pub(super) Masks<'m>);

impl Refined for RefinedWeights<'_> {
    type Point = Vec<(VertexId, f64)>;

    fn moved(&self, vertex: VertexId) -> Self::Point {
        self.0.vertex_weights(vertex)
    }

    fn on_edge(&self, edge: HalfEdgeId) -> Self::Point {
        self.0.edge_weights(edge)
    }
}
