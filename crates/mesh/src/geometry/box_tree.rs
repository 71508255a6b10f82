//! A binary tree of boxes over any items, for searches that visit near items, or those in the way
//! of a ray, first.
//!
//! Items are ordered by median cuts across the longest side of the box of their middles; those with
//! equal coordinates are ordered by their numbers, so that the tree depends on the boxes alone. A
//! node's items are consecutive in that order.

use smallvec::SmallVec;

use crate::vector::DVec3;

/// The least and the greatest corner of a box.
pub type Bounds = [DVec3; 2];

/// A box around no points.
pub const NO_BOUNDS: Bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];

/// The box grown to hold a point.
#[inline]
pub fn grown(bounds: Bounds, point: DVec3) -> Bounds {
    [bounds[0].min(point), bounds[1].max(point)]
}

/// The distance of a point from a box: 0 inside.
#[inline]
pub fn distance_to(bounds: &Bounds, point: DVec3) -> f64 {
    distance_squared_to(bounds, point).sqrt()
}

/// The square of [`distance_to`].
#[inline]
pub fn distance_squared_to(bounds: &Bounds, point: DVec3) -> f64 {
    (bounds[0] - point)
        .max(point - bounds[1])
        .max(DVec3::ZERO)
        .length_squared()
}

/// A box and its contents.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub bounds: Bounds,
    /// Its items, as a range of [`BoxTree::items`].
    first: u32,
    count: u32,
    /// The second of its two children; the first follows the node itself.
    second: u32,
}

impl Node {
    /// Where its items are among [`BoxTree::items`].
    pub fn range(&self) -> core::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// Boxes in boxes, down to those of single items.
#[derive(Clone, Debug)]
pub struct BoxTree {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// The query of a search.
pub trait Search {
    /// A lower bound, for the contents of a box, of the value that the search minimises; infinite
    /// where the search skips it.
    fn bound(&self, bounds: &Bounds) -> f64;

    /// The bound from which the search skips nodes.
    fn limit(&self) -> f64;

    /// Visits an item.
    fn visit(&mut self, item: u32);

    /// Called with the bound of each node that is skipped.
    fn pass_over(&mut self, _bound: f64) {}
}

impl BoxTree {
    /// The tree over boxes, up to `u32::MAX / 2` of them.
    pub fn of(boxes: &[Bounds]) -> Self {
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(2 * boxes.len());
        if !items.is_empty() {
            append(&mut nodes, boxes, &mut items, 0);
        }
        Self { nodes, items }
    }

    /// The nodes: the root first, each followed by the subtree of its first child.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The items in the order of the tree.
    pub fn items(&self) -> &[u32] {
        &self.items
    }

    /// The children of a node, given its number; `None` where it holds a single item.
    pub fn children(&self, node: usize) -> Option<[usize; 2]> {
        let own = &self.nodes[node];
        (own.count > 1).then_some([node + 1, own.second as usize])
    }

    /// Searches from the root, the lesser bound first.
    pub fn search(&self, search: &mut impl Search) {
        let Some(root) = self.nodes.first() else {
            return;
        };
        let mut waiting: SmallVec<[(f64, usize); 64]> = SmallVec::new();
        waiting.push((search.bound(&root.bounds), 0));
        while let Some((bound, node)) = waiting.pop() {
            if bound >= search.limit() {
                search.pass_over(bound);
                continue;
            }
            match self.children(node) {
                None => search.visit(self.items[self.nodes[node].first as usize]),
                Some(children) => {
                    let [a, b] =
                        children.map(|child| (search.bound(&self.nodes[child].bounds), child));
                    let (near, far) = if a.0 <= b.0 { (a, b) } else { (b, a) };
                    waiting.extend([far, near]);
                }
            }
        }
    }
}

/// Appends the subtree over some items, which begin at `first` among all; orders them.
fn append(nodes: &mut Vec<Node>, boxes: &[Bounds], items: &mut [u32], first: u32) {
    let joined = |a: Bounds, &b: &u32| {
        let [low, high] = boxes[b as usize];
        [a[0].min(low), a[1].max(high)]
    };
    let bounds = items.iter().fold(NO_BOUNDS, joined);
    let own = nodes.len();
    nodes.push(Node {
        bounds,
        first,
        count: items.len() as u32,
        second: 0,
    });
    if items.len() < 2 {
        return;
    }
    // Halved before they are added: coordinates may be as large as numbers are.
    let middle = |&item: &u32| {
        let [low, high] = boxes[item as usize];
        0.5 * low + 0.5 * high
    };
    let [low, high] = items.iter().map(middle).fold(NO_BOUNDS, grown);
    let sides = (0.5 * high - 0.5 * low).to_array();
    let axis = (1..3).fold(0, |longest, axis| {
        if sides[axis] > sides[longest] {
            axis
        } else {
            longest
        }
    });
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b))
    });
    let (before, after) = items.split_at_mut(half);
    append(nodes, boxes, before, first);
    nodes[own].second = nodes.len() as u32;
    append(nodes, boxes, after, first + half as u32);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(count: usize) -> Vec<Bounds> {
        let at = |i: usize, step: f64| (0.3 + step * i as f64).fract();
        let boxes = (0..count).map(|i| {
            let low = DVec3::new(at(i, 0.618), at(i, 0.7548), at(i, 0.5698));
            [
                low,
                low + 0.05 * DVec3::new(at(i, 0.31), at(i, 0.17), at(i, 0.93)),
            ]
        });
        boxes.collect()
    }

    /// Looks for the item whose box is nearest to a point.
    struct Nearest<'a> {
        from: DVec3,
        boxes: &'a [Bounds],
        found: (f64, u32),
        visited: usize,
    }

    impl Search for Nearest<'_> {
        fn bound(&self, bounds: &Bounds) -> f64 {
            distance_to(bounds, self.from)
        }

        fn limit(&self) -> f64 {
            self.found.0
        }

        fn visit(&mut self, item: u32) {
            self.visited += 1;
            let distance = distance_to(&self.boxes[item as usize], self.from);
            if distance < self.found.0 {
                self.found = (distance, item);
            }
        }
    }

    #[test]
    fn the_nearest_box_is_found_without_looking_at_all() {
        let boxes = scattered(1000);
        let tree = BoxTree::of(&boxes);
        for at in scattered(200).into_iter().map(|[low, _]| 1.4 * low - 0.2) {
            let mut search = Nearest {
                from: at,
                boxes: &boxes,
                found: (f64::INFINITY, u32::MAX),
                visited: 0,
            };
            tree.search(&mut search);
            let expected = boxes
                .iter()
                .map(|bounds| distance_to(bounds, at))
                .min_by(f64::total_cmp)
                .unwrap_or(f64::NAN);
            assert_eq!(search.found.0, expected);
            assert!(search.visited < 100, "{} of 1000 visited", search.visited);
        }
    }

    #[test]
    fn nodes_hold_their_items_and_leaves_one_each() {
        for count in [0, 1, 2, 3, 17, 256] {
            // Some boxes coincide.
            let boxes: Vec<Bounds> = scattered(count / 2 + 1)
                .into_iter()
                .cycle()
                .take(count)
                .collect();
            let tree = BoxTree::of(&boxes);
            let mut items = tree.items().to_vec();
            items.sort_unstable();
            assert_eq!(items, (0..count as u32).collect::<Vec<_>>());
            assert_eq!(tree.nodes().len(), (2 * count).saturating_sub(1));
            for (number, node) in tree.nodes().iter().enumerate() {
                for &item in &tree.items()[node.range()] {
                    let [low, high] = boxes[item as usize];
                    assert!(node.bounds[0].cmple(low).all() && node.bounds[1].cmpge(high).all());
                }
                match tree.children(number) {
                    None => assert_eq!(node.range().len(), 1),
                    Some([a, b]) => {
                        assert_eq!(tree.nodes()[a].range().start, node.range().start);
                        assert_eq!(tree.nodes()[a].range().end, tree.nodes()[b].range().start);
                        assert_eq!(tree.nodes()[b].range().end, node.range().end);
                    }
                }
            }
        }
    }
}
