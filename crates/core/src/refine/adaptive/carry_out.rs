//! Carries a plan out: neighbouring leaves at most one level apart, closed where these differ, divided where what closes them fails, and
//! all again for the control faces that see a division, until everything holds.

use std::collections::BTreeMap;

use super::balance::{Pending, balance};
use super::chains::{Chains, first_of};
use super::close::{Closed, Closing, Counts, Unfinished};
use super::dirty::Dirty;
use super::quadtree::{Place, Trees};
use super::{CountsStrips, Engine, Plan};
use crate::parallel;
use crate::refine::RefineError;

/// Control faces that were closed again, of which nothing is put together yet.
type Again = BTreeMap<u32, Box<Unfinished>>;

/// What came of closing a face once.
enum Found {
    Whole(Closed),
    Again(Counts, Box<Unfinished>),
}

impl Engine<'_> {
    /// Restricts and closes until everything holds, beginning with what is dirty; `false` if there are too many triangles.
    pub(super) fn carry_out(
        &self,
        plan: &mut Plan,
        mut dirty: Dirty,
        most: usize,
    ) -> Result<bool, RefineError> {
        loop {
            self.restrict(&mut plan.decision.trees, &mut dirty)?;
            if !self.close(plan, dirty, most)? {
                return Ok(false);
            }
            let closed = &plan.closed;
            let closing = |face: u32| closed[face as usize].extent();
            let limits = (self.max_levels, most);
            let control = (self.control, self.watch);
            let again = plan
                .decision
                .settle(control, &plan.goal, &self.edges, limits, closing)?;
            let Some(again) = again else { return Ok(false) };
            if again.is_empty() {
                plan.has_failed |= plan.decision.has_failed();
                return Ok(true);
            }
            dirty = Dirty::none(plan.closed.len());
            again
                .iter()
                .for_each(|&face| plan.closed[face as usize].forget());
            again
                .iter()
                .for_each(|&face| dirty.replace(&self.edges, face));
        }
    }

    /// Splits a leaf; told to what is dirty.
    pub(super) fn split(
        &self,
        trees: &mut Trees,
        place: Place,
        dirty: &mut Dirty,
    ) -> Result<(), RefineError> {
        let fits = trees.split(place, |place| dirty.add(&self.edges, place));
        fits.then_some(()).ok_or_else(|| trees.too_many(4).into())
    }

    /// Neighbouring leaves are at most one level apart; adds what is split for that. Only what is dirty may have more leaves than before.
    fn restrict(&self, trees: &mut Trees, dirty: &mut Dirty) -> Result<(), RefineError> {
        let (faces, edges) = (dirty.replaced(), &self.edges);
        let lists = self
            .watch
            .pieces(faces.len(), parallel::share(faces.len()), |block| {
                let mut pending = Pending::default();
                faces[block]
                    .iter()
                    .for_each(|&face| pending.push_tree(trees, edges, face));
                pending
            })?;
        let mut all = Pending::default();
        self.watch.each(lists, |list| all.append(list))?;
        self.watch.each(dirty.split(), |&place| all.push(place))?;
        let fits = balance(trees, edges, all, &mut || self.watch.poll(), |place| {
            dirty.add(edges, place)
        })?;
        fits.then_some(()).ok_or_else(|| trees.too_many(4).into())
    }

    /// Closes what is dirty, splitting what fails, until nothing does; `false` if there are too many triangles.
    fn close(&self, plan: &mut Plan, mut dirty: Dirty, most: usize) -> Result<bool, RefineError> {
        let mut again = Again::new();
        loop {
            let failing = self.close_once(plan, &dirty, &mut again)?;
            plan.triangles = self.triangles_at_most(plan);
            self.watch.round(plan.triangles)?;
            if plan.triangles > most {
                if self.counts_strips == CountsStrips::Never || !self.control.flat.has_strips() {
                    return Ok(false);
                }
                // What strips leave takes an emission.
                self.finish(plan, core::mem::take(&mut again))?;
                plan.triangles = self.triangles(plan)?;
                if plan.triangles > most {
                    return Ok(false);
                }
            }
            let mut next = Dirty::none(plan.closed.len());
            for place in failing {
                if place.level >= self.max_levels {
                    plan.has_failed = true;
                    continue;
                }
                self.watch.poll()?;
                self.split(&mut plan.decision.trees, place, &mut next)?;
            }
            if next.split().is_empty() {
                self.finish(plan, again)?;
                if self.counts_strips == CountsStrips::Always {
                    plan.triangles = self.triangles(plan)?;
                }
                return Ok(true);
            }
            dirty = next;
            self.restrict(&mut plan.decision.trees, &mut dirty)?;
        }
    }

    /// Closes the faces that are dirty; gives leaves that fail, in the order of faces. What is `again` closed is not put together yet.
    fn close_once(
        &self,
        plan: &mut Plan,
        dirty: &Dirty,
        again: &mut Again,
    ) -> Result<Vec<Place>, RefineError> {
        let Self {
            control,
            ref edges,
            max_levels,
            ..
        } = *self;
        let faces = dirty.faces();
        let Plan {
            goal,
            decision,
            closed,
            ..
        } = &*plan;
        let inserted = dirty.inserted(edges);
        let known = (&plan.chains, &inserted);
        let chains = match inserted.is_empty() {
            true => None,
            false => Some(Chains::of(
                control.mesh,
                edges,
                &decision.trees,
                known,
                self.watch,
            )?),
        };
        let new_chains = chains.as_ref().unwrap_or(&plan.chains);
        let closing = Closing {
            control,
            goal,
            max_levels,
            edges,
            trees: &decision.trees,
            chains: new_chains,
        };
        let seen = dirty.leaves(&decision.trees, edges, self.watch)?;
        let mut split = dirty.split().to_vec();
        split.sort_unstable_by(Place::in_order);
        let of_block = |block: &[u32]| {
            block
                .iter()
                .map(|&face| (face, again.remove(&face)))
                .collect::<Vec<_>>()
        };
        let blocks: Vec<_> = faces
            .chunks(parallel::share(faces.len()))
            .map(of_block)
            .collect();
        let poll = &mut |_| self.watch.poll();
        let found = parallel::each_long_polled(blocks, poll, |block, is_stopped| {
            let mut knots = Vec::new();
            let closed = block.into_iter().map(|(face, unfinished)| {
                let closed = &closed[face as usize];
                let known = (decision.allowance(face), closed);
                if dirty.is_replaced(face) {
                    let (found, failing) = closing.close(face, known, is_stopped, &mut knots);
                    return (Found::Whole(found), failing);
                }
                let mut unfinished = unfinished.unwrap_or_else(|| Box::new(Unfinished::of(closed)));
                let places = (of_face(&split, face), of_face(&seen, face));
                let (counts, failing) =
                    closing.close_again(face, known, places, &mut unfinished, is_stopped);
                (Found::Again(counts, unfinished), failing)
            });
            closed.collect::<Vec<_>>()
        })?;
        let mut all_failing = Vec::new();
        self.watch.each(
            faces.iter().zip(found.into_iter().flatten()),
            |(&face, (found, failing))| {
                all_failing.extend(failing);
                let own = &mut plan.closed[face as usize];
                let is_same = match found {
                    Found::Whole(found) => {
                        let is_same = own.is_as(&found);
                        *own = found;
                        is_same
                    }
                    // Whether what is judged is the same is looked at in the end.
                    Found::Again(counts, unfinished) => {
                        own.count(counts);
                        again.insert(face, unfinished);
                        of_face(&split, face).is_empty()
                    }
                };
                let has_other_chain = |h: u32| {
                    let owner = first_of(edges, h);
                    chains
                        .as_ref()
                        .is_some_and(|chains| chains.own(owner).1 != plan.chains.own(owner).1)
                };
                if !is_same || (3 * face..3 * face + 3).any(has_other_chain) {
                    self.touch(plan, face);
                }
            },
        )?;
        plan.chains = chains.unwrap_or_else(|| core::mem::take(&mut plan.chains));
        Ok(all_failing)
    }

    /// Puts together what faces that were closed again came to.
    fn finish(&self, plan: &mut Plan, again: Again) -> Result<(), RefineError> {
        let faces: Vec<u32> = again.keys().copied().collect();
        let take = |(face, unfinished): (u32, Box<Unfinished>)| {
            (core::mem::take(&mut plan.closed[face as usize]), unfinished)
        };
        let mut all = again.into_iter().map(take);
        let next_block = || {
            Some(
                all.by_ref()
                    .take(parallel::share(faces.len()))
                    .collect::<Vec<_>>(),
            )
        };
        let blocks = core::iter::from_fn(next_block)
            .take_while(|block| !block.is_empty())
            .collect();
        let max_levels = self.max_levels;
        let trees = &plan.decision.trees;
        let poll = &mut |_| self.watch.poll();
        let found = parallel::each_long_polled(blocks, poll, |block, _| {
            let finish = |(known, unfinished): (Closed, Box<Unfinished>)| {
                unfinished.finish(known, trees, max_levels)
            };
            block.into_iter().map(finish).collect::<Vec<_>>()
        })?;
        self.watch.each(
            faces.iter().zip(found.into_iter().flatten()),
            |(&face, (found, is_same))| {
                plan.closed[face as usize] = found;
                if !is_same {
                    self.touch(plan, face);
                }
            },
        )?;
        Ok(())
    }

    /// Marks a face that came to something else than before.
    fn touch(&self, plan: &mut Plan, face: u32) {
        plan.is_touched[face as usize] = true;
        // Conditions count on the triangles beside.
        plan.settled.forget(face);
        for twin in (3 * face..3 * face + 3).filter_map(|h| self.edges.twin(h)) {
            plan.settled.forget(twin / 3);
        }
    }
}

/// Those of some places, in the order of faces, that are in one.
fn of_face(places: &[Place], face: u32) -> &[Place] {
    let start = places.partition_point(|place| place.face < face);
    let end = places.partition_point(|place| place.face <= face);
    &places[start..end]
}

pub(super) fn marked(is_marked: &[bool]) -> Vec<u32> {
    (0..)
        .zip(is_marked)
        .filter(|&(_, &is_marked)| is_marked)
        .map(|(face, _)| face)
        .collect()
}
