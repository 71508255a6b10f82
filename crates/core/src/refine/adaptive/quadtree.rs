//! Quadtrees over the control faces, and the way from node to node.
//!
//! A tree is a word for its root: [`LEAF`] with a depth `m` says that all leaves lie `m` levels below, anything else is the
//! place of four consecutive words, those of the children. Children 0 to 2 keep the corner of their number at its place; corner
//! `i` of child 3, the middle one, is the new vertex opposite corner `i`. So child `i` lies along the first half of edge `i`
//! and the second half of edge `i + 2` of its parent, and shares its edge `i + 1` with the middle child, whose edge of the
//! same number runs the other way.

use crate::index::HalfEdgeId;
use crate::mesh::{Mesh, MeshError, Topology};
use crate::progress::Cancelled;
use crate::refine::{RefineError, exact_options};

/// Marks the word of a node below which all leaves are equally deep; the lowest bits are their depth below it.
pub(super) const LEAF: u32 = 1 << 31;

/// Marks a leaf that was made for its neighbours' sake and has not been judged.
pub(super) const UNJUDGED: u32 = 1 << 30;

/// Marks a leaf that passes if its neighbours turn out as expected.
pub(super) const CONDITIONAL: u32 = 1 << 29;

/// Marks a leaf that, like what it is split into, must pass whatever its neighbours are.
pub(super) const STRICT: u32 = 1 << 28;

/// The marks of leaves.
const MARKS: u32 = UNJUDGED | CONDITIONAL | STRICT;

/// Nodes whose places have room beside the marks.
pub(super) const MOST_NODES: usize = STRICT as usize;

/// Levels at most below a control face: paths take two bits a level, and places along an edge are counted in units of the
/// deepest level's edges.
pub(super) const MOST_LEVELS: u32 = exact_options::MOST_LEVELS as u32;

/// Places along the edge of a control face run from 0 to this.
pub(super) const FULL: u32 = 1 << MOST_LEVELS;

/// A node's place: control face, levels below it, and the child taken on each, the last in the lowest two bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Place {
    pub(super) face: u32,
    pub(super) level: u32,
    pub(super) path: u64,
}

impl Place {
    pub(super) fn root(face: u32) -> Self {
        Self { face, level: 0, path: 0 }
    }

    /// The node that it is a child of.
    pub(super) fn parent(self) -> Option<Self> {
        Some(Self { level: self.level.checked_sub(1)?, path: self.path >> 2, ..self })
    }

    pub(super) fn child(self, child: usize) -> Self {
        Self { level: self.level + 1, path: self.path << 2 | child as u64, ..self }
    }

    /// The node `depth` levels below in column i and row j, as rows run along edge 0 from the first corner: the one that stands
    /// upright there, or the one to its right that stands on its head.
    pub(super) fn leaf(self, depth: u32, (mut i, mut j): (usize, usize), mut is_headlong: bool) -> Self {
        let mut place = self;
        for level in (0..depth).rev() {
            let half = 1 << level;
            let child = if i >= half {
                i -= half;
                1
            } else if j >= half {
                j -= half;
                2
            } else if i + j + 1 + usize::from(is_headlong) <= half {
                0
            } else {
                // The middle child stands the other way.
                (i, j, is_headlong) = (half - 1 - i, half - 1 - j, !is_headlong);
                3
            };
            place = place.child(child);
        }
        place
    }

    /// Whether a walk over the face comes to this node before the other, or to one that holds it.
    pub(super) fn precedes(self, other: Self) -> bool {
        let most = self.level.max(other.level);
        let path = |place: Self| place.path << (2 * (most - place.level));
        (path(self), self.level) < (path(other), other.level)
    }

    /// The child taken on the way from `level` to the next one.
    pub(super) fn digit(self, level: u32) -> usize {
        (self.path >> (2 * (self.level - 1 - level)) & 3) as usize
    }

    /// The node of level `down` below this one, at number `index` along edge `edge` from its start.
    pub(super) fn along(self, edge: usize, down: u32, index: u32) -> Self {
        let digits = (0..down).rev().map(|bit| along_edge(edge, index >> bit & 1 == 1));
        digits.fold(self, |place, child| place.child(child))
    }
}

/// The child at the first or the second half of an edge.
#[inline]
pub(super) fn along_edge(edge: usize, second: bool) -> usize {
    if second { (edge + 1) % 3 } else { edge }
}

/// What lies beyond an edge of a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beyond {
    /// The node of the same level in the same control face; its edge has the same number.
    Same(Place),
    /// The node lies along an edge of the control face.
    Control(Along),
}

/// A part of an edge of a control face: `index` counts parts of `level` levels below it from the edge's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Along {
    /// Half-edge of the control mesh.
    pub(super) half_edge: u32,
    pub(super) level: u32,
    pub(super) index: u32,
}

impl Along {
    /// The node of the control face of `half_edge`, which runs along the same edge, the other way if `turned`.
    pub(super) fn node_at(self, half_edge: u32, turned: bool) -> (Place, usize) {
        let index = if turned { (1 << self.level) - 1 - self.index } else { self.index };
        let edge = (half_edge % 3) as usize;
        (Place::root(half_edge / 3).along(edge, self.level, index), edge)
    }
}

/// What lies beyond an edge of a node, on the node's own level.
pub(super) fn beyond(place: Place, edge: usize) -> Beyond {
    let (mut path, mut level) = (place.path, place.level);
    let (mut index, mut depth) = (0u32, 0u32);
    while level > 0 {
        let child = (path & 3) as usize;
        if child == 3 || edge == (child + 1) % 3 {
            let sibling = if child == 3 { (edge + 2) % 3 } else { 3 };
            path = path & !3 | sibling as u64;
            // Down again on the other side, where the edge runs the other way.
            for bit in (0..depth).rev() {
                path = path << 2 | along_edge(edge, index >> bit & 1 == 0) as u64;
            }
            return Beyond::Same(Place { path, ..place });
        }
        index |= u32::from(child != edge) << depth;
        depth += 1;
        path >>= 2;
        level -= 1;
    }
    Beyond::Control(Along { half_edge: 3 * place.face + edge as u32, level: place.level, index })
}

/// The trees of all control faces.
#[derive(Clone, Debug)]
pub(super) struct Trees {
    /// The roots, by control face, then children in fours.
    words: Vec<u32>,
}

/// Whether a node has children.
#[inline]
pub(super) fn is_split(word: u32) -> bool {
    word & !MARKS != LEAF
}

/// The depth of the leaves below a node where they are equally deep.
#[inline]
pub(super) fn even_depth(word: u32) -> Option<u32> {
    (word & LEAF != 0).then_some(word & !(LEAF | MARKS))
}

impl Trees {
    /// Trees from pieces: for consecutive runs of control faces their roots, and words whose children count from the
    /// piece's own first.
    ///
    /// # Errors
    /// There are too many, or the observer asked to stop.
    pub(super) fn of(
        pieces: &[Piece],
        poll: &mut dyn FnMut() -> Result<(), Cancelled>,
    ) -> Result<Self, RefineError> {
        let faces: usize = pieces.iter().map(|piece| piece.roots.len()).sum();
        let words: usize = pieces.iter().map(|piece| piece.words.len()).sum();
        let count = faces + words;
        if count >= MOST_NODES {
            return Err(MeshError::TooMany { what: "nodes", count, limit: MOST_NODES }.into());
        }
        let mut all = Vec::with_capacity(faces + words + words / 8);
        let mut base = faces as u32;
        for piece in pieces {
            all.extend(piece.roots.iter().map(|&word| rebased(word, base)));
            base += piece.words.len() as u32;
        }
        base = faces as u32;
        for piece in pieces {
            all.extend(piece.words.iter().map(|&word| rebased(word, base)));
            base += piece.words.len() as u32;
            poll()?;
        }
        Ok(Self { words: all })
    }

    /// The word of a control face.
    #[inline]
    pub(super) fn root(&self, face: u32) -> u32 {
        self.words[face as usize]
    }

    /// The word of a child of a node that has children.
    #[inline]
    pub(super) fn child(&self, word: u32, child: usize) -> u32 {
        if word & LEAF != 0 { word - 1 } else { self.words[word as usize + child] }
    }

    /// What refuses `more` words than there are.
    pub(super) fn too_many(&self, more: usize) -> MeshError {
        MeshError::TooMany { what: "nodes", count: self.words.len() + more, limit: MOST_NODES }
    }

    /// The deepest level of a leaf below a node.
    pub(super) fn depth(&self, word: u32) -> u32 {
        match even_depth(word) {
            Some(depth) => depth,
            None => 1 + (0..4).map(|child| self.depth(self.child(word, child))).max().unwrap_or(0),
        }
    }

    /// Splits whatever must be for the node at `place` to exist; `fresh` is told the places that were split. `false` if there
    /// would be too many nodes.
    pub(super) fn ensure(&mut self, place: Place, mut fresh: impl FnMut(Place)) -> bool {
        let mut at = place.face as usize;
        for level in 0..place.level {
            let word = self.words[at];
            let first = if word & LEAF == 0 {
                word
            } else {
                // Even nodes stay whole as long as they hold the node.
                if even_depth(word).is_some_and(|depth| depth >= place.level - level) {
                    return true;
                }
                if !is_split(word) {
                    fresh(Place { level, path: place.path >> (2 * (place.level - level)), ..place });
                }
                match self.expanded(word) {
                    Some(first) => {
                        self.words[at] = first;
                        first
                    }
                    None => return false,
                }
            };
            at = first as usize + place.digit(level);
        }
        true
    }

    /// Demands of the leaf at `place` that it, and what it is split into, passes whatever its neighbours are.
    pub(super) fn make_strict(&mut self, place: Place) {
        let mut at = place.face as usize;
        for level in 0..place.level {
            match even_depth(self.words[at]) {
                None => at = self.words[at] as usize + place.digit(level),
                Some(_) => return,
            }
        }
        if !is_split(self.words[at]) {
            self.words[at] |= STRICT;
        }
    }

    /// Splits the leaf at `place`. `false` if there would be too many nodes.
    pub(super) fn split(&mut self, place: Place, fresh: impl FnMut(Place)) -> bool {
        self.ensure(place.child(0), fresh)
    }

    /// Replaces the tree of a control face. `false` if there would be too many nodes.
    pub(super) fn replace(&mut self, face: u32, piece: &Piece) -> bool {
        let base = self.words.len() as u32;
        if self.words.len() + piece.words.len() >= MOST_NODES {
            return false;
        }
        self.words.extend(piece.words.iter().map(|&word| rebased(word, base)));
        self.words[face as usize] = rebased(piece.roots[0], base);
        true
    }

    /// Four words for the children of a node whose leaves are equally deep.
    fn expanded(&mut self, word: u32) -> Option<u32> {
        let first = self.words.len();
        if first + 4 >= MOST_NODES {
            return None;
        }
        // Nodes whose leaves are equally deep have no marks.
        let below = if is_split(word) { word - 1 } else { LEAF | UNJUDGED | word & STRICT };
        self.words.extend([below; 4]);
        Some(first as u32)
    }
}

fn rebased(word: u32, base: u32) -> u32 {
    if word & LEAF != 0 { word } else { word + base }
}

/// Trees of some consecutive control faces, on their own.
#[derive(Clone, Debug, Default)]
pub(super) struct Piece {
    pub(super) roots: Vec<u32>,
    pub(super) words: Vec<u32>,
}

impl Piece {
    /// The word of a node over a regular part with the given children.
    pub(super) fn node(&mut self, children: [u32; 4]) -> u32 {
        let [first, ..] = children;
        if first & LEAF != 0 && first & MARKS == 0 && children == [first; 4] && first & !LEAF < MOST_LEVELS {
            return first + 1;
        }
        self.irregular_node(children)
    }

    /// The same where the surface is not regular: such nodes are kept one by one, so that what is kept as a whole is regular.
    pub(super) fn irregular_node(&mut self, children: [u32; 4]) -> u32 {
        let at = self.words.len() as u32;
        self.words.extend(children);
        at
    }
}

/// The half-edges of the control mesh that run along one edge.
#[derive(Clone, Debug)]
pub(super) struct Edges<'m> {
    topology: &'m Topology,
    /// By half-edge that is a copy of a cut edge, ascending, its group.
    groups: Vec<(u32, u32)>,
    /// By group, its half-edges and whether each runs against the first.
    members: Vec<Vec<(u32, bool)>>,
}

impl<'m> Edges<'m> {
    pub(super) fn of(mesh: &'m Mesh) -> Self {
        let topology = mesh.topology();
        let start = |h: u32| mesh.positions()[topology.origin(HalfEdgeId(h)).index()];
        let members: Vec<Vec<(u32, bool)>> = mesh
            .junctions()
            .edges
            .iter()
            .map(|group| group.iter().map(|&h| (h, start(h) != start(group[0]))).collect())
            .collect();
        let mut groups: Vec<(u32, u32)> = (0..)
            .zip(&members)
            .flat_map(|(group, members)| members.iter().map(move |&(h, _)| (h, group)))
            .collect();
        groups.sort_unstable();
        Self { topology, groups, members }
    }

    pub(super) fn twin(&self, h: u32) -> Option<u32> {
        self.topology.twin(HalfEdgeId(h)).map(|twin| twin.0)
    }

    /// The group of copies that a half-edge is in.
    pub(super) fn group(&self, h: u32) -> Option<usize> {
        if self.groups.is_empty() {
            return None;
        }
        let at = self.groups.binary_search_by_key(&h, |&(member, _)| member).ok()?;
        Some(self.groups[at].1 as usize)
    }

    /// The half-edges of a group, and whether each runs against the first.
    pub(super) fn members(&self, group: usize) -> &[(u32, bool)] {
        &self.members[group]
    }

    pub(super) fn group_count(&self) -> usize {
        self.members.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a node's corners are, in units of its control face's edge over 2 to the level.
    fn corners(place: Place) -> [[i64; 2]; 3] {
        let full = 1i64 << place.level;
        let mut at = [[0, 0], [full, 0], [0, full]];
        for level in 0..place.level {
            let middle = |a: [i64; 2], b: [i64; 2]| [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
            let middles = [middle(at[0], at[1]), middle(at[1], at[2]), middle(at[2], at[0])];
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
                let place = Place { face: 7, level, path };
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
        let node = Place { face: 0, level: 2, path: 0b11_01 };
        let depth = 3;
        let whole = corners(node).map(|c| c.map(|x| x << depth));
        let n = 1i64 << depth;
        let at = |i: i64, j: i64| {
            [0, 1].map(|x| {
                whole[0][x] + (whole[1][x] - whole[0][x]) / n * i + (whole[2][x] - whole[0][x]) / n * j
            })
        };
        for j in 0..n {
            for i in 0..n - j {
                let leaf = node.leaf(depth, (i as usize, j as usize), false);
                assert_eq!(corners(leaf), [at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    let leaf = node.leaf(depth, (i as usize, j as usize), true);
                    assert_eq!(corners(leaf), [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]);
                }
            }
        }
    }

    #[test]
    fn even_nodes_are_split_where_asked() {
        let mut trees =
            Trees::of(&[Piece { roots: vec![LEAF + 2, LEAF], words: vec![] }, Piece::default()], &mut || {
                Ok(())
            })
            .unwrap();
        let mut fresh = Vec::new();
        let place = Place { face: 0, level: 4, path: 0b11_01_10_00 };
        assert!(trees.ensure(place, |place| fresh.push(place)));
        // The first two levels were split already.
        assert_eq!(
            fresh.iter().map(|place| (place.level, place.path)).collect::<Vec<_>>(),
            [(2, 0b11_01), (3, 0b11_01_10)]
        );
        assert_eq!((trees.depth(trees.root(0)), trees.depth(trees.root(1))), (4, 0));
        let middle = trees.child(trees.root(0), 3);
        assert_eq!(even_depth(trees.child(middle, 0)), Some(0));
        assert!(is_split(trees.child(middle, 1)));
    }
}
