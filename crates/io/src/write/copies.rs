//! Copies of the files that a document names, at the same places below the folder of a new one.

use super::whole::{WholeFile, write_together};
use crate::error::WriteError;
use std::io;
use std::path::{Path, PathBuf};

/// Copies files, given by their ways from a folder, to the same places below another: all or none, and only those that are not there.
///
/// # Errors
/// The system refuses, or another file is there already that is not the same.
pub fn copy_beside<'a>(
    from: &Path,
    files: impl Iterator<Item = &'a PathBuf>,
    to: &Path,
) -> Result<(), WriteError> {
    write_together(&copies(files.map(|file| (file.as_path(), from.join(file))), to)?)
}

/// Files that are to be written below a folder, given by their ways from there and where they are now: those that are not there. Folders
/// for them are made.
pub(crate) fn copies<'a>(
    files: impl Iterator<Item = (&'a Path, PathBuf)>,
    folder: &Path,
) -> Result<Vec<WholeFile>, WriteError> {
    let mut whole = Vec::new();
    for (file, from) in files {
        let to = folder.join(file);
        let reason = |reason| WriteError::File { path: to.clone(), reason };
        let from = from.canonicalize().map_err(reason)?;
        if to.canonicalize().is_ok_and(|there| there == from) {
            continue;
        }
        let bytes = std::fs::read(&from).map_err(reason)?;
        match std::fs::read(&to) {
            Ok(there) if there == bytes => continue,
            Ok(_) => {
                let why = format!("it is there already, and not the same as {}", from.display());
                return Err(reason(io::Error::new(io::ErrorKind::AlreadyExists, why)));
            }
            Err(_) => {}
        }
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder).map_err(reason)?;
        }
        whole.push(WholeFile { path: to, bytes });
    }
    Ok(whole)
}
