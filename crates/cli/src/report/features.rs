//! The rules for sharp edges and boundaries, in every report of a limit surface.

use serde::Serialize;

use crate::arguments::{Boundary, ConcaveCorners, CreasesFrom, FeatureArguments};

/// The rules for sharp edges, corners and boundaries, defaults filled in.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FeaturesReport {
    /// The rule for open boundaries.
    boundary: Boundary,
    /// Edges beyond this angle are sharp; null for none.
    crease_angle_degrees: Option<f64>,
    /// Whether that was found by looking at the mesh, where it looks like a part.
    crease_angle_auto: bool,
    /// Normals or labels of the file that make edges sharp, apart from tags.
    creases_from: CreasesFrom,
    /// The rule for corners of 180° and more between sharp edges.
    pub(crate) concave_corners: ConcaveCorners,
}

impl From<&FeatureArguments> for FeaturesReport {
    fn from(arguments: &FeatureArguments) -> Self {
        Self {
            boundary: arguments.boundary.unwrap_or_default(),
            crease_angle_degrees: arguments.angle(),
            crease_angle_auto: arguments.is_auto(),
            creases_from: arguments.creases_from,
            concave_corners: arguments.concave_corners(),
        }
    }
}
