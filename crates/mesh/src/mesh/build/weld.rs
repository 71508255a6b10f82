//! Welding: merging vertices at one position.
//!
//! Takes positions, gives for each vertex the lowest index of the vertices it is merged with (those in
//! no face take no part). Equal positions
//! are found by sorting; those within a distance by a k-d tree's self-join, which needs no grid and therefore
//! no care for distances far smaller or larger than the coordinates.

use super::super::MeshError;
use crate::geometry::DisjointSets;
use crate::vector::{DVec3, vector};

/// Up to this many vertices a tree node is a leaf: pairs are tested one by one.
const LEAF: usize = 8;

/// Merges vertices at equal positions; −0.0 equals 0.0.
pub(super) fn exact(positions: &[[f64; 3]], used: &[bool]) -> Vec<u32> {
    // Adding zero turns −0.0 into 0.0 and leaves all else alone.
    let key = |v: u32| positions[v as usize].map(|x| x + 0.0);
    let compare = |a: &u32, b: &u32| {
        let (p, q) = (key(*a), key(*b));
        let by_place = p[0]
            .total_cmp(&q[0])
            .then(p[1].total_cmp(&q[1]))
            .then(p[2].total_cmp(&q[2]));
        by_place.then(a.cmp(b))
    };
    let mut order: Vec<u32> = (0..positions.len() as u32)
        .filter(|&v| used[v as usize])
        .collect();
    order.sort_unstable_by(compare);
    let mut kept: Vec<u32> = (0..positions.len() as u32).collect();
    for run in order.chunk_by(|&a, &b| positions[a as usize] == positions[b as usize]) {
        for &v in run {
            kept[v as usize] = run[0];
        }
    }
    kept
}

/// For each of some points the first that it is joined with: those within `distance` of each other are, and so on along chains of
/// them, as [`Weld::Within`](super::Weld::Within) joins vertices.
///
/// # Errors
/// A point is not finite, or the distance is not a finite number of at least 0.
pub fn weld_within(points: &[[f64; 3]], distance: f64) -> Result<Vec<u32>, MeshError> {
    super::check_finite(points)?;
    within(points, &vec![true; points.len()], distance)
}

/// Merges vertices within `distance` of each other, and so on along chains of them.
///
/// # Errors
/// The distance is not a finite number of at least 0.
pub(super) fn within(
    positions: &[[f64; 3]],
    used: &[bool],
    distance: f64,
) -> Result<Vec<u32>, MeshError> {
    if !distance.is_finite() || distance < 0.0 {
        return Err(MeshError::BadOption {
            name: "weld distance",
            value: distance,
            expected: "a finite number of at least 0",
        });
    }
    let kept = exact(positions, used);
    if distance == 0.0 {
        return Ok(kept);
    }
    let first = |&v: &u32| used[v as usize] && kept[v as usize] == v;
    let mut order: Vec<u32> = (0..positions.len() as u32).filter(first).collect();
    let mut sets = DisjointSets::from_parents(kept);
    if !order.is_empty() {
        let nodes = Tree::build(positions, &mut order);
        SelfJoin {
            positions,
            order: &order,
            tree: &nodes,
            distance,
            sets: &mut sets,
        }
        .join_all();
    }
    Ok(sets.into_roots())
}

/// A node: a run of the order, its box, and its children (none for a leaf).
struct Node {
    start: usize,
    end: usize,
    low: DVec3,
    high: DVec3,
    children: Option<[usize; 2]>,
}

struct Tree {
    nodes: Vec<Node>,
}

impl Tree {
    /// Reorders the vertices so that each node is a run. Halving keeps the depth at log₂ of their number.
    fn build(positions: &[[f64; 3]], order: &mut [u32]) -> Self {
        let mut tree = Self {
            nodes: Vec::with_capacity(order.len() / (LEAF / 4) + 1),
        };
        tree.add(positions, order, 0);
        tree
    }

    fn add(&mut self, positions: &[[f64; 3]], run: &mut [u32], start: usize) -> usize {
        let point = |v: u32| vector(positions[v as usize]);
        let first = point(run[0]);
        let (low, high) = run.iter().fold((first, first), |(l, h), &v| {
            (l.min(point(v)), h.max(point(v)))
        });
        let node = self.nodes.len();
        self.nodes.push(Node {
            start,
            end: start + run.len(),
            low,
            high,
            children: None,
        });
        if run.len() > LEAF {
            // Halved extents, because the full ones may overflow.
            let extent = high * 0.5 - low * 0.5;
            let axis = (0..3).fold(0, |best, i| if extent[i] > extent[best] { i } else { best });
            let middle = run.len() / 2;
            let along = |v: u32| positions[v as usize][axis];
            run.select_nth_unstable_by(middle, |&a, &b| {
                along(a).total_cmp(&along(b)).then(a.cmp(&b))
            });
            let (left, right) = run.split_at_mut(middle);
            let left = self.add(positions, left, start);
            let right = self.add(positions, right, start + middle);
            self.nodes[node].children = Some([left, right]);
        }
        node
    }
}

/// All pairs of the tree's vertices within the distance, without looking at pairs known to be far, and without
/// looking at each when all are known to be near.
struct SelfJoin<'a> {
    positions: &'a [[f64; 3]],
    order: &'a [u32],
    tree: &'a Tree,
    distance: f64,
    sets: &'a mut DisjointSets,
}

impl SelfJoin<'_> {
    fn join_all(&mut self) {
        // Children stand after their parents, so that backwards each node's parts are joined before itself.
        for node in (0..self.tree.nodes.len()).rev() {
            let Node {
                start,
                end,
                low,
                high,
                children,
            } = self.tree.nodes[node];
            if self.is_within(high - low) {
                let run = &self.order[start..end];
                for &v in run {
                    self.sets.unite(run[0], v);
                }
            } else if let Some([left, right]) = children {
                self.join(left, right);
            } else {
                self.join_pairs(start..end, start..end);
            }
        }
    }

    /// Joins near vertices of two nodes.
    fn join(&mut self, a: usize, b: usize) {
        let (first, second) = (&self.tree.nodes[a], &self.tree.nodes[b]);
        let gap = (second.low - first.high)
            .max(first.low - second.high)
            .max(DVec3::ZERO);
        if !self.is_within(gap) {
            return;
        }
        let together = |node: &Node| self.is_within(node.high - node.low);
        let (from_first, from_second) = (self.order[first.start], self.order[second.start]);
        if together(first)
            && together(second)
            && self.sets.root(from_first) == self.sets.root(from_second)
        {
            return;
        }
        let (runs, one) = (
            [first.start..first.end, second.start..second.end],
            self.order[first.start],
        );
        if self.is_within(first.high.max(second.high) - first.low.min(second.low)) {
            self.sets.unite(one, self.order[second.start]);
            return;
        }
        match (first.children, second.children) {
            (None, None) => {
                let [first, second] = runs;
                self.join_pairs(first, second);
            }
            (Some([left, right]), other) if other.is_none() || runs[0].len() >= runs[1].len() => {
                self.join(left, b);
                self.join(right, b);
            }
            (_, Some([left, right])) => {
                self.join(a, left);
                self.join(a, right);
            }
            (Some(_), None) => {}
        }
    }

    fn join_pairs(&mut self, first: core::ops::Range<usize>, second: core::ops::Range<usize>) {
        for &a in &self.order[first] {
            for &b in &self.order[second.clone()] {
                let apart = vector(self.positions[a as usize]) - vector(self.positions[b as usize]);
                if self.is_within(apart) {
                    self.sets.unite(a, b);
                }
            }
        }
    }

    /// Whether a vector is no longer than the distance; scaled, so that squares neither overflow nor vanish.
    fn is_within(&self, v: DVec3) -> bool {
        (v / self.distance).length_squared() <= 1.0
    }
}
