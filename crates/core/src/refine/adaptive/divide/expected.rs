//! The expected normal deviation and least angle of a control face's triangles before anything is divided, on which those around them count. Where the result
//! misses them, [`super::super::measure`] looks at each triangle by itself.

use super::super::Engine;
use super::super::control::Control;
use super::super::judge::Goal;
use super::super::seen::{Allowance, Seen};
use super::Divider;
use crate::certificate::least_slope;
use crate::patch::LimitPoint;
use crate::progress::Cancelled;
use crate::vector::{DVec3, Extremes, unit_normal};

/// The expectation for the triangles of a control face by its corners and their normals.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Expected {
    /// The greatest normal deviation; 0 where the normals do not bound it.
    normal_deviation: f64,
    /// The tangent of the least angle.
    slope: f64,
}

impl Expected {
    /// That of all control faces; of none where nothing is counted on.
    pub(super) fn of_all(engine: &Engine<'_>, goal: &Goal) -> Result<Vec<Self>, Cancelled> {
        let control = engine.control;
        if control.criteria.is_some() {
            return Ok(Vec::new());
        }
        engine.watch.map(control.mesh.face_count(), 1024, |face| {
            Self::of(control, goal, face as u32)
        })
    }

    fn of(control: &Control<'_>, goal: &Goal, face: u32) -> Self {
        let corners = control.corners(face);
        let slope = least_slope(corners.map(|at| at.position));
        Self {
            normal_deviation: normal_deviation_of(&corners, goal.allowed(face)),
            slope,
        }
    }
}

impl Divider<'_> {
    /// The allowance of a control face: the greatest normal deviations and the least angles that are expected
    /// there and in the faces adjacent to it. Angles between planes shrink with the size of triangles, heights with its square; those of the face
    /// are known at some points of its piece. Nothing where more than distances counts.
    pub(super) fn allowance(&self, face: u32, seen: &Seen, points: &[LimitPoint]) -> Allowance {
        if self.judge.criteria.is_some() {
            return Allowance::NOTHING;
        }
        let (mut normal_deviation, mut slope) = (
            seen.normal_deviation * shrunk(seen.highest(points), self.judge.limit),
            seen.frame.least_slope(),
        );
        for adjacent in self.control.adjacent(face) {
            let other = self.expected[adjacent as usize];
            (normal_deviation, slope) = (
                normal_deviation.larger(other.normal_deviation),
                slope.min(other.slope),
            );
        }
        Allowance {
            // Triangles may bend more than their control face does on the whole; a hundredth costs next to nothing.
            normal_deviation: (2.2 * normal_deviation).max(0.01),
            // Triangles that close gaps may halve the least angle.
            slope: 0.3 * slope,
        }
    }
}

/// The normal deviation that is expected of triangles in a face by the normals at its corners, divided down to a limit; 0 where they do not bound it.
fn normal_deviation_of(corners: &[LimitPoint; 3], limit: f64) -> f64 {
    let normal = unit_normal(corners.each_ref().map(|corner| corner.position));
    if normal == DVec3::ZERO || corners.iter().any(|corner| corner.normal == DVec3::ZERO) {
        return 0.0;
    }
    // A curve over an edge that bends evenly stands as high as this.
    let height = |from: usize| {
        let [from, to] = [&corners[from], &corners[(from + 1) % 3]];
        0.125
            * (to.normal - from.normal)
                .dot(to.position - from.position)
                .abs()
    };
    let chord = |corner: usize| corners[corner].normal.distance_squared(normal);
    let height = height(0).larger(height(1)).larger(height(2));
    chord(0).larger(chord(1)).larger(chord(2)).sqrt() * shrunk(height, limit)
}

/// The part of angles that is left where heights like this one are divided down to the limit.
fn shrunk(height: f64, limit: f64) -> f64 {
    if height > limit {
        (limit / height).sqrt()
    } else {
        1.0
    }
}
