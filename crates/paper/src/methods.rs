//! The methods that are compared: the paper's, at a given angle or face count, and uniform refinement.

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::front::{Demand, Front, FrontError, Measure};
use limitmesh::refine::{
    Exact, ExactOptions, RefineError, Refinement, SeamRule, StepwiseOptions, UniformOptions, exact,
    stepwise, uniform,
};
use limitmesh::scheme::Loop;
use limitmesh::sqrt3::{self, Sqrt3Options};

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
    adaptive(
        control,
        &LimitNormal::new(angle_degrees.to_radians()),
        steps,
        seam,
    )
}

/// The method of Amresh, Farin and Razdan, angle in degrees.
///
/// # Errors
/// See [`RefineError`].
pub fn amresh(control: &Mesh, angle_degrees: f64, steps: usize) -> Result<Refinement, RefineError> {
    adaptive(
        control,
        &NeighbourNormal::new(angle_degrees.to_radians()),
        steps,
        SeamRule::All,
    )
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
    stepwise(
        control,
        &Loop,
        criterion,
        &StepwiseOptions::default().levels(steps).seam(seam),
    )
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

/// Levels at most of restricted quadtrees: where the surface has no tangent plane, some criteria are never met.
pub const DEEPEST: u32 = 8;

/// A criterion of the literature over a restricted quadtree: the least limit that takes at most so many faces, within [`DEEPEST`] levels.
///
/// # Errors
/// See [`FrontError`].
pub fn restricted(control: &Mesh, measure: Measure, faces: usize) -> Result<Mesh, FrontError> {
    let mut front = Front::measured_by(control, &Loop, measure)?;
    front.update(&Demand::tolerance(0.0).triangles(faces).max_levels(DEEPEST))?;
    front.mesh()
}

/// Adaptive √3-subdivision: the best mesh with at most so many faces, its vertices on the limit surface.
///
/// # Errors
/// See [`RefineError`].
pub fn sqrt3_with(control: &Mesh, faces: usize) -> Result<Mesh, RefineError> {
    Ok(sqrt3::adaptive(control, &Sqrt3Options::default().triangles(Some(faces)))?.mesh)
}

/// What stands for the limit surface of √3-subdivision, and its number of uniform steps: an even one, `least` at least and more while they
/// give no more than `most` faces. (Every second step divides boundaries.)
///
/// # Errors
/// See [`RefineError`].
pub fn sqrt3_reference(
    control: &Mesh,
    least: u32,
    most: usize,
) -> Result<(Mesh, usize), RefineError> {
    let mut steps = least.next_multiple_of(2);
    while control
        .face_count()
        .saturating_mul(3usize.saturating_pow(steps + 2))
        <= most
    {
        steps += 2;
    }
    let options = UniformOptions::default().levels(steps as usize).limit(true);
    Ok((sqrt3::uniform(control, &options)?.mesh, steps as usize))
}
