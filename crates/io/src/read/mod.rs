//! Reading: from a file or its bytes to a polygon soup.

mod left_out;
mod obj;
mod off;
mod ply;
mod stl;

use crate::error::{Flaw, Place, ReadError};
use crate::format::{Format, looks_like_other};
use crate::gltf::Asset;
use crate::threemf::Package;
use limitmesh::mesh::{PolygonFaces, PolygonSoup};
use std::io;
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

/// [`read`] in a format that the name need not tell.
///
/// # Errors
/// The same, but for unknown extensions.
pub fn read_as(path: &Path, format: Format) -> Result<PolygonSoup, ReadError> {
    let bytes = read_all(path).map_err(|reason| ReadError::Io {
        path: path.to_owned(),
        reason,
    })?;
    let soup = match format {
        Format::Gltf | Format::Glb => {
            check_content(&bytes, format).and_then(|()| read_gltf(&bytes, path.parent()))
        }
        _ => read_bytes(&bytes, format),
    };
    soup.map_err(|error| error.in_file(path))
}

/// All that a document's scene shows, in the scene's coordinates.
fn read_gltf(bytes: &[u8], folder: Option<&Path>) -> Result<PolygonSoup, ReadError> {
    Asset::from_bytes(bytes, folder)?.scene_soup()
}

/// All bytes of a file or a pipe. A device is refused: some, like `/dev/zero`, never end.
pub(crate) fn read_all(path: &Path) -> io::Result<Vec<u8>> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let kind = std::fs::metadata(path)?.file_type();
        if kind.is_char_device() || kind.is_block_device() {
            return Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "it is a device, not a file",
            ));
        }
    }
    std::fs::read(path)
}

/// Reads the bytes of a mesh file in the given format. glTF documents may name no other files then.
///
/// # Errors
/// As for [`read`].
pub fn read_bytes(bytes: &[u8], format: Format) -> Result<PolygonSoup, ReadError> {
    check_content(bytes, format)?;
    let soup = match format {
        Format::Gltf | Format::Glb => return read_gltf(bytes, None),
        Format::Obj => obj::read(bytes),
        Format::Ply => ply::read(bytes),
        Format::Stl => stl::read(bytes),
        Format::Off => off::read(bytes),
        Format::ThreeMf => return Package::from_bytes(bytes.to_vec())?.scene_soup(),
    };
    soup.map_err(|flaw| flaw.in_format(format))
}

/// Refuses what is empty or plainly of another kind.
fn check_content(bytes: &[u8], format: Format) -> Result<(), ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::Empty { path: None, format });
    }
    match looks_like_other(bytes, format) {
        Some(looks_like) => Err(ReadError::OtherContent {
            path: None,
            format,
            looks_like,
        }),
        None => Ok(()),
    }
}

/// Most elements of a kind that `u32` indices can name.
const MOST: usize = u32::MAX as usize;

/// Refuses counts that `u32` indices cannot name.
fn check_count(count: u64, what: &str, place: Place) -> Result<usize, Flaw> {
    match usize::try_from(count) {
        Ok(count) if count <= MOST => Ok(count),
        _ => Err(Flaw::new(
            place,
            count.to_string(),
            format!("at most {MOST} {what}"),
        )),
    }
}

/// Adds a face, unless all faces together would have more corners than can be counted.
#[inline]
fn push_face(
    faces: &mut PolygonFaces,
    corners: &[u32],
    place: impl Fn() -> Place,
) -> Result<(), Flaw> {
    if corners.len() > MOST - faces.corner_count() {
        let found = format!("more than {MOST}");
        return Err(Flaw::new(
            place(),
            found,
            format!("at most {MOST} face corners"),
        ));
    }
    faces.push(corners);
    Ok(())
}
