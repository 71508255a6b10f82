//! A control face that is closed again and again while leaves are split: what changes is kept apart from what was known of its leaves, so
//! that each time takes what has changed, not all that is there.

use std::collections::BTreeMap;

use super::super::quadtree::{MOST_LEVELS, Place, Trees};
use super::super::surface::SurfacePiece;
use super::judged::{Closed, Counts, Judged};

/// What has changed of a face since it was closed.
pub(in super::super) struct Unfinished {
    /// What is known of leaves now, in the order of places: nothing of those that were split, or need not be judged any more.
    later: BTreeMap<(u64, u32), Option<Judged>>,
    /// How many edges of leaves are split.
    pub(super) split_edges: usize,
    /// The surface over it.
    pub(super) piece: Option<Box<SurfacePiece>>,
}

impl Unfinished {
    pub(in super::super) fn of(known: &Closed) -> Self {
        let split_edges = (known.triangles as usize).saturating_sub(known.leaves);
        Self {
            later: BTreeMap::new(),
            split_edges,
            piece: None,
        }
    }

    /// What is said of a leaf, of which `known` was said before.
    pub(super) fn leaf<'l>(&'l self, known: &'l [Judged], place: Place) -> Option<&'l Judged> {
        match self.later.get(&place.key(MOST_LEVELS)) {
            Some(later) => later.as_ref(),
            None => known
                .binary_search_by(|leaf| leaf.place.in_order(&place))
                .ok()
                .map(|at| &known[at]),
        }
    }

    /// Says something else of a leaf, or nothing.
    pub(super) fn replace(&mut self, known: &[Judged], place: Place, leaf: Option<Judged>) {
        let before = self.leaf(known, place);
        if before.is_none() && leaf.is_none() {
            return;
        }
        self.split_edges -= before.map_or(0, Judged::split_edges);
        self.split_edges += leaf.as_ref().map_or(0, Judged::split_edges);
        self.later.insert(place.key(MOST_LEVELS), leaf);
    }

    /// What the face comes to, with the counts that it has now, and whether that is what was judged before.
    pub(in super::super) fn finish(
        self,
        mut known: Closed,
        trees: &Trees,
        max_levels: u32,
    ) -> (Closed, bool) {
        let before = known
            .judged
            .as_mut()
            .map_or(Vec::new(), |judged| core::mem::take(&mut judged.leaves));
        let mut leaves = Vec::with_capacity(before.len() + self.later.len());
        let mut later = self.later.into_iter().peekable();
        for leaf in before {
            let at = leaf.place.key(MOST_LEVELS);
            while let Some((_, new)) = later.next_if(|&(other, _)| other < at) {
                leaves.extend(new);
            }
            match later.next_if(|&(other, _)| other == at) {
                Some((_, new)) => leaves.extend(new),
                None => leaves.push(leaf),
            }
        }
        leaves.extend(later.filter_map(|(_, new)| new));
        let Closed {
            vertices,
            triangles,
            leaves: count,
            ..
        } = known;
        let found = Closed::of(
            Counts {
                vertices,
                triangles,
                leaves: count,
            },
            leaves,
            trees,
            max_levels,
        );
        let is_same = found.is_judged_as(&known);
        (found, is_same)
    }
}
