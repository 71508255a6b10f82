//! Options that say what the limit surface of a control mesh is: those of all commands that ask about one.

use clap::Args;

use super::features::FeatureArguments;
use super::interpolation::InterpolationArguments;
use super::quantity::Unit;
use super::shared::{BuildArguments, SchemeName, of_triangles};

/// The scheme, and what is done to the mesh that was read before it is the control mesh.
#[derive(Args, Debug, Clone, Copy)]
pub(crate) struct LimitArguments {
    /// Scheme of the limit surface [default: loop]
    #[arg(long, value_parser = of_triangles())]
    pub(crate) scheme: Option<SchemeName>,

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

    /// The scheme that holds.
    pub(crate) fn scheme(&self) -> SchemeName {
        self.scheme.unwrap_or_default()
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
        scheme
            .or(self.features.given())
            .or(self.interpolation.given())
    }
}
