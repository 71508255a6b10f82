//! The parts of a patch's domain that triangles stand for.

/// Part of a patch's domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SubTriangle {
    /// All of it.
    Whole,
    /// One side of the line from the middle of the edge from corner `edge` to the corner opposite: that of the edge's
    /// start, or of its end. Corners keep their places, the middle takes that of the other end.
    Half {
        /// Number of the edge.
        edge: usize,
        /// The side of the edge's end.
        second: bool,
    },
    /// One of the four parts of a refinement.
    Child(usize),
    /// The quarter between an edge's end, the middle of the next edge and the middle of the edge before.
    Quarter {
        /// The edge, from this corner to the next one.
        edge: usize,
        /// At the edge's end rather than at its start. Corners: the end, the middle of the next edge, the middle
        /// of the edge before.
        at_end: bool,
    },
}
