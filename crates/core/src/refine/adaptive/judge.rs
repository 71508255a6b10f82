//! Whether a triangle stands well enough for its part of the surface: a value of the triangle alone.
//!
//! What a triangle's bound needs to know of its neighbours (see [`crate::certificate`]) are the angles between their planes
//! and its own and the angles at their corners. Neighbours share a corner and its limit normal, so the chord between two planes is at
//! most the sum of the chords between each and that normal, their *tilts*. Each control face therefore has an
//! [`Allowance`]: how far the triangles in it and beside it may be tilted, and how acute they may be. What is let pass is checked
//! against it face by face, so no triangle has to look at its neighbours.

mod verdict;

use super::backs::{BackFaces, Behind, Leaf};
use super::control::Control;
use super::surface::Ground;
use super::trial::Trial;
use crate::certificate::{
    Cell, Deviation, Effort, Heights, NetPart, Pieces, RowTarget, SubTriangle, TriangleFrame,
    at_a_glance, exceeds,
};
use crate::criterion::Criteria;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{LimitPoint, Patch, Rules, Spot};
use crate::vector::{DVec3, Extremes};
pub(super) use verdict::{Condition, Extent, Outcome, Verdict};

/// Halvings of a net before a triangle is given up: the bound is within some per cent of the truth then.
pub(super) const HALVINGS: usize = 2;

/// The same where nothing can be divided further: then all that is gained is proof.
const LENIENT_HALVINGS: usize = 4;

/// Divisions into four of the heights over a plane, to the same end.
pub(super) const DIVISIONS: u32 = 2;

/// Drifts over an edge are counted on up to this part of what a triangle's own angles there allow, or 1: those of the triangle beyond
/// it may be more acute, closing triangles above all. No more than √2 − 1, so that half of what an angle α leaves of π allows it, too: its
/// tangent is 1 at least where α ≤ π/2, else tan(π − α) times 1/(1 + √(1 + tan²)).
const DRIFT_SHARE: f64 = 0.41;

/// Below this level triangles count on neighbours with angles like their own.
const FEW_LEVELS: u32 = 3;

/// From this level on, triangles that miss by little are divided whatever their neighbours could do for them.
const DEEP: u32 = 5;

/// That goes for chords of the angles to neighbours below this.
const NEARLY_FLAT: f64 = 0.06;

/// And for bounds that are no more than so many times too great.
const NEAR_MISS: f64 = 1.05;

/// What faces count on of those beside them is guessed anew where a distance falls by more than this.
const MOST_TIMES: f64 = 1.5;

/// How far triangles may miss the surface before their corners are moved: by half that much afterwards at best.
pub(super) const UNBALANCED: f64 = 1.9;

/// Heights in a range of so many times what is allowed on either side are too much, however corners are moved.
pub(super) const HOPELESS: f64 = 2.0;

/// The range of heights that a few points of a piece that need not be regular tell is about this part of what there is.
const SEEN: f64 = 0.8;

/// Unit vectors are off by no more than this.
const ROUNDING: f64 = 1e-12;

/// The chord of all tilts that are possible.
pub(super) const ANY_TILT: f64 = 2.0;

/// What triangles count on of those beside them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Allowance {
    /// Triangles beside one are tilted by chords of at most this.
    pub(super) tilt: f64,
    /// Tangents of the angles of triangles beside one are at least this.
    pub(super) slope: f64,
}

impl Allowance {
    /// Nothing is expected of those beside.
    pub(super) const NOTHING: Self = Self {
        tilt: 2.0 * ANY_TILT,
        slope: 0.0,
    };
}

/// What is asked of the triangles of each control face. Values are distances between a triangle and its part of the surface
/// where nothing else counts ([`super::control::Control::criteria`]), else how many times over the criteria fail.
#[derive(Clone, Debug)]
pub(super) enum Goal {
    /// Greatest value of a triangle.
    Within(f64),
    /// Greatest distance of a triangle once its corners are moved off the surface ([`super::offsets`]): before, it may be nearly twice as far.
    Balanced(f64),
    /// The same as [`Self::Within`], and a lesser one for marked faces.
    Partly(f64, f64, Vec<bool>),
    /// All faces divided by so many levels, marked ones once more, whatever comes of it.
    Even(u32, Vec<bool>),
    /// Nothing: all triangles are looked at among their neighbours later.
    Nothing,
}

impl Goal {
    /// The judge of a face's triangles.
    pub(super) fn judge<'a>(
        &self,
        control: &'a Control<'_>,
        max_levels: u32,
        face: u32,
    ) -> Judge<'a> {
        let (distance, is_lenient) = match self {
            Self::Within(distance) => (*distance, false),
            Self::Balanced(distance) => (UNBALANCED * distance, false),
            Self::Partly(_, less, is_finer) if is_finer[face as usize] => (*less, false),
            Self::Partly(distance, ..) => (*distance, false),
            // Bounds as tight as they get.
            Self::Even(..) => (0.0, true),
            Self::Nothing => (f64::INFINITY, true),
        };
        let (rules, criteria) = (control.rules, control.criteria.as_ref());
        let (back_faces, rim_alone) = (&control.back_faces, control.flat.is_its_rim(face));
        let is_balanced = matches!(self, Self::Balanced(_)) && criteria.is_none();
        let range_share = if is_balanced {
            UNBALANCED / HOPELESS
        } else {
            0.0
        };
        Judge {
            rules,
            criteria,
            back_faces,
            face,
            rim_alone,
            max_levels,
            limit: distance,
            range_share,
            is_lenient,
        }
    }

    /// Whether not much less is asked of a face than by another goal, so that what it counted on of those beside it will do.
    pub(super) fn is_near(&self, coarser: &Self, face: u32) -> bool {
        coarser.allowed(face) <= MOST_TIMES * self.allowed(face)
    }

    /// What bounds may come to once the neighbours are known.
    pub(super) fn allowed(&self, face: u32) -> f64 {
        match self {
            Self::Within(distance) => *distance,
            Self::Balanced(distance) => UNBALANCED * distance,
            Self::Partly(_, less, is_finer) if is_finer[face as usize] => *less,
            Self::Partly(distance, ..) => *distance,
            Self::Even(..) | Self::Nothing => f64::INFINITY,
        }
    }
}

/// What is asked of triangles.
#[derive(Clone, Copy)]
pub(super) struct Judge<'a> {
    pub(super) rules: &'a Rules<'a>,
    /// What is asked beside distances.
    pub(super) criteria: Option<&'a Criteria>,
    back_faces: &'a BackFaces,
    /// The control face.
    face: u32,
    /// Whether it is flat and nothing counts but the rim of its region ([`super::flat`]).
    rim_alone: bool,
    /// Levels from which on triangles are not divided, whatever they come to.
    max_levels: u32,
    /// Greatest value: a distance where nothing else counts.
    pub(super) limit: f64,
    /// Ranges of heights from one side to the other count by this, beside the greatest height on one side.
    range_share: f64,
    /// Everything passes, and all that counts is how far it is off among its neighbours.
    is_lenient: bool,
}

impl Judge<'_> {
    /// A triangle over a part of a regular piece: the part of the node at a place, whose domain is given.
    pub(super) fn regular(
        &self,
        ground: &Ground,
        (spot, level, part): (Spot, u32, SubTriangle),
        cell: &Cell,
        corners: &[LimitPoint; 3],
        open: [bool; 3],
        allowance: &Allowance,
    ) -> Verdict {
        if self.is_inside(open) {
            return Verdict::NONE;
        }
        let seen = Seen::of(corners, level);
        let net = || ground.net(spot, part);
        if self.rim_alone {
            return self.along_rim(net().deviation(&seen.frame, self.rules, self.rim_effort(open)));
        }
        if let Some(criteria) = self.criteria {
            let behind = self.behind(Leaf::Regular(ground, spot));
            let test = Trial::of(criteria, self.limit, &seen, corners, &behind);
            return test.regular(ground, net, cell, open, self.rules);
        }
        let heights = ground.jet().heights(cell, seen.frame.normal());
        let (low, high) = heights.range();
        if self.is_lenient {
            let beside = ground.jet().beside(cell, &seen.frame, open);
            let by_derivatives = beside.deviation(heights.refined(DIVISIONS, 0.0).min(high));
            let by_net =
                net().deviation(&seen.frame, self.rules, self.effort(&seen, open, allowance));
            let (chord, slopes) = seen.expected();
            let is_less = by_derivatives.bound(chord, slopes) <= by_net.bound(chord, slopes);
            return self.decided(
                &seen,
                if is_less { by_derivatives } else { by_net },
                allowance,
            );
        }
        let low = if self.range_share > 0.0 {
            low.larger(self.range_share * heights.least_range())
        } else {
            low
        };
        if exceeds(low, self.limit) && !self.is_kept(&seen) {
            return Verdict {
                outcome: Outcome::Fails,
                extent: Extent {
                    bound: low,
                    ..seen.extent()
                },
            };
        }
        let by_piece = ground.jet().beside(cell, &seen.frame, open);
        if !by_piece.is_loose() {
            let verdict = self.decided(&seen, by_piece.deviation(high), allowance);
            if verdict.passes() {
                return verdict;
            }
        }
        // By what the part itself comes to, not all of its piece. Drifts along edges that nobody is beyond, and those that the piece does not
        // tell, are better seen by points.
        let closely = || {
            ground
                .jet()
                .beside_closely(&by_piece, cell, &seen.frame, open)
        };
        let beside = if open == [false; 3] {
            closely()
        } else {
            by_piece
        };
        let verdict = self.decided(&seen, beside.deviation(high), allowance);
        if beside.is_loose() || by_piece.is_loose() && !verdict.passes() {
            return self.by_net_and_heights(&seen, &net(), (&heights, high), open, allowance);
        }
        if !verdict.fails() {
            return verdict;
        }
        // Higher than that it is not; or what fails is not the height.
        let least = self.decided(&seen, beside.deviation(low), allowance);
        if !least.fails() {
            let enough = beside
                .deviation(low)
                .height_within(self.limit, seen.allowed(allowance).0);
            let high = heights.refined(DIVISIONS, enough).min(high);
            return self.decided(&seen, beside.deviation(high), allowance);
        }
        // Wide parts are better seen by their points; of others hardly any passes.
        if level < FEW_LEVELS || open != [false; 3] || self.is_kept(&seen) {
            return self.by_net(&seen, &net(), open, allowance);
        }
        least
    }

    /// A triangle over a part of a regular piece whose derivatives do not tell how far points drift: drifts by the net, heights by the
    /// derivatives, since those of a net are a third too great.
    fn by_net_and_heights(
        &self,
        seen: &Seen,
        net: &NetPart,
        (heights, high): (&Heights, f64),
        open: [bool; 3],
        allowance: &Allowance,
    ) -> Verdict {
        if open != [false; 3] {
            return self.by_net(seen, net, open, allowance);
        }
        let (mut deviation, _) = net.at_a_glance(&seen.frame, open);
        deviation.height = deviation.height.min(high);
        let at_once = self.decided(seen, deviation, allowance);
        if at_once.passes() {
            return at_once;
        }
        let enough = deviation.height_within(self.limit, seen.allowed(allowance).0);
        deviation.height = deviation.height.min(heights.refined(DIVISIONS, enough));
        let refined = self.decided(seen, deviation, allowance);
        if refined.passes() {
            return refined;
        }
        let halved = self.by_net(seen, net, open, allowance);
        if halved.fails() { refined } else { halved }
    }

    /// Whether a triangle is to be divided whatever else its piece is, since some of its points stand too high.
    pub(super) fn surely_fails(&self, seen: &Seen, points: &[DVec3]) -> bool {
        let height = || self.counted(seen, points.iter().copied());
        let has_limit = self.criteria.is_none() && !self.rim_alone && !self.is_kept(seen);
        has_limit && exceeds(height(), self.limit)
    }

    /// What the heights of some points come to.
    fn counted(&self, seen: &Seen, points: impl Iterator<Item = DVec3>) -> f64 {
        let heights = points.map(|point| seen.frame.height(point));
        let (low, high) = heights.fold((0.0f64, 0.0f64), |(low, high), height| {
            (low.smaller(height), high.larger(height))
        });
        high.larger(-low)
            .larger(self.range_share / SEEN * (high - low))
    }

    /// A triangle over a regular piece, as far as its net decides at a glance.
    pub(super) fn at_a_glance(
        &self,
        net: &BezierTriangle,
        seen: &Seen,
        open: [bool; 3],
        allowance: &Allowance,
    ) -> Option<Verdict> {
        if self.is_lenient || self.rim_alone || self.criteria.is_some() {
            return None;
        }
        let (deviation, attained) = at_a_glance(net, &seen.frame, open);
        if exceeds(attained, self.limit) && !self.is_kept(seen) {
            let extent = Extent {
                bound: attained,
                ..seen.extent()
            };
            return Some(Verdict {
                outcome: Outcome::Fails,
                extent,
            });
        }
        // Heights of both signs are not told apart.
        let may_be_uneven = 2.0 * self.range_share * deviation.height > self.limit;
        Some(self.decided(seen, deviation, allowance))
            .filter(|verdict| verdict.passes() && !may_be_uneven)
    }

    /// A triangle over a part of any piece, so many levels below its control face.
    pub(super) fn general<'p>(
        &'p self,
        pieces: &mut Pieces<'p>,
        (level, part): (u32, SubTriangle),
        corners: &[LimitPoint; 3],
        open: [bool; 3],
        allowance: &Allowance,
    ) -> Verdict {
        if self.is_inside(open) {
            return Verdict::NONE;
        }
        let seen = Seen::of(corners, level);
        if self.rim_alone {
            let effort = self.rim_effort(open);
            return self.along_rim(pieces.deviation(part, &seen.frame, self.rules, effort));
        }
        if let Some(criteria) = self.criteria {
            let behind = self.behind(Leaf::General(pieces.patch(), self.rules));
            let test = Trial::of(criteria, self.limit, &seen, corners, &behind);
            return test.general(pieces, part, open, self.rules);
        }
        self.by_pieces(&seen, pieces, part, open, allowance)
    }

    /// Whether a triangle with these open edges passes for being inside of a rim that alone counts.
    pub(super) fn is_inside(&self, open: [bool; 3]) -> bool {
        self.rim_alone && open == [false; 3]
    }

    /// What becomes of a triangle of whose edges those on the rim count alone.
    fn along_rim(&self, deviation: Deviation) -> Verdict {
        let bound = deviation.own;
        let stays = self.is_lenient || bound <= self.limit;
        let outcome = if stays {
            Outcome::Passes
        } else {
            Outcome::Fails
        };
        Verdict {
            outcome,
            extent: Extent {
                bound,
                ..Extent::NONE
            },
        }
    }

    fn rim_effort(&self, open: [bool; 3]) -> Effort {
        Effort::along_rim(self.limit, open)
    }

    fn behind<'p>(&'p self, leaf: Leaf<'p>) -> Behind<'p> {
        Behind {
            faces: self.back_faces,
            face: self.face,
            leaf,
        }
    }

    fn by_net(
        &self,
        seen: &Seen,
        net: &NetPart,
        open: [bool; 3],
        allowance: &Allowance,
    ) -> Verdict {
        let deviation = net.deviation(&seen.frame, self.rules, self.effort(seen, open, allowance));
        self.decided(seen, deviation, allowance)
    }

    /// Whether a triangle stays whatever it comes to, so that it takes a bound that holds among its neighbours.
    fn is_kept(&self, seen: &Seen) -> bool {
        self.is_lenient || seen.level >= self.max_levels
    }

    /// What is done for a bound.
    fn effort(&self, seen: &Seen, open: [bool; 3], allowance: &Allowance) -> Effort {
        let (chord, slopes) = seen.expected();
        // What will be divided needs no bound.
        let gives_up = !self.is_kept(seen);
        let halvings = if self.is_lenient {
            LENIENT_HALVINGS
        } else {
            HALVINGS
        };
        let least_chord = gives_up.then(|| chord.min(seen.allowed(allowance).0));
        let target = self.limit;
        Effort {
            target,
            halvings,
            open,
            rim_alone: false,
            chord,
            slopes,
            gives_up,
            least_chord,
        }
    }

    fn by_pieces<'p>(
        &'p self,
        seen: &Seen,
        pieces: &mut Pieces<'p>,
        part: SubTriangle,
        open: [bool; 3],
        allowance: &Allowance,
    ) -> Verdict {
        let deviation = pieces.deviation(
            part,
            &seen.frame,
            self.rules,
            self.effort(seen, open, allowance),
        );
        self.decided(seen, deviation, allowance)
    }

    /// What becomes of a triangle with this deviation.
    fn decided(&self, seen: &Seen, deviation: Deviation, allowance: &Allowance) -> Verdict {
        let (chord, slopes) = seen.allowed(allowance);
        let bound = deviation.bound(chord, slopes);
        let verdict = |outcome, bound: f64, drift_slope| Verdict {
            outcome,
            extent: Extent {
                bound,
                drift_slope,
                ..seen.extent()
            },
        };
        if bound <= self.limit {
            // Drifts that are too steep are not counted on.
            let counted = if deviation.is_within(slopes) {
                deviation.steepest()
            } else {
                0.0
            };
            return verdict(Outcome::Passes, bound, counted);
        }
        // Few triangles miss by so little: to divide them costs less than to look at their neighbours.
        let is_near_miss =
            seen.level >= DEEP && chord < NEARLY_FLAT && bound <= NEAR_MISS * self.limit;
        let (chord, slopes) = seen.expected();
        let bound = deviation.bound(chord, slopes);
        if self.is_kept(seen) || !is_near_miss && bound <= self.limit {
            // What it comes to is known when its neighbours are.
            let (tilt, slopes) = (seen.tilt, seen.own_slopes());
            return verdict(
                Outcome::Depends {
                    deviation,
                    tilt,
                    slopes,
                },
                0.0,
                0.0,
            );
        }
        verdict(Outcome::Fails, bound, 0.0)
    }

    /// The same for rows of triangles.
    pub(super) fn row_target(&self, allowance: &Allowance) -> RowTarget {
        let Allowance { tilt, slope } = *allowance;
        RowTarget {
            distance: self.limit,
            tilt,
            slope,
            range_share: self.range_share,
            drift_share: DRIFT_SHARE,
        }
    }

    /// Whether a triangle may pass, as far as some points of its piece tell.
    pub(super) fn may_pass(
        &self,
        patch: &Patch,
        corners: &[LimitPoint; 3],
        points: &[LimitPoint],
        level: u32,
    ) -> bool {
        let seen = Seen::of(corners, level);
        let height = self.counted(&seen, points.iter().map(|point| point.position));
        match self.criteria {
            None => height <= self.limit,
            Some(criteria) => {
                let behind = self.behind(Leaf::General(patch, self.rules));
                !Trial::of(criteria, self.limit, &seen, corners, &behind).is_lost(height)
            }
        }
    }

    /// Whether whole rows of triangles can be tested at once.
    pub(super) fn has_rows(&self) -> bool {
        self.criteria.is_none()
    }
}

/// A triangle as its neighbours see it.
pub(super) struct Seen {
    pub(super) frame: TriangleFrame,
    pub(super) tilt: f64,
    /// Its level below the control face.
    pub(super) level: u32,
}

impl Seen {
    pub(super) fn of(corners: &[LimitPoint; 3], level: u32) -> Self {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        // Of the two corners that neighbours share one must have a normal.
        let known = corners.iter().filter(|corner| corner.normal != DVec3::ZERO);
        let (mut squared, mut count) = (0.0f64, 0);
        for corner in known {
            squared = squared.max(corner.normal.distance_squared(frame.normal()));
            count += 1;
        }
        let tilt = if count < 2 || frame.is_flat() {
            ANY_TILT
        } else {
            squared.sqrt() + ROUNDING
        };
        Self { frame, tilt, level }
    }

    /// How high the highest of some points stands over the triangle.
    pub(super) fn highest(&self, points: &[LimitPoint]) -> f64 {
        points
            .iter()
            .map(|point| self.frame.height(point.position).abs())
            .fold(0.0, f64::max)
    }

    pub(super) fn extent(&self) -> Extent {
        let slope = if self.frame.is_flat() {
            0.0
        } else {
            self.frame.least_slope()
        };
        Extent {
            tilt: self.tilt,
            slope,
            ..Extent::NONE
        }
    }

    /// By edge, the slopes that the triangle's own angles allow.
    #[inline]
    pub(super) fn own_slopes(&self) -> [f64; 3] {
        [0, 1, 2].map(|edge| DRIFT_SHARE * self.frame.slope_at(edge).min(1.0))
    }

    /// The chord of the angles to the neighbours and the greatest slopes of drifts, by edge, that are certain.
    #[inline]
    fn allowed(&self, allowance: &Allowance) -> (f64, [f64; 3]) {
        (
            self.tilt + allowance.tilt,
            self.own_slopes().map(|slope| slope.min(allowance.slope)),
        )
    }

    /// The same as they are expected: neighbours are alike, on the other side of the limit normals. From some level on that
    /// is not expected of their angles: what is wrong there is put right one level at a time.
    pub(super) fn expected(&self) -> (f64, [f64; 3]) {
        let slopes = if self.level < FEW_LEVELS {
            [0, 1, 2].map(|edge| self.frame.slope_at(edge).min(1.0))
        } else {
            self.own_slopes()
        };
        (2.0 * self.tilt, slopes)
    }
}
