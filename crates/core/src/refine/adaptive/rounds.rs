//! The one loop of exact refinement: balance, cover, emit, verify, and split what fails, until nothing does.
//!
//! Takes a state that guesses have divided; gives it with a mesh all of whose triangles are within the goal, among their neighbours as they are.

use super::balance::{Pending, balance};
use super::chains::{Chains, first_of};
use super::changes::Changes;
use super::control::Control;
use super::cover::{Covered, Covering};
use super::dirty::{Dirty, marked};
use super::emit::{Emission, Emitter};
use super::flat::Net;
use super::judge::Goal;
use super::measure::{Look, measure};
use super::measured::Failing;
use super::neighbours::sharp_edges;
use super::quadtree::{NodeAddress, is_leaf};
use super::seen::Allowance;
use super::state::State;
use super::touched::{Fresh, Touched};
use super::{Engine, sides};
use crate::index::VertexId;
use crate::math;
use crate::parallel;
use crate::progress::{Cancelled, Stage};
use crate::refine::RefineError;
use crate::refine::junctions::join_copies;

/// A state whose triangles were all verified as they were emitted.
pub(super) struct Verified {
    pub(super) state: State,
    pub(super) emission: Emission,
}

/// Levels that a leaf which fails is split by beyond the first at most: bounds of coarse leaves may be far above their distances.
const MOST_AT_ONCE: u32 = 3;

impl Engine<'_> {
    /// Divides until all triangles are within a goal; `None` if there are more than `most`.
    pub(super) fn refined(&self, goal: Goal, most: usize) -> Result<Option<Verified>, RefineError> {
        match self.divided(goal, most)? {
            Some(state) => self.verified(state, most),
            None => Ok(None),
        }
    }

    /// Divides as guesses have it, nothing of which is verified; `None` if there are more than `most`.
    pub(super) fn guessed(&self, goal: Goal, most: usize) -> Result<Option<State>, RefineError> {
        let Some(mut state) = self.divided(goal, most)? else {
            return Ok(None);
        };
        let faces = state.covers.len();
        self.cover(&mut state, &mut Dirty::all(faces), most)?;
        Ok(Some(state))
    }

    /// Splits leaves of a divided state until all triangles are within its goal; `None` if there are more than `most`.
    pub(super) fn verified(
        &self,
        mut state: State,
        most: usize,
    ) -> Result<Option<Verified>, RefineError> {
        let faces = state.covers.len();
        let (mut dirty, mut last) = (Dirty::all(faces), None);
        loop {
            self.cover(&mut state, &mut dirty, most)?;
            self.watch.round(state.triangles)?;
            let has_strips = self.control.flat.has_strips();
            if state.triangles > most && !has_strips {
                return Ok(None);
            }
            let fresh = core::mem::replace(&mut state.fresh, vec![Fresh::None; faces]);
            let is_changed: Vec<bool> = fresh.iter().map(Fresh::is_any).collect();
            let mut emission = self.emit(&state, &is_changed, last)?;
            if state.triangles > most && state.triangles - self.saved(&emission)? > most {
                return Ok(None);
            }
            let failing = self.verify(&mut state, &mut emission, &fresh)?;
            dirty = Dirty::none(faces);
            let mut is_split = self.split_failing(&mut state, &failing, &mut dirty)?;
            // Triangles that fail may be why others keep less than is assumed of them; they are divided first.
            if !is_split && self.trusts() {
                let failing = self.distrust(&mut state, &emission)?;
                is_split = self.split_failing(&mut state, &failing, &mut dirty)?;
            }
            if !is_split {
                if has_strips {
                    state.triangles -= self.saved(&emission)?;
                }
                return Ok(Some(Verified { state, emission }));
            }
            last = Some(emission);
        }
    }

    /// Balances the trees and covers what is dirty.
    fn cover(&self, state: &mut State, dirty: &mut Dirty, most: usize) -> Result<(), RefineError> {
        let Self { control, watch, .. } = *self;
        self.balance(state, dirty)?;
        self.split_closing(state, dirty, most)?;
        let edges = &control.edges;
        let chains = match dirty.is_all {
            true => Chains::of(control.mesh, edges, &state.trees, watch)?,
            false => state
                .chains
                .with_inserted(control.mesh, &dirty.inserted(edges), watch)?,
        };
        let (faces, trees) = (dirty.faces(), &state.trees);
        let touched =
            (!dirty.is_all && !self.is_balanced).then(|| Touched::by(dirty, trees, edges));
        let covering = Covering {
            control,
            trees,
            chains: &chains,
            has_fixed_diagonals: state.has_fixed_diagonals,
            touched: touched.as_ref(),
        };
        let covers = watch.long_shares(faces.len(), |block, is_stopped| {
            let mut edge_vertices = Vec::new();
            let covers = faces[block]
                .iter()
                .map(|&face| covering.cover(face, &mut edge_vertices, is_stopped));
            covers.collect::<Vec<Covered>>()
        })?;
        let has_other_chain =
            |h: u32| chains.own(first_of(edges, h)).1 != state.chains.own(first_of(edges, h)).1;
        let mut is_split = vec![false; state.covers.len()];
        let asking = dirty.asking().iter().map(|(place, _)| place);
        for place in dirty.split().iter().chain(asking) {
            is_split[place.face as usize] = true;
        }
        watch.each(
            faces.iter().zip(covers.into_iter().flatten()),
            |(&face, covered)| {
                let Covered { cover, fresh } = covered;
                let (own, known) = (
                    &mut state.covers[face as usize],
                    &mut state.fresh[face as usize],
                );
                let has_other_side = || (3 * face..3 * face + 3).any(has_other_chain);
                if known.is_any() {
                    // Numbers of triangles may be others since.
                    *known = Fresh::All;
                } else if is_split[face as usize] || *own != cover || has_other_side() {
                    *known = fresh;
                }
                *own = cover;
            },
        )?;
        state.chains = chains;
        let own = |face: u32| state.covers[face as usize].triangles as usize;
        state.triangles = control.flat.count(control, &state.chains, own);
        Ok(())
    }

    /// Splits what must be for adjacent leaves to be at most one level apart; adds that to what is dirty.
    fn balance(&self, state: &mut State, dirty: &mut Dirty) -> Result<(), RefineError> {
        let (edges, trees) = (&self.control.edges, &mut state.trees);
        let mut all = Pending::default();
        if dirty.is_all {
            let faces = state.covers.len();
            let lists = self.watch.pieces(faces, parallel::share(faces), |block| {
                let mut pending = Pending::default();
                block.for_each(|face| pending.push_tree(trees, edges, face as u32));
                pending
            })?;
            self.watch.each(lists, |list| all.append(list))?;
        }
        self.watch.each(dirty.split(), |&place| all.push(place))?;
        self.watch.each(dirty.asking(), |&(place, edge)| {
            all.push_beyond(place, 1 << edge)
        })?;
        let fits = balance(trees, edges, all, &mut || self.watch.poll(), |place| {
            dirty.add(edges, place)
        })?;
        fits.then_some(()).ok_or_else(|| trees.too_many(4).into())
    }

    /// Emits a state into the arrays of what was emitted before.
    fn emit(
        &self,
        state: &State,
        is_changed: &[bool],
        before: Option<Emission>,
    ) -> Result<Emission, RefineError> {
        self.watch.stage(Stage::Assembling, None)?;
        let emitter = Emitter {
            control: self.control,
            trees: &state.trees,
            chains: &state.chains,
            covers: &state.covers,
            is_changed,
            has_origins: self.has_origins,
            is_balanced: self.is_balanced,
        };
        let mut emission = emitter.emit(before, self.watch)?;
        let junctions = sides::junctions(self.control, self.watch, &state.chains, &emission)?;
        join_copies(&mut emission.positions, &junctions.vertices);
        emission.junctions = junctions;
        Ok(emission)
    }

    /// Emits all of a state.
    pub(super) fn emit_all(&self, state: &State) -> Result<Emission, RefineError> {
        self.emit(state, &vec![true; state.covers.len()], None)
    }

    /// How many triangles fewer there are once strips are put together.
    fn saved(&self, emission: &Emission) -> Result<usize, Cancelled> {
        let sharp = sharp_edges(emission, self.watch)?;
        let Emission {
            positions,
            triangles,
            twins,
            parents,
            starts,
            ..
        } = emission;
        let (corners, kept) = (self.control.mesh.vertex_count(), self.control.kept);
        let net = Net {
            positions,
            triangles,
            twins,
            parents,
            starts,
            sharp: &sharp,
            kept,
            corners,
        };
        self.control.flat.saved(&net, self.watch)
    }

    /// Looks at all triangles that may have changed among their neighbours; gives the leaves with some that fail. Where that is asked for,
    /// vertices are moved off the surface before.
    fn verify(
        &self,
        state: &mut State,
        emission: &mut Emission,
        fresh: &[Fresh],
    ) -> Result<Vec<Failing>, RefineError> {
        let Self { control, watch, .. } = *self;
        // Heights that are good enough, where it is known.
        let allowed = if control.criteria.is_none() {
            state.goal.allowed(0)
        } else {
            0.0
        };
        let is_alone = self.is_balanced && allowed > 0.0;
        let mut bulges = core::mem::take(&mut state.bulges);
        if self.is_balanced {
            let sources = self.sources(state, emission);
            let is_changed: Vec<bool> = fresh.iter().map(Fresh::is_any).collect();
            bulges.look(
                &sources,
                watch,
                &marked(&is_changed),
                allowed,
                self.max_levels,
            )?;
            let (offsets, faces) = bulges.offsets(control, emission, allowed, watch)?;
            emission.shift(offsets, &faces, watch)?;
        }
        watch.stage(Stage::Bounding, None)?;
        let known = self.is_balanced.then_some(&bulges);
        // Of triangles of which nothing but distances is asked it is known what was found of them.
        let changes = Changes::since(known, is_alone, fresh, emission, watch)?;
        let faces = changes.faces(emission, &control.edges, watch)?;
        let trusted = if self.trusts() {
            &state.is_trusted[..]
        } else {
            &[]
        };
        let look = Look {
            goal: &state.goal,
            divided_above: self.max_levels,
            length: f64::INFINITY,
            changes: Some(&changes),
            bulges: known,
            trusted,
        };
        let found = measure(&self.sources(state, emission), watch, &faces, &look)?;
        watch.each(faces.iter().zip(found), |(&face, mut found)| {
            let is_all = bulges.keep(face, &mut found, emission) || changes.are_all(face);
            state.measured[face as usize].replace(found, is_all);
        })?;
        // Leaves that cannot be balanced were not measured.
        let mut failing = if is_alone {
            bulges.failing()
        } else {
            Vec::new()
        };
        state.bulges = bulges;
        state.take_failing(&mut failing, watch)?;
        Ok(failing)
    }

    /// Whether the bounds of proven leaves count: where vertices stay on the surface and nothing counts but distances.
    pub(super) fn trusts(&self) -> bool {
        !self.is_balanced && self.control.criteria.is_none()
    }

    /// Measures the proven leaves of control faces that assume more of the triangles around them than these keep; gives those that fail.
    fn distrust(
        &self,
        state: &mut State,
        emission: &Emission,
    ) -> Result<Vec<Failing>, RefineError> {
        let faces = state.covers.len();
        let (control, shared) = (self.control, &*state);
        let found = self.watch.pieces(faces, parallel::share(faces), |block| {
            let is_lost =
                |&face: &u32| shared.is_trusted[face as usize] && !is_kept(control, shared, face);
            block
                .map(|face| face as u32)
                .filter(is_lost)
                .collect::<Vec<u32>>()
        })?;
        let faces = found.concat();
        let mut failing = Vec::new();
        if faces.is_empty() {
            return Ok(failing);
        }
        faces
            .iter()
            .for_each(|&face| state.is_trusted[face as usize] = false);
        let look = Look {
            goal: &state.goal,
            divided_above: self.max_levels,
            length: f64::INFINITY,
            changes: None,
            bulges: None,
            trusted: &state.is_trusted,
        };
        let found = measure(&self.sources(state, emission), self.watch, &faces, &look)?;
        self.watch.each(faces.iter().zip(found), |(&face, found)| {
            state.measured[face as usize].replace(found, true);
        })?;
        state.take_failing(&mut failing, self.watch)?;
        Ok(failing)
    }

    /// Splits the leaves that fail; says whether there are any that may be.
    fn split_failing(
        &self,
        state: &mut State,
        failing: &[Failing],
        dirty: &mut Dirty,
    ) -> Result<bool, RefineError> {
        let goal = state.goal.clone();
        let has_heights = self.control.criteria.is_none();
        let failing = &self.ask(state, failing, dirty)?;
        let mut is_split = !dirty.asking().is_empty();
        for &(place, value) in failing {
            self.watch.poll()?;
            // Triangles of a leaf may fail for several reasons.
            if !is_leaf(&state.trees, place) {
                continue;
            }
            // Each division leaves a quarter of the height.
            let times = if has_heights {
                // Heights of parts should be a quarter, and are half as much again at most.
                value / (6.0 * goal.allowed(place.face))
            } else {
                0.0
            };
            let levels = if times > 1.0 {
                ((math::log2(times) / 2.0).ceil() as u32).min(MOST_AT_ONCE)
            } else {
                0
            };
            is_split |= self.split_below(state, place, levels, dirty)?;
        }
        if has_heights {
            for &(place, value) in failing {
                let times = value / goal.allowed(place.face);
                is_split |= self.split_towards_corner(state, place, times, dirty)?;
            }
        }
        Ok(is_split)
    }

    /// Splits a leaf, and what that gives so many times more; says whether it may be split.
    fn split_below(
        &self,
        state: &mut State,
        place: NodeAddress,
        levels: u32,
        dirty: &mut Dirty,
    ) -> Result<bool, RefineError> {
        if place.level >= self.max_levels {
            state.has_failed = true;
            return Ok(false);
        }
        self.split(state, place, dirty)?;
        if levels > 0 && place.level + 1 < self.max_levels {
            for child in 0..4 {
                self.split_below(state, place.child(child), levels - 1, dirty)?;
            }
        }
        Ok(true)
    }

    /// Splits a leaf; adds that to what is dirty.
    pub(super) fn split(
        &self,
        state: &mut State,
        place: NodeAddress,
        dirty: &mut Dirty,
    ) -> Result<(), RefineError> {
        let fits = state
            .trees
            .split(place, |place| dirty.add(&self.control.edges, place));
        fits.then_some(())
            .ok_or_else(|| state.trees.too_many(4).into())
    }

    /// Divides the leaves at a corner of a control face, and those adjacent to them, as often as one that fails there by so many times lets
    /// expect: at irregular vertices distances fall like the edges, or more slowly, not by a quarter each time, and what fails does so again,
    /// level by level. Says whether there are any.
    fn split_towards_corner(
        &self,
        state: &mut State,
        place: NodeAddress,
        times: f64,
        dirty: &mut Dirty,
    ) -> Result<bool, RefineError> {
        let Some(TowardsCorner {
            mut corner,
            child,
            is_adjacent,
        }) = towards_corner(place)
        else {
            return Ok(false);
        };
        let vertex = VertexId(self.control.mesh.triangles()[place.face as usize][child]);
        let (valence, _) = self.control.mesh.topology().valence_and_openness(vertex);
        // Around vertices of six edges at most each division leaves a quarter of the distance, unless triangles are balanced.
        if !self.is_balanced && valence <= 6 {
            return Ok(false);
        }
        let mut is_split = false;
        // A leaf that fails by more than 64 times does not show how its children fail.
        let mut left = if times <= 64.0 {
            // The first split there leaves a quarter: the rest of the distance is then mostly due to the corner.
            0.25 * times
        } else {
            0.0
        };
        while left > 1.0 && corner.level + u32::from(is_adjacent) < self.max_levels {
            self.watch.poll()?;
            let inner = corner.child(3);
            for place in [Some(corner), is_adjacent.then_some(inner)]
                .into_iter()
                .flatten()
            {
                if is_leaf(&state.trees, place) {
                    self.split(state, place, dirty)?;
                    is_split = true;
                }
            }
            corner = corner.child(child);
            // Distances at irregular vertices are halved each time at least.
            left *= 0.5;
        }
        Ok(is_split)
    }
}

/// Whether the triangles of a control face and those adjacent to it keep what its proven leaves assume.
fn is_kept(control: &Control<'_>, state: &State, face: u32) -> bool {
    let assumed = &state.proven[face as usize];
    // A proof that assumes nothing holds.
    if assumed.allowance == Allowance::NOTHING {
        return true;
    }
    let own = [face].into_iter().chain(control.adjacent(face));
    own.into_iter().all(|face| {
        let (proven, measured) = (
            &state.proven[face as usize].extent,
            &state.measured[face as usize],
        );
        let (normal_deviation, slope) = (
            proven.normal_deviation.max(measured.normal_deviation),
            proven.slope.min(measured.slope),
        );
        normal_deviation <= assumed.allowance.normal_deviation
            && assumed.extent.displacement_slope <= slope
    })
}

/// The way towards a corner of a control face.
#[derive(Debug, PartialEq, Eq)]
struct TowardsCorner {
    /// The next leaf at the corner, which of its parent's children that is, and whether the leaf that was split is adjacent to it.
    corner: NodeAddress,
    child: usize,
    is_adjacent: bool,
}

/// The way on from a leaf that has been split at a corner of its control face, or adjacent to the leaf there.
fn towards_corner(place: NodeAddress) -> Option<TowardsCorner> {
    let parent = place.parent()?;
    let (first, last) = (place.digit(0), place.digit(place.level - 1));
    let is_at_corner = first < 3 && (0..parent.level).all(|level| parent.digit(level) == first);
    match last {
        _ if !is_at_corner => None,
        3 => Some(TowardsCorner {
            corner: parent.child(first),
            child: first,
            is_adjacent: true,
        }),
        _ if last == first => Some(TowardsCorner {
            corner: place.child(first),
            child: first,
            is_adjacent: false,
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
