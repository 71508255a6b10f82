//! Leaves whose closing triangles leave their cones, split before these are emitted.
//!
//! A leaf that is split gives the leaves beyond its edges closing triangles. Near cusps these leave their cones in turn, one layer of
//! leaves after the other. A round of the loop for each layer would take minutes; here only the leaves of a layer are looked at.

use std::collections::HashMap;

use super::Engine;
use super::backs::{Behind, Leaf};
use super::balance::{Pending, balance};
use super::cover::is_nearer_from_end;
use super::dirty::Dirty;
use super::leaf::LeafTriangle;
use super::quadtree::{NodeAddress, is_leaf};
use super::seen::Seen;
use super::state::State;
use super::surface::{Surface, SurfacePiece};
use super::trial::Trial;
use crate::closure::{Diagonal, closure};
use crate::criterion::Criteria;
use crate::refine::RefineError;

impl Engine<'_> {
    /// Splits leaves next to those that were split, as long as closing triangles leave their cones and there may be more triangles.
    /// Angles of vertices off the surface are left to the loop.
    pub(super) fn split_closing(
        &self,
        state: &mut State,
        dirty: &mut Dirty,
        most: usize,
    ) -> Result<(), RefineError> {
        let criteria = self.control.criteria.as_ref();
        let has_cones = |criteria: &&Criteria| criteria.has_cones() && !self.is_balanced;
        let Some(criteria) = criteria.filter(has_cones) else {
            return Ok(());
        };
        let mut pieces = HashMap::new();
        let mut first = 0;
        while first < dirty.split().len() && dirty.split().len() < most {
            let layer = self.touched(state, &dirty.split()[first..]);
            first = dirty.split().len();
            let mut failing = Vec::new();
            for place in layer {
                self.watch.poll()?;
                if place.level < self.max_levels
                    && self.leaves_cone(state, place, criteria, &mut pieces)
                {
                    failing.push(place);
                }
            }
            let mut pending = Pending::default();
            for place in failing {
                self.split(state, place, dirty)?;
                pending.push(place);
            }
            let edges = &self.control.edges;
            let fits = balance(
                &mut state.trees,
                edges,
                pending,
                &mut || self.watch.poll(),
                |place| dirty.add(edges, place),
            )?;
            fits.then_some(()).ok_or_else(|| state.trees.too_many(4))?;
        }
        Ok(())
    }

    /// The leaves that nodes which were split have given other triangles: their children, and the leaves beyond their edges.
    fn touched(&self, state: &State, split: &[NodeAddress]) -> Vec<NodeAddress> {
        let mut touched = Vec::with_capacity(7 * split.len());
        for &place in split {
            touched.extend((0..4).map(|child| place.child(child)));
            for edge in 0..3 {
                let beyond = self.control.edges.nodes_beyond(place, edge);
                touched.extend(beyond.into_iter().map(|(other, _)| other));
            }
        }
        touched.retain(|&place| is_leaf(&state.trees, place));
        touched.sort_unstable_by_key(|place| (place.face, place.level, place.path));
        touched.dedup();
        touched
    }

    /// Whether a triangle that closes a leaf leaves the cones of its corners.
    fn leaves_cone(
        &self,
        state: &State,
        place: NodeAddress,
        criteria: &Criteria,
        pieces: &mut HashMap<u32, SurfacePiece>,
    ) -> bool {
        let (control, trees) = (self.control, &state.trees);
        let split: Vec<usize> = (0..3)
            .filter(|&edge| trees.has_middle(&control.edges, place, edge))
            .collect();
        if split.is_empty() {
            return false;
        }
        let piece = pieces
            .entry(place.face)
            .or_insert_with(|| control.piece(place.face));
        let surface = piece.over(place, control.rules);
        let unsplit = 3 - split.iter().sum::<usize>();
        let is_from_end =
            split.len() == 2 && !state.has_fixed_diagonals && is_nearer_from_end(surface, unsplit);
        let diagonal = match is_from_end {
            true => Diagonal::FromEnd,
            false => Diagonal::FromStart,
        };
        let ([a, b, c], [d, e, f]) = (surface.corners(), surface.middles());
        let points = [a, b, c, d, e, f];
        let bits = split.iter().fold(0, |bits, edge| bits | 1 << edge);
        let patch = surface.patch();
        let leaf = match surface {
            Surface::Regular(piece, domain) => Leaf::Regular(piece.quartic(), domain),
            Surface::Bicubic(..) | Surface::General(..) => match &patch {
                Some(patch) => Leaf::General(patch, control.rules),
                None => return false,
            },
            Surface::Unknown => return false,
        };
        let behind = Behind {
            faces: &control.back_faces,
            face: place.face,
            leaf,
        };
        let limit = state.goal.allowed(place.face);
        let fails = |labels: &[u8; 3]| {
            let corners = LeafTriangle::of(*labels).corners.map(|label| points[label]);
            Trial::of(criteria, limit, &Seen::of(&corners), &corners, &behind)
                .at_level(place.level)
                .leaves_cone()
        };
        closure(bits, diagonal).triangles().iter().any(fails)
    }
}
