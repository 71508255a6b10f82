//! Whether a node may stay whole: a guess from its own piece of the surface alone.
//!
//! A wrong guess costs time, never truth: [`super::measure`] proves each triangle among its neighbours as they are. Much of that is done here:
//! what a triangle's bound needs to know of its neighbours (see [`crate::certificate`]) are the angles between their planes
//! and its own and the angles at their corners. Neighbours share a corner and its limit normal, so the chord between two planes is at
//! most the sum of the chords between each and that normal, their *normal deviations*. Each control face therefore has an
//! [`Allowance`]: the greatest normal deviation and the least angle of the triangles in it and adjacent to it. Where a whole leaf is within the limit
//! on that condition, its bound holds as soon as all these triangles keep the allowance.

use super::back_faces::BackFaces;
use super::backs::{Behind, Leaf};
use super::control::Control;
use super::edge_curves::{Asking, EdgeCurves};
use super::seen::{
    ANY_SLOPES, Allowance, DISPLACEMENT_SHARE, DIVISIONS, Extent, Fate, HALVINGS, NO_CHORDS, Seen,
};
use super::surface::QuarticPiece;
use super::trial::Trial;
use crate::certificate::{
    Cell, Deviation, EdgeBounds, Effort, Heights, NetPart, Pieces, RowTarget, SubTriangle,
    at_a_glance, exceeds,
};
use crate::criterion::Criteria;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{LimitPoint, ParamTriangle, Patch, Rules};
use crate::vector::{DVec3, Extremes};

/// The part of a height that is good enough in spite of rounding.
pub(super) const ROUNDED: f64 = 1.0 - 1e-9;

/// How far triangles may miss the surface before their corners are moved: by half that much afterwards at best.
pub(super) const UNBALANCED: f64 = 1.9;

/// Heights in a range of so many times what is allowed on either side are too much, however corners are moved.
pub(super) const HOPELESS: f64 = 2.0;

/// The limits for the triangles of each control face. Values are distances between a triangle and its part of the surface
/// where nothing else counts ([`super::control::Control::criteria`]), else how many times over the criteria fail.
#[derive(Clone, Debug)]
pub(super) enum Goal {
    /// Greatest value of a triangle.
    Within(f64),
    /// Greatest distance of a triangle once its corners are moved off the surface ([`super::offsets`]): before, it may be nearly twice as far.
    Balanced(f64),
    /// The greatest value of a triangle, and a lesser one for marked faces.
    Partly(f64, f64, Vec<bool>),
}

impl Goal {
    /// The judge of a face's nodes.
    pub(super) fn judge<'a>(&self, control: &'a Control<'_>, face: u32) -> Judge<'a> {
        let is_balanced = matches!(self, Self::Balanced(_)) && control.criteria.is_none();
        Judge {
            rules: control.rules,
            criteria: control.criteria.as_ref(),
            back_faces: &control.back_faces,
            face,
            rim_alone: control.flat.is_its_rim(face),
            asking: Asking::of(control, face),
            limit: match self {
                Self::Balanced(distance) => UNBALANCED * distance,
                _ => self.allowed(face),
            },
            range_share: if is_balanced {
                UNBALANCED / HOPELESS
            } else {
                0.0
            },
            allowance: Allowance::NOTHING,
        }
    }

    /// The greatest value of a triangle over a face in the end.
    pub(super) fn allowed(&self, face: u32) -> f64 {
        match self {
            Self::Within(value) | Self::Balanced(value) => *value,
            Self::Partly(_, less, is_marked) if is_marked[face as usize] => *less,
            Self::Partly(value, ..) => *value,
        }
    }
}

/// The limits for the nodes of a control face.
#[derive(Clone, Copy)]
pub(super) struct Judge<'a> {
    pub(super) rules: &'a Rules<'a>,
    /// The criteria besides distances.
    pub(super) criteria: Option<&'a Criteria>,
    back_faces: &'a BackFaces,
    face: u32,
    /// Whether it is flat and nothing counts but the rim of its region ([`super::flat`]).
    rim_alone: bool,
    /// How its nodes ask for the middles of their edges.
    pub(super) asking: Asking,
    /// Greatest value: a distance where nothing else counts.
    pub(super) limit: f64,
    /// Ranges of heights from one side to the other count by this, as well as the greatest height on one side.
    range_share: f64,
    pub(super) allowance: Allowance,
}

/// The fate of a node, and what its triangle has where it is proven.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdict {
    pub(super) fate: Fate,
    pub(super) extent: Extent,
}

impl Verdict {
    /// That of a triangle that needs no bound.
    const FREE: Self = Self {
        fate: Fate::Proven,
        extent: Extent::NONE,
    };

    pub(super) fn of(fate: Fate) -> Self {
        Self {
            fate,
            extent: Extent::NONE,
        }
    }

    fn is_proven(&self) -> bool {
        self.fate == Fate::Proven
    }
}

impl Judge<'_> {
    /// The bits of the edges for whose middles a node asks that may not stay whole; `None` if it is divided.
    pub(super) fn asked(
        &self,
        corners: &[LimitPoint; 3],
        middles: &[LimitPoint; 3],
        open: [bool; 3],
    ) -> Option<u8> {
        let curves = || EdgeCurves::of(corners, middles, open, self.asking);
        self.asking.may_be.then(curves)?.asked(self.limit)
    }

    /// A node of a regular piece.
    pub(super) fn regular(
        &self,
        quartic: &QuarticPiece,
        domain: ParamTriangle,
        level: u32,
        corners: &[LimitPoint; 3],
        open: [bool; 3],
    ) -> Verdict {
        if self.is_inside(open) {
            return Verdict::FREE;
        }
        let seen = Seen::of(corners);
        let net = || quartic.net(domain, SubTriangle::Whole);
        if self.rim_alone {
            return self.along_rim(net().deviation(
                &seen.frame,
                self.rules,
                Effort::along_rim(self.limit, open),
            ));
        }
        let cell = Cell(domain.corners());
        if let Some(criteria) = self.criteria {
            let behind = self.behind(Leaf::Regular(quartic, domain));
            let trial = Trial::of(criteria, self.limit, &seen, corners, &behind).at_level(level);
            return Verdict::of(trial.regular(quartic, net, &cell, open, self.rules));
        }
        let heights = quartic.jet().heights(&cell, seen.frame.normal());
        let (low, high) = heights.range();
        let counted = if self.range_share > 0.0 {
            low.larger(self.range_share * heights.least_range())
        } else {
            low
        };
        if exceeds(counted, self.limit) {
            return Verdict::of(Fate::Fails);
        }
        let by_piece = quartic.jet().edge_bounds(&cell, &seen.frame, open);
        let verdict = self.decided(&seen, by_piece.deviation(high));
        if verdict.is_proven() {
            return verdict;
        }
        // By what the part itself has, not all of its piece.
        let edges = quartic
            .jet()
            .closer_edge_bounds(&by_piece, &cell, &seen.frame, open);
        if edges.is_loose() {
            return self.by_net(&seen, &net(), &heights, high, open);
        }
        let verdict = self.decided(&seen, edges.deviation(high));
        if verdict.is_proven() {
            return verdict;
        }
        self.by_heights(&seen, &edges, &heights, low)
    }

    /// A node whose curves are known, by heights that are refined where the least of them would do.
    fn by_heights(&self, seen: &Seen, edges: &EdgeBounds, heights: &Heights, low: f64) -> Verdict {
        let least = edges.deviation(low);
        if exceeds(least.bound(NO_CHORDS, ANY_SLOPES), self.limit) {
            return Verdict::of(Fate::Fails);
        }
        let enough = ROUNDED * least.height_within(self.limit, self.allowed(seen).0);
        self.decided(seen, edges.deviation(heights.refined(DIVISIONS, enough)))
    }

    /// A node whose derivatives do not bound tangential displacements: displacements by the net, heights by the
    /// derivatives, since those of a net are a third too great.
    fn by_net(
        &self,
        seen: &Seen,
        net: &NetPart,
        heights: &Heights,
        high: f64,
        open: [bool; 3],
    ) -> Verdict {
        let (mut deviation, _) = net.at_a_glance(&seen.frame, open);
        if open == [false; 3] {
            let enough = ROUNDED * deviation.height_within(self.limit, self.allowed(seen).0);
            deviation.height = deviation
                .height
                .min(high)
                .min(heights.refined(DIVISIONS, enough));
        }
        let verdict = self.decided(seen, deviation);
        if verdict.is_proven() {
            return verdict;
        }
        let halved = self.decided(
            seen,
            net.deviation(&seen.frame, self.rules, self.effort(seen, open)),
        );
        if halved.fate == Fate::Fails {
            verdict
        } else {
            halved
        }
    }

    /// Whether a node is to be divided whatever else its piece is, since some of its points stand too high.
    pub(super) fn surely_fails(&self, seen: &Seen, points: &[DVec3]) -> bool {
        let height = || self.counted(seen, points.iter().copied());
        self.criteria.is_none() && !self.rim_alone && exceeds(height(), self.limit)
    }

    /// How much the heights of some points count.
    fn counted(&self, seen: &Seen, points: impl Iterator<Item = DVec3>) -> f64 {
        let heights = points.map(|point| seen.frame.height(point));
        let (low, high) = heights.fold((0.0f64, 0.0f64), |(low, high), height| {
            (low.smaller(height), high.larger(height))
        });
        high.larger(-low)
            // The range of heights at a few points of a piece is about 0.8 of the whole range.
            .larger(self.range_share / 0.8 * (high - low))
    }

    /// A regular piece, as far as its net decides at a glance.
    pub(super) fn at_a_glance(
        &self,
        net: &BezierTriangle,
        seen: &Seen,
        open: [bool; 3],
    ) -> Option<Verdict> {
        if self.rim_alone || self.criteria.is_some() {
            return None;
        }
        let (deviation, attained) = at_a_glance(net, &seen.frame, open);
        if exceeds(attained, self.limit) {
            return Some(Verdict::of(Fate::Fails));
        }
        // Heights of both signs count alike.
        let may_be_uneven = 2.0 * self.range_share * deviation.height > self.limit;
        Some(self.decided(seen, deviation)).filter(|verdict| verdict.is_proven() && !may_be_uneven)
    }

    /// A piece of any kind.
    pub(super) fn general<'p>(
        &'p self,
        pieces: &mut Pieces<'p>,
        level: u32,
        corners: &[LimitPoint; 3],
        open: [bool; 3],
    ) -> Verdict {
        if self.is_inside(open) {
            return Verdict::FREE;
        }
        let (seen, part) = (Seen::of(corners), SubTriangle::Whole);
        if self.rim_alone {
            let effort = Effort::along_rim(self.limit, open);
            return self.along_rim(pieces.deviation(part, &seen.frame, self.rules, effort));
        }
        if let Some(criteria) = self.criteria {
            let behind = self.behind(Leaf::General(pieces.patch(), self.rules));
            let trial = Trial::of(criteria, self.limit, &seen, corners, &behind).at_level(level);
            return Verdict::of(trial.general(pieces, open, self.rules));
        }
        self.decided(
            &seen,
            pieces.deviation(part, &seen.frame, self.rules, self.effort(&seen, open)),
        )
    }

    /// Whether a node with these open edges is inside of a rim that alone counts.
    pub(super) fn is_inside(&self, open: [bool; 3]) -> bool {
        self.rim_alone && open == [false; 3]
    }

    /// The fate of a node of whose edges those on the rim count alone.
    fn along_rim(&self, deviation: Deviation) -> Verdict {
        let bound = deviation.own;
        let fate = if bound <= self.limit {
            Fate::Proven
        } else {
            Fate::Fails
        };
        Verdict {
            fate,
            extent: Extent {
                bound,
                ..Extent::NONE
            },
        }
    }

    fn behind<'p>(&'p self, leaf: Leaf<'p>) -> Behind<'p> {
        Behind {
            faces: self.back_faces,
            face: self.face,
            leaf,
        }
    }

    /// The effort for a bound.
    fn effort(&self, seen: &Seen, open: [bool; 3]) -> Effort {
        let chords = self.allowed(seen).0;
        // A guess: neighbours have angles like the triangle's own.
        let slopes = [0, 1, 2].map(|edge| seen.frame.slope_at(edge).min(1.0));
        Effort {
            target: self.limit,
            halvings: HALVINGS,
            open,
            rim_alone: false,
            chords,
            slopes,
            // A node that will be divided needs no bound.
            gives_up: true,
            least_chord: Some(0.0),
        }
    }

    /// The fate of a node with this deviation.
    fn decided(&self, seen: &Seen, deviation: Deviation) -> Verdict {
        let (chords, slopes) = self.allowed(seen);
        let bound = deviation.bound(chords, slopes);
        if bound <= self.limit {
            // Drifts that are too steep are not counted on.
            let displacement_slope = if deviation.is_within(slopes) {
                deviation.steepest()
            } else {
                0.0
            };
            return Verdict {
                fate: Fate::Proven,
                extent: Extent {
                    bound,
                    displacement_slope,
                    ..seen.extent()
                },
            };
        }
        let fails = exceeds(deviation.bound(NO_CHORDS, ANY_SLOPES), self.limit);
        Verdict::of(if fails { Fate::Fails } else { Fate::Likely })
    }

    /// The chords of the angles to the neighbours and the greatest slopes of tangential displacements, by edge, that the allowance makes certain.
    #[inline]
    fn allowed(&self, seen: &Seen) -> ([f64; 3], [f64; 3]) {
        let Allowance {
            normal_deviation,
            slope,
        } = self.allowance;
        (
            [seen.normal_deviation + normal_deviation; 3],
            seen.own_slopes().map(|own| own.min(slope)),
        )
    }

    /// The limits for rows of nodes.
    pub(super) fn row_target(&self) -> RowTarget {
        let Allowance {
            normal_deviation,
            slope,
        } = self.allowance;
        RowTarget {
            distance: self.limit,
            normal_deviation,
            slope,
            range_share: self.range_share,
            displacement_share: DISPLACEMENT_SHARE,
        }
    }

    /// Whether a node may stay whole, as far as some points of its piece tell.
    pub(super) fn may_stay(
        &self,
        patch: &Patch,
        corners: &[LimitPoint; 3],
        points: &[LimitPoint],
        level: u32,
    ) -> bool {
        let seen = Seen::of(corners);
        let height = self.counted(&seen, points.iter().map(|point| point.position));
        match self.criteria {
            None => height <= self.limit,
            Some(criteria) => {
                let behind = self.behind(Leaf::General(patch, self.rules));
                !Trial::of(criteria, self.limit, &seen, corners, &behind)
                    .at_level(level)
                    .is_lost(height)
            }
        }
    }

    /// Whether whole rows of nodes can be tested at once.
    pub(super) fn has_rows(&self) -> bool {
        self.criteria.is_none()
    }
}
