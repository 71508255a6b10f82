//! `limitmesh project`.

use std::path::PathBuf;

use clap::Args;

use super::limit::LimitArguments;
use super::shared::OverwriteArguments;
use super::shared::of_polynomials;
use super::values::{self, Extent};

const EXAMPLES: &str = "\
Examples:
  limitmesh project scan.ply --onto control.obj -o deviation.ply
        how far each vertex of a scan is from the limit surface, as a colour map with distances and places
  limitmesh project scan.stl --onto control.obj --crease-angle 30 -o deviation.png
  limitmesh project probes.csv --onto control.obj -o deviation.csv --json
        points of a coordinate measuring machine: x, y, z in a line";

/// Project points onto a limit surface: distances, closest points, and which are inside
///
/// POINTS are the vertices of a mesh, or a text file with three coordinates a line (.xyz, .txt, .csv, .asc; .pts, whose first line may
/// be their number), between blanks, commas or semicolons. Each is projected onto the limit surface of CONTROL itself, not onto a mesh
/// that approximates it: no point of the surface is nearer by more than --tolerance.
/// Distances are below 0 inside of a closed surface; where it is open, behind it, as its normal at the closest point says.
/// With --scheme catmull-clark control faces are halves of quads, those of the first quad 0 and 1.
#[derive(Args, Debug, Clone)]
#[command(after_help = EXAMPLES)]
#[command(mut_arg("scheme", |scheme| scheme.value_parser(of_polynomials())))]
pub(crate) struct ProjectArguments {
    /// Points: a mesh or text file, - for standard input, or builtin:NAME
    #[arg(value_name = "POINTS")]
    pub(crate) points: PathBuf,

    /// Control mesh of the limit surface: a file or builtin:NAME
    #[arg(long, value_name = "CONTROL")]
    pub(crate) onto: PathBuf,

    /// How much nearer the surface may be than what was found: a length, or per cent of the control mesh's diagonal
    #[arg(long, value_name = "T", value_parser = values::tolerance, default_value = "0.0001%", allow_hyphen_values = true)]
    pub(crate) tolerance: Extent,

    /// Write the points with what was found: .ply (coloured; closest points and places as properties), .csv, or .png (a picture, of meshes)
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) overwrite: OverwriteArguments,

    #[command(flatten)]
    pub(crate) limit: LimitArguments,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}
