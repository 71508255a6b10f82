//! Nodes of quadtrees over the control faces: their addresses, and the nodes beyond their edges.
//! Knows no trees.
//!
//! Children 0 to 2 of a node keep the corner of their number at its place; corner `i` of child 3, the middle one, is the new
//! vertex opposite corner `i`. So child `i` lies along the first half of edge `i` and the second half of edge `i + 2` of its
//! parent, and shares its edge `i + 1` with the middle child, whose edge of the same number runs the other way.

use smallvec::{SmallVec, smallvec};

use crate::index::HalfEdgeId;
use crate::mesh::{Mesh, Topology};

/// A node's place: control face, levels below it, and the child taken on each, the last in the lowest two bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct NodeAddress {
    pub(crate) face: u32,
    pub(crate) level: u32,
    pub(crate) path: u64,
}

impl NodeAddress {
    pub(crate) fn root(face: u32) -> Self {
        Self {
            face,
            level: 0,
            path: 0,
        }
    }

    /// The node that it is a child of.
    pub(crate) fn parent(self) -> Option<Self> {
        Some(Self {
            level: self.level.checked_sub(1)?,
            path: self.path >> 2,
            ..self
        })
    }

    pub(crate) fn child(self, child: usize) -> Self {
        Self {
            level: self.level + 1,
            path: self.path << 2 | child as u64,
            ..self
        }
    }

    /// The node `depth` levels below in column i and row j, as rows run along edge 0 from the first
    /// corner: the upright one, or the inverted one to its right.
    pub(crate) fn leaf(
        self,
        depth: u32,
        (mut i, mut j): (usize, usize),
        mut is_inverted: bool,
    ) -> Self {
        let mut place = self;
        for level in (0..depth).rev() {
            let half = 1 << level;
            let child = if i >= half {
                i -= half;
                1
            } else if j >= half {
                j -= half;
                2
            } else if i + j + 1 + usize::from(is_inverted) <= half {
                0
            } else {
                // The middle child stands the other way.
                (i, j, is_inverted) = (half - 1 - i, half - 1 - j, !is_inverted);
                3
            };
            place = place.child(child);
        }
        place
    }

    /// Whether another is this node or one below it.
    pub(crate) fn holds(self, other: Self) -> bool {
        other.face == self.face
            && other.level >= self.level
            && other.path >> (2 * (other.level - self.level)) == self.path
    }

    /// The child taken on the way from `level` to the next one.
    pub(crate) fn digit(self, level: u32) -> usize {
        (self.path >> (2 * (self.level - 1 - level)) & 3) as usize
    }

    /// Whether an edge of the node lies along an edge of its control face.
    pub(crate) fn lies_along(self, edge: usize) -> bool {
        (0..self.level).all(|level| {
            let child = self.digit(level);
            child == edge || child == (edge + 1) % 3
        })
    }

    /// Whether the node beyond an edge is a child of the same node.
    pub(crate) fn has_sibling_beyond(self, edge: usize) -> bool {
        self.level > 0 && is_beside_sibling((self.path & 3) as usize, edge)
    }

    /// The node of level `down` below this one, at number `index` along edge `edge` from its start.
    pub(crate) fn along(self, edge: usize, down: u32, index: u32) -> Self {
        let digits = (0..down)
            .rev()
            .map(|bit| along_edge(edge, index >> bit & 1 == 1));
        digits.fold(self, |place, child| place.child(child))
    }
}

/// Whether the node beyond an edge of a child is a child of the same parent: every edge of the
/// middle one, and that of any other which faces the middle.
#[inline]
fn is_beside_sibling(child: usize, edge: usize) -> bool {
    child == 3 || edge == (child + 1) % 3
}

/// The child at the first or the second half of an edge.
#[inline]
pub(crate) fn along_edge(edge: usize, second: bool) -> usize {
    if second { (edge + 1) % 3 } else { edge }
}

/// The region beyond an edge of a node.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Beyond {
    /// The node of the same level in the same control face; its edge has the same number.
    Same(NodeAddress),
    /// The node lies along an edge of the control face.
    Control(Along),
}

/// A part of an edge of a control face: `index` counts parts of `level` levels below it from the edge's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Along {
    /// Half-edge of the control mesh.
    pub(crate) half_edge: u32,
    pub(crate) level: u32,
    pub(crate) index: u32,
}

impl Along {
    /// The node of the control face of `half_edge`, which runs along the same edge, the other way if `turned`.
    pub(crate) fn node_at(self, half_edge: u32, turned: bool) -> (NodeAddress, usize) {
        let index = if turned {
            (1 << self.level) - 1 - self.index
        } else {
            self.index
        };
        let edge = (half_edge % 3) as usize;
        (
            NodeAddress::root(half_edge / 3).along(edge, self.level, index),
            edge,
        )
    }
}

/// The region beyond an edge of a node, on the node's own level.
pub(crate) fn beyond(place: NodeAddress, edge: usize) -> Beyond {
    let (mut path, mut level) = (place.path, place.level);
    let (mut index, mut depth) = (0u32, 0u32);
    while level > 0 {
        let child = (path & 3) as usize;
        if is_beside_sibling(child, edge) {
            let sibling = if child == 3 { (edge + 2) % 3 } else { 3 };
            path = path & !3 | sibling as u64;
            // Down again on the other side, where the edge runs the other way.
            for bit in (0..depth).rev() {
                path = path << 2 | along_edge(edge, index >> bit & 1 == 0) as u64;
            }
            return Beyond::Same(NodeAddress { path, ..place });
        }
        index |= u32::from(child != edge) << depth;
        depth += 1;
        path >>= 2;
        level -= 1;
    }
    Beyond::Control(Along {
        half_edge: 3 * place.face + edge as u32,
        level: place.level,
        index,
    })
}

/// The half-edges of the control mesh that run along one edge.
#[derive(Clone, Debug)]
pub(crate) struct Edges<'m> {
    topology: &'m Topology,
    /// By half-edge that is a copy of a cut edge, ascending, its group.
    groups: Vec<(u32, u32)>,
    /// By group, its half-edges and whether each runs against the first.
    members: Vec<Vec<(u32, bool)>>,
}

impl<'m> Edges<'m> {
    pub(crate) fn of(mesh: &'m Mesh) -> Self {
        let topology = mesh.topology();
        let start = |h: u32| mesh.positions()[topology.origin(HalfEdgeId(h)).index()];
        let members: Vec<Vec<(u32, bool)>> = mesh
            .junctions()
            .edges
            .iter()
            .map(|group| {
                group
                    .iter()
                    .map(|&h| (h, start(h) != start(group[0])))
                    .collect()
            })
            .collect();
        let mut groups: Vec<(u32, u32)> = (0..)
            .zip(&members)
            .flat_map(|(group, members)| members.iter().map(move |&(h, _)| (h, group)))
            .collect();
        groups.sort_unstable();
        Self {
            topology,
            groups,
            members,
        }
    }

    pub(crate) fn twin(&self, h: u32) -> Option<u32> {
        self.topology.twin(HalfEdgeId(h)).map(|twin| twin.0)
    }

    /// The group of copies that a half-edge is in.
    pub(crate) fn group(&self, h: u32) -> Option<usize> {
        if self.groups.is_empty() {
            return None;
        }
        let at = self
            .groups
            .binary_search_by_key(&h, |&(member, _)| member)
            .ok()?;
        Some(self.groups[at].1 as usize)
    }

    /// The half-edges of a group, and whether each runs against the first.
    pub(crate) fn members(&self, group: usize) -> &[(u32, bool)] {
        &self.members[group]
    }

    /// The nodes of the same level beyond an edge of a node, on all sheets that meet there, and the number of the edge in each.
    pub(crate) fn nodes_beyond(
        &self,
        place: NodeAddress,
        edge: usize,
    ) -> SmallVec<[(NodeAddress, usize); 1]> {
        let along = match beyond(place, edge) {
            Beyond::Same(other) => return smallvec![(other, edge)],
            Beyond::Control(along) => along,
        };
        let h = along.half_edge;
        if let Some(twin) = self.twin(h) {
            return smallvec![along.node_at(twin, true)];
        }
        let members = self.group(h).map_or(&[][..], |group| self.members(group));
        let is_turned = members.contains(&(h, true));
        let others = members.iter().filter(|&&(member, _)| member != h);
        others
            .map(|&(member, turned)| along.node_at(member, turned != is_turned))
            .collect()
    }

    pub(crate) fn group_count(&self) -> usize {
        self.members.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a node's corners are, in units of its control face's edge over 2 to the level.
    fn corners(place: NodeAddress) -> [[i64; 2]; 3] {
        let full = 1i64 << place.level;
        let mut at = [[0, 0], [full, 0], [0, full]];
        for level in 0..place.level {
            let middle = |a: [i64; 2], b: [i64; 2]| [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
            let middles = [
                middle(at[0], at[1]),
                middle(at[1], at[2]),
                middle(at[2], at[0]),
            ];
            let child = place.digit(level);
            at = if child == 3 {
                [middles[1], middles[2], middles[0]]
            } else {
                let mut own = at;
                own[(child + 1) % 3] = middles[child];
                own[(child + 2) % 3] = middles[(child + 2) % 3];
                own
            };
        }
        at
    }

    #[test]
    fn nodes_beyond_an_edge_share_it() {
        for level in 0..5u32 {
            for path in 0..1u64 << (2 * level) {
                let place = NodeAddress {
                    face: 7,
                    level,
                    path,
                };
                let own = corners(place);
                for edge in 0..3 {
                    let (start, end) = (own[edge], own[(edge + 1) % 3]);
                    match beyond(place, edge) {
                        Beyond::Same(other) => {
                            let theirs = corners(other);
                            assert_eq!(
                                (theirs[edge], theirs[(edge + 1) % 3]),
                                (end, start),
                                "{place:?} {edge}"
                            );
                        }
                        Beyond::Control(along) => {
                            let (back, side) = along.node_at(along.half_edge, false);
                            assert_eq!((back, side), (place, edge));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn nodes_are_found_by_column_and_row() {
        let node = NodeAddress {
            face: 0,
            level: 2,
            path: 0b11_01,
        };
        let depth = 3;
        let whole = corners(node).map(|c| c.map(|x| x << depth));
        let n = 1i64 << depth;
        let at = |i: i64, j: i64| {
            [0, 1].map(|x| {
                whole[0][x]
                    + (whole[1][x] - whole[0][x]) / n * i
                    + (whole[2][x] - whole[0][x]) / n * j
            })
        };
        for j in 0..n {
            for i in 0..n - j {
                let leaf = node.leaf(depth, (i as usize, j as usize), false);
                assert_eq!(corners(leaf), [at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    let leaf = node.leaf(depth, (i as usize, j as usize), true);
                    assert_eq!(
                        corners(leaf),
                        [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]
                    );
                }
            }
        }
    }
}
