//! The points of a mesh after one refinement by a scheme's masks, for the stencils of two-ring schemes.
//!
//! Either of the whole mesh, each edge point computed once, or on demand for single vertices.

use std::borrow::Cow;

use super::weights::{Ring, edge_shape, edge_weights, vertex_weights};
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::parallel;
use crate::ring::EdgeShape;
use crate::scheme::{EdgeMask, Scheme};
use crate::vector::{DVec3, vector};

/// Where points stand after one refinement.
pub(super) trait Refined {
    /// The new position of a vertex.
    fn moved(&self, vertex: VertexId) -> DVec3;
    /// The new vertex on the edge of a half-edge.
    fn on_edge(&self, edge: HalfEdgeId) -> DVec3;
}

/// All points of a mesh.
pub(super) struct RefinedMesh {
    moved: Vec<DVec3>,
    /// By half-edge; those with a smaller twin look there.
    on_edges: Vec<DVec3>,
    twins: Vec<u32>,
}

impl RefinedMesh {
    pub(super) fn new(scheme: &dyn Scheme, mesh: &Mesh) -> Self {
        let topology = mesh.topology();
        let twins = topology.raw_twins().to_vec();
        let is_first = |h: usize| twins[h] as usize > h;
        let lazy = Lazy::new(scheme, mesh);
        let masks = Masks::of(scheme, mesh, is_first);
        let moved = parallel::map(topology.vertex_count(), |v| lazy.moved(VertexId(v as u32)));
        let on_edges = parallel::map(topology.half_edge_count(), |h| {
            if is_first(h) {
                lazy.edge_point(HalfEdgeId(h as u32), |shape| masks.get(shape))
            } else {
                DVec3::ZERO
            }
        });
        Self { moved, on_edges, twins }
    }
}

impl Refined for RefinedMesh {
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

/// The masks of all edge shapes of a mesh, in ascending order of the shapes.
struct Masks<'s> {
    scheme: &'s dyn Scheme,
    known: Vec<(EdgeShape, EdgeMask)>,
}

impl<'s> Masks<'s> {
    fn of(scheme: &'s dyn Scheme, mesh: &Mesh, is_first: impl Fn(usize) -> bool + Sync + Send) -> Self {
        let mut shapes: Vec<EdgeShape> = parallel::map(mesh.topology().half_edge_count(), |h| {
            is_first(h).then(|| mesh.edge_shape(HalfEdgeId(h as u32)))
        })
        .into_iter()
        .flatten()
        .collect();
        shapes.sort_unstable();
        shapes.dedup();
        let known = shapes.into_iter().map(|shape| (shape, scheme.edge_mask(shape))).collect();
        Self { scheme, known }
    }

    fn get(&self, shape: EdgeShape) -> Cow<'_, EdgeMask> {
        match self.known.binary_search_by(|(known, _)| known.cmp(&shape)) {
            Ok(i) => Cow::Borrowed(&self.known[i].1),
            Err(_) => Cow::Owned(self.scheme.edge_mask(shape)),
        }
    }
}

/// Points computed when asked for.
pub(super) struct Lazy<'a> {
    scheme: &'a dyn Scheme,
    mesh: &'a Mesh,
}

impl<'a> Lazy<'a> {
    pub(super) fn new(scheme: &'a dyn Scheme, mesh: &'a Mesh) -> Self {
        Self { scheme, mesh }
    }

    fn ring(&self, vertex: VertexId) -> Ring<VertexId> {
        let neighbours = self.mesh.topology().ring(vertex).collect();
        Ring { centre: vertex, shape: self.mesh.ring_shape(vertex), neighbours }
    }

    fn point(&self, vertex: VertexId) -> DVec3 {
        vector(self.mesh.positions()[vertex.index()])
    }

    fn edge_point<'m>(&self, edge: HalfEdgeId, mask: impl FnOnce(EdgeShape) -> Cow<'m, EdgeMask>) -> DVec3 {
        let [origin, target] = self.mesh.topology().ends(edge).map(|end| self.ring(end));
        let slot = |ring: &Ring<VertexId>, other: VertexId| {
            ring.neighbours.iter().position(|&neighbour| neighbour == other).unwrap_or(0)
        };
        let from = (&origin, slot(&origin, target.centre));
        let to = (&target, slot(&target, origin.centre));
        let mut sum = DVec3::ZERO;
        let mask = mask(edge_shape(from, to));
        edge_weights(&mask, from, to, |vertex, weight| sum += weight * self.point(vertex));
        sum
    }
}

impl Refined for Lazy<'_> {
    fn moved(&self, vertex: VertexId) -> DVec3 {
        let mut sum = DVec3::ZERO;
        vertex_weights(self.scheme, &self.ring(vertex), |vertex, weight| sum += weight * self.point(vertex));
        sum
    }

    fn on_edge(&self, edge: HalfEdgeId) -> DVec3 {
        // From the same side as for the whole mesh, for the same rounding.
        let edge = self.mesh.topology().twin(edge).map_or(edge, |twin| twin.min(edge));
        self.edge_point(edge, |shape| Cow::Owned(self.scheme.edge_mask(shape)))
    }
}
