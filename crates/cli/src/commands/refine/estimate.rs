//! `limitmesh refine --dry-run`: a prediction of an exact refinement, without doing it.

use limitmesh::refine::{Estimate, exact_estimate_observed};

use super::goals::Goals;
use super::task::Task;
use crate::arguments::RefineArguments;
use crate::format::{bytes, counted};
use crate::output;
use crate::report::{EstimateReport, InputReport, ParametersReport, PredictionReport, VERSION};

/// Predicts triangles and memory; prints them, or writes the report asked for.
pub(super) fn run(
    task: &Task<'_>,
    goals: &Goals,
    input: InputReport,
    parameters: ParametersReport,
) -> anyhow::Result<()> {
    let (arguments, progress) = (task.arguments, task.progress);
    progress.stage("estimating");
    let options = goals.options(task);
    let observer = &mut progress.observer();
    let found = exact_estimate_observed(task.mesh(), task.scheme()?, &options, observer)?;
    progress.clear();
    let path = arguments.report.as_deref();
    // A report on standard output is not mixed with text for people.
    if !path.is_some_and(output::is_standard_output) {
        output::print(&format!("{}: {}", input.path, in_words(&found, arguments)))?;
    }
    let Some(path) = path else { return Ok(()) };
    let estimate = EstimateReport {
        triangles: found.triangles,
        memory_bytes: found.memory_bytes,
        counted: found.is_counted,
    };
    let report = PredictionReport {
        version: VERSION,
        input,
        diagnosis: (&task.control.diagnosis).into(),
        parameters,
        estimate,
    };
    output::write_json(path, &report)
}

fn in_words(found: &Estimate, arguments: &RefineArguments) -> String {
    let about = if found.is_counted { "" } else { "about " };
    let triangles = counted(found.triangles, "triangle", "triangles");
    let capped = match found.triangles == arguments.max_triangles() {
        true => ", where --max-triangles ends it",
        false => "",
    };
    let memory = bytes(found.memory_bytes);
    format!(
        "{about}{triangles}{capped}, at most about {memory} of memory while it refines; nothing was written"
    )
}
