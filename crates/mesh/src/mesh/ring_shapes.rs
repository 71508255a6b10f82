//! The ring shapes that occur in a mesh, each once, and which vertex has which: masks and limit stencils are
//! evaluated once for each.

use super::Mesh;
use crate::index::VertexId;
use crate::parallel::{self, Poll};
use crate::progress::{Cancelled, uncancelled};
use crate::ring::RingShape;

/// Vertices that are processed together.
const PIECE: usize = 1 << 13;

/// The distinct shapes of a mesh's rings, ascending, and for each vertex the place of its shape among them.
#[derive(Default)]
#[doc(hidden)]
pub struct RingShapes {
    #[doc(hidden)]
    pub distinct: Vec<RingShape>,
    #[doc(hidden)]
    pub by_vertex: Vec<u32>,
}

impl RingShapes {
    #[doc(hidden)]
    pub fn of(mesh: &Mesh) -> Self {
        uncancelled(|_| Self::polled(mesh, &mut |_| Ok(())))
    }

    /// [`Self::of`] that can be cancelled.
    #[doc(hidden)]
    pub fn polled(mesh: &Mesh, poll: &mut Poll<'_>) -> Result<Self, Cancelled> {
        let shapes = parallel::pieces_polled(mesh.vertex_count(), PIECE, poll, |piece| {
            piece
                .map(|v| mesh.ring_shape(VertexId(v as u32)))
                .collect::<Vec<_>>()
        });
        let shapes = shapes?.concat();
        let distinct = parallel::pieces_polled(shapes.len(), PIECE, poll, |piece| {
            // Neighbouring vertices mostly have equal shapes, so that few are left to sort.
            let mut shapes = shapes[piece].to_vec();
            shapes.dedup();
            sorted_once(shapes)
        });
        let distinct = sorted_once(distinct?.concat());
        let place = |v: usize| distinct.partition_point(|shape| *shape < shapes[v]) as u32;
        let by_vertex = parallel::map_polled(shapes.len(), poll, place)?;
        Ok(Self {
            distinct,
            by_vertex,
        })
    }

    /// The shape of a vertex's ring.
    #[inline]
    #[doc(hidden)]
    pub fn at(&self, vertex: VertexId) -> RingShape {
        self.distinct[self.by_vertex[vertex.index()] as usize]
    }
}

fn sorted_once(mut shapes: Vec<RingShape>) -> Vec<RingShape> {
    shapes.sort_unstable();
    shapes.dedup();
    shapes
}
