//! Options about glTF assets.

use clap::{Args, ValueEnum};
use limitmesh::mesh::Weld;
use limitmesh_io::gltf::Joining;

use super::tolerances::MorphTolerance;
use crate::failure::usage;

/// The heading of these options in the help.
const HEADING: &str = "Options of glTF assets";

/// Which parts of an asset are refined, and how they are joined.
#[derive(Args, Debug, Clone, Default)]
#[command(next_help_heading = HEADING)]
pub(crate) struct AssetArguments {
    /// Refine the meshes of this name alone; may be given several times [default: all]
    ///
    /// All else stays to the byte. A mesh without a name is called meshes[2], by its number.
    #[arg(long, value_name = "NAME")]
    pub(crate) mesh: Vec<String>,

    /// Refine the primitives with a material of this name alone; may be given several times [default: all]
    ///
    /// With --mesh, those of these meshes. Edges where they meet primitives that stay are kept straight, so that no gap opens.
    #[arg(long, value_name = "NAME")]
    pub(crate) material: Vec<String>,

    /// Leave images where they are: the new asset names those of the input, rather than copies
    #[arg(long)]
    pub(crate) link_resources: bool,

    /// Make vertices at one place one, even if these move them apart [with a comma between several]
    ///
    /// Otherwise vertices become one where position, displacements of all morph targets, and joints with their weights are the
    /// same; a note says how many stay apart. The first of those that become one says how it moves.
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',')]
    pub(crate) weld_ignores: Vec<Mover>,

    /// Greatest distance at weight 1 of each morph target, between the moved triangles and the moved limit surface [default: --tolerance]
    ///
    /// A length or per cent as for --tolerance, or none. Not with --triangles, --balance or --optimize, which are for the mesh as
    /// it rests.
    #[arg(long, value_name = "T|none")]
    pub(crate) morph_tolerance: Option<MorphTolerance>,
}

/// The attributes that move vertices of one place apart.
#[derive(ValueEnum, Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mover {
    /// Joints and weights that differ
    Skin,
    /// Displacements of morph targets that differ
    Morphs,
}

impl AssetArguments {
    /// Which vertices of a mesh become one that the scene shows `stretch` times as large.
    pub(crate) fn joining(&self, weld: Weld, stretch: f64) -> Joining {
        let ignores = |mover| self.weld_ignores.contains(&mover);
        let distance = match weld {
            Weld::Never => return Joining::Never,
            Weld::Within(distance) => distance / stretch,
            _ => 0.0,
        };
        Joining::Ignoring {
            skins: ignores(Mover::Skin),
            morphs: ignores(Mover::Morphs),
            distance,
        }
    }

    /// Refuses these options for what is no glTF asset.
    ///
    /// # Errors
    /// One is given.
    pub(crate) fn refuse(&self) -> anyhow::Result<()> {
        match self.given() {
            Some(option) => usage(format!("{option} is for glTF assets that stay glTF")),
            None => Ok(()),
        }
    }

    /// The first of these options that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let all = [
            (!self.mesh.is_empty(), "--mesh"),
            (!self.material.is_empty(), "--material"),
            (self.link_resources, "--link-resources"),
            (!self.weld_ignores.is_empty(), "--weld-ignores"),
            (self.morph_tolerance.is_some(), "--morph-tolerance"),
        ];
        all.into_iter()
            .find(|&(is_given, _)| is_given)
            .map(|(_, option)| option)
    }
}
