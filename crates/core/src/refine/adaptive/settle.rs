//! The leaves that pass on conditions, with their neighbours as they are emitted.
//!
//! Most triangles pass whatever is beside them ([`super::judge`]). What is left counted on neighbours like itself; here the
//! angles between the emitted triangles say whether that was right.

use std::collections::HashSet;

use super::emit::{self, Emission, Extend};
use super::judge::{Condition, Goal};
use super::quadtree::Place;
use super::{Engine, Plan};
use crate::certificate::{STEEP, around};
use crate::mesh::NONE;
use crate::parallel;
use crate::refine::RefineError;
use crate::vector::vector;

/// Leaves that one call takes together.
const BLOCK: usize = 1024;

/// Rounds of dividing leaves whose conditions do not hold; what still fails after them has to pass without conditions.
const MOST_ROUNDS: usize = 2;

impl Engine<'_> {
    /// Divides where conditions do not hold; `false` if there are too many triangles.
    pub(super) fn settle(&self, plan: &mut Plan, most: usize) -> Result<bool, RefineError> {
        let mut round = 0;
        loop {
            round += 1;
            self.settle_by_allowances(plan);
            let only = self.conditional(plan);
            let chains = (&plan.decision, &plan.chains);
            let emission = match &only {
                Some(only) if only.iter().all(|&extend| extend == Extend::Nothing) => return Ok(true),
                Some(only) => emit::emit(self.control, &self.edges, chains, &plan.closed, Some(only))?,
                None => self.emit_all(plan)?,
            };
            let found = failing(&emission, &plan.goal, &mut plan.settled);
            let mut is_dirty = vec![false; plan.closed.len()];
            let mut is_split = false;
            for (place, bound) in found {
                if place.level >= self.max_levels {
                    plan.has_failed = true;
                    let known = &mut plan.settled[place.face as usize];
                    if known.is_none_or(|(known, _)| bound > known) {
                        *known = Some((bound, place));
                    }
                    continue;
                }
                is_split = true;
                self.mark(place.face, &mut is_dirty);
                if round > MOST_ROUNDS {
                    plan.decision.trees.make_strict(place);
                }
                self.split(&mut plan.decision.trees, place, |place| self.mark(place.face, &mut is_dirty))?;
            }
            if !is_split {
                plan.emission = only.is_none().then_some(emission);
                return Ok(true);
            }
            if !self.carry_out(plan, is_dirty, most)? {
                return Ok(false);
            }
        }
    }

    /// Settles the faces whose conditions hold whatever is beside, by what triangles there came to after all.
    fn settle_by_allowances(&self, plan: &mut Plan) {
        // Where nothing is asked for, what the neighbours really are tells how far off they may be.
        if matches!(plan.goal, Goal::Even(..)) {
            return;
        }
        for face in 0..plan.closed.len() {
            let lists = [plan.decision.conditions(face as u32), &plan.closed[face].conditions];
            if plan.settled[face].is_some() || lists.iter().all(|list| list.is_empty()) {
                continue;
            }
            let closing = |face: u32| plan.closed[face as usize].extent.as_ref();
            let (around, _) = plan.decision.around(self.control, &self.edges, face as u32, closing);
            let bounds =
                lists.into_iter().flatten().map(|condition| (condition.bound(&around), condition.place));
            let worst = bounds.max_by(|a, b| a.0.total_cmp(&b.0));
            plan.settled[face] = worst.filter(|&(bound, _)| bound <= plan.goal.allowed(face as u32));
        }
    }

    /// What must be emitted to look at the conditions that nobody has looked at: their faces and those around, and the
    /// edges of the faces around these. `None` if that is most of all.
    fn conditional(&self, plan: &Plan) -> Option<Vec<Extend>> {
        let has = |face: usize| {
            let conditions = [plan.decision.conditions(face as u32), &plan.closed[face].conditions];
            plan.settled[face].is_none() && conditions.iter().any(|list| !list.is_empty())
        };
        let wider = |marked: &[bool]| {
            let mut wider = marked.to_vec();
            (0..marked.len())
                .filter(|&face| marked[face])
                .for_each(|face| self.mark(face as u32, &mut wider));
            wider
        };
        let whole = wider(&(0..plan.closed.len()).map(has).collect::<Vec<bool>>());
        let triangles = plan.closed.iter().zip(&whole).filter(|&(_, &is_whole)| is_whole);
        let triangles: usize = triangles.map(|(face, _)| face.triangles as usize).sum();
        if 2 * triangles >= plan.triangles {
            return None;
        }
        let edges = wider(&whole);
        let extend = |(is_whole, is_edge): (bool, bool)| match (is_whole, is_edge) {
            (true, _) => Extend::All,
            (false, true) => Extend::Edges,
            (false, false) => Extend::Nothing,
        };
        Some(whole.into_iter().zip(edges).map(extend).collect())
    }
}

/// The leaves whose conditions do not hold, and what they come to. Where all of a control face do, `settled` gets the greatest bound of one, and the
/// leaf; faces that have it already are passed over.
fn failing(emission: &Emission, goal: &Goal, settled: &mut [Option<(f64, Place)>]) -> Vec<(Place, f64)> {
    let sharp = sharp_edges(emission);
    let conditions =
        emission.conditions.iter().filter(|(condition, ..)| settled[condition.place.face as usize].is_none());
    let conditions: Vec<&(Condition, u32, u32)> = conditions.collect();
    let found = parallel::pieces_of(conditions.len(), BLOCK, |block| {
        let bounds = conditions[block].iter().map(|(condition, first, last)| {
            let (mut squared, mut slope) = (0.0f64, STEEP);
            for triangle in *first..*last {
                let (turn, room) = beside(emission, &sharp, triangle);
                squared = squared.max(turn);
                slope = slope.min(room);
            }
            let bound = condition.deviation.bound(squared.sqrt(), slope);
            (bound, bound <= goal.allowed(condition.place.face), condition.place)
        });
        bounds.collect::<Vec<_>>()
    });
    let (mut failing, mut failed) = (Vec::new(), HashSet::new());
    for (bound, holds, place) in found.into_iter().flatten() {
        let known = &mut settled[place.face as usize];
        if !holds {
            failing.push((place, bound));
            failed.insert(place.face);
        } else if known.is_none_or(|(known, _)| bound > known) {
            *known = Some((bound, place));
        }
    }
    // Where all leaves with conditions have been divided since there is nothing left to look at.
    for (face, known) in (0..).zip(settled.iter_mut()) {
        if failed.contains(&face) {
            *known = None;
        } else if known.is_none() {
            *known = Some((0.0, Place::root(face)));
        }
    }
    failing
}

/// The half-edges along sharp edges.
pub(super) fn sharp_edges(emission: &Emission) -> HashSet<u32> {
    emission.sharp.iter().flat_map(|(h, _)| emission.borders.along(*h).iter().copied()).collect()
}

/// [`around`] of an emitted triangle. Sharp edges have nobody beyond.
pub(super) fn beside(emission: &Emission, sharp: &HashSet<u32>, triangle: u32) -> (f64, f64) {
    let at = |vertex: u32| vector(emission.positions[vertex as usize]);
    let opposite = [0, 1, 2].map(|edge| {
        let h = 3 * triangle + edge;
        let twin = emission.twins[h as usize];
        let is_open = twin == NONE || !sharp.is_empty() && sharp.contains(&h);
        (!is_open).then(|| at(emission.triangles[twin as usize / 3][(twin as usize + 2) % 3]))
    });
    around(emission.triangles[triangle as usize].map(at), &opposite)
}
