//! `limitmesh refine`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::values;
use super::{BuildArguments, SchemeName, Seam};

/// What decides which faces are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Method {
    /// Faces whose normal leaves the cone around a limit normal of their vertices
    LimitNormal,
    /// Faces whose normal differs too much from an edge neighbour's (Amresh, Farin and Razdan)
    Amresh,
    /// All faces
    Uniform,
}

const EXAMPLES: &str = "\
Examples:
  limitmesh refine builtin:cup -o cup.ply --angle 5 --levels 4 --report cup.json
  limitmesh refine scan.stl -o smooth.obj --weld 1e-6
  limitmesh refine builtin:sphere -o seen.ply --view 0,0,-1 --levels 5
  limitmesh refine big.ply -o fine.ply --method uniform --max-triangles 20000000

Exit code 3 means that --max-triangles was reached before the levels asked for; the file is written.";

/// Refine a mesh where it stands badly for its smooth limit surface
///
/// Each step marks the faces that the method calls divisible, splits them in four, and closes the gaps to
/// their neighbours, so that the mesh is free of cracks after every step.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RefineArguments {
    /// Mesh file (.obj, .ply, .stl, .off) or builtin:NAME
    pub(crate) input: String,

    /// File to write; its extension (.obj, .ply, .stl, .off) chooses the format
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// What decides which faces are divided
    #[arg(long, value_enum, default_value = "limit-normal")]
    pub(crate) method: Method,

    /// The angle that a face's normal may differ by [degrees, above 0 to 180; default: 10]
    ///
    /// Smaller angles divide more faces. For limit-normal it is the cone around the limit normals of the
    /// face's vertices; for amresh the angle between neighbouring faces. Not with --method uniform.
    #[arg(long, value_name = "DEG", value_parser = values::angle, allow_hyphen_values = true)]
    pub(crate) angle: Option<f64>,

    /// Greatest number of steps; each splits an edge at most once
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = values::levels)]
    pub(crate) levels: usize,

    /// Subdivision scheme
    #[arg(long, value_enum, default_value = "loop")]
    pub(crate) scheme: SchemeName,

    /// Which vertices move where divided and undivided faces meet [default: all]
    #[arg(long, value_enum)]
    pub(crate) seam: Option<Seam>,

    /// Direction of sight, from the viewer into the scene: parallel projection
    ///
    /// Faces that look away are never divided, those on the silhouette always, those that look at the viewer
    /// where their normal leaves a cone of --dilatation times --angle.
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true, conflicts_with = "eye")]
    pub(crate) view: Option<[f64; 3]>,

    /// Eye point: as --view, with a direction of its own for each face
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) eye: Option<[f64; 3]>,

    /// Factor on the angle of faces that look straight at the viewer [at least 0; default: 1]
    ///
    /// Larger values divide fewer of them; with --view or --eye only.
    #[arg(long, value_name = "K", value_parser = values::factor, allow_hyphen_values = true)]
    pub(crate) dilatation: Option<f64>,

    /// Move the vertices to the limit surface of the last mesh at the end
    ///
    /// With --method uniform that is the limit surface of the input. The adaptive methods have drifted from it by
    /// then, and may come out farther from it than without this option.
    #[arg(long)]
    pub(crate) limit: bool,

    /// Stop before the step that would give more triangles
    ///
    /// What was reached by then is written, and the exit code is 3. The default keeps memory below about
    /// 10 gigabytes.
    #[arg(long, value_name = "N", default_value_t = 50_000_000, value_parser = values::positive)]
    pub(crate) max_triangles: usize,

    #[command(flatten)]
    pub(crate) build: BuildArguments,

    /// Write PLY and STL as text rather than binary
    #[arg(long)]
    pub(crate) ascii: bool,

    /// Write a JSON report: input, repairs, parameters, steps, output, seconds ('-': standard output)
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Draw the refined mesh with its edges
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,
}
