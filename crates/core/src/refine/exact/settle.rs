//! The bounds of the leaves among their neighbours as they are emitted.

use super::emit::Emission;
use super::grow::Growth;
use crate::certificate::{STEEP, TriangleFrame, around};
use crate::criterion::{Apart, Region};
use crate::emit::{Diagonal, Pattern, closure};
use crate::mesh::NONE;
use crate::parallel;
use crate::vector::DVec3;

/// Leaves that one call takes together.
const BLOCK: usize = 1024;

impl Growth<'_> {
    /// Takes the bounds of the leaves that were evaluated since, and of their neighbours, with the angles between the
    /// emitted triangles; sets the values of those that come out above `limit`, which they were not expected to.
    /// Whether there are any.
    pub(super) fn settle(&mut self, limit: f64) -> bool {
        let unsettled = core::mem::take(&mut self.unsettled);
        let nodes = self.forest.node_count();
        let is_leaf = |&node: &u32| self.forest.children(node).is_none();
        let mut changed = vec![2 * unsettled.len() > nodes; nodes];
        if 2 * unsettled.len() <= nodes {
            for leaf in unsettled.into_iter().filter(is_leaf) {
                changed[leaf as usize] = true;
                for (edge, second) in [(0, false), (1, false), (2, false), (0, true), (1, true), (2, true)] {
                    if let Some((other, _)) = self.beyond(leaf, edge, second) {
                        changed[other as usize] = true;
                    }
                }
            }
        }
        let leaves: Vec<u32> =
            (0..nodes as u32).filter(|&node| changed[node as usize]).filter(is_leaf).collect();
        let failing = parallel::pieces_of(leaves.len(), BLOCK, |block| {
            let values = leaves[block].iter().map(|&leaf| {
                let scale = self.scales[leaf as usize];
                // What holds without neighbours holds with them; but a leaf whose triangles no camera sees may come into
                // a picture when all that its deviation reaches counts.
                let is_plain =
                    self.options.pixels.is_none() && self.deviations[leaf as usize].own * scale <= limit;
                (leaf, if is_plain { 0.0 } else { self.settled_ratio(leaf) })
            });
            values.filter(|&(_, value)| value > limit).collect::<Vec<_>>()
        });
        let mut fails = false;
        for (leaf, value) in failing.into_iter().flatten() {
            let known = self.values[leaf as usize];
            self.set_value(leaf, value.max(known));
            fails = true;
        }
        fails
    }

    /// The bound of a leaf.
    pub(super) fn settled(&self, leaf: u32) -> f64 {
        let deviation = self.deviations[leaf as usize];
        // Neighbours can't help.
        if deviation.own <= deviation.height {
            return deviation.own;
        }
        let (chord, slope) = self.around(leaf).steepest();
        deviation.bound(chord, slope)
    }

    /// How many times over a leaf fails by its distance.
    fn settled_ratio(&self, leaf: u32) -> f64 {
        self.greatest(leaf, |apart, region| self.criteria.distance_ratio(apart, region))
    }

    /// The greatest distance between the mesh and the surface in the cameras' pictures, in pixels at most; `None` without
    /// cameras.
    pub(super) fn pixels(&self, emission: &Emission) -> Option<f64> {
        let leaves = &emission.leaves.order;
        let of_block = parallel::pieces_of(leaves.len(), BLOCK, |block| {
            let of_leaf = |&leaf: &u32| {
                self.greatest(leaf, |apart, region| self.criteria.pixels(apart, region).unwrap_or(0.0))
            };
            leaves[block].iter().map(of_leaf).fold(0.0, f64::max)
        });
        self.options.pixels.map(|_| of_block.into_iter().fold(0.0, f64::max))
    }

    /// The greatest of what a leaf's triangles come to.
    fn greatest(&self, leaf: u32, value: impl Fn(&Apart, &Region) -> f64) -> f64 {
        let (around, deviation) = (self.around(leaf), self.deviations[leaf as usize]);
        let (chord, slope) = around.steepest();
        let apart = deviation.apart(chord, slope);
        let of_triangle = |corners: [DVec3; 3]| {
            let normal = TriangleFrame::new(corners).normal();
            value(&apart, &Region::around(corners, normal).turned(chord).grown(apart.own))
        };
        around.triangles().map(of_triangle).fold(0.0, f64::max)
    }

    /// The triangles of a leaf and their neighbours, as they are emitted.
    fn around(&self, leaf: u32) -> Surroundings {
        let (pattern, labels) = self.covering(leaf);
        let at = labels.map(|vertex| if vertex == NONE { DVec3::ZERO } else { self.emitted(vertex) });
        // By half-edge of the pattern, the corner opposite of the neighbour. Edges on sharp curves count on their own.
        let mut opposite = [None; 12];
        let open = self.forest.open_edges(leaf);
        for edge in (0..3).filter(|&edge| !open[edge]) {
            let [first, last] = pattern.border(edge);
            for (h, second) in [(first, false), (last, true)] {
                if first != last || !second {
                    let vertex = self.beyond(leaf, edge, second).map(|(_, vertex)| vertex);
                    opposite[h] = vertex.map(|vertex| self.emitted(vertex));
                }
            }
        }
        let triangles = pattern.triangles();
        for (h, opposite) in opposite.iter_mut().enumerate().take(3 * triangles.len()) {
            if let Some(twin) = pattern.twin(h) {
                *opposite = Some(at[triangles[twin / 3][(twin + 2) % 3] as usize]);
            }
        }
        Surroundings { at, pattern, opposite }
    }

    /// How a leaf is covered, and the vertices that its corners and middles are.
    fn covering(&self, leaf: u32) -> (&'static Pattern, [u32; 6]) {
        let [a, b, c] = self.forest.corners(leaf);
        let middles = [0, 1, 2].map(|edge| self.forest.middle(leaf, edge));
        let split = (0..3).fold(0, |bits, edge| bits | u8::from(middles[edge].is_some()) << edge);
        let diagonal = if self.diagonals[leaf as usize] { Diagonal::FromEnd } else { Diagonal::FromStart };
        let [d, e, f] = middles.map(|middle| middle.unwrap_or(NONE));
        (closure(split, diagonal), [a, b, c, d, e, f])
    }

    /// The leaf beyond an edge of a leaf, or beyond its second half where it is split, and the vertex opposite of the
    /// triangle there; `None` at the boundary.
    fn beyond(&self, leaf: u32, edge: usize, second: bool) -> Option<(u32, u32)> {
        let forest = &self.forest;
        let (other, half_edge) = match forest.twin(leaf, edge) {
            Some(twin) => {
                let (other, side) = (twin / 3, twin as usize % 3);
                let other = match forest.children(other) {
                    None => other,
                    Some(first) if second => first + side as u32,
                    Some(first) => first + (side as u32 + 1) % 3,
                };
                (other, self.covering(other).0.border(side)[0])
            }
            // The neighbour is greater: beyond the parent's edge, of which this is a half.
            None => {
                let (parent, place) = forest.parent(leaf)?;
                let twin = forest.twin(parent, edge)?;
                let (other, side) = (twin / 3, twin as usize % 3);
                (other, self.covering(other).0.border(side)[usize::from(place == edge)])
            }
        };
        let (pattern, labels) = self.covering(other);
        let corner = pattern.triangles()[half_edge / 3][(half_edge + 2) % 3];
        Some((other, labels[corner as usize]))
    }
}

/// The triangles of a leaf and the corners opposite of their neighbours.
struct Surroundings {
    /// Where the pattern's vertices lie.
    at: [DVec3; 6],
    pattern: &'static Pattern,
    /// By half-edge of the pattern; `None` beside open edges.
    opposite: [Option<DVec3>; 12],
}

impl Surroundings {
    fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.pattern.triangles().iter().map(|triangle| triangle.map(|corner| self.at[corner as usize]))
    }

    /// The greatest chord of the angles between the planes of the triangles and their neighbours, and the greatest slope at
    /// which points may drift over them.
    fn steepest(&self) -> (f64, f64) {
        let (mut squared, mut slope) = (0.0f64, STEEP);
        for (triangle, opposite) in self.triangles().zip(self.opposite.as_chunks::<3>().0) {
            let (turn, room) = around(triangle, opposite);
            squared = squared.max(turn);
            slope = slope.min(room);
        }
        (squared.sqrt(), slope)
    }
}
