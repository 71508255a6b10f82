//! Files that an input names, such as materials and their pictures: the writer takes them along, and this says which it does not.

use std::collections::BTreeSet;
use std::path::Path;

use limitmesh::mesh::{Channel, Semantic};
use limitmesh_io::{Format, MATERIAL, MaterialLibraries};

use crate::arguments::{ChannelArguments, RefineArguments};
use crate::output;
use crate::progress::Progress;

/// Where channels go, and what was asked for them.
pub(super) struct Destination<'a> {
    /// Nothing is written without one.
    pub(super) format: Option<Format>,
    /// Whether it is written as text.
    pub(super) ascii: bool,
    pub(super) chosen: &'a ChannelArguments,
    /// The file that they came from, and the one that they go to.
    pub(super) files: (&'a Path, Option<&'a Path>),
}

impl<'a> Destination<'a> {
    /// That of a refinement.
    pub(super) fn of(arguments: &'a RefineArguments, format: Option<Format>) -> Self {
        let files = (arguments.input(), arguments.output.as_deref());
        Self {
            format,
            ascii: arguments.ascii,
            chosen: &arguments.channels,
            files,
        }
    }
}

/// Finds the files that the output has a use for, given the names of libraries and pictures and the channels that are kept; says which it
/// has none for, and which are not found.
pub(super) fn find(
    libraries: &[String],
    pictures: &[String],
    kept: &[Channel],
    to: &Destination<'_>,
    progress: &Progress,
) -> MaterialLibraries {
    let Some(format) = to.format else {
        return MaterialLibraries::default();
    };
    let has_materials = kept.iter().any(|own| own.name == MATERIAL);
    let is_described = format == Format::Obj || format.is_gltf() && has_materials;
    if !is_described && !libraries.is_empty() {
        progress.note(format!(
            "left out: {} (only OBJ files name others)",
            libraries.join("; ")
        ));
    }
    if format != Format::Ply && !pictures.is_empty() {
        let files = pictures.join("; ");
        progress.note(format!(
            "left out: {files} (only PLY files name pictures themselves)"
        ));
    }
    let (input, output) = to.files;
    let found = match format {
        _ if kept.is_empty() => MaterialLibraries::default(),
        Format::Gltf | Format::Glb if is_described => MaterialLibraries::read(input, libraries),
        Format::Obj if is_elsewhere(input, output) => MaterialLibraries::read(input, libraries),
        Format::Ply if is_elsewhere(input, output) => {
            MaterialLibraries::of_pictures(input, pictures)
        }
        _ => MaterialLibraries::default(),
    };
    let stays = if format.is_gltf() {
        "left out"
    } else {
        "named as in the input, and not copied"
    };
    for problem in &found.problems {
        progress.note(format!("{}: {stays}: {}", problem.name, problem.reason));
    }
    if format.is_gltf() {
        let is_texture = |own: &Channel| own.semantic == Semantic::TextureCoordinates;
        note_materials(&found, kept.iter().any(is_texture), progress);
    }
    found
}

/// Whether an output is in another folder than the input.
fn is_elsewhere(input: &Path, output: Option<&Path>) -> bool {
    let folder = |file: &Path| {
        let folder = file
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    output.is_some_and(|output| {
        !output::is_standard_output(output) && folder(input) != folder(output)
    })
}

/// Says what glTF does not get of the materials.
fn note_materials(found: &MaterialLibraries, has_coordinates: bool, progress: &Progress) {
    let pictures: BTreeSet<_> = found
        .materials
        .iter()
        .filter_map(|own| own.picture.as_ref())
        .collect();
    for picture in pictures {
        let name = picture.file.display();
        if !has_coordinates {
            progress.note(format!(
                "{name}: left out: there are no texture coordinates"
            ));
        } else if picture.mime_type.is_none() {
            progress.note(format!(
                "{name}: left out: neither PNG nor JPEG, which glTF knows"
            ));
        }
    }
    if !found.left_out.is_empty() {
        let statements: Vec<&str> = found.left_out.iter().map(String::as_str).collect();
        progress.note(format!(
            "left out of the materials: {}",
            statements.join(", ")
        ));
    }
}
