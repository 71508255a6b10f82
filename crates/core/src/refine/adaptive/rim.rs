//! The edges of the leaves along the sides of a node, and which of them the neighbours have split.

use super::walk::{EdgeVertex, Node};
use crate::mesh::NONE;

/// The edge vertices along a node's sides.
#[derive(Default)]
pub(super) struct Rim {
    /// By side, the numbers of the edge vertices at the leaves' corners, from the side's start to its end.
    corners: [Vec<u32>; 3],
    /// By side and leaf, the number of the edge vertex in the middle of its edge, or [`NONE`].
    middles: [Vec<u32>; 3],
}

impl Rim {
    /// How many leaves of a node have two split edges, and so a diagonal each.
    pub(super) fn diagonals(&mut self, node: &Node<'_>, edge_vertices: &[EdgeVertex]) -> usize {
        if node.is_plain() {
            return 0;
        }
        self.set(node, edge_vertices);
        let n = 1usize << node.depth;
        let split = Self::leaves(n).map(|(i, j)| bits(&self.split(n, i, j)));
        split.filter(|bits| bits.count_ones() == 2).count()
    }

    /// Takes the sides of a node.
    pub(super) fn set(&mut self, node: &Node<'_>, edge_vertices: &[EdgeVertex]) {
        for (edge, side) in node.sides.iter().enumerate() {
            let (corners, middles) = (&mut self.corners[edge], &mut self.middles[edge]);
            corners.clear();
            middles.clear();
            let unit = (edge_vertices[side.last].at - edge_vertices[side.first].at) >> node.depth;
            let mut at = 0;
            corners.push(side.edge_vertex(0) as u32);
            while at < side.segments() {
                let (from, next) = (side.edge_vertex(at), side.edge_vertex(at + 1));
                if edge_vertices[from].at.abs_diff(edge_vertices[next].at) == unit {
                    middles.push(NONE);
                    at += 1;
                } else {
                    middles.push(next as u32);
                    at += 2;
                }
                corners.push(side.edge_vertex(at) as u32);
            }
        }
    }

    /// The edge vertex at a corner of a leaf on a side.
    #[inline]
    pub(super) fn corner(&self, edge: usize, i: usize) -> usize {
        self.corners[edge][i] as usize
    }

    /// The edge vertices in the middles of the edges of the leaf at (i, j), of n a side.
    #[inline]
    pub(super) fn split(&self, n: usize, i: usize, j: usize) -> [Option<usize>; 3] {
        let middle = |edge: usize, at: usize| {
            let edge_vertex = self.middles[edge][at];
            (edge_vertex != NONE).then_some(edge_vertex as usize)
        };
        [
            if j == 0 { middle(0, i) } else { None },
            if i + j + 1 == n { middle(1, j) } else { None },
            if i == 0 { middle(2, n - 1 - j) } else { None },
        ]
    }

    /// The leaves along the sides, row by row.
    pub(super) fn leaves(n: usize) -> impl Iterator<Item = (usize, usize)> {
        (0..n).flat_map(move |j| {
            let last = n - 1 - j;
            let step = if j == 0 || last == 0 { 1 } else { last };
            (0..=last).step_by(step).map(move |i| (i, j))
        })
    }
}

/// Bits of the edges that are split.
pub(super) fn bits(split: &[Option<usize>; 3]) -> u8 {
    (0..3).fold(0, |bits, edge| {
        bits | u8::from(split[edge].is_some()) << edge
    })
}
