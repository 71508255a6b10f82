//! Methods at equal triangle counts: the angle at which the method of Amresh, Farin and Razdan gives as many
//! triangles as wanted, and the level at which uniform refinement comes nearest.

use std::time::{Duration, Instant};

use limitmesh::Mesh;
use limitmesh::criterion::NeighbourNormal;
use limitmesh::refine::{RefineError, Refinement, StepwiseOptions, Stop, stepwise};
use limitmesh::scheme::Scheme;

use crate::arguments::MAX_LEVELS;
use crate::reference::faces_at;

/// Angles in degrees between which the count is searched: below, every edge that bends at all is refined.
const LEAST_ANGLE: f64 = 1e-3;
const GREATEST_ANGLE: f64 = 180.0;

/// Counts as near as this share of the wanted one are equal for a comparison.
const NEAR_ENOUGH: f64 = 1e-3;

/// The search ends when the angle is known to this share: the count jumps over the wanted one there.
const ANGLE_KNOWN: f64 = 1e-5;

/// A refinement by Amresh's method and the angle that gave it.
pub(crate) struct Matched {
    /// In degrees.
    pub(crate) angle_degrees: f64,
    /// The refined mesh and its steps.
    pub(crate) refinement: Refinement,
    /// Time that this refinement took, without the search for the angle.
    pub(crate) duration: Duration,
}

impl Matched {
    fn miss(&self, wanted: usize) -> usize {
        self.refinement.mesh.face_count().abs_diff(wanted)
    }
}

/// Bisects the angle of Amresh's method until it gives nearly `wanted` triangles.
///
/// `first` is the angle to try first, in degrees. The count falls as the angle grows, all but strictly; the
/// nearest count met is returned.
///
/// # Errors
/// See [`RefineError`].
pub(crate) fn match_neighbour_angle(
    control: &Mesh,
    scheme: &dyn Scheme,
    levels: usize,
    wanted: usize,
    first: f64,
) -> Result<Matched, RefineError> {
    // Far too fine attempts are cut off: that they are too fine is all that matters of them.
    let cap = wanted.saturating_mul(2).max(control.face_count());
    let options = StepwiseOptions::default().levels(levels).max_triangles(Some(cap));
    let attempt = |angle_degrees: f64| {
        let criterion = NeighbourNormal::new(angle_degrees.to_radians());
        let start = Instant::now();
        let refinement = stepwise(control, scheme, &criterion, &options)?;
        Ok::<_, RefineError>(Matched { angle_degrees, refinement, duration: start.elapsed() })
    };
    let (mut low, mut high) = (LEAST_ANGLE, GREATEST_ANGLE);
    let mut best = attempt(GREATEST_ANGLE)?;
    let mut angle = first;
    while best.miss(wanted) as f64 > NEAR_ENOUGH * wanted as f64 && high > low * (1.0 + ANGLE_KNOWN) {
        let next = attempt(angle)?;
        let capped = matches!(next.refinement.stop, Stop::TriangleCap { .. });
        if capped || next.refinement.mesh.face_count() > wanted {
            low = angle;
        } else {
            high = angle;
        }
        if !capped && next.miss(wanted) < best.miss(wanted) {
            best = next;
        }
        // Angles matter by their ratio: halfway on a logarithmic scale.
        angle = (low * high).sqrt();
    }
    Ok(best)
}

/// The level at which uniform refinement gives the count nearest to `wanted`; the lower one of two equally near.
pub(crate) fn nearest_uniform_level(control_faces: usize, wanted: usize) -> usize {
    let miss =
        |&level: &usize| faces_at(control_faces, level).map_or(usize::MAX, |faces| faces.abs_diff(wanted));
    (0..=MAX_LEVELS).min_by_key(miss).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_level_is_found() {
        assert_eq!(nearest_uniform_level(142, 142), 0);
        assert_eq!(nearest_uniform_level(142, 3954), 2);
        assert_eq!(nearest_uniform_level(142, 9088), 3);
        assert_eq!(nearest_uniform_level(100, 250), 0);
    }
}
