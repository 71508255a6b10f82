//! Edges that leaves have split without being divided: a leaf that is not much too far from the surface asks for the middles of those
//! edges whose curves are, and the paper's Figure 5 closes it like any other whose edges are split.
//!
//! Sizes of leaves jump by four; middles of edges are the steps between.

use std::collections::HashMap;

use super::Engine;
use super::dirty::Dirty;
use super::judge::Judge;
use super::quadtree::NodeAddress;
use super::state::State;
use super::surface::SurfacePiece;
use crate::certificate::TriangleFrame;
use crate::patch::LimitPoint;
use crate::refine::RefineError;

/// A leaf so many times as far from the surface as it may be is divided. Its parts are a quarter as far.
pub(super) const DIVIDED: f64 = 4.0;

/// The bits of all edges.
const ALL_EDGES: u8 = 7;

/// The curves over the edges of a leaf, by their middles.
struct EdgeCurves {
    /// How far they are from the triangle.
    heights: [f64; 3],
    lengths: [f64; 3],
}

impl EdgeCurves {
    fn of(corners: &[LimitPoint; 3], middles: &[LimitPoint; 3], open: [bool; 3]) -> Self {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        let height = |edge: usize| {
            let point = middles[edge].position;
            match open[edge] || frame.is_flat() {
                true => frame.squared_to_edge(edge, point).sqrt(),
                false => frame.height(point).abs(),
            }
        };
        Self {
            heights: [0, 1, 2].map(height),
            lengths: [0, 1, 2].map(|edge| frame.length(edge)),
        }
    }

    /// The bits of those that are too high.
    fn above(&self, limit: f64) -> u8 {
        (0..3).fold(0, |bits, edge| {
            bits | u8::from(self.heights[edge] > limit) << edge
        })
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
        let curves = EdgeCurves::of(corners, middles, open);
        let is_far = curves.above(DIVIDED * self.limit) != 0;
        let asked = curves.above(self.limit);
        (self.may_ask() && !is_far && asked != ALL_EDGES).then_some(asked)
    }
}

impl Engine<'_> {
    /// Whether leaves may ask: where vertices stay on the surface and nothing counts but distances.
    fn may_ask(&self) -> bool {
        !self.is_balanced && self.control.criteria.is_none()
    }

    /// Has leaves with triangles that fail, not by much, ask for the middles of edges; gives those that are to be divided instead.
    pub(super) fn ask(
        &self,
        state: &mut State,
        failing: &[(NodeAddress, f64)],
        dirty: &mut Dirty,
    ) -> Result<Vec<(NodeAddress, f64)>, RefineError> {
        if !self.may_ask() {
            return Ok(failing.to_vec());
        }
        let mut pieces = HashMap::new();
        let (mut divided, mut high, mut low) = (Vec::new(), Vec::new(), Vec::new());
        for &(place, value) in failing {
            self.watch.poll()?;
            let limit = state.goal.allowed(place.face);
            let is_rim = self.control.flat.is_its_rim(place.face);
            if value > DIVIDED * limit || is_rim || place.level >= self.max_levels {
                divided.push((place, value));
                continue;
            }
            let split = self.split_edges(state, place);
            let curves = self.curves(place, &mut pieces);
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
            let free = (0..3).filter(|edge| split >> edge & 1 == 0);
            let longest = free.max_by(|&a, &b| curves.lengths[a].total_cmp(&curves.lengths[b]));
            match longest {
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
        EdgeCurves::of(&surface.corners(), &surface.middles(), open)
    }
}
