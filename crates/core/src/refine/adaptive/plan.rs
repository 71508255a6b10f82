//! What is going to be emitted: the trees that the passes have come to, and what is known of their leaves; made from the beginning, or
//! from a coarser plan.

use limitmesh_pages::filled;

use super::Engine;
use super::chains::Chains;
use super::close::Closed;
use super::decide::{Decision, decide};
use super::dirty::Dirty;
use super::emit::Emission;
use super::judge::{Condition, Goal};
use super::settle::SettledFaces;
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;

/// Trees whose closed leaves pass, and what emitting them takes.
pub(super) struct Plan {
    pub(super) goal: Goal,
    pub(super) decision: Decision,
    pub(super) chains: Chains,
    pub(super) closed: Vec<Closed>,
    pub(super) triangles: usize,
    /// Leaves fail that must not be divided.
    pub(super) has_failed: bool,
    /// The control faces whose leaves that pass on conditions do so.
    pub(super) settled: SettledFaces,
    /// Control faces whose triangles have changed since the last emission.
    pub(super) is_touched: Vec<bool>,
    /// What was emitted last, as far as it was.
    pub(super) emission: Option<Emission>,
}

impl Plan {
    /// The plan of a decision, which nobody has walked over yet.
    pub(super) fn of(goal: Goal, decision: Decision, faces: usize) -> Self {
        Self {
            goal,
            decision,
            chains: Chains::default(),
            closed: filled(Closed::default(), faces),
            triangles: 0,
            has_failed: false,
            settled: SettledFaces::none(faces),
            is_touched: vec![true; faces],
            emission: None,
        }
    }

    /// The same, for another goal, with nothing emitted.
    pub(super) fn with_goal(&self, goal: Goal) -> Self {
        Self {
            goal,
            decision: self.decision.clone(),
            chains: self.chains.clone(),
            closed: self.closed.clone(),
            triangles: self.triangles,
            has_failed: self.has_failed,
            settled: self.settled.clone(),
            is_touched: vec![true; self.closed.len()],
            emission: None,
        }
    }

    /// The greatest bound of a face's triangles.
    pub(super) fn bound(&self, face: u32) -> f64 {
        let closing = self.closed[face as usize]
            .extent()
            .map_or(0.0, |extent| extent.bound);
        let settled = self.settled.bound(face);
        closing.max(settled).max(self.decision.bound(face))
    }

    /// The same, with what leaves that pass on conditions nobody has looked at come to beside triangles like themselves: a bound that was good
    /// enough for a goal need not be as good as it gets, so these are judged anew for one that asks for less.
    pub(super) fn expected(&self, face: u32) -> f64 {
        let bound = self.bound(face);
        if self.settled.has(face) {
            return bound;
        }
        let conditions = [
            self.decision.conditions(face),
            self.closed[face as usize].conditions(),
        ];
        conditions
            .into_iter()
            .flatten()
            .map(Condition::expected)
            .fold(bound, f64::max)
    }

    /// The faces whose leaves have the greatest bounds first.
    pub(super) fn faces_by_bound(&self) -> Vec<(f64, u32)> {
        let mut order: Vec<(f64, u32)> = (0..self.closed.len() as u32)
            .map(|face| (self.bound(face), face))
            .collect();
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order
    }

    /// The greatest bound of all triangles.
    pub(super) fn worst(&self) -> f64 {
        (0..self.closed.len() as u32)
            .map(|face| self.bound(face))
            .fold(0.0, f64::max)
    }

    /// Levels of the deepest tree.
    pub(super) fn levels(&self, watch: &SharedWatch<'_>) -> Result<usize, Cancelled> {
        let (trees, faces) = (&self.decision.trees, self.closed.len());
        let levels = watch.pieces(faces, parallel::share(faces), |block| {
            block
                .map(|face| trees.depth(trees.root(face as u32)) as usize)
                .max()
        });
        Ok(levels?.into_iter().flatten().max().unwrap_or(0))
    }
}

impl Engine<'_> {
    /// Divides as asked, until all conditions hold; `None` if that takes more than `most` triangles.
    pub(super) fn plan(&self, goal: Goal, most: usize) -> Result<Option<Plan>, RefineError> {
        let Some(mut plan) = self.divided(goal, most)? else {
            return Ok(None);
        };
        let fits = self.is_settled_later() || self.settle(&mut plan, most)?;
        Ok(fits.then_some(plan))
    }

    /// Divides as asked. Nothing is looked at among its neighbours yet ([`Self::settle`]).
    pub(super) fn divided(&self, goal: Goal, most: usize) -> Result<Option<Plan>, RefineError> {
        let control = (self.control, self.watch);
        let Some(decision) = decide(control, &goal, &self.edges, self.max_levels, most)? else {
            return Ok(None);
        };
        let faces = self.control.mesh.face_count();
        // What closes gaps is looked at with all the rest once vertices are moved, where nothing counts but distances.
        let is_asked = !self.is_balanced || self.control.criteria.is_some();
        let mut plan = Plan::of(if is_asked { goal } else { Goal::Nothing }, decision, faces);
        Ok(self
            .carry_out(&mut plan, Dirty::all(faces), most)?
            .then_some(plan))
    }

    /// The same for another goal, of distances alone, which asks more of these faces only: they are divided anew, and what that
    /// changes. Nothing is looked at among its neighbours yet ([`Self::settle`]). `None` if that takes too many triangles.
    pub(super) fn finer(
        &self,
        plan: &Plan,
        goal: Goal,
        wanting: &[u32],
        most: usize,
    ) -> Result<Option<Plan>, RefineError> {
        let mut finer = plan.with_goal(goal);
        let (control, limits) = ((self.control, self.watch), (self.max_levels, most));
        let again = (wanting, Some(&plan.goal));
        if !finer
            .decision
            .divide(control, &finer.goal, &self.edges, limits, again)?
        {
            return Ok(None);
        }
        finer.decision.begin_again();
        let mut dirty = Dirty::none(plan.closed.len());
        for &face in wanting {
            let closed = &mut finer.closed[face as usize];
            match finer.goal.is_near(&plan.goal, face) {
                true => closed.forget_beyond(finer.goal.allowed(face)),
                false => closed.forget(),
            }
        }
        wanting
            .iter()
            .for_each(|&face| dirty.replace(&self.edges, face));
        Ok(self.carry_out(&mut finer, dirty, most)?.then_some(finer))
    }
}
