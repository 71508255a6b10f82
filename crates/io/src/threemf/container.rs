//! The archive: parts are read from it, and all but those that changed are copied as they are, compressed.
//!
//! What the archive says of its own sizes is not believed: a part is given up where it becomes larger than [`MOST_BYTES`], or than text ever does
//! that was compressed to the archive's size ([`MOST_TIMES`]).

use super::flaw::{self, PackageFlaw};
use super::xml::{Element, attribute};
use quick_xml::events::Event;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Bytes of all parts together that are read, at most: as much as some thirty million triangles take.
pub(super) const MOST_BYTES: u64 = 1 << 31;

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
    pub(super) fn parse(bytes: Vec<u8>) -> flaw::Result<Self> {
        let archive = ZipArchive::new(Cursor::new(bytes.as_slice())).map_err(broken)?;
        if archive.len() > MOST_PARTS {
            let problem = format!(
                "it has {} parts; at most {MOST_PARTS} are read",
                archive.len()
            );
            return Err(PackageFlaw::of_archive(problem));
        }
        // A part whose name cannot be read is copied, and never asked for.
        let name = |i| {
            archive
                .name_for_index(i)
                .and_then(Result::ok)
                .map_or_else(String::new, Cow::into_owned)
        };
        let names = (0..archive.len()).map(name).collect();
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
    pub(super) fn text(&self, part: usize, read: &mut u64) -> flaw::Result<String> {
        let name = &self.names[part];
        let mut archive = ZipArchive::new(Cursor::new(self.bytes.as_slice())).map_err(broken)?;
        let flaw = |why: &dyn std::fmt::Display| {
            PackageFlaw::new(name, format!("it cannot be unpacked: {why}"))
        };
        let file = archive.by_index(part).map_err(|why| flaw(&why))?;
        let most = MOST_BYTES.min(ALWAYS.saturating_add(MOST_TIMES * self.bytes.len() as u64));
        let mut bytes = Vec::new();
        file.take(most - *read + 1)
            .read_to_end(&mut bytes)
            .map_err(|why| flaw(&why))?;
        *read += bytes.len() as u64;
        if *read > most {
            let problem = format!(
                "with this part the models have more than {} MiB; they may have 2 GiB, and 32 MiB with {MOST_TIMES} times the \
                 archive's size",
                most >> 20
            );
            return Err(PackageFlaw::new(name, problem));
        }
        // What some programs put before text in UTF-8 stays: it is part of what is edited.
        String::from_utf8(bytes).map_err(|error| {
            let byte = error.utf8_error().valid_up_to();
            PackageFlaw::new(name, format!("byte {byte} is not UTF-8"))
        })
    }

    /// The part that is the model, by the package's relationships.
    pub(super) fn root(&self, read: &mut u64) -> flaw::Result<usize> {
        let Some(relationships) = self.find(RELATIONSHIPS) else {
            return Err(PackageFlaw::of_archive(format!(
                "it has no part {RELATIONSHIPS}, as 3MF packages have"
            )));
        };
        let text = self.text(relationships, read)?;
        let name = self.name(relationships);
        let mut reader = quick_xml::Reader::from_str(&text);
        loop {
            let at = reader.buffer_position() as usize;
            let event = reader
                .read_event()
                .map_err(|why| PackageFlaw::not_xml(name, &why).at(&text, at))?;
            let (Event::Start(tag) | Event::Empty(tag)) = event else {
                if event == Event::Eof {
                    return Err(PackageFlaw::new(name, "it names no 3D model"));
                }
                continue;
            };
            let element = Element::new(&tag, &text);
            if attribute(element.attributes, "Type") != Some(MODEL) {
                continue;
            }
            let target = attribute(element.attributes, "Target").unwrap_or_default();
            return self.find(target).ok_or_else(|| {
                let problem =
                    format!("it names the model '{target}', which is no part of the package");
                PackageFlaw::new(name, problem).at(&text, at)
            });
        }
    }

    /// The package with other texts for some of its parts; all others are copied as they are.
    pub(super) fn with(
        &self,
        changed: &BTreeMap<usize, String>,
    ) -> zip::result::ZipResult<Vec<u8>> {
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
    ) -> zip::result::ZipResult<()> {
        self.0.start_file(name, options(length))?;
        Ok(fill(&mut self.0)?)
    }

    pub(super) fn finish(self) -> zip::result::ZipResult<Vec<u8>> {
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

fn broken(why: zip::result::ZipError) -> PackageFlaw {
    PackageFlaw::of_archive(format!("it cannot be read as a ZIP archive: {why}"))
}
