//! The declaration of each format: how files begin, what they can hold, how they are read and written.

use crate::capacity::Capacity;
use crate::error::{ReadError, WriteError};
use crate::output::{Output, WriteOptions};
use limitmesh::mesh::PolygonSoup;
use std::io::Write;
use std::path::Path;

/// Writes an output that was checked to the file at a path, and other files that belong to it.
pub(crate) type WriteFile = fn(&Path, &Output<'_>, &WriteOptions) -> Result<(), WriteError>;

/// A format, as the functions that read and write all formats know it.
pub(crate) struct Codec {
    /// Whether bytes begin as files of the format do, in text if there are texts.
    pub(crate) begins: fn(&[u8]) -> bool,
    pub(crate) capacity: fn(&WriteOptions) -> Capacity,
    /// Reads a file's bytes, and files that these name below its folder, if it has one.
    pub(crate) read: fn(&[u8], Option<&Path>) -> Result<PolygonSoup, ReadError>,
    /// Writes an output that was checked, as one file.
    pub(crate) write: fn(&mut dyn Write, &Output<'_>, &WriteOptions) -> Result<(), WriteError>,
    /// Writes several files that belong together, if the format has any.
    pub(crate) write_file: Option<WriteFile>,
}
