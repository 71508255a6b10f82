//! The points of a step of Catmull–Clark subdivision, as weights of those before it.
//!
//! The rules are OpenSubdiv's, for sharp edges and vertices too (Catmull and Clark 1978; DeRose, Kass and Truong 1998).

use super::quads::{Connected, Quads, next};
use super::ring::vertex_weights;
use crate::row::{Row, summed};

/// Where a vertex of [`Quads::refined`] comes from.
#[derive(Clone, Copy)]
pub(crate) enum Source {
    Vertex(u32),
    /// One of the half-edges of an edge.
    Edge(u32),
    Quad(u32),
}

impl Source {
    /// That of a vertex after a step, given the half-edges with new vertices.
    pub(crate) fn of(quads: &Quads, edges: &[u32], vertex: u32) -> Self {
        let before = quads.vertex_count() as u32;
        match vertex.checked_sub(before) {
            None => Self::Vertex(vertex),
            Some(edge) => match edges.get(edge as usize) {
                Some(&h) => Self::Edge(h),
                None => Self::Quad(edge - edges.len() as u32),
            },
        }
    }

    /// The weights of its new point.
    pub(crate) fn row(self, quads: &Quads) -> Row {
        match self {
            Self::Vertex(vertex) => {
                let Some(h) = quads.outgoing(vertex) else {
                    debug_assert!(false, "each vertex has a quad");
                    return Row::new();
                };
                let (ring, points) = quads.ring(h);
                let weights = vertex_weights(&ring);
                summed(points.into_iter().zip(weights).collect())
            }
            Self::Edge(h) => edge_row(quads, h),
            Self::Quad(quad) => centroid(quads, 4 * quad, 1.0).collect(),
        }
    }
}

fn centroid(quads: &Quads, h: u32, weight: f64) -> impl Iterator<Item = (u32, f64)> {
    let corners = quads.corners[h as usize / 4];
    corners
        .into_iter()
        .map(move |corner| (corner, 0.25 * weight))
}

fn edge_row(quads: &Quads, h: u32) -> Row {
    let sharp = quads.edge(h).min(1.0);
    let smooth = 1.0 - sharp;
    let ends = [h, next(h)].map(|h| (quads.origin(h), 0.25 * smooth + 0.5 * sharp));
    let twin = quads.twin(h).filter(|_| smooth > 0.0);
    let faces = [Some(h).filter(|_| smooth > 0.0), twin]
        .into_iter()
        .flatten();
    let faces = faces.flat_map(|h| centroid(quads, h, 0.25 * smooth));
    summed(ends.into_iter().chain(faces).collect())
}

/// The slot of a half-edge in the ring of its origin that [`Connected::ring`] gives for it: 0 in a closed one.
pub(crate) fn slot(quads: &impl Connected, h: u32) -> usize {
    let first = quads.first(h);
    quads.around(first).take_while(|&other| other != h).count()
}
