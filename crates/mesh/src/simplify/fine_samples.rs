//! Points of the fine surface, each in the care of the face of the coarse one that it is measured against.
//!
//! The samples are the fine mesh's vertices, so that a vertex that goes becomes the sample of its number; the
//! lists of the faces are chained through one array.

use crate::mesh::NONE;
use crate::vector::DVec3;

/// Sample positions and which face cares for which.
pub(super) struct FineSamples {
    positions: Vec<DVec3>,
    following: Vec<u32>,
    first: Vec<u32>,
    /// The face that cares for each sample.
    holders: Vec<u32>,
    /// Greatest distance of a face's samples from it.
    errors: Vec<f64>,
}

impl FineSamples {
    /// No face has samples yet.
    pub(crate) fn new(positions: Vec<DVec3>, faces: usize) -> Self {
        Self {
            following: vec![NONE; positions.len()],
            holders: vec![NONE; positions.len()],
            positions,
            first: vec![NONE; faces],
            errors: vec![0.0; faces],
        }
    }

    /// Where a sample, or the vertex of that number, is.
    #[inline]
    pub(super) fn position(&self, sample: u32) -> DVec3 {
        self.positions[sample as usize]
    }

    /// Greatest distance of the samples of `face`.
    #[inline]
    pub(super) fn error(&self, face: u32) -> f64 {
        self.errors[face as usize]
    }

    /// The face that cares for a sample; of a vertex that is still there, [`NONE`].
    #[inline]
    pub(super) fn holder(&self, sample: u32) -> u32 {
        self.holders[sample as usize]
    }

    /// Puts a sample at `distance` into the care of `face`.
    #[inline]
    pub(super) fn give(&mut self, face: u32, sample: u32, distance: f64) {
        self.holders[sample as usize] = face;
        let face = face as usize;
        self.following[sample as usize] = self.first[face];
        self.first[face] = sample;
        self.errors[face] = self.errors[face].max(distance);
    }

    /// Puts a sample into the care of a face again, or of none.
    #[inline]
    pub(super) fn give_back(&mut self, face: u32, sample: u32) {
        if face == NONE {
            self.holders[sample as usize] = NONE;
        } else {
            self.give(face, sample, 0.0);
        }
    }

    /// Sets [`Self::error`].
    #[inline]
    pub(super) fn set_error(&mut self, face: u32, error: f64) {
        self.errors[face as usize] = error;
    }

    /// Takes all its samples from `face`, or none if it has none.
    #[inline]
    pub(super) fn clear(&mut self, face: u32) {
        self.first[face as usize] = NONE;
        self.errors[face as usize] = 0.0;
    }

    /// The samples of `face`.
    #[inline]
    pub(crate) fn of(&self, face: u32) -> impl Iterator<Item = u32> + use<'_> {
        let some = |sample: u32| (sample != NONE).then_some(sample);
        core::iter::successors(some(self.first[face as usize]), move |&s| {
            some(self.following[s as usize])
        })
    }
}
