//! The document as it was read: its JSON, and the bytes that its buffers and views name.
//!
//! Files beside the document are read when something asks for them, so that a missing animation does not keep a mesh
//! from being refined.

use super::codecs;
use super::container::Container;
use super::flaw::{GltfFlaw, Result};
use super::json::{At, shortened};
use super::uri::{self, Uri};
use crate::below::file_below;
use serde_json::Value;
use std::cell::{Cell, OnceCell};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Bytes at most that compressed data may become, all together: more than any asset has, less than what a few bytes
/// could claim.
const MOST_DECODED: usize = 2 << 30;

/// A document and what belongs to it.
#[derive(Debug)]
pub(super) struct Source {
    /// The whole JSON document.
    pub(super) json: Value,
    /// The file's parts.
    pub(super) container: Container,
    /// Where files beside the document are; `None` if it came from nowhere.
    folder: Option<PathBuf>,
    buffers: Vec<OnceCell<Result<Vec<u8>>>>,
    views: Vec<OnceCell<Result<Vec<u8>>>>,
    /// Whether it claims no more zeros than any document needs.
    pub(super) zeros_are_few: OnceCell<Result<()>>,
    /// Bytes that may still be decoded.
    room: Cell<usize>,
}

/// The bytes of a buffer view.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    /// From one element to the next, where the view says so.
    pub(super) stride: Option<usize>,
}

/// Names under which meshopt compression is known.
pub(super) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

impl Source {
    /// Takes a file apart and reads its JSON.
    pub(super) fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Self> {
        let container = Container::parse(bytes)?;
        let json: Value = serde_json::from_str(&container.text).map_err(|error| {
            GltfFlaw::saying("the JSON text", format!("it cannot be read: {error}"))
        })?;
        let root = At::root(&json);
        if !json.is_object() {
            return Err(root.unexpected("an object"));
        }
        let version = root.require("asset")?.require("version")?;
        if !version.text()?.starts_with("2.") {
            return Err(version.unexpected("2.0"));
        }
        let cells = |key: &str| {
            Ok((0..root.list(key)?.len())
                .map(|_| OnceCell::new())
                .collect())
        };
        let (buffers, views) = (cells("buffers")?, cells("bufferViews")?);
        let room = Cell::new(MOST_DECODED);
        let zeros_are_few = OnceCell::new();
        Ok(Self {
            json,
            container,
            folder: folder.map(Path::to_owned),
            buffers,
            views,
            zeros_are_few,
            room,
        })
    }

    /// Where files beside the document are.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The JSON document.
    pub(super) fn root(&self) -> At<'_> {
        At::root(&self.json)
    }

    /// The bytes of a buffer, which `at` names by its index: as many as it says it has.
    pub(super) fn buffer(&self, at: &At<'_>) -> Result<&[u8]> {
        let (index, buffer) = at.item_of(&self.root(), "buffers")?;
        let length = buffer.require("byteLength")?;
        let size = length.count()?;
        if buffer.get("uri").is_none() && index == 0 && self.container.bin.is_some() {
            let bin = self.container.bin.as_deref().unwrap_or_default();
            return bin.get(..size).ok_or_else(|| {
                length.unexpected(format!(
                    "at most {} (the length of the GLB's binary chunk)",
                    bin.len()
                ))
            });
        }
        let loaded = self.buffers[index].get_or_init(|| self.load(&buffer, &length, size));
        loaded.as_deref().map_err(Clone::clone)
    }

    fn load(&self, buffer: &At<'_>, length: &At<'_>, size: usize) -> Result<Vec<u8>> {
        let Some(uri) = buffer.get("uri") else {
            return Err(GltfFlaw::saying(
                buffer.place(),
                "it has neither a 'uri' nor a binary chunk",
            ));
        };
        let too_short =
            |there: usize| length.unexpected(format!("at most {there} (the bytes that there are)"));
        match self.parse_uri(&uri)? {
            Uri::Base64(data) => {
                // Before any room is made for it.
                if data.len() / 4 * 3 + 3 < size {
                    return Err(too_short(data.len() / 4 * 3));
                }
                let bytes =
                    uri::from_base64(data, size).ok_or_else(|| uri.unexpected("base 64"))?;
                if bytes.len() < size {
                    Err(too_short(bytes.len()))
                } else {
                    Ok(bytes)
                }
            }
            Uri::File(file) => {
                let bytes = self.file_bytes(&uri, &file, size)?;
                if bytes.len() < size {
                    Err(too_short(bytes.len()))
                } else {
                    Ok(bytes)
                }
            }
        }
    }

    /// The bytes of a picture that a `uri` names.
    pub(super) fn picture(&self, at: &At<'_>) -> Result<Vec<u8>> {
        match self.parse_uri(at)? {
            Uri::Base64(data) => {
                uri::from_base64(data, MOST_DECODED).ok_or_else(|| at.unexpected("base 64"))
            }
            Uri::File(file) => self.file_bytes(at, &file, MOST_DECODED),
        }
    }

    /// Understands a `uri`.
    pub(super) fn parse_uri<'a>(&self, at: &At<'a>) -> Result<Uri<'a>> {
        uri::parse(at.text()?).map_err(|expected| at.unexpected(expected))
    }

    /// The first bytes of a file below the folder.
    fn file_bytes(&self, at: &At<'_>, file: &Path, most: usize) -> Result<Vec<u8>> {
        let refused = |why: &dyn std::fmt::Display| {
            let name = shortened(&file.display().to_string());
            GltfFlaw::saying(
                at.place(),
                format!("the file '{name}' cannot be read: {why}"),
            )
        };
        let path = self.file(file).map_err(|why| refused(&why))?;
        let opened = std::fs::File::open(path).and_then(|file| {
            let mut bytes = Vec::new();
            file.take(most as u64).read_to_end(&mut bytes)?;
            Ok(bytes)
        });
        opened.map_err(|why| refused(&why))
    }

    /// Where a file below the folder is.
    ///
    /// # Errors
    /// There is no such file, or a link leads out of the folder.
    pub(super) fn file(&self, file: &Path) -> io::Result<PathBuf> {
        let folder = self
            .folder
            .as_ref()
            .ok_or_else(|| io::Error::other("the document has no folder"))?;
        file_below(folder, file)
    }

    /// The bytes of a buffer view, which `at` names by its index; decoded if they are compressed.
    pub(super) fn view(&self, at: &At<'_>) -> Result<View<'_>> {
        let (index, view) = at.item_of(&self.root(), "bufferViews")?;
        let stride = match view.get("byteStride") {
            None => None,
            Some(stride) => match stride.count()? {
                0 => return Err(stride.unexpected("at least 4")),
                bytes => Some(bytes),
            },
        };
        let compressed = MESHOPT
            .iter()
            .find_map(|name| view.path(&["extensions", name]));
        let Some(compressed) = compressed else {
            return Ok(View {
                bytes: self.range(&view)?,
                stride,
            });
        };
        let decoded = self.views[index].get_or_init(|| {
            let source = self.range(&compressed)?;
            codecs::meshopt(&compressed, source, |bytes| {
                self.take_room(&compressed, bytes)
            })
        });
        match decoded {
            Ok(bytes) => Ok(View { bytes, stride }),
            Err(flaw) => Err(flaw.clone()),
        }
    }

    /// The part of a buffer that a view, or the extension of one, names.
    fn range(&self, view: &At<'_>) -> Result<&[u8]> {
        let buffer = self.buffer(&view.require("buffer")?)?;
        let (start, length) = (
            view.count_or("byteOffset", 0)?,
            view.require("byteLength")?.count()?,
        );
        start
            .checked_add(length)
            .and_then(|end| buffer.get(start..end))
            .ok_or_else(|| {
                let there = buffer.len();
                let problem = format!(
                    "it names {length} bytes from byte {start} on, but its buffer has {there}"
                );
                GltfFlaw::saying(view.place(), problem)
            })
    }

    /// Bytes that may still be decoded.
    pub(super) fn room(&self) -> usize {
        self.room.get()
    }

    /// Notes that so many bytes will be decoded.
    pub(super) fn take_room(&self, at: &At<'_>, bytes: usize) -> Result<()> {
        let Some(left) = self.room.get().checked_sub(bytes) else {
            let problem = format!(
                "with these {bytes} bytes the document has more than 2 GiB of compressed data"
            );
            return Err(GltfFlaw::saying(at.place(), problem));
        };
        self.room.set(left);
        Ok(())
    }
}
