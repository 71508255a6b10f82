//! Copies of the files that a document names, at the same places below the folder of a new one.

use super::whole::WholeFile;
use crate::error::WriteError;
use std::io;
use std::path::{Path, PathBuf};

/// Files that are to be written below a folder, given by their paths from there and where they are now: those that are not there. Folders
/// for them are made.
///
/// # Errors
/// The system refuses, or another file is there already that is not the same.
pub(crate) fn copies<'a>(
    files: impl Iterator<Item = (&'a Path, PathBuf)>,
    folder: &Path,
) -> Result<Vec<WholeFile>, WriteError> {
    let mut whole = Vec::new();
    for (file, from) in files {
        let to = folder.join(file);
        let failed = |reason| WriteError::File {
            path: to.clone(),
            reason,
        };
        let from = from.canonicalize().map_err(failed)?;
        if to.canonicalize().is_ok_and(|there| there == from) {
            continue;
        }
        let bytes = std::fs::read(&from).map_err(failed)?;
        match std::fs::read(&to) {
            Ok(there) if there == bytes => continue,
            Ok(_) => {
                let why = format!(
                    "it is there already, and not the same as {}",
                    from.display()
                );
                return Err(failed(io::Error::new(io::ErrorKind::AlreadyExists, why)));
            }
            Err(_) => {}
        }
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        whole.push(WholeFile { path: to, bytes });
    }
    Ok(whole)
}
