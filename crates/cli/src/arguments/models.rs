//! `limitmesh models`.

use clap::Args;

/// List the built-in models
#[derive(Args, Debug)]
pub(crate) struct ModelsArguments {
    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}
