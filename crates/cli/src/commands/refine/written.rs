//! A refined mesh as a file: with normals, channels, provenance and tags, in the unit of the input.

use std::borrow::Cow;
use std::path::Path;

use limitmesh::Triangles;
use limitmesh_io::{Format, Output};

use super::provenance::Provenance;
use super::refined::Refined;
use crate::arguments::RefineArguments;
use crate::output;
use crate::progress::Progress;
use crate::written_unit::WrittenUnit;

/// Notes what becomes of normals, of values where vertices have several, and of the unit; gives whether vertices are to be written
/// several times.
pub(super) fn notes(
    format: Format,
    arguments: &RefineArguments,
    refined: &Refined,
    progress: &Progress,
) -> bool {
    let surface = refined.mesh.as_triangles();
    let splits = refined.channels.split_vertices(format, surface);
    // Vertices on sharp edges stand once for each side as asked for, or as a file has vertices several times anyway.
    let is_split = arguments.split_normals || splits;
    let normals = refined.normals.as_ref();
    progress.notes(normals.and_then(|all| all.note(format, is_split)));
    progress.notes(refined.channels.note(format, surface, splits));
    WrittenUnit::of(arguments.input(), &arguments.build, format)
        .note(&arguments.output_name(), progress);
    is_split
}

/// Writes a mesh; vertices on sharp edges once for each side if it `is_split`.
///
/// # Errors
/// It cannot be written.
pub(super) fn write(
    path: &Path,
    format: Format,
    is_split: bool,
    arguments: &RefineArguments,
    refined: &Refined,
) -> anyhow::Result<()> {
    let (mesh, normals) = (&refined.mesh, refined.normals.as_ref());
    let surface = Output::new(mesh.as_triangles()).quads(&refined.quads);
    let mut output = refined.channels.add_to(surface);
    if let Some(normals) = normals {
        output = normals.add_to(output, format, is_split);
    }
    let sources = normals.and_then(|all| all.sources(format, is_split));
    let provenance = refined.provenance.as_ref().map(|all| match sources {
        Some(list) => Cow::Owned(all.of_copies(list)),
        None => Cow::Borrowed(all),
    });
    let of_vertices = provenance.as_deref().map(Provenance::of_vertices);
    let of_faces = provenance.as_deref().map(Provenance::of_faces);
    if let (Some(vertices), Some(faces)) = (&of_vertices, &of_faces) {
        output = output.vertex_properties(vertices).face_properties(faces);
    }
    let unit = WrittenUnit::of(arguments.input(), &arguments.build, format);
    let positions = unit.positions(output.surface.positions);
    output.surface = Triangles {
        positions: &positions,
        ..output.surface
    };
    let tags = mesh.tags();
    let output = output.creases(&tags.creases).corners(&tags.corners);
    output::write_mesh(
        path,
        format,
        &output,
        &unit.options(arguments.write_options()),
    )
}
