//! What becomes of a triangle that was judged, and what triangles that were let pass come to.

use super::super::quadtree::Place;
use super::{ANY_TILT, Allowance};
use crate::certificate::Deviation;
use crate::vector::Extremes;

/// What the triangles that were let pass come to.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Extent {
    /// The greatest tilt.
    pub(in super::super) tilt: f64,
    /// The least tangent of an angle.
    pub(in super::super) slope: f64,
    /// The greatest slope of a drift that was counted on.
    pub(in super::super) drift_slope: f64,
    /// The greatest bound of a distance, or value by the criteria where more than distances count.
    pub(in super::super) bound: f64,
    /// The leaf that has it.
    pub(in super::super) worst: Option<Place>,
}

impl Default for Extent {
    fn default() -> Self {
        Self::NONE
    }
}

impl Extent {
    pub(in super::super) const NONE: Self = Self {
        tilt: 0.0,
        slope: f64::INFINITY,
        drift_slope: 0.0,
        bound: 0.0,
        worst: None,
    };

    pub(in super::super) fn add(&mut self, other: &Self) {
        self.tilt = self.tilt.larger(other.tilt);
        self.slope = self.slope.smaller(other.slope);
        self.drift_slope = self.drift_slope.larger(other.drift_slope);
        if other.bound > self.bound {
            (self.bound, self.worst) = (other.bound, other.worst);
        }
    }
}

/// What becomes of a triangle.
#[derive(Clone, Copy, Debug)]
pub(in super::super) enum Outcome {
    /// Good enough, as long as allowances hold.
    Passes,
    /// To be divided.
    Fails,
    /// Good enough if this deviation, with the neighbours as they are emitted, comes to no more than the greatest distance; or
    /// not to be divided in any case, and what it comes to is known then.
    Depends {
        /// How far the triangle is from its part of the surface.
        deviation: Deviation,
        /// Its tilt.
        tilt: f64,
        /// By edge, the slopes that its own angles allow.
        slopes: [f64; 3],
    },
}

/// A leaf that passes if its neighbours turn out as expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Condition {
    pub(in super::super) place: Place,
    pub(in super::super) deviation: Deviation,
    pub(in super::super) tilt: f64,
    pub(in super::super) slopes: [f64; 3],
}

impl Condition {
    /// That of a leaf of which nothing is known any more: it never holds.
    pub(in super::super) fn unknown(place: Place) -> Self {
        Self {
            place,
            deviation: Deviation::alone(f64::INFINITY),
            tilt: ANY_TILT,
            slopes: [0.0; 3],
        }
    }

    /// What it comes to beside triangles like itself.
    pub(in super::super) fn expected(&self) -> f64 {
        self.bound(&Allowance {
            tilt: self.tilt,
            slope: f64::INFINITY,
        })
    }

    /// What it comes to beside triangles of these tilts and angles at most.
    pub(in super::super) fn bound(&self, around: &Allowance) -> f64 {
        let slopes = self.slopes.map(|slope| slope.min(around.slope));
        self.deviation.bound(self.tilt + around.tilt, slopes)
    }
}

/// What becomes of a triangle, and what it comes to.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Verdict {
    pub(in super::super) outcome: Outcome,
    pub(in super::super) extent: Extent,
}

impl Verdict {
    /// That of no triangle.
    pub(in super::super) const NONE: Self = Self {
        outcome: Outcome::Passes,
        extent: Extent::NONE,
    };

    pub(in super::super) fn passes(&self) -> bool {
        matches!(self.outcome, Outcome::Passes)
    }

    pub(in super::super) fn fails(&self) -> bool {
        matches!(self.outcome, Outcome::Fails)
    }

    /// That of two triangles together.
    pub(in super::super) fn and(mut self, other: &Self) -> Self {
        self.extent.add(&other.extent);
        self.outcome = match (self.outcome, other.outcome) {
            (Outcome::Fails, _) | (_, Outcome::Fails) => Outcome::Fails,
            (Outcome::Passes, other) => other,
            (own, Outcome::Passes) => own,
            (
                Outcome::Depends {
                    deviation,
                    tilt,
                    slopes,
                },
                Outcome::Depends {
                    deviation: second,
                    tilt: other,
                    slopes: least,
                },
            ) => Outcome::Depends {
                deviation: deviation.max(second),
                tilt: tilt.max(other),
                slopes: [0, 1, 2].map(|edge| slopes[edge].min(least[edge])),
            },
        };
        self
    }

    /// The same where nobody knows which edge is which any more.
    pub(in super::super) fn spread(mut self) -> Self {
        if let Outcome::Depends {
            deviation, slopes, ..
        } = &mut self.outcome
        {
            deviation.slopes = [deviation.steepest(); 3];
            *slopes = [slopes.iter().copied().fold(f64::INFINITY, f64::min); 3];
        }
        self
    }
}
