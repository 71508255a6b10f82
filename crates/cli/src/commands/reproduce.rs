//! `limitmesh reproduce`: the paper's table and figures, measured and drawn anew.

use std::path::Path;
use std::time::Instant;

use limitmesh::Mesh;
use limitmesh_paper::{Host, Request, reproduce};

use crate::arguments::ReproduceArguments;
use crate::failure::Outcome;
use crate::format::{counted, seconds};
use crate::input;
use crate::output;
use crate::progress::Progress;

/// Runs the command.
pub(crate) fn run(arguments: &ReproduceArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let start = Instant::now();
    let request = Request {
        output: arguments.output.clone(),
        models: arguments.models.clone(),
        quick: arguments.quick,
    };
    let written = reproduce(&request, &Program { progress })?;
    progress.clear();
    output::print(&format!(
        "{} written in {}: {}",
        counted(written.files, "file", "files"),
        seconds(start.elapsed().as_secs_f64()),
        written.page.display()
    ))?;
    Ok(Outcome::Done)
}

/// How this program reads, writes and says what it does.
struct Program<'a> {
    progress: &'a Progress<'a>,
}

impl Host for Program<'_> {
    fn load(&self, name: &str) -> anyhow::Result<Mesh> {
        Ok(input::load(Path::new(name), &Default::default(), &[], self.progress)?.mesh)
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        output::write_file(path, bytes)
    }

    fn stage(&self, what: &str) {
        self.progress.stage(what);
    }
}
