//! Distances of many points of which consecutive ones are near each other, as samples of a surface are.
//!
//! The upper levels of the tree look the same to neighbouring points, so that a group of them shares one walk there.
//! Let c be the centre of a group, d its distance to the surface and r the radius of the group around it. Each
//! point of the group has some point of the surface within d + r, and a box farther than d + 2 r from c is farther
//! than that from all of the group. The boxes within d + 2 r that are no larger than the group are the
//! frontier from which each point's own search starts.

use super::{Bvh, Entry, Nearest, Node, STACK, WIDTH, splat};
use crate::measure::frame::Located;
use crate::vector::DVec3;

/// Points that share a frontier. Larger groups share more but have wider frontiers; measured on samples
/// of surfaces against finer and coarser ones, 16 to 64 differ little.
const GROUP: usize = 32;

/// Boxes of a frontier at most; where more would be needed, larger ones are kept.
const CAPACITY: usize = 64;

/// Where the searches of a group start.
struct Frontier {
    packs: [Node; CAPACITY / WIDTH],
    entries: [Entry; CAPACITY],
    count: usize,
}

impl Bvh<'_> {
    /// The distance of each of the finite `points`; fastest where consecutive ones are near each other.
    pub(crate) fn distances(&self, points: &[DVec3], distances: &mut [f64]) {
        self.each_nearest(points, |i, distance, _| distances[i] = distance);
    }

    /// Calls `found` with the number, distance and nearest triangle of each of the finite `points`, in their order;
    /// fastest where consecutive ones are near each other.
    pub(crate) fn each_nearest(&self, points: &[DVec3], mut found: impl FnMut(usize, f64, u32)) {
        let mut frontier = Frontier::EMPTY;
        let mut guess = None;
        for (group, points) in points.chunks(GROUP).enumerate() {
            let found =
                |i: usize, distance: f64, face: u32| found(group * GROUP + i, distance, face);
            guess = self.group_nearest(points, guess, &mut frontier, found);
        }
    }

    /// The nearest triangle to a group of points. Takes and gives a triangle near it.
    fn group_nearest(
        &self,
        points: &[DVec3],
        mut guess: Option<u32>,
        frontier: &mut Frontier,
        mut found: impl FnMut(usize, f64, u32),
    ) -> Option<u32> {
        let (low, high) = points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        let centre = self.frame.locate(low * 0.5 + high * 0.5);
        if [low, high]
            .iter()
            .any(|&corner| self.frame.locate(corner).pulled_in)
        {
            for (i, point) in points.iter().enumerate() {
                let closest = self.closest_with_guess(point.to_array(), guess);
                found(i, closest.distance, closest.face);
                guess = Some(closest.face);
            }
            return guess;
        }
        let radius = points
            .iter()
            .map(|&p| self.frame.locate(p).local.distance_squared(centre.local));
        let radius = radius.fold(0.0, f64::max).sqrt();
        let nearest = self.search(&centre, guess);
        let reach = nearest.squared.sqrt() + 2.0 * radius;
        self.collect(
            frontier,
            &centre,
            Nearest {
                squared: reach * reach,
                ..nearest
            }
            .bound(),
            radius,
        );
        let mut face = nearest.face;
        for (i, &point) in points.iter().enumerate() {
            let nearest = self.search_frontier(frontier, &self.frame.locate(point), face);
            face = nearest.face;
            found(i, self.frame.length(nearest.squared.sqrt()), face);
        }
        Some(face)
    }

    /// Fills the frontier of a group.
    fn collect(&self, frontier: &mut Frontier, centre: &Located, bound: f32, radius: f64) {
        let (point, diameter) = (splat(centre.local), 2.0 * radius as f32);
        frontier.count = 0;
        let mut stack = [Entry::ROOT; CAPACITY / WIDTH];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let at = stack[waiting];
            let node = self.node(at);
            let mut within = node
                .squared_distances(point)
                .cmple(glam::Vec4::splat(bound))
                .bitmask();
            while within != 0 {
                let lane = within.trailing_zeros() as usize & (WIDTH - 1);
                within &= within - 1;
                let child = at.child(lane);
                // A waiting node may turn into as many boxes as it has children.
                let room = frontier.count + WIDTH * (waiting + 1) + within.count_ones() as usize
                    <= CAPACITY;
                if room && child.level < self.levels() && node.size(lane) > diameter {
                    stack[waiting] = child;
                    waiting += 1;
                } else {
                    frontier.add(node, lane, child);
                }
            }
        }
        frontier.close();
    }

    /// The triangle nearest to a point of the group, starting from a guess.
    #[inline]
    fn search_frontier(&self, frontier: &Frontier, at: &Located, guess: u32) -> Nearest {
        let mut nearest = Nearest {
            squared: self.projection(guess, at).squared,
            face: guess,
            visited: 0,
        };
        let mut bound = nearest.bound();
        let point = splat(at.local);
        let mut stack = [0; STACK];
        let mut visit = |place: usize, squared: f32, bound: &mut f32| {
            let entry = frontier.entries[place % CAPACITY];
            if entry.level == self.levels() {
                self.offer_slot(entry.index as usize, at, &mut nearest, bound);
            } else {
                stack[0] = entry.waiting(squared);
                self.descend(&mut stack, 1, at, point, &mut nearest, bound);
            }
        };
        // The nearest box first: a point of a triangle much larger than the surface's has a poor guess, with which
        // boxes in any order would be searched in vain.
        let mut squared = [glam::Vec4::INFINITY; CAPACITY / WIDTH];
        let packs = frontier.count.div_ceil(WIDTH);
        for (squared, pack) in squared.iter_mut().zip(&frontier.packs[..packs]) {
            *squared = pack.squared_distances(point);
        }
        let boxes = || {
            squared
                .iter()
                .flat_map(|lanes| lanes.to_array())
                .take(frontier.count)
                .enumerate()
        };
        let first = boxes().fold((0, f32::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
        if first.1 <= bound {
            visit(first.0, first.1, &mut bound);
        }
        for (pack, squared) in squared[..packs].iter().enumerate() {
            let mut within = squared.cmple(glam::Vec4::splat(bound)).bitmask();
            while within != 0 {
                let lane = within.trailing_zeros() as usize & (WIDTH - 1);
                within &= within - 1;
                let place = pack * WIDTH + lane;
                if place != first.0 && squared[lane] <= bound {
                    visit(place, squared[lane], &mut bound);
                }
            }
        }
        nearest
    }
}

impl Frontier {
    const EMPTY: Self = Self {
        packs: [Node::EMPTY; CAPACITY / WIDTH],
        entries: [Entry::ROOT; CAPACITY],
        count: 0,
    };

    /// Adds the box of a lane of `node`, which leads to `entry`.
    #[inline]
    fn add(&mut self, node: &Node, lane: usize, entry: Entry) {
        if self.count < CAPACITY {
            self.packs[self.count / WIDTH].copy_lane(self.count % WIDTH, node, lane);
            self.entries[self.count] = entry;
            self.count += 1;
        }
    }

    /// Empties the lanes of the last pack that hold nothing.
    fn close(&mut self) {
        for place in self.count..self.count.next_multiple_of(WIDTH) {
            self.packs[place / WIDTH].copy_lane(place % WIDTH, &Node::EMPTY, 0);
        }
    }
}
