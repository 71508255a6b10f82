//! Files that are written whole or not at all.
//!
//! The bytes go to a temporary file in the same folder, which takes the name at the end. An error, or the end
//! of the program on the way, leaves an earlier file of that name as it was.

use crate::error::WriteError;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Finds out, without writing anything, whether [`write_whole`] could write a file: to be asked before long work.
///
/// # Errors
/// The folder does not exist or may not be written to, or the earlier file of that name is a folder or read-only.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let failed = |reason: io::Error| WriteError::File { path: path.to_owned(), reason };
    match earlier(path).map_err(failed)? {
        Some(device) if !device.is_file() => Ok(()),
        earlier => {
            temporary_beside(&target(path, earlier.as_ref()).map_err(failed)?).map(drop).map_err(failed)
        }
    }
}

/// What is known of the earlier file of that name, if there is one; an error if it may not be replaced.
fn earlier(path: &Path) -> io::Result<Option<fs::Metadata>> {
    let Ok(earlier) = fs::metadata(path) else { return Ok(None) };
    if earlier.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory));
    }
    if earlier.is_file() {
        // A new name over a file asks only the folder for permission, and the superuser may write to what is read-only: ask
        // the file as well.
        if earlier.permissions().readonly() {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only"));
        }
        fs::OpenOptions::new().write(true).open(path)?;
    }
    Ok(Some(earlier))
}

/// The file that is replaced where `path` names it by a link.
fn target(path: &Path, earlier: Option<&fs::Metadata>) -> io::Result<PathBuf> {
    if earlier.is_some() { fs::canonicalize(path) } else { Ok(path.to_owned()) }
}

/// Writes `bytes` to a file, whole or not at all.
///
/// A new file gets the permissions of any other new file; an earlier one keeps its own. A symbolic link stays
/// one, and the file it points to is replaced. What is not a regular file (a device, a pipe) is written to
/// directly.
///
/// # Errors
/// The folder does not exist, it or the earlier file may not be written to, or there is no space.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_whole_with(path, |writer| Ok(writer.write_all(bytes)?))
}

/// Writes what `fill` gives to a file, whole or not at all, as [`write_whole`] does.
///
/// # Errors
/// As for [`write_whole`]; what `fill` returns.
pub fn write_whole_with(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Result<(), WriteError> {
    let failed = |reason: io::Error| WriteError::File { path: path.to_owned(), reason };
    let earlier = earlier(path).map_err(failed)?;
    if earlier.as_ref().is_some_and(|e| !e.is_file()) {
        let mut device = fs::OpenOptions::new().write(true).open(path).map_err(failed)?;
        return fill(&mut device).map_err(|error| error.in_file(path));
    }
    let target = target(path, earlier.as_ref()).map_err(failed)?;
    let mut file = temporary_beside(&target).map_err(failed)?;
    fill(file.as_file_mut()).map_err(|error| error.in_file(path))?;
    if let Some(earlier) = earlier {
        fs::set_permissions(file.path(), earlier.permissions()).map_err(failed)?;
    }
    file.persist(&target).map(drop).map_err(|error| failed(error.error))
}

/// A file with all its bytes.
pub(crate) struct WholeFile {
    pub(crate) path: PathBuf,
    pub(crate) bytes: Vec<u8>,
}

/// Writes several files that belong together: all under other names first, which are changed only when all are there.
pub(crate) fn write_together(files: &[WholeFile]) -> Result<(), WriteError> {
    let mut waiting = Vec::with_capacity(files.len());
    for WholeFile { path, bytes } in files {
        let failed = |reason: io::Error| WriteError::File { path: path.clone(), reason };
        let earlier = earlier(path).map_err(failed)?;
        if earlier.as_ref().is_some_and(|e| !e.is_file()) {
            waiting.push((path, None));
            continue;
        }
        let target = target(path, earlier.as_ref()).map_err(failed)?;
        let mut file = temporary_beside(&target).map_err(failed)?;
        file.as_file_mut().write_all(bytes).map_err(failed)?;
        if let Some(earlier) = earlier {
            fs::set_permissions(file.path(), earlier.permissions()).map_err(failed)?;
        }
        waiting.push((path, Some((file, target))));
    }
    for ((path, file), WholeFile { bytes, .. }) in waiting.into_iter().zip(files) {
        match file {
            Some((file, target)) => {
                let failed = |error: tempfile::PersistError| WriteError::File {
                    path: path.clone(),
                    reason: error.error,
                };
                file.persist(&target).map_err(failed)?;
            }
            None => write_whole(path, bytes)?,
        }
    }
    Ok(())
}

/// A new file in the folder of `target`, which is removed unless it is renamed.
///
/// It is opened here and written to as it is, since errors would name the temporary file otherwise, which nobody asked for.
fn temporary_beside(target: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    // With the permissions of any new file.
    let open = |path: &Path| fs::OpenOptions::new().read(true).write(true).create_new(true).open(path);
    tempfile::Builder::new().prefix(".limitmesh-").suffix(".tmp").make_in(folder, open)
}
