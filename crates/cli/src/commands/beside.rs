//! Files that an input names, such as materials and their pictures: they come along to the output's folder.

use std::path::{Path, PathBuf};

use limitmesh_io::{Format, MaterialLibraries, Picture, copy_beside};

use crate::interrupt;
use crate::output;
use crate::progress::Progress;

/// Copies the files to the folder of the output, if that is another than the input's.
pub(super) fn copy(found: &MaterialLibraries, output: &Path) -> anyhow::Result<()> {
    if output::is_standard_output(output) || found.files.is_empty() {
        return Ok(());
    }
    let folder = folder(output);
    interrupt::whole_or_not(output, || copy_beside(&found.folder, found.files.iter(), folder))?;
    Ok(())
}

/// Whether an output is in another folder than the input, or in none.
pub(super) fn is_elsewhere(input: &Path, output: Option<&Path>) -> bool {
    let whole = |file: &Path| folder(file).canonicalize().ok();
    output.is_some_and(|output| !output::is_standard_output(output) && whole(input) != whole(output))
}

fn folder(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Says which files do not come along.
pub(super) fn note(found: &MaterialLibraries, format: Format, progress: &Progress) {
    let stays = if format.is_gltf() { "left out" } else { "named as in the input, and not copied" };
    for problem in &found.problems {
        progress.note(format!("{}: {stays}: {}", problem.name, problem.reason));
    }
    if !format.is_gltf() {
        return;
    }
    let pictures = found.materials.iter().filter_map(|material| material.picture.as_ref());
    let mut unknown: Vec<&PathBuf> =
        pictures.filter(|own| own.mime_type.is_none()).map(|Picture { file, .. }| file).collect();
    unknown.sort_unstable();
    unknown.dedup();
    for file in unknown {
        progress.note(format!("{}: left out: neither PNG nor JPEG, which glTF knows", file.display()));
    }
}
