//! Files below a folder: what a document names is reached there and nowhere else.

use std::io;
use std::path::{Path, PathBuf};

/// Where a file is, given by its path from a folder.
///
/// # Errors
/// There is none, or a link leads out of the folder.
pub(crate) fn file_below(folder: &Path, file: &Path) -> io::Result<PathBuf> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let path = folder.join(file).canonicalize()?;
    match path.starts_with(folder.canonicalize()?) {
        true if path.is_file() => Ok(path),
        true => Err(io::Error::other("it is no file")),
        false => Err(io::Error::other("it leads out of the document's folder")),
    }
}
