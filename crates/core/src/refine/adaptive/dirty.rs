//! What has changed in the trees since their leaves were closed: trees that were replaced, and leaves that were split.

use super::chains::Inserted;
use super::quadtree::{Beyond, Edges, Place, Trees, beyond, is_split};
use crate::progress::{Cancelled, SharedWatch};

/// Control faces whose closing may be another than it was, and why.
pub(super) struct Dirty {
    /// By control face.
    marks: Vec<Mark>,
    /// Leaves that were split.
    split: Vec<Place>,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Mark {
    Clean,
    /// Leaves were split on it or beside it.
    Split,
    /// Its tree was replaced, or one beside it.
    Replaced,
}

impl Dirty {
    /// Nothing.
    pub(super) fn none(faces: usize) -> Self {
        Self {
            marks: vec![Mark::Clean; faces],
            split: Vec::new(),
        }
    }

    /// Everything.
    pub(super) fn all(faces: usize) -> Self {
        Self {
            marks: vec![Mark::Replaced; faces],
            split: Vec::new(),
        }
    }

    /// The marked control faces.
    pub(super) fn faces(&self) -> Vec<u32> {
        self.marked(|mark| mark > Mark::Clean)
    }

    /// Those whose trees, or others beside them, were replaced.
    pub(super) fn replaced(&self) -> Vec<u32> {
        self.marked(|mark| mark == Mark::Replaced)
    }

    fn marked(&self, is_marked: impl Fn(Mark) -> bool) -> Vec<u32> {
        (0..)
            .zip(&self.marks)
            .filter(|&(_, &mark)| is_marked(mark))
            .map(|(face, _)| face)
            .collect()
    }

    /// The vertices that this has put on edges of control faces.
    pub(super) fn inserted(&self, edges: &Edges<'_>) -> Inserted {
        let replaced = self.replaced().into_iter();
        let anew = replaced.flat_map(|face| 3 * face..3 * face + 3).collect();
        let mut inserted = Inserted {
            anew,
            at: Vec::new(),
        };
        for &place in &self.split {
            let along = (0..3).filter(|&edge| place.lies_along(edge));
            along.for_each(|edge| inserted.add(edges, place, edge));
        }
        inserted.at.sort_unstable();
        inserted.at.dedup();
        inserted
    }

    /// Whether a face must be looked at as a whole.
    pub(super) fn is_replaced(&self, face: u32) -> bool {
        self.marks[face as usize] == Mark::Replaced
    }

    /// The leaves that were split.
    pub(super) fn split(&self) -> &[Place] {
        &self.split
    }

    /// Adds a control face whose tree was replaced: it, and all beyond its edges.
    pub(super) fn replace(&mut self, edges: &Edges<'_>, face: u32) {
        self.marks[face as usize] = Mark::Replaced;
        (3 * face..3 * face + 3).for_each(|h| self.mark_beyond(edges, h, Mark::Replaced));
    }

    /// Adds a leaf that was split, and the control faces that see it: it stands on their edges.
    pub(super) fn add(&mut self, edges: &Edges<'_>, place: Place) {
        self.split.push(place);
        self.mark(place.face, Mark::Split);
        let along = (0..3).filter(|&edge| place.lies_along(edge));
        along.for_each(|edge| self.mark_beyond(edges, 3 * place.face + edge as u32, Mark::Split));
    }

    fn mark(&mut self, face: u32, mark: Mark) {
        let own = &mut self.marks[face as usize];
        *own = mark.max(*own);
    }

    /// Marks the control faces beyond a half-edge.
    fn mark_beyond(&mut self, edges: &Edges<'_>, h: u32, mark: Mark) {
        if let Some(twin) = edges.twin(h) {
            self.mark(twin / 3, mark);
        } else if let Some(group) = edges.group(h) {
            edges
                .members(group)
                .iter()
                .for_each(|&(h, _)| self.mark(h / 3, mark));
        }
    }

    /// Leaves that are new or have other edges split than before, by control face and in the order of a walk, but for faces that were
    /// replaced: the children of leaves that were split, and what is beyond these.
    pub(super) fn leaves(
        &self,
        trees: &Trees,
        edges: &Edges<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<Place>, Cancelled> {
        let mut found = Vec::with_capacity(6 * self.split.len());
        watch.each(&self.split, |&place| {
            let mut add = |place: Place| {
                let is_leaf = || trees.word_at(place).is_some_and(|word| !is_split(word));
                if !self.is_replaced(place.face) && is_leaf() {
                    found.push(place);
                }
            };
            (0..4).for_each(|child| add(place.child(child)));
            for edge in 0..3 {
                each_beyond(edges, place, edge, &mut add);
            }
        })?;
        found.sort_unstable_by(Place::in_order);
        found.dedup();
        Ok(found)
    }
}

/// Shows the nodes of a node's level beyond an edge of it, whether or not they are there: one, but at copies of an edge that was cut.
fn each_beyond(edges: &Edges<'_>, place: Place, edge: usize, show: &mut impl FnMut(Place)) {
    match beyond(place, edge) {
        Beyond::Same(other) => show(other),
        Beyond::Control(along) => {
            if let Some(twin) = edges.twin(along.half_edge) {
                show(along.node_at(twin, true).0);
            } else if let Some(group) = edges.group(along.half_edge) {
                let members = edges.members(group);
                let own = members
                    .iter()
                    .any(|&(member, turned)| member == along.half_edge && turned);
                for &(member, turned) in members
                    .iter()
                    .filter(|&&(member, _)| member != along.half_edge)
                {
                    show(along.node_at(member, turned != own).0);
                }
            }
        }
    }
}

/// Which edges of a leaf the nodes beyond have split, as long as these are no more than a level apart.
pub(super) fn split_edges(trees: &Trees, edges: &Edges<'_>, place: Place) -> [bool; 3] {
    [0, 1, 2].map(|edge| {
        let mut is_divided = false;
        each_beyond(edges, place, edge, &mut |other| {
            is_divided |= trees.word_at(other).is_some_and(is_split);
        });
        is_divided
    })
}
