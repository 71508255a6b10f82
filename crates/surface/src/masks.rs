//! A scheme's masks applied to a mesh: the new positions of its vertices and the positions of new
//! ones.
//!
//! Takes a mesh and a scheme; gives points. Refinement and the limits of two-ring schemes build on it.

mod incident_edge;
pub(crate) mod views;

use crate::catmull_clark::masks::QuadMasks;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, RingShapes, Sharpness, Topology};
use crate::parallel;
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{EdgeMask, Scheme, Support, VertexMask, declared};
use crate::vector::{DVec3, vector};
use incident_edge::IncidentEdge;
use views::{EdgeView, LabelledRing, View, edge_views, vertex_views};

/// Up to this valence the place of an edge in an open ring is counted each time; beyond it the places of all edges
/// are kept, because counting would take time with the square of the valence.
const MOST_COUNTED: u32 = 32;

/// Weights of edge masks kept at most (32 MB): the edges of a vertex on a boundary all have shapes of their own,
/// whose masks together grow with the square of the valence. Beyond it masks are evaluated where they are needed.
const MOST_WEIGHTS: usize = 1 << 22;

/// The masks of one scheme for one mesh. Those that recur are evaluated once where many points are wanted.
pub struct Masks<'a> {
    mesh: &'a Mesh,
    /// The rules of a mesh of quads, which has no others.
    quads: Option<QuadMasks<'a>>,
    scheme: &'a dyn Scheme,
    sharpness: Sharpness<'a>,
    /// Whether nothing but boundaries is sharp.
    is_untagged: bool,
    /// The shape of each vertex's ring, and the mask of each shape; empty where they are looked up on demand.
    shapes: RingShapes,
    vertex_masks: Vec<VertexMask>,
    /// Whether the mesh is known to have no boundary.
    is_closed: bool,
    /// The mask of an interior edge that touches no boundary, where the rings' valences do not matter.
    diamond: Option<Diamond>,
    /// By half-edge, its place in the ring of its origin where that is open; empty if such rings are all small.
    slots: Vec<u32>,
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
    pub fn new(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Self {
        let scheme = declared(scheme);
        if mesh.topology().has_quads() {
            return Self::on_demand(mesh, scheme);
        }
        let shapes = RingShapes::of(mesh);
        let vertex_masks = shapes
            .distinct
            .iter()
            .map(|&shape| scheme.vertex_mask(shape))
            .collect();
        let is_closed = shapes.distinct.iter().all(|shape| !shape.open);
        let slots = slots_of_open_rings(mesh.topology(), &shapes);
        let mut masks = Self {
            shapes,
            vertex_masks,
            is_closed,
            slots,
            ..Self::on_demand(mesh, scheme)
        };
        masks.edge_masks = masks.all_edge_masks();
        masks
    }

    /// For a few points.
    pub fn on_demand(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Self {
        let scheme = declared(scheme);
        let regular = || {
            scheme.edge_mask(EdgeShape::between(
                RingShape::interior(6),
                RingShape::interior(6),
            ))
        };
        let diamond = (scheme.support() == Support::OneRing)
            .then(|| Diamond::of(&regular()))
            .flatten();
        let sharpness = Sharpness::of(mesh);
        let has_quads = mesh.topology().has_quads();
        Self {
            mesh,
            quads: has_quads.then(|| QuadMasks::of(mesh)),
            scheme,
            is_untagged: sharpness.is_empty(),
            sharpness,
            shapes: RingShapes::default(),
            vertex_masks: Vec::new(),
            is_closed: false,
            diamond,
            slots: Vec::new(),
            edge_masks: Vec::new(),
        }
    }

    /// The masks of edges that the diamond does not serve, as many as there is room for.
    fn all_edge_masks(&self) -> Vec<(EdgeShape, EdgeMask)> {
        if self.diamond.is_some() && self.is_closed {
            return Vec::new();
        }
        let topology = self.mesh.topology();
        let shapes = parallel::pieces(topology.half_edge_count(), |piece| {
            let mut shapes: Vec<EdgeShape> = piece
                .map(|h| HalfEdgeId(h as u32))
                .filter(|&h| topology.twin(h).is_none_or(|twin| h < twin))
                .filter(|&h| !self.has_diamond(h) && !self.is_at_tag(h))
                .map(|h| self.edge_shape(h))
                .collect();
            shapes.sort_unstable();
            shapes.dedup();
            shapes
        });
        let mut shapes = shapes.concat();
        shapes.sort_unstable();
        shapes.dedup();
        let mut room = MOST_WEIGHTS;
        shapes.retain(|shape| {
            let left = room.checked_sub((shape.origin.valence + shape.target.valence) as usize);
            room = left.unwrap_or(room);
            left.is_some()
        });
        shapes
            .into_iter()
            .map(|shape| (shape, self.scheme.edge_mask(shape)))
            .collect()
    }

    /// The shape of an edge, without going round its ends where their rings are known.
    fn edge_shape(&self, h: HalfEdgeId) -> EdgeShape {
        if self.shapes.by_vertex.is_empty() {
            return self.mesh.edge_shape(h);
        }
        let topology = self.mesh.topology();
        let [origin, target] = topology.ends(h).map(|v| self.shapes.at(v));
        let slot = |shape: RingShape, edge: IncidentEdge| match edge {
            _ if !shape.open => 0,
            IncidentEdge::Arriving(_) => shape.valence - 1,
            IncidentEdge::Leaving(h) => self.slots.get(h.index()).copied().unwrap_or_else(|| {
                let before =
                    core::iter::successors(edge.previous(topology), |s| s.previous(topology));
                before.count() as u32
            }),
        };
        EdgeShape {
            origin,
            origin_slot: slot(origin, IncidentEdge::from_origin(h)),
            target,
            target_slot: slot(target, IncidentEdge::from_target(topology, h)),
        }
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

    /// Whether an end of an edge follows other rules than its ring's shape says.
    #[inline]
    fn is_at_tag(&self, h: HalfEdgeId) -> bool {
        !self.is_untagged
            && self
                .mesh
                .topology()
                .ends(h)
                .iter()
                .any(|&end| self.sharpness.is_tagged(end))
    }

    fn at(&self, vertex: VertexId) -> DVec3 {
        vector(self.mesh.positions()[vertex.index()])
    }

    /// Where `vertex` moves.
    pub fn vertex_point(&self, vertex: VertexId) -> DVec3 {
        if let Some(quads) = &self.quads {
            return quads.vertex_point(vertex);
        }
        if !self.is_untagged && self.sharpness.is_tagged(vertex) {
            return self.tagged_vertex_point(vertex);
        }
        match self.shapes.by_vertex.get(vertex.index()) {
            Some(&shape) => self.weigh_vertex(vertex, &self.vertex_masks[shape as usize]),
            None => self.weigh_vertex(
                vertex,
                &self.scheme.vertex_mask(self.mesh.ring_shape(vertex)),
            ),
        }
    }

    fn weigh_vertex(&self, vertex: VertexId, mask: &VertexMask) -> DVec3 {
        self.mesh
            .topology()
            .ring(vertex)
            .zip(&mask.ring)
            .filter(|&(_, &weight)| weight != 0.0)
            .fold(mask.centre * self.at(vertex), |sum, (u, &weight)| {
                sum + weight * self.at(u)
            })
    }

    /// The position of the new vertex on the edge of `h`, with the same bits from both of its
    /// half-edges.
    pub fn edge_point(&self, h: HalfEdgeId) -> DVec3 {
        if let Some(quads) = &self.quads {
            return quads.edge_point(h);
        }
        let topology = self.mesh.topology();
        let h = topology.twin(h).map_or(h, |twin| h.min(twin));
        if self.is_at_tag(h) {
            return self.tagged_edge_point(h);
        }
        if let (Some(diamond), Some(twin), true) =
            (self.diamond, topology.twin(h), self.has_diamond(h))
        {
            let [origin, target] = topology.ends(h);
            return diamond.ends[0] * self.at(origin)
                + diamond.ends[1] * self.at(target)
                + diamond.opposite[0] * self.at(topology.opposite(h))
                + diamond.opposite[1] * self.at(topology.opposite(twin));
        }
        let shape = self.edge_shape(h);
        match self
            .edge_masks
            .binary_search_by(|(known, _)| known.cmp(&shape))
        {
            Ok(i) => self.weigh_edge(h, &shape, &self.edge_masks[i].1),
            Err(_) => self.weigh_edge(h, &shape, &self.scheme.edge_mask(shape)),
        }
    }

    /// The ring of a vertex with the sharpness of its edges.
    fn labelled_ring(&self, vertex: VertexId) -> LabelledRing<VertexId> {
        let neighbours = self.mesh.topology().ring(vertex).collect();
        LabelledRing {
            centre: vertex,
            neighbours,
            sharp: self.sharpness.ring(vertex),
        }
    }

    // Kept apart, so that the loops over untagged vertices and edges stay short.
    #[cold]
    #[inline(never)]
    fn tagged_vertex_point(&self, vertex: VertexId) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (share, view) in vertex_views(&self.labelled_ring(vertex)) {
            let mask = self.scheme.vertex_mask(view.shape);
            sum += share * self.weigh_view(&view, mask.centre, &mask.ring);
        }
        sum
    }

    #[cold]
    #[inline(never)]
    fn tagged_edge_point(&self, h: HalfEdgeId) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (share, view) in self.views_of_edge(h) {
            sum += share * self.weigh_edge_view(&view);
        }
        sum
    }

    fn views_of_edge(&self, h: HalfEdgeId) -> Vec<(f64, EdgeView<VertexId>)> {
        let topology = self.mesh.topology();
        let [origin, target] = topology.ends(h).map(|end| self.labelled_ring(end));
        let slot = |ring: &LabelledRing<VertexId>, h: Option<HalfEdgeId>| {
            // The last edge of an open ring has no half-edge that leaves.
            let place = |h| {
                topology
                    .outgoing_ring(ring.centre)
                    .position(|other| other == h)
            };
            h.and_then(place).unwrap_or(ring.neighbours.len() - 1)
        };
        let slots = [slot(&origin, Some(h)), slot(&target, topology.twin(h))];
        edge_views((&origin, slots[0]), (&target, slots[1]))
    }

    /// The vertices whose weighted sum [`Self::vertex_point`] is; a vertex may occur several times.
    pub(crate) fn vertex_weights(&self, vertex: VertexId) -> Vec<(VertexId, f64)> {
        let mut weights = Vec::new();
        for (share, view) in vertex_views(&self.labelled_ring(vertex)) {
            let mask = self.scheme.vertex_mask(view.shape);
            weights.extend(
                view.weighted(mask.centre, &mask.ring)
                    .map(|(v, weight)| (v, share * weight)),
            );
        }
        weights
    }

    /// The vertices whose weighted sum [`Self::edge_point`] is; a vertex may occur several times.
    pub(crate) fn edge_weights(&self, h: HalfEdgeId) -> Vec<(VertexId, f64)> {
        let mut weights = Vec::new();
        for (
            share,
            EdgeView {
                shape,
                origin,
                target,
            },
        ) in self.views_of_edge(h)
        {
            let mask = self.scheme.edge_mask(shape);
            let at_origin = origin.weighted(mask.origin, &mask.origin_ring);
            let at_target = target.weighted(mask.target, &mask.target_ring);
            weights.extend(
                at_origin
                    .chain(at_target)
                    .map(|(v, weight)| (v, share * weight)),
            );
        }
        weights
    }

    fn weigh_edge_view(&self, view: &EdgeView<VertexId>) -> DVec3 {
        let weigh = |mask: &EdgeMask| {
            self.weigh_view(&view.origin, mask.origin, &mask.origin_ring)
                + self.weigh_view(&view.target, mask.target, &mask.target_ring)
        };
        match self
            .edge_masks
            .binary_search_by(|(known, _)| known.cmp(&view.shape))
        {
            Ok(i) => weigh(&self.edge_masks[i].1),
            Err(_) => weigh(&self.scheme.edge_mask(view.shape)),
        }
    }

    fn weigh_view(&self, view: &View<VertexId>, centre: f64, ring: &[f64]) -> DVec3 {
        view.weighted(centre, ring)
            .fold(DVec3::ZERO, |sum, (v, weight)| sum + weight * self.at(v))
    }

    fn weigh_edge(&self, h: HalfEdgeId, shape: &EdgeShape, mask: &EdgeMask) -> DVec3 {
        let [origin, target] = self.mesh.topology().ends(h);
        let mut sum = mask.origin * self.at(origin) + mask.target * self.at(target);
        let ends = [
            (
                IncidentEdge::from_origin(h),
                shape.origin,
                shape.origin_slot,
                &mask.origin_ring,
            ),
            (
                IncidentEdge::from_target(self.mesh.topology(), h),
                shape.target,
                shape.target_slot,
                &mask.target_ring,
            ),
        ];
        for (edge, ring, slot, weights) in ends {
            let slot = slot as usize;
            // A closed ring starts at the edge: the second half of it is nearer clockwise.
            let (before, from) = if ring.open {
                weights.split_at(slot)
            } else {
                let (near, far) = weights.split_at(weights.len().div_ceil(2));
                (far, near)
            };
            self.weigh_around(&mut sum, Some(edge), IncidentEdge::next, from.iter());
            let previous = edge.previous(self.mesh.topology());
            self.weigh_around(
                &mut sum,
                previous,
                IncidentEdge::previous,
                before.iter().rev(),
            );
        }
        sum
    }

    /// Adds the weighted neighbours from `edge` on, step by step, as far as there are weights that are not zero.
    fn weigh_around<'w>(
        &self,
        sum: &mut DVec3,
        mut edge: Option<IncidentEdge>,
        step: impl Fn(IncidentEdge, &Topology) -> Option<IncidentEdge>,
        weights: impl DoubleEndedIterator<Item = &'w f64> + ExactSizeIterator + Clone,
    ) {
        let topology = self.mesh.topology();
        let reach = weights
            .clone()
            .rposition(|&weight| weight != 0.0)
            .map_or(0, |last| last + 1);
        for &weight in weights.take(reach) {
            let Some(here) = edge else { return };
            if weight != 0.0 {
                *sum += weight * self.at(here.neighbour(topology));
            }
            edge = step(here, topology);
        }
    }
}

/// The place of each half-edge in the ring of its origin, where that is open, if any such ring is large.
fn slots_of_open_rings(topology: &Topology, shapes: &RingShapes) -> Vec<u32> {
    if !shapes
        .distinct
        .iter()
        .any(|shape| shape.open && shape.valence > MOST_COUNTED)
    {
        return Vec::new();
    }
    let mut slots = vec![0; topology.half_edge_count()];
    for vertex in topology.vertices().filter(|&v| topology.is_boundary(v)) {
        for (slot, h) in (0..).zip(topology.outgoing_ring(vertex)) {
            slots[h.index()] = slot;
        }
    }
    slots
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

#[cfg(test)]
mod tests;
