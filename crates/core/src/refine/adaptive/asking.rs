//! Edges that leaves have split without being divided: a leaf that is not much too far from the surface asks for the middles of those
//! edges whose curves are, and the paper's Figure 5 closes it like any other whose edges are split.
//!
//! Sizes of leaves jump by four; middles of edges are the steps between.

use super::Engine;
use super::dirty::Dirty;
use super::edge_curves::{Asking, DIVIDED, EdgeCurves};
use super::judge::UNBALANCED;
use super::measured::Failing;
use super::quadtree::{ALL_EDGES, NodeAddress};
use super::state::State;
use super::surface::SurfacePiece;
use crate::refine::RefineError;

impl Engine<'_> {
    /// Has leaves with triangles that fail, not by much, ask for the middles of edges; gives those that are to be divided instead.
    pub(super) fn ask(
        &self,
        state: &mut State,
        failing: &[Failing],
        dirty: &mut Dirty,
    ) -> Result<Vec<Failing>, RefineError> {
        let mut last = None;
        let (mut divided, mut high, mut low) = (Vec::new(), Vec::new(), Vec::new());
        for &(place, value) in failing {
            self.watch.poll()?;
            let asking = Asking::of(self.control, place.face);
            let limit = state.goal.allowed(place.face);
            if value > DIVIDED * limit || !asking.may_be || place.level >= self.max_levels {
                divided.push((place, value));
                continue;
            }
            // As far as corners may be moved.
            let times = if self.is_balanced { UNBALANCED } else { 1.0 };
            let split = self.split_edges(state, place);
            let curves = self.curves(place, asking, &mut last);
            let asked = curves.first(times * limit) & !split;
            if asked | split == ALL_EDGES {
                divided.push((place, value));
            } else if asked != 0 {
                high.push((place, asked));
            } else {
                low.push((place, value, split, curves));
            }
        }
        for (place, asked) in high {
            self.ask_edges(state, place, asked, dirty)?;
        }
        for (place, value, before, curves) in low {
            let split = self.split_edges(state, place);
            // Others may have helped.
            if split != before {
                continue;
            }
            match curves.next(split) {
                Some(asked) if asked | split != ALL_EDGES => {
                    self.ask_edges(state, place, asked, dirty)?;
                }
                _ => divided.push((place, value)),
            }
        }
        Ok(divided)
    }

    /// Has a leaf ask for the middles of the edges of these bits.
    fn ask_edges(
        &self,
        state: &mut State,
        place: NodeAddress,
        asked: u8,
        dirty: &mut Dirty,
    ) -> Result<(), RefineError> {
        for edge in (0..3).filter(|edge| asked >> edge & 1 != 0) {
            if !state.trees.ask(place, edge) {
                return Err(state.trees.too_many(4).into());
            }
            dirty.ask(&self.control.edges, place, edge);
        }
        Ok(())
    }

    /// The bits of the edges of a leaf that have middles.
    fn split_edges(&self, state: &State, place: NodeAddress) -> u8 {
        let edges = &self.control.edges;
        let has_middle = |edge: usize| state.trees.has_middle(edges, place, edge);
        (0..3).fold(0, |bits, edge| bits | u8::from(has_middle(edge)) << edge)
    }

    /// The curves over the edges of a leaf; the piece of the last control face is kept.
    fn curves(
        &self,
        place: NodeAddress,
        asking: Asking,
        last: &mut Option<(u32, SurfacePiece)>,
    ) -> EdgeCurves {
        let control = self.control;
        let (_, piece) = match last.take().filter(|(face, _)| *face == place.face) {
            Some(known) => last.insert(known),
            None => last.insert((place.face, control.piece(place.face))),
        };
        let surface = piece.over(place, control.rules);
        let open = control.open(place.face);
        let open = [0, 1, 2].map(|edge| open[edge] && place.lies_along(edge));
        EdgeCurves::of(&surface.corners(), &surface.middles(), open, asking)
    }
}
