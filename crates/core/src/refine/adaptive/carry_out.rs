//! Carries a plan out: neighbouring leaves at most one level apart, closed where these differ, divided where what closes them fails, and
//! all again for the control faces that see a division, until everything holds.

use super::balance::{Pending, balance};
use super::chains::{Chains, first_of};
use super::close::close;
use super::quadtree::{Place, Trees};
use super::{BLOCK, Engine, Plan, block};
use crate::refine::RefineError;

impl Engine<'_> {
    /// Restricts and closes until everything holds, beginning with the marked faces; `false` if there are too many triangles.
    pub(super) fn carry_out(
        &self,
        plan: &mut Plan,
        mut is_dirty: Vec<bool>,
        most: usize,
    ) -> Result<bool, RefineError> {
        loop {
            self.restrict(&mut plan.decision.trees, &mut is_dirty)?;
            if !self.close(plan, marked(&is_dirty), most)? {
                return Ok(false);
            }
            let closed = &plan.closed;
            let closing = |face: u32| closed[face as usize].extent();
            let limits = (self.max_levels, most);
            let control = (self.control, self.watch);
            let again = plan.decision.settle(control, &plan.goal, &self.edges, limits, closing)?;
            let Some(again) = again else { return Ok(false) };
            if again.is_empty() {
                plan.has_failed |= plan.decision.has_failed();
                return Ok(true);
            }
            is_dirty.fill(false);
            again.iter().for_each(|&face| plan.closed[face as usize].forget());
            again.iter().for_each(|&face| self.mark_replaced(face, &mut is_dirty));
        }
    }

    pub(super) fn split(
        &self,
        trees: &mut Trees,
        place: Place,
        fresh: impl FnMut(Place),
    ) -> Result<(), RefineError> {
        trees.split(place, fresh).then_some(()).ok_or_else(|| trees.too_many(4).into())
    }

    /// Neighbouring leaves are at most one level apart; marks what changes. Only marked faces may have more leaves than before.
    fn restrict(&self, trees: &mut Trees, is_dirty: &mut [bool]) -> Result<(), RefineError> {
        let (faces, edges) = (marked(is_dirty), &self.edges);
        let lists = self.watch.pieces(faces.len(), block(faces.len()), |block| {
            let mut pending = Pending::default();
            faces[block].iter().for_each(|&face| pending.push_tree(trees, edges, face));
            pending
        })?;
        let mut all = Pending::default();
        self.watch.each(lists, |list| all.append(list))?;
        self.balance(trees, all, |place| self.mark_split(place, is_dirty))
    }

    fn balance(
        &self,
        trees: &mut Trees,
        pending: Pending,
        split: impl FnMut(Place),
    ) -> Result<(), RefineError> {
        let fits = balance(trees, &self.edges, pending, &mut || self.watch.poll(), split)?;
        fits.then_some(()).ok_or_else(|| trees.too_many(4).into())
    }

    /// Walks over the given faces, splitting what fails, until nothing does; `false` if there are too many triangles.
    fn close(&self, plan: &mut Plan, mut dirty: Vec<u32>, most: usize) -> Result<bool, RefineError> {
        let Self { control, ref edges, max_levels, .. } = *self;
        let mesh = control.mesh;
        loop {
            let known = (&plan.chains, &dirty[..]);
            let chains = Chains::of(mesh, edges, &plan.decision.trees, known, self.watch)?;
            let decision = &plan.decision;
            // Most faces are walked over once.
            let is_kept = plan.is_kept || dirty.len() < plan.closed.len();
            let found = self.watch.long_pieces(dirty.len(), BLOCK, |block, is_stopped| {
                let mut knots = Vec::new();
                let walks = dirty[block].iter().map(|&face| {
                    let allowance = decision.allowance(face);
                    let trees = (&decision.trees, &chains);
                    let known = &plan.closed[face as usize];
                    close(
                        control,
                        (&plan.goal, max_levels),
                        edges,
                        trees,
                        (allowance, known, is_kept),
                        (face, is_stopped),
                        &mut knots,
                    )
                });
                walks.collect::<Vec<_>>()
            })?;
            self.watch.each(dirty.iter().zip(found.into_iter().flatten()), |(&face, found)| {
                let known = core::mem::replace(&mut plan.closed[face as usize], found);
                let found = &plan.closed[face as usize];
                let is_same = known.is_as(found)
                    && (3 * face..3 * face + 3).all(|h| {
                        let owner = first_of(edges, h);
                        chains.own(owner).1 == plan.chains.own(owner).1
                    });
                if is_same {
                    return;
                }
                plan.is_touched[face as usize] = true;
                // Conditions count on the triangles beside.
                plan.settled[face as usize] = None;
                for twin in (3 * face..3 * face + 3).filter_map(|h| edges.twin(h)) {
                    plan.settled[twin as usize / 3] = None;
                }
            })?;
            plan.chains = chains;
            plan.triangles = self.triangles(plan)?;
            self.watch.round(plan.triangles)?;
            if plan.triangles > most {
                return Ok(false);
            }
            let mut pending = Pending::default();
            let mut is_dirty = vec![false; mesh.face_count()];
            let mut is_split = false;
            for &face in &dirty {
                for place in plan.closed[face as usize].take_failing() {
                    if place.level >= self.max_levels {
                        plan.has_failed = true;
                        continue;
                    }
                    is_split = true;
                    self.watch.poll()?;
                    self.split(&mut plan.decision.trees, place, |place| {
                        self.mark_split(place, &mut is_dirty);
                        pending.push(place);
                    })?;
                }
            }
            if !is_split {
                return Ok(true);
            }
            self.balance(&mut plan.decision.trees, pending, |place| self.mark_split(place, &mut is_dirty))?;
            dirty = marked(&is_dirty);
        }
    }

    /// Marks a control face whose tree was replaced, and all beyond its edges.
    pub(super) fn mark_replaced(&self, face: u32, is_dirty: &mut [bool]) {
        is_dirty[face as usize] = true;
        (3 * face..3 * face + 3).for_each(|h| self.mark_beyond(h, is_dirty));
    }

    /// Marks the control face of a node that was split, and those that see it: it stands on their edges.
    pub(super) fn mark_split(&self, place: Place, is_dirty: &mut [bool]) {
        is_dirty[place.face as usize] = true;
        let edges = (0..3).filter(|&edge| place.lies_along(edge));
        edges.for_each(|edge| self.mark_beyond(3 * place.face + edge as u32, is_dirty));
    }

    /// Marks the control faces beyond a half-edge.
    fn mark_beyond(&self, h: u32, is_dirty: &mut [bool]) {
        if let Some(twin) = self.edges.twin(h) {
            is_dirty[twin as usize / 3] = true;
        } else if let Some(group) = self.edges.group(h) {
            self.edges.members(group).iter().for_each(|&(h, _)| is_dirty[h as usize / 3] = true);
        }
    }
}

pub(super) fn marked(is_marked: &[bool]) -> Vec<u32> {
    (0..).zip(is_marked).filter(|&(_, &is_marked)| is_marked).map(|(face, _)| face).collect()
}
