//! Refinement step by step: by the paper's criterion, and by the one it is compared with.

use limitmesh::carry::carried;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::limit::LimitTable;
use limitmesh::progress::Observer;
use limitmesh::refine::{StepwiseOptions, Stop, stepwise_observed};

use super::{Method, Normals, Refined};
use crate::control::{Control, Recipe};
use crate::errors::Failure;
use crate::options::Goals;
use crate::origins::Trail;

/// The angle where none is given, in degrees: the paper's middle one.
const USUAL_ANGLE: f64 = 10.0;

/// A triangle with what refining it takes besides, in bytes: measured for uniform refinement, rounded up.
pub(super) const BYTES_PER_TRIANGLE: usize = 200;

/// Refines a control mesh by steps.
pub(super) fn refined(
    control: Control,
    recipe: &Recipe,
    (method, goals): (Method, &Goals),
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let angle = goals.angle.unwrap_or(USUAL_ANGLE).to_radians();
    let criterion: Box<dyn Criterion> = match (method, goals.viewer()) {
        (Method::Amresh, _) => Box::new(NeighbourNormal::new(angle)),
        (_, Some(view)) => Box::new(LimitNormal::new(angle).view(view)),
        (_, None) => Box::new(LimitNormal::new(angle)),
    };
    let (mesh, scheme, cap) = (&control.mesh, recipe.scheme, goals.cap(BYTES_PER_TRIANGLE));
    let carries = !control.channels.is_empty();
    let options = StepwiseOptions::default()
        .levels(goals.levels)
        .origins(carries || goals.origins)
        .max_triangles(cap);
    let found = stepwise_observed(mesh, scheme, criterion.as_ref(), &options, observer)?;
    let channels = match carries {
        true => carried(&control.channels, mesh, scheme, &found)?,
        false => Vec::new(),
    };
    let normals = Normals::of_sides(
        &found.mesh,
        LimitTable::new(scheme).sided_normals(&found.mesh)?,
    );
    Ok(Refined {
        parents: control.tables.input_faces(found.parents),
        origins: Trail::Known(found.origins),
        channels,
        stop: stop_name(&found.stop, goals),
        levels: found.steps.len(),
        ..Refined::of_mesh(found.mesh, normals, control.tables)
    })
}

/// Why steps ended, as Python has it.
pub(super) fn stop_name(stop: &Stop, goals: &Goals) -> &'static str {
    match stop {
        Stop::Levels => "levels",
        Stop::Satisfied => "satisfied",
        Stop::TriangleCap { .. } => goals.cap_name(BYTES_PER_TRIANGLE),
        _ => "other",
    }
}
