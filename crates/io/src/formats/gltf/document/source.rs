//! The document as it was read: its JSON, and the bytes that its buffers and views name.
//!
//! Files that the document names are read when something asks for them, so that a missing animation does not keep a mesh
//! from being refined.

use super::codecs;
use super::container::Container;
use super::extensions::MESHOPT;
use super::json::At;
use super::uri::{self, Uri};
use crate::files::file_below;
use crate::flaw::{Flaw, Result, shortened};
use serde_json::Value;
use std::cell::{Cell, OnceCell};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Bytes at most that compressed data may become, all together: more than any asset has, less than what a few bytes
/// could claim.
const MOST_DECODED: usize = 2 << 30;

/// A document and what belongs to it.
#[derive(Debug)]
pub(crate) struct Source {
    /// The whole JSON document.
    pub(crate) json: Value,
    /// The file's parts.
    pub(crate) container: Container,
    /// The folder of the files that the document names; `None` if it came from nowhere.
    folder: Option<PathBuf>,
    buffers: Vec<OnceCell<Result<Vec<u8>>>>,
    views: Vec<OnceCell<Result<Vec<u8>>>>,
    /// Whether it claims no more zeros than any document needs.
    pub(crate) zeros_are_few: OnceCell<Result<()>>,
    /// Bytes that may still be decoded.
    room: Cell<usize>,
}

/// The bytes of a buffer view.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) bytes: &'a [u8],
    /// From one element to the next, where the view says so.
    pub(crate) stride: Option<usize>,
}

impl Source {
    /// Takes a file apart and reads its JSON.
    pub(crate) fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Self> {
        let container = Container::parse(bytes)?;
        let broken = |error| format!("it cannot be read: {error}");
        let json: Value = serde_json::from_str(&container.text)
            .map_err(|error| Flaw::saying("the JSON text", broken(error)))?;
        let root = At::root(&json);
        if !json.is_object() {
            return Err(root.unexpected("an object"));
        }
        let version = root.require("asset")?.require("version")?;
        if !version.text()?.starts_with("2.") {
            return Err(version.unexpected("2.0"));
        }
        let cells = |key: &str| Ok(root.list(key)?.iter().map(|_| OnceCell::new()).collect());
        let (buffers, views) = (cells("buffers")?, cells("bufferViews")?);
        Ok(Self {
            json,
            container,
            folder: folder.map(Path::to_owned),
            buffers,
            views,
            zeros_are_few: OnceCell::new(),
            room: Cell::new(MOST_DECODED),
        })
    }

    /// The folder of the files that the document names.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The JSON document.
    pub(crate) fn root(&self) -> At<'_> {
        At::root(&self.json)
    }

    /// The bytes of a buffer, which `at` names by its index: as many as it says it has.
    pub(crate) fn buffer(&self, at: &At<'_>) -> Result<&[u8]> {
        let root = self.root();
        let (index, buffer) = (
            at.number_in(&root, "buffers")?,
            at.item_of(&root, "buffers")?,
        );
        let length = buffer.require("byteLength")?;
        let size = length.count()?;
        if let Some(bin) = &self.container.bin
            && index == 0
            && buffer.get("uri").is_none()
        {
            let most = bin.len();
            let expected = || format!("at most {most} (the length of the GLB's binary chunk)");
            return bin.get(..size).ok_or_else(|| length.unexpected(expected()));
        }
        let loaded = self.buffers[index].get_or_init(|| self.load(&buffer, &length, size));
        loaded.as_deref().map_err(Clone::clone)
    }

    fn load(&self, buffer: &At<'_>, length: &At<'_>, size: usize) -> Result<Vec<u8>> {
        let Some(uri) = buffer.get("uri") else {
            let problem = "it has neither a 'uri' nor a binary chunk";
            return Err(Flaw::saying(buffer.place(), problem));
        };
        let too_short =
            |there: usize| length.unexpected(format!("at most {there} (the bytes that there are)"));
        if let Uri::Base64(data) = parse_uri(&uri)? {
            // Before any room is made for it.
            let most = data.len() / 4 * 3;
            if most + 3 < size {
                return Err(too_short(most));
            }
        }
        let bytes = self.bytes_of(&uri, size)?;
        if bytes.len() < size {
            Err(too_short(bytes.len()))
        } else {
            Ok(bytes)
        }
    }

    /// The first bytes that a `uri` names.
    fn bytes_of(&self, at: &At<'_>, most: usize) -> Result<Vec<u8>> {
        match parse_uri(at)? {
            Uri::Base64(data) => {
                uri::from_base64(data, most).ok_or_else(|| at.unexpected("base 64"))
            }
            Uri::File(file) => {
                let bytes = self.file(&file).and_then(|path| {
                    let mut bytes = Vec::new();
                    let mut found = std::fs::File::open(path)?.take(most as u64);
                    found.read_to_end(&mut bytes)?;
                    Ok(bytes)
                });
                bytes.map_err(|why| {
                    let name = shortened(&file.display().to_string());
                    let problem = format!("the file '{name}' cannot be read: {why}");
                    Flaw::saying(at.place(), problem)
                })
            }
        }
    }

    /// The bytes of a picture that a `uri` names.
    pub(crate) fn picture(&self, at: &At<'_>) -> Result<Vec<u8>> {
        self.bytes_of(at, MOST_DECODED)
    }

    /// Where a file below the folder is.
    ///
    /// # Errors
    /// There is no such file, or a link leads out of the folder.
    pub(crate) fn file(&self, file: &Path) -> io::Result<PathBuf> {
        let none = || io::Error::other("the document has no folder");
        file_below(self.folder().ok_or_else(none)?, file)
    }

    /// The bytes of a buffer view, which `at` names by its index; decoded if they are compressed.
    pub(crate) fn view(&self, at: &At<'_>) -> Result<View<'_>> {
        let root = self.root();
        let view = at.item_of(&root, "bufferViews")?;
        let stride = view.get("byteStride");
        let count = stride.as_ref().map(|stride| match stride.count()? {
            0 => Err(stride.unexpected("at least 4")),
            bytes => Ok(bytes),
        });
        let stride = count.transpose()?;
        let is_compressed = |name: &&str| view.path(&["extensions", name]);
        let Some(compressed) = MESHOPT.iter().find_map(is_compressed) else {
            return Ok(View {
                bytes: self.range(&view)?,
                stride,
            });
        };
        let decoded = self.views[at.number_in(&root, "bufferViews")?].get_or_init(|| {
            let take_room = |bytes| self.take_room(&compressed, bytes);
            codecs::meshopt(&compressed, self.range(&compressed)?, take_room)
        });
        let bytes = decoded.as_deref().map_err(Clone::clone)?;
        Ok(View { bytes, stride })
    }

    /// The part of a buffer that a view, or the extension of one, names.
    fn range(&self, view: &At<'_>) -> Result<&[u8]> {
        let buffer = self.buffer(&view.require("buffer")?)?;
        let start = view.count_or("byteOffset", 0)?;
        let length = view.require("byteLength")?.count()?;
        let end = start.checked_add(length);
        end.and_then(|end| buffer.get(start..end)).ok_or_else(|| {
            let there = buffer.len();
            let problem =
                format!("it names {length} bytes from byte {start} on, but its buffer has {there}");
            Flaw::saying(view.place(), problem)
        })
    }

    /// Bytes that may still be decoded.
    pub(crate) fn room(&self) -> usize {
        self.room.get()
    }

    /// Notes that so many bytes will be decoded.
    pub(crate) fn take_room(&self, at: &At<'_>, bytes: usize) -> Result<()> {
        let Some(left) = self.room.get().checked_sub(bytes) else {
            let problem = format!(
                "with these {bytes} bytes the document has more than 2 GiB of compressed data"
            );
            return Err(Flaw::saying(at.place(), problem));
        };
        self.room.set(left);
        Ok(())
    }
}

/// Understands a `uri`.
fn parse_uri<'a>(at: &At<'a>) -> Result<Uri<'a>> {
    uri::parse(at.text()?).map_err(|expected| at.unexpected(expected))
}
