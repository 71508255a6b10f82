//! Files that an input names, such as materials and their pictures: the writer takes them along, and this says which it does not.

use std::collections::BTreeSet;
use std::path::Path;

use limitmesh_io::{Format, MaterialLibraries};

use crate::output;
use crate::progress::Progress;

/// Whether an output is in another folder than the input.
pub(super) fn is_elsewhere(input: &Path, output: Option<&Path>) -> bool {
    let folder = |file: &Path| {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    output.is_some_and(|output| !output::is_standard_output(output) && folder(input) != folder(output))
}

/// Says which files do not come along.
pub(super) fn note(found: &MaterialLibraries, format: Format, progress: &Progress) {
    let stays = if format.is_gltf() { "left out" } else { "named as in the input, and not copied" };
    for problem in &found.problems {
        progress.note(format!("{}: {stays}: {}", problem.name, problem.reason));
    }
}

/// Says what glTF does not get of the materials.
pub(super) fn note_materials(found: &MaterialLibraries, has_coordinates: bool, progress: &Progress) {
    let pictures: BTreeSet<_> = found.materials.iter().filter_map(|own| own.picture.as_ref()).collect();
    for picture in pictures {
        let name = picture.file.display();
        if !has_coordinates {
            progress.note(format!("{name}: left out: there are no texture coordinates"));
        } else if picture.mime_type.is_none() {
            progress.note(format!("{name}: left out: neither PNG nor JPEG, which glTF knows"));
        }
    }
    if !found.left_out.is_empty() {
        let statements: Vec<&str> = found.left_out.iter().map(String::as_str).collect();
        progress.note(format!("left out of the materials: {}", statements.join(", ")));
    }
}
