//! `limitmesh completions` and `limitmesh man`, which no help lists: for whoever packages the program or sets up a shell.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

/// Print what makes a shell complete commands and options
#[derive(Args, Debug)]
pub(crate) struct CompletionsArguments {
    /// The shell
    pub(crate) shell: Shell,
}

/// Write a page of the manual for the program and for each command
#[derive(Args, Debug)]
pub(crate) struct ManArguments {
    /// An existing folder
    pub(crate) folder: PathBuf,
}
