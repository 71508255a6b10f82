//! Emission where triangles are looked at among their neighbours, all of them: for goals beside distances, and for vertices
//! that are moved off the surface.

use super::bulges::Bulges;
use super::carry_out::marked;
use super::changes::Changes;
use super::dirty::Dirty;
use super::emit::Emission;
use super::emitted::Sources;
use super::judge::Goal;
use super::measure::measure;
use super::measured::Measured;
use super::quadtree::{self, Place};
use super::result::Outcome;
use super::{ADDED, Engine, Plan};
use crate::progress::Stage;
use crate::refine::RefineError;
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::{Exact, ExactStop};

/// Heights of parts are at most so many times what they should be, a quarter.
const SURELY: f64 = 1.5;

/// What balancing leaves of a plain mesh's distance, at equal triangles, about.
const BALANCED: f64 = 0.65;

/// Values that are tried under a budget.
const MOST_TRIES: usize = 8;

/// Values nearer to each other than this part tell nothing any more: the budget is spent but for some per cent.
const NEAR: f64 = 0.98;

/// Distances at irregular vertices fall by this part each time at least.
const HALVED: f64 = 0.5;

/// What fails by more times than this says nothing of those below it.
const MOST_TIMES: f64 = 64.0;

/// Of a leaf that has been split at a corner of its control face, or beside the leaf there, the next one at the corner; which of its parent's children
/// that is; and whether the leaf was beside it.
fn towards_corner(place: Place) -> Option<(Place, usize, bool)> {
    let parent = place.parent()?;
    let (first, last) = (place.digit(0), place.digit(place.level - 1));
    let is_at_corner = first < 3 && (0..parent.level).all(|level| parent.digit(level) == first);
    match last {
        _ if !is_at_corner => None,
        3 => Some((parent.child(first), first, true)),
        _ => (last == first).then(|| (place.child(first), first, false)),
    }
}

/// Whether there is a node at a place that has no children.
fn is_leaf(plan: &Plan, place: Place) -> bool {
    plan.decision
        .trees
        .word_at(place)
        .is_some_and(|word| !quadtree::is_split(word))
}

impl Engine<'_> {
    /// Emits a plan whose triangles come to `goal` at most among their neighbours, dividing what fails; `None` if there are too
    /// many triangles. Where a budget is all that ends the division, what does not fit any more counts as it is.
    pub(super) fn emit_among(
        &self,
        mut plan: Plan,
        goal: &Goal,
        (most, is_budget): (usize, bool),
    ) -> Result<Option<Outcome>, RefineError> {
        let mut bulges = Bulges::default();
        let faces = 0..plan.closed.len() as u32;
        let mut measured: Vec<Measured> = faces.map(Measured::nothing).collect();
        // Heights that are good enough, where it is known.
        let allowed = if self.control.criteria.is_none() {
            goal.allowed(0)
        } else {
            0.0
        };
        let is_alone = self.is_balanced && allowed > 0.0;
        loop {
            let touched = plan.is_touched.clone();
            let mut emission = self.emit_all(&mut plan)?;
            if self.is_balanced {
                let sources = self.sources(&plan, &emission);
                bulges.look(
                    &sources,
                    self.watch,
                    &marked(&touched),
                    (allowed, self.max_levels),
                )?;
                let moves = bulges.offsets(self.control, &mut emission, allowed, self.watch)?;
                emission.shift(moves, self.watch)?;
            }
            self.watch.stage(Stage::Bounding, None)?;
            // Of triangles of which nothing but distances is asked it is known what they came to.
            let known = self.is_balanced.then_some(&bulges);
            let changes = Changes::since((known, is_alone), &touched, &emission, self.watch)?;
            let sources = self.sources(&plan, &emission);
            let faces = changes.faces(&emission, &self.edges, self.watch)?;
            let found = measure(
                &sources,
                self.watch,
                (goal, f64::INFINITY),
                (&faces, Some(&changes), known),
            )?;
            self.watch
                .each(faces.iter().zip(found), |(&face, mut found)| {
                    let is_other = touched[face as usize] && !is_alone;
                    let is_all = bulges.keep(face, &mut found, &emission) || is_other;
                    measured[face as usize].replace(found, is_all);
                })?;
            let failing: Vec<(Place, f64)> = measured
                .iter_mut()
                .flat_map(|face| core::mem::take(&mut face.failing))
                .collect();
            let is_full = is_budget && plan.triangles + ADDED * failing.len() > most;
            let mut dirty = Dirty::none(plan.closed.len());
            let mut is_split = false;
            if !is_full {
                // What cannot be balanced was not measured.
                let hopeless = if is_alone {
                    bulges.failing()
                } else {
                    Vec::new()
                };
                for (failing, allowed) in [(&hopeless, Some(allowed)), (&failing, None)] {
                    is_split |= self.divide(&mut plan, failing, allowed, &mut dirty)?;
                }
                if is_alone {
                    is_split |=
                        self.divide_towards_corners(&mut plan, &failing, goal, &mut dirty)?;
                }
            }
            if !is_split {
                return Ok(Some(Outcome {
                    plan,
                    emission,
                    measured: Some(measured),
                }));
            }
            plan.emission = Some(emission);
            if !self.carry_out(&mut plan, dirty, most)? {
                return Ok(None);
            }
        }
    }

    /// Divides the leaves that fail, and marks the faces that this changes; says whether there are any that may be. With heights that
    /// are `allowed` as often as these take, each division leaving a quarter.
    fn divide(
        &self,
        plan: &mut Plan,
        failing: &[(Place, f64)],
        allowed: Option<f64>,
        dirty: &mut Dirty,
    ) -> Result<bool, RefineError> {
        let mut is_split = false;
        let mut fresh = Vec::new();
        for &(place, height) in failing {
            self.watch.poll()?;
            // Triangles of a leaf may fail for both reasons.
            if !is_leaf(plan, place) {
                continue;
            }
            let mut left = allowed.map_or(0.0, |allowed| height / (4.0 * SURELY * allowed));
            fresh.push(place);
            for level in place.level.. {
                if level >= self.max_levels {
                    plan.has_failed |= level == place.level;
                    break;
                }
                is_split = true;
                for place in core::mem::take(&mut fresh) {
                    self.split(&mut plan.decision.trees, place, dirty)?;
                    fresh.extend((0..4).map(|child| place.child(child)));
                }
                if left <= 1.0 {
                    break;
                }
                left *= 0.25;
            }
            fresh.clear();
        }
        Ok(is_split)
    }

    /// Divides the leaves at a corner of a control face, and those beside them, as often as one that fails there lets expect: at irregular vertices
    /// distances fall like the edges, or more slowly, not by a quarter each time, and what fails does so again, level by level. Says whether there
    /// are any.
    fn divide_towards_corners(
        &self,
        plan: &mut Plan,
        failing: &[(Place, f64)],
        goal: &Goal,
        dirty: &mut Dirty,
    ) -> Result<bool, RefineError> {
        let mut is_split = false;
        for &(place, value) in failing {
            let Some((mut corner, child, is_beside)) = towards_corner(place) else {
                continue;
            };
            let times = value / goal.allowed(place.face);
            let mut left = if times <= MOST_TIMES {
                HALVED * times
            } else {
                0.0
            };
            while left > 1.0 && corner.level + u32::from(is_beside) < self.max_levels {
                self.watch.poll()?;
                is_split |= self.split_leaf(plan, corner, dirty)?;
                if is_beside {
                    is_split |= self.split_leaf(plan, corner.child(3), dirty)?;
                }
                corner = corner.child(child);
                left *= HALVED;
            }
        }
        Ok(is_split)
    }

    /// Splits a node if it has no children.
    fn split_leaf(
        &self,
        plan: &mut Plan,
        place: Place,
        dirty: &mut Dirty,
    ) -> Result<bool, RefineError> {
        let may_be = is_leaf(plan, place);
        if may_be {
            self.split(&mut plan.decision.trees, place, dirty)?;
        }
        Ok(may_be)
    }

    /// The finest mesh with balanced triangles within a value; `None` if that takes more triangles than there may be.
    pub(super) fn balanced(&self, limit: f64, most: usize) -> Result<Option<Outcome>, RefineError> {
        let Some(plan) = self.plan(Goal::Balanced(limit), most)? else {
            return Ok(None);
        };
        self.emit_among(plan, &Goal::Within(limit), (most, false))
    }

    /// The balanced mesh within the least value that has no more triangles than there may be; the plain one where that does
    /// no worse.
    pub(super) fn least_balanced(
        &self,
        plain: Exact,
        floor: f64,
        (most, stop): (usize, ExactStop),
        options: &ExactOptions,
    ) -> Result<Exact, RefineError> {
        let mut high = if self.control.criteria.is_some() {
            plain.worst
        } else {
            plain.error.upper
        };
        let mut low = floor;
        let mut best = None;
        for _ in 0..MOST_TRIES {
            let next = (BALANCED * high).max((low * high).sqrt());
            if !(low < next && next < high && low < NEAR * high) {
                break;
            }
            match self.balanced(next, most)? {
                Some(outcome) => (best, high) = (Some(outcome), next),
                None => low = next,
            }
        }
        let Some(outcome) = best else {
            return Ok(plain);
        };
        let balanced = outcome.finish(self, stop, options)?;
        Ok(if balanced.error.upper < plain.error.upper {
            balanced
        } else {
            plain
        })
    }

    pub(super) fn sources<'a>(&'a self, plan: &'a Plan, emission: &'a Emission) -> Sources<'a> {
        let Plan {
            decision,
            chains,
            closed,
            ..
        } = plan;
        Sources {
            control: self.control,
            edges: &self.edges,
            trees: &decision.trees,
            chains,
            closed,
            emission,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::demands::Demands;
    use super::super::judge::UNBALANCED;
    use super::super::with_engine;
    use super::*;
    use crate::models::stirred;
    use crate::progress::unobserved;
    use crate::scheme::Loop;

    /// How many triangles could not be balanced however their corners were moved, and how many there are.
    fn hopeless(name: &str, share: f64, goal: impl Fn(f64) -> Goal) -> [usize; 2] {
        let mesh = stirred(name, 0);
        let limit = share * mesh.diagonal();
        let options = ExactOptions::default().tolerance(limit).balance(true);
        with_engine(
            &mesh,
            &Loop,
            (&options, &Demands::default()),
            &mut unobserved,
            |engine| {
                let mut plan = engine.plan(goal(limit), usize::MAX)?.unwrap();
                let faces: Vec<u32> = (0..plan.closed.len() as u32).collect();
                let emission = engine.emit_all(&mut plan)?;
                let mut bulges = Bulges::default();
                bulges.look(
                    &engine.sources(&plan, &emission),
                    engine.watch,
                    &faces,
                    (limit, 30),
                )?;
                Ok([bulges.failing().len(), emission.triangles.len()])
            },
        )
        .unwrap()
    }

    #[test]
    fn what_cannot_be_balanced_is_divided_before_it_is_looked_at() {
        for (name, share) in [("cup", 1e-4), ("bunny", 1e-3), ("head", 1e-3)] {
            let [few, triangles] = hopeless(name, share, Goal::Balanced);
            let [many, fewer_triangles] =
                hopeless(name, share, |limit| Goal::Within(UNBALANCED * limit));
            assert!(6 * few < many && many > 10, "{name}: {few}, {many}");
            assert!(
                triangles > fewer_triangles,
                "{name}: {triangles}, {fewer_triangles}"
            );
        }
    }

    /// A leaf by its path below its control face.
    fn leaf(path: &[usize]) -> Place {
        path.iter()
            .fold(Place::root(0), |place, &child| place.child(child))
    }

    #[test]
    fn corners_are_told_from_what_lies_elsewhere() {
        // At a corner, the next one there is a child; beside it, a sibling.
        assert_eq!(
            towards_corner(leaf(&[2, 2])),
            Some((leaf(&[2, 2, 2]), 2, false))
        );
        assert_eq!(
            towards_corner(leaf(&[1, 1, 3])),
            Some((leaf(&[1, 1, 1]), 1, true))
        );
        for elsewhere in [
            &[] as &[usize],
            &[3],
            &[3, 3],
            &[0, 1],
            &[0, 1, 1],
            &[0, 3, 0],
            &[2, 3, 3],
        ] {
            assert_eq!(towards_corner(leaf(elsewhere)), None, "{elsewhere:?}");
        }
    }
}
