//! Options that make the limit surface pass through the vertices.

use clap::Args;

use super::quantity::Unit;
use super::values::{self, Extent};

/// Whether vertices are taken for points of the limit surface.
#[derive(Args, Debug, Clone, Copy, Default)]
pub(crate) struct InterpolationArguments {
    /// Let the limit surface pass through every vertex, so that it does not shrink
    ///
    /// Control points are found whose limits are the vertices: a cylinder of 16 facets keeps its radius to 0.01 %, where its
    /// plain limit surface loses 2.5 %. The price is that the surface undulates where vertices are out of line.
    #[arg(long, conflicts_with = "interpolate_within")]
    pub(crate) interpolate: bool,

    /// Let the limit surface pass that near to every vertex, and be as fair as it can be
    ///
    /// A length in the mesh's unit, or with % in per cent of the diagonal of its bounding box; 0 is --interpolate. For scans,
    /// whose vertices are no more exact than that.
    #[arg(long, value_name = "T", value_parser = values::extent, allow_hyphen_values = true)]
    pub(crate) interpolate_within: Option<Extent>,

    /// Whether it passes through those of a part around which it does not fold, as nothing else was asked for.
    #[arg(skip)]
    pub(crate) is_of_part: bool,
}

impl InterpolationArguments {
    /// Whether the surface passes through the vertices, or near them.
    pub(crate) fn is_led(&self) -> bool {
        self.is_of_part || self.given().is_some()
    }

    /// The one of these options that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let within = self.interpolate_within.map(|_| "--interpolate-within");
        within.or(self.interpolate.then_some("--interpolate"))
    }

    /// How near the surface is to pass, for a mesh with this diagonal and unit; none where it is not led there.
    ///
    /// # Errors
    /// The length has a unit, and the mesh's is not known.
    pub(crate) fn within(&self, diagonal: f64, unit: Option<Unit>) -> anyhow::Result<Option<f64>> {
        match self.interpolate_within {
            Some(within) => within.length(diagonal, unit).map(Some),
            None => Ok((self.interpolate || self.is_of_part).then_some(0.0)),
        }
    }
}
