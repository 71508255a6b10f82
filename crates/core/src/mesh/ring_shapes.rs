//! The ring shapes that occur in a mesh, each once, and which vertex has which: masks and limit stencils are
//! evaluated once for each.

use super::Mesh;
use crate::index::VertexId;
use crate::parallel;
use crate::ring::RingShape;

/// The distinct shapes of a mesh's rings, ascending, and for each vertex the place of its shape among them.
#[derive(Default)]
pub(crate) struct RingShapes {
    pub(crate) distinct: Vec<RingShape>,
    pub(crate) by_vertex: Vec<u32>,
}

impl RingShapes {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let shapes = parallel::map(mesh.vertex_count(), |v| mesh.ring_shape(VertexId(v as u32)));
        let distinct = parallel::pieces(shapes.len(), |piece| {
            // Neighbouring vertices mostly have the same shape: what is left to sort is little.
            let mut shapes = shapes[piece].to_vec();
            shapes.dedup();
            sorted_once(shapes)
        });
        let distinct = sorted_once(distinct.concat());
        let place = |v: usize| distinct.binary_search(&shapes[v]).unwrap_or(0) as u32;
        let by_vertex = parallel::map(shapes.len(), place);
        Self { distinct, by_vertex }
    }

    /// The shape of a vertex's ring.
    #[inline]
    pub(crate) fn at(&self, vertex: VertexId) -> RingShape {
        self.distinct[self.by_vertex[vertex.index()] as usize]
    }
}

fn sorted_once(mut shapes: Vec<RingShape>) -> Vec<RingShape> {
    shapes.sort_unstable();
    shapes.dedup();
    shapes
}
