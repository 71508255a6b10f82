//! The one mutable state of exact refinement: the quadtrees, and all that was made of them so far.

use limitmesh_pages::filled;

use super::Engine;
use super::bulges::Bulges;
use super::chains::Chains;
use super::cover::Cover;
use super::divide::{Division, Proven, divide};
use super::emit::Emission;
use super::emitted::Sources;
use super::judge::Goal;
use super::measured::Measured;
use super::quadtree::{NodeAddress, Piece, Trees};
use super::seen::{Allowance, Extent};
use super::touched::Fresh;
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;

/// Quadtrees over all control faces, on the way to a goal.
pub(super) struct State {
    pub(super) goal: Goal,
    pub(super) trees: Trees,
    /// By control face, its proven leaves, and whether all triangles around them keep what these assume, as far as is known.
    pub(super) proven: Vec<Proven>,
    pub(super) is_trusted: Vec<bool>,
    pub(super) chains: Chains,
    /// Whether diagonals do not depend on the surface, as one state serves several.
    pub(super) has_fixed_diagonals: bool,
    /// By control face.
    pub(super) covers: Vec<Cover>,
    pub(super) triangles: usize,
    /// Whether leaves fail that must not be divided.
    pub(super) has_failed: bool,
    /// By control face, what has changed since the last emission.
    pub(super) fresh: Vec<Fresh>,
    /// The measured bounds, by control face.
    pub(super) measured: Vec<Measured>,
    pub(super) bulges: Bulges,
}

impl State {
    /// The state of a division that is not covered yet.
    pub(super) fn of(goal: Goal, division: Division) -> Self {
        let Division { trees, proven } = division;
        let faces = proven.len();
        Self {
            goal,
            trees,
            chains: Chains::default(),
            has_fixed_diagonals: false,
            covers: filled(Cover::default(), faces),
            triangles: 0,
            has_failed: false,
            is_trusted: vec![true; faces],
            fresh: vec![Fresh::All; faces],
            measured: (0..faces as u32).map(Measured::nothing).collect(),
            bulges: Bulges::default(),
            proven,
        }
    }

    /// That of faces that are divided evenly, so many times.
    pub(super) fn even(goal: Goal, faces: usize, levels: u32) -> Result<Self, RefineError> {
        let mut piece = Piece::default();
        for _ in 0..faces {
            let root = piece.even(levels);
            piece.roots.push(root);
        }
        let trees = Trees::of(&[piece], &mut || Ok(()))?;
        let nothing = Proven {
            allowance: Allowance::NOTHING,
            extent: Extent::NONE,
        };
        let mut state = Self::of(
            goal,
            Division {
                trees,
                proven: vec![nothing; faces],
            },
        );
        state.is_trusted.fill(false);
        Ok(state)
    }

    /// Keeps the trees, and forgets what is known of their leaves.
    pub(super) fn forget(&mut self) {
        self.is_trusted.fill(false);
        self.fresh.fill(Fresh::All);
    }

    pub(super) fn faces(&self) -> u32 {
        self.covers.len() as u32
    }

    /// The greatest value of all triangles.
    pub(super) fn worst(&self) -> f64 {
        (0..self.faces())
            .map(|face| self.worst_of(face))
            .fold(0.0, f64::max)
    }

    /// Moves the leaves that fail to a list.
    pub(super) fn take_failing(
        &mut self,
        failing: &mut Vec<(NodeAddress, f64)>,
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        watch.each(&mut self.measured, |face| failing.append(&mut face.failing))
    }

    /// The greatest value of a triangle of a control face.
    pub(super) fn worst_of(&self, face: u32) -> f64 {
        self.measured[face as usize]
            .value
            .max(self.proven_bound(face))
    }

    /// The greatest bound of a proven leaf of a control face; 0 where these are not trusted, or there are none.
    pub(super) fn proven_bound(&self, face: u32) -> f64 {
        if self.is_trusted[face as usize] {
            self.proven[face as usize].extent.bound
        } else {
            0.0
        }
    }

    /// Levels of the deepest tree.
    pub(super) fn levels(&self, watch: &SharedWatch<'_>) -> Result<usize, Cancelled> {
        let (trees, faces) = (&self.trees, self.covers.len());
        let levels = watch.pieces(faces, parallel::share(faces), |block| {
            block
                .map(|face| trees.depth(trees.root(face as u32)) as usize)
                .max()
        });
        Ok(levels?.into_iter().flatten().max().unwrap_or(0))
    }
}

impl Engine<'_> {
    /// Divides as asked, by guesses alone; `None` if that takes more than `most` triangles.
    pub(super) fn divided(&self, goal: Goal, most: usize) -> Result<Option<State>, RefineError> {
        let Some(division) = divide(self, &goal, most)? else {
            return Ok(None);
        };
        let mut state = State::of(goal, division);
        state.is_trusted.fill(self.trusts());
        Ok(Some(state))
    }

    pub(super) fn sources<'a>(&'a self, state: &'a State, emission: &'a Emission) -> Sources<'a> {
        let State {
            trees,
            chains,
            covers,
            ..
        } = state;
        Sources {
            control: self.control,
            trees,
            chains,
            covers,
            emission,
        }
    }
}
