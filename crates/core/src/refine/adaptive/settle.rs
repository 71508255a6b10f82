//! The leaves that pass on conditions, with their neighbours as they are emitted.
//!
//! Most triangles pass whatever is beside them ([`super::judge`]). What is left counted on neighbours like itself; here the
//! angles between the emitted triangles say whether that was right.

mod settled_faces;

use std::collections::HashSet;

use super::area::Areas;
use super::dirty::Dirty;
use super::emit::{Emission, Scope};
use super::judge::{Condition, Goal};
use super::quadtree::Place;
use super::{Engine, Plan};
use crate::certificate::{STEEP, around};
use crate::mesh::NONE;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;
use crate::vector::{DVec3, vector};
pub(super) use settled_faces::SettledFaces;

/// Leaves that one call takes together.
const BLOCK: usize = 1024;

/// Rounds of dividing leaves whose conditions do not hold; what still fails after them has to pass without conditions.
const MOST_ROUNDS: usize = 2;

/// Rounds after which what lies around leaves whose conditions do not hold is divided, too, one level more of it each round: what one
/// division gives fails in its turn, and a front of such triangles creeps on by one a round.
const PATIENT_ROUNDS: usize = 4;

/// Where a greater part of the triangles than this would be looked at, all are emitted, and kept.
const MOST_LOOKED_AT: f64 = 0.25;

/// How many levels more at most.
const MOST_UP: usize = 3;

impl Engine<'_> {
    /// Divides where conditions do not hold; `false` if there are too many triangles.
    pub(super) fn settle(&self, plan: &mut Plan, most: usize) -> Result<bool, RefineError> {
        let mut round = 0;
        loop {
            round += 1;
            self.settle_by_allowances(plan)?;
            let areas = self.conditional(plan)?;
            if areas.0.is_empty() {
                return Ok(true);
            }
            let found = self.failing(plan, &areas)?;
            let mut dirty = Dirty::none(plan.closed.len());
            let mut is_split = false;
            for (place, bound) in found {
                self.watch.poll()?;
                if place.level >= self.max_levels {
                    plan.has_failed = true;
                    plan.settled.add(place, bound);
                    continue;
                }
                is_split = true;
                if round > MOST_ROUNDS {
                    plan.decision.trees.make_strict(place);
                }
                let up = (round.saturating_sub(PATIENT_ROUNDS)).min(MOST_UP);
                let around = (0..up).fold(place, |around, _| around.parent().unwrap_or(around));
                self.split_around(plan, (around, place.level), &mut dirty)?;
            }
            if !is_split {
                return Ok(true);
            }
            if !self.carry_out(plan, dirty, most)? {
                return Ok(false);
            }
        }
    }

    /// Splits what there is of a level below a node.
    fn split_around(
        &self,
        plan: &mut Plan,
        (around, level): (Place, u32),
        dirty: &mut Dirty,
    ) -> Result<(), RefineError> {
        if !plan.decision.trees.has(around) {
            return Ok(());
        }
        if around.level == level {
            return self.split(&mut plan.decision.trees, around, dirty);
        }
        (0..4).try_for_each(|child| self.split_around(plan, (around.child(child), level), dirty))
    }

    /// Settles the faces whose conditions hold whatever is beside, by what triangles there came to after all.
    fn settle_by_allowances(&self, plan: &mut Plan) -> Result<(), Cancelled> {
        // Where nothing is asked for, what the neighbours really are tells how far off they may be.
        if matches!(plan.goal, Goal::Even(..)) {
            return Ok(());
        }
        self.watch.each(0..plan.closed.len() as u32, |face| {
            let lists = [
                plan.decision.conditions(face),
                plan.closed[face as usize].conditions(),
            ];
            if plan.settled.has(face) || lists.iter().all(|list| list.is_empty()) {
                return;
            }
            let closing = |face: u32| plan.closed[face as usize].extent();
            let (around, _) = plan
                .decision
                .around(self.control, &self.edges, face, closing);
            let bounds = lists
                .into_iter()
                .flatten()
                .map(|condition| (condition.bound(&around), condition.place));
            let worst = bounds.max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((bound, place)) =
                worst.filter(|&(bound, _)| bound <= plan.goal.allowed(face))
            {
                plan.settled.add(place, bound);
            }
        })
    }

    /// What must be looked at: the leaves with conditions that nobody has looked at, and what is beside them.
    fn conditional(&self, plan: &Plan) -> Result<Areas, Cancelled> {
        let mut areas = Areas::default();
        let faces = (0..plan.closed.len() as u32).filter(|&face| !plan.settled.has(face));
        self.watch.each(faces, |face| {
            let open = self.control.open(face);
            let lists = [
                plan.decision.conditions(face),
                plan.closed[face as usize].conditions(),
            ];
            for condition in lists.into_iter().flatten() {
                areas.add(&self.edges, condition.place, open);
            }
        })?;
        Ok(areas)
    }

    /// The leaves in these areas whose conditions do not hold.
    fn failing(&self, plan: &mut Plan, areas: &Areas) -> Result<Vec<(Place, f64)>, RefineError> {
        let count = |face: u32| plan.closed[face as usize].triangles as usize;
        let in_faces: usize = areas.0.keys().map(|&face| count(face)).sum();
        let in_areas: f64 = areas
            .0
            .iter()
            .map(|(&face, area)| area.share() * count(face) as f64)
            .sum();
        // What is emitted first is taken over in the end; later looks are not worth that.
        let scope = match plan.emission {
            None if 2 * in_faces < plan.triangles => Scope::Faces(areas),
            Some(_) if in_areas < MOST_LOOKED_AT * plan.triangles as f64 => Scope::Areas(areas),
            _ => Scope::All,
        };
        let found = self.failing_in(plan, scope)?;
        // What is not known for want of those beside it is looked at among all.
        if !matches!(scope, Scope::All) && found.iter().any(|(_, bound)| bound.is_infinite()) {
            return self.failing_in(plan, Scope::All);
        }
        Ok(found)
    }

    /// The same by so much of the plan. Keeps what was emitted but areas.
    fn failing_in(
        &self,
        plan: &mut Plan,
        scope: Scope<'_>,
    ) -> Result<Vec<(Place, f64)>, RefineError> {
        if matches!(scope, Scope::Areas(_)) {
            let emission = self.emit_some(plan, scope)?;
            return Ok(failing(
                &emission,
                &plan.goal,
                &mut plan.settled,
                self.watch,
            )?);
        }
        let emission = self.emit_instead(plan, scope)?;
        let found = failing(&emission, &plan.goal, &mut plan.settled, self.watch)?;
        plan.emission = Some(emission);
        plan.is_touched.fill(false);
        Ok(found)
    }
}

/// The leaves whose conditions do not hold, and what they come to. Where all of a control face do, `settled` gets the greatest bound of one, and the
/// leaf; faces that have it already are passed over. What was emitted without something beside it has an infinite bound.
fn failing(
    emission: &Emission,
    goal: &Goal,
    settled: &mut SettledFaces,
    watch: &SharedWatch<'_>,
) -> Result<Vec<(Place, f64)>, Cancelled> {
    let sharp = sharp_edges(emission, watch)?;
    let conditions = emission
        .conditions
        .iter()
        .filter(|(condition, ..)| !settled.has(condition.place.face));
    let conditions: Vec<&(Condition, u32, u32)> = conditions.collect();
    let found = watch.pieces(conditions.len(), BLOCK, |block| {
        let bounds = conditions[block].iter().map(|(condition, first, last)| {
            let (mut squared, mut slopes) = (0.0f64, [STEEP; 3]);
            let mut is_known = true;
            for triangle in *first..*last {
                is_known &= has_neighbours(emission, &sharp, triangle);
                let (turn, room) = beside(emission, &sharp, triangle);
                squared = squared.max(turn);
                (0..3).for_each(|edge| slopes[edge] = slopes[edge].min(room[edge]));
            }
            let bound = if is_known {
                condition.deviation.bound(squared.sqrt(), slopes)
            } else {
                f64::INFINITY
            };
            (
                bound,
                is_known && bound <= goal.allowed(condition.place.face),
                condition.place,
            )
        });
        bounds.collect::<Vec<_>>()
    })?;
    let (mut failing, mut failed) = (Vec::new(), HashSet::new());
    watch.each(found.into_iter().flatten(), |(bound, holds, place)| {
        if holds {
            settled.add(place, bound);
        } else {
            failing.push((place, bound));
            failed.insert(place.face);
        }
    })?;
    // Where all leaves with conditions have been divided since there is nothing left to look at.
    watch.each(0..settled.faces(), |face| match failed.contains(&face) {
        true => settled.forget(face),
        false => settled.settle(face),
    })?;
    Ok(failing)
}

/// Whether all that is beyond a triangle's edges was emitted.
fn has_neighbours(emission: &Emission, sharp: &HashSet<u32>, triangle: u32) -> bool {
    (3 * triangle..3 * triangle + 3)
        .all(|h| beyond(emission, sharp, h).is_none_or(|twin| emission.is_known(h, twin)))
}

/// The half-edges along sharp edges.
pub(super) fn sharp_edges(
    emission: &Emission,
    watch: &SharedWatch<'_>,
) -> Result<HashSet<u32>, Cancelled> {
    let mut sharp = HashSet::new();
    let all = emission
        .sharp
        .iter()
        .flat_map(|(h, _)| emission.borders.along(*h));
    watch.each(all, |&h| {
        sharp.insert(h);
    })?;
    Ok(sharp)
}

/// [`around`] of an emitted triangle. Sharp edges have nobody beyond.
pub(super) fn beside(emission: &Emission, sharp: &HashSet<u32>, triangle: u32) -> (f64, [f64; 3]) {
    let opposite = [0, 1, 2].map(|edge| {
        let twin = beyond(emission, sharp, 3 * triangle + edge)?;
        let vertex = emission.triangles[twin as usize / 3][(twin as usize + 2) % 3];
        Some(vector(emission.positions[vertex as usize]))
    });
    around(corners(emission, triangle), &opposite)
}

/// By edge the corners of the triangle beyond, the one opposite last.
pub(super) type Neighbours = [Option<[DVec3; 3]>; 3];

/// [`beside`], and the triangles beyond the edges.
pub(super) fn neighbours(
    emission: &Emission,
    sharp: &HashSet<u32>,
    triangle: u32,
) -> ((f64, [f64; 3]), Neighbours) {
    let neighbours = [0, 1, 2].map(|edge| {
        let twin = beyond(emission, sharp, 3 * triangle + edge)?;
        let mut corners = corners(emission, twin / 3);
        corners.rotate_left(twin as usize % 3);
        Some(corners)
    });
    let opposite = neighbours.map(|corners| corners.map(|[.., opposite]| opposite));
    (around(corners(emission, triangle), &opposite), neighbours)
}

/// The half-edge on the other side, where somebody is.
fn beyond(emission: &Emission, sharp: &HashSet<u32>, h: u32) -> Option<u32> {
    let twin = emission.twins[h as usize];
    let is_open = twin == NONE || !sharp.is_empty() && sharp.contains(&h);
    (!is_open).then_some(twin)
}

fn corners(emission: &Emission, triangle: u32) -> [DVec3; 3] {
    emission.triangles[triangle as usize].map(|vertex| vector(emission.positions[vertex as usize]))
}

#[cfg(test)]
mod tests;
