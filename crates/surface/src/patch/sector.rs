//! Irregular pieces: a face and its one-ring as the sectors of its three corners, whatever their rings are like.
//!
//! A vertex's sector (Biermann, Levin and Zorin 2000) is the part of its ring that decides the surface on the face's
//! side: the whole ring of a smooth vertex or a dart, the part between two sharp edges (or boundary edges) of a crease
//! vertex or a corner. One refinement gives the sectors of the four parts; all but the corner's own are regular then.
//!
//! Of very many neighbours only those near the face and what else the rules ask for are kept ([`Far`]), so that a piece takes no
//! more than any other; see [`super::pole`] for why that is enough.

use core::array::from_fn;

use super::box_spline::{self, Points};
use super::extraordinary::ExtraordinaryPatch;
use super::rules::Rules;
use super::{Neighbours, Patch};
use crate::ring::RingShape;
use crate::vector::DVec3;

/// The rule of a sector's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Centre {
    /// Faces all round; with the slot of its sharp edge where it has just one (a dart).
    Smooth { sharp: Option<usize> },
    /// Smooth along the sharp or boundary curve that the sector starts and ends at.
    Crease,
    /// Keeps its place; the sector is open where `open`, and may have one sharp edge where not.
    Corner { open: bool, sharp: Option<usize> },
}

impl Centre {
    /// The rule of the centre of a sector with that shape, whose first edge is sharp where any is.
    pub(crate) fn of(shape: RingShape) -> Self {
        match (shape.corner, shape.open) {
            (true, true) => Self::Corner {
                open: true,
                sharp: None,
            },
            (false, true) => Self::Crease,
            (true, false) => Self::Corner {
                open: false,
                sharp: shape.dart.then_some(0),
            },
            (false, false) => Self::Smooth {
                sharp: shape.dart.then_some(0),
            },
        }
    }
}

/// The neighbours of a sector that are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Far {
    /// All are there.
    Kept,
    /// In a closed ring without sharp edges, those far from the face are left out: after half of those that are there, and one more.
    /// There is the mean of all of them in their place.
    Mean {
        /// The number of all neighbours.
        valence: usize,
        mean: DVec3,
    },
    /// In an open sector those after the first are left out, or those before the last, or both: the ends are all that
    /// counts of what is far.
    Ends {
        after_first: bool,
        before_last: bool,
    },
}

/// A vertex with its neighbours, counter-clockwise, on the side of one of its faces.
#[derive(Clone, Debug)]
pub struct VertexSector {
    pub(crate) at: DVec3,
    pub(crate) neighbours: Neighbours,
    pub(crate) centre: Centre,
    /// The neighbour that is the face's next corner; the one after it is the corner after that. 0 where a mean replaces the others.
    pub(crate) slot: usize,
    /// The neighbours that are left out.
    pub(crate) far: Far,
}

impl VertexSector {
    /// Whether the sector ends at two sharp or boundary edges.
    pub fn is_open(&self) -> bool {
        matches!(
            self.centre,
            Centre::Crease | Centre::Corner { open: true, .. }
        )
    }

    /// The neighbour `offset` slots on from the face's next corner.
    fn neighbour(&self, offset: isize) -> usize {
        (self.slot as isize + offset).rem_euclid(self.neighbours.len() as isize) as usize
    }

    /// Whether the edge to the neighbour in `slot` is sharp or a boundary.
    fn is_sharp(&self, slot: usize) -> bool {
        match self.centre {
            Centre::Smooth { sharp } | Centre::Corner { open: false, sharp } => sharp == Some(slot),
            _ => self.is_open() && (slot == 0 || slot + 1 == self.neighbours.len()),
        }
    }

    /// Where the centre moves.
    fn moved(&self, rules: &Rules) -> DVec3 {
        match self.centre {
            Centre::Corner { .. } => self.at,
            Centre::Crease => {
                0.75 * self.at
                    + 0.125 * (self.neighbours[0] + self.neighbours[self.neighbours.len() - 1])
            }
            Centre::Smooth { .. } => {
                let (valence, sum) = match self.far {
                    Far::Mean { valence, mean } => (valence, valence as f64 * mean),
                    _ => (self.neighbours.len(), self.neighbours.iter().sum::<DVec3>()),
                };
                let beta = rules.beta(valence);
                (1.0 - valence as f64 * beta) * self.at + beta * sum
            }
        }
    }

    /// Adds the new vertices on the edges to the neighbours.
    fn add_edge_points(&self, points: &mut Neighbours) {
        let count = self.neighbours.len();
        points.resize(count, DVec3::ZERO);
        for slot in 0..count {
            let end = self.neighbours[slot];
            if self.is_sharp(slot) {
                points[slot] = 0.5 * (self.at + end);
                continue;
            }
            let before = self.neighbours[if slot == 0 { count - 1 } else { slot - 1 }];
            let after = self.neighbours[if slot + 1 == count { 0 } else { slot + 1 }];
            points[slot] = 0.375 * (self.at + end) + 0.125 * (before + after);
        }
    }

    /// The six neighbours, the face's next corner first, of a regular sector; on an open one those beyond the curve are
    /// mirrored, which gives the same surface.
    pub(super) fn regular_ring(&self) -> Option<[DVec3; 6]> {
        regular_ring(self.far, self.centre, self.at, &self.neighbours, self.slot)
    }
}

/// The six neighbours, from the one in `slot` on, of a regular sector.
fn regular_ring(
    far: Far,
    centre: Centre,
    at: DVec3,
    neighbours: &[DVec3],
    slot: usize,
) -> Option<[DVec3; 6]> {
    if far != Far::Kept {
        return None;
    }
    let mut ring = match (centre, neighbours) {
        (Centre::Smooth { sharp: None }, &[a, b, c, d, e, f]) => [a, b, c, d, e, f],
        (Centre::Crease, &[a, b, c, d]) => mirrored(at, [a, b, c, d]),
        _ => return None,
    };
    ring.rotate_left(slot);
    Some(ring)
}

/// The ring of a vertex on a curve, with the neighbours that are there and those that mirror them.
fn mirrored(at: DVec3, [a, b, c, d]: [DVec3; 4]) -> [DVec3; 6] {
    [a, b, c, d, at + d - c, at + a - b]
}

/// The sectors of a face's corners.
#[derive(Clone, Debug)]
pub struct SectorPatch(pub [VertexSector; 3]);

impl SectorPatch {
    /// The twelve points of a regular face.
    pub(crate) fn regular(&self) -> Option<Points> {
        let [a, b, c] = &self.0;
        let rings = [a.regular_ring()?, b.regular_ring()?, c.regular_ring()?];
        Some(box_spline::assemble(
            [a.at, b.at, c.at],
            rings.each_ref(),
            [0; 3],
        ))
    }

    /// The face as that of one irregular vertex inside the surface, if the other two corners are regular.
    pub(crate) fn extraordinary(&self) -> Option<(ExtraordinaryPatch, Far)> {
        let corner = self
            .0
            .iter()
            .position(|sector| sector.regular_ring().is_none())?;
        let [sector, first, second] = [0, 1, 2].map(|i| &self.0[(corner + i) % 3]);
        if sector.centre != (Centre::Smooth { sharp: None }) || sector.neighbours.len() < 3 {
            return None;
        }
        let [_, _, _, before, past_first, between] = first.regular_ring()?;
        let [_, _, _, past_second, after, _] = second.regular_ring()?;
        let mut ring = sector.neighbours.clone();
        ring.rotate_left(sector.slot);
        let outer = [before, past_first, between, past_second, after];
        Some((
            ExtraordinaryPatch {
                corner,
                at: sector.at,
                ring,
                outer,
            },
            sector.far,
        ))
    }

    /// All points, corners first; some more than once.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.0.iter().flat_map(|sector| {
            let mean = match sector.far {
                Far::Mean { mean, .. } => Some(mean),
                _ => None,
            };
            core::iter::once(sector.at)
                .chain(sector.neighbours.iter().copied())
                .chain(mean)
        })
    }

    /// Moves all so that the first corner is at the origin, and gives where it was.
    pub(crate) fn moved_to_origin(&mut self) -> DVec3 {
        let from = self.0[0].at;
        for sector in &mut self.0 {
            sector.at -= from;
            sector
                .neighbours
                .iter_mut()
                .for_each(|point| *point -= from);
            if let Far::Mean { mean, .. } = &mut sector.far {
                *mean -= from;
            }
        }
        from
    }

    /// The points after one refinement.
    pub(crate) fn refined(&self, rules: &Rules) -> RefinedSectors<'_> {
        let moved = [0, 1, 2].map(|corner| self.0[corner].moved(rules));
        let (edge_points, rings) = (Default::default(), [[DVec3::ZERO; 6]; 3]);
        let mut refined = RefinedSectors {
            sectors: self,
            moved,
            edge_points,
            rings,
            is_crease: [false; 3],
        };
        let points = refined.edge_points.iter_mut();
        points
            .zip(&self.0)
            .for_each(|(points, sector)| sector.add_edge_points(points));
        for edge in 0..3 {
            let beyond = refined.beyond(edge);
            refined.is_crease[edge] = beyond.is_none();
            let [end, on_next, on_last, start] = refined.before_middle(edge);
            refined.rings[edge] = match beyond {
                Some([first, second]) => [end, on_next, on_last, start, first, second],
                None => mirrored(refined.middle(edge), [end, on_next, on_last, start]),
            };
        }
        refined
    }
}

/// The points around the four parts of an irregular face.
pub struct RefinedSectors<'a> {
    sectors: &'a SectorPatch,
    moved: [DVec3; 3],
    edge_points: [Neighbours; 3],
    /// The neighbours of the new points on the edges: from the edge's end over the face to its start, and on beyond the edge, where they
    /// are mirrored if it is sharp or a boundary.
    rings: [[DVec3; 6]; 3],
    is_crease: [bool; 3],
}

impl RefinedSectors<'_> {
    /// The new point on the edge from corner `edge`.
    fn middle(&self, edge: usize) -> DVec3 {
        self.edge_points[edge][self.sectors.0[edge].slot]
    }

    /// Its neighbours beyond the edge; `None` if that is sharp or a boundary.
    fn beyond(&self, edge: usize) -> Option<[DVec3; 2]> {
        let next = (edge + 1) % 3;
        let (from, to) = (&self.sectors.0[edge], &self.sectors.0[next]);
        if from.is_sharp(from.slot) || to.is_sharp(to.neighbour(1)) {
            return None;
        }
        Some([
            self.edge_points[edge][from.neighbour(-1)],
            self.edge_points[next][to.neighbour(2)],
        ])
    }

    /// Those over the face, from the edge's end to its start.
    fn before_middle(&self, edge: usize) -> [DVec3; 4] {
        let (next, last) = ((edge + 1) % 3, (edge + 2) % 3);
        [
            self.moved[next],
            self.middle(next),
            self.middle(last),
            self.moved[edge],
        ]
    }

    /// The sector of the new point on the edge from corner `edge`, with the face that starts at neighbour `slot`.
    fn middle_sector(&self, edge: usize, slot: usize) -> VertexSector {
        let (count, centre) = match self.is_crease[edge] {
            true => (4, Centre::Crease),
            false => (6, Centre::Smooth { sharp: None }),
        };
        let neighbours = Neighbours::from_slice(&self.rings[edge][..count]);
        VertexSector {
            at: self.middle(edge),
            neighbours,
            centre,
            slot,
            far: Far::Kept,
        }
    }

    /// The new point on the edge from corner `edge` and its six neighbours: new points are always regular.
    pub(crate) fn regular_middle(&self, edge: usize) -> (DVec3, [DVec3; 6]) {
        (self.middle(edge), self.rings[edge])
    }

    /// A part in its simplest form, without its sectors where these can be done without.
    pub(crate) fn piece(&self, part: usize) -> Patch {
        if let Some(points) = self.points(part) {
            return Patch::Regular(points);
        }
        match self.extraordinary(part) {
            Some(piece) => Patch::of_extraordinary(piece),
            None if self.sectors.0[part].far == Far::Kept => {
                Patch::Sectors(Box::new(self.part(part)))
            }
            None => Patch::of(self.part(part)),
        }
    }

    /// A part that is not regular but has all of its vertex' ring, which is closed and smooth.
    pub(crate) fn extraordinary(&self, part: usize) -> Option<ExtraordinaryPatch> {
        let (old, own) = (self.sectors.0.get(part)?, &self.edge_points[part]);
        if old.far != Far::Kept || old.centre != (Centre::Smooth { sharp: None }) || own.len() < 3 {
            return None;
        }
        let [on_next, on_last] = [&self.rings[part], &self.rings[(part + 2) % 3]];
        let mut ring = Neighbours::from_slice(&own[old.slot..]);
        ring.extend_from_slice(&own[..old.slot]);
        let outer = [on_next[5], on_next[0], on_next[1], on_last[3], on_last[4]];
        Some(ExtraordinaryPatch {
            corner: part,
            at: self.moved[part],
            ring,
            outer,
        })
    }

    /// The points of a part, if it is regular.
    pub(crate) fn points(&self, part: usize) -> Option<Points> {
        let Self { rings, moved, .. } = self;
        if part == 3 {
            let corners = [1, 2, 0].map(|edge| self.middle(edge));
            return Some(box_spline::assemble(
                corners,
                [&rings[1], &rings[2], &rings[0]],
                [1; 3],
            ));
        }
        let (old, last) = (&self.sectors.0[part], (part + 2) % 3);
        let own = &regular_ring(
            old.far,
            old.centre,
            moved[part],
            &self.edge_points[part],
            old.slot,
        )?;
        let mut corners = [moved[part], self.middle(part), self.middle(last)];
        let (mut own_rings, mut turns) = ([own, &rings[part], &rings[last]], [0, 2, 0]);
        corners.rotate_right(part);
        own_rings.rotate_right(part);
        turns.rotate_right(part);
        Some(box_spline::assemble(corners, own_rings, turns))
    }

    /// Whether a part is regular: new points are, old ones stay what they were.
    pub(crate) fn is_regular(&self, part: usize) -> bool {
        part == 3 || self.sectors.0[part].regular_ring().is_some()
    }

    /// The sectors of a part; numbered as [`box_spline::Refined::part`] does.
    pub(crate) fn part(&self, part: usize) -> SectorPatch {
        // Around the middle of an edge the parts follow each other: the end's, the middle one, the start's.
        if part == 3 {
            return SectorPatch([1, 2, 0].map(|edge| self.middle_sector(edge, 1)));
        }
        let old = &self.sectors.0[part];
        let own = || VertexSector {
            at: self.moved[part],
            neighbours: Neighbours::from_slice(&self.edge_points[part]),
            centre: old.centre,
            slot: old.slot,
            far: match old.far {
                Far::Mean { valence, mean } => Far::Mean {
                    valence,
                    mean: 0.375 * old.at + 0.625 * mean,
                },
                far => far,
            },
        };
        SectorPatch(from_fn(|corner| match (corner + 3 - part) % 3 {
            0 => own(),
            1 => self.middle_sector(part, 2),
            _ => self.middle_sector((part + 2) % 3, 0),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::Loop;

    /// Pieces that are made without sectors equal those of the sectors to the bit.
    #[test]
    fn pieces_are_those_of_the_sectors() {
        let rules = Rules::of(&Loop);
        let mut count = 0.0;
        let mut point = || {
            count += 1.0;
            let t: f64 = count;
            DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
        };
        let centres = [
            Centre::Smooth { sharp: None },
            Centre::Smooth { sharp: Some(1) },
            Centre::Crease,
            Centre::Corner {
                open: true,
                sharp: None,
            },
        ];
        let mut regular = 0;
        for case in 0..2000 {
            let kind = |corner: usize| {
                if case % 3 == 0 {
                    case / 3 / 5usize.pow(corner as u32) % 5
                } else {
                    0
                }
            };
            let sectors = SectorPatch([0, 1, 2].map(|corner| {
                let count = 3 + (case / 7usize.pow(corner as u32)) % 7;
                let centre = centres[kind(corner) % 4];
                let is_open = matches!(centre, Centre::Crease | Centre::Corner { .. });
                let slot = case % (count - usize::from(is_open));
                let neighbours = (0..count).map(|_| point()).collect();
                VertexSector {
                    at: point(),
                    neighbours,
                    centre,
                    slot,
                    far: Far::Kept,
                }
            }));
            let refined = sectors.refined(&rules);
            for part in 0..4 {
                let expected = Patch::of(refined.part(part));
                assert_eq!(
                    format!("{:?}", refined.piece(part)),
                    format!("{expected:?}"),
                    "{case}, {part}"
                );
                let points = refined.points(part).map(|points| format!("{points:?}"));
                let expected = match expected {
                    Patch::Regular(points) => Some(format!("{points:?}")),
                    _ => None,
                };
                assert_eq!(points, expected, "{case}, {part}");
                regular += usize::from(points.is_some());
            }
        }
        assert!(regular > 2000, "{regular}");
    }
}
