//! The control mesh of a limit surface that is measured or evaluated: as it was read, with sharp edges and control points as asked for.

use limitmesh::Mesh;

use super::interpolation;
use crate::arguments::{FeatureArguments, Featured, InterpolationArguments, SchemeName, Unit};
use crate::input::Input;
use crate::progress::Progress;

/// The mesh with its tags, and control points that let the surface pass through its vertices where that is asked for; and by its faces, that
/// of the file that each is from.
///
/// # Errors
/// Edges are to be sharp by what the file does not tell, or some vertex has no limit that is near enough.
pub(super) fn prepared(
    input: Input,
    features: &FeatureArguments,
    interpolation: (InterpolationArguments, Option<Unit>),
    scheme: SchemeName,
    progress: &Progress,
) -> anyhow::Result<(Mesh, Vec<u32>)> {
    let Input { mesh, trace, .. } = input.with_creases(features.creases_from)?;
    let Featured { mesh, concave } = features.apply(mesh)?;
    let (mesh, _) = interpolation::apply(mesh, interpolation, scheme.scheme(), progress)?;
    let input_of = |face| trace.faces[concave.parts.whole(face) as usize];
    let face_inputs = (0..mesh.face_count() as u32).map(input_of).collect();
    Ok((mesh, face_inputs))
}
