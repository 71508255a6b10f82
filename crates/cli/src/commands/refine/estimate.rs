//! `limitmesh refine --dry-run`: what an exact refinement would come to, without doing it.

use limitmesh::Mesh;
use limitmesh::refine::{Estimate, exact_estimate_observed};

use super::goals::Goals;
use crate::arguments::RefineArguments;
use crate::format::{bytes, counted};
use crate::output;
use crate::progress::Progress;
use crate::report::{
    DiagnosisReport, EstimateReport, InputReport, ParametersReport, PredictionReport, VERSION,
};

/// Predicts triangles and memory; prints them, or writes the report asked for.
pub(super) fn run(
    control: &Mesh,
    goals: &Goals,
    arguments: &RefineArguments,
    (input, diagnosis, parameters): (InputReport, DiagnosisReport, ParametersReport),
    progress: &Progress,
) -> anyhow::Result<()> {
    progress.stage("estimating");
    let options = goals.options(arguments);
    let found = exact_estimate_observed(
        control,
        arguments.scheme()?,
        &options,
        &mut progress.observer(),
    )?;
    progress.clear();
    // A report on standard output is not mixed with text for people.
    if arguments
        .report
        .as_deref()
        .is_none_or(|path| !output::is_standard_output(path))
    {
        output::print(&format!("{}: {}", input.path, in_words(&found, arguments)))?;
    }
    let Some(path) = &arguments.report else {
        return Ok(());
    };
    let report = PredictionReport {
        version: VERSION,
        input,
        diagnosis,
        parameters,
        estimate: EstimateReport {
            triangles: found.triangles,
            memory_bytes: found.memory_bytes,
            counted: found.is_counted,
        },
    };
    output::write_json(path, &report)
}

fn in_words(found: &Estimate, arguments: &RefineArguments) -> String {
    let is_capped = found.triangles == arguments.max_triangles();
    format!(
        "{}{}{}, at most about {} of memory while it refines; nothing was written",
        if found.is_counted { "" } else { "about " },
        counted(found.triangles, "triangle", "triangles"),
        if is_capped {
            ", where --max-triangles ends it"
        } else {
            ""
        },
        bytes(found.memory_bytes)
    )
}
