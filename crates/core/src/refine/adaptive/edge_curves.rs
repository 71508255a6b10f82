//! The curves of the surface over the edges of a leaf, and which edges are to be split for them.

use super::control::Control;
use super::quadtree::ALL_EDGES;
use crate::certificate::{TriangleFrame, quadratic_height};
use crate::closure::{Diagonal, closure};
use crate::patch::LimitPoint;

/// A leaf so many times as far from the surface as it may be is divided. Its parts are a quarter as far.
pub(super) const DIVIDED: f64 = 4.0;

/// Curves below this part of the limit are expected to pass: their heights are known at their middles alone.
const SURE: f64 = 0.95;

/// Where the surface is straight in a direction, curves whose heights are as near to each other as this are as high.
const ALIKE: f64 = 0.9;

/// The places of the labels of [`closure`] in a leaf.
const PLACES: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [0.5, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
];

/// How the leaves of a control face ask.
#[derive(Clone, Copy)]
pub(super) struct Asking {
    /// Whether they do: where nothing counts but distances, which are proven, and levels of detail are not nested.
    pub(super) may_be: bool,
    /// Whether nothing counts but the rim of a flat region.
    rim_alone: bool,
    /// Whether strips may be put together.
    is_straight: bool,
}

impl Asking {
    pub(super) fn of(control: &Control<'_>, face: u32) -> Self {
        Self {
            may_be: control.criteria.is_none()
                && control.rules.is_certified()
                && control.leaves_ask,
            rim_alone: control.flat.is_its_rim(face),
            is_straight: control.flat.is_straight(face),
        }
    }
}

/// The curves over those edges of a leaf that count, by their middles.
pub(super) struct EdgeCurves {
    /// How far they are from the triangle; signed where that is by heights.
    heights: [f64; 3],
    lengths: [f64; 3],
    is_straight: bool,
}

impl EdgeCurves {
    /// Those of a leaf some of whose edges have no neighbour that counts.
    pub(super) fn of(
        corners: &[LimitPoint; 3],
        middles: &[LimitPoint; 3],
        open: [bool; 3],
        asking: Asking,
    ) -> Self {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        let height = |edge: usize| {
            let point = middles[edge].position;
            match open[edge] || frame.is_flat() {
                true => frame.squared_to_edge(edge, point).sqrt(),
                false => frame.height(point),
            }
        };
        let counts = |edge: &usize| !asking.rim_alone || open[*edge];
        let (mut heights, mut lengths) = ([0.0; 3], [0.0; 3]);
        for edge in (0..3).filter(counts) {
            (heights[edge], lengths[edge]) = (height(edge), frame.length(edge));
        }
        Self {
            heights,
            lengths,
            is_straight: asking.is_straight,
        }
    }

    /// The bits of those that are higher.
    fn above(&self, limit: f64) -> u8 {
        let is_above = |edge: usize| self.heights[edge].abs() > limit;
        (0..3).fold(0, |bits, edge| bits | u8::from(is_above(edge)) << edge)
    }

    /// The bits of those that are split first: all that are higher, and those that are about as high where the surface is straight.
    pub(super) fn first(&self, limit: f64) -> u8 {
        match self.above(limit) {
            0 => 0,
            _ if self.is_straight => self.above(ALIKE * limit),
            bits => bits,
        }
    }

    /// The bits of those that are split next where those of some bits are: the longest other one; where the surface is straight in a
    /// direction, all that lead across, so that triangles stay in planes.
    pub(super) fn next(&self, split: u8) -> Option<u8> {
        if self.is_straight {
            let heights = self.heights.iter();
            let most = heights.fold(0.0, |most: f64, height| most.max(height.abs()));
            let across = self.above(ALIKE * most) & !split;
            return (across != 0).then_some(across);
        }
        let free = (0..3).filter(|edge| split >> edge & 1 == 0 && self.lengths[*edge] > 0.0);
        let longest = free.max_by(|&a, &b| self.lengths[a].total_cmp(&self.lengths[b]));
        longest.map(|edge| 1 << edge)
    }

    /// The bits of the edges that a leaf whose curves may be so high asks for; `None` if it is divided.
    pub(super) fn asked(&self, limit: f64) -> Option<u8> {
        match self.above(DIVIDED * limit) {
            0 => self.completed(self.first(SURE * limit), SURE * limit),
            _ => None,
        }
    }

    /// The bits of those that are split in the end, where those of some bits are: others follow as long as a triangle of the pattern is too
    /// high over the quadratic that stands over the middles. `None` if that is all of them.
    fn completed(&self, split: u8, limit: f64) -> Option<u8> {
        let mut split = split;
        while split != ALL_EDGES {
            let passes = |diagonal| {
                let mut triangles = closure(split, diagonal).triangles().iter();
                triangles.all(|&labels| self.height(labels) <= limit)
            };
            if passes(Diagonal::FromStart) || passes(Diagonal::FromEnd) {
                return Some(split);
            }
            split |= self.next(split)?;
        }
        None
    }

    /// The greatest height of that quadratic over a triangle of a pattern.
    fn height(&self, labels: [u8; 3]) -> f64 {
        // Second derivatives along the edges are eight times the heights in their middles.
        let [p, q, s] = self.heights.map(|height| 8.0 * height);
        let at = labels.map(|label| PLACES[usize::from(label)]);
        let bend = |i: usize| {
            let [u, v] = [0, 1].map(|axis| at[(i + 1) % 3][axis] - at[i][axis]);
            p * u * u + s * v * v + (p + s - q) * u * v
        };
        quadratic_height([0, 1, 2].map(bend))
    }
}
