//! How many vertices lie inside of boundary edges.
//!
//! Vertices at one place are looked up once and edges between the same two places are kept once, so
//! that soups of unconnected triangles, where many meet in a point, take no longer than others.
//! Each edge goes through a tree of the places and meets those near to it, so that many parallel
//! edges, or many edges at one vertex, take no more time.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

use crate::geometry::SurfaceFrame;
use crate::geometry::box_tree::{Bounds, NO_BOUNDS, grown};
use crate::parallel;
use crate::progress::{Cancelled, Stage, Watch};
use crate::vector::{DVec3, vector};

/// How near to a boundary edge, as a share of its length, a vertex counts as lying on it, and how
/// far from its ends it must be to lie inside. Wide enough for midpoints rounded to single
/// precision in edges down to about a hundredth of the model; a gap this narrow cannot be
/// distinguished from a crack.
const ON_EDGE: f64 = 1e-5;

/// The factor of an edge's reach where places are skipped, for rounding.
const WITH_ROUNDING: f64 = 1.001;

/// Edges looked up in one go.
const EDGES: usize = 1 << 12;

/// Up to this many places are tested one by one.
const FEW: usize = 8;

/// While the tree is built, subtrees of this many places are polled for.
const POLLED: usize = 1 << 12;

/// Number of `vertices` that lie inside an edge of `boundary`.
pub(super) fn count(
    positions: &[[f64; 3]],
    mut vertices: Vec<u32>,
    boundary: &[[u32; 2]],
    watch: &mut Watch<'_>,
) -> Result<usize, Cancelled> {
    let place = |v: u32| {
        positions
            .get(v as usize)
            .filter(|p| p.iter().all(|x| x.is_finite()))
    };
    // Adding zero makes both zeros the same place.
    let bits = |v: u32| positions[v as usize].map(|x| (x + 0.0).to_bits());
    let mut edges: Vec<[u32; 2]> = boundary
        .iter()
        .filter(|[a, b]| place(*a).is_some() && place(*b).is_some())
        .map(|&[a, b]| if bits(a) <= bits(b) { [a, b] } else { [b, a] })
        .collect();
    edges.sort_unstable_by_key(|edge| edge.map(bits));
    edges.dedup_by_key(|edge| edge.map(bits));
    if edges.is_empty() {
        return Ok(0);
    }
    vertices.retain(|&v| place(v).is_some());
    vertices.sort_unstable_by_key(|&v| (bits(v), v));
    let at = |v: u32| vector(positions[v as usize]);
    let frame = SurfaceFrame::of(vertices.iter().map(|&v| at(v)).fold(NO_BOUNDS, grown));
    let inside = |v: u32| frame.inside(at(v));
    let places: Vec<Place> = vertices
        .chunk_by(|&a, &b| bits(a) == bits(b))
        .map(|vertices| Place {
            at: inside(vertices[0]),
            vertices: vertices.len() as u32,
        })
        .collect();
    let tree = Places::of(places, watch)?;
    watch.stage(Stage::Sampling, Some(edges.len()))?;
    parallel::pieces_polled(edges.len(), EDGES, &mut |done| watch.done(done), |range| {
        edges[range]
            .iter()
            .for_each(|&[a, b]| tree.meet(inside(a), inside(b)));
    })?;
    Ok(tree.met())
}

/// A place, and how many vertices are there.
#[derive(Clone, Copy)]
struct Place {
    at: DVec3,
    vertices: u32,
}

/// Some places, and the box that holds them.
struct Node {
    bounds: Bounds,
    /// Its places, as a range of [`Places::places`].
    range: Range<usize>,
    /// The second of its two children; the first follows the node itself. None where the places are few.
    second: Option<usize>,
    /// How many of its places no edge has met yet.
    left: AtomicUsize,
}

/// Places in a tree: the root first, each node followed by the subtree of its first child.
struct Places {
    places: Vec<Place>,
    nodes: Vec<Node>,
    is_met: Vec<AtomicBool>,
}

impl Places {
    fn of(mut places: Vec<Place>, watch: &mut Watch<'_>) -> Result<Self, Cancelled> {
        watch.stage(Stage::Indexing, Some(places.len()))?;
        let mut nodes = Vec::new();
        append(&mut nodes, &mut places, 0, watch)?;
        let is_met = places.iter().map(|_| AtomicBool::new(false)).collect();
        Ok(Self {
            places,
            nodes,
            is_met,
        })
    }

    /// How many vertices are at places that an edge has met.
    fn met(&self) -> usize {
        let met = self
            .places
            .iter()
            .zip(&self.is_met)
            .filter(|(_, is_met)| is_met.load(Relaxed));
        met.map(|(place, _)| place.vertices as usize).sum()
    }

    /// Marks the places that lie inside of the edge from `a` to `b`.
    fn meet(&self, a: DVec3, b: DVec3) {
        let along = b - a;
        let squared = along.length_squared();
        let reach = DVec3::splat(WITH_ROUNDING * ON_EDGE * squared.sqrt());
        let is_inside = |number: &usize| {
            let from = self.places[*number].at - a;
            let t = from.dot(along) / squared;
            let apart = (from - along * t).length_squared();
            t > ON_EDGE && t < 1.0 - ON_EDGE && apart <= ON_EDGE * ON_EDGE * squared
        };
        // Nodes, with the part of the edge that may be near to them.
        let mut waiting = vec![(0, [0.0, 1.0])];
        while let Some((number, part)) = waiting.pop() {
            let node = &self.nodes[number];
            if node.left.load(Relaxed) == 0 {
                continue;
            }
            let [low, high] = node.bounds;
            let Some(part) = within(part, (a, along), [low - reach, high + reach]) else {
                continue;
            };
            match node.second {
                Some(second) => waiting.extend([(second, part), (number + 1, part)]),
                None => node
                    .range
                    .clone()
                    .filter(is_inside)
                    .for_each(|number| self.mark(number)),
            }
        }
    }

    /// Marks a place, and removes it from the counts of the nodes that hold it.
    fn mark(&self, place: usize) {
        if self.is_met[place].swap(true, Relaxed) {
            return;
        }
        let mut number = 0;
        loop {
            self.nodes[number].left.fetch_sub(1, Relaxed);
            let Some(second) = self.nodes[number].second else {
                return;
            };
            number = if place < self.nodes[second].range.start {
                number + 1
            } else {
                second
            };
        }
    }
}

/// Appends the subtree over some places, which begin at `first` among all; orders them.
fn append(
    nodes: &mut Vec<Node>,
    places: &mut [Place],
    first: usize,
    watch: &mut Watch<'_>,
) -> Result<(), Cancelled> {
    if places.len() >= POLLED {
        watch.poll()?;
    }
    let bounds = places.iter().map(|place| place.at).fold(NO_BOUNDS, grown);
    let (own, range) = (nodes.len(), first..first + places.len());
    nodes.push(Node {
        bounds,
        range,
        second: None,
        left: AtomicUsize::new(places.len()),
    });
    if places.len() <= FEW {
        return Ok(());
    }
    let sides = (bounds[1] - bounds[0]).to_array();
    let axis = (1..3).fold(0, |longest, axis| {
        if sides[axis] > sides[longest] {
            axis
        } else {
            longest
        }
    });
    let half = places.len() / 2;
    places.select_nth_unstable_by(half, |a, b| a.at[axis].total_cmp(&b.at[axis]));
    let (before, after) = places.split_at_mut(half);
    append(nodes, before, first, watch)?;
    nodes[own].second = Some(nodes.len());
    append(nodes, after, first + half, watch)
}

/// The part of an edge, which starts at `start` and goes `along`, that is within a box, if there is any.
fn within(part: [f64; 2], (start, along): (DVec3, DVec3), [low, high]: Bounds) -> Option<[f64; 2]> {
    (0..3).try_fold(part, |part, axis| {
        let part = clipped(part, (start[axis], along[axis]), high[axis])?;
        clipped(part, (-start[axis], -along[axis]), -low[axis])
    })
}

/// The part of [first, last] where `start + step t` is at most `most`, if there is any.
fn clipped([first, last]: [f64; 2], (start, step): (f64, f64), most: f64) -> Option<[f64; 2]> {
    let [at_first, at_last] = [first, last].map(|t| start + step * t);
    match (at_first <= most, at_last <= most) {
        (true, true) => Some([first, last]),
        (false, false) => None,
        (is_first, _) => {
            let end = ((most - start) / step).clamp(first, last);
            Some(if is_first { [first, end] } else { [end, last] })
        }
    }
}
