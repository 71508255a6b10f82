//! A scheme's masks applied to a mesh: where its vertices move and where new ones come to stand.
//!
//! Takes a mesh and a scheme; gives points. Refinement and the limits of two-ring schemes build on it.

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, RingShapes};
use crate::parallel;
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{EdgeMask, Scheme, Support, VertexMask};
use crate::vector::{DVec3, vector};

/// The masks of one scheme for one mesh. Those that recur are evaluated once where many points are wanted.
pub(crate) struct Masks<'a> {
    mesh: &'a Mesh,
    scheme: &'a dyn Scheme,
    /// The shape of each vertex's ring, and the mask of each shape; empty where they are looked up on demand.
    shapes: RingShapes,
    vertex_masks: Vec<VertexMask>,
    /// Whether the mesh is known to have no boundary.
    is_closed: bool,
    /// The mask of an interior edge that touches no boundary, where the rings' valences do not matter.
    diamond: Option<Diamond>,
    /// The other masks of edges, by ascending shape.
    edge_masks: Vec<(EdgeShape, EdgeMask)>,
}

/// Weights of an edge's ends and of the two vertices opposite it.
#[derive(Clone, Copy)]
struct Diamond {
    ends: [f64; 2],
    opposite: [f64; 2],
}

impl<'a> Masks<'a> {
    /// Prepared for points all over the mesh.
    pub(crate) fn new(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Self {
        let shapes = RingShapes::of(mesh);
        let vertex_masks = shapes.distinct.iter().map(|&shape| scheme.vertex_mask(shape)).collect();
        let is_closed = shapes.distinct.iter().all(|shape| !shape.open);
        let mut masks = Self { shapes, vertex_masks, is_closed, ..Self::on_demand(mesh, scheme) };
        masks.edge_masks = masks.all_edge_masks();
        masks
    }

    /// For a few points.
    pub(crate) fn on_demand(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Self {
        let regular = || scheme.edge_mask(EdgeShape::between(RingShape::interior(6), RingShape::interior(6)));
        let diamond = (scheme.support() == Support::OneRing).then(|| Diamond::of(&regular())).flatten();
        Self {
            mesh,
            scheme,
            shapes: RingShapes::default(),
            vertex_masks: Vec::new(),
            is_closed: false,
            diamond,
            edge_masks: Vec::new(),
        }
    }

    /// The masks of all edges that the diamond does not serve.
    fn all_edge_masks(&self) -> Vec<(EdgeShape, EdgeMask)> {
        if self.diamond.is_some() && self.is_closed {
            return Vec::new();
        }
        let topology = self.mesh.topology();
        let shapes = parallel::pieces(topology.half_edge_count(), |piece| {
            let mut shapes: Vec<EdgeShape> = piece
                .map(|h| HalfEdgeId(h as u32))
                .filter(|&h| topology.twin(h).is_none_or(|twin| h < twin) && !self.has_diamond(h))
                .map(|h| self.mesh.edge_shape(h))
                .collect();
            shapes.sort_unstable();
            shapes.dedup();
            shapes
        });
        let mut shapes = shapes.concat();
        shapes.sort_unstable();
        shapes.dedup();
        shapes.into_iter().map(|shape| (shape, self.scheme.edge_mask(shape))).collect()
    }

    /// Whether the mask of an edge is the diamond.
    #[inline]
    fn has_diamond(&self, h: HalfEdgeId) -> bool {
        let ends = || self.mesh.topology().ends(h);
        self.diamond.is_some() && (self.is_closed || !ends().iter().any(|&end| self.is_open(end)))
    }

    #[inline]
    fn is_open(&self, vertex: VertexId) -> bool {
        match self.shapes.by_vertex.get(vertex.index()) {
            Some(&shape) => self.shapes.distinct[shape as usize].open,
            None => self.mesh.topology().is_boundary(vertex),
        }
    }

    fn at(&self, vertex: VertexId) -> DVec3 {
        vector(self.mesh.positions()[vertex.index()])
    }

    /// Where `vertex` moves.
    pub(crate) fn vertex_point(&self, vertex: VertexId) -> DVec3 {
        match self.shapes.by_vertex.get(vertex.index()) {
            Some(&shape) => self.weigh_vertex(vertex, &self.vertex_masks[shape as usize]),
            None => self.weigh_vertex(vertex, &self.scheme.vertex_mask(self.mesh.ring_shape(vertex))),
        }
    }

    fn weigh_vertex(&self, vertex: VertexId, mask: &VertexMask) -> DVec3 {
        self.mesh
            .topology()
            .ring(vertex)
            .zip(&mask.ring)
            .filter(|&(_, &weight)| weight != 0.0)
            .fold(mask.centre * self.at(vertex), |sum, (u, &weight)| sum + weight * self.at(u))
    }

    /// Where the new vertex on the edge of `h` comes to stand: the same bits from both of its half-edges.
    pub(crate) fn edge_point(&self, h: HalfEdgeId) -> DVec3 {
        let topology = self.mesh.topology();
        let h = topology.twin(h).map_or(h, |twin| h.min(twin));
        if let (Some(diamond), Some(twin), true) = (self.diamond, topology.twin(h), self.has_diamond(h)) {
            let [origin, target] = topology.ends(h);
            return diamond.ends[0] * self.at(origin)
                + diamond.ends[1] * self.at(target)
                + diamond.opposite[0] * self.at(topology.opposite(h))
                + diamond.opposite[1] * self.at(topology.opposite(twin));
        }
        let shape = self.mesh.edge_shape(h);
        match self.edge_masks.binary_search_by(|(known, _)| known.cmp(&shape)) {
            Ok(i) => self.weigh_edge(h, &shape, &self.edge_masks[i].1),
            Err(_) => self.weigh_edge(h, &shape, &self.scheme.edge_mask(shape)),
        }
    }

    fn weigh_edge(&self, h: HalfEdgeId, shape: &EdgeShape, mask: &EdgeMask) -> DVec3 {
        let [origin, target] = self.mesh.topology().ends(h);
        let mut sum = mask.origin * self.at(origin) + mask.target * self.at(target);
        for (vertex, ring, weights, other) in [
            (origin, shape.origin, &mask.origin_ring, target),
            (target, shape.target, &mask.target_ring, origin),
        ] {
            // A closed ring may start anywhere in the mesh, but starts at the edge in the mask.
            let topology = self.mesh.topology();
            let start =
                if ring.open { 0 } else { topology.ring(vertex).position(|u| u == other).unwrap_or(0) };
            let k = weights.len();
            for (slot, u) in topology.ring(vertex).enumerate() {
                let weight = weights[(slot + k - start) % k];
                if weight != 0.0 {
                    sum += weight * self.at(u);
                }
            }
        }
        sum
    }
}

impl Diamond {
    /// The mask's weights, where it uses nothing but the two triangles at the edge.
    fn of(regular: &EdgeMask) -> Option<Self> {
        let (at_origin, at_target) = (&regular.origin_ring, &regular.target_ring);
        let within = |ring: &[f64]| ring[2..5].iter().all(|&weight| weight == 0.0);
        // From the origin, slot 0 is the target, slot 1 the vertex on the left, slot 5 that on the right.
        (within(at_origin) && within(at_target)).then(|| Self {
            ends: [regular.origin + at_target[0], regular.target + at_origin[0]],
            opposite: [at_origin[1] + at_target[5], at_origin[5] + at_target[1]],
        })
    }
}
