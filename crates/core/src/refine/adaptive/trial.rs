//! How a triangle fares by criteria that ask for more than distances: cones, pixels, and distances beside them.
//!
//! Neighbours are expected to be like the triangle itself, or to look away if it does; with those that are emitted it is looked at
//! again ([`super::measure`]).

use super::backs::{Behind, looks_away};
use super::judge::{DIVISIONS, Extent, HALVINGS, Outcome, Seen, Verdict};
use super::surface::Ground;
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
        let (chord, _) = seen.expected();
        let normal = seen.frame.normal();
        let region = Region::around(corners.map(|corner| corner.position), normal).turned(chord);
        let triangle = corners.map(|corner| corner.position);
        let backs = looks_away(criteria, &region, (&[triangle], 0.0), |viewer, rest| {
            behind.is_back(corners, viewer, rest)
        });
        let cone =
            criteria.cone_ratio(normal, corners.map(|corner| corner.normal), &region, &backs);
        let is_given_up = seen.level as usize >= criteria.deepest_cone();
        Self {
            criteria,
            limit,
            seen,
            region,
            backs,
            cone: if is_given_up { cone.min(1.0) } else { cone },
        }
    }

    /// Whether a triangle fails for sure with a point of its piece so high over it.
    pub(super) fn is_lost(&self, height: f64) -> bool {
        let least = Apart {
            own: height,
            height,
            across: 0.0,
        };
        exceeds(self.cone, self.limit)
            || exceeds(
                self.criteria
                    .distance_ratio(&least, &self.region, &self.backs),
                self.limit,
            )
    }

    /// What the triangle comes to with this deviation.
    fn value(&self, deviation: &Deviation) -> f64 {
        let (chord, slopes) = self.seen.expected();
        let apart = deviation.apart(chord, slopes);
        let distance =
            self.criteria
                .distance_ratio(&apart, &self.region.grown(apart.own), &self.backs);
        // What is not a number fails.
        if exceeds(distance, self.cone) {
            distance
        } else {
            self.cone
        }
    }

    fn verdict(&self, value: f64) -> Verdict {
        let outcome = if exceeds(value, self.limit) {
            Outcome::Fails
        } else {
            Outcome::Passes
        };
        Verdict {
            outcome,
            extent: Extent {
                bound: value,
                ..self.seen.extent()
            },
        }
    }

    pub(super) fn regular(
        &self,
        ground: &Ground,
        net: impl Fn() -> NetPart,
        cell: &Cell,
        open: [bool; 3],
        rules: &Rules<'_>,
    ) -> Verdict {
        if !self.criteria.has_distances() {
            return self.verdict(self.cone);
        }
        let heights = ground.jet().heights(cell, self.seen.frame.normal());
        let (low, high) = heights.range();
        if self.is_lost(low) {
            let least = Apart {
                own: low,
                height: low,
                across: 0.0,
            };
            return self.verdict(self.cone.max(self.criteria.distance_ratio(
                &least,
                &self.region,
                &self.backs,
            )));
        }
        let beside = ground.jet().beside(cell, &self.seen.frame, open);
        let verdict = self.verdict(self.value(&beside.deviation(high)));
        if !verdict.fails() {
            return verdict;
        }
        if !self.verdict(self.value(&beside.deviation(low))).fails() {
            let high = heights.refined(DIVISIONS, 0.0).min(high);
            return self.verdict(self.value(&beside.deviation(high)));
        }
        let deviation = net().deviation(&self.seen.frame, rules, self.effort(open));
        self.verdict(self.value(&deviation))
    }

    /// What is done for a bound.
    fn effort(&self, open: [bool; 3]) -> Effort {
        let (chord, slopes) = self.seen.expected();
        let target = self.limit * self.criteria.allowed_length(&self.region, &self.backs);
        Effort {
            target,
            halvings: HALVINGS,
            open,
            chord,
            slopes,
            rim_alone: false,
            gives_up: false,
            least_chord: None,
        }
    }

    pub(super) fn general<'p>(
        &self,
        pieces: &mut Pieces<'p>,
        part: SubTriangle,
        open: [bool; 3],
        rules: &'p Rules<'p>,
    ) -> Verdict {
        if !self.criteria.has_distances() || exceeds(self.cone, self.limit) {
            return self.verdict(self.cone);
        }
        self.verdict(self.value(&pieces.deviation(
            part,
            &self.seen.frame,
            rules,
            self.effort(open),
        )))
    }
}
