//! Carries a plan out: neighbouring leaves at most one level apart, closed where these differ, divided where what closes them fails, and
//! all again for the control faces that see a division, until everything holds.

use std::collections::HashMap;

use super::balance::{Pending, balance};
use super::chains::{Chains, first_of};
use super::close::Closing;
use super::dirty::Dirty;
use super::quadtree::{Place, Trees};
use super::surface::SurfacePiece;
use super::{BLOCK, Engine, Plan, block};
use crate::parallel;
use crate::refine::RefineError;

/// The surface over control faces that were closed again, by face.
type Pieces = HashMap<u32, Box<SurfacePiece>>;

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
            let again = plan.decision.settle(control, &plan.goal, &self.edges, limits, closing)?;
            let Some(again) = again else { return Ok(false) };
            if again.is_empty() {
                plan.has_failed |= plan.decision.has_failed();
                return Ok(true);
            }
            dirty = Dirty::none(plan.closed.len());
            again.iter().for_each(|&face| plan.closed[face as usize].forget());
            again.iter().for_each(|&face| dirty.replace(&self.edges, face));
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
        let lists = self.watch.pieces(faces.len(), block(faces.len()), |block| {
            let mut pending = Pending::default();
            faces[block].iter().for_each(|&face| pending.push_tree(trees, edges, face));
            pending
        })?;
        let mut all = Pending::default();
        self.watch.each(lists, |list| all.append(list))?;
        self.watch.each(dirty.split(), |&place| all.push(place))?;
        let fits = balance(trees, edges, all, &mut || self.watch.poll(), |place| dirty.add(edges, place))?;
        fits.then_some(()).ok_or_else(|| trees.too_many(4).into())
    }

    /// Closes what is dirty, splitting what fails, until nothing does; `false` if there are too many triangles.
    fn close(&self, plan: &mut Plan, mut dirty: Dirty, most: usize) -> Result<bool, RefineError> {
        let mut pieces = Pieces::new();
        loop {
            self.close_once(plan, &dirty, &mut pieces)?;
            plan.triangles = self.triangles_at_most(plan);
            self.watch.round(plan.triangles)?;
            // What strips leave takes an emission.
            if plan.triangles > most {
                plan.triangles = self.triangles(plan)?;
                if plan.triangles > most {
                    return Ok(false);
                }
            }
            let mut next = Dirty::none(plan.closed.len());
            for face in dirty.faces() {
                for place in plan.closed[face as usize].take_failing() {
                    if place.level >= self.max_levels {
                        plan.has_failed = true;
                        continue;
                    }
                    self.watch.poll()?;
                    self.split(&mut plan.decision.trees, place, &mut next)?;
                }
            }
            if next.split().is_empty() {
                if self.counts_strips {
                    plan.triangles = self.triangles(plan)?;
                }
                return Ok(true);
            }
            dirty = next;
            self.restrict(&mut plan.decision.trees, &mut dirty)?;
        }
    }

    /// Closes the faces that are dirty, over pieces of the surface that are kept where it is not for the first time.
    fn close_once(&self, plan: &mut Plan, dirty: &Dirty, pieces: &mut Pieces) -> Result<(), RefineError> {
        let Self { control, ref edges, max_levels, .. } = *self;
        let faces = dirty.faces();
        let Plan { goal, decision, closed, .. } = &*plan;
        let known = (&plan.chains, &faces[..]);
        let chains = Chains::of(control.mesh, edges, &decision.trees, known, self.watch)?;
        let closing = Closing { control, goal, max_levels, edges, trees: &decision.trees, chains: &chains };
        let seen = dirty.leaves(&decision.trees, edges, self.watch)?;
        let mut split = dirty.split().to_vec();
        split.sort_unstable_by(Place::in_order);
        let of_block =
            |block: &[u32]| block.iter().map(|&face| (face, pieces.remove(&face))).collect::<Vec<_>>();
        let blocks: Vec<_> = faces.chunks(BLOCK).map(of_block).collect();
        let poll = &mut |_| self.watch.poll();
        let found = parallel::each_long_polled(blocks, poll, |block, is_stopped| {
            let mut knots = Vec::new();
            let closed = block.into_iter().map(|(face, mut piece)| {
                let known = (decision.allowance(face), &closed[face as usize]);
                if dirty.is_replaced(face) {
                    return (closing.close(face, known, is_stopped, &mut knots), None);
                }
                let places = (of_face(&split, face), of_face(&seen, face));
                (closing.close_again(face, known, places, &mut piece, is_stopped), piece)
            });
            closed.collect::<Vec<_>>()
        })?;
        self.watch.each(faces.iter().zip(found.into_iter().flatten()), |(&face, (found, piece))| {
            piece.into_iter().for_each(|piece| {
                pieces.insert(face, piece);
            });
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
            plan.settled.forget(face);
            for twin in (3 * face..3 * face + 3).filter_map(|h| edges.twin(h)) {
                plan.settled.forget(twin / 3);
            }
        })?;
        plan.chains = chains;
        Ok(())
    }
}

/// Those of some places, in the order of faces, that are in one.
fn of_face(places: &[Place], face: u32) -> &[Place] {
    let start = places.partition_point(|place| place.face < face);
    let end = places.partition_point(|place| place.face <= face);
    &places[start..end]
}

pub(super) fn marked(is_marked: &[bool]) -> Vec<u32> {
    (0..).zip(is_marked).filter(|&(_, &is_marked)| is_marked).map(|(face, _)| face).collect()
}
