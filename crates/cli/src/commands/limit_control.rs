//! The control mesh of a limit surface that is measured or evaluated: as it was read, with sharp edges and control points as asked for.

use limitmesh::Mesh;

use super::interpolation;
use crate::arguments::{FeatureArguments, InterpolationArguments, SchemeName, Unit};
use crate::input::Input;
use crate::progress::Progress;

/// The mesh with its tags, and control points that let the surface pass through its vertices where that is asked for.
///
/// # Errors
/// Edges are to be sharp by what the file does not tell, or some vertex has no limit that is near enough.
pub(super) fn prepared(
    input: Input,
    features: &FeatureArguments,
    interpolation: (InterpolationArguments, Option<Unit>),
    scheme: SchemeName,
    progress: &Progress,
) -> anyhow::Result<Mesh> {
    let mesh = input.with_creases(features.creases_from)?.mesh;
    let mesh = features.apply(mesh)?.mesh;
    Ok(interpolation::apply(mesh, interpolation, scheme.scheme(), progress)?.0)
}
