//! The control mesh of a limit surface: as it was read, with sharp edges and control points as asked for.

use std::path::Path;

use limitmesh::mesh::FaceParts;

use super::interpolation;
use crate::arguments::LimitArguments;
use crate::input::{self, Input, Soup, of_quads};
use crate::parts;
use crate::progress::Progress;

/// A control mesh.
pub(super) struct Prepared {
    /// The input; its mesh has tags, and control points that let the surface pass through its vertices where that is asked for.
    pub(super) input: Input,
    /// Where its faces are on those of the mesh that was read.
    pub(super) parts: FaceParts,
    /// The arguments with what was decided by looking at the mesh.
    pub(super) limit: LimitArguments,
}

impl Prepared {
    /// By face of the control mesh, the file's face that it is from.
    pub(super) fn face_inputs(&self) -> Vec<u32> {
        let input = |face| self.input.trace.faces[self.parts.whole(face) as usize];
        (0..self.input.mesh.face_count() as u32)
            .map(input)
            .collect()
    }
}

/// Reads the control mesh of a limit surface, and decides its scheme where none was asked for.
///
/// # Errors
/// As for [`input::load`]; or an option is for another scheme.
pub(super) fn load(
    path: &Path,
    arguments: &LimitArguments,
    progress: &Progress,
) -> anyhow::Result<(Input, LimitArguments)> {
    let mut read = input::read(path, &arguments.build, progress)?;
    let limit = decided(&mut read, arguments, progress)?;
    let input = input::connect(read, &limit.build, &[], progress)?;
    Ok((input, limit))
}

/// Decides the scheme for what was read where none was asked for, and has its polygons become quads where the scheme is for these.
///
/// # Errors
/// An option is for another scheme.
pub(super) fn decided(
    read: &mut Soup,
    arguments: &LimitArguments,
    progress: &Progress,
) -> anyhow::Result<LimitArguments> {
    let limit = arguments.for_faces(read.is_of_quads())?;
    if arguments.scheme.is_none() && limit.scheme().has_quads() {
        progress.note(of_quads(&read.name));
    }
    read.quads = limit.quads();
    Ok(limit)
}

/// Prepares a mesh that was read. What is sharp by its looks counts where nothing else is asked for, as for `refine`.
///
/// # Errors
/// Edges are to be sharp by what the file does not say, or some vertex has no limit that is near enough.
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
    progress.notes(decided.note.map(|note| format!("{}: {note}", input.name)));
    let limit = LimitArguments {
        features: decided.features,
        interpolation: decided.interpolation,
        ..arguments.in_unit(input.unit)
    };
    let input = input.with_creases(limit.features.creases_from)?;
    let featured = limit.features.apply(input.mesh)?;
    let (unit, scheme) = (limit.build.unit, limit.scheme().scheme());
    let led = limit.interpolation;
    let (mesh, _) = interpolation::apply(featured.mesh, led, unit, scheme, progress)?;
    Ok(Prepared {
        input: Input { mesh, ..input },
        parts: featured.concave.parts,
        limit,
    })
}
