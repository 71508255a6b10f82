//! What the triangles of a control face count on of those beside them before anything is divided. [`super::decide`] checks it against
//! what came out, and divides again the faces that counted on too much.

use super::judge::{Allowance, Judge, Seen};
use crate::certificate::least_slope;
use crate::patch::LimitPoint;
use crate::vector::{DVec3, Extremes};

/// The least tilt that neighbours are allowed: it costs next to nothing.
const LEAST_TILT: f64 = 0.01;

/// What a guess leaves for triangles that bend more than their control face does on the whole.
const GENEROUS: f64 = 2.2;

/// What is left of the least angle of the control faces when triangles close gaps, as tangents: they may halve it.
const SLOPE_LEFT: f64 = 0.3;

impl Judge<'_> {
    /// What the triangles of a control face count on of those beside them at first: the greatest tilts and the least angles that are expected
    /// there and in the faces beside. Angles between planes shrink with the size of triangles, heights with its square; those of the face are
    /// known at some points of its piece, those beside are told by the normals at their corners. Where more than distances count, triangles
    /// are looked at among their neighbours as they are emitted, and count on nothing.
    pub(super) fn guess(
        &self,
        corners: &[LimitPoint; 3],
        points: &[LimitPoint],
        beside: impl Iterator<Item = [LimitPoint; 3]>,
    ) -> Allowance {
        if self.criteria.is_some() {
            return Allowance::NOTHING;
        }
        let seen = Seen::of(corners, 0);
        let tilt = seen.tilt * self.shrunk(seen.highest(points));
        let slope = seen.frame.least_slope();
        let (tilt, slope) = beside.fold((tilt, slope), |(tilt, slope), corners| {
            (tilt.larger(self.tilt_beside(&corners)), slope.min(least_slope(corners.map(|at| at.position))))
        });
        Allowance { tilt: (GENEROUS * tilt).max(LEAST_TILT), slope: SLOPE_LEFT * slope }
    }

    /// The tilt that is expected of triangles in a face beside, by the normals at its corners; 0 where they tell nothing.
    fn tilt_beside(&self, corners: &[LimitPoint; 3]) -> f64 {
        let edge = |from: usize| corners[(from + 1) % 3].position - corners[from].position;
        let across = edge(0).cross(edge(1));
        let double_area = across.length();
        if double_area.is_nan()
            || double_area <= 0.0
            || corners.iter().any(|corner| corner.normal == DVec3::ZERO)
        {
            return 0.0;
        }
        let normal = across / double_area;
        // A curve over an edge that bends evenly stands as high as this.
        let height = |from: usize| {
            0.125 * (corners[(from + 1) % 3].normal - corners[from].normal).dot(edge(from)).abs()
        };
        let chord = |corner: usize| corners[corner].normal.distance_squared(normal);
        let height = height(0).larger(height(1)).larger(height(2));
        chord(0).larger(chord(1)).larger(chord(2)).sqrt() * self.shrunk(height)
    }

    /// What is left of angles where heights like this one are divided down to the limit.
    fn shrunk(&self, height: f64) -> f64 {
        if height > self.limit { (self.limit / height).sqrt() } else { 1.0 }
    }
}
