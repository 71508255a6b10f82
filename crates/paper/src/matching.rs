//! Methods at equal triangle counts: the angle at which a method gives as many triangles as wanted, and the level at
//! which uniform refinement comes nearest.

use std::time::{Duration, Instant};

use limitmesh::refine::{RefineError, Refinement, Stop};

/// Angles in degrees between which the count is searched: below, every edge that bends at all is refined.
const LEAST_ANGLE: f64 = 1e-3;
const GREATEST_ANGLE: f64 = 180.0;

/// Counts as near as this share of the wanted one are equal for a comparison.
const NEAR_ENOUGH: f64 = 1e-3;

/// The search ends when the angle is known to this share: the count jumps over the wanted one there.
const ANGLE_KNOWN: f64 = 1e-5;

/// A refinement and the angle that gave it.
pub struct Matched {
    /// In degrees.
    pub angle_degrees: f64,
    /// The refined mesh and its steps.
    pub refinement: Refinement,
    /// Time that this refinement took, without the search for the angle.
    pub duration: Duration,
}

impl Matched {
    fn miss(&self, wanted: usize) -> usize {
        self.refinement.mesh.face_count().abs_diff(wanted)
    }
}

/// Bisects the angle of a method that gives fewer triangles for greater angles until it gives nearly `wanted` of them.
///
/// `first` is the angle to try first, and `refine` is given angles, in degrees. The count falls as the angle grows, all but
/// strictly; the nearest count met is returned. Attempts that end at a cap count as too fine.
///
/// # Errors
/// Those of `refine`.
pub fn match_angle(
    wanted: usize,
    first: f64,
    mut refine: impl FnMut(f64) -> Result<Refinement, RefineError>,
) -> Result<Matched, RefineError> {
    let mut attempt = |angle_degrees: f64| {
        let start = Instant::now();
        let refinement = refine(angle_degrees)?;
        Ok::<_, RefineError>(Matched {
            angle_degrees,
            refinement,
            duration: start.elapsed(),
        })
    };
    let (mut low, mut high) = (LEAST_ANGLE, GREATEST_ANGLE);
    let mut best = attempt(GREATEST_ANGLE)?;
    let mut angle = first;
    while best.miss(wanted) as f64 > NEAR_ENOUGH * wanted as f64 && high > low * (1.0 + ANGLE_KNOWN)
    {
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

/// The uniform level whose face count is nearest in ratio.
pub fn nearest_level(control_faces: usize, faces: usize) -> usize {
    // Levels multiply by 4: the nearest in ratio is the rounded logarithm.
    ((faces as f64 / control_faces as f64).log(4.0))
        .round()
        .max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use limitmesh::Mesh;
    use limitmesh::refine::SeamRule;

    use super::*;
    use crate::methods::paper;

    #[test]
    fn levels_are_nearest_in_ratio() {
        // 4 to 16 by ratio meet at 8.
        assert_eq!(nearest_level(1, 1), 0);
        assert_eq!(nearest_level(1, 7), 1);
        assert_eq!(nearest_level(1, 9), 2);
        assert_eq!(nearest_level(100, 6399), 3);
        assert_eq!(nearest_level(100, 40), 0);
    }

    #[test]
    fn bisection_comes_as_near_as_a_search_over_all_angles() {
        let soup = limitmesh_models::find("bumpy").map(|m| m.soup()).unwrap();
        let (control, _) = Mesh::from_soup(&soup, &Default::default()).unwrap();
        let refine = |degrees: f64| paper(&control, degrees, 2, SeamRule::All);
        let wanted = 1500;
        let found = match_angle(wanted, 10.0, refine).unwrap();
        let count = |degrees: f64| refine(degrees).unwrap().mesh.face_count();
        assert_eq!(
            found.refinement.mesh.face_count(),
            count(found.angle_degrees)
        );
        let off = |faces: usize| (faces as f64 - wanted as f64).abs() / wanted as f64;
        let best = (1..360)
            .map(|i| off(count(0.5 * f64::from(i))))
            .fold(f64::MAX, f64::min);
        assert!(off(found.refinement.mesh.face_count()) <= best.max(NEAR_ENOUGH) + 1e-12);
    }
}
