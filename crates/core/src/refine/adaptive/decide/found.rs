//! What each control face came to, kept in the blocks in which faces were divided: nothing is copied together.

use super::{Allowance, BLOCK, Condition, Extent};

/// What one face came to.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) extent: Extent,
    /// What its triangles count on.
    pub(super) allowance: Allowance,
    pub(super) has_failed: bool,
    /// Leaves that pass on conditions, in the order of the tree.
    pub(super) conditions: Vec<Condition>,
}

impl Found {
    /// That of a face of whose leaves nothing is known.
    pub(super) const NOTHING: Self = Self {
        extent: Extent::NONE,
        allowance: Allowance::NOTHING,
        has_failed: false,
        conditions: Vec::new(),
    };
}

/// The same by control face, [`BLOCK`] faces together.
#[derive(Clone)]
pub(super) struct FoundByFace(pub(super) Vec<Vec<Found>>);

impl FoundByFace {
    pub(super) fn of(&self, face: u32) -> &Found {
        &self.0[face as usize / BLOCK][face as usize % BLOCK]
    }

    pub(super) fn of_mut(&mut self, face: u32) -> &mut Found {
        &mut self.0[face as usize / BLOCK][face as usize % BLOCK]
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Found> {
        self.0.iter().flatten()
    }
}
