//! `limitmesh refine --dry-run`: what an exact refinement would come to, without doing it.

use limitmesh::Mesh;
use limitmesh::refine::{Estimate, exact_estimate_observed};

use super::exact::Goals;
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
    let found =
        exact_estimate_observed(control, arguments.scheme.scheme(), &options, &mut progress.observer())?;
    progress.clear();
    // A report on standard output is not mixed with text for people.
    if arguments.report.as_deref().is_none_or(|path| path.as_os_str() != output::STANDARD_OUTPUT) {
        output::print(&in_words(&found))?;
    }
    let Some(path) = &arguments.report else { return Ok(()) };
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

fn in_words(found: &Estimate) -> String {
    format!(
        "{}{}, at most about {} of memory while it refines; nothing was written",
        if found.is_counted { "" } else { "about " },
        counted(found.triangles, "triangle", "triangles"),
        bytes(found.memory_bytes)
    )
}
