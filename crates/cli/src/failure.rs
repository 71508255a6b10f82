//! How a command can end: its outcomes, usage errors found after parsing, and how an error is printed.

use std::fmt;
use std::io;

/// How a command ended that gave a result.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// Everything asked for was done.
    Done,
    /// A result was written, but a cap was reached first; says which.
    StoppedShort(String),
}

/// The command line asks for something that makes no sense.
#[derive(Debug)]
pub(crate) struct UsageError(pub(crate) String);

impl fmt::Display for UsageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UsageError {}

/// A usage error as a result.
pub(crate) fn usage<T>(what: impl Into<String>) -> anyhow::Result<T> {
    Err(UsageError(what.into()).into())
}

/// Whether the reader of our output went away, as `head` does: no failure of ours.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<io::Error>()
            .is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    })
}

/// Prints why the command line makes no sense. What it means is at fault, not how it is written: a line on its usage would not help.
pub(crate) fn print_usage_error(what: &str) {
    eprintln!("error: {what}");
}

/// Prints why a result is less than what was asked for.
pub(crate) fn print_stopped_short(why: &str) {
    eprintln!("stopped short: {why}");
}

/// Prints an error and its causes, one to a line, on standard error.
///
/// Causes whose words the line above already ends with are left out.
pub(crate) fn print(error: &anyhow::Error) {
    let mut said = error.to_string();
    eprintln!("error: {said}");
    for cause in error.chain().skip(1) {
        let words = cause.to_string();
        if !said.ends_with(&words) {
            eprintln!("  caused by: {words}");
            said = words;
        }
    }
}
