//! Whether a node may stay whole by criteria that ask for more than distances: cones, pixels, and distances besides them.
//!
//! Neighbours are expected to look away if the triangle does; with those that are emitted it is looked at
//! again ([`super::measure`]).

use super::backs::{Behind, looks_away};
use super::seen::{ANY_SLOPES, DIVISIONS, Fate, HALVINGS, NO_CHORDS, Seen};
use super::surface::QuarticPiece;
use crate::certificate::{Cell, Deviation, Effort, NetPart, Pieces, SubTriangle, exceeds};
use crate::criterion::{Apart, Backs, Criteria, Region};
use crate::patch::{LimitPoint, Rules};

/// A triangle under test.
pub(super) struct Trial<'a> {
    criteria: &'a Criteria,
    limit: f64,
    seen: &'a Seen,
    /// Where it lies, and the normals of it and its neighbours.
    region: Region,
    /// Who sees nothing but its back.
    backs: Backs,
    /// How many times over it leaves its cones; no more than the limit where these are given up.
    cone: f64,
}

impl<'a> Trial<'a> {
    pub(super) fn of(
        criteria: &'a Criteria,
        limit: f64,
        seen: &'a Seen,
        corners: &[LimitPoint; 3],
        behind: &Behind<'_>,
    ) -> Self {
        let normal = seen.frame.normal();
        let triangle = corners.map(|corner| corner.position);
        let region = Region::around(triangle, normal).turned(2.0 * seen.normal_deviation);
        let backs = looks_away(criteria, &region, &[triangle], 0.0, |viewer, rest| {
            behind.is_back(corners, viewer, rest)
        });
        let cone =
            criteria.cone_ratio(normal, corners.map(|corner| corner.normal), &region, &backs);
        Self {
            criteria,
            limit,
            seen,
            region,
            backs,
            cone,
        }
    }

    /// The trial of a node so many levels below its control face: cones are given up at last.
    pub(super) fn at_level(self, level: u32) -> Self {
        let is_given_up = level as usize >= self.criteria.deepest_cone();
        Self {
            cone: if is_given_up {
                self.cone.min(1.0)
            } else {
                self.cone
            },
            ..self
        }
    }

    /// Whether it leaves its cones.
    pub(super) fn leaves_cone(&self) -> bool {
        exceeds(self.cone, self.limit)
    }

    /// Whether a triangle fails for sure with a point of its piece so high over it.
    pub(super) fn is_lost(&self, height: f64) -> bool {
        let least = Apart {
            own: height,
            height,
            across: 0.0,
        };
        let ratio = || {
            self.criteria
                .distance_ratio(&least, &self.region, &self.backs)
        };
        self.leaves_cone() || exceeds(ratio(), self.limit)
    }

    /// Whether distances are within the limit with this deviation.
    fn is_within(&self, deviation: &Deviation) -> bool {
        let apart = deviation.apart(NO_CHORDS, ANY_SLOPES);
        let ratio =
            self.criteria
                .distance_ratio(&apart, &self.region.grown(apart.own), &self.backs);
        !exceeds(ratio, self.limit)
    }

    pub(super) fn regular(
        &self,
        quartic: &QuarticPiece,
        net: impl Fn() -> NetPart,
        cell: &Cell,
        open: [bool; 3],
        rules: &Rules<'_>,
    ) -> Fate {
        if !self.criteria.has_distances() || self.leaves_cone() {
            return self.fate(true);
        }
        let heights = quartic.jet().heights(cell, self.seen.frame.normal());
        let (low, high) = heights.range();
        if self.is_lost(low) {
            return Fate::Fails;
        }
        let edges = quartic.jet().edge_bounds(cell, &self.seen.frame, open);
        let is_within = self.is_within(&edges.deviation(high))
            || match self.is_within(&edges.deviation(low)) {
                true => self.is_within(&edges.deviation(heights.refined(DIVISIONS, 0.0).min(high))),
                false => {
                    self.is_within(&net().deviation(&self.seen.frame, rules, self.effort(open)))
                }
            };
        self.fate(is_within)
    }

    pub(super) fn general<'p>(
        &self,
        pieces: &mut Pieces<'p>,
        open: [bool; 3],
        rules: &'p Rules<'p>,
    ) -> Fate {
        if !self.criteria.has_distances() || self.leaves_cone() {
            return self.fate(true);
        }
        let effort = self.effort(open);
        self.fate(self.is_within(&pieces.deviation(
            SubTriangle::Whole,
            &self.seen.frame,
            rules,
            effort,
        )))
    }

    /// The fate of a node that is within its distances or not.
    fn fate(&self, is_within: bool) -> Fate {
        if is_within && !self.leaves_cone() {
            Fate::Likely
        } else {
            Fate::Fails
        }
    }

    /// The effort for a bound.
    fn effort(&self, open: [bool; 3]) -> Effort {
        Effort {
            target: self.limit * self.criteria.allowed_length(&self.region, &self.backs),
            halvings: HALVINGS,
            open,
            chords: NO_CHORDS,
            slopes: ANY_SLOPES,
            rim_alone: false,
            gives_up: false,
            least_chord: None,
        }
    }
}
