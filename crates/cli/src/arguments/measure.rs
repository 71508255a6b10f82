//! `limitmesh measure`.

use std::path::PathBuf;

use clap::Args;

use super::limit::LimitArguments;
use super::values::{self, Extent};

const EXAMPLES: &str = "\
Examples:
  limitmesh measure refined.ply scan.ply
        how far one mesh is from another, both ways
  limitmesh measure refined.ply --limit-of control.obj --samples 500000 --json
        how far a refined mesh is from the limit surface of its control mesh
  limitmesh measure refined.ply --limit-of control.obj --heatmap error.png
  limitmesh measure refined.ply scan.ply --certified --gap 0.01%
        between which two values the distance certainly lies
  limitmesh measure refined.ply --limit-of control.obj --certified
        the same against the true limit surface";

/// Measure the symmetric Hausdorff distance between two surfaces
///
/// The distance is sampled on vertices, edges and faces of both: a lower bound of the true one. It is given
/// as a length and in per cent of a bounding box's diagonal: the control mesh's with --limit-of, as in refine; else B's.
/// With --certified it is bounded from both sides instead.
#[derive(Args, Debug, Clone)]
#[command(after_help = EXAMPLES)]
#[command(mut_arg("scheme", |scheme| scheme.help("Scheme of the limit surface [default: catmull-clark for files whose faces are quads for the most part, else loop]; with --limit-of only")))]
pub(crate) struct MeasureArguments {
    /// The mesh to measure: a file, - for standard input, or builtin:NAME
    #[arg(value_name = "A")]
    pub(crate) surface: PathBuf,

    /// The mesh to measure it against: a file or builtin:NAME
    #[arg(
        value_name = "B",
        required_unless_present = "limit_of",
        conflicts_with = "limit_of"
    )]
    pub(crate) reference: Option<PathBuf>,

    /// Measure against the limit surface of this control mesh
    ///
    /// The limit surface is represented by uniform refinement of the control mesh with all vertices moved to
    /// the limit.
    #[arg(long, value_name = "CONTROL")]
    pub(crate) limit_of: Option<PathBuf>,

    /// Levels of uniform refinement that approximate the limit surface
    ///
    /// Default: 5, or fewer where they would give more than 4 million triangles, but two more than the first mesh has. With
    /// --limit-of only.
    #[arg(long, value_name = "N", value_parser = values::steps)]
    pub(crate) reference_levels: Option<usize>,

    /// Samples on each surface; all its vertices are among them, however many they are
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = values::samples)]
    pub(crate) samples: usize,

    /// Bound the distance from both sides instead of sampling it: no point is farther away than the upper bound
    ///
    /// Branch and bound over the triangles of both meshes. The interval is as narrow as --gap says, or wider if
    /// the work runs out first (exit code 3). With --limit-of, exact refinement approximates the limit surface, as finely as
    /// the interval needs it; what it is off by at most is part of the interval.
    #[arg(long, conflicts_with = "samples")]
    pub(crate) certified: bool,

    /// How wide the interval may be: a length, or per cent such as 0.01%
    ///
    /// Per cent are of the control mesh's diagonal with --limit-of, else of B's. Default: 1 % of the distance, with --limit-of 10 %; or 0.0001% of
    /// the diagonal where that is more. With --certified only.
    #[arg(long, value_name = "G", value_parser = values::extent, allow_hyphen_values = true)]
    pub(crate) gap: Option<Extent>,

    /// Work after which the interval is given as it is, in each direction [default: 1G, from half a minute to some minutes]
    ///
    /// A unit is a piece of a triangle bounded, or a triangle or box looked at for that: how long one takes depends on how
    /// much of the other mesh is near. With --certified only.
    #[arg(long, value_name = "N", value_parser = values::work)]
    pub(crate) max_work: Option<u64>,

    // But for what is said of files, with --limit-of only.
    #[command(flatten)]
    pub(crate) limit: LimitArguments,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,

    /// Write A coloured by its distance to the reference: a mesh (.ply) or a picture (.png)
    ///
    /// The mesh has the distance of each vertex as its quality, in the mesh's unit; the picture shows it in per
    /// cent of the control mesh's diagonal with --limit-of, else of B's.
    #[arg(long, value_name = "FILE")]
    pub(crate) heatmap: Option<PathBuf>,
}
