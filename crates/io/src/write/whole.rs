//! Files that are written whole or not at all.
//!
//! The bytes go to a temporary file in the same folder, which takes the name at the end. An error, or the end
//! of the program on the way, leaves an earlier file of that name as it was.

use crate::error::WriteError;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

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
pub(super) fn write_whole_with(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Result<(), WriteError> {
    let failed = |reason: io::Error| WriteError::File { path: path.to_owned(), reason };
    let earlier = fs::metadata(path).ok();
    if let Some(earlier) = earlier.as_ref().filter(|e| !e.is_file()) {
        if earlier.is_dir() {
            return Err(failed(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let mut device = fs::OpenOptions::new().write(true).open(path).map_err(failed)?;
        return fill(&mut device).map_err(|error| error.in_file(path));
    }
    if earlier.is_some() {
        // A new name over a file asks only the folder for permission: ask the file as well.
        fs::OpenOptions::new().write(true).open(path).map_err(failed)?;
    }
    let target = if earlier.is_some() { fs::canonicalize(path).map_err(failed)? } else { path.to_owned() };
    let mut file = temporary_beside(&target).map_err(failed)?;
    fill(&mut file).map_err(|error| error.in_file(path))?;
    if let Some(earlier) = earlier {
        fs::set_permissions(file.path(), earlier.permissions()).map_err(failed)?;
    }
    file.persist(&target).map(drop).map_err(|error| failed(error.error))
}

/// A new file in the folder of `target`, which is removed unless it is renamed.
fn temporary_beside(target: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".limitmesh-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any new file asks for; the user's mask takes from it.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
