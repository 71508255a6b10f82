//! Files as a whole: read, found below a folder, or copied below another.

use crate::error::{ReadError, WriteError};
use crate::whole::WholeFile;
use std::io;
use std::path::{Path, PathBuf};

/// The folder of a file, which is empty for one in the current folder.
pub(crate) fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// The absolute path of a folder; an empty one is the current folder.
///
/// # Errors
/// There is none.
pub(crate) fn absolute(folder: &Path) -> io::Result<PathBuf> {
    let is_empty = folder.as_os_str().is_empty();
    if is_empty { Path::new(".") } else { folder }.canonicalize()
}

/// Where a file is, given by its path from a folder.
///
/// # Errors
/// There is none, or a link leads out of the folder.
pub(crate) fn file_below(folder: &Path, file: &Path) -> io::Result<PathBuf> {
    let folder = absolute(folder)?;
    let path = folder.join(file).canonicalize()?;
    match path.starts_with(folder) {
        true if path.is_file() => Ok(path),
        true => Err(io::Error::other("it is no file")),
        false => Err(io::Error::other("it leads out of the document's folder")),
    }
}

/// All bytes of a file or a pipe. A device is refused: some, like `/dev/zero`, never end.
pub(crate) fn read_all(path: &Path) -> Result<Vec<u8>, ReadError> {
    let bytes = refuse_devices(path).and_then(|()| std::fs::read(path));
    bytes.map_err(|reason| ReadError::Io {
        path: path.to_owned(),
        reason,
    })
}

#[cfg(unix)]
fn refuse_devices(path: &Path) -> io::Result<()> {
    use std::os::unix::fs::FileTypeExt;
    let kind = std::fs::metadata(path)?.file_type();
    match kind.is_char_device() || kind.is_block_device() {
        true => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is a device, not a file",
        )),
        false => Ok(()),
    }
}

#[cfg(not(unix))]
fn refuse_devices(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Copies of files below a folder, given by their paths from there and where they are now: those that are not there yet. Makes the folders that
/// they need.
///
/// # Errors
/// The system refuses, or another file is there already that is not the same.
pub(crate) fn copies<'a>(
    files: impl Iterator<Item = (&'a Path, PathBuf)>,
    folder: &Path,
) -> Result<Vec<WholeFile>, WriteError> {
    let mut copies = Vec::new();
    for (file, from) in files {
        let path = folder.join(file);
        let failed = WriteError::of(&path);
        let from = from.canonicalize().map_err(&failed)?;
        if path.canonicalize().is_ok_and(|there| there == from) {
            continue;
        }
        let bytes = std::fs::read(&from).map_err(&failed)?;
        match std::fs::read(&path) {
            Ok(there) if there == bytes => continue,
            Ok(_) => {
                let from = from.display();
                let why = format!("it is there already, and not the same as {from}");
                return Err(failed(io::Error::new(io::ErrorKind::AlreadyExists, why)));
            }
            Err(_) => std::fs::create_dir_all(folder_of(&path)).map_err(&failed)?,
        }
        drop(failed);
        copies.push(WholeFile { path, bytes });
    }
    Ok(copies)
}
