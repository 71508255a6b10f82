//! What triangles count on of those beside them, checked against what came out; faces that counted on too much are divided again.

use core::sync::atomic::AtomicUsize;

use super::super::control::Control;
use super::super::judge::{Allowance, Extent, Goal};
use super::super::quadtree::Edges;
use super::again::Before;
use super::{Count, Decider, Decision};
use crate::progress::SharedWatch;
use crate::refine::RefineError;

/// What is added to an allowance that was too little.
const WIDER: f64 = 1.1;

/// Rounds after which triangles count on nothing where allowances still do not hold.
const MOST_ROUNDS: usize = 6;

impl Decision {
    /// Divides again the faces that counted on more than those beside them keep, `closing` being what came about since in a
    /// face; gives their numbers, or `None` if that takes too many leaves.
    pub(in super::super) fn settle<'c>(
        &mut self,
        (control, watch): (&Control<'_>, &SharedWatch<'_>),
        goal: &Goal,
        edges: &Edges<'_>,
        (max_levels, most): (u32, usize),
        closing: impl Fn(u32) -> Option<&'c Extent> + Sync,
    ) -> Result<Option<Vec<u32>>, RefineError> {
        let faces = control.mesh.face_count() as u32;
        let mut wanting = Vec::new();
        watch.each(0..faces, |face| {
            let (Allowance { tilt, slope }, counted) = self.around(control, edges, face, &closing);
            let allowance = self.allowance(face);
            // What counts on nothing needs nothing.
            if *allowance != Allowance::NOTHING && !(tilt <= allowance.tilt && counted <= slope) {
                wanting.push((face, tilt, slope));
            }
        })?;
        for &(face, tilt, slope) in &wanting {
            let own = &mut self.found[face as usize].allowance;
            *own = if self.rounds >= MOST_ROUNDS {
                Allowance::NOTHING
            } else {
                Allowance {
                    tilt: own.tilt.max(WIDER * tilt),
                    slope: own.slope.min(slope / WIDER),
                }
            };
        }
        self.rounds += 1;
        let faces: Vec<u32> = wanting.into_iter().map(|(face, ..)| face).collect();
        let fits = self.divide(
            (control, watch),
            goal,
            edges,
            (max_levels, most),
            (&faces, None),
        )?;
        Ok(fits.then_some(faces))
    }

    /// Nothing was divided again so far.
    pub(in super::super) fn begin_again(&mut self) {
        self.rounds = 0;
    }

    /// Divides some faces again, with the allowances that they have, or further than they were for another goal; `false` if that takes too
    /// many leaves.
    pub(in super::super) fn divide(
        &mut self,
        (control, watch): (&Control<'_>, &SharedWatch<'_>),
        goal: &Goal,
        edges: &Edges<'_>,
        (max_levels, most): (u32, usize),
        (faces, coarser): (&[u32], Option<&Goal>),
    ) -> Result<bool, RefineError> {
        let count = Count {
            leaves: AtomicUsize::new(0),
            most,
        };
        let again = watch.long_shares(faces.len(), |block, is_stopped| {
            let mut decider = Decider::new(control, edges, goal, max_levels, (&count, is_stopped));
            let again = faces[block].iter().map(|&face| {
                let found = &self.found[face as usize];
                let found = match coarser {
                    None => decider.face(face, Some(found.allowance)),
                    Some(goal) => decider.again(
                        face,
                        Before {
                            trees: &self.trees,
                            goal,
                        },
                        found,
                    ),
                };
                decider.tell();
                (face, core::mem::take(&mut decider.piece), found)
            });
            again.collect::<Vec<_>>()
        })?;
        if count.is_passed() {
            return Ok(false);
        }
        for (face, piece, found) in again.into_iter().flatten() {
            if !self.trees.replace(face, &piece) {
                return Err(self.trees.too_many(piece.words.len()).into());
            }
            self.found[face as usize] = found;
        }
        Ok(true)
    }

    /// What the triangles in a face and beside it come to, `closing` being what came about since in a face, and the greatest
    /// slope that is counted on in the face.
    pub(in super::super) fn around<'c>(
        &self,
        control: &Control<'_>,
        edges: &Edges<'_>,
        face: u32,
        closing: impl Fn(u32) -> Option<&'c Extent>,
    ) -> (Allowance, f64) {
        let all = |face: u32| {
            let mut extent = self.extent(face);
            if let Some(closing) = closing(face) {
                extent.add(closing);
            }
            extent
        };
        let own = all(face);
        let mut around = Allowance {
            tilt: own.tilt,
            slope: own.slope,
        };
        for other in control.beside(edges, face).map(all) {
            around = Allowance {
                tilt: around.tilt.max(other.tilt),
                slope: around.slope.min(other.slope),
            };
        }
        (around, own.drift_slope)
    }
}
