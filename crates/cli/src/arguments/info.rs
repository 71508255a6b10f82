//! `limitmesh info`.

use std::path::PathBuf;

use clap::Args;

use super::features::FeatureArguments;
use super::shared::BuildArguments;

const EXAMPLES: &str = "\
Examples:
  limitmesh info scan.stl
  limitmesh info builtin:cup --json
  limitmesh info part.stl --limit --crease-angle 30
        with the area and volume of the smooth surface";

/// Say what is in a file and what would be repaired
///
/// Lists the findings with the first few faces or vertices, counted from 0 as in the file, then the control
/// mesh that refinement would start from: topology, valences, extent, triangle quality.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct InfoArguments {
    /// Mesh file (.obj, .ply, .stl, .off, .gltf, .glb, .3mf), - for standard input, or builtin:NAME
    pub(crate) input: PathBuf,

    /// Say also the area and the volume of the limit surface of the control mesh (Loop's scheme), to some 1e-9 of them
    #[arg(long)]
    pub(crate) limit: bool,

    // Of the limit surface: with --limit only.
    #[command(flatten)]
    pub(crate) features: FeatureArguments,

    #[command(flatten)]
    pub(crate) build: BuildArguments,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}
