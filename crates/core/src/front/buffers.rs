//! The triangles of a forest in slots, without gaps.

use super::forest::{Forest, NONE};
use crate::closure::{Diagonal, closure};

/// Marks a slot whose triangle was removed.
const NOBODY: u32 = u32::MAX;

/// The changes of an update in a front's buffers: slots that are not named are unchanged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Changes {
    /// Vertices whose positions are new, by their numbers in [`positions`](super::Front::positions); ascending.
    pub vertices: Vec<u32>,
    /// Triangles that are new or have moved, by their numbers in
    /// [`triangles`](super::Front::triangles); ascending. Those beyond the end were removed.
    pub triangles: Vec<u32>,
    /// Nodes that were divided.
    pub divided: usize,
    /// Nodes that were merged.
    pub merged: usize,
}

/// Triangles in slots.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    pub(super) triangles: Vec<[u32; 3]>,
    /// By slot, the node that the triangle is of, and which of its triangles it is.
    owners: Vec<(u32, u8)>,
    written: Vec<u32>,
}

impl Buffers {
    /// Brings the triangles up to date, and reports the slots that were written.
    pub(super) fn update(&mut self, forest: &mut Forest<'_>) -> Vec<u32> {
        let mut holes = core::mem::take(&mut forest.released);
        holes
            .iter()
            .for_each(|&slot| self.owners[slot as usize].0 = NOBODY);
        for node in forest.take_touched() {
            if forest.exists(node) && !forest.is_divided(node) {
                self.leaf(forest, node, &mut holes);
            }
        }
        // From the end, so that a hole is not filled by another.
        holes.sort_unstable_by(|a, b| b.cmp(a));
        for hole in holes {
            let last = self.triangles.len() - 1;
            let (owner, number) = self.owners[last];
            if hole as usize != last {
                self.triangles[hole as usize] = self.triangles[last];
                self.owners[hole as usize] = (owner, number);
                forest.node_mut(owner).own[usize::from(number)] = hole;
                self.written.push(hole);
            }
            self.triangles.pop();
            self.owners.pop();
        }
        let mut written = core::mem::take(&mut self.written);
        written.retain(|&slot| (slot as usize) < self.triangles.len());
        written.sort_unstable();
        written.dedup();
        written
    }

    fn leaf(&mut self, forest: &mut Forest<'_>, node: u32, holes: &mut Vec<u32>) {
        let (found, count) = covering(forest, node);
        let own = forest.node_mut(node);
        let before = usize::from(own.triangles);
        for number in count..before {
            let slot = own.own[number];
            self.owners[slot as usize].0 = NOBODY;
            holes.push(slot);
        }
        own.triangles = count as u8;
        for (number, &triangle) in found[..count].iter().enumerate() {
            if number < before {
                let slot = own.own[number];
                if self.triangles[slot as usize] != triangle {
                    self.triangles[slot as usize] = triangle;
                    self.written.push(slot);
                }
                continue;
            }
            let slot = holes.pop().unwrap_or_else(|| {
                self.triangles.push([0; 3]);
                self.owners.push((NOBODY, 0));
                (self.triangles.len() - 1) as u32
            });
            self.triangles[slot as usize] = triangle;
            self.owners[slot as usize] = (node, number as u8);
            own.own[number] = slot;
            self.written.push(slot);
        }
    }
}

/// The triangles that cover a leaf, four at most, and how many they are.
pub(super) fn covering(forest: &Forest<'_>, node: u32) -> ([[u32; 3]; 4], usize) {
    let corners = forest.node(node).corners;
    let splits = [0, 1, 2].map(|edge| forest.split_of(node, edge));
    let split = (0..3)
        .filter(|&edge| splits[edge].is_some())
        .fold(0, |bits, edge| bits | 1 << edge);
    // The whole edge of a quadrilateral, and the vertices on the edges after and before it.
    let two = match splits {
        [None, Some(after), Some(before)] => Some((0, after, before)),
        [Some(before), None, Some(after)] => Some((1, after, before)),
        [Some(after), Some(before), None] => Some((2, after, before)),
        _ => None,
    };
    let length = |a: u32, b: u32| {
        forest
            .vertices
            .at(a)
            .distance_squared(forest.vertices.at(b))
    };
    let is_from_start = two.is_none_or(|(whole, after, before)| {
        length(corners[whole], after) <= length(corners[(whole + 1) % 3], before)
    });
    let diagonal = if is_from_start {
        Diagonal::FromStart
    } else {
        Diagonal::FromEnd
    };
    // No triangle has the middle of a whole edge.
    let [[a, b, c], [d, e, f]] = [corners, splits.map(|split| split.unwrap_or(NONE))];
    let labelled = [a, b, c, d, e, f];
    let mut found = [[0; 3]; 4];
    let pattern = closure(split, diagonal).triangles();
    found
        .iter_mut()
        .zip(pattern)
        .for_each(|(triangle, labels)| {
            *triangle = labels.map(|label| labelled[usize::from(label)]);
            debug_assert!(!triangle.contains(&NONE));
        });
    (found, pattern.len())
}
