//! A scheme's masks applied to a mesh: where its vertices move and where new ones come to stand.

use std::collections::HashMap;

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::parallel;
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{EdgeMask, Scheme, Support, VertexMask};
use crate::vector::{DVec3, vector};

/// The masks of one scheme for one mesh: those that recur are evaluated once.
pub(super) struct Masks<'a> {
    mesh: &'a Mesh,
    scheme: &'a dyn Scheme,
    shapes: Vec<RingShape>,
    vertex_masks: HashMap<RingShape, VertexMask>,
    /// Vertex masks of smooth interior vertices of small valence, by valence: nearly all of them.
    common: Vec<Option<VertexMask>>,
    /// The mask of an interior edge that touches no boundary, where the rings' valences do not matter.
    diamond: Option<Diamond>,
    /// The mask of an edge between two regular interior vertices.
    regular: EdgeMask,
}

/// Weights of an edge's ends and of the two vertices opposite it.
#[derive(Clone, Copy)]
struct Diamond {
    ends: [f64; 2],
    opposite: [f64; 2],
}

/// Valences that [`Masks::common`] holds.
const COMMON_VALENCES: usize = 32;

const REGULAR: EdgeShape = EdgeShape::between(RingShape::interior(6), RingShape::interior(6));

impl<'a> Masks<'a> {
    pub(super) fn new(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Self {
        let shapes = parallel::map(mesh.vertex_count(), |v| mesh.ring_shape(VertexId(v as u32)));
        let mut vertex_masks = HashMap::new();
        let mut common = vec![None; COMMON_VALENCES];
        for &shape in &shapes {
            match common.get_mut(shape.valence as usize) {
                Some(slot) if !shape.open && !shape.corner => {
                    slot.get_or_insert_with(|| scheme.vertex_mask(shape));
                }
                _ => {
                    vertex_masks.entry(shape).or_insert_with(|| scheme.vertex_mask(shape));
                }
            }
        }
        let regular = scheme.edge_mask(REGULAR);
        let diamond = (scheme.support() == Support::OneRing).then(|| Diamond::of(&regular)).flatten();
        Self { mesh, scheme, shapes, vertex_masks, common, diamond, regular }
    }

    fn at(&self, vertex: VertexId) -> DVec3 {
        vector(self.mesh.positions()[vertex.index()])
    }

    /// Where `vertex` moves.
    pub(super) fn vertex_point(&self, vertex: VertexId) -> DVec3 {
        let shape = self.shapes[vertex.index()];
        let common = match self.common.get(shape.valence as usize) {
            Some(mask) if !shape.open && !shape.corner => mask.as_ref(),
            _ => self.vertex_masks.get(&shape),
        };
        match common {
            Some(mask) => self.weigh_vertex(vertex, mask),
            None => self.weigh_vertex(vertex, &self.scheme.vertex_mask(shape)),
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

    /// Where the new vertex on the edge of `h` comes to stand.
    pub(super) fn edge_point(&self, h: HalfEdgeId) -> DVec3 {
        let topology = self.mesh.topology();
        let [origin, target] = topology.ends(h);
        let shapes = [self.shapes[origin.index()], self.shapes[target.index()]];
        if let (Some(diamond), Some(twin), [false, false]) =
            (self.diamond, topology.twin(h), shapes.map(|shape| shape.open))
        {
            return diamond.ends[0] * self.at(origin)
                + diamond.ends[1] * self.at(target)
                + diamond.opposite[0] * self.at(topology.opposite(h))
                + diamond.opposite[1] * self.at(topology.opposite(twin));
        }
        let shape = self.mesh.edge_shape(h);
        if shape == REGULAR {
            self.weigh_edge(h, &shape, &self.regular)
        } else {
            self.weigh_edge(h, &shape, &self.scheme.edge_mask(shape))
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
