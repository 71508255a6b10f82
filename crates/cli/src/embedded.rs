//! Commands for other programs, in their process: arguments as on the command line in, what is said of the work back.

use std::ffi::OsString;
use std::fmt;

use clap::Parser;
use limitmesh::Mesh;

use crate::arguments::{Arguments, Command};
use crate::commands;
use crate::commands::batch::{BatchCounts, RemoteFiles};
use crate::failure::{Outcome, UsageError};
use crate::mesh_info;
use crate::output;
use crate::progress::{Host, Progress};

/// Why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The arguments make no sense.
    Usage(String),
    /// A file is at fault, or what it holds.
    Input(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Usage(what) | Self::Input(what)) = self;
        f.write_str(what)
    }
}

impl std::error::Error for Failure {}

/// How a command ended.
#[derive(Debug)]
pub struct Refined {
    /// Where a cap was reached before what was asked for: which.
    pub stopped_short: Option<String>,
}

/// `limitmesh refine` with these arguments, on the current thread pool. Files are written whole or not at all, a report where
/// `--report` says.
///
/// # Errors
/// As the program's; the host stopped it.
pub fn refine_files(
    arguments: impl IntoIterator<Item = OsString>,
    host: &dyn Host,
) -> Result<Refined, Failure> {
    refined(arguments, &Progress::to_host(host))
}

/// [`refine_files`], heard by the program itself.
pub(crate) fn refined(
    arguments: impl IntoIterator<Item = OsString>,
    progress: &Progress,
) -> Result<Refined, Failure> {
    let parsed = parsed("refine", arguments)?;
    let Command::Refine(arguments) = &parsed.command else {
        return Err(Failure::Usage("that is not limitmesh refine".to_owned()));
    };
    match commands::refine::run(arguments, progress) {
        Ok(Outcome::Done) => Ok(Refined {
            stopped_short: None,
        }),
        Ok(Outcome::StoppedShort(why)) => Ok(Refined {
            stopped_short: Some(why),
        }),
        Err(error) => Err(failure(error)),
    }
}

/// `limitmesh batch` with these arguments: each job in a process of its own, which `again` starts as for [`program`](crate::program). Files
/// at addresses such as `s3://bucket/a.stl` are copied by the caller.
///
/// # Errors
/// As the program's, but for jobs that fail; the host stopped it.
pub fn batch(
    arguments: impl IntoIterator<Item = OsString>,
    again: &[OsString],
    remote: &dyn RemoteFiles,
    host: &dyn Host,
) -> Result<BatchCounts, Failure> {
    let parsed = parsed("batch", arguments)?;
    let Command::Batch(arguments) = &parsed.command else {
        return Err(Failure::Usage("that is not limitmesh batch".to_owned()));
    };
    let (threads, progress) = (parsed.global.threads, Progress::to_host(host));
    commands::batch::work(arguments, again, threads, Some(remote), &progress).map_err(failure)
}

/// The arguments of a command.
fn parsed(
    command: &str,
    arguments: impl IntoIterator<Item = OsString>,
) -> Result<Arguments, Failure> {
    let words = ["limitmesh", command].into_iter().map(OsString::from);
    Arguments::try_parse_from(words.chain(arguments))
        .map_err(|why| Failure::Usage(first_line(&why.to_string())))
}

fn failure(error: anyhow::Error) -> Failure {
    match error.downcast_ref::<UsageError>() {
        Some(UsageError(what)) => Failure::Usage(what.clone()),
        None => Failure::Input(in_words(&error)),
    }
}

/// The message of clap, without the hints for a terminal.
fn first_line(text: &str) -> String {
    let text = text.lines().next().unwrap_or_default();
    text.strip_prefix("error: ").unwrap_or(text).to_owned()
}

/// An error and its causes in one line, each said once.
fn in_words(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1) {
        let words = cause.to_string();
        if !text.ends_with(&words) {
            text.push_str(": ");
            text.push_str(&words);
        }
    }
    text
}

/// The properties of a mesh, as JSON: `mesh` of the report of `limitmesh info`. `faces` are the input's that its own are from; none where
/// these are not known.
///
/// # Errors
/// A number that JSON cannot hold.
pub fn examined(mesh: &Mesh, faces: &[u32]) -> anyhow::Result<String> {
    output::json(&mesh_info::examine(mesh, faces))
}
