//! Which triangles may have another bound than when they were measured last.
//!
//! The bound of a triangle depends on its part of the surface, on its corners and on those of adjacent triangles. Of triangles whose
//! corners are moved off the surface it is known which were there before, and how these were moved then ([`super::bulges`]);
//! of others, which leaves were touched ([`super::touched`]).

use super::bulges::{Bulges, ENDS};
use super::emit::Emission;
use super::quadtree::Edges;
use super::touched::Fresh;
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
    /// By control face, which have.
    faces: Vec<Which>,
}

/// Which triangles of a control face have changed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Which {
    None,
    Some,
    All,
}

impl Changes {
    /// Since triangles were measured last, with those that were not there, and what is known of triangles whose
    /// corners were moved. Unless that is all that counts, all triangles of faces with such a triangle are others.
    pub(super) fn since(
        bulges: Option<&Bulges>,
        is_alone: bool,
        fresh: &[Fresh],
        emission: &Emission,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        if bulges.is_some_and(Bulges::are_new) {
            let which = if is_alone { Which::Some } else { Which::All };
            return Ok(Self {
                changes: Vec::new(),
                faces: vec![which; fresh.len()],
            });
        }
        let found = watch.pieces(fresh.len(), parallel::share(fresh.len()), |faces| {
            let (mut changes, mut which) = (Vec::new(), Vec::new());
            for face in faces {
                let triangles = emission.triangles_of(face as u32);
                let fresh = &fresh[face];
                if let (None, Fresh::Some(fresh)) = (bulges, fresh) {
                    let change = |&is_fresh| if is_fresh { Change::Some } else { Change::None };
                    changes.extend(fresh.iter().map(change));
                    which.push(Which::Some);
                    continue;
                }
                let is_other = fresh.is_any() && !is_alone;
                let is_same =
                    |known: &Bulges| !fresh.is_any() && known.are_same(face as u32, emission);
                let Some(known) = bulges.filter(|known| !is_other && !is_same(known)) else {
                    let (change, own) = match is_other {
                        true => (Change::Some, Which::All),
                        false => (Change::None, Which::None),
                    };
                    changes.resize(changes.len() + triangles.len(), change);
                    which.push(own);
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
                which.push(if has_changed {
                    Which::Some
                } else {
                    Which::None
                });
            }
            (changes, which)
        })?;
        let (changes, faces): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        Ok(Self {
            changes: changes.concat(),
            faces: faces.concat(),
        })
    }

    /// Whether all triangles of a control face have.
    pub(super) fn are_all(&self, face: u32) -> bool {
        self.faces[face as usize] == Which::All
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
        let has_changed = |face: u32| self.faces[face as usize] != Which::None;
        let found = watch.pieces(
            self.faces.len(),
            parallel::share(self.faces.len()),
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
