//! What is going to be emitted: the trees that the passes have come to, and what is known of their leaves.

use super::block;
use super::chains::Chains;
use super::close::Closed;
use super::decide::Decision;
use super::emit::Emission;
use super::judge::Goal;
use super::quadtree::Place;
use crate::progress::{Cancelled, SharedWatch};

/// Trees whose closed leaves pass, and what emitting them takes.
pub(super) struct Plan {
    pub(super) goal: Goal,
    pub(super) decision: Decision,
    pub(super) chains: Chains,
    pub(super) closed: Vec<Closed>,
    pub(super) triangles: usize,
    /// Leaves fail that must not be divided.
    pub(super) has_failed: bool,
    /// By control face whose leaves that pass on conditions do so, the greatest bound of one, and the leaf.
    pub(super) settled: Vec<Option<(f64, Place)>>,
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
            closed: vec![Closed::default(); faces],
            triangles: 0,
            has_failed: false,
            settled: vec![None; faces],
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
        let closing = self.closed[face as usize].extent().map_or(0.0, |extent| extent.bound);
        let settled = self.settled[face as usize].map_or(0.0, |(bound, _)| bound);
        closing.max(settled).max(self.decision.bound(face))
    }

    /// The faces whose leaves have the greatest bounds first.
    pub(super) fn faces_by_bound(&self) -> Vec<(f64, u32)> {
        let mut order: Vec<(f64, u32)> =
            (0..self.closed.len() as u32).map(|face| (self.bound(face), face)).collect();
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order
    }

    /// The greatest bound of all triangles.
    pub(super) fn worst(&self) -> f64 {
        (0..self.closed.len() as u32).map(|face| self.bound(face)).fold(0.0, f64::max)
    }

    /// Levels of the deepest tree.
    pub(super) fn levels(&self, watch: &SharedWatch<'_>) -> Result<usize, Cancelled> {
        let (trees, faces) = (&self.decision.trees, self.closed.len());
        let levels = watch.pieces(faces, block(faces), |block| {
            block.map(|face| trees.depth(trees.root(face as u32)) as usize).max()
        });
        Ok(levels?.into_iter().flatten().max().unwrap_or(0))
    }
}
