//! `limitmesh compare`.

use std::path::PathBuf;

use clap::Args;

use super::limit::LimitArguments;
use super::shared::of_triangles;
use super::values;

const EXAMPLES: &str = "\
Examples:
  limitmesh compare builtin:head
  limitmesh compare control.obj --angle 5 --levels 4 --json";

/// Compare the methods at equal triangle counts
///
/// Refines by limit normals with the angle and levels given, finds the angle at which the method of Amresh,
/// Farin and Razdan gives nearly as many triangles, the level at which uniform refinement comes nearest,
/// without and with its vertices moved to the limit surface, and the best meshes of exact refinement with no more
/// triangles: plain, balanced and optimised. Added to them are criteria of the literature with no more triangles over restricted
/// quadtrees of eight levels, planarity by angle and by distance (Zorin, Schröder and Sweldens) and vertex errors (Müller and Jaeschke), and
/// √3-subdivision (Kobbelt). Each is measured against its scheme's limit surface.
#[derive(Args, Debug, Clone)]
#[command(after_help = EXAMPLES)]
#[command(mut_arg("scheme", |scheme| scheme.value_parser(of_triangles()).help("Scheme of the limit surface [default: loop]")))]
#[command(mut_arg("smooth_triangles", |smooth| smooth.hide(true)))]
pub(crate) struct CompareArguments {
    /// Control mesh: a file, - for standard input, or builtin:NAME
    pub(crate) input: PathBuf,

    /// Angle of the limit-normal method [degrees, above 0 to 180]
    #[arg(long, value_name = "DEG", default_value_t = 10.0, value_parser = values::angle, allow_hyphen_values = true)]
    pub(crate) angle: f64,

    /// Steps of the adaptive methods
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = values::steps)]
    pub(crate) levels: usize,

    /// Samples on each surface; all its vertices are among them, however many they are
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = values::samples)]
    pub(crate) samples: usize,

    #[command(flatten)]
    pub(crate) limit: LimitArguments,

    /// Print JSON instead of a table
    #[arg(long)]
    pub(crate) json: bool,
}
