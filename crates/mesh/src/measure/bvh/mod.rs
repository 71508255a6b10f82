//! A bounding-volume hierarchy over triangles, for closest points.
//!
//! Takes the triangles of a surface, manifold or not; gives the closest point to any point, exact
//! in double precision: single-precision boxes, rounded outwards, only decide which triangles are
//! tested. The answer is the triangle at the least computed distance, the one with the least index
//! among equals, whatever the order of the search, the guess that it started from, or the number of
//! threads that built the hierarchy.
//!
//! The tree is four children wide and implicit: [`build`] orders the triangles so that every 4^k consecutive
//! ones form a node, so that no child pointers are stored.

mod build;
mod group;

use glam::Vec4;

use super::MeasureError;
use super::frame::{Frame, Located, distance};
use crate::geometry::{Projection, closest_to_origin};
use crate::mesh::Triangles;
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::vector::{DVec3, diagonal, vector};

/// Children of a node.
const WIDTH: usize = 4;

/// Single-precision boxes of four children, one lane each; lanes without a child hold an empty box.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: [Vec4; 3],
    high: [Vec4; 3],
}

/// The corners of a triangle and which triangle it is, in the order of the tree.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    corners: [u32; 3],
    face: u32,
}

/// The closest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// The point on the surface.
    pub point: [f64; 3],
    /// Its distance.
    pub distance: f64,
    /// The triangle that it lies on.
    pub face: u32,
}

/// A hierarchy of boxes over the triangles of a surface.
///
/// It borrows the surface and takes about 48 bytes a triangle.
pub struct Bvh<'a> {
    surface: Triangles<'a>,
    frame: Frame,
    /// Box of the triangles, in the surface's own coordinates.
    bounds: [DVec3; 2],
    /// Triangles in the order of the tree.
    slots: Vec<Slot>,
    /// Nodes level by level, the root first; level `l` holds `starts[l] .. starts[l + 1]`.
    nodes: Vec<Node>,
    starts: Vec<usize>,
}

/// The best result of a search so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Squared distance in the frame.
    pub(super) squared: f64,
    /// The triangle.
    pub(super) face: u32,
    /// Nodes visited for it.
    pub(super) visited: u32,
}

impl Nearest {
    /// Nothing found yet.
    const NONE: Self = Self {
        squared: f64::INFINITY,
        face: u32::MAX,
        visited: 0,
    };

    /// Takes the candidate if it is nearer, or as near with a lesser index.
    #[inline]
    fn offer(&mut self, squared: f64, face: u32) -> bool {
        let better = squared < self.squared || (squared == self.squared && face < self.face);
        if better {
            *self = Self {
                squared,
                face,
                ..*self
            };
        }
        better
    }

    /// The greatest distance of a box that may hold a nearer triangle, with slack for the rounding
    /// of the box test.
    ///
    /// The test's gaps are within 2^-23 of their size or within half the boxes' margin of the truth
    /// ([`build::MARGIN`]), their squares and sum add less than 2^-22; 2^-20 covers both and the conversion. Below
    /// single precision's normal numbers nothing is rejected.
    #[inline]
    fn bound(&self) -> f32 {
        ((self.squared * (1.0 + 1.0 / 1_048_576.0)) as f32).clamp(f32::MIN_POSITIVE, f32::MAX)
    }
}

/// Nodes waiting to be visited. A tree over 2^32 triangles has 16 levels, and a visited level leaves at most
/// three nodes waiting.
const STACK: usize = 64;

/// The low bits of a stack entry's distance, which hold its level instead: clearing them only lowers the
/// distance.
const LEVEL_MASK: u32 = 0xf;

impl<'a> Bvh<'a> {
    /// Builds the hierarchy.
    ///
    /// # Errors
    /// No triangles, an index out of range, a coordinate that is not finite.
    pub fn new(surface: Triangles<'a>) -> Result<Self, MeasureError> {
        Self::new_observed(surface, &mut unobserved)
    }

    /// [`Self::new`] with an observer.
    ///
    /// # Errors
    /// No triangles, an index out of range, a coordinate that is not finite, or the observer asked to stop.
    pub fn new_observed(
        surface: Triangles<'a>,
        observer: &mut Observer<'_>,
    ) -> Result<Self, MeasureError> {
        Self::named(surface, "reference", observer)
    }

    /// Builds the hierarchy; `which` names the surface in errors.
    pub(super) fn named(
        surface: Triangles<'a>,
        which: &'static str,
        observer: &mut Observer<'_>,
    ) -> Result<Self, MeasureError> {
        super::check(surface, which)?;
        Ok(build::build(
            surface,
            &mut Watch::new(observer, Stage::Indexing),
        )?)
    }

    /// The surface.
    pub fn surface(&self) -> Triangles<'a> {
        self.surface
    }

    /// Least and greatest coordinates of the triangles; vertices that no triangle uses do not count.
    pub fn bounding_box(&self) -> [[f64; 3]; 2] {
        self.bounds.map(|corner| corner.to_array())
    }

    /// Length of the diagonal of that box.
    pub fn diagonal(&self) -> f64 {
        diagonal(self.bounds[0], self.bounds[1])
    }

    /// Bytes of the hierarchy, without the surface it borrows.
    pub fn memory(&self) -> usize {
        size_of_val(self.slots.as_slice())
            + size_of_val(self.nodes.as_slice())
            + size_of_val(self.starts.as_slice())
    }

    /// The point of the surface closest to `point`; NaN with face 0 if a coordinate of `point` is not finite.
    pub fn closest(&self, point: [f64; 3]) -> ClosestPoint {
        self.closest_with_guess(point, None)
    }

    /// The closest point, found faster where `guess` is a triangle near it, for example the answer
    /// for a neighbouring point. The answer does not depend on the guess, and a guess out of range
    /// is ignored.
    #[doc(hidden)]
    pub fn closest_from(&self, point: [f64; 3], guess: u32) -> ClosestPoint {
        self.closest_with_guess(point, Some(guess))
    }

    fn closest_with_guess(&self, point: [f64; 3], guess: Option<u32>) -> ClosestPoint {
        self.closest_counted(point, guess).0
    }

    /// The closest point, and the number of nodes visited for it.
    pub(super) fn closest_counted(
        &self,
        point: [f64; 3],
        guess: Option<u32>,
    ) -> (ClosestPoint, u32) {
        if !point.iter().all(|x| x.is_finite()) {
            return (
                ClosestPoint {
                    point: [f64::NAN; 3],
                    distance: f64::NAN,
                    face: 0,
                },
                0,
            );
        }
        let from = vector(point);
        let at = self.frame.locate(from);
        let nearest = self.search(&at, guess);
        let projection = self.projection(nearest.face, &at);
        let [a, b, c] = self.surface.corners(nearest.face as usize).map(vector);
        let on_surface =
            a * projection.weights[0] + b * projection.weights[1] + c * projection.weights[2];
        let distance = if at.pulled_in {
            distance(from, on_surface)
        } else {
            self.frame.length(nearest.squared.sqrt())
        };
        (
            ClosestPoint {
                point: on_surface.to_array(),
                distance,
                face: nearest.face,
            },
            nearest.visited,
        )
    }

    /// Vertices of the triangle at place `slot` of the tree's order, in which neighbours are near in space.
    #[inline]
    pub(super) fn in_order(&self, slot: usize) -> [u32; 3] {
        self.slots[slot].corners
    }

    /// Corners of that triangle.
    #[inline]
    pub(super) fn corners(&self, slot: usize) -> [DVec3; 3] {
        let [a, b, c] = self.slots[slot].corners;
        [self.position(a), self.position(b), self.position(c)]
    }

    #[inline]
    fn position(&self, vertex: u32) -> DVec3 {
        vector(self.surface.positions[vertex as usize])
    }

    /// The corners of a triangle, scaled so that squares and products neither overflow nor vanish.
    #[inline]
    pub(super) fn scaled_corners(&self, slot: usize) -> [DVec3; 3] {
        let [a, b, c] = self.corners(slot);
        [
            self.frame.scale_point(a),
            self.frame.scale_point(b),
            self.frame.scale_point(c),
        ]
    }

    /// The point of triangle `face` closest to a point.
    #[inline]
    fn projection(&self, face: u32, at: &Located) -> Projection {
        self.projection_on(self.surface.triangles[face as usize], at)
    }

    #[inline]
    fn projection_on(&self, [a, b, c]: [u32; 3], at: &Located) -> Projection {
        let corner = |vertex: u32| self.frame.scale_point(self.position(vertex)) - at.scaled;
        closest_to_origin(corner(a), corner(b), corner(c))
    }

    /// Number of levels of nodes; the triangles are one below.
    #[inline]
    fn levels(&self) -> u32 {
        self.starts.len() as u32 - 1
    }

    #[inline]
    fn node(&self, at: Entry) -> &Node {
        &self.nodes[self.starts[at.level as usize] + at.index as usize]
    }

    /// The nearest triangle, starting from a guess.
    fn search(&self, at: &Located, guess: Option<u32>) -> Nearest {
        let mut nearest = Nearest::NONE;
        if let Some(face) = guess.filter(|&face| (face as usize) < self.surface.triangles.len()) {
            nearest.offer(self.projection(face, at).squared, face);
        }
        let mut bound = nearest.bound();
        let mut stack = [0; STACK];
        stack[0] = Entry::ROOT.waiting(0.0);
        self.descend(&mut stack, 1, at, splat(at.local), &mut nearest, &mut bound);
        nearest
    }

    /// Works off the stack, nearest children first, skipping boxes that are farther than the best so far.
    #[inline]
    fn descend(
        &self,
        stack: &mut [u64; STACK],
        mut waiting: usize,
        at: &Located,
        point: [Vec4; 3],
        nearest: &mut Nearest,
        bound: &mut f32,
    ) {
        while waiting > 0 {
            waiting -= 1;
            let (entry, squared) = Entry::waited(stack[waiting % STACK]);
            if squared > *bound {
                continue;
            }
            nearest.visited = nearest.visited.saturating_add(1);
            let (lanes, count) = self.node(entry).sorted_within(point, *bound);
            if entry.level + 1 == self.levels() {
                for &lane in &lanes[..count] {
                    if f32::from_bits((lane >> 32) as u32) > *bound {
                        break;
                    }
                    let slot = entry.child(lane as usize & (WIDTH - 1)).index as usize;
                    self.offer_slot(slot, at, nearest, bound);
                }
            } else {
                // All four are written, the nearest last; those too far end up above the top.
                for place in 0..WIDTH {
                    let lane = lanes[(count + WIDTH - 1 - place) % WIDTH];
                    let squared = f32::from_bits((lane >> 32) as u32);
                    stack[(waiting + place) % STACK] =
                        entry.child(lane as usize % WIDTH).waiting(squared);
                }
                waiting += count;
            }
        }
    }

    /// Measures the triangle at place `slot` of the tree's order.
    #[inline]
    fn offer_slot(&self, slot: usize, at: &Located, nearest: &mut Nearest, bound: &mut f32) {
        let slot = &self.slots[slot];
        if slot.face != nearest.face
            && nearest.offer(self.projection_on(slot.corners, at).squared, slot.face)
        {
            *bound = nearest.bound();
        }
    }
}

/// The coordinates of a point of the frame, each in all lanes.
#[inline]
fn splat(local: DVec3) -> [Vec4; 3] {
    local.to_array().map(|x| Vec4::splat(x as f32))
}

/// A node by level and place in the level, or, one level below the last, a triangle by its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Entry {
    level: u32,
    index: u32,
}

impl Entry {
    const ROOT: Self = Self { level: 0, index: 0 };

    #[inline]
    fn child(self, lane: usize) -> Self {
        Self {
            level: self.level + 1,
            index: self.index * WIDTH as u32 + lane as u32,
        }
    }

    /// The entry on a stack together with the squared distance of its box, which is rounded down to make room.
    #[inline]
    fn waiting(self, squared: f32) -> u64 {
        let key = (squared.to_bits() & !LEVEL_MASK) | self.level;
        (key as u64) << 32 | self.index as u64
    }

    /// The entry and squared distance from the stack.
    #[inline]
    fn waited(waiting: u64) -> (Self, f32) {
        let key = (waiting >> 32) as u32;
        let entry = Self {
            level: key & LEVEL_MASK,
            index: waiting as u32,
        };
        (entry, f32::from_bits(key & !LEVEL_MASK))
    }
}

impl Node {
    /// An empty box in every lane.
    const EMPTY: Self = Self {
        low: [Vec4::INFINITY; 3],
        high: [Vec4::NEG_INFINITY; 3],
    };

    /// Longest side of the box of a lane.
    #[inline]
    fn size(&self, lane: usize) -> f32 {
        (0..3).fold(0.0, |size: f32, axis| {
            size.max(self.high[axis][lane] - self.low[axis][lane])
        })
    }

    /// Copies the box of a lane of another node.
    #[inline]
    fn copy_lane(&mut self, to: usize, other: &Self, from: usize) {
        for axis in 0..3 {
            self.low[axis][to] = other.low[axis][from];
            self.high[axis][to] = other.high[axis][from];
        }
    }

    /// Squared distances of a point to the four boxes: zero inside, infinite for an empty box.
    #[inline]
    fn squared_distances(&self, point: [Vec4; 3]) -> Vec4 {
        let gap = |axis: usize| {
            (self.low[axis] - point[axis])
                .max(point[axis] - self.high[axis])
                .max(Vec4::ZERO)
        };
        let (x, y, z) = (gap(0), gap(1), gap(2));
        x * x + y * y + z * z
    }

    /// All lanes, nearest first, as squared distance (its bits order like the number) above the lane, and how
    /// many of them lie within `bound`.
    ///
    /// A sorting network rather than a loop over the lanes within: which they are cannot be predicted.
    #[inline]
    fn sorted_within(&self, point: [Vec4; 3], bound: f32) -> ([u64; WIDTH], usize) {
        let squared = self.squared_distances(point);
        let count = squared.cmple(Vec4::splat(bound)).bitmask().count_ones() as usize;
        let [a, b, c, d] = squared.to_array();
        let entry = |squared: f32, lane: u64| (squared.to_bits() as u64) << 32 | lane;
        let order = |a: u64, b: u64| (a.min(b), a.max(b));
        let (a, b) = order(entry(a, 0), entry(b, 1));
        let (c, d) = order(entry(c, 2), entry(d, 3));
        let (a, c) = order(a, c);
        let (b, d) = order(b, d);
        let (b, c) = order(b, c);
        ([a, b, c, d], count)
    }
}

#[cfg(test)]
mod tests;
