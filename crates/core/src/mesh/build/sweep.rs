//! Triangulates a simple polygon of many corners by a plane sweep, in O(n log n) whatever its shape.
//!
//! After S. Hertel and K. Mehlhorn, "Fast triangulation of simple polygons" (1983): a line sweeps down; each
//! interval of it inside the polygon carries a chain of corners, from the upper end of its left edge to that of
//! its right edge, below which nothing is triangulated yet. The chain always bulges downwards, so that a corner
//! met at one end of it sees just the part from there to the tangent point.
//!
//! A polygon that crosses itself gives nothing, or triangles that are no disc: the caller checks.

/// Nobody: at the ends of chains and where an edge bounds no interval.
const NONE: u32 = u32::MAX;

/// Intervals in a block of the sweep line; twice as many are split in two. Any size near the square root of
/// the number of intervals does.
const BLOCK: usize = 512;

/// Appends triangles over the counter-clockwise polygon's corners; `None` where the sweep met a crossing.
pub(super) fn triangulate(polygon: &[[f64; 2]], triangles: &mut Vec<u32>) -> Option<()> {
    let n = polygon.len();
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_unstable_by(|&a, &b| {
        let (p, q) = (polygon[a as usize], polygon[b as usize]);
        q[1].total_cmp(&p[1]).then(p[0].total_cmp(&q[0])).then(a.cmp(&b))
    });
    let mut rank = vec![0; n];
    for (i, &v) in order.iter().enumerate() {
        rank[v as usize] = i;
    }
    let mut sweep = Sweep {
        polygon,
        triangles,
        nodes: Vec::with_capacity(n + n / 2),
        intervals: Vec::new(),
        status: Vec::new(),
        left_of: vec![NONE; n],
        right_of: vec![NONE; n],
    };
    for &v in &order {
        let (previous, next) = ((v as usize + n - 1) % n, (v as usize + 1) % n);
        let now = rank[v as usize];
        let previous_is_below = rank[previous] > now;
        let next_is_below = rank[next] > now;
        let is_convex = sweep.area(previous as u32, v, next as u32) > 0.0;
        let previous = previous as u32;
        match (previous_is_below, next_is_below, is_convex) {
            (true, true, true) => sweep.start(v, previous)?,
            (true, true, false) => sweep.split(v, previous)?,
            (false, false, true) => sweep.end(v, previous)?,
            (false, false, false) => sweep.merge(v, previous)?,
            (false, true, _) => sweep.continue_left(v, previous)?,
            (true, false, _) => sweep.continue_right(v, previous)?,
        }
    }
    Some(())
}

/// A corner in a chain.
struct Node {
    corner: u32,
    left: u32,
    right: u32,
}

/// A part of the sweep line inside the polygon. An edge is named by the corner it leaves.
struct Interval {
    left_edge: u32,
    right_edge: u32,
    head: u32,
    tail: u32,
    /// The node of the chain met last, which is the lowest.
    lowest: u32,
}

struct Sweep<'a> {
    polygon: &'a [[f64; 2]],
    triangles: &'a mut Vec<u32>,
    nodes: Vec<Node>,
    intervals: Vec<Interval>,
    /// The intervals that the line crosses now, from left to right, in blocks that are never empty.
    status: Vec<Vec<u32>>,
    /// The interval that an edge bounds on its left, and on its right.
    left_of: Vec<u32>,
    right_of: Vec<u32>,
}

impl Sweep<'_> {
    /// Twice the signed area of a triangle.
    fn area(&self, a: u32, b: u32, c: u32) -> f64 {
        let [a, b, c] = [a, b, c].map(|v| self.polygon[v as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    fn node(&mut self, corner: u32) -> u32 {
        self.nodes.push(Node { corner, left: NONE, right: NONE });
        (self.nodes.len() - 1) as u32
    }

    fn link(&mut self, left: u32, right: u32) {
        self.nodes[left as usize].right = right;
        self.nodes[right as usize].left = left;
    }

    fn corner(&self, node: u32) -> u32 {
        self.nodes[node as usize].corner
    }

    /// Triangles from `v` to the chain that starts at node `first` and runs right, up to where `v` sees it; gives
    /// the node from there on. `all` also takes triangles without area, to use the chain up.
    fn cut_from_left(&mut self, v: u32, mut first: u32, all: bool) -> u32 {
        loop {
            let second = self.nodes[first as usize].right;
            if second == NONE {
                return first;
            }
            let triangle = [v, self.corner(second), self.corner(first)];
            let area = self.area(triangle[0], triangle[1], triangle[2]);
            if !(area > 0.0 || all && area == 0.0) {
                return first;
            }
            self.triangles.extend(triangle);
            first = second;
        }
    }

    /// The same from the chain's right end.
    fn cut_from_right(&mut self, v: u32, mut last: u32) -> u32 {
        loop {
            let before = self.nodes[last as usize].left;
            if before == NONE {
                return last;
            }
            let triangle = [self.corner(before), v, self.corner(last)];
            let area = self.area(triangle[0], triangle[1], triangle[2]);
            if area.is_nan() || area <= 0.0 {
                return last;
            }
            self.triangles.extend(triangle);
            last = before;
        }
    }

    /// Adds `v` at the left end of an interval's chain.
    fn push_left(&mut self, interval: u32, v: u32) {
        let head = self.intervals[interval as usize].head;
        let first = self.cut_from_left(v, head, false);
        let node = self.node(v);
        self.link(node, first);
        let interval = &mut self.intervals[interval as usize];
        (interval.head, interval.lowest) = (node, node);
    }

    /// Adds `v` at the right end of an interval's chain.
    fn push_right(&mut self, interval: u32, v: u32) {
        let tail = self.intervals[interval as usize].tail;
        let last = self.cut_from_right(v, tail);
        let node = self.node(v);
        self.link(last, node);
        let interval = &mut self.intervals[interval as usize];
        (interval.tail, interval.lowest) = (node, node);
    }

    fn interval(&mut self, interval: Interval) -> u32 {
        let id = self.intervals.len() as u32;
        self.left_of[interval.left_edge as usize] = id;
        self.right_of[interval.right_edge as usize] = id;
        self.intervals.push(interval);
        id
    }

    /// The block and place of the first interval whose left edge does not pass left of `v`.
    fn find(&self, v: u32) -> (usize, usize) {
        let passes_left = |&interval: &u32| {
            let edge = self.intervals[interval as usize].left_edge;
            self.area(edge, (edge + 1) % self.polygon.len() as u32, v) > 0.0
        };
        let after = self.status.partition_point(|block| passes_left(&block[0]));
        let block = after.saturating_sub(1);
        (block, self.status.get(block).map_or(0, |block| block.partition_point(passes_left)))
    }

    fn insert(&mut self, (block, place): (usize, usize), interval: u32) {
        if self.status.is_empty() {
            self.status.push(Vec::new());
        }
        self.status[block].insert(place, interval);
        if self.status[block].len() > 2 * BLOCK {
            let upper = self.status[block].split_off(BLOCK);
            self.status.insert(block + 1, upper);
        }
    }

    fn remove(&mut self, v: u32, interval: u32) -> Option<()> {
        let (mut block, mut place) = self.find(v);
        if place == self.status.get(block)?.len() {
            (block, place) = (block + 1, 0);
        }
        if *self.status.get(block)?.get(place)? != interval {
            return None;
        }
        self.status[block].remove(place);
        if self.status[block].is_empty() {
            self.status.remove(block);
        }
        Some(())
    }

    /// Both edges go down and the polygon is between them.
    fn start(&mut self, v: u32, previous: u32) -> Option<()> {
        let place = self.find(v);
        let node = self.node(v);
        let interval = Interval { left_edge: v, right_edge: previous, head: node, tail: node, lowest: node };
        let interval = self.interval(interval);
        self.insert(place, interval);
        Some(())
    }

    /// Both edges go down and the polygon is on their outer sides: the interval there falls in two.
    fn split(&mut self, v: u32, previous: u32) -> Option<()> {
        let (block, place) = self.find(v);
        let interval = *self.status.get(block)?.get(place.checked_sub(1)?)?;
        let Interval { right_edge, tail, lowest, .. } = self.intervals[interval as usize];
        // The lowest corner sees `v`: the right part of the chain starts with a second node for it.
        let second = self.node(self.corner(lowest));
        let right_tail = match self.nodes[lowest as usize].right {
            NONE => second,
            right => {
                self.link(second, right);
                tail
            }
        };
        self.nodes[lowest as usize].right = NONE;
        let left = &mut self.intervals[interval as usize];
        (left.tail, left.right_edge) = (lowest, previous);
        self.right_of[previous as usize] = interval;
        self.push_right(interval, v);
        let right = Interval { left_edge: v, right_edge, head: second, tail: right_tail, lowest: second };
        let right = self.interval(right);
        self.push_left(right, v);
        self.insert((block, place), right);
        Some(())
    }

    /// Both edges come from above and the polygon is between them: its interval ends.
    fn end(&mut self, v: u32, previous: u32) -> Option<()> {
        let interval = self.left_of[previous as usize];
        if interval == NONE || self.right_of[v as usize] != interval {
            return None;
        }
        self.cut_from_left(v, self.intervals[interval as usize].head, true);
        self.remove(v, interval)
    }

    /// Both edges come from above and the polygon is on their outer sides: two intervals become one.
    fn merge(&mut self, v: u32, previous: u32) -> Option<()> {
        let (left, right) = (self.right_of[v as usize], self.left_of[previous as usize]);
        if left == NONE || right == NONE || left == right {
            return None;
        }
        self.push_right(left, v);
        let Interval { right_edge, head, tail, .. } = self.intervals[right as usize];
        let first = self.cut_from_left(v, head, false);
        let middle = self.intervals[left as usize].lowest;
        self.link(middle, first);
        self.remove(v, right)?;
        let merged = &mut self.intervals[left as usize];
        (merged.right_edge, merged.tail) = (right_edge, tail);
        self.right_of[right_edge as usize] = left;
        Some(())
    }

    /// One left edge follows another.
    fn continue_left(&mut self, v: u32, previous: u32) -> Option<()> {
        let interval = self.left_of[previous as usize];
        self.intervals.get_mut(interval as usize)?.left_edge = v;
        self.left_of[v as usize] = interval;
        self.push_left(interval, v);
        Some(())
    }

    /// One right edge follows another.
    fn continue_right(&mut self, v: u32, previous: u32) -> Option<()> {
        let interval = self.right_of[v as usize];
        self.intervals.get_mut(interval as usize)?.right_edge = previous;
        self.right_of[previous as usize] = interval;
        self.push_right(interval, v);
        Some(())
    }
}
