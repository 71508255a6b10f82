//! The parts of a patch's domain that triangles approximate.

use crate::patch::child_corners;

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

impl SubTriangle {
    /// All parts.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let edges = || (0..3).flat_map(|edge| [(edge, false), (edge, true)]);
        let halves = edges().map(|(edge, second)| Self::Half { edge, second });
        let quarters = edges().map(|(edge, at_end)| Self::Quarter { edge, at_end });
        core::iter::once(Self::Whole)
            .chain((0..4).map(Self::Child))
            .chain(halves)
            .chain(quarters)
    }

    /// The values at its corners, given those at the corners of the domain and in the middles of
    /// its edges.
    pub(crate) fn corners<T: Copy>(self, corners: [T; 3], middles: [T; 3]) -> [T; 3] {
        match self {
            Self::Whole => corners,
            Self::Child(child) => child_corners(corners, middles, child),
            Self::Half { edge, second } => {
                let mut own = corners;
                own[(edge + usize::from(!second)) % 3] = middles[edge];
                own
            }
            Self::Quarter { edge, at_end } => {
                let from = (edge + usize::from(at_end)) % 3;
                [
                    corners[from],
                    middles[(edge + 1) % 3],
                    middles[(edge + 2) % 3],
                ]
            }
        }
    }
}
