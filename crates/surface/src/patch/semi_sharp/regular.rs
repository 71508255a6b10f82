//! Semi-sharp pieces whose corners have six edges each and no tag of their own: nearly all, after a refinement.
//!
//! They have the twelve points of a regular piece and the sharpness of the fifteen edges at its corners.

use core::array::from_fn;

use super::lasting_twin::Gaps;
use super::{SemiSharpPatch, SemiSharpVertex, rings_twin};
use crate::patch::box_spline::{
    CORNERS, EDGE_POINTS, MIDDLES, PARTS, Points, REFINED_CORNERS, RINGS, Refined, assemble,
};
use crate::patch::{Limit, LimitPoint, Patch, Rules};
use crate::ring::{INFINITELY_SHARP, SharpRing, VertexRule, decremented, present_weight, rule};
use crate::vector::DVec3;

/// No edge.
const NONE: u8 = u8::MAX;

/// The edges at each corner, in the order of [`RINGS`], as places in [`EDGE_POINTS`].
const SPOKES: [[u8; 6]; 3] = {
    let mut spokes = [[NONE; 6]; 3];
    let mut corner = 0;
    while corner < 3 {
        let mut slot = 0;
        while slot < 6 {
            spokes[corner][slot] = edge_between(CORNERS[corner] as u8, RINGS[corner][slot]);
            assert!(spokes[corner][slot] != NONE);
            slot += 1;
        }
        corner += 1;
    }
    spokes
};

/// The place in [`EDGE_POINTS`] of the edge between two of the twelve points.
const fn edge_between(a: u8, b: u8) -> u8 {
    let mut edge = 0;
    while edge < EDGE_POINTS.len() {
        let [from, to] = EDGE_POINTS[edge].1;
        if (from == a && to == b) || (from == b && to == a) {
            return edge as u8;
        }
        edge += 1;
    }
    NONE
}

/// For each edge of a part the edge that it is half of, or [`NONE`].
const PART_EDGES: [[u8; 15]; 4] = {
    let mut halves = [[NONE; 15]; 4];
    let mut part = 0;
    while part < 4 {
        let mut edge = 0;
        while edge < 15 {
            let [a, b] = EDGE_POINTS[edge].1;
            let (a, b) = (PARTS[part][a as usize], PARTS[part][b as usize]);
            halves[part][edge] = half_of(a, b);
            if halves[part][edge] == NONE {
                halves[part][edge] = half_of(b, a);
            }
            edge += 1;
        }
        part += 1;
    }
    halves
};

/// The edge that the line from the refined point `a` to `b` is half of, if `a` is a corner and `b` the new point on it.
const fn half_of(a: u8, b: u8) -> u8 {
    let mut corner = 0;
    while corner < 3 {
        let mut slot = 0;
        while slot < 6 && REFINED_CORNERS[corner] == a {
            let edge = SPOKES[corner][slot];
            if EDGE_POINTS[edge as usize].0 == b {
                return edge;
            }
            slot += 1;
        }
        corner += 1;
    }
    NONE
}

/// A face whose corners have six edges each, and how sharp these are.
#[derive(Clone, Debug)]
pub struct RegularSemiSharp {
    pub(super) points: Points,
    /// By place in [`EDGE_POINTS`].
    edges: [f64; 15],
}

impl RegularSemiSharp {
    /// The face with those corners, if they are such.
    pub(crate) fn of(corners: &[SemiSharpVertex; 3]) -> Option<Self> {
        let is_plain = |corner: &SemiSharpVertex| {
            !corner.sharp.open
                && corner.sharp.vertex == 0.0
                && corner.neighbours.len() == 6
                && corner.whole.is_none()
        };
        if !corners.iter().all(is_plain) {
            return None;
        }
        let mut edges = [0.0; 15];
        for (corner, places) in corners.iter().zip(&SPOKES) {
            for (slot, &edge) in places.iter().enumerate() {
                edges[edge as usize] = corner.sharp.spokes[(corner.slot + slot) % 6];
            }
        }
        let ring =
            |corner: &SemiSharpVertex| from_fn(|slot| corner.neighbours[(corner.slot + slot) % 6]);
        let points = assemble(
            corners.each_ref().map(|corner| corner.at),
            corners.each_ref().map(ring).each_ref(),
            [0; 3],
        );
        Some(Self { points, edges })
    }

    fn spokes(&self, corner: usize) -> [f64; 6] {
        SPOKES[corner].map(|edge| self.edges[edge as usize])
    }

    /// The corners with their rings.
    fn corners(&self) -> [SemiSharpVertex; 3] {
        [0, 1, 2].map(|corner| SemiSharpVertex {
            at: self.points[CORNERS[corner]],
            neighbours: RINGS[corner]
                .iter()
                .map(|&at| self.points[at as usize])
                .collect(),
            sharp: SharpRing {
                open: false,
                vertex: 0.0,
                spokes: self.spokes(corner).to_vec(),
            },
            slot: 0,
            whole: None,
        })
    }

    /// The piece that this would be if semi-sharp edges were infinitely sharp, and how far that is from it at most, over the same parameter.
    pub(super) fn infinitely_sharp_twin(&self, rules: &Rules<'_>) -> Option<(Patch, f64)> {
        let mut rings = RINGS.map(|ring| ring.map(|at| self.points[at as usize]));
        let is_regular = |corner: usize| {
            mirror(
                self.points[CORNERS[corner]],
                &mut rings[corner],
                &self.spokes(corner),
            )
        };
        if !(0..3).all(is_regular) {
            return rings_twin(&self.corners(), rules);
        }
        let fading = self
            .edges
            .iter()
            .copied()
            .filter(|&sharpness| decremented(sharpness) != sharpness);
        let mut gaps = Gaps::new(fading.fold(INFINITELY_SHARP, f64::min));
        let mut kink = 0.0f64;
        for (&(_, [v, w], [a, b]), _) in EDGE_POINTS
            .iter()
            .zip(&self.edges)
            .filter(|(_, sharpness)| **sharpness > 0.0)
        {
            let [v, w, a, b] = [v, w, a, b].map(|at| self.points[at as usize]);
            kink = kink.max(((v - a) + (w - b)).length_squared());
        }
        gaps.add_kink(kink.sqrt());
        Some((
            Patch::Regular(assemble(
                CORNERS.map(|at| self.points[at]),
                rings.each_ref(),
                [0; 3],
            )),
            gaps.apart(),
        ))
    }

    /// The simplest form of the piece.
    fn settled(self) -> Patch {
        if self.edges == [0.0; 15] {
            return Patch::Regular(self.points);
        }
        if self
            .edges
            .iter()
            .all(|&sharpness| decremented(sharpness) == sharpness)
        {
            return SemiSharpPatch::of(self.corners());
        }
        Patch::SemiSharp(Box::new(SemiSharpPatch::Regular(self)))
    }

    /// Where a corner moves.
    fn moved(&self, corner: usize) -> DVec3 {
        let spokes = self.spokes(corner);
        let at = self.points[CORNERS[corner]];
        let ring = RINGS[corner].map(|place| self.points[place as usize]);
        let as_sharp_as = |spokes: &[f64; 6]| match rule(false, 0.0, spokes) {
            VertexRule::Corner => at,
            VertexRule::Crease => {
                let ends = ring
                    .iter()
                    .zip(spokes)
                    .filter(|&(_, &sharpness)| sharpness > 0.0);
                0.75 * at + 0.125 * ends.map(|(end, _)| end).sum::<DVec3>()
            }
            VertexRule::Smooth | VertexRule::Dart => {
                0.625 * at + 0.0625 * ring.iter().sum::<DVec3>()
            }
        };
        let (now, after) = (present_weight(0.0, &spokes), spokes.map(decremented));
        if now == 1.0 || rule(false, 0.0, &spokes) == rule(false, 0.0, &after) {
            return as_sharp_as(&spokes);
        }
        now * as_sharp_as(&spokes) + (1.0 - now) * as_sharp_as(&after)
    }

    /// The points after one refinement.
    pub(super) fn refined(&self) -> RefinedRegular {
        let mut points = [DVec3::ZERO; 18];
        for (&(at, [a, b], [c, d]), &sharpness) in EDGE_POINTS.iter().zip(&self.edges) {
            let [a, b, c, d] = [a, b, c, d].map(|place| self.points[place as usize]);
            let sharp = sharpness.clamp(0.0, 1.0);
            let smooth = 0.375 * (a + b) + 0.125 * (c + d);
            points[at as usize] = if sharp == 0.0 {
                smooth
            } else {
                sharp * 0.5 * (a + b) + (1.0 - sharp) * smooth
            };
        }
        for corner in 0..3 {
            points[REFINED_CORNERS[corner] as usize] = self.moved(corner);
        }
        RefinedRegular {
            points: Refined(points),
            edges: self.edges.map(decremented),
        }
    }
}

/// Replaces the neighbours beyond the crease through a vertex, seen from the face between neighbours 0 and 1, by their mirror
/// images, with which the ring is smooth; says whether sharp edges are opposite, or none.
fn mirror(at: DVec3, ring: &mut [DVec3; 6], spokes: &[f64; 6]) -> bool {
    let first = match spokes.map(|sharpness| sharpness > 0.0) {
        [false, false, false, false, false, false] => return true,
        [true, false, false, true, false, false] => 0,
        [false, true, false, false, true, false] => 4,
        [false, false, true, false, false, true] => 5,
        _ => return false,
    };
    let [a, b, c, d] = from_fn(|slot| ring[(first + slot) % 6]);
    ring[(first + 4) % 6] = at + d - c;
    ring[(first + 5) % 6] = at + a - b;
    true
}

/// The points around the four parts of such a face.
pub struct RefinedRegular {
    points: Refined,
    /// How sharp the halves of the edges are.
    edges: [f64; 15],
}

impl RefinedRegular {
    /// A part; numbered as [`Refined::part`] does.
    pub(super) fn part(&self, part: usize) -> Patch {
        let sharpness = |edge: u8| self.edges.get(edge as usize).copied().unwrap_or(0.0);
        RegularSemiSharp {
            points: self.points.part(part),
            edges: PART_EDGES[part].map(sharpness),
        }
        .settled()
    }

    /// The limit of the new vertex on the edge from corner `edge`, on the face's side.
    pub(super) fn middle(&self, edge: usize, rules: &Rules<'_>) -> LimitPoint {
        let (at, mut ring) = self.points.middle(edge);
        let along = self.edges[SPOKES[edge][0] as usize];
        if along == 0.0 {
            return LimitPoint::regular(at, &ring);
        }
        // From the edge's end on, with the face between that and the next.
        let end = REFINED_CORNERS[(edge + 1) % 3];
        let start = MIDDLES[edge]
            .1
            .iter()
            .position(|&place| place == end)
            .unwrap_or(0);
        ring.rotate_left(start);
        let sharp = SharpRing {
            open: false,
            vertex: 0.0,
            spokes: vec![along, 0.0, 0.0, along, 0.0, 0.0],
        };
        SemiSharpVertex {
            at,
            neighbours: ring.to_vec(),
            sharp,
            slot: 0,
            whole: None,
        }
        .limit(rules)
    }
}
