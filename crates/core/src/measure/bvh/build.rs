//! Building the hierarchy: order the triangles by median cuts, then box them from the bottom up.
//!
//! A node of height k spans 4^(k+1) consecutive triangles. The triangles get their order by cutting ranges in
//! two at these places, across the longest side of the box of their centres, which is a packed k-d tree: every
//! node but the last of a level is full, no depth depends on the positions, and ranges are independent, so
//! that they are cut in parallel. Centres equal in a coordinate are told apart by the triangle's index, so
//! that the parts do not depend on the algorithm that selects the median.

use glam::{Vec3, Vec4};

use super::{Bvh, Node, Slot, WIDTH};
use crate::measure::frame::Frame;
use crate::mesh::Triangles;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// Boxes are enlarged by this much, in the frame, where coordinates are within ±1: four times the rounding of a
/// coordinate to single precision near 1, so that box, query point and the double-precision error of
/// the triangle's own distance are covered together.
pub(super) const MARGIN: f32 = 1.0 / 4_194_304.0;

/// Ranges shorter than this are cut on the thread they are on.
#[cfg(feature = "parallel")]
const PARALLEL_ABOVE: usize = 8192;

/// Builds the tree of a checked surface; each triangle's box is enlarged by `padding` times its diagonal.
pub(super) fn build(surface: Triangles<'_>, padding: f64) -> Bvh<'_> {
    let bounds = bounds(surface);
    let frame = Frame::new(bounds[0], bounds[1]);
    let mut centres = parallel::map(surface.triangles.len(), |face| Centre::new(surface, &frame, face));
    let mut capacity = WIDTH;
    while capacity < centres.len() {
        capacity *= WIDTH;
    }
    order(&mut centres, capacity);
    let slots = parallel::map(centres.len(), |place| {
        let face = centres[place].face;
        Slot { corners: surface.triangles[face as usize], face }
    });
    drop(centres);
    let (nodes, starts) = boxes(surface, &frame, &slots, padding);
    Bvh { surface, frame, bounds, slots, nodes, starts }
}

/// The box of the triangles.
fn bounds(surface: Triangles<'_>) -> [DVec3; 2] {
    let join = |a: [DVec3; 2], b: [DVec3; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let boxes = parallel::pieces(surface.triangles.len(), |faces| {
        surface.triangles[faces].as_flattened().iter().fold(nothing, |bounds, &v| {
            let p = vector(surface.positions[v as usize]);
            join(bounds, [p, p])
        })
    });
    boxes.into_iter().fold(nothing, join)
}

/// A triangle standing for its place in the order: the centre of its box.
#[derive(Clone, Copy)]
struct Centre {
    at: [f32; 3],
    face: u32,
}

impl Centre {
    fn new(surface: Triangles<'_>, frame: &Frame, face: usize) -> Self {
        let [a, b, c] = surface.corners(face).map(|p| frame.centre_point(vector(p)));
        let centre = (a.min(b).min(c) + a.max(b).max(c)) * 0.5;
        Self { at: centre.to_array().map(|x| x as f32), face: face as u32 }
    }

    /// A number that orders centres along `axis`, distinct for distinct triangles.
    #[inline]
    fn key(&self, axis: usize) -> u64 {
        let bits = self.at[axis].to_bits();
        // Negative numbers order backwards by their bits, and below the others.
        let ordered = bits ^ (((bits as i32 >> 31) as u32) | 0x8000_0000);
        (ordered as u64) << 32 | self.face as u64
    }
}

/// Orders `centres` so that every aligned run of 4^k is compact; `capacity` is a power of four times one or two.
fn order(centres: &mut [Centre], capacity: usize) {
    if centres.len() <= WIDTH {
        centres.sort_unstable_by_key(|centre| centre.face);
        return;
    }
    let half = capacity / 2;
    if centres.len() <= half {
        return order(centres, half);
    }
    let axis = longest_axis(centres);
    centres.select_nth_unstable_by_key(half, |centre| centre.key(axis));
    let (left, right) = centres.split_at_mut(half);
    #[cfg(feature = "parallel")]
    if left.len() >= PARALLEL_ABOVE {
        rayon::join(|| order(left, half), || order(right, half));
        return;
    }
    order(left, half);
    order(right, half);
}

/// The axis along which the centres spread most; the first of equals.
fn longest_axis(centres: &[Centre]) -> usize {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for centre in centres {
        let at = Vec3::from_array(centre.at);
        (low, high) = (low.min(at), high.max(at));
    }
    (high - low).max_position()
}

/// The nodes, level by level from the root, and where each level starts.
fn boxes(surface: Triangles<'_>, frame: &Frame, slots: &[Slot], padding: f64) -> (Vec<Node>, Vec<usize>) {
    let mut sizes = vec![slots.len().div_ceil(WIDTH)];
    while sizes[sizes.len() - 1] > 1 {
        sizes.push(sizes[sizes.len() - 1].div_ceil(WIDTH));
    }
    sizes.reverse();
    let mut starts = vec![0];
    for (level, size) in sizes.iter().enumerate() {
        starts.push(starts[level] + size);
    }
    let mut nodes = vec![Node::EMPTY; starts[sizes.len()]];
    for level in (0..sizes.len()).rev() {
        let (above, below) = nodes.split_at_mut(starts[level + 1]);
        parallel::for_each_chunk(&mut above[starts[level]..], 256, |piece, chunk| {
            for (i, node) in chunk.iter_mut().enumerate() {
                let first = (piece * 256 + i) * WIDTH;
                if level + 1 == sizes.len() {
                    *node =
                        box_triangles(surface, frame, &slots[first..slots.len().min(first + WIDTH)], padding);
                } else {
                    *node = box_nodes(&below[first..sizes[level + 1].min(first + WIDTH)]);
                }
            }
        });
    }
    (nodes, starts)
}

/// The node over up to four triangles.
fn box_triangles(surface: Triangles<'_>, frame: &Frame, slots: &[Slot], padding: f64) -> Node {
    let mut node = Node::EMPTY;
    for (lane, slot) in slots.iter().enumerate() {
        let [a, b, c] = slot.corners.map(|v| frame.centre_point(vector(surface.positions[v as usize])));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let pad = if padding > 0.0 { DVec3::splat((high - low).length() * padding) } else { DVec3::ZERO };
        let (low, high) = ((low - pad).to_array(), (high + pad).to_array());
        for axis in 0..3 {
            node.low[axis][lane] = low[axis] as f32 - MARGIN;
            node.high[axis][lane] = high[axis] as f32 + MARGIN;
        }
    }
    node
}

/// The node over up to four nodes.
fn box_nodes(children: &[Node]) -> Node {
    let mut node = Node::EMPTY;
    for (lane, child) in children.iter().enumerate() {
        for axis in 0..3 {
            node.low[axis][lane] = Vec4::min_element(child.low[axis]);
            node.high[axis][lane] = Vec4::max_element(child.high[axis]);
        }
    }
    node
}
