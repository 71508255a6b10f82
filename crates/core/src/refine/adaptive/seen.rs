//! A triangle as its neighbours see it: its normal deviation, how acute it is, and what leaves may count on of their neighbours.

use crate::certificate::TriangleFrame;
use crate::patch::LimitPoint;
use crate::vector::{DVec3, Extremes};

/// Halvings of a net before a triangle is given up: the bound is within some per cent of the truth then.
pub(super) const HALVINGS: usize = 2;

/// Divisions into four of the heights over a plane, to the same end.
pub(super) const DIVISIONS: u32 = 2;

/// Tangential displacements over an edge are counted on up to this part of what a triangle's own angles there allow, or 1: those of the triangle beyond
/// it may be more acute, closing triangles above all. No more than √2 − 1, so that half of what an angle α leaves of π allows it, too: its
/// tangent is 1 at least where α ≤ π/2, else tan(π − α) times 1/(1 + √(1 + tan²)).
pub(super) const DISPLACEMENT_SHARE: f64 = 0.41;

/// The greatest possible chord of a normal deviation.
const ANY_DEVIATION: f64 = 2.0;

/// Slopes that no known tangential displacement exceeds: as if neighbours were as wide as can be.
pub(super) const ANY_SLOPES: [f64; 3] = [9.0; 3];

/// The chords of the angles to neighbours in the triangle's own plane.
pub(super) const NO_CHORDS: [f64; 3] = [0.0; 3];

/// Limits that leaves count on for the triangles in their control face and adjacent to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Allowance {
    /// The chords of their normal deviations are at most this.
    pub(super) normal_deviation: f64,
    /// Tangents of their angles are at least this.
    pub(super) slope: f64,
}

impl Allowance {
    /// Nothing is expected.
    pub(super) const NOTHING: Self = Self {
        normal_deviation: 2.0 * ANY_DEVIATION,
        slope: 0.0,
    };
}

/// The outcome for a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It stays whole, and is within the limit if the allowance is kept.
    Proven,
    /// It is likely to be within the limit.
    Likely,
    /// It is divided.
    Fails,
}

/// The extreme values of some triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// The greatest normal deviation.
    pub(super) normal_deviation: f64,
    /// The least tangent of an angle.
    pub(super) slope: f64,
    /// The greatest slope of a tangential displacement that bounds count on.
    pub(super) displacement_slope: f64,
    /// The greatest bound of a distance.
    pub(super) bound: f64,
}

impl Extent {
    pub(super) const NONE: Self = Self {
        normal_deviation: 0.0,
        slope: f64::INFINITY,
        displacement_slope: 0.0,
        bound: 0.0,
    };

    pub(super) fn add(&mut self, other: &Self) {
        self.normal_deviation = self.normal_deviation.larger(other.normal_deviation);
        self.slope = self.slope.smaller(other.slope);
        self.displacement_slope = self.displacement_slope.larger(other.displacement_slope);
        self.bound = self.bound.larger(other.bound);
    }
}

/// A triangle as its neighbours see it.
pub(super) struct Seen {
    pub(super) frame: TriangleFrame,
    pub(super) normal_deviation: f64,
}

impl Seen {
    pub(super) fn of(corners: &[LimitPoint; 3]) -> Self {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        // Of the two corners that neighbours share one must have a normal.
        let known = corners.iter().filter(|corner| corner.normal != DVec3::ZERO);
        let (mut squared, mut count) = (0.0f64, 0);
        for corner in known {
            squared = squared.max(corner.normal.distance_squared(frame.normal()));
            count += 1;
        }
        let normal_deviation = if count < 2 || frame.is_flat() {
            ANY_DEVIATION
        } else {
            // Unit vectors are off by no more than 1e-12.
            squared.sqrt() + 1e-12
        };
        Self {
            frame,
            normal_deviation,
        }
    }

    /// How high the highest of some points stands over the triangle.
    pub(super) fn highest(&self, points: &[LimitPoint]) -> f64 {
        points
            .iter()
            .map(|point| self.frame.height(point.position).abs())
            .fold(0.0, f64::max)
    }

    /// The values on which its neighbours may count.
    pub(super) fn extent(&self) -> Extent {
        let slope = if self.frame.is_flat() {
            0.0
        } else {
            self.frame.least_slope()
        };
        Extent {
            normal_deviation: self.normal_deviation,
            slope,
            ..Extent::NONE
        }
    }

    /// By edge, the slopes that the triangle's own angles allow.
    #[inline]
    pub(super) fn own_slopes(&self) -> [f64; 3] {
        [0, 1, 2].map(|edge| DISPLACEMENT_SHARE * self.frame.slope_at(edge).min(1.0))
    }
}
