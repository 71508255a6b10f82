//! √3-subdivision: uniform steps, and adaptive to an angle, an estimated distance or a number of triangles.

use limitmesh::limit::SidedNormals;
use limitmesh::progress::Observer;
use limitmesh::refine::{ExactStop, UniformOptions};
use limitmesh::sqrt3::{Sqrt3Options, adaptive_observed, uniform_observed};

use super::stepwise::BYTES_PER_TRIANGLE;
use super::{Normals, Refined, stepwise};
use crate::control::Control;
use crate::errors::Failure;
use crate::options::Goals;
use crate::origins::Trail;

/// A triangle of an adaptive refinement in bytes, with those that it came from and what is known of them: measured, rounded up.
const BYTES_PER_ADAPTIVE: usize = 2500;

/// Divides what fails, by its centre, the worst first.
pub(super) fn to_goals(
    control: Control,
    goals: &Goals,
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let options = Sqrt3Options::default()
        .angle(goals.angle.map(f64::to_radians))
        .tolerance(
            goals
                .tolerance
                .map(|tolerance| tolerance.of(control.diagonal)),
        )
        .triangles(goals.triangles)
        .max_triangles(goals.cap(BYTES_PER_ADAPTIVE))
        .origins(goals.origins);
    let options = goals
        .max_levels
        .map_or(options, |levels| options.max_levels(levels));
    let found = adaptive_observed(&control.mesh, &options, observer)?;
    let normals = Normals::of_sides(&found.mesh, found.normals);
    // Nothing is known from below, and nothing is proven.
    let at = found.mesh.positions().first().copied().unwrap_or_default();
    Ok(Refined {
        parents: control.tables.input_faces(found.parents),
        origins: Trail::Known(found.origins),
        error: found
            .estimated_distance
            .map(|distance| (0.0, distance, false, at.into())),
        stop: match found.stop {
            ExactStop::TriangleCap => goals.cap_name(BYTES_PER_ADAPTIVE),
            stop => stop.name(),
        },
        levels: found.levels,
        ..Refined::of_mesh(found.mesh, normals, control.tables)
    })
}

/// Divides everything, step by step.
pub(super) fn by_steps(
    control: Control,
    goals: &Goals,
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let options = UniformOptions::default()
        .levels(goals.levels)
        .origins(goals.origins)
        .normals(true)
        .max_triangles(goals.cap(BYTES_PER_TRIANGLE));
    let found = uniform_observed(&control.mesh, &options, observer)?;
    let none = || Normals {
        corners: Vec::new(),
        of_corners: Vec::new(),
        by_vertex: Vec::new(),
    };
    let of_sides = |sided: SidedNormals| Normals::of_sides(&found.mesh, sided);
    let normals = found.normals.map_or_else(none, of_sides);
    Ok(Refined {
        parents: control.tables.input_faces(found.parents),
        origins: Trail::Known(found.origins),
        stop: stepwise::stop_name(&found.stop, goals),
        levels: found.steps.len(),
        ..Refined::of_mesh(found.mesh, normals, control.tables)
    })
}
