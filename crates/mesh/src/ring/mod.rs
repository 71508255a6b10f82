//! The shape of a vertex's one-ring and of an edge's neighbourhood: all that a scheme may know of a mesh.
//!
//! Rings are listed counter-clockwise. The ring of a boundary vertex starts and ends at its two boundary
//! neighbours; the ring of an interior vertex starts anywhere, and for an edge at that edge.

mod sharp;

pub use sharp::{INFINITELY_SHARP, RingSector, SharpRing, VertexRule};
pub use sharp::{decremented, present_weight, rule};

/// The rule of a vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum VertexKind {
    /// Smooth, faces all round.
    Interior,
    /// Smooth along a boundary curve of the mesh.
    Boundary,
    /// Keeps its position, whatever surrounds it.
    Corner,
}

/// The one-ring of a vertex without its positions.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct RingShape {
    /// Number of edges at the vertex.
    pub valence: u32,
    /// Whether the ring ends at two boundary edges.
    pub open: bool,
    /// Whether the vertex keeps its position.
    pub corner: bool,
    /// Whether a crease ends at the vertex, along the first edge of its closed ring. The rules of
    /// the vertex and of its other edges ignore it; masks never get it, limits do.
    pub dart: bool,
}

impl RingShape {
    /// A smooth interior vertex with `valence` edges (and as many faces).
    pub const fn interior(valence: u32) -> Self {
        Self {
            valence,
            open: false,
            corner: false,
            dart: false,
        }
    }

    /// A smooth boundary vertex with `valence` edges (and one face fewer).
    pub const fn boundary(valence: u32) -> Self {
        Self {
            valence,
            open: true,
            corner: false,
            dart: false,
        }
    }

    /// The rules the vertex follows.
    pub const fn kind(&self) -> VertexKind {
        match (self.corner, self.open) {
            (true, _) => VertexKind::Corner,
            (false, true) => VertexKind::Boundary,
            (false, false) => VertexKind::Interior,
        }
    }

    /// Number of faces at the vertex.
    pub const fn faces(&self) -> u32 {
        if self.open {
            self.valence - 1
        } else {
            self.valence
        }
    }

    /// Whether the vertex is regular: six edges inside, four on a boundary.
    pub const fn is_regular(&self) -> bool {
        self.valence == if self.open { 4 } else { 6 }
    }
}

/// An edge and the rings of its two ends.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct EdgeShape {
    /// Ring of the vertex that the edge leaves.
    pub origin: RingShape,
    /// The slot of the edge's far end in the origin's ring: 0 in a closed ring.
    pub origin_slot: u32,
    /// Ring of the vertex that the edge reaches.
    pub target: RingShape,
    /// The slot of the edge's near end in the target's ring: 0 in a closed ring.
    pub target_slot: u32,
}

impl EdgeShape {
    /// Whether the edge has one face only.
    pub const fn is_boundary(&self) -> bool {
        self.origin.open && (self.origin_slot == 0 || self.origin_slot + 1 == self.origin.valence)
    }

    /// An interior edge between two closed rings.
    pub const fn between(origin: RingShape, target: RingShape) -> Self {
        Self {
            origin,
            origin_slot: 0,
            target,
            target_slot: 0,
        }
    }
}
