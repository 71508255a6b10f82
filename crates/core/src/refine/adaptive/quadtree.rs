//! Quadtrees over the control faces.
//!
//! A tree is a word for its root. [`LEAF`] with a depth `m` says that all leaves lie `m` levels below, and [`PROVEN`] that their bounds are known.
//! A leaf may also ask for the middles of some of its edges, three bits from [`ASKED`] on: the edge is then split for both sides, the leaf
//! is not. Anything else is the index of four consecutive words, those of the children, which [`crate::node`] numbers.

use crate::mesh::MeshError;
pub(super) use crate::node::{Along, Beyond, Edges, NodeAddress, along_edge, beyond};
use crate::progress::Cancelled;
use crate::refine::{RefineError, exact_options};

/// Marks the word of a node below which all leaves are equally deep; the lowest bits are their depth below it.
pub(super) const LEAF: u32 = 1 << 31;

/// Marks leaves that are within the limit if the triangles around them keep what was assumed of them ([`super::judge::Allowance`]).
pub(super) const PROVEN: u32 = 1 << 30;

/// The depth of leaves below a node.
const DEPTH: u32 = (1 << 5) - 1;

/// Marks a leaf that asks for the middle of its first edge; the next bits are those of the others.
const ASKED: u32 = 1 << 5;
const ANY_ASKED: u32 = 7 * ASKED;

/// The bits of all edges of a node.
pub(super) const ALL_EDGES: u8 = 7;

/// Nodes whose indices leave room for the marks.
pub(super) const MOST_NODES: usize = 1 << 28;

/// Levels at most below a control face: paths take two bits a level, and places along an edge are counted in units of the
/// deepest level's edges.
pub(super) const MOST_LEVELS: u32 = exact_options::MOST_LEVELS as u32;

/// Places along the edge of a control face run from 0 to this.
pub(super) const FULL: u32 = 1 << MOST_LEVELS;

/// The trees of all control faces.
#[derive(Clone, Debug)]
pub(super) struct Trees {
    /// The roots, by control face, then children in fours.
    words: Vec<u32>,
}

/// Whether a node has children.
#[inline]
pub(super) fn is_split(word: u32) -> bool {
    word & LEAF == 0 || word & DEPTH != 0
}

/// Whether the leaves below a node, which are equally deep, are marked as proven.
#[inline]
pub(super) fn is_proven(word: u32) -> bool {
    word & (LEAF | PROVEN) == LEAF | PROVEN
}

/// The depth of the leaves below a node where they are equally deep.
#[inline]
pub(super) fn even_depth(word: u32) -> Option<u32> {
    (word & LEAF != 0).then_some(word & DEPTH)
}

/// The word of a leaf that asks for the middles of edges, by their bits.
pub(super) fn asking(edges: u8) -> u32 {
    LEAF | (u32::from(edges) * ASKED)
}

/// Whether a node is a leaf that asks for the middle of an edge.
#[inline]
pub(super) fn asks(word: u32, edge: usize) -> bool {
    word & LEAF != 0 && word & (ASKED << edge) != 0
}

/// How often an edge of a node is halved by the node, where it is so evenly.
#[inline]
pub(super) fn even_depth_along(word: u32, edge: usize) -> Option<u32> {
    even_depth(word).map(|depth| depth + u32::from(asks(word, edge)))
}

/// Whether there is a node at a place that has no children.
pub(super) fn is_leaf(trees: &Trees, place: NodeAddress) -> bool {
    trees.word_at(place).is_some_and(|word| !is_split(word))
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
            return Err(MeshError::TooMany {
                what: "nodes",
                count,
                limit: MOST_NODES,
            }
            .into());
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
        if word & LEAF != 0 {
            word - 1
        } else {
            self.words[word as usize + child]
        }
    }

    /// The error for `more` words than fit.
    pub(super) fn too_many(&self, more: usize) -> MeshError {
        MeshError::TooMany {
            what: "nodes",
            count: self.words.len() + more,
            limit: MOST_NODES,
        }
    }

    /// The deepest level of a leaf below a node.
    pub(super) fn depth(&self, word: u32) -> u32 {
        match even_depth(word) {
            Some(depth) => depth,
            None => {
                1 + (0..4)
                    .map(|child| self.depth(self.child(word, child)))
                    .fold(0, u32::max)
            }
        }
    }

    /// Whether there is a node at `place`.
    pub(super) fn has(&self, place: NodeAddress) -> bool {
        self.word_at(place).is_some()
    }

    /// The word of the node at a place, if there is one.
    pub(super) fn word_at(&self, place: NodeAddress) -> Option<u32> {
        let mut at = place.face as usize;
        for level in 0..place.level {
            let word = self.words[at];
            if word & LEAF != 0 {
                let below = place.level - level;
                return even_depth(word)
                    .filter(|&depth| depth >= below)
                    .map(|_| word - below);
            }
            at = word as usize + place.digit(level);
        }
        Some(self.words[at])
    }

    /// Whether the edge of a leaf has a middle: the leaf itself asks for it, or a node beyond has one.
    pub(super) fn has_middle(&self, edges: &Edges<'_>, place: NodeAddress, edge: usize) -> bool {
        let is_halved = |(place, edge): (NodeAddress, usize)| {
            self.word_at(place)
                .is_some_and(|word| is_split(word) || asks(word, edge))
        };
        is_halved((place, edge)) || edges.nodes_beyond(place, edge).into_iter().any(is_halved)
    }

    /// Splits whatever must be for the node at `place` to exist; `fresh` is called with the places that were split. `false` if there
    /// would be too many nodes.
    pub(super) fn ensure(
        &mut self,
        place: NodeAddress,
        mut fresh: impl FnMut(NodeAddress),
    ) -> bool {
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
                    fresh(NodeAddress {
                        level,
                        path: place.path >> (2 * (place.level - level)),
                        ..place
                    });
                }
                match self.opened(at) {
                    Some(first) => first,
                    None => return false,
                }
            };
            at = first as usize + place.digit(level);
        }
        true
    }

    /// Splits the leaf at `place`. `false` if there would be too many nodes.
    pub(super) fn split(&mut self, place: NodeAddress, fresh: impl FnMut(NodeAddress)) -> bool {
        self.ensure(place.child(0), fresh)
    }

    /// Has the leaf at a place ask for the middle of an edge. `false` if there would be too many nodes.
    pub(super) fn ask(&mut self, place: NodeAddress, edge: usize) -> bool {
        let mut at = place.face as usize;
        for level in 0..place.level {
            // Leaves that ask are kept one by one.
            let Some(first) = self.opened(at) else {
                return false;
            };
            at = first as usize + place.digit(level);
        }
        debug_assert!(!is_split(self.words[at]), "a leaf asks");
        self.words[at] = self.words[at] & !PROVEN | ASKED << edge;
        true
    }

    /// The children of a node, which have words of their own from now on.
    fn opened(&mut self, at: usize) -> Option<u32> {
        let (word, first) = (self.words[at], self.words.len());
        if word & LEAF == 0 {
            return Some(word);
        }
        if first + 4 >= MOST_NODES {
            return None;
        }
        let below = if is_split(word) { word - 1 } else { LEAF };
        self.words.extend([below; 4]);
        self.words[at] = first as u32;
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
        let is_even = first & (LEAF | ANY_ASKED) == LEAF && first & DEPTH < MOST_LEVELS;
        if is_even && children.iter().all(|&child| child == first) {
            return first + 1;
        }
        self.irregular_node(children)
    }

    /// The word of a node so many levels above its leaves, of which nothing is known.
    pub(super) fn even(&mut self, levels: u32) -> u32 {
        if levels == 0 {
            return LEAF;
        }
        let children = [0; 4].map(|_| self.even(levels - 1));
        self.irregular_node(children)
    }

    /// Adds a node where the surface is not regular: such nodes are kept one by one, so that all even blocks are regular.
    pub(super) fn irregular_node(&mut self, children: [u32; 4]) -> u32 {
        let at = self.words.len() as u32;
        self.words.extend(children);
        at
    }
}
