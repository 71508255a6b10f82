//! Options that several commands have.

use std::path::Path;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use limitmesh::mesh::{BuildOptions, Weld};
use limitmesh::scheme::{CatmullClark, Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh_io::Format;
use serde::Serialize;

use super::quantity::Unit;
use super::values::{self, WeldDistance};
use crate::failure::usage;

/// The heading of options that every command has.
pub(super) const GENERAL: &str = "General options";

/// Whether a result may take the place of an input.
#[derive(Args, Debug, Clone, Copy)]
pub(crate) struct OverwriteArguments {
    /// Let the result replace a file that is also an input
    #[arg(long)]
    pub(crate) overwrite: bool,
}

/// Which subdivision scheme defines the smooth surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Default)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SchemeName {
    /// Loop's scheme with his own weights: smooth, approximating
    #[default]
    Loop,
    /// Loop's scheme with Warren's simpler weights
    LoopWarren,
    /// The modified butterfly scheme: the surface passes through all vertices
    Butterfly,
    /// Catmull–Clark for quads, as in modelling programs; other polygons are divided into quads first
    CatmullClark,
}

impl SchemeName {
    /// The scheme itself.
    pub(crate) fn scheme(self) -> &'static dyn Scheme {
        match self {
            Self::Loop => &Loop,
            Self::LoopWarren => &LoopWarren,
            Self::Butterfly => &ModifiedButterfly,
            Self::CatmullClark => &CatmullClark,
        }
    }

    /// Whether control meshes have quads.
    pub(crate) fn has_quads(self) -> bool {
        self == Self::CatmullClark
    }
}

/// Why a rule for triangles in cages is refused.
pub(crate) const SMOOTH_TRIANGLES: &str =
    "--smooth-triangles is a rule of Catmull–Clark's scheme; it needs --scheme catmull-clark";

/// Which scheme `refine` follows: those that split triangles in four, and one that does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Default)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RefiningScheme {
    /// Loop's scheme with his own weights: smooth, approximating
    #[default]
    Loop,
    /// Loop's scheme with Warren's simpler weights
    LoopWarren,
    /// The modified butterfly scheme: the surface passes through all vertices
    Butterfly,
    /// Catmull–Clark for quads, as in modelling programs; other polygons are divided into quads first
    CatmullClark,
    /// √3-subdivision (Kobbelt): each step gives three times the triangles; smooth, approximating
    Sqrt3,
}

impl From<SchemeName> for RefiningScheme {
    fn from(name: SchemeName) -> Self {
        match name {
            SchemeName::Loop => Self::Loop,
            SchemeName::LoopWarren => Self::LoopWarren,
            SchemeName::Butterfly => Self::Butterfly,
            SchemeName::CatmullClark => Self::CatmullClark,
        }
    }
}

impl RefiningScheme {
    /// The library's name of it.
    pub(crate) fn name(self) -> &'static str {
        self.in_quarters()
            .map_or("sqrt3", |name| name.scheme().name())
    }

    /// The scheme, if it splits triangles in four.
    ///
    /// # Errors
    /// It does not: what asks for it knows no other.
    pub(crate) fn in_quarters(self) -> anyhow::Result<SchemeName> {
        match self {
            Self::Loop => Ok(SchemeName::Loop),
            Self::LoopWarren => Ok(SchemeName::LoopWarren),
            Self::Butterfly => Ok(SchemeName::Butterfly),
            Self::CatmullClark => Ok(SchemeName::CatmullClark),
            Self::Sqrt3 => {
                usage("--scheme sqrt3 does not split triangles in four, as is needed here")
            }
        }
    }
}

/// How the control mesh is made from what the file holds.
#[derive(Args, Debug, Clone, Copy, Default)]
pub(crate) struct BuildArguments {
    /// Merge vertices within this distance of each other [mesh units; default: equal positions alone]
    ///
    /// 0 merges vertices at exactly equal positions, as files with split seams (and every STL) need; 'none'
    /// lets the file's own indices alone connect faces.
    #[arg(long, value_name = "DIST", value_parser = values::weld, allow_hyphen_values = true)]
    weld: Option<WeldDistance>,

    /// What the mesh's numbers are measured in, for lengths that have a unit, such as 0.05mm [default: what a 3MF package says; m for glTF]
    ///
    /// 3MF packages that are written say it, and glTF documents, which are in metres, scale to it.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,

    /// Format of standard input ('-'), and of files whose names have no extension that is known
    #[arg(long, value_parser = formats(), value_name = "FORMAT")]
    pub(crate) from: Option<Format>,

    /// Refuse a mesh that needs repair instead of repairing it
    #[arg(long)]
    pub(crate) strict: bool,
}

impl BuildArguments {
    /// For a file whose unit is known, or not.
    pub(crate) fn in_unit(self, unit: Option<Unit>) -> Self {
        Self { unit, ..self }
    }

    /// ` mm`, or nothing where no unit is known.
    pub(crate) fn unit_in_words(&self) -> String {
        self.unit
            .map_or_else(String::new, |unit| format!(" {}", unit.name()))
    }

    /// The library's options.
    ///
    /// # Errors
    /// A distance has a unit, and the mesh's is not known.
    pub(crate) fn options(&self) -> anyhow::Result<BuildOptions> {
        let weld = match self.weld {
            None => Weld::default(),
            Some(WeldDistance::None) => Weld::Never,
            Some(WeldDistance::Within(distance)) => match distance.in_unit_of(self.unit)? {
                0.0 => Weld::Exact,
                distance => Weld::Within(distance),
            },
        };
        Ok(BuildOptions::default().weld(weld).strict(self.strict))
    }
}

/// The schemes for triangles.
pub(super) fn of_triangles() -> impl TypedValueParser<Value = SchemeName> {
    let own = SchemeName::value_variants()
        .iter()
        .filter(|name| !name.has_quads());
    PossibleValuesParser::new(own.filter_map(ValueEnum::to_possible_value))
        .try_map(|name| SchemeName::from_str(&name, false))
}

/// The schemes whose limit surfaces are polynomials in pieces, as rays and projections need them.
pub(super) fn of_polynomials() -> impl TypedValueParser<Value = SchemeName> {
    let own = SchemeName::value_variants()
        .iter()
        .filter(|name| name.scheme().family().is_some());
    PossibleValuesParser::new(own.filter_map(ValueEnum::to_possible_value))
        .try_map(|name| SchemeName::from_str(&name, false))
}

/// The formats of mesh files, by their extensions.
pub(super) fn formats() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::ALL.iter().map(|own| own.extension()))
        .try_map(|name| Format::from_path(Path::new(&format!("mesh.{name}"))))
}
