//! `limitmesh measure`.

use std::path::PathBuf;

use clap::Args;

use super::{BuildArguments, SchemeName, values};

const EXAMPLES: &str = "\
Examples:
  limitmesh measure refined.ply scan.ply
        how far one mesh is from another, both ways
  limitmesh measure refined.ply --limit-of control.obj --samples 500000 --json
        how far a refined mesh is from the limit surface of its control mesh
  limitmesh measure refined.ply --limit-of control.obj --heatmap error.png";

/// Measure the symmetric Hausdorff distance between two surfaces
///
/// The distance is sampled on vertices, edges and faces of both: a lower bound of the true one. It is given
/// as a length and in per cent of the bounding-box diagonal of the reference, which is B or the limit surface.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct MeasureArguments {
    /// The mesh to measure: a file or builtin:NAME
    #[arg(value_name = "A")]
    pub(crate) surface: String,

    /// The mesh to measure it against: a file or builtin:NAME
    #[arg(value_name = "B", required_unless_present = "limit_of", conflicts_with = "limit_of")]
    pub(crate) reference: Option<String>,

    /// Measure against the limit surface of this control mesh
    ///
    /// The limit surface is represented by uniform refinement of the control mesh with all vertices moved to
    /// the limit.
    #[arg(long, value_name = "CONTROL")]
    pub(crate) limit_of: Option<String>,

    /// Levels of uniform refinement that stand for the limit surface
    ///
    /// Default: 5, or fewer where they would give more than 4 million triangles. With --limit-of only.
    #[arg(long, value_name = "N", value_parser = values::levels)]
    pub(crate) reference_levels: Option<usize>,

    /// Scheme of the limit surface [default: loop]; with --limit-of only
    #[arg(long, value_enum)]
    pub(crate) scheme: Option<SchemeName>,

    /// Samples on each surface; all its vertices are among them, however many they are
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = values::samples)]
    pub(crate) samples: usize,

    #[command(flatten)]
    pub(crate) build: BuildArguments,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,

    /// Write A coloured by its distance to the reference: a mesh (.ply) or a picture (.png)
    ///
    /// The mesh has the distance of each vertex as its quality, in the mesh's unit; the picture shows it in per
    /// cent of the reference's diagonal.
    #[arg(long, value_name = "FILE")]
    pub(crate) heatmap: Option<PathBuf>,
}
