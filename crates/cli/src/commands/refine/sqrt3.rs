//! √3-subdivision: uniform steps, and adaptive refinement to an angle, an estimated distance or a number of triangles.

use limitmesh::refine::UniformOptions;
use limitmesh::sqrt3::{Sqrt3Options, adaptive_observed, uniform_observed};

use super::super::normals::Normals;
use super::refined::{Refined, capped};
use super::stepwise;
use super::task::Task;
use crate::arguments::{Extent, RefineArguments};
use crate::format::counted;
use crate::report::refinement::ErrorReport;
use crate::report::{MethodReport, ParametersReport};

/// The tolerance where there is no other goal, in per cent of the diagonal: that of the exact method.
const USUAL_PERCENT: f64 = 0.1;

/// The options of adaptive refinement, defaults filled in.
pub(super) fn parameters(
    arguments: &RefineArguments,
    diagonal: f64,
) -> anyhow::Result<ParametersReport> {
    let goals = goals(arguments, diagonal)?;
    let (tolerance, levels) = (goals.tolerance, goals.max_levels);
    ParametersReport::of_goals(arguments.angle, tolerance, diagonal, levels, arguments)
}

/// The goals and caps of an adaptive refinement.
fn goals(arguments: &RefineArguments, diagonal: f64) -> anyhow::Result<Sqrt3Options> {
    let exact = &arguments.exact;
    let usual = (arguments.angle.is_none() && exact.triangles.is_none())
        .then_some(Extent::Percent(USUAL_PERCENT));
    let length = |extent: Extent| extent.length(diagonal, arguments.build.unit);
    let options = Sqrt3Options::default()
        .angle(arguments.angle.map(f64::to_radians))
        .tolerance(exact.tolerance.or(usual).map(length).transpose()?)
        .triangles(exact.triangles)
        .max_triangles(Some(arguments.max_triangles()))
        .origins(exact.provenance);
    Ok(match arguments.levels {
        Some(levels) => options.max_levels(levels),
        None => options,
    })
}

/// Divides what fails, by its centre, the worst first.
pub(super) fn to_goals(task: &Task<'_>) -> anyhow::Result<Refined> {
    let (arguments, diagonal) = (task.arguments, task.control.diagonal);
    let options = goals(arguments, diagonal)?;
    task.begin();
    let found = adaptive_observed(task.mesh(), &options, &mut task.progress.observer())?;
    let mesh = found.mesh;
    let error = found
        .estimated_distance
        .map(|distance| ErrorReport::estimated(distance, diagonal, &mesh));
    let achieved = error
        .iter()
        .map(|error| error.in_words(&task.unit()))
        .collect();
    let report = MethodReport {
        error,
        ..MethodReport::new(found.levels, found.stop.name())
    };
    let how = counted(found.levels, "level", "levels") + " of √3-subdivision";
    let outcome = capped(&mesh, found.stop, arguments);
    Ok(Refined {
        normals: task
            .wants_normals()
            .then(|| Normals::of_sides(&mesh, found.normals)),
        provenance: task.provenance(&found.origins, &found.parents),
        achieved,
        ..Refined::new(mesh, how, report, outcome)
    })
}

/// Refines by steps, and moves the vertices to the limit if asked.
pub(super) fn by_steps(task: &Task<'_>) -> anyhow::Result<Refined> {
    let arguments = task.arguments;
    let levels = stepwise::levels(arguments);
    let options = UniformOptions::default()
        .levels(levels)
        .limit(arguments.limit)
        .normals(task.wants_normals())
        .max_triangles(Some(arguments.max_triangles()));
    let mut observer = stepwise::watch(levels, task.progress);
    let found = uniform_observed(task.mesh(), &options, &mut observer)?;
    let (mesh, steps) = (found.mesh, found.steps);
    let how = counted(
        steps.len(),
        "step of √3-subdivision",
        "steps of √3-subdivision",
    );
    let outcome = stepwise::outcome(arguments, &mesh, &steps, found.stop);
    Ok(Refined {
        normals: found.normals.map(|sided| Normals::of_sides(&mesh, sided)),
        ..Refined::new(mesh, how, stepwise::report(&steps, found.stop), outcome)
    })
}
