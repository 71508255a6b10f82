//! Options about glTF assets.

use clap::{Args, ValueEnum};
use limitmesh::mesh::Weld;
use limitmesh_io::gltf::Joining;

/// The heading of these options in the help.
const HEADING: &str = "Options of glTF assets";

/// What of an asset is refined, and how it is joined.
#[derive(Args, Debug, Clone, Default)]
#[command(next_help_heading = HEADING)]
pub(crate) struct AssetArguments {
    /// Make vertices at one place one, even if these move them apart [with a comma between several]
    ///
    /// Otherwise vertices become one where position, displacements of all morph targets, and joints with their weights are the
    /// same; how many stay apart is told. The first of those that become one says how it moves.
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',')]
    pub(crate) weld_ignores: Vec<Mover>,
}

/// What moves vertices of one place apart.
#[derive(ValueEnum, Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mover {
    /// Joints and weights that differ
    Skin,
    /// Displacements of morph targets that differ
    Morphs,
}

impl AssetArguments {
    /// Which vertices of a mesh become one.
    pub(crate) fn joining(&self, weld: Weld) -> Joining {
        let ignores = |mover| self.weld_ignores.contains(&mover);
        match weld {
            Weld::Never => Joining::Never,
            _ => Joining::Ignoring { skins: ignores(Mover::Skin), morphs: ignores(Mover::Morphs) },
        }
    }

    /// The first of these options that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        (!self.weld_ignores.is_empty()).then_some("--weld-ignores")
    }
}
