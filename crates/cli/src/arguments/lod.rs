//! `limitmesh lod`.

use std::path::PathBuf;

use clap::Args;

use super::channels::ChannelArguments;
use super::limit::LimitArguments;
use super::shared::OverwriteArguments;
use super::values::{self, Extent};

const EXAMPLES: &str = "\
Examples:
  limitmesh lod builtin:cup -o cup.glb --morph
        four levels in one file, each with a morph target that makes it the coarser one, and when to switch
  limitmesh lod rock.obj -o rock.ply --tolerances 1%,0.3%,0.1% --report rock.json
        rock_LOD0.ply (the finest), rock_LOD1.ply, rock_LOD2.ply
  limitmesh lod statue.ply -o statue.glb --levels 5 --tolerance 0.05% --pixels 0.5 --fov 60 --height 1440

Exit code 3 means that a level could not be reached; those up to it are written.";

/// Make levels of detail: meshes of one smooth surface, each nested in the next, with distances to switch at
///
/// Each level is certainly within its tolerance of the limit surface. With --morph each vertex also knows its place on the coarser
/// level; on the straight way between them the mesh is within the coarser level's tolerance at every moment, place by place. LOD0 is the finest;
/// none has fewer triangles than the control mesh.
///
/// A glTF file holds all levels: the scene has the finest, whose node names the others (MSFT_lod) with the height of the picture
/// that the object takes where each ends (MSFT_screencoverage); with --morph each mesh has a morph target that makes it the coarser level.
/// Of a glTF input its materials and textures come along, its nodes as one mesh in the scene's coordinates. PLY files have a level each, with
/// the vertices' places on the coarser level as coarse_x, coarse_y and coarse_z.
#[derive(Args, Debug, Clone)]
#[command(after_help = EXAMPLES)]
pub(crate) struct LodArguments {
    /// Control mesh: a file, - for standard input with --from, or builtin:NAME
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,

    /// File to write: .glb or .gltf for all levels, or the name of files that are called NAME_LOD0 and so on
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Greatest distances between a level and the limit surface, coarse to fine, with commas between them
    ///
    /// Lengths in the mesh's unit, or with % in per cent of the diagonal of its bounding box. With --morph they hold place by place.
    #[arg(long, value_name = "T,T,…", value_delimiter = ',', value_parser = values::tolerance)]
    #[arg(conflicts_with_all = ["levels", "tolerance", "ratio"])]
    pub(crate) tolerances: Vec<Extent>,

    /// Number of levels, whose tolerances are --tolerance and its multiples [1 to 12; default: 4]
    #[arg(long, value_name = "N", value_parser = values::detail_levels)]
    pub(crate) levels: Option<usize>,

    /// Tolerance of the finest level [default: 0.1%]
    #[arg(long, value_name = "T", value_parser = values::tolerance, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<Extent>,

    /// A level's tolerance as a part of the coarser level's [above 0, below 1; default: 0.25, about four times the triangles]
    #[arg(long, value_name = "R", value_parser = values::ratio, allow_hyphen_values = true)]
    pub(crate) ratio: Option<f64>,

    /// Write how each level grows out of the coarser one: a morph target (glTF), or coarse_x, coarse_y, coarse_z (PLY)
    #[arg(long)]
    pub(crate) morph: bool,

    /// How far a level may be off in the picture, for the distances to switch at [pixels]
    #[arg(long, value_name = "P", default_value_t = 1.0, value_parser = values::above_zero)]
    pub(crate) pixels: f64,

    /// Height of that picture [pixels]
    #[arg(long, value_name = "H", default_value_t = 1080.0, value_parser = values::above_zero)]
    pub(crate) height: f64,

    /// Its vertical angle of view [degrees, below 180]
    #[arg(long, value_name = "DEG", default_value_t = 60.0, value_parser = values::field_of_view)]
    pub(crate) fov: f64,

    /// Give no more triangles a level [default: 30000000]
    #[arg(long, value_name = "N", value_parser = values::positive)]
    pub(crate) max_triangles: Option<usize>,

    #[command(flatten)]
    pub(crate) limit: LimitArguments,

    #[command(flatten)]
    pub(crate) channels: ChannelArguments,

    #[command(flatten)]
    pub(crate) overwrite: OverwriteArguments,

    /// Write PLY and STL as text rather than binary
    #[arg(long)]
    pub(crate) ascii: bool,

    /// Write a JSON report: by level its file, triangles, distances and where to switch (- for standard output)
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
}
