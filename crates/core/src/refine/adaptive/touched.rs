//! Leaves whose triangles may not be the same as before: those that were split or ask for a middle, and those beyond such edges.

use super::dirty::Dirty;
use super::quadtree::{Edges, MOST_LEVELS, NodeAddress, Trees, is_leaf};

/// Nodes all of whose leaves have other triangles, in order, none below another.
pub(super) struct Touched(Vec<NodeAddress>);

impl Touched {
    /// Those that a change in the trees has touched.
    pub(super) fn by(dirty: &Dirty, trees: &Trees, edges: &Edges<'_>) -> Self {
        let split = dirty.split().iter().map(|&place| (place, 0..3));
        let asking = dirty.asking().iter();
        let asking = asking.map(|&(place, edge)| (place, edge..edge + 1));
        let mut touched = Vec::new();
        for (place, own) in split.chain(asking) {
            touched.push(place);
            for edge in own {
                let beyond = edges.nodes_beyond(place, edge).into_iter();
                // Nodes that are split have had that middle before.
                touched.extend(
                    beyond
                        .map(|(other, _)| other)
                        .filter(|&other| is_leaf(trees, other)),
                );
            }
        }
        touched.sort_unstable_by_key(|place| (first(place), place.level));
        touched.dedup_by(|place, last| last.holds(*place));
        Self(touched)
    }

    /// Whether a node or one above it is among them.
    pub(super) fn holds(&self, place: NodeAddress) -> bool {
        let after = self
            .0
            .partition_point(|other| first(other) <= first(&place));
        after > 0 && self.0[after - 1].holds(place)
    }
}

/// The triangles of a control face that were not there at the last emission.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Fresh {
    None,
    /// By triangle, whether it was not.
    Some(Vec<bool>),
    All,
}

impl Fresh {
    pub(super) fn is_any(&self) -> bool {
        *self != Self::None
    }
}

/// The control face and, as a path, the first of the deepest nodes below a node.
fn first(place: &NodeAddress) -> (u32, u64) {
    (place.face, place.path << (2 * (MOST_LEVELS - place.level)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::adaptive::quadtree::{LEAF, Piece};
    use limitmesh_testing::Random;
    use limitmesh_testing::models::model;

    /// Against a comparison with all of them.
    #[test]
    fn nodes_below_touched_ones_are_found() {
        let mesh = model("icosphere");
        let (edges, mut random) = (Edges::of(&mesh), Random::new(4));
        for _ in 0..20 {
            let roots = vec![LEAF; mesh.face_count()];
            let words = Vec::new();
            let mut trees = Trees::of(&[Piece { roots, words }], &mut || Ok(())).unwrap();
            let mut dirty = Dirty::none(mesh.face_count());
            for _ in 0..6 {
                let node = random_node(&mut random, mesh.face_count());
                assert!(trees.ensure(node.child(0), |place| dirty.add(&edges, place)));
            }
            let mut all: Vec<NodeAddress> = dirty.split().to_vec();
            for &place in dirty.split() {
                let beyond = (0..3).flat_map(|edge| edges.nodes_beyond(place, edge));
                all.extend(
                    beyond
                        .map(|(other, _)| other)
                        .filter(|&other| is_leaf(&trees, other)),
                );
            }
            let touched = Touched::by(&dirty, &trees, &edges);
            for _ in 0..200 {
                let node = random_node(&mut random, mesh.face_count());
                let expected = all.iter().any(|touched| touched.holds(node));
                assert_eq!(touched.holds(node), expected, "{node:?}");
            }
        }
    }

    fn random_node(random: &mut Random, faces: usize) -> NodeAddress {
        let level = random.below(5);
        let digits = (0..level).map(|_| random.below(4)).collect::<Vec<_>>();
        let root = NodeAddress::root(random.below(faces) as u32);
        digits.into_iter().fold(root, NodeAddress::child)
    }
}
