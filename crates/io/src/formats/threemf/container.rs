//! The archive: parts are read from it, and all but those that changed are copied as they are, compressed.
//!
//! The sizes that the archive states are not believed: a part is given up where it becomes larger than [`MOST_BYTES`], or than text ever does
//! that was compressed to the archive's size ([`MOST_TIMES`]).

use super::xml::elements;
use crate::flaw::{Flaw, Result};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// The archive itself as the place of a flaw.
pub(super) const ARCHIVE: &str = "the package";

/// Bytes of all parts together that are read, at most: as much as some thirty million triangles take.
const MOST_BYTES: u64 = 1 << 31;

/// How many times as large as the archive all parts together may be, and how many bytes they may be in any case. Triangles as text take five to
/// thirty times what they take compressed; bytes that are all alike take a thousand times as much.
const MOST_TIMES: u64 = 100;
const ALWAYS: u64 = 1 << 25;

/// Parts at most.
const MOST_PARTS: usize = 100_000;

/// The relationships of a package.
const RELATIONSHIPS: &str = "_rels/.rels";

/// The type of the relationship to the model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// The bytes of a package, and where its parts are.
#[derive(Clone)]
pub(super) struct Container {
    bytes: Vec<u8>,
    names: Vec<String>,
}

impl Container {
    pub(super) fn parse(bytes: Vec<u8>) -> Result<Self> {
        let archive = open(&bytes)?;
        let count = archive.len();
        if count > MOST_PARTS {
            let problem = format!("it has {count} parts; at most {MOST_PARTS} are read");
            return Err(Flaw::saying(ARCHIVE, problem));
        }
        // A part whose name cannot be read is copied, and never asked for.
        let name = |i| archive.name_for_index(i).and_then(std::result::Result::ok);
        let names = (0..count)
            .map(|i| name(i).map_or_else(String::new, Cow::into_owned))
            .collect();
        drop(archive);
        Ok(Self { bytes, names })
    }

    /// A part as the archive calls it; names are alike in capitals and small letters.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let name = name.trim_start_matches('/');
        let is_own = |own: &&String| own.trim_start_matches('/').eq_ignore_ascii_case(name);
        self.names.iter().position(|own| is_own(&own))
    }

    /// The name of a part.
    pub(super) fn name(&self, part: usize) -> &str {
        &self.names[part]
    }

    /// The text of a part, counting it to what has been `read` so far.
    pub(super) fn text(&self, part: usize, read: &mut u64) -> Result<String> {
        let name = self.name(part);
        let flaw = |why: &dyn std::fmt::Display| {
            Flaw::saying(name, format!("it cannot be unpacked: {why}"))
        };
        let mut archive = open(&self.bytes)?;
        let file = archive.by_index(part).map_err(|why| flaw(&why))?;
        let most = MOST_BYTES.min(ALWAYS.saturating_add(MOST_TIMES * self.bytes.len() as u64));
        let mut bytes = Vec::new();
        let found = file.take(most - *read + 1).read_to_end(&mut bytes);
        found.map_err(|why| flaw(&why))?;
        *read += bytes.len() as u64;
        if *read > most {
            let problem = format!(
                "with this part the models have more than {} MiB; they may have 2 GiB, and 32 MiB with {MOST_TIMES} times the \
                 archive's size",
                most >> 20
            );
            return Err(Flaw::saying(name, problem));
        }
        // What some programs put before text in UTF-8 stays: it is part of what is edited.
        String::from_utf8(bytes).map_err(|error| {
            let byte = error.utf8_error().valid_up_to();
            Flaw::saying(name, format!("byte {byte} is not UTF-8"))
        })
    }

    /// The part that is the model, by the package's relationships.
    pub(super) fn root(&self, read: &mut u64) -> Result<usize> {
        let Some(relationships) = self.find(RELATIONSHIPS) else {
            let problem = format!("it has no part {RELATIONSHIPS}, as 3MF packages have");
            return Err(Flaw::saying(ARCHIVE, problem));
        };
        let (name, text) = (self.name(relationships), self.text(relationships, read)?);
        for element in elements(name, &text) {
            let element = element?;
            if element.attribute("Type") == Some(MODEL) {
                let target = element.attribute("Target").unwrap_or_default();
                return self.find(target).ok_or_else(|| {
                    let problem =
                        format!("it names the model '{target}', which is no part of the package");
                    Flaw::saying(name, problem).at(&text, element.at)
                });
            }
        }
        Err(Flaw::saying(name, "it names no 3D model"))
    }

    /// The package with other texts for some of its parts; all others are copied as they are.
    pub(super) fn with(&self, changed: &BTreeMap<usize, String>) -> ZipResult<Vec<u8>> {
        let mut archive = ZipArchive::new(Cursor::new(self.bytes.as_slice()))?;
        let mut writer = ZipWriter::new(Cursor::new(Vec::with_capacity(self.bytes.len())));
        for part in 0..archive.len() {
            let Some(text) = changed.get(&part) else {
                writer.raw_copy_file(archive.by_index_raw(part)?)?;
                continue;
            };
            let old = archive.by_index_raw(part)?;
            let mut options = options(text.len());
            if let Some(time) = old.last_modified() {
                options = options.last_modified_time(time);
            }
            let name = old.name()?.into_owned();
            drop(old);
            writer.start_file(name, options)?;
            writer.write_all(text.as_bytes())?;
        }
        Ok(writer.finish()?.into_inner())
    }
}

/// A new package, part by part.
pub(super) struct Fresh(ZipWriter<Cursor<Vec<u8>>>);

impl Fresh {
    pub(super) fn new() -> Self {
        Self(ZipWriter::new(Cursor::new(Vec::new())))
    }

    /// Adds a part with a name, of so many bytes at most, which `fill` writes.
    pub(super) fn part(
        &mut self,
        name: &str,
        length: usize,
        fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
    ) -> ZipResult<()> {
        self.0.start_file(name, options(length))?;
        Ok(fill(&mut self.0)?)
    }

    pub(super) fn finish(self) -> ZipResult<Vec<u8>> {
        Ok(self.0.finish()?.into_inner())
    }
}

/// How hard parts are compressed: of a model the next level takes off a quarter of a per cent, and twice as long.
const LEVEL: i64 = 5;

/// How parts are written; without a time, so that the same input gives the same bytes.
fn options(length: usize) -> SimpleFileOptions {
    SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(LEVEL))
        .last_modified_time(zip::DateTime::default())
        .large_file(length >= u32::MAX as usize)
}

fn open(bytes: &[u8]) -> Result<ZipArchive<Cursor<&[u8]>>> {
    let broken = |why| format!("it cannot be read as a ZIP archive: {why}");
    ZipArchive::new(Cursor::new(bytes)).map_err(|why| Flaw::saying(ARCHIVE, broken(why)))
}
