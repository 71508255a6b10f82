//! Subdivision schemes: refinement masks on a ring of neighbours, one file a scheme.
//!
//! A scheme sees the shape of rings ([`RingShape`], [`EdgeShape`]) and answers with weights; it knows neither
//! meshes nor positions. Everything else (refinement, limit positions, limit normals) follows from the masks.

mod butterfly;
mod catmull_clark;
mod loop_family;

pub use butterfly::ModifiedButterfly;
pub use catmull_clark::CatmullClark;
pub use loop_family::{Loop, LoopFamily, LoopWarren};

use crate::ring::{EdgeShape, RingShape};

/// Weights of a vertex's new position. They sum to 1.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct VertexMask {
    /// Weight of the vertex itself.
    pub centre: f64,
    /// Weights of its neighbours, in ring order.
    pub ring: Vec<f64>,
}

/// Weights of the new vertex on an edge. They sum to 1.
///
/// The two rings overlap (each end is in the other's ring, and so are the vertices opposite the edge): the
/// weights of a vertex that is named more than once add up, so a scheme writes each where it is easiest.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct EdgeMask {
    /// Weight of the edge's origin.
    pub origin: f64,
    /// Weight of the edge's target.
    pub target: f64,
    /// Weights of the origin's neighbours, in ring order (slot [`EdgeShape::origin_slot`] is the target).
    pub origin_ring: Vec<f64>,
    /// Weights of the target's neighbours, in ring order (slot [`EdgeShape::target_slot`] is the origin).
    pub target_ring: Vec<f64>,
}

impl EdgeMask {
    /// All weights zero, sized for `shape`.
    pub fn zero(shape: &EdgeShape) -> Self {
        Self {
            origin: 0.0,
            target: 0.0,
            origin_ring: vec![0.0; shape.origin.valence as usize],
            target_ring: vec![0.0; shape.target.valence as usize],
        }
    }
}

/// How far a vertex's refined neighbourhood of equal size reaches.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Support {
    /// The refined one-ring depends on the one-ring alone, and the masks of its edges do not depend on the
    /// valences of their far ends (Loop).
    OneRing,
    /// The refined two-ring depends on the two-ring (butterfly).
    TwoRing,
}

/// A scheme that splits each triangle in four.
///
/// # Contract
/// * Weights sum to 1 and do not depend on where in a closed ring it is cut.
/// * A boundary vertex's mask, and a boundary edge's, use boundary vertices only, so that sheets
///   that share a boundary stay together; edge masks do not depend on which end is the origin.
/// * A corner ([`RingShape::corner`]) keeps its place.
pub trait Scheme: Send + Sync {
    /// A short name, as on the command line.
    fn name(&self) -> &str;

    /// How far the masks reach.
    fn support(&self) -> Support;

    /// New position of a vertex.
    fn vertex_mask(&self, shape: RingShape) -> VertexMask;

    /// Position of the new vertex on an edge.
    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask;

    /// The known scheme that this is, if any. Distances are proven for these only. A scheme that returns one has
    /// its rules everywhere, regardless of its own methods.
    fn family(&self) -> Option<Family> {
        None
    }
}

/// A scheme whose limit surface is known piece by piece.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Family {
    /// A member of the Loop family.
    Loop(LoopFamily),
    /// [`CatmullClark`], for meshes of quads.
    CatmullClark,
}

impl Family {
    /// The scheme as a static reference.
    pub(crate) fn scheme(self) -> &'static dyn Scheme {
        match self {
            Self::Loop(family) => family.scheme(),
            Self::CatmullClark => &CatmullClark,
        }
    }
}

/// The scheme whose masks count: the known one that a scheme says it is, else the scheme itself.
pub(crate) fn declared(scheme: &dyn Scheme) -> &dyn Scheme {
    match scheme.family() {
        Some(family) => family.scheme(),
        None => scheme,
    }
}

#[cfg(test)]
mod tests;

/// The mask of every corner and of every vertex of an interpolating scheme: stay.
pub(crate) fn stay(shape: RingShape) -> VertexMask {
    VertexMask {
        centre: 1.0,
        ring: vec![0.0; shape.valence as usize],
    }
}
