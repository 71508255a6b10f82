//! The methods that are compared: the paper's, at a given angle or face count, and uniform refinement.

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal};
use limitmesh::refine::{
    Exact, ExactOptions, RefineError, Refinement, SeamRule, StepwiseOptions, UniformOptions, exact, stepwise,
    uniform,
};
use limitmesh::scheme::Loop;

/// The paper's method: stepwise refinement by limit normals, angle in degrees.
pub(super) fn paper(
    control: &Mesh,
    angle_degrees: f64,
    steps: usize,
    seam: SeamRule,
) -> Result<Refinement, RefineError> {
    adaptive(control, &LimitNormal::new(angle_degrees.to_radians()), steps, seam)
}

/// Stepwise refinement by any criterion.
pub(super) fn adaptive(
    control: &Mesh,
    criterion: &dyn Criterion,
    steps: usize,
    seam: SeamRule,
) -> Result<Refinement, RefineError> {
    stepwise(control, &Loop, criterion, &StepwiseOptions::default().levels(steps).seam(seam))
}

/// Exact refinement: the best mesh with at most so many faces, its vertices on the limit surface of `control`.
pub(super) fn exact_with(control: &Mesh, faces: usize) -> Result<Exact, RefineError> {
    exact(control, &Loop, &ExactOptions::default().triangles(faces))
}

/// Uniform refinement, vertices as the scheme leaves them.
pub(super) fn uniform_plain(control: &Mesh, levels: usize) -> Result<Refinement, RefineError> {
    uniform(control, &Loop, &UniformOptions::default().levels(levels))
}

/// A refinement at the angle whose face count comes nearest to a given one.
pub(super) struct Matched {
    pub(super) mesh: Mesh,
    pub(super) angle_degrees: f64,
}

/// A face count within this part of the wanted one is near enough.
const NEAR_ENOUGH: f64 = 0.002;

/// Bisects the angle in degrees, from 0 to 180, of a method that gives fewer faces for greater angles.
///
/// The count is a step function of the angle; the nearest count met is given.
pub(super) fn nearest(
    faces: usize,
    mut refine: impl FnMut(f64) -> Result<Mesh, RefineError>,
) -> Result<Matched, RefineError> {
    let (mut low, mut high) = (0.0_f64, 180.0_f64);
    let mut best: Option<(f64, Matched)> = None;
    // The interval halves: after 24 of them it is a hundred-thousandth of a degree, and the count's steps show.
    for _ in 0..24 {
        let angle_degrees = 0.5 * (low + high);
        let mesh = refine(angle_degrees)?;
        let ratio = mesh.face_count() as f64 / faces as f64;
        if ratio > 1.0 {
            low = angle_degrees
        } else {
            high = angle_degrees
        }
        let distance = ratio.ln().abs();
        if best.as_ref().is_none_or(|(least, _)| distance < *least) {
            best = Some((distance, Matched { mesh, angle_degrees }));
        }
        if best.as_ref().is_some_and(|(least, _)| *least <= NEAR_ENOUGH) {
            break;
        }
    }
    match best {
        Some((_, matched)) => Ok(matched),
        None => Ok(Matched { mesh: refine(180.0)?, angle_degrees: 180.0 }),
    }
}

/// The uniform level whose face count is nearest in ratio.
pub(super) fn nearest_level(control_faces: usize, faces: usize) -> usize {
    // Levels multiply by 4: the nearest in ratio is the rounded logarithm.
    ((faces as f64 / control_faces as f64).log(4.0)).round().max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let soup = limitmesh::models::find("bumpy").map(|m| m.soup()).unwrap();
        let (control, _) = Mesh::from_soup(&soup, &Default::default()).unwrap();
        let refine = |degrees: f64| paper(&control, degrees, 2, SeamRule::All).map(|r| r.mesh);
        let wanted = 1500;
        let found = nearest(wanted, refine).unwrap();
        let count = |degrees: f64| refine(degrees).unwrap().face_count();
        assert_eq!(found.mesh.face_count(), count(found.angle_degrees));
        let off = |faces: usize| (faces as f64 / wanted as f64).ln().abs();
        let best = (1..360).map(|i| off(count(0.5 * f64::from(i)))).fold(f64::MAX, f64::min);
        assert!(off(found.mesh.face_count()) <= best.max(NEAR_ENOUGH) + 1e-12);
    }
}
