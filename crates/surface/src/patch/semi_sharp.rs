//! Pieces at semi-sharp tags (DeRose, Kass and Truong 1998): a face of the Loop family with the whole rings of its
//! three corners and how sharp their edges are.
//!
//! The rules are OpenSubdiv's (see [`SharpRing`]). Within the family a new point on an edge depends on that edge's
//! sharpness alone and a vertex's on its own ring's, so that one refinement follows from the masks directly. New
//! vertices have six edges, of which two may stay sharp for a while. As soon as nothing at a part's corners is semi-sharp any
//! more, it takes the form of other pieces. Of rings of very many edges pieces have the part near the face; what the rules ask of the
//! others is found once for all faces ([`WholeRing`]).

mod lasting_twin;
mod regular;
mod whole_ring;

use lasting_twin::Gaps;
use regular::{RefinedRegular, RegularSemiSharp};
use whole_ring::PartOfRing;
pub(super) use whole_ring::WholeRing;

use super::sector::{Centre, Far, SectorPatch, VertexSector};
use super::{Limit, LimitPoint, Rules};
use super::{Patch, box_spline};
use crate::index::HalfEdgeId;
use crate::mesh::{Mesh, Sharpness};
use crate::ring::{INFINITELY_SHARP, SharpRing, VertexRule, decremented};
use crate::vector::{DVec3, vector};

/// A vertex with its neighbours, counter-clockwise, and the sharpness of the edges to them.
#[derive(Clone, Debug)]
pub struct SemiSharpVertex {
    at: DVec3,
    neighbours: Vec<DVec3>,
    sharp: SharpRing,
    /// The neighbour that is the face's next corner; the one after it is the corner after that.
    slot: usize,
    /// Which part of its ring that is, where the ring is too large for all of it to be there.
    whole: Option<PartOfRing>,
}

impl SemiSharpVertex {
    /// The origin of `h`, as a corner of the face of `h`, with all of its ring.
    pub fn of(mesh: &Mesh, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> Self {
        let topology = mesh.topology();
        let vertex = topology.origin(h);
        let at = |v: crate::VertexId| vector(mesh.positions()[v.index()]);
        Self {
            at: at(vertex),
            neighbours: topology.ring(vertex).map(at).collect(),
            sharp: sharpness.ring(vertex),
            slot: topology.slot(h),
            whole: None,
        }
    }

    /// The neighbour `offset` slots on from the face's next corner.
    fn neighbour(&self, offset: isize) -> usize {
        (self.slot as isize + offset).rem_euclid(self.neighbours.len() as isize) as usize
    }

    fn is_semi_sharp(&self) -> bool {
        self.whole.as_ref().map_or_else(
            || self.sharp.semi_sharpness() > 0.0,
            PartOfRing::is_semi_sharp,
        )
    }

    /// The least semi-sharp sharpness; [`INFINITELY_SHARP`] without one.
    fn least_semi_sharpness(&self) -> f64 {
        self.whole.as_ref().map_or_else(
            || self.sharp.least_semi_sharpness(),
            PartOfRing::least_semi_sharpness,
        )
    }

    /// Where the centre moves by the rules of a ring as sharp as `sharp`.
    fn moved_as(&self, sharp: &SharpRing, rules: &Rules<'_>) -> DVec3 {
        match sharp.rule() {
            VertexRule::Corner => self.at,
            VertexRule::Crease => {
                let ends = (0..self.neighbours.len()).filter(|&slot| sharp.is_sharp(slot));
                0.75 * self.at + 0.125 * ends.map(|slot| self.neighbours[slot]).sum::<DVec3>()
            }
            VertexRule::Smooth | VertexRule::Dart => {
                let valence = self.neighbours.len();
                let beta = rules.beta(valence);
                (1.0 - valence as f64 * beta) * self.at
                    + beta * self.neighbours.iter().sum::<DVec3>()
            }
        }
    }

    /// Where the centre moves, given its ring as sharp as it will be: between both rules where one is about to change.
    fn moved(&self, after: &SharpRing, rules: &Rules<'_>) -> DVec3 {
        let now = self.sharp.present_weight();
        if now == 1.0 || self.sharp.rule() == after.rule() {
            return self.moved_as(&self.sharp, rules);
        }
        now * self.moved_as(&self.sharp, rules) + (1.0 - now) * self.moved_as(after, rules)
    }

    /// The new vertex on the edge to the neighbour in `slot`: between the middle and the smooth one where the edge is
    /// about to become smooth.
    fn edge_point(&self, slot: usize) -> DVec3 {
        let count = self.neighbours.len();
        let end = self.neighbours[slot];
        let sharp = self.sharp.spokes[slot].clamp(0.0, 1.0);
        let middle = 0.5 * (self.at + end);
        if sharp == 1.0 {
            return middle;
        }
        let before = self.neighbours[if slot == 0 { count - 1 } else { slot - 1 }];
        let after = self.neighbours[if slot + 1 == count { 0 } else { slot + 1 }];
        let smooth = 0.375 * (self.at + end) + 0.125 * (before + after);
        sharp * middle + (1.0 - sharp) * smooth
    }

    /// The vertex after one refinement.
    fn refined(&self, rules: &Rules<'_>) -> Self {
        let sharp = self.sharp.refined();
        let whole = self.whole.as_ref().map(PartOfRing::refined);
        Self {
            at: whole
                .as_ref()
                .map_or_else(|| self.moved(&sharp, rules), PartOfRing::at),
            neighbours: (0..self.neighbours.len())
                .map(|slot| self.edge_point(slot))
                .collect(),
            sharp,
            slot: self.slot,
            whole,
        }
    }

    /// The sector that the face is in, where nothing is semi-sharp.
    pub(super) fn sector(&self) -> VertexSector {
        if let Some(whole) = &self.whole {
            return whole.sector(&self.neighbours, self.slot);
        }
        let count = self.neighbours.len();
        let place = |first: usize| (self.slot + count - first) % count;
        let sectors = self.sharp.sectors();
        let own = sectors
            .iter()
            .find(|sector| place(sector.first) < sector.shape.faces() as usize);
        let Some(own) = own else {
            let centre = Centre::Smooth { sharp: None };
            return VertexSector {
                at: self.at,
                neighbours: self.neighbours.iter().copied().collect(),
                centre,
                slot: self.slot,
                far: Far::Kept,
            };
        };
        let around =
            (0..own.shape.valence as usize).map(|i| self.neighbours[(own.first + i) % count]);
        VertexSector {
            at: self.at,
            neighbours: around.collect(),
            centre: Centre::of(own.shape),
            slot: place(own.first),
            far: Far::Kept,
        }
    }

    /// The limit of a new vertex, on the side of the face.
    fn limit(mut self, rules: &Rules<'_>) -> LimitPoint {
        while self.is_semi_sharp() {
            self = self.refined(rules);
        }
        let sector = self.sector();
        // New vertices are regular; those on boundaries and creases once they are mirrored.
        LimitPoint::regular(sector.at, &sector.regular_ring().unwrap_or([sector.at; 6]))
    }
}

/// A face of which one corner at least is semi-sharp.
#[derive(Clone, Debug)]
pub enum SemiSharpPatch {
    /// Its corners, whatever they are.
    Rings([SemiSharpVertex; 3]),
    /// All corners are regular but for sharp edges.
    Regular(RegularSemiSharp),
}

impl SemiSharpPatch {
    /// The simplest form of the face with those corners.
    pub fn of(corners: [SemiSharpVertex; 3]) -> Patch {
        match corners.iter().any(SemiSharpVertex::is_semi_sharp) {
            true => Patch::SemiSharp(Box::new(match RegularSemiSharp::of(&corners) {
                Some(regular) => Self::Regular(regular),
                None => Self::Rings(corners),
            })),
            false => Patch::of(SectorPatch(corners.each_ref().map(SemiSharpVertex::sector))),
        }
    }

    /// The point of a corner of the face.
    pub(super) fn control_point(&self, corner: usize) -> DVec3 {
        match self {
            Self::Regular(regular) => regular.points[box_spline::CORNERS[corner]],
            Self::Rings(corners) => corners[corner].at,
        }
    }

    /// Calls `visit` for all points, some more than once. Masks are convex combinations of them, so that their hull holds
    /// the piece.
    pub(crate) fn for_each_point(&self, mut visit: impl FnMut(DVec3)) {
        match self {
            Self::Regular(regular) => regular.points.iter().for_each(|&point| visit(point)),
            Self::Rings(corners) => corners.iter().for_each(|corner| {
                visit(corner.at);
                corner.neighbours.iter().for_each(|&point| visit(point));
                corner
                    .whole
                    .iter()
                    .for_each(|whole| whole.for_each_point(corner.slot, &mut visit));
            }),
        }
    }

    /// The piece that this would be if semi-sharp edges were infinitely sharp, and how far that is from it at most, over the same parameter. `None`
    /// where that is not known.
    pub fn infinitely_sharp_twin(&self, rules: &Rules<'_>) -> Option<(Patch, f64)> {
        match self {
            Self::Regular(regular) => regular.infinitely_sharp_twin(rules),
            Self::Rings(corners) => rings_twin(corners, rules),
        }
    }

    /// The points after one refinement.
    pub(crate) fn refined<'a>(&'a self, rules: &'a Rules<'a>) -> RefinedSemiSharp<'a> {
        match self {
            Self::Regular(regular) => RefinedSemiSharp::Regular(regular.refined(), rules),
            Self::Rings(before) => RefinedSemiSharp::Rings(RefinedRings {
                before,
                corners: before.each_ref().map(|corner| corner.refined(rules)),
                rules,
            }),
        }
    }
}

/// [`SemiSharpPatch::infinitely_sharp_twin`] of the face with those corners.
fn rings_twin(corners: &[SemiSharpVertex; 3], rules: &Rules<'_>) -> Option<(Patch, f64)> {
    let least = corners
        .iter()
        .map(SemiSharpVertex::least_semi_sharpness)
        .fold(INFINITELY_SHARP, f64::min);
    let mut gaps = Gaps::new(least);
    for corner in corners.iter().filter(|corner| corner.is_semi_sharp()) {
        gaps.add(corner, rules)?;
    }
    Some((
        Patch::of(SectorPatch(corners.each_ref().map(SemiSharpVertex::sector))),
        gaps.apart(),
    ))
}

/// The points around the four parts of a semi-sharp face.
// Made for each face on the way: boxing it would cost an allocation.
#[allow(clippy::large_enum_variant)]
pub enum RefinedSemiSharp<'a> {
    /// Of any.
    Rings(RefinedRings<'a>),
    /// Of one with regular corners.
    Regular(RefinedRegular, &'a Rules<'a>),
}

impl RefinedSemiSharp<'_> {
    /// A part; numbered as [`super::box_spline::Refined::part`] does.
    pub(crate) fn part(&self, part: usize) -> Patch {
        match self {
            Self::Rings(refined) => refined.part(part),
            Self::Regular(refined, _) => refined.part(part),
        }
    }

    /// The limit of the new vertex on the edge from corner `edge`, on the face's side.
    pub(crate) fn middle(&self, edge: usize) -> LimitPoint {
        match self {
            Self::Rings(refined) => refined.middle(edge),
            Self::Regular(refined, rules) => refined.middle(edge, rules),
        }
    }
}

/// The corners of a face with the new points around them, and what they were before.
pub struct RefinedRings<'a> {
    before: &'a [SemiSharpVertex; 3],
    corners: [SemiSharpVertex; 3],
    rules: &'a Rules<'a>,
}

impl RefinedRings<'_> {
    /// The new point on the edge from corner `edge`.
    fn on_edge(&self, edge: usize) -> DVec3 {
        let corner = &self.corners[edge];
        corner.neighbours[corner.slot]
    }

    /// The new vertex on the edge from corner `edge`, as a corner of the face that starts at neighbour `slot`. Its
    /// neighbours go from the edge's end over the face to its start, and on beyond the edge unless that is sharp for ever.
    fn middle_vertex(&self, edge: usize, slot: usize) -> SemiSharpVertex {
        let (next, last) = ((edge + 1) % 3, (edge + 2) % 3);
        let (from, to) = (&self.corners[edge], &self.corners[next]);
        let near = [to.at, self.on_edge(next), self.on_edge(last), from.at];
        let before = &self.before[edge];
        let sharpness = before.sharp.spokes[before.slot];
        let (at, vertex, along) = (self.on_edge(edge), 0.0, decremented(sharpness));
        if sharpness >= INFINITELY_SHARP {
            let sharp = SharpRing {
                open: true,
                vertex,
                spokes: vec![along, 0.0, 0.0, along],
            };
            return SemiSharpVertex {
                at,
                neighbours: near.to_vec(),
                sharp,
                slot,
                whole: None,
            };
        }
        let beyond = [
            from.neighbours[from.neighbour(-1)],
            to.neighbours[to.neighbour(2)],
        ];
        let sharp = SharpRing {
            open: false,
            vertex,
            spokes: vec![along, 0.0, 0.0, along, 0.0, 0.0],
        };
        SemiSharpVertex {
            at,
            neighbours: [near.as_slice(), &beyond].concat(),
            sharp,
            slot,
            whole: None,
        }
    }

    fn part(&self, part: usize) -> Patch {
        // Around the middle of an edge the parts follow each other: the end's, the middle one, the start's.
        if part == 3 {
            return SemiSharpPatch::of([1, 2, 0].map(|edge| self.middle_vertex(edge, 1)));
        }
        let (on_next, on_last) = (
            self.middle_vertex(part, 2),
            self.middle_vertex((part + 2) % 3, 0),
        );
        let mut corners = [self.corners[part].clone(), on_next, on_last];
        corners.rotate_right(part);
        SemiSharpPatch::of(corners)
    }

    fn middle(&self, edge: usize) -> LimitPoint {
        self.middle_vertex(edge, 0).limit(self.rules)
    }
}

#[cfg(test)]
mod tests;
