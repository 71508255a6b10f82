//! Reading: from a file or its bytes to a polygon soup.

use crate::content::looks_like_other;
use crate::error::ReadError;
use crate::files::read_all;
use crate::format::Format;
use crate::formats::codec;
use limitmesh::mesh::PolygonSoup;
use std::path::Path;

/// Reads a mesh file in the format of its extension.
///
/// # Errors
/// The extension is unknown, the file cannot be read, its content is plainly of another format, or it breaks
/// the rules of its format; each names the file, and the last the line or byte as well.
pub fn read(path: impl AsRef<Path>) -> Result<PolygonSoup, ReadError> {
    let path = path.as_ref();
    read_as(path, Format::from_path(path)?)
}

/// [`read`] in a format that the name need not say.
///
/// # Errors
/// As for [`read`], but for unknown extensions.
pub fn read_as(path: &Path, format: Format) -> Result<PolygonSoup, ReadError> {
    let soup = read_from(&read_all(path)?, format, path.parent());
    soup.map_err(|error| error.in_file(path))
}

/// Reads the bytes of a mesh file in the given format. glTF documents may name no other files then.
///
/// # Errors
/// As for [`read`].
pub fn read_bytes(bytes: &[u8], format: Format) -> Result<PolygonSoup, ReadError> {
    read_from(bytes, format, None)
}

/// Reads bytes unless there are none, or they are plainly of another kind.
fn read_from(
    bytes: &[u8],
    format: Format,
    folder: Option<&Path>,
) -> Result<PolygonSoup, ReadError> {
    let path = None;
    if bytes.is_empty() {
        return Err(ReadError::Empty { path, format });
    }
    match looks_like_other(bytes, format) {
        Some(looks_like) => Err(ReadError::OtherContent {
            path,
            format,
            looks_like,
        }),
        None => (codec(format).read)(bytes, folder),
    }
}
