//! The methods that are compared: the paper's, at a given angle or face count, and uniform refinement.

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::refine::{
    Exact, ExactOptions, RefineError, Refinement, SeamRule, StepwiseOptions, UniformOptions, exact, stepwise,
    uniform,
};
use limitmesh::scheme::Loop;

/// The paper's method: stepwise refinement by limit normals, angle in degrees.
///
/// # Errors
/// See [`RefineError`].
pub fn paper(
    control: &Mesh,
    angle_degrees: f64,
    steps: usize,
    seam: SeamRule,
) -> Result<Refinement, RefineError> {
    adaptive(control, &LimitNormal::new(angle_degrees.to_radians()), steps, seam)
}

/// The method of Amresh, Farin and Razdan, angle in degrees.
///
/// # Errors
/// See [`RefineError`].
pub fn amresh(control: &Mesh, angle_degrees: f64, steps: usize) -> Result<Refinement, RefineError> {
    adaptive(control, &NeighbourNormal::new(angle_degrees.to_radians()), steps, SeamRule::All)
}

/// Stepwise refinement by any criterion.
///
/// # Errors
/// See [`RefineError`].
pub fn adaptive(
    control: &Mesh,
    criterion: &dyn Criterion,
    steps: usize,
    seam: SeamRule,
) -> Result<Refinement, RefineError> {
    stepwise(control, &Loop, criterion, &StepwiseOptions::default().levels(steps).seam(seam))
}

/// Exact refinement: the best mesh with at most so many faces, its vertices on the limit surface of `control`.
///
/// # Errors
/// See [`RefineError`].
pub fn exact_with(control: &Mesh, faces: usize) -> Result<Exact, RefineError> {
    exact(control, &Loop, &ExactOptions::default().triangles(faces))
}

/// Uniform refinement, vertices as the scheme leaves them.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform_plain(control: &Mesh, levels: usize) -> Result<Refinement, RefineError> {
    uniform(control, &Loop, &UniformOptions::default().levels(levels))
}
