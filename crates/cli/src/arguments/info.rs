//! `limitmesh info`.

use std::path::PathBuf;

use clap::Args;

use super::shared::BuildArguments;

const EXAMPLES: &str = "\
Examples:
  limitmesh info scan.stl
  limitmesh info builtin:cup --json";

/// Say what is in a file and what would be repaired
///
/// Lists the findings with the first few faces or vertices, counted from 0 as in the file, then the control
/// mesh that refinement would start from: topology, valences, extent, triangle quality.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct InfoArguments {
    /// Mesh file (.obj, .ply, .stl, .off, .gltf, .glb, .3mf), - for standard input, or builtin:NAME
    pub(crate) input: PathBuf,

    #[command(flatten)]
    pub(crate) build: BuildArguments,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}
