//! The control mesh of a limit surface that is measured, evaluated or drawn: as it was read, with sharp edges and control points as asked
//! for.

use limitmesh::Mesh;

use super::interpolation;
use crate::arguments::{Featured, LimitArguments};
use crate::input::Input;
use crate::parts;
use crate::progress::Progress;

/// What a limit surface is of.
pub(super) struct Prepared {
    /// The mesh with its tags, and control points that let the surface pass through its vertices where that is asked for.
    pub(super) mesh: Mesh,
    /// By its faces, that of the file that each is from.
    pub(super) face_inputs: Vec<u32>,
    /// The arguments with what was decided by looking at the mesh.
    pub(super) limit: LimitArguments,
}

/// Prepares a mesh that was read. What is sharp by its looks counts where nothing else is asked for, as for `refine`.
///
/// # Errors
/// Edges are to be sharp by what the file does not tell, or some vertex has no limit that is near enough.
pub(super) fn prepared(
    input: Input,
    arguments: &LimitArguments,
    progress: &Progress,
) -> anyhow::Result<Prepared> {
    let limit = LimitArguments {
        features: arguments.features.or_auto(),
        ..*arguments
    };
    as_asked(input, &limit, progress)
}

/// [`prepared`], where edges that look sharp are so only if that is asked for.
///
/// # Errors
/// As for [`prepared`].
pub(super) fn as_asked(
    input: Input,
    arguments: &LimitArguments,
    progress: &Progress,
) -> anyhow::Result<Prepared> {
    let (features, interpolation) = (arguments.features, arguments.interpolation);
    let (mesh, faces) = (&input.mesh, &input.trace.faces);
    let decided = parts::decided(features, interpolation, mesh, faces, &input.hints(), true);
    if let Some(note) = decided.note {
        progress.note(format!("{}: {note}", input.name));
    }
    let limit = LimitArguments {
        features: decided.features,
        interpolation: decided.interpolation,
        ..*arguments
    };
    let Input { mesh, trace, .. } = input.with_creases(limit.features.creases_from)?;
    let Featured { mesh, concave, .. } = limit.features.apply(mesh)?;
    let (unit, scheme) = (limit.build.unit, limit.scheme().scheme());
    let (mesh, _) = interpolation::apply(mesh, limit.interpolation, unit, scheme, progress)?;
    let input_of = |face| trace.faces[concave.parts.whole(face) as usize];
    let face_inputs = (0..mesh.face_count() as u32).map(input_of).collect();
    Ok(Prepared {
        mesh,
        face_inputs,
        limit,
    })
}
