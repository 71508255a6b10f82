//! The methods that the figures show.

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::refine::{StepwiseOptions, UniformOptions, stepwise};
use limitmesh::scheme::Loop;

/// Uniform refinement, vertices as the scheme leaves them or moved to the limit surface.
pub(super) fn uniform(control: &Mesh, levels: usize, limit: bool) -> Result<Mesh> {
    let options = UniformOptions::default().levels(levels).limit(limit);
    Ok(limitmesh::refine::uniform(control, &Loop, &options)?.mesh)
}

/// The paper's method, angle in degrees.
pub(super) fn paper(control: &Mesh, angle: f64, steps: usize) -> Result<Mesh> {
    by(control, &LimitNormal::new(angle.to_radians()), steps)
}

/// The method of Amresh, Farin and Razdan, angle in degrees.
pub(super) fn amresh(control: &Mesh, angle: f64, steps: usize) -> Result<Mesh> {
    by(control, &NeighbourNormal::new(angle.to_radians()), steps)
}

fn by(control: &Mesh, criterion: &dyn Criterion, steps: usize) -> Result<Mesh> {
    Ok(stepwise(control, &Loop, criterion, &StepwiseOptions::default().levels(steps))?.mesh)
}

/// The angle in degrees at which the paper's method gives about so many triangles, and that mesh.
pub(super) fn paper_with(control: &Mesh, triangles: usize, steps: usize) -> Result<(f64, Mesh)> {
    /// Halvings of the range: the count's own steps are wider by then.
    const HALVINGS: usize = 16;
    let (mut low, mut high) = (0.0, 90.0);
    let mut best: Option<(f64, Mesh)> = None;
    for _ in 0..HALVINGS {
        let angle = 0.5 * (low + high);
        let mesh = paper(control, angle, steps)?;
        if mesh.face_count() > triangles {
            low = angle
        } else {
            high = angle
        }
        let miss = |mesh: &Mesh| mesh.face_count().abs_diff(triangles);
        if best.as_ref().is_none_or(|(_, met)| miss(&mesh) < miss(met)) {
            best = Some((angle, mesh));
        }
    }
    best.ok_or_else(|| anyhow::anyhow!("no angle was tried"))
}
