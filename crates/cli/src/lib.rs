//! The `limitmesh` program: refine a triangle mesh within a distance of its limit surface, measure it, compare methods, draw it.
//!
//! Takes the command line, gives files, text on standard output and an exit code: 0 done, 1 bad input or
//! output, 2 usage, 3 stopped short of what was asked. Messages go to standard error, so that a report or a
//! measurement can be piped.
//!
//! The program is [`program`]; other programs, such as the Python package, run its commands on files through [`refine_files`] and [`batch`], and
//! look at meshes through [`examined`].

mod arguments;
mod bulk;
mod commands;
mod creases;
mod dihedral;
mod embedded;
mod failure;
mod file_identity;
mod format;
mod input;
mod interrupt;
mod mesh_info;
mod output;
mod parts;
mod pieces;
mod points;
mod progress;
mod reference;
mod report;
mod rows;
#[cfg(test)]
mod tests;
mod vector;
mod written_unit;

use std::ffi::OsString;
use std::path::Path;

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use arguments::{Arguments, Command};
use failure::{Outcome, UsageError, is_broken_pipe};
use progress::Progress;

pub use commands::batch::{BatchCounts, RemoteFiles};
pub use embedded::{Failure, Refined, batch, examined, refine_files};
pub use progress::Host;

/// The program with a command line, whose first word is the program's name; gives its exit code. Where the command line makes no sense, or
/// asks for help, the process ends here. `again` starts this program in another process: its file, and what comes before the arguments.
pub fn program(words: impl IntoIterator<Item = OsString>, again: &[OsString]) -> u8 {
    let arguments = parse(words);
    let progress = Progress::new(arguments.global.quiet);
    let result = prepare(&arguments).and_then(|()| run(&arguments, again, &progress));
    progress.clear();
    match result {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::StoppedShort(why)) => {
            failure::print_stopped_short(&why);
            3
        }
        Err(error) if is_broken_pipe(&error) => 0,
        Err(error) => match error.downcast_ref::<UsageError>() {
            Some(UsageError(what)) => {
                failure::print_usage_error(what);
                2
            }
            None => {
                failure::print(&error);
                1
            }
        },
    }
}

/// The arguments of a command line; ends the process where they make no sense or ask for help.
fn parse(words: impl IntoIterator<Item = OsString>) -> Arguments {
    Arguments::try_parse_from(words).unwrap_or_else(|mut error| {
        // Both options are written as they should be: it is their meaning that clashes.
        if error.kind() == ErrorKind::ArgumentConflict {
            error.remove(ContextKind::Usage);
        }
        if let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(word))) =
            (error.kind(), error.get(ContextKind::InvalidSubcommand))
            && Path::new(word).extension().is_some()
        {
            failure::print_usage_error(&format!(
                "'{word}' is no command; `limitmesh refine {word}` smooths a file"
            ));
            std::process::exit(2);
        }
        error.exit()
    })
}

/// Sets up what holds for the whole process: the thread pool and what Ctrl-C does.
fn prepare(arguments: &Arguments) -> anyhow::Result<()> {
    interrupt::install()?;
    // The batch itself computes nothing.
    if matches!(arguments.command, Command::Batch(_)) {
        return Ok(());
    }
    // This thread is one of them: idle ones look for work for a while before they sleep, and would take its time.
    rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.global.threads)
        .use_current_thread()
        .build_global()?;
    Ok(())
}

fn run(arguments: &Arguments, again: &[OsString], progress: &Progress) -> anyhow::Result<Outcome> {
    match &arguments.command {
        Command::Refine(arguments) => commands::refine::run(arguments, progress),
        Command::Measure(arguments) => commands::measure::run(arguments, progress),
        Command::Compare(arguments) => commands::compare::run(arguments, progress),
        Command::View(arguments) => commands::view::run(arguments, progress),
        Command::Render(arguments) => commands::render::run(arguments, progress),
        Command::Reproduce(arguments) => commands::reproduce::run(arguments, progress),
        Command::Info(arguments) => commands::info::run(arguments, progress),
        Command::Evaluate(arguments) => commands::evaluate::run(arguments, progress),
        Command::Project(arguments) => commands::project::run(arguments, progress),
        Command::Lod(arguments) => commands::lod::run(arguments, progress),
        Command::Models(arguments) => commands::models::run(arguments),
        Command::Batch(own) => commands::batch::run(own, again, arguments.global.threads, progress),
        Command::BatchJob(arguments) => commands::batch_job::run(arguments, progress),
        Command::Completions(arguments) => commands::shipped::completions(arguments),
        Command::Man(arguments) => commands::shipped::man(arguments),
    }
}
