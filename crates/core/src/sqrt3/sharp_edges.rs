//! The sharp edges of a mesh for √3-subdivision: infinitely sharp ones, boundaries among them, and
//! the rules of the vertices on them.

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness, Topology};
use crate::refine::RefineError;
use crate::ring::{INFINITELY_SHARP, VertexRule};

/// The sharp edges of a mesh.
#[derive(Debug)]
pub(super) struct SharpEdges<'m> {
    topology: &'m Topology,
    sharpness: Sharpness<'m>,
}

impl<'m> SharpEdges<'m> {
    /// # Errors
    /// A semi-sharp tag, which has no meaning here.
    pub(super) fn of(mesh: &'m Mesh) -> Result<Self, RefineError> {
        let tags = mesh.tags();
        let is_semi_sharp = |sharpness: f64| sharpness > 0.0 && sharpness < INFINITELY_SHARP;
        if let Some(tag) = tags.creases.iter().find(|tag| is_semi_sharp(tag.sharpness)) {
            let [a, b] = tag.vertices;
            let (tag, sharpness) = (
                format!("the edge from vertex {a} to vertex {b}"),
                tag.sharpness,
            );
            return Err(RefineError::FadingTag { tag, sharpness });
        }
        if let Some(tag) = tags.corners.iter().find(|tag| is_semi_sharp(tag.sharpness)) {
            let (tag, sharpness) = (format!("vertex {}", tag.vertex), tag.sharpness);
            return Err(RefineError::FadingTag { tag, sharpness });
        }
        Ok(Self {
            topology: mesh.topology(),
            sharpness: Sharpness::of(mesh),
        })
    }

    /// Whether there is nothing sharp but boundaries.
    pub(super) fn is_empty(&self) -> bool {
        self.sharpness.is_empty()
    }

    /// Whether the edge of `h` is sharp.
    pub(super) fn is_sharp(&self, h: HalfEdgeId) -> bool {
        self.sharpness.edge(h) > 0.0
    }

    /// The rule that a vertex follows.
    pub(super) fn rule(&self, vertex: VertexId) -> VertexRule {
        self.sharpness.rule(vertex)
    }

    /// The neighbours of a vertex along sharp edges, in ring order.
    pub(super) fn neighbours(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.topology.outgoing_ring(vertex).flat_map(|h| {
            let before = h.previous();
            let last = self
                .topology
                .twin(before)
                .is_none()
                .then(|| self.topology.origin(before));
            let first = self.is_sharp(h).then(|| self.topology.target(h));
            first.into_iter().chain(last)
        })
    }

    /// The first sharp half-edge of each face, as its corner; 3 where it has none.
    pub(super) fn corner_of(&self, face: usize) -> u8 {
        let corner = (0..3).find(|corner| self.is_sharp(HalfEdgeId(3 * face as u32 + corner)));
        corner.unwrap_or(3) as u8
    }
}
