//! Neighbouring leaves at most one level apart, so that the closure patterns of the paper's Figure 5 close every gap.
//!
//! A node that has children needs a node of its own level beyond each of its edges. From the finest level down, what is
//! missing is split; that asks only for nodes of coarser levels, so each level is done once. The result is the least
//! restriction of the trees, whatever the order. A leaf that asks for the middle of an edge needs a node of its own level beyond that one.
//! All half-edges along an edge of cut sheets count as neighbours.

use std::collections::HashSet;

use super::quadtree::{
    ALL_EDGES, Along, Beyond, Edges, NodeAddress, Trees, asks, beyond, even_depth,
};
use crate::progress::Cancelled;

/// Nodes whose neighbours must exist beyond some edges, given by their bits, by level.
#[derive(Default)]
pub(super) struct Pending(Vec<Vec<(NodeAddress, u8)>>);

impl Pending {
    /// A node that has children.
    pub(super) fn push(&mut self, place: NodeAddress) {
        self.push_beyond(place, ALL_EDGES);
    }

    /// A node whose neighbours must exist beyond the edges of these bits.
    pub(super) fn push_beyond(&mut self, place: NodeAddress, edges: u8) {
        let level = place.level as usize;
        if self.0.len() <= level {
            self.0.resize_with(level + 1, Vec::new);
        }
        self.0[level].push((place, edges));
    }

    /// Those nodes with children in the tree of a control face that lack a neighbour: of even nodes the lowest ones, which speak for
    /// those above.
    pub(super) fn push_tree(&mut self, trees: &Trees, edges: &Edges<'_>, face: u32) {
        self.push_below(trees, edges, trees.root(face), NodeAddress::root(face));
    }

    fn push_below(&mut self, trees: &Trees, edges: &Edges<'_>, word: u32, place: NodeAddress) {
        match even_depth(word) {
            Some(0) => {
                let is_lacking =
                    |edge: &usize| asks(word, *edge) && lacks(trees, edges, place, *edge);
                let bits = (0..3)
                    .filter(is_lacking)
                    .fold(0, |bits, edge| bits | 1 << edge);
                if bits != 0 {
                    self.push_beyond(place, bits);
                }
            }
            Some(depth) => {
                // Inside, neighbours are equally deep, and so are most of those around it.
                for edge in (0..3).filter(|&edge| !is_as_deep(trees, edges, place, depth, edge)) {
                    for index in 0..1 << (depth - 1) {
                        let lowest = place.along(edge, depth - 1, index);
                        if lacks(trees, edges, lowest, edge) {
                            self.push(lowest);
                        }
                    }
                }
            }
            None => {
                if (0..3).any(|edge| lacks(trees, edges, place, edge)) {
                    self.push(place);
                }
                for child in 0..4 {
                    self.push_below(trees, edges, trees.child(word, child), place.child(child));
                }
            }
        }
    }

    /// Moves what another has over.
    pub(super) fn append(&mut self, other: Pending) {
        if self.0.len() < other.0.len() {
            self.0.resize_with(other.0.len(), Vec::new);
        }
        self.0
            .iter_mut()
            .zip(other.0)
            .for_each(|(own, mut list)| own.append(&mut list));
    }
}

/// Whether all nodes beyond an edge of an even one are even, too, and at most a level less deep.
fn is_as_deep(
    trees: &Trees,
    edges: &Edges<'_>,
    place: NodeAddress,
    depth: u32,
    edge: usize,
) -> bool {
    edges
        .nodes_beyond(place, edge)
        .into_iter()
        .all(|(other, _)| {
            let below = trees.word_at(other).and_then(even_depth);
            below.is_some_and(|below| below + 1 >= depth)
        })
}

/// Whether a node of the same level beyond an edge is missing.
fn lacks(trees: &Trees, edges: &Edges<'_>, place: NodeAddress, edge: usize) -> bool {
    let mut beyond = edges.nodes_beyond(place, edge).into_iter();
    !place.has_sibling_beyond(edge) && beyond.any(|(other, _)| !trees.has(other))
}

/// Splits what must be for the nodes in `pending`; `split` is called with each place that was. `false` if there would be too many
/// nodes.
pub(super) fn balance(
    trees: &mut Trees,
    edges: &Edges<'_>,
    mut pending: Pending,
    poll: &mut dyn FnMut() -> Result<(), Cancelled>,
    mut split: impl FnMut(NodeAddress),
) -> Result<bool, Cancelled> {
    let mut ensured = HashSet::new();
    let mut fresh = Vec::new();
    let mut steps = 0usize;
    // No split is missing at a control face.
    for level in (1..pending.0.len()).rev() {
        while let Some((place, bits)) = pending.0[level].pop() {
            steps += 1;
            if steps.is_multiple_of(1 << 12) {
                poll()?;
            }
            let wants = |edge: &usize| bits >> edge & 1 != 0 && !place.has_sibling_beyond(*edge);
            for edge in (0..3).filter(wants) {
                let mut ensure =
                    |place: NodeAddress| trees.ensure(place, |place| fresh.push(place));
                let fits = match beyond(place, edge) {
                    Beyond::Same(other) => ensure(other),
                    Beyond::Control(along) => ensure_along(edges, along, &mut ensured, ensure),
                };
                if !fits {
                    return Ok(false);
                }
                for place in fresh.drain(..) {
                    split(place);
                    pending.push(place);
                }
            }
        }
    }
    Ok(true)
}

/// Asks for the nodes along a part of an edge, on all other faces there; of the copies of a cut edge once for all.
fn ensure_along(
    edges: &Edges<'_>,
    along: Along,
    ensured: &mut HashSet<(usize, u32, u32)>,
    mut ensure: impl FnMut(NodeAddress) -> bool,
) -> bool {
    let h = along.half_edge;
    if let Some(twin) = edges.twin(h) {
        return ensure(along.node_at(twin, true).0);
    }
    let Some(group) = edges.group(h) else {
        return true;
    };
    let members = edges.members(group);
    let own = members
        .iter()
        .any(|&(member, turned)| member == h && turned);
    // As the group's first half-edge counts.
    let index = if own {
        (1 << along.level) - 1 - along.index
    } else {
        along.index
    };
    if !ensured.insert((group, along.level, index)) {
        return true;
    }
    let first = Along { index, ..along };
    members
        .iter()
        .all(|&(member, turned)| ensure(first.node_at(member, turned).0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::adaptive::quadtree::{LEAF, Piece, is_split};
    use limitmesh_testing::Random;
    use limitmesh_testing::models::model;

    /// The places of all leaves.
    fn leaves(trees: &Trees, word: u32, place: NodeAddress, found: &mut Vec<NodeAddress>) {
        if !is_split(word) {
            found.push(place);
        } else {
            (0..4).for_each(|child| {
                leaves(trees, trees.child(word, child), place.child(child), found)
            });
        }
    }

    /// The level of the leaf at a place, or of the node there if it has children.
    fn level_at(trees: &Trees, place: NodeAddress) -> u32 {
        let mut word = trees.root(place.face);
        for level in 0..place.level {
            if !is_split(word) {
                return level;
            }
            word = trees.child(word, place.digit(level));
        }
        place.level
    }

    /// Repeated passes over all leaves, splitting what is two levels above a neighbour, until nothing changes.
    fn brute_force(trees: &mut Trees, edges: &Edges<'_>, faces: u32) {
        loop {
            let mut missing = Vec::new();
            for face in 0..faces {
                let mut found = Vec::new();
                leaves(trees, trees.root(face), NodeAddress::root(face), &mut found);
                for leaf in found.into_iter().filter(|leaf| leaf.level > 1) {
                    for edge in 0..3 {
                        let other = match beyond(leaf, edge) {
                            Beyond::Same(place) => place,
                            Beyond::Control(along) => {
                                let Some(twin) = edges.twin(along.half_edge) else {
                                    continue;
                                };
                                along.node_at(twin, true).0
                            }
                        };
                        let above = NodeAddress {
                            level: other.level - 1,
                            path: other.path >> 2,
                            ..other
                        };
                        if level_at(trees, other) < other.level - 1 {
                            missing.push(above);
                        }
                    }
                }
            }
            if missing.is_empty() {
                return;
            }
            missing
                .into_iter()
                .for_each(|place| assert!(trees.ensure(place, |_| ())));
        }
    }

    #[test]
    fn the_least_restriction_is_found() {
        let mut random = Random::new(5);
        for name in ["tetrahedron", "torus", "sheet"] {
            let mesh = model(name);
            let edges = Edges::of(&mesh);
            for _ in 0..20 {
                let roots: Vec<u32> = (0..mesh.face_count())
                    .map(|_| LEAF + random.below(3) as u32)
                    .collect();
                let mut trees = Trees::of(
                    &[Piece {
                        roots,
                        words: vec![],
                    }],
                    &mut || Ok(()),
                )
                .unwrap();
                for _ in 0..3 {
                    let face = random.below(mesh.face_count()) as u32;
                    let level = 3 + random.below(3) as u32;
                    let place = NodeAddress {
                        face,
                        level,
                        path: random.below(1 << (2 * level)) as u64,
                    };
                    assert!(trees.ensure(place, |_| ()));
                }
                let mut expected = trees.clone();
                brute_force(&mut expected, &edges, mesh.face_count() as u32);
                let mut pending = Pending::default();
                (0..mesh.face_count() as u32)
                    .for_each(|face| pending.push_tree(&trees, &edges, face));
                assert!(balance(&mut trees, &edges, pending, &mut || Ok(()), |_| ()).unwrap());
                for face in 0..mesh.face_count() as u32 {
                    let (mut a, mut b) = (Vec::new(), Vec::new());
                    leaves(&trees, trees.root(face), NodeAddress::root(face), &mut a);
                    leaves(
                        &expected,
                        expected.root(face),
                        NodeAddress::root(face),
                        &mut b,
                    );
                    assert_eq!(a, b, "{name}, face {face}");
                }
            }
        }
    }
}
