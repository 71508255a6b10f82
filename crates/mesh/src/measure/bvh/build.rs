//! Building the hierarchy: order the triangles by median cuts, then box them from the bottom up.
//!
//! A node of height k spans 4^(k+1) consecutive triangles. The triangles get their order by cutting
//! ranges in two at these places, across the longest side of the box of their centres, which is a
//! packed k-d tree: every node but the last of a level is full, no depth depends on the positions,
//! and ranges are independent, so that they are cut in parallel. Centres equal in a coordinate are
//! ordered by the triangle's index, so that the parts do not depend on the algorithm that selects
//! the median.

use glam::{Vec3, Vec4};

use super::{Bvh, Node, Slot, WIDTH};
use crate::measure::frame::Frame;
use crate::mesh::Triangles;
use crate::parallel;
use crate::progress::{Cancelled, Stage, Watch};
use crate::vector::{DVec3, vector};

/// Boxes are enlarged by this much, in the frame, where coordinates are within ±1: four times the rounding of a
/// coordinate to single precision near 1, so that box, query point and the double-precision error of
/// the triangle's own distance are covered together.
pub(super) const MARGIN: f32 = 1.0 / 4_194_304.0;

/// Ranges shorter than this are cut to the end in one go.
const CUT_AT_ONCE: usize = 8192;

/// Builds the tree of a checked surface.
pub(super) fn build<'a>(
    surface: Triangles<'a>,
    watch: &mut Watch<'_>,
) -> Result<Bvh<'a>, Cancelled> {
    watch.triangles(surface.triangles.len());
    watch.stage(Stage::Indexing, Some(surface.triangles.len()))?;
    let bounds = bounds(surface);
    let frame = Frame::new(bounds[0], bounds[1]);
    let poll = &mut |_| watch.poll();
    let mut centres = parallel::map_polled(surface.triangles.len(), poll, |face| {
        Centre::new(surface, &frame, face)
    })?;
    let mut capacity = WIDTH;
    while capacity < centres.len() {
        capacity *= WIDTH;
    }
    order(&mut centres, capacity, watch)?;
    let poll = &mut |_| watch.poll();
    let slots = parallel::map_polled(centres.len(), poll, |place| {
        let face = centres[place].face;
        Slot {
            corners: surface.triangles[face as usize],
            face,
        }
    })?;
    drop(centres);
    let (nodes, starts) = boxes(surface, &frame, &slots, watch)?;
    watch.done(surface.triangles.len())?;
    Ok(Bvh {
        surface,
        frame,
        bounds,
        slots,
        nodes,
        starts,
    })
}

/// The box of the triangles.
fn bounds(surface: Triangles<'_>) -> [DVec3; 2] {
    let join = |a: [DVec3; 2], b: [DVec3; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let boxes = parallel::pieces(surface.triangles.len(), |faces| {
        surface.triangles[faces]
            .as_flattened()
            .iter()
            .fold(nothing, |bounds, &v| {
                let p = vector(surface.positions[v as usize]);
                join(bounds, [p, p])
            })
    });
    boxes.into_iter().fold(nothing, join)
}

/// A triangle in the order: the centre of its box.
#[derive(Clone, Copy, Default)]
struct Centre {
    at: [f32; 3],
    face: u32,
}

impl Centre {
    fn new(surface: Triangles<'_>, frame: &Frame, face: usize) -> Self {
        let [a, b, c] = surface.corners(face).map(|p| frame.centre_point(vector(p)));
        let centre = (a.min(b).min(c) + a.max(b).max(c)) * 0.5;
        Self {
            at: centre.to_array().map(|x| x as f32),
            face: face as u32,
        }
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
///
/// Cut by cut, all ranges of one size together, until they are small enough to be cut to the end in one go.
fn order(
    centres: &mut [Centre],
    mut capacity: usize,
    watch: &mut Watch<'_>,
) -> Result<(), Cancelled> {
    let count = centres.len();
    let mut ranges = vec![centres];
    while capacity > CUT_AT_ONCE {
        capacity /= 2;
        let halves =
            parallel::each_polled(ranges, &mut |_| watch.poll(), |range| cut(range, capacity))?;
        ranges = halves
            .into_iter()
            .flatten()
            .filter(|half| !half.is_empty())
            .collect();
    }
    let poll = &mut |ranges: usize| watch.done((ranges * capacity).min(count));
    parallel::each_polled(ranges, poll, |range| order_at_once(range, capacity))?;
    Ok(())
}

/// Cuts a range so that `half` of its centres lie before the cut; the part behind it is empty where there are no more.
fn cut(centres: &mut [Centre], half: usize) -> [&mut [Centre]; 2] {
    if centres.len() <= half {
        return [centres, &mut []];
    }
    let axis = longest_axis(centres);
    centres.select_nth_unstable_by_key(half, |centre| centre.key(axis));
    centres.split_at_mut(half).into()
}

/// Orders a range in one go.
fn order_at_once(centres: &mut [Centre], capacity: usize) {
    if centres.len() <= WIDTH {
        centres.sort_unstable_by_key(|centre| centre.face);
        return;
    }
    cut(centres, capacity / 2)
        .into_iter()
        .for_each(|half| order_at_once(half, capacity / 2));
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
fn boxes(
    surface: Triangles<'_>,
    frame: &Frame,
    slots: &[Slot],
    watch: &mut Watch<'_>,
) -> Result<(Vec<Node>, Vec<usize>), Cancelled> {
    let mut sizes = vec![slots.len().div_ceil(WIDTH)];
    while sizes[sizes.len() - 1] > 1 {
        sizes.push(sizes[sizes.len() - 1].div_ceil(WIDTH));
    }
    sizes.reverse();
    let mut starts = vec![0];
    for (level, size) in sizes.iter().enumerate() {
        starts.push(starts[level] + size);
    }
    let mut nodes = limitmesh_pages::filled(Node::EMPTY, starts[sizes.len()]);
    for level in (0..sizes.len()).rev() {
        let (above, below) = nodes.split_at_mut(starts[level + 1]);
        let own = &mut above[starts[level]..];
        parallel::for_each_chunk_polled(own, 256, &mut |_| watch.poll(), |piece, chunk| {
            for (i, node) in chunk.iter_mut().enumerate() {
                let first = (piece * 256 + i) * WIDTH;
                if level + 1 == sizes.len() {
                    *node = box_triangles(
                        surface,
                        frame,
                        &slots[first..slots.len().min(first + WIDTH)],
                    );
                } else {
                    *node = box_nodes(&below[first..sizes[level + 1].min(first + WIDTH)]);
                }
            }
        })?;
    }
    Ok((nodes, starts))
}

/// The node over up to four triangles.
fn box_triangles(surface: Triangles<'_>, frame: &Frame, slots: &[Slot]) -> Node {
    let mut node = Node::EMPTY;
    for (lane, slot) in slots.iter().enumerate() {
        let [a, b, c] = slot
            .corners
            .map(|v| frame.centre_point(vector(surface.positions[v as usize])));
        let (low, high) = (a.min(b).min(c).to_array(), a.max(b).max(c).to_array());
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
