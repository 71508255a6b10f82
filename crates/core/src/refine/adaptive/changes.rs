//! Which triangles may come to something else than when they were looked at last.
//!
//! What a triangle comes to depends on its part of the surface, on its corners and on those of the triangles beside it. Of triangles whose
//! corners are moved off the surface it is known which were there before, and how these were moved then ([`super::bulges`]);
//! of others, in which control faces all were.

use super::bulges::Bulges;
use super::emit::Emission;
use crate::mesh::NONE;
use crate::progress::{Cancelled, SharedWatch};

/// Control faces that one call takes together.
const BLOCK: usize = 256;

/// What has changed.
pub(super) struct Changes {
    /// By triangle.
    has_changed: Vec<bool>,
    /// By control face, whether all of its triangles count as others.
    are_others: Vec<bool>,
}

impl Changes {
    /// Since triangles were measured last, with the control faces whose triangles all count as others, and what is known of triangles whose
    /// corners were moved.
    pub(super) fn since(
        bulges: Option<&Bulges>,
        are_others: Vec<bool>,
        emission: &Emission,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let found = watch.pieces(are_others.len(), BLOCK, |faces| {
            let mut changed = Vec::new();
            for face in faces {
                let triangles = emission.triangles_of(face as u32);
                match bulges.filter(|_| !are_others[face]) {
                    None => changed.resize(changed.len() + triangles.len(), are_others[face]),
                    Some(bulges) => {
                        let known = triangles.zip(&bulges.0[face].found);
                        changed.extend(known.map(|(at, found)| found.offsets != emission.offsets_of(at)));
                    }
                }
            }
            changed
        })?;
        Ok(Self { has_changed: found.concat(), are_others })
    }

    /// Whether all triangles of a control face count as others.
    pub(super) fn are_others(&self, face: u32) -> bool {
        self.are_others[face as usize]
    }

    /// Whether a triangle may come to something else.
    pub(super) fn concern(&self, emission: &Emission, triangle: u32) -> bool {
        let is_changed = |triangle: u32| self.has_changed[triangle as usize];
        let twins = &emission.twins[3 * triangle as usize..3 * triangle as usize + 3];
        is_changed(triangle) || twins.iter().any(|&twin| twin != NONE && is_changed(twin / 3))
    }

    /// The control faces some of whose triangles may.
    pub(super) fn faces(&self, emission: &Emission, watch: &SharedWatch<'_>) -> Result<Vec<u32>, Cancelled> {
        let faces = emission.starts.len() - 1;
        let found = watch.pieces(faces, BLOCK, |faces| {
            let concerned = faces.map(|face| face as u32).filter(|&face| {
                let mut triangles = emission.triangles_of(face);
                triangles.any(|triangle| self.concern(emission, triangle as u32))
            });
            concerned.collect::<Vec<u32>>()
        })?;
        Ok(found.concat())
    }
}

#[cfg(test)]
mod tests;
