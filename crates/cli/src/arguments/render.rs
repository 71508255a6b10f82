//! `limitmesh render`.

use std::path::PathBuf;

use clap::Args;

use super::features::{CreaseAngle, crease_angle};
use super::shared::of_polynomials;
use super::shared::{BuildArguments, SchemeName};
use super::values;
use super::values::Size;

const EXAMPLES: &str = "\
Examples:
  limitmesh render refined.ply -o refined.png --wireframe
  limitmesh render duck.glb -o duck.png
  limitmesh render chair.obj -o chair.png --texture wood.jpg
  limitmesh render builtin:shark -o shark.png --exact
        its limit surface itself, without triangles
  limitmesh render builtin:cup -o cup.png --flat --view 1,-2,-1 --size 1600x1200";

/// Draw a mesh as a PNG picture; needs no graphics card
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RenderArguments {
    /// Mesh file (.obj, .ply, .stl, .off, .gltf, .glb, .3mf), - for standard input, or builtin:NAME
    pub(crate) input: PathBuf,

    /// Picture to write (.png), or - for standard output
    #[arg(short, long, value_name = "OUT.png")]
    pub(crate) output: PathBuf,

    /// Draw the edges of the triangles over the shaded surface, but of those smaller than 4 pixels
    #[arg(long)]
    pub(crate) wireframe: bool,

    /// Shade each triangle by its own normal, so that facets show
    #[arg(long, conflicts_with = "smooth")]
    pub(crate) flat: bool,

    /// Shade smoothly, by means of the faces' normals around each vertex, whatever normals the file has
    ///
    /// Without this and --flat, files are shaded by their normals; those that have none as with --crease-angle 30.
    #[arg(long)]
    pub(crate) smooth: bool,

    /// Take the mesh for a control mesh and draw its limit surface itself, by rays: outlines have no facets
    #[arg(long, conflicts_with_all = ["wireframe", "flat", "smooth", "texture"])]
    pub(crate) exact: bool,

    /// Scheme of the limit surface that --exact draws [default: catmull-clark for files whose faces are quads for the most part, else loop]
    #[arg(long, value_parser = of_polynomials())]
    pub(crate) scheme: Option<SchemeName>,

    /// Shade both sides of edges by themselves where the faces meet at more than this angle [degrees, above 0 to 180, or none; with --exact
    /// also auto, its default]
    ///
    /// In place of the file's normals. Edges that the file tags as sharp for ever are shaded so in any case. With --exact they are creases
    /// of the surface, as `refine` has them.
    #[arg(long, value_name = "DEG|auto|none", value_parser = crease_angle, allow_hyphen_values = true)]
    #[arg(conflicts_with = "flat")]
    pub(crate) crease_angle: Option<CreaseAngle>,

    /// A picture on the surface by its texture coordinates: a PNG or JPEG file, checker for a pattern that shows stretching and seams, or
    /// none
    ///
    /// Without it a glTF file's own materials are drawn, with their base colours and textures in plain light, and other files in one colour.
    #[arg(long, value_name = "IMAGE|checker|none")]
    pub(crate) texture: Option<PathBuf>,

    /// Direction of sight, from the viewer into the scene
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    pub(crate) view: Option<[f64; 3]>,

    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1200x900")]
    pub(crate) size: Size,

    #[command(flatten)]
    pub(crate) build: BuildArguments,
}
