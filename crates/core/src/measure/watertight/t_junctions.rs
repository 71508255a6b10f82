//! How many vertices lie inside of boundary edges.
//!
//! Vertices at one place are looked up once and edges between the same two places are kept once, so that soups of
//! unconnected triangles, where many meet in a point, take no longer than others. Each edge goes through a tree of the places
//! and meets those near to it, so that it does not matter how many edges run side by side, or lead to the same vertex.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

use crate::geometry::SurfaceFrame;
use crate::geometry::box_tree::{NO_BOUNDS, grown};
use crate::parallel;
use crate::progress::{Cancelled, Stage, Watch};
use crate::vector::{DVec3, vector};

/// How near to a boundary edge, as a share of its length, a vertex counts as lying on it, and how far from its ends
/// it must be to lie inside. Wide enough for midpoints rounded to single precision in edges down to about a hundredth
/// of the model; a gap this narrow cannot be told from a crack.
const ON_EDGE: f64 = 1e-5;

/// The reach of an edge is taken so many times as wide where places are passed over unseen, for rounding.
const WITH_ROUNDING: f64 = 1.001;

/// Edges looked up in one go.
const EDGES: usize = 1 << 12;

/// Up to so many places are looked at one by one.
const FEW: usize = 8;

/// While the tree is built, subtrees of so many places are polled for.
const POLLED: usize = 1 << 12;

/// Number of `vertices` that lie inside an edge of `boundary`.
pub(super) fn count(
    positions: &[[f64; 3]],
    mut vertices: Vec<u32>,
    boundary: &[[u32; 2]],
    watch: &mut Watch<'_>,
) -> Result<usize, Cancelled> {
    let place = |v: u32| positions.get(v as usize).filter(|p| p.iter().all(|x| x.is_finite()));
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
        .map(|vertices| Place { at: inside(vertices[0]), vertices: vertices.len() as u32 })
        .collect();
    let tree = Places::of(places, watch)?;
    watch.stage(Stage::Sampling, Some(edges.len()))?;
    parallel::pieces_polled(edges.len(), EDGES, &mut |done| watch.done(done), |range| {
        edges[range].iter().for_each(|&[a, b]| tree.meet(inside(a), inside(b)));
    })?;
    Ok(tree.met())
}

/// A place, and how many vertices are there.
#[derive(Clone, Copy)]
struct Place {
    at: DVec3,
    vertices: u32,
}

/// Places in a tree: of those in a range, the one in the middle stands between those below it and those above it on an axis.
struct Places {
    places: Vec<Place>,
    /// By the place in the middle of a range, the axis.
    axes: Vec<u8>,
    /// By the same, how many places of the range no edge has met yet.
    left: Vec<AtomicU32>,
    is_met: Vec<AtomicBool>,
}

impl Places {
    fn of(mut places: Vec<Place>, watch: &mut Watch<'_>) -> Result<Self, Cancelled> {
        let count = places.len();
        watch.stage(Stage::Indexing, Some(count))?;
        let (mut axes, mut left) = (vec![0; count], vec![0; count]);
        let mut waiting: Vec<_> = core::iter::once(0..count).collect();
        while let Some(range) = waiting.pop() {
            if range.len() >= POLLED {
                watch.poll()?;
            }
            let middle = middle(&range);
            left[middle] = range.len() as u32;
            if range.len() <= FEW {
                continue;
            }
            let own = &mut places[range.clone()];
            let [low, high] = own.iter().map(|place| place.at).fold(NO_BOUNDS, grown);
            let sides = (high - low).to_array();
            let axis =
                (1..3).fold(0, |longest, axis| if sides[axis] > sides[longest] { axis } else { longest });
            axes[middle] = axis as u8;
            own.select_nth_unstable_by(middle - range.start, |a, b| a.at[axis].total_cmp(&b.at[axis]));
            waiting.extend([range.start..middle, middle + 1..range.end]);
        }
        let left = left.into_iter().map(AtomicU32::new).collect();
        let is_met = places.iter().map(|_| AtomicBool::new(false)).collect();
        Ok(Self { places, axes, left, is_met })
    }

    /// How many vertices are at places that an edge has met.
    fn met(&self) -> usize {
        let met = self.places.iter().zip(&self.is_met).filter(|(_, is_met)| is_met.load(Relaxed));
        met.map(|(place, _)| place.vertices as usize).sum()
    }

    /// Marks the places that lie inside of the edge from `a` to `b`.
    fn meet(&self, a: DVec3, b: DVec3) {
        let along = b - a;
        let squared = along.length_squared();
        let reach = WITH_ROUNDING * ON_EDGE * squared.sqrt();
        let is_inside = |number: usize| {
            let from = self.places[number].at - a;
            let t = from.dot(along) / squared;
            let apart = (from - along * t).length_squared();
            t > ON_EDGE && t < 1.0 - ON_EDGE && apart <= ON_EDGE * ON_EDGE * squared
        };
        // Ranges, with the part of the edge that may be near to them.
        let mut waiting = vec![(0..self.places.len(), [0.0, 1.0])];
        while let Some((range, part)) = waiting.pop() {
            let middle = middle(&range);
            if range.is_empty() || self.left[middle].load(Relaxed) == 0 {
                continue;
            }
            if range.len() <= FEW {
                range.filter(|&number| is_inside(number)).for_each(|number| self.mark(number));
                continue;
            }
            if is_inside(middle) {
                self.mark(middle);
            }
            let axis = self.axes[middle] as usize;
            let (start, step, at) = (a[axis], along[axis], self.places[middle].at[axis]);
            let below = clipped(part, (start, step), at + reach);
            let above = clipped(part, (-start, -step), reach - at);
            waiting.extend(below.map(|part| (range.start..middle, part)));
            waiting.extend(above.map(|part| (middle + 1..range.end, part)));
        }
    }

    /// Marks a place, and takes it from what is left of the ranges that hold it.
    fn mark(&self, number: usize) {
        if self.is_met[number].swap(true, Relaxed) {
            return;
        }
        let mut range = 0..self.places.len();
        loop {
            let middle = middle(&range);
            self.left[middle].fetch_sub(1, Relaxed);
            if middle == number || range.len() <= FEW {
                return;
            }
            range = if number < middle { range.start..middle } else { middle + 1..range.end };
        }
    }
}

fn middle(range: &core::ops::Range<usize>) -> usize {
    range.start + range.len() / 2
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
