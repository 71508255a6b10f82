//! A job of `limitmesh batch`, in the process that is its own: `limitmesh refine`, and a verdict after the report.

use super::batch::Verdict;
use crate::arguments::BatchJobArguments;
use crate::embedded::{self, Failure};
use crate::failure::Outcome;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;

/// Refines, and says on standard output how that went; ends when standard input does.
pub(crate) fn run(arguments: &BatchJobArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    interrupt::end_with_standard_input();
    let verdict = match embedded::refined(arguments.words.iter().cloned(), progress) {
        Ok(refined) => refined
            .stopped_short
            .map_or(Verdict::Done, |why| Verdict::StoppedShort { why }),
        Err(Failure::Usage(message)) => Verdict::Options { message },
        Err(Failure::Input(message)) => Verdict::File { message },
    };
    output::print(&serde_json::to_string(&verdict)?)?;
    Ok(Outcome::Done)
}
