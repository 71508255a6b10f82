//! Edges that leaves have split without being divided: a leaf that is not much too far from the surface asks for the middles of those
//! edges whose curves are, and the paper's Figure 5 closes it like any other whose edges are split.
//!
//! Sizes of leaves jump by four; middles of edges are the steps between.

use std::collections::HashMap;

use super::Engine;
use super::control::Control;
use super::dirty::Dirty;
use super::judge::{Judge, UNBALANCED};
use super::quadtree::NodeAddress;
use super::state::State;
use super::surface::SurfacePiece;
use crate::certificate::{TriangleFrame, quadratic_height};
use crate::closure::{Diagonal, closure};
use crate::patch::LimitPoint;
use crate::refine::RefineError;

/// A leaf so many times as far from the surface as it may be is divided. Its parts are a quarter as far.
pub(super) const DIVIDED: f64 = 4.0;

/// The places of the labels of [`closure`] in a leaf.
const PLACES: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [0.5, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
];

/// The bits of all edges.
const ALL_EDGES: u8 = 7;

/// The curves over those edges of a leaf that count, by their middles.
struct EdgeCurves {
    /// How far they are from the triangle; signed where that is by heights.
    heights: [f64; 3],
    lengths: [f64; 3],
}

impl EdgeCurves {
    /// Those of a leaf some of whose edges have no neighbour that counts, which may be the only ones that count themselves.
    fn of(
        corners: &[LimitPoint; 3],
        middles: &[LimitPoint; 3],
        open: [bool; 3],
        rim_alone: bool,
    ) -> Self {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        let height = |edge: usize| {
            let point = middles[edge].position;
            match open[edge] || frame.is_flat() {
                true => frame.squared_to_edge(edge, point).sqrt(),
                false => frame.height(point),
            }
        };
        let counted = |of: &dyn Fn(usize) -> f64| {
            [0, 1, 2].map(|edge| {
                if rim_alone && !open[edge] {
                    0.0
                } else {
                    of(edge)
                }
            })
        };
        Self {
            heights: counted(&height),
            lengths: counted(&|edge| frame.length(edge)),
        }
    }

    /// The bits of those that are too high.
    fn above(&self, limit: f64) -> u8 {
        (0..3).fold(0, |bits, edge| {
            bits | u8::from(self.heights[edge].abs() > limit) << edge
        })
    }

    /// The bits of the edges that are split in the end, where those of some bits are: as long as a triangle of the pattern is too high over
    /// the quadratic that stands over the middles, the longest edge that is not split. `None` if that is all of them.
    fn completed(&self, split: u8, limit: f64) -> Option<u8> {
        let mut split = split;
        while split != ALL_EDGES {
            let passes = |diagonal| {
                let triangles = closure(split, diagonal).triangles().iter();
                triangles
                    .map(|&labels| self.height(labels))
                    .all(|height| height <= limit)
            };
            if passes(Diagonal::FromStart) || passes(Diagonal::FromEnd) {
                return Some(split);
            }
            split |= 1 << self.longest(split)?;
        }
        None
    }

    /// The greatest height of that quadratic over a triangle of a pattern.
    fn height(&self, labels: [u8; 3]) -> f64 {
        // Second derivatives along the edges are eight times the heights in their middles.
        let [p, q, s] = self.heights.map(|height| 8.0 * height);
        let at = labels.map(|label| PLACES[label as usize]);
        let bend = |i: usize| {
            let [u, v] = [0, 1].map(|axis| at[(i + 1) % 3][axis] - at[i][axis]);
            p * u * u + s * v * v + (p + s - q) * u * v
        };
        quadratic_height([0, 1, 2].map(bend))
    }

    /// The longest of those without these bits.
    fn longest(&self, without: u8) -> Option<usize> {
        let free = (0..3).filter(|edge| without >> edge & 1 == 0 && self.lengths[*edge] > 0.0);
        free.max_by(|&a, &b| self.lengths[a].total_cmp(&self.lengths[b]))
    }
}

impl Control<'_> {
    /// Whether leaves of a control face may ask: where nothing counts but distances, which are proven, and no strips are put together, which would
    /// not lie in planes any more.
    pub(super) fn may_ask(&self, face: u32) -> bool {
        self.criteria.is_none() && self.rules.is_certified() && !self.flat.is_straight(face)
    }
}

impl Judge<'_> {
    /// The bits of the edges for whose middles a node asks that may not stay whole; `None` if it is divided.
    pub(super) fn asked(
        &self,
        corners: &[LimitPoint; 3],
        middles: &[LimitPoint; 3],
        open: [bool; 3],
    ) -> Option<u8> {
        if !self.may_ask {
            return None;
        }
        let curves = EdgeCurves::of(corners, middles, open, self.rim_alone);
        let is_far = curves.above(DIVIDED * self.limit) != 0;
        match is_far {
            true => None,
            false => curves.completed(curves.above(self.limit), self.limit),
        }
    }
}

impl Engine<'_> {
    /// Has leaves with triangles that fail, not by much, ask for the middles of edges; gives those that are to be divided instead.
    pub(super) fn ask(
        &self,
        state: &mut State,
        failing: &[(NodeAddress, f64)],
        dirty: &mut Dirty,
    ) -> Result<Vec<(NodeAddress, f64)>, RefineError> {
        let mut pieces = HashMap::new();
        let (mut divided, mut high, mut low) = (Vec::new(), Vec::new(), Vec::new());
        for &(place, value) in failing {
            self.watch.poll()?;
            let limit = state.goal.allowed(place.face);
            let may_ask = self.control.may_ask(place.face) && place.level < self.max_levels;
            if value > DIVIDED * limit || !may_ask {
                divided.push((place, value));
                continue;
            }
            let split = self.split_edges(state, place);
            let curves = self.curves(place, &mut pieces);
            // As far as corners may be moved.
            let limit = if self.is_balanced {
                UNBALANCED * limit
            } else {
                limit
            };
            let asked = curves.above(limit) & !split;
            if (asked | split) == ALL_EDGES {
                divided.push((place, value));
            } else if asked != 0 {
                high.push((place, asked));
            } else {
                low.push((place, value, split, curves));
            }
        }
        for (place, asked) in high {
            for edge in (0..3).filter(|edge| asked >> edge & 1 != 0) {
                self.ask_edge(state, place, edge, dirty)?;
            }
        }
        for (place, value, before, curves) in low {
            // Others may have helped.
            let split = self.split_edges(state, place);
            if split != before {
                continue;
            }
            match curves.longest(split) {
                Some(edge) if split.count_ones() < 2 => self.ask_edge(state, place, edge, dirty)?,
                _ => divided.push((place, value)),
            }
        }
        Ok(divided)
    }

    fn ask_edge(
        &self,
        state: &mut State,
        place: NodeAddress,
        edge: usize,
        dirty: &mut Dirty,
    ) -> Result<(), RefineError> {
        if !state.trees.ask(place, edge) {
            return Err(state.trees.too_many(4).into());
        }
        dirty.ask(&self.control.edges, place, edge);
        Ok(())
    }

    /// The bits of the edges of a leaf that have middles.
    fn split_edges(&self, state: &State, place: NodeAddress) -> u8 {
        let edges = &self.control.edges;
        let has_middle = |edge: &usize| state.trees.has_middle(edges, place, *edge);
        (0..3)
            .filter(has_middle)
            .fold(0, |bits, edge| bits | 1 << edge)
    }

    /// The curves over the edges of a leaf; pieces of control faces are kept.
    fn curves(&self, place: NodeAddress, pieces: &mut HashMap<u32, SurfacePiece>) -> EdgeCurves {
        let control = self.control;
        let piece = pieces
            .entry(place.face)
            .or_insert_with(|| control.piece(place.face));
        let surface = (0..place.level).fold(piece.surface(control.rules), |surface, level| {
            surface.child(place.digit(level))
        });
        let open = control.open(place.face);
        let open = [0, 1, 2].map(|edge| open[edge] && place.lies_along(edge));
        EdgeCurves::of(
            &surface.corners(),
            &surface.middles(),
            open,
            control.flat.is_its_rim(place.face),
        )
    }
}
