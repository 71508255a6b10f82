//! Which triangles may have another bound than when they were measured last.
//!
//! The bound of a triangle depends on its part of the surface, on its corners and on those of adjacent triangles. Of triangles whose
//! corners are moved off the surface it is known which were there before, and how these were moved then ([`super::bulges`]);
//! of others, in which control faces all were.

use super::bulges::{Bulges, ENDS};
use super::emit::Emission;
use super::quadtree::Edges;
use crate::mesh::NONE;
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};

/// How a triangle differs from the last emission.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Change {
    None,
    Some,
    /// It is divided anyway, which the triangles adjacent to it do not know yet.
    Ends,
}

/// The differences between two emissions.
pub(super) struct Changes {
    /// By triangle; empty where every one is new.
    changes: Vec<Change>,
    /// By control face, whether any triangle has.
    have_changed: Vec<bool>,
}

impl Changes {
    /// Since triangles were measured last, with the control faces that were touched since, and what is known of triangles whose
    /// corners were moved. Where that is all that counts, not all triangles of faces that were touched are others.
    pub(super) fn since(
        bulges: Option<&Bulges>,
        is_alone: bool,
        is_touched: &[bool],
        emission: &Emission,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        if bulges.is_some_and(Bulges::are_new) {
            return Ok(Self {
                changes: Vec::new(),
                have_changed: vec![true; is_touched.len()],
            });
        }
        let found = watch.pieces(
            is_touched.len(),
            parallel::share(is_touched.len()),
            |faces| {
                let (mut changes, mut have_changed) = (Vec::new(), Vec::new());
                for face in faces {
                    let triangles = emission.triangles_of(face as u32);
                    let is_other = is_touched[face] && !is_alone;
                    let is_same =
                        |known: &Bulges| !is_touched[face] && known.are_same(face as u32, emission);
                    let Some(known) = bulges.filter(|known| !is_other && !is_same(known)) else {
                        let change = if is_other { Change::Some } else { Change::None };
                        changes.resize(changes.len() + triangles.len(), change);
                        have_changed.push(is_other);
                        continue;
                    };
                    let mut has_changed = false;
                    let bulge = &known.0[face];
                    let last = bulge.offsets_last().zip(&bulge.ranges);
                    changes.extend(triangles.zip(last).map(|(at, (last, range))| {
                        let is_same = last == emission.offsets_of(at);
                        has_changed |= !is_same;
                        match (is_alone && *range == ENDS, is_same) {
                            (true, _) => Change::Ends,
                            (false, true) => Change::None,
                            (false, false) => Change::Some,
                        }
                    }));
                    have_changed.push(has_changed);
                }
                (changes, have_changed)
            },
        )?;
        let (changes, have_changed): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        Ok(Self {
            changes: changes.concat(),
            have_changed: have_changed.concat(),
        })
    }

    /// Whether a triangle may have another bound.
    #[inline]
    pub(super) fn concern(&self, emission: &Emission, triangle: u32) -> bool {
        self.changes.is_empty() || self.concern_one(emission, triangle)
    }

    fn concern_one(&self, emission: &Emission, triangle: u32) -> bool {
        let twins = &emission.twins[3 * triangle as usize..3 * triangle as usize + 3];
        let adjacent = twins
            .iter()
            .filter(|&&twin| twin != NONE)
            .map(|twin| self.changes[*twin as usize / 3]);
        let mut change = self.changes[triangle as usize];
        for other in adjacent {
            change = match (change, other) {
                (Change::Ends, _) | (_, Change::Ends) => Change::Ends,
                (Change::None, other) => other,
                (Change::Some, _) => Change::Some,
            };
        }
        change == Change::Some
    }

    /// The control faces some of whose triangles may.
    pub(super) fn faces(
        &self,
        emission: &Emission,
        edges: &Edges<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<u32>, Cancelled> {
        let has_changed = |face: u32| self.have_changed[face as usize];
        let found = watch.pieces(
            self.have_changed.len(),
            parallel::share(self.have_changed.len()),
            |faces| {
                let concerned = faces.map(|face| face as u32).filter(|&face| {
                    let mut beyond = (3 * face..3 * face + 3)
                        .filter_map(|h| edges.twin(h))
                        .map(|twin| twin / 3);
                    let mut triangles = emission.triangles_of(face);
                    (has_changed(face) || beyond.any(has_changed))
                        && triangles.any(|triangle| self.concern(emission, triangle as u32))
                });
                concerned.collect::<Vec<u32>>()
            },
        )?;
        Ok(found.concat())
    }
}
