//! Quadtrees over the control faces.
//!
//! A tree is a word for its root: [`LEAF`] with a depth `m` says that all leaves lie `m` levels below, and how far off they are at most
//! ([`bounded`]); anything else is the place of four consecutive words, those of the children, which [`crate::node`] numbers.

use crate::mesh::MeshError;
pub(super) use crate::node::{Along, Beyond, Edges, Place, along_edge, beyond};
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

/// The depth of leaves below a node.
const DEPTH: u32 = (1 << 5) - 1;

/// What is known of the greatest bound of leaves: the upper bits of the number, the least of them counted up; 0 where nothing is.
const BOUND: u32 = STRICT - 1 - DEPTH;

/// The bits of a number that are left out there.
const LEFT_OUT: u32 = 40;

/// Nodes whose places have room beside the marks.
pub(super) const MOST_NODES: usize = STRICT as usize;

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

/// Whether a control face or node is a leaf without any mark.
#[inline]
pub(super) fn is_plain_leaf(word: u32) -> bool {
    word & !BOUND == LEAF
}

/// Whether a node is a leaf that nobody has judged.
#[inline]
pub(super) fn is_unjudged(word: u32) -> bool {
    even_depth(word) == Some(0) && word & UNJUDGED != 0
}

/// A leaf's word, with what its bound is at most.
#[inline]
pub(super) fn bounded(word: u32, bound: f64) -> u32 {
    if !(bound >= 0.0 && bound.is_finite()) {
        return word;
    }
    let upper = ((bound + 0.0).to_bits() >> LEFT_OUT) as u32 + 1;
    word | upper << DEPTH.count_ones()
}

/// What the bounds of leaves below a node, where they are equally deep, are at most, if it is known and they have no marks.
#[inline]
pub(super) fn bound_of(word: u32) -> Option<f64> {
    let is_known = word & LEAF != 0 && word & MARKS == 0 && word & BOUND != 0;
    is_known.then(|| f64::from_bits(u64::from((word & BOUND) >> DEPTH.count_ones()) << LEFT_OUT))
}

/// The depth of the leaves below a node where they are equally deep.
#[inline]
pub(super) fn even_depth(word: u32) -> Option<u32> {
    (word & LEAF != 0).then_some(word & DEPTH)
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

    /// What refuses `more` words than there are.
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
                    .max()
                    .unwrap_or(0)
            }
        }
    }

    /// Whether there is a node at `place`.
    pub(super) fn has(&self, place: Place) -> bool {
        self.word_at(place).is_some()
    }

    /// The word of the node at a place, if there is one.
    pub(super) fn word_at(&self, place: Place) -> Option<u32> {
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

    /// The node that holds the leaf at a place, and below which all leaves are equally deep.
    pub(super) fn even_node(&self, leaf: Place) -> Place {
        let mut word = self.root(leaf.face);
        let mut level = 0;
        while level < leaf.level && word & LEAF == 0 {
            word = self.child(word, leaf.digit(level));
            level += 1;
        }
        Place {
            level,
            path: leaf.path >> (2 * (leaf.level - level)),
            ..leaf
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
                    fresh(Place {
                        level,
                        path: place.path >> (2 * (place.level - level)),
                        ..place
                    });
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
        self.words
            .extend(piece.words.iter().map(|&word| rebased(word, base)));
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
        let below = if is_split(word) {
            word - 1
        } else {
            LEAF | UNJUDGED | word & STRICT
        };
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
        let is_even = first & LEAF != 0 && first & MARKS == 0 && first & DEPTH < MOST_LEVELS;
        if is_even
            && children
                .iter()
                .all(|child| child & !BOUND == first & !BOUND)
        {
            // Of bounds the greatest, but none where one is not known.
            let bounds = children.map(|child| child & BOUND);
            let [least, most] =
                [u32::min, u32::max].map(|of| bounds.into_iter().reduce(of).unwrap_or(0));
            return (first & !BOUND | if least > 0 { most } else { 0 }) + 1;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Bounds that are read are those that were written, but for what rounding adds.
    #[test]
    fn bounds_are_kept_in_words() {
        let mut random = Random::new(5);
        let bounds = (0..10_000).map(|_| f64::from_bits(random.bits() >> 1));
        let bounds = bounds.filter(|bound| bound.is_finite());
        for bound in bounds.chain([0.0, -0.0, 1.0, f64::MIN_POSITIVE, 5e-324, f64::MAX]) {
            for depth in [0, 1, MOST_LEVELS] {
                let word = bounded(LEAF + depth, bound);
                assert_eq!(
                    (even_depth(word), is_split(word)),
                    (Some(depth), depth > 0),
                    "{bound}"
                );
                let known = bound_of(word).unwrap();
                assert!(bound <= known, "{bound}: {known}");
                assert!(
                    known <= bound * (1.0 + 1.0 / 2048.0) || bound < f64::MIN_POSITIVE,
                    "{bound}: {known}"
                );
            }
        }
        assert_eq!(bound_of(LEAF), None);
        for bound in [f64::INFINITY, f64::NAN, -1.0] {
            assert_eq!(bounded(LEAF, bound), LEAF);
        }
        assert_eq!(bound_of(bounded(LEAF | CONDITIONAL, 1.0)), None);
        let mut piece = Piece::default();
        let leaves = |last| [1.0, 3.0, 2.0, last].map(|bound| bounded(LEAF, bound));
        assert_eq!(
            bound_of(piece.node(leaves(0.5))),
            bound_of(bounded(LEAF, 3.0))
        );
        assert_eq!(piece.node(leaves(f64::INFINITY)), LEAF + 1);
        assert!(piece.words.is_empty());
    }

    #[test]
    fn even_nodes_are_split_where_asked() {
        let mut trees = Trees::of(
            &[
                Piece {
                    roots: vec![LEAF + 2, LEAF],
                    words: vec![],
                },
                Piece::default(),
            ],
            &mut || Ok(()),
        )
        .unwrap();
        let mut fresh = Vec::new();
        let place = Place {
            face: 0,
            level: 4,
            path: 0b11_01_10_00,
        };
        assert!(trees.ensure(place, |place| fresh.push(place)));
        // The first two levels were split already.
        assert_eq!(
            fresh
                .iter()
                .map(|place| (place.level, place.path))
                .collect::<Vec<_>>(),
            [(2, 0b11_01), (3, 0b11_01_10)]
        );
        assert_eq!(
            (trees.depth(trees.root(0)), trees.depth(trees.root(1))),
            (4, 0)
        );
        let middle = trees.child(trees.root(0), 3);
        assert_eq!(even_depth(trees.child(middle, 0)), Some(0));
        assert!(is_split(trees.child(middle, 1)));
    }
}
