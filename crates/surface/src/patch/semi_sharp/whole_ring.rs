//! A ring of very many edges in a mesh with tags: its sharpness at each level, found once for all faces around its vertex.
//!
//! Takes a vertex; gives, for each of its faces, the neighbours near the face with what the rules ask of the others on every level: where the
//! vertex goes, and, once nothing is semi-sharp any more, the mean of its neighbours or the ends of the sector that the face is in. So a face takes no
//! more than at any other vertex. See [`crate::patch::pole`] for why the neighbours near a face are enough; sharp edges make that only better, as nothing
//! enters their new points from their adjacent neighbours.

use std::sync::Arc;

use super::SemiSharpVertex;
use super::lasting_twin::RingGaps;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::Poll;
use crate::patch::pole::{BEYOND, KEPT};
use crate::patch::sector::{Centre, Far, VertexSector};
use crate::patch::{Neighbours, Rules};
use crate::progress::Cancelled;
use crate::ring::{SharpRing, VertexRule};
use crate::vector::DVec3;

/// A vertex with all of its ring, and what becomes of them.
#[derive(Debug)]
pub(crate) struct WholeRing {
    /// The half-edges that leave the vertex, ascending, each with its slot.
    slots: Vec<(HalfEdgeId, u32)>,
    neighbours: Vec<DVec3>,
    sharp: SharpRing,
    /// At first, and after each refinement until nothing in the mesh is semi-sharp any more.
    levels: Vec<Level>,
}

/// The ring after some refinements.
#[derive(Debug)]
struct Level {
    at: DVec3,
    /// The mean of the neighbours.
    mean: DVec3,
    is_semi_sharp: bool,
    least_semi_sharpness: f64,
    is_corner: bool,
    /// The neighbours along sharp edges with their slots, ascending.
    sharp: Vec<(usize, DVec3)>,
    /// How far the ring is from its infinitely sharp twin; `None` where that is not known, or nothing is semi-sharp.
    gaps: Option<Box<RingGaps>>,
}

impl Level {
    fn of(whole: &SemiSharpVertex, rules: &Rules<'_>) -> Self {
        let neighbours = &whole.neighbours;
        let sharp = (0..neighbours.len()).filter(|&slot| whole.sharp.is_sharp(slot));
        let gaps = if whole.is_semi_sharp() {
            RingGaps::of(whole, rules)
        } else {
            None
        };
        Self {
            at: whole.at,
            mean: neighbours.iter().sum::<DVec3>() / neighbours.len() as f64,
            is_semi_sharp: whole.is_semi_sharp(),
            least_semi_sharpness: whole.least_semi_sharpness(),
            is_corner: whole.sharp.rule() == VertexRule::Corner,
            sharp: sharp.map(|slot| (slot, neighbours[slot])).collect(),
            gaps: gaps.map(Box::new),
        }
    }

    /// The sharp edges on either side of the face after a slot, first that which is at the slot or before it; `None` if no two edges are sharp.
    fn around(&self, slot: usize) -> Option<[(usize, DVec3); 2]> {
        let ([_, _, ..], [first, .., last]) = (&self.sharp[..], &self.sharp[..]) else {
            return None;
        };
        let next = self.sharp.partition_point(|&(sharp, _)| sharp <= slot);
        let before = next
            .checked_sub(1)
            .map_or(last, |before| &self.sharp[before]);
        Some([*before, *self.sharp.get(next).unwrap_or(first)])
    }
}

impl WholeRing {
    /// The ring of a vertex after each of so many refinements, after which nothing in the mesh is semi-sharp. `None` if a crease
    /// ends there then: the mean of the neighbours does not tell by itself where the vertex goes.
    pub(crate) fn of(
        mesh: &Mesh,
        sharpness: &Sharpness<'_>,
        vertex: VertexId,
        levels: usize,
        rules: &Rules<'_>,
        poll: &mut Poll<'_>,
    ) -> Result<Option<Self>, Cancelled> {
        let topology = mesh.topology();
        let mut whole = SemiSharpVertex::of(mesh, sharpness, topology.outgoing(vertex));
        let mut slots: Vec<(HalfEdgeId, u32)> = topology.outgoing_ring(vertex).zip(0..).collect();
        slots.sort_unstable();
        let (neighbours, sharp) = (whole.neighbours.clone(), whole.sharp.clone());
        let mut found = vec![Level::of(&whole, rules)];
        for level in 0..levels {
            poll(level)?;
            whole = whole.refined(rules);
            found.push(Level::of(&whole, rules));
        }
        let is_dart = whole.sharp.rule() == VertexRule::Dart;
        Ok((!is_dart).then_some(Self {
            slots,
            neighbours,
            sharp,
            levels: found,
        }))
    }

    /// Whether an edge or the vertex is semi-sharp.
    pub(crate) fn is_semi_sharp(&self) -> bool {
        self.levels[0].is_semi_sharp
    }

    /// The vertex as a corner of the face of `h`, which leaves it, with the neighbours near that face.
    pub(crate) fn near(self: &Arc<Self>, h: HalfEdgeId) -> SemiSharpVertex {
        let place = self.slots.partition_point(|&(other, _)| other < h);
        let (own, count) = (self.slots[place].1 as usize, self.neighbours.len());
        let (first, kept) = if self.sharp.open {
            let first = own.saturating_sub(1 + BEYOND);
            (first, (own + BEYOND + 3).min(count) - first)
        } else {
            ((own + count - 1 - BEYOND) % count, KEPT)
        };
        let around = (0..kept).map(|i| (first + i) % count);
        let spokes = around.clone().map(|slot| self.sharp.spokes[slot]).collect();
        SemiSharpVertex {
            at: self.levels[0].at,
            neighbours: around.map(|slot| self.neighbours[slot]).collect(),
            sharp: SharpRing {
                spokes,
                ..self.sharp
            },
            slot: (own + count - first) % count,
            whole: Some(PartOfRing {
                ring: Arc::clone(self),
                level: 0,
                first,
            }),
        }
    }
}

/// Which part of a ring of very many edges the neighbours of a vertex are.
#[derive(Clone, Debug)]
pub(super) struct PartOfRing {
    ring: Arc<WholeRing>,
    level: usize,
    /// The slot of the first of them.
    first: usize,
}

impl PartOfRing {
    /// After the last level nothing in the mesh is semi-sharp, and this is not called.
    fn level(&self) -> &Level {
        &self.ring.levels[self.level.min(self.ring.levels.len() - 1)]
    }

    /// After a refinement.
    pub(super) fn refined(&self) -> Self {
        Self {
            ring: Arc::clone(&self.ring),
            level: self.level + 1,
            first: self.first,
        }
    }

    /// Where the vertex is.
    pub(crate) fn at(&self) -> DVec3 {
        self.level().at
    }

    pub(super) fn is_semi_sharp(&self) -> bool {
        self.level().is_semi_sharp
    }

    /// The least semi-sharp sharpness of all of the ring.
    pub(crate) fn least_semi_sharpness(&self) -> f64 {
        self.level().least_semi_sharpness
    }

    pub(super) fn gaps(&self) -> Option<&RingGaps> {
        self.level().gaps.as_deref()
    }

    /// The slot in the whole ring of one of the neighbours.
    fn slot(&self, neighbour: usize) -> usize {
        (self.first + neighbour) % self.ring.neighbours.len()
    }

    /// Calls `visit` for what holds, together with the neighbours that are there, all that becomes of the face after `neighbour`.
    pub(super) fn for_each_point(&self, neighbour: usize, mut visit: impl FnMut(DVec3)) {
        let levels = &self.ring.levels[self.level.min(self.ring.levels.len() - 1)..];
        levels.iter().for_each(|level| visit(level.at));
        let Some(last) = levels.last() else { return };
        match last.around(self.slot(neighbour)) {
            Some(ends) => ends.into_iter().for_each(|(_, end)| visit(end)),
            None => visit(last.mean),
        }
    }

    /// The sector that the face after neighbour `slot` is in, as sharp as everything is now.
    pub(super) fn sector(&self, neighbours: &[DVec3], slot: usize) -> VertexSector {
        let level = self.level();
        match level.around(self.slot(slot)) {
            Some(ends) => self.open_sector(neighbours, slot, ends),
            None => self.closed_sector(neighbours, slot),
        }
    }

    /// That between two sharp edges.
    fn open_sector(&self, near: &[DVec3], slot: usize, ends: [(usize, DVec3); 2]) -> VertexSector {
        let (level, own, count) = (self.level(), self.slot(slot), self.ring.neighbours.len());
        let [(before, first), (after, last)] = ends;
        let [before, after] = [
            (own + count - before) % count,
            (after + count - own) % count,
        ];
        let (after_first, before_last) = (before > slot, after > near.len() - 1 - slot);
        let (from, to) = (
            slot - before.min(slot),
            slot + after.min(near.len() - 1 - slot),
        );
        let around = near[from..=to].iter().copied();
        let centre = if level.is_corner {
            Centre::Corner {
                open: true,
                sharp: None,
            }
        } else {
            Centre::Crease
        };
        VertexSector {
            at: level.at,
            neighbours: after_first
                .then_some(first)
                .into_iter()
                .chain(around)
                .chain(before_last.then_some(last))
                .collect(),
            centre,
            slot: slot - from + usize::from(after_first),
            far: match after_first || before_last {
                true => Far::Ends {
                    after_first,
                    before_last,
                },
                false => Far::Kept,
            },
        }
    }

    /// All of a closed ring without two sharp edges.
    fn closed_sector(&self, near: &[DVec3], slot: usize) -> VertexSector {
        let (level, count) = (self.level(), self.ring.neighbours.len());
        let mut neighbours = Neighbours::from_slice(&near[slot..]);
        neighbours.extend_from_slice(&near[..slot]);
        let centre = if level.is_corner {
            // One that is far away does not matter: the vertex stays.
            let sharp = level
                .sharp
                .first()
                .map(|&(sharp, _)| (sharp + count - self.first) % count);
            let sharp = sharp.filter(|&place| place < near.len());
            let sharp = sharp.map(|place| (place + near.len() - slot) % near.len());
            Centre::Corner { open: false, sharp }
        } else {
            Centre::Smooth { sharp: None }
        };
        VertexSector {
            at: level.at,
            neighbours,
            centre,
            slot: 0,
            far: Far::Mean {
                valence: count,
                mean: level.mean,
            },
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
