//! Options that several commands have.

use clap::{Args, ValueEnum};
use limitmesh::mesh::{BuildOptions, Weld};
use limitmesh::refine::SeamRule;
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use serde::Serialize;

use super::values;

/// Which subdivision scheme defines the smooth surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Default)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SchemeName {
    /// Loop's scheme with his own weights: smooth, approximating
    #[default]
    Loop,
    /// Loop's scheme with Warren's simpler weights
    LoopWarren,
    /// The modified butterfly scheme: the surface passes through all vertices
    Butterfly,
}

impl SchemeName {
    /// The scheme itself.
    pub(crate) fn scheme(self) -> &'static dyn Scheme {
        match self {
            Self::Loop => &Loop,
            Self::LoopWarren => &LoopWarren,
            Self::Butterfly => &ModifiedButterfly,
        }
    }
}

/// Which vertices move where divided and undivided faces meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Default)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Seam {
    /// All vertices of the mesh move in each step
    #[default]
    All,
    /// Vertices with at least one divided face move
    Any,
    /// Vertices all of whose faces are divided move
    Inner,
}

impl Seam {
    /// The library's rule.
    pub(crate) fn rule(self) -> SeamRule {
        match self {
            Self::All => SeamRule::All,
            Self::Any => SeamRule::Any,
            Self::Inner => SeamRule::Inner,
        }
    }
}

/// How the control mesh is made from what the file holds.
#[derive(Args, Debug, Clone, Copy)]
pub(crate) struct BuildArguments {
    /// Merge vertices within this distance of each other [mesh units; default: equal positions alone]
    ///
    /// 0 merges vertices at exactly equal positions, as files with split seams (and every STL) need; 'none'
    /// lets the file's own indices alone connect faces.
    #[arg(long, value_name = "DIST", value_parser = values::weld, allow_hyphen_values = true)]
    pub(crate) weld: Option<Weld>,

    /// Refuse a mesh that needs repair instead of repairing it
    #[arg(long)]
    pub(crate) strict: bool,
}

impl BuildArguments {
    /// The library's options.
    pub(crate) fn options(&self) -> BuildOptions {
        BuildOptions::default().weld(self.weld.unwrap_or_default()).strict(self.strict)
    }
}
