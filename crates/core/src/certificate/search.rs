//! The search for the bound of one triangle, by the nets of regular pieces, halved where that
//! helps, and by pieces at irregular vertices, refined where they are not good enough as they are.
//! The sum is proven in [`super::bounds`].

mod irregular;
mod quad;

use super::borders::{Borders, INSIDE};
use super::deviation::Deviation;
use super::effort::Effort;
use super::exceeds;
use super::hull_points::{DeviationBound, HullPoint};
use super::net::Net;
use super::net_part::NetPart;
use super::sub_triangle::SubTriangle;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::bicubic::Bicubic;
use crate::patch::extraordinary::{ExtraordinaryPatch, RefinedExtraordinary};
use crate::patch::{Patch, Points, RefinedPatch, Rules};

pub(crate) use quad::QuadPieces;

/// Pieces that reach this many times as far as the target will not pass; bounds of others stay
/// tight, so that they can be compared even if they may not be split.
const HOPELESS: f64 = 1.5;

/// A part of a refinement by its number, the sub-part, and its edges relative to the triangle.
type PartOf = (usize, SubTriangle, Borders);

/// A refined piece, whose parts a bound uses as they exist.
pub(super) trait Parts<P: HullPoint> {
    fn is_regular(&self, part: usize) -> bool;

    /// Bounds a part.
    fn look(&self, search: &mut Search<'_, P>, part: PartOf, depth: usize);
}

impl<P: HullPoint> Parts<P> for RefinedPatch<'_> {
    fn is_regular(&self, part: usize) -> bool {
        self.is_regular(part)
    }

    fn look(&self, search: &mut Search<'_, P>, (part, of_part, borders): PartOf, depth: usize) {
        if let Some(points) = self.points(part) {
            search.regular_in_space(&points, of_part, borders);
        } else if let Some(piece) = self.extraordinary(part) {
            let piece = search.seen(&piece);
            search.extraordinary(&piece, of_part, borders, depth);
        } else {
            search.part(&self.part(part), of_part, borders, depth);
        }
    }
}

impl<P: HullPoint> Parts<P> for RefinedExtraordinary<P> {
    fn is_regular(&self, part: usize) -> bool {
        self.is_regular(part)
    }

    fn look(&self, search: &mut Search<'_, P>, (part, of_part, borders): PartOf, depth: usize) {
        match self.places(part) {
            // In place: copies of many are not free.
            Some(places) => {
                let points: [P; 12] = core::array::from_fn(|i| self.near(places[i]));
                search.regular(&points, of_part, borders);
            }
            None => search.extraordinary(self.own(), of_part, borders, depth),
        }
    }
}

/// The bound of one triangle as it grows, piece by piece.
pub(super) struct Search<'a, P: HullPoint> {
    bound: DeviationBound<'a, P>,
    rules: &'a Rules<'a>,
    effort: Effort,
    pub(super) found: Deviation,
}

impl<'a, P: HullPoint> Search<'a, P> {
    pub(super) fn of(bound: DeviationBound<'a, P>, rules: &'a Rules<'a>, effort: Effort) -> Self {
        Self {
            bound,
            rules,
            effort,
            found: Deviation::default(),
        }
    }

    /// A piece relative to the triangle.
    pub(super) fn seen(&self, piece: &ExtraordinaryPatch) -> ExtraordinaryPatch<P> {
        piece.map(|point| P::of(self.bound.frame, point))
    }

    /// The net of a piece, or of a part of one.
    pub(super) fn own_net(&mut self, part: &NetPart) {
        self.net(
            &part.seen(self.bound.frame),
            part.borders,
            self.effort.halvings,
        );
    }

    /// A part of a piece without derived data.
    pub(super) fn part(
        &mut self,
        patch: &Patch,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        match (patch, part) {
            (_, SubTriangle::Child(child)) => {
                self.refined(
                    &patch.refined(self.rules),
                    (child, SubTriangle::Whole, borders),
                    depth + 1,
                );
            }
            (Patch::Regular(points), _) => self.regular_in_space(points, part, borders),
            (Patch::Extraordinary(piece), _) => {
                let piece = self.seen(piece);
                self.extraordinary(&piece, part, borders, depth);
            }
            (Patch::Bicubic(piece), _) => self.bicubic(piece, part, borders),
            (Patch::Sectors(_) | Patch::Pole(_) | Patch::SemiSharp(_) | Patch::Quad(_), _) => {
                if !self.is_settled(patch, part, borders, depth) {
                    self.divided(&patch.refined(self.rules), part, borders, depth);
                }
            }
            // Their points' hull holds nothing.
            (Patch::Mesh(_), _) => self.add(Deviation::alone(f64::INFINITY)),
        }
    }

    /// A part of a refinement, as it exists.
    pub(super) fn refined(&mut self, refined: &impl Parts<P>, part: PartOf, depth: usize) {
        if self.counts(part.2) {
            refined.look(self, part, depth);
        }
    }

    /// A part of a bicubic piece.
    fn bicubic(&mut self, piece: &Bicubic, part: SubTriangle, borders: Borders) {
        let frame = self.bound.frame;
        let seen = |point| P::of(frame, point);
        let net = match part {
            SubTriangle::Whole => piece.part_net_of(seen),
            _ => {
                let corners = piece.part.corners();
                let middles = [0, 1, 2].map(|edge| piece.part.along(edge, 0.5));
                piece.net(part.corners(corners, middles), seen)
            }
        };
        self.net(&net, borders, self.effort.halvings);
    }

    fn regular_in_space(&mut self, points: &Points, part: SubTriangle, borders: Borders) {
        let mut seen = [P::default(); 12];
        seen.iter_mut()
            .zip(points)
            .for_each(|(seen, &point)| *seen = P::of(self.bound.frame, point));
        self.regular(&seen, part, borders);
    }

    fn regular(&mut self, points: &[P; 12], part: SubTriangle, borders: Borders) {
        let net = BezierTriangle::of(points);
        let halvings = self.effort.halvings;
        match part {
            SubTriangle::Whole | SubTriangle::Child(_) => self.net(&net, borders, halvings),
            _ => {
                let part = NetPart::of(&net, part, borders);
                self.net(&part.net, part.borders, halvings);
            }
        }
    }

    /// The value of a deviation.
    fn value(&self, deviation: &Deviation) -> f64 {
        deviation.bound(self.effort.chords, self.effort.slopes)
    }

    /// The value that is good enough for the rest: values below the present bound add nothing.
    fn aim(&self) -> f64 {
        self.effort.target.max(self.value(&self.found))
    }

    /// The result so far together with one more deviation.
    fn with(&self, deviation: Deviation) -> Deviation {
        // A slope that is too great must not spoil the bound of others.
        let counts = deviation.is_within(self.effort.slopes);
        self.found.max(if counts {
            deviation
        } else {
            Deviation::alone(deviation.own)
        })
    }

    fn add(&mut self, deviation: Deviation) {
        self.found = self.with(deviation);
        if let Some(chord) = self.effort.least_chord
            && exceeds(
                self.found.bound([chord; 3], self.effort.slopes),
                self.effort.target,
            )
        {
            self.found = Deviation::alone(f64::INFINITY);
        }
    }

    /// Whether a piece with these borders adds anything.
    fn counts(&self, borders: Borders) -> bool {
        let is_rim = |border: u8| border != INSIDE && self.effort.open[border as usize];
        !self.effort.rim_alone || borders.into_iter().any(is_rim)
    }

    fn net(&mut self, net: &impl Net<P>, borders: Borders, halvings: usize) {
        if self.found.own == f64::INFINITY || !self.counts(borders) {
            return;
        }
        let (deviation, attained) = net.deviation(&self.bound, borders);
        if self.effort.gives_up && exceeds(attained, self.effort.target) {
            self.add(Deviation::alone(f64::INFINITY));
            return;
        }
        // A part that is certainly much too far away stays so however it is divided.
        let is_hopeless = self.effort.target > 0.0 && attained > HOPELESS * self.effort.target;
        if halvings == 0 || is_hopeless || self.value(&deviation) <= self.aim() {
            self.add(deviation);
            return;
        }
        // The longest edge, so that the pieces stay as round as they can be.
        let [a, b, c] = net.corners();
        let lengths = [b - a, c - b, a - c].map(|side| side.length_squared(self.bound.frame));
        let edge = (1..3).fold(0, |longest, edge| {
            if lengths[edge] > lengths[longest] {
                edge
            } else {
                longest
            }
        });
        let halves = net.halves(edge);
        for (half, cut) in halves.iter().zip([(edge + 1) % 3, (edge + 2) % 3]) {
            let mut sides = borders;
            sides[cut] = INSIDE;
            self.net(half, sides, halvings - 1);
        }
    }

    /// A refined piece.
    pub(super) fn divided(
        &mut self,
        refined: &impl Parts<P>,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        match part {
            SubTriangle::Whole => {
                let inner = |part: usize| {
                    let mut sides = borders;
                    sides[(part + 1) % 3] = INSIDE;
                    (part, SubTriangle::Whole, sides)
                };
                self.pieces(
                    refined,
                    [
                        inner(0),
                        inner(1),
                        inner(2),
                        (3, SubTriangle::Whole, [INSIDE; 3]),
                    ],
                    depth,
                );
            }
            SubTriangle::Child(child) => {
                self.pieces(refined, [(child, SubTriangle::Whole, borders)], depth)
            }
            SubTriangle::Half { edge, second } => self.half(refined, edge, second, borders, depth),
            SubTriangle::Quarter { edge, at_end } => {
                self.quarter(refined, edge, at_end, borders, depth)
            }
        }
    }

    /// The pieces that make up a half; see [`SubTriangle::Half`].
    fn half(
        &mut self,
        refined: &impl Parts<P>,
        edge: usize,
        second: bool,
        borders: Borders,
        depth: usize,
    ) {
        let (next, last) = ((edge + 1) % 3, (edge + 2) % 3);
        let half = SubTriangle::Half { edge, second };
        let other = SubTriangle::Half {
            edge,
            second: !second,
        };
        let (mut whole, mut middle, mut tip) = ([INSIDE; 3], [INSIDE; 3], [INSIDE; 3]);
        (tip[next], tip[last]) = (borders[next], borders[last]);
        whole[edge] = borders[edge];
        let kept = if second {
            whole[next] = borders[next];
            middle[next] = borders[last];
            next
        } else {
            whole[last] = borders[last];
            middle[last] = borders[next];
            edge
        };
        self.pieces(
            refined,
            [
                (3, other, middle),
                (kept, SubTriangle::Whole, whole),
                (last, half, tip),
            ],
            depth,
        );
    }

    /// The pieces that make up a quarter; see [`SubTriangle::Quarter`].
    fn quarter(
        &mut self,
        refined: &impl Parts<P>,
        edge: usize,
        at_end: bool,
        borders: Borders,
        depth: usize,
    ) {
        let (end, tip) = ((edge + 1) % 3, (edge + 2) % 3);
        let (mut corner, mut middle) = ([INSIDE; 3], [INSIDE; 3]);
        let (at, cut) = if at_end {
            (corner[edge], corner[end]) = (borders[2], borders[0]);
            (middle[edge], middle[end]) = (borders[1], borders[2]);
            (end, tip)
        } else {
            (corner[tip], corner[edge]) = (borders[2], borders[0]);
            (middle[tip], middle[edge]) = (borders[0], borders[1]);
            (edge, end)
        };
        let own = (
            at,
            SubTriangle::Half {
                edge: cut,
                second: !at_end,
            },
            corner,
        );
        self.pieces(
            refined,
            [
                (
                    3,
                    SubTriangle::Half {
                        edge: cut,
                        second: at_end,
                    },
                    middle,
                ),
                own,
            ],
            depth,
        );
    }

    /// Pieces of the parts of a refinement: the regular ones first, so that little is left to do for the others.
    fn pieces<const N: usize>(
        &mut self,
        refined: &impl Parts<P>,
        pieces: [PartOf; N],
        depth: usize,
    ) {
        for regular in [true, false] {
            for part in pieces
                .into_iter()
                .filter(|part| refined.is_regular(part.0) == regular)
            {
                self.refined(refined, part, depth + 1);
            }
        }
    }
}
