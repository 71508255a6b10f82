//! Catmull–Clark's scheme, for meshes of quads ([`crate::mesh::Topology::has_quads`]).
//!
//! Its rules use the corners opposite a vertex in its quads, which rings of triangles do not have: everything that refines or evaluates
//! a mesh of quads takes them from there. The masks for triangles below leave vertices where they are.

use super::{EdgeMask, Family, Scheme, Support, VertexMask, stay};
use crate::ring::{EdgeShape, RingShape};

/// Catmull and Clark's scheme for quads (1978), with OpenSubdiv's rules for boundaries, creases and corners.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CatmullClark;

impl Scheme for CatmullClark {
    fn name(&self) -> &str {
        "catmull-clark"
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        stay(shape)
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        EdgeMask {
            origin: 0.5,
            target: 0.5,
            ..EdgeMask::zero(&shape)
        }
    }

    fn family(&self) -> Option<Family> {
        Some(Family::CatmullClark)
    }
}
