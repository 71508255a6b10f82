//! Crease and corner tags with their sharpness.

use super::{MeshError, Topology};
use crate::index::VertexId;

/// Sharpness from which a tag never fades: OpenSubdiv's convention for files.
pub const INFINITELY_SHARP: f64 = 10.0;

/// An edge that is to stay sharp.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CreaseTag {
    /// The ends of the edge, in any order.
    pub vertices: [u32; 2],
    /// 0 smooth, [`INFINITELY_SHARP`] and above for ever sharp, between them sharp for that many levels.
    pub sharpness: f64,
}

/// A vertex that is to stay where it is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CornerTag {
    /// The vertex.
    pub vertex: u32,
    /// As for [`CreaseTag::sharpness`].
    pub sharpness: f64,
}

/// The tags of a mesh.
///
/// Refinement honours corners of infinite sharpness. It hands creases and semi-sharp corners on to the pieces of
/// what they name, but smooths across them.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tags {
    /// Sharp edges.
    pub creases: Vec<CreaseTag>,
    /// Sharp vertices, by ascending vertex.
    pub corners: Vec<CornerTag>,
}

impl Tags {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.creases.is_empty() && self.corners.is_empty()
    }

    /// Whether `vertex` keeps its place for ever.
    #[inline]
    pub fn is_corner(&self, vertex: VertexId) -> bool {
        if self.corners.is_empty() {
            return false;
        }
        self.corners
            .binary_search_by_key(&vertex.0, |tag| tag.vertex)
            .is_ok_and(|i| self.corners[i].sharpness >= INFINITELY_SHARP)
    }

    /// Checks that every tag names something that exists, with a sharpness that is a number ≥ 0.
    pub(crate) fn check(&self, topology: &Topology) -> Result<(), MeshError> {
        let broken = |place: String, what| Err(MeshError::Broken { place, what });
        for pair in self.corners.windows(2) {
            if pair[0].vertex >= pair[1].vertex {
                return broken(
                    format!("corner tag of vertex {}", pair[1].vertex),
                    "corner tags stand in ascending order of their vertices, one for each",
                );
            }
        }
        for tag in &self.corners {
            if tag.vertex as usize >= topology.vertex_count() {
                return broken(
                    format!("corner tag of vertex {}", tag.vertex),
                    "a corner tag names a vertex of the mesh",
                );
            }
            if tag.sharpness.is_nan() || tag.sharpness < 0.0 {
                return broken(
                    format!("corner tag of vertex {} with sharpness {}", tag.vertex, tag.sharpness),
                    "a sharpness is a number of at least 0",
                );
            }
        }
        for tag in &self.creases {
            let [a, b] = tag.vertices;
            let exists = |v: u32| (v as usize) < topology.vertex_count();
            if !exists(a) || !exists(b) || topology.edge_between(VertexId(a), VertexId(b)).is_none() {
                return broken(
                    format!("crease tag from vertex {a} to vertex {b}"),
                    "a crease tag names an edge of the mesh",
                );
            }
            if tag.sharpness.is_nan() || tag.sharpness < 0.0 {
                return broken(
                    format!("crease tag from vertex {a} to vertex {b} with sharpness {}", tag.sharpness),
                    "a sharpness is a number of at least 0",
                );
            }
        }
        Ok(())
    }
}
