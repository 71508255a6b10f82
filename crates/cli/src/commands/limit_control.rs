//! The control mesh of a limit surface that is measured or evaluated: as it was read, with sharp edges and control points as asked for.

use limitmesh::Mesh;

use super::interpolation;
use crate::arguments::{Featured, LimitArguments};
use crate::input::Input;
use crate::progress::Progress;

/// The mesh with its tags, and control points that let the surface pass through its vertices where that is asked for; and by its faces, that
/// of the file that each is from.
///
/// # Errors
/// Edges are to be sharp by what the file does not tell, or some vertex has no limit that is near enough.
pub(super) fn prepared(
    input: Input,
    arguments: &LimitArguments,
    progress: &Progress,
) -> anyhow::Result<(Mesh, Vec<u32>)> {
    let Input { mesh, trace, .. } = input.with_creases(arguments.features.creases_from)?;
    let Featured { mesh, concave, .. } = arguments.features.apply(mesh)?;
    let interpolation = (arguments.interpolation, arguments.build.unit);
    let (mesh, _) = interpolation::apply(mesh, interpolation, arguments.scheme().scheme(), progress)?;
    let input_of = |face| trace.faces[concave.parts.whole(face) as usize];
    let face_inputs = (0..mesh.face_count() as u32).map(input_of).collect();
    Ok((mesh, face_inputs))
}
