//! Options that make the limit surface pass through the vertices.

use clap::Args;

use super::quantity::Unit;
use super::values::{self, Extent};

/// Whether vertices are taken for points of the limit surface.
#[derive(Args, Debug, Clone, Copy, Default)]
pub(crate) struct InterpolationArguments {
    /// Let the limit surface pass through every vertex, so that it does not shrink; with =T, that near to it, and as fair as it can be
    ///
    /// Control points are found whose limits are the vertices: a cylinder of 16 facets keeps its radius to 0.01 %, where its
    /// plain limit surface loses 2.5 %. The price is that the surface undulates where vertices are out of line. For scans, whose vertices
    /// are no more exact than T: a length in the mesh's unit, or with % in per cent of the diagonal of its bounding box.
    #[arg(long, value_name = "WITHIN", value_parser = values::extent, allow_hyphen_values = true)]
    #[arg(num_args = 0..=1, require_equals = true, default_missing_value = "0")]
    pub(crate) interpolate: Option<Extent>,

    /// Whether it passes through those of a part around which it does not fold, as nothing else was asked for.
    #[arg(skip)]
    pub(crate) is_of_part: bool,
}

impl InterpolationArguments {
    /// Whether the surface passes through the vertices, or near them.
    pub(crate) fn is_led(&self) -> bool {
        self.is_of_part || self.given().is_some()
    }

    /// The option, where it is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        self.interpolate.map(|_| "--interpolate")
    }

    /// How near the surface is to pass, for a mesh with this diagonal and unit; none where it is not led there.
    ///
    /// # Errors
    /// The length has a unit, and the mesh's is not known.
    pub(crate) fn within(&self, diagonal: f64, unit: Option<Unit>) -> anyhow::Result<Option<f64>> {
        match self.interpolate {
            Some(within) => within.length(diagonal, unit).map(Some),
            None => Ok(self.is_of_part.then_some(0.0)),
        }
    }
}
