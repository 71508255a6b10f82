//! How sharp the edges and vertices of a mesh are, which rule each vertex follows, and into which sectors its sharp
//! edges cut its ring.
//!
//! Takes a mesh with its tags; answers for single half-edges and vertices. The classification is
//! OpenSubdiv's, by the number of sharp edges at a vertex, those of a boundary included (see
//! [`SharpRing`]).

use super::{Mesh, Topology};
use crate::index::{HalfEdgeId, VertexId};
use crate::ring::{INFINITELY_SHARP, RingSector, RingShape, SharpRing, VertexRule};

/// One side of the sharp edges at a vertex; all of the ring where there are fewer than two of them.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sector {
    /// The half-edge that leaves the vertex along the first edge of the sector, counter-clockwise.
    /// It is sharp except in the closed ring of a vertex without sharp edges.
    pub first: HalfEdgeId,
    /// The shape of the ring from there on: open between two sharp edges.
    pub shape: RingShape,
}

impl Sector {
    /// The half-edges that leave the vertex, counter-clockwise: one for each face of the sector.
    pub fn outgoing<'t>(
        &self,
        topology: &'t Topology,
    ) -> impl Iterator<Item = HalfEdgeId> + use<'t> {
        let next = |h: &HalfEdgeId| topology.twin(h.previous());
        core::iter::successors(Some(self.first), next).take(self.shape.faces() as usize)
    }

    /// The vertices at the other ends of the sector's edges, counter-clockwise: as many as the valence of its shape.
    pub fn neighbours<'t>(
        &self,
        topology: &'t Topology,
    ) -> impl Iterator<Item = VertexId> + use<'t> {
        let faces = self.shape.faces() as usize;
        let last = self
            .shape
            .open
            .then(|| self.outgoing(topology).nth(faces - 1))
            .flatten();
        let last = last.map(|h| topology.opposite(h));
        self.outgoing(topology)
            .map(|h| topology.target(h))
            .chain(last)
    }
}

/// The sharpness of a mesh's edges and vertices. Takes no memory where there are no tags.
#[derive(Clone, Debug)]
pub struct Sharpness<'m> {
    topology: &'m Topology,
    /// One bit a vertex: whether an interior edge at it is sharp, or it is tagged itself. Empty without tags.
    tagged: Vec<u64>,
    /// Both half-edges of each sharp interior edge, ascending, and their sharpness.
    half_edges: Vec<(HalfEdgeId, f64)>,
    /// By 64 half-edges, which of them these are, one bit each, and how many come before; empty where there are none.
    sharp: Vec<(u64, u32)>,
    /// Tagged vertices, ascending, and their sharpness.
    vertices: Vec<(VertexId, f64)>,
}

impl<'m> Sharpness<'m> {
    /// The sharpness that the tags of `mesh` give its edges and vertices.
    pub fn of(mesh: &'m Mesh) -> Self {
        let (topology, tags) = (mesh.topology(), mesh.tags());
        let mut half_edges = Vec::with_capacity(2 * tags.creases.len());
        for tag in tags.creases.iter().filter(|tag| tag.sharpness > 0.0) {
            let [a, b] = tag.vertices.map(VertexId);
            let sides = topology
                .edge_between(a, b)
                .and_then(|h| Some([h, topology.twin(h)?]));
            half_edges.extend(sides.into_iter().flatten().map(|h| (h, tag.sharpness)));
        }
        // Of several tags on one edge the sharpest counts.
        half_edges
            .sort_unstable_by(|a: &(HalfEdgeId, f64), b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
        half_edges.dedup_by_key(|&mut (h, _)| h);
        let sharp = tags.corners.iter().filter(|tag| tag.sharpness > 0.0);
        let vertices = sharp
            .map(|tag| (VertexId(tag.vertex), tag.sharpness))
            .collect();
        Self::new(topology, half_edges, vertices)
    }

    fn new(
        topology: &'m Topology,
        half_edges: Vec<(HalfEdgeId, f64)>,
        vertices: Vec<(VertexId, f64)>,
    ) -> Self {
        let mut tagged = Vec::new();
        if !half_edges.is_empty() || !vertices.is_empty() {
            tagged.resize(topology.vertex_count().div_ceil(64), 0);
            let origins = half_edges.iter().map(|&(h, _)| topology.origin(h));
            for v in origins.chain(vertices.iter().map(|&(v, _)| v)) {
                tagged[v.index() / 64] |= 1u64 << (v.index() % 64);
            }
        }
        let mut sharp = Vec::new();
        if let Some((last, _)) = half_edges.last() {
            sharp.resize(last.index() / 64 + 1, (0, 0));
            for (h, _) in &half_edges {
                sharp[h.index() / 64].0 |= 1u64 << (h.index() % 64);
            }
            let mut before = 0;
            for (bits, rank) in &mut sharp {
                *rank = before;
                before += bits.count_ones();
            }
        }
        Self {
            topology,
            tagged,
            half_edges,
            sharp,
            vertices,
        }
    }

    /// The infinitely sharp tags: those left after enough levels of refinement.
    pub fn infinitely_sharp(&self) -> Self {
        let half_edges = self
            .half_edges
            .iter()
            .copied()
            .filter(|&(_, s)| s >= INFINITELY_SHARP);
        let vertices = self
            .vertices
            .iter()
            .copied()
            .filter(|&(_, s)| s >= INFINITELY_SHARP);
        Self::new(self.topology, half_edges.collect(), vertices.collect())
    }

    /// Whether no vertex and no edge but those of boundaries are sharp.
    pub fn is_empty(&self) -> bool {
        self.tagged.is_empty()
    }

    /// Whether there are semi-sharp tags.
    pub fn is_semi_sharp(&self) -> bool {
        let mut all = self
            .half_edges
            .iter()
            .map(|&(_, s)| s)
            .chain(self.vertices.iter().map(|&(_, s)| s));
        all.any(|s| s < INFINITELY_SHARP)
    }

    /// Levels of refinement after which only infinitely sharp tags are left.
    #[doc(hidden)]
    pub fn semi_sharp_levels(&self) -> usize {
        let all = self
            .half_edges
            .iter()
            .map(|&(_, s)| s)
            .chain(self.vertices.iter().map(|&(_, s)| s));
        all.filter(|&s| s < INFINITELY_SHARP)
            .fold(0.0, f64::max)
            .ceil() as usize
    }

    /// Whether an interior edge at `vertex` is sharp, or the vertex itself by its tag: whether its
    /// rules may differ from those of its ring alone.
    #[inline]
    pub fn is_tagged(&self, vertex: VertexId) -> bool {
        self.tagged
            .get(vertex.index() / 64)
            .is_some_and(|word| word >> (vertex.index() % 64) & 1 != 0)
    }

    /// The vertices for which [`Self::is_tagged`] holds, ascending.
    #[doc(hidden)]
    pub fn tagged_vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        let vertices = (0..self.topology.vertex_count() as u32).map(VertexId);
        let none = self.is_empty();
        vertices
            .take_while(move |_| !none)
            .filter(|&v| self.is_tagged(v))
    }

    /// The sharpness of the edge of `h`: infinite on a boundary, 0 where it is smooth.
    #[inline]
    pub fn edge(&self, h: HalfEdgeId) -> f64 {
        if self.topology.twin(h).is_none() {
            return f64::INFINITY;
        }
        let Some(&(bits, before)) = self.sharp.get(h.index() / 64) else {
            return 0.0;
        };
        let at = 1u64 << (h.index() % 64);
        if bits & at == 0 {
            return 0.0;
        }
        self.half_edges[(before + (bits & (at - 1)).count_ones()) as usize].1
    }

    /// The sharpness of `vertex` by its tag, whatever its edges: 0 without one.
    #[inline]
    pub fn vertex(&self, vertex: VertexId) -> f64 {
        if !self.is_tagged(vertex) {
            return 0.0;
        }
        self.vertices
            .binary_search_by_key(&vertex, |&(v, _)| v)
            .map_or(0.0, |i| self.vertices[i].1)
    }

    /// The half-edges that leave `vertex`, counter-clockwise, without diagonals of quads.
    fn outgoing(&self, vertex: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let outgoing = self.topology.outgoing_ring(vertex);
        outgoing.filter(|&h| !self.topology.is_diagonal(h))
    }

    /// The sharpness of the edges at `vertex`, in ring order; the last edge of an open ring included. Diagonals of quads are no edges.
    pub fn spokes(&self, vertex: VertexId) -> impl Iterator<Item = f64> + '_ {
        let boundary = self.topology.is_boundary(vertex).then_some(f64::INFINITY);
        self.outgoing(vertex).map(|h| self.edge(h)).chain(boundary)
    }

    /// The ring of `vertex` with the sharpness of its edges.
    pub fn ring(&self, vertex: VertexId) -> SharpRing {
        let open = self.topology.is_boundary(vertex);
        SharpRing {
            open,
            vertex: self.vertex(vertex),
            spokes: self.spokes(vertex).collect(),
        }
    }

    /// The rule of `vertex` at the present level.
    pub fn rule(&self, vertex: VertexId) -> VertexRule {
        match self.is_tagged(vertex) {
            true => self.ring(vertex).rule(),
            false if self.topology.is_boundary(vertex) => VertexRule::Crease,
            false => VertexRule::Smooth,
        }
    }

    /// The sectors of the ring of `vertex`, counter-clockwise, at the present level.
    pub fn sectors(&self, vertex: VertexId) -> Vec<Sector> {
        let sectors = self.ring(vertex).sectors();
        let mut outgoing = self.outgoing(vertex).enumerate();
        let place = |sector: &RingSector| {
            let (_, first) = outgoing.find(|&(slot, _)| slot == sector.first)?;
            Some(Sector {
                first,
                shape: sector.shape,
            })
        };
        sectors.iter().filter_map(place).collect()
    }
}

#[cfg(test)]
mod tests;
