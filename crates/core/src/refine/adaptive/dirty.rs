//! Changes in the trees since their leaves were covered: everything at first, then leaves that were split.

use super::quadtree::{Along, Beyond, Edges, FULL, NodeAddress, beyond};

/// Control faces whose cover may be another than it was, and why.
pub(super) struct Dirty {
    /// Whether nothing was covered yet.
    pub(super) is_all: bool,
    /// By control face, whether leaves were split on it or beyond its edges.
    is_marked: Vec<bool>,
    /// Leaves that were split.
    split: Vec<NodeAddress>,
    /// Leaves that ask for the middle of an edge since then.
    asking: Vec<(NodeAddress, usize)>,
}

impl Dirty {
    /// Nothing.
    pub(super) fn none(faces: usize) -> Self {
        Self {
            is_all: false,
            is_marked: vec![false; faces],
            split: Vec::new(),
            asking: Vec::new(),
        }
    }

    /// Everything.
    pub(super) fn all(faces: usize) -> Self {
        Self {
            is_all: true,
            is_marked: vec![true; faces],
            split: Vec::new(),
            asking: Vec::new(),
        }
    }

    /// The marked control faces.
    pub(super) fn faces(&self) -> Vec<u32> {
        marked(&self.is_marked)
    }

    /// The leaves that were split.
    pub(super) fn split(&self) -> &[NodeAddress] {
        &self.split
    }

    /// The leaves that ask for the middle of an edge.
    pub(super) fn asking(&self) -> &[(NodeAddress, usize)] {
        &self.asking
    }

    /// The vertices that this has put on edges of control faces: half-edges that keep vertices, ascending, and places on these.
    pub(super) fn inserted(&self, edges: &Edges<'_>) -> Vec<(u32, u32)> {
        let mut inserted = Vec::new();
        for &place in &self.split {
            let along = (0..3).filter(|&edge| place.lies_along(edge));
            along.for_each(|edge| insert(edges, place, edge, &mut inserted));
        }
        let asking = self.asking.iter();
        for &(place, edge) in asking.filter(|(place, edge)| place.lies_along(*edge)) {
            insert(edges, place, edge, &mut inserted);
        }
        inserted.sort_unstable();
        inserted.dedup();
        inserted
    }

    /// Adds a leaf that was split, and marks the control faces that have a vertex on their edges by that.
    pub(super) fn add(&mut self, edges: &Edges<'_>, place: NodeAddress) {
        self.split.push(place);
        self.is_marked[place.face as usize] = true;
        (0..3).for_each(|edge| self.mark_beyond(edges, place, edge));
    }

    /// Adds a leaf that asks for the middle of an edge, and marks the control faces that have it on theirs.
    pub(super) fn ask(&mut self, edges: &Edges<'_>, place: NodeAddress, edge: usize) {
        self.asking.push((place, edge));
        self.is_marked[place.face as usize] = true;
        self.mark_beyond(edges, place, edge);
    }

    /// Marks the control faces beyond a node's edge.
    fn mark_beyond(&mut self, edges: &Edges<'_>, place: NodeAddress, edge: usize) {
        if place.lies_along(edge) {
            let h = 3 * place.face + edge as u32;
            if let Some(twin) = edges.twin(h) {
                self.is_marked[twin as usize / 3] = true;
            } else if let Some(group) = edges.group(h) {
                edges
                    .members(group)
                    .iter()
                    .for_each(|&(h, _)| self.is_marked[h as usize / 3] = true);
            }
        }
    }
}

/// Adds the middle of a node's edge, which lies along one of its control face, for all half-edges there that keep vertices.
fn insert(edges: &Edges<'_>, place: NodeAddress, edge: usize, inserted: &mut Vec<(u32, u32)>) {
    let Beyond::Control(Along {
        half_edge: h,
        level,
        index,
    }) = beyond(place, edge)
    else {
        return;
    };
    let at = (2 * index + 1) * (FULL >> (level + 1));
    let turned = |is_turned: bool| if is_turned { FULL - at } else { at };
    if let Some(twin) = edges.twin(h) {
        inserted.push((h.min(twin), turned(twin < h)));
    } else if let Some(group) = edges.group(h) {
        let members = edges.members(group);
        let own = members
            .iter()
            .any(|&(member, is_turned)| member == h && is_turned);
        inserted.extend(
            members
                .iter()
                .map(|&(member, other)| (member, turned(own != other))),
        );
    } else {
        inserted.push((h, at));
    }
}

/// The numbers of those that are marked.
pub(super) fn marked(is_marked: &[bool]) -> Vec<u32> {
    (0..)
        .zip(is_marked)
        .filter(|&(_, &is_marked)| is_marked)
        .map(|(face, _)| face)
        .collect()
}
