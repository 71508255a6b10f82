//! Options that say what the limit surface of a control mesh is: those of all commands that ask about one.

use clap::Args;
use limitmesh::QuadOptions;

use super::features::FeatureArguments;
use super::interpolation::InterpolationArguments;
use super::quantity::Unit;
use super::shared::{BuildArguments, SMOOTH_TRIANGLES, SchemeName};
use crate::failure::usage;

/// The scheme, and what is done to the mesh that was read before it is the control mesh.
#[derive(Args, Debug, Clone, Copy)]
pub(crate) struct LimitArguments {
    /// Scheme of the limit surface [default: catmull-clark for files whose faces are quads for the most part, else loop]
    #[arg(long, value_enum)]
    pub(crate) scheme: Option<SchemeName>,

    /// Make the surface rounder where a cage for Catmull–Clark has triangles, as --smooth-triangles of `refine` does
    #[arg(long)]
    pub(crate) smooth_triangles: bool,

    #[command(flatten)]
    pub(crate) features: FeatureArguments,

    #[command(flatten)]
    pub(crate) interpolation: InterpolationArguments,

    #[command(flatten)]
    pub(crate) build: BuildArguments,
}

impl LimitArguments {
    /// For a file whose unit is known, or not.
    pub(crate) fn in_unit(self, unit: Option<Unit>) -> Self {
        Self {
            build: self.build.in_unit(unit),
            ..self
        }
    }

    /// The scheme that holds, once it is decided ([`Self::for_faces`]).
    pub(crate) fn scheme(&self) -> SchemeName {
        self.scheme.unwrap_or_default()
    }

    /// With the scheme that holds where none was asked for, for a file most of whose faces are quads, or not.
    ///
    /// # Errors
    /// An option is for another scheme.
    pub(crate) fn for_faces(self, are_quads: bool) -> anyhow::Result<Self> {
        let usual = match are_quads || self.smooth_triangles {
            true => SchemeName::CatmullClark,
            false => SchemeName::default(),
        };
        let scheme = self.scheme.unwrap_or(usual);
        if self.smooth_triangles && !scheme.has_quads() {
            return usage(SMOOTH_TRIANGLES);
        }
        Ok(Self {
            scheme: Some(scheme),
            ..self
        })
    }

    /// The rules by which the control mesh's polygons become quads, where the scheme is for these.
    pub(crate) fn quads(&self) -> Option<QuadOptions> {
        let options = self.features.quads(self.smooth_triangles);
        self.scheme().has_quads().then_some(options)
    }

    /// How near the surface is to pass to the vertices of a mesh with this diagonal, if that was asked for.
    ///
    /// # Errors
    /// The length has a unit, and the mesh's is not known.
    pub(crate) fn within(&self, diagonal: f64) -> anyhow::Result<Option<f64>> {
        self.interpolation.within(diagonal, self.build.unit)
    }

    /// The first of these options that is given, but for those that say how files are read.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let scheme = self.scheme.map(|_| "--scheme");
        let smooth = self.smooth_triangles.then_some("--smooth-triangles");
        scheme
            .or(smooth)
            .or(self.features.given())
            .or(self.interpolation.given())
    }
}
