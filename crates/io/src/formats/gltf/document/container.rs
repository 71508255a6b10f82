//! The two forms of a glTF file: JSON text alone, or a GLB with the text and one buffer in chunks.
//!
//! A GLB is `glTF`, its version (2) and length, then chunks: length, kind, bytes, each padded to four bytes. Chunks of
//! other kinds are carried along.

use crate::flaw::{Flaw, Result};
use crate::scan::BYTE_ORDER_MARK;

const MAGIC: &[u8; 4] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// The parts of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Container {
    /// The JSON text.
    pub(crate) text: String,
    /// The chunk with the first buffer, if the file is a GLB that has one.
    pub(crate) bin: Option<Vec<u8>>,
    /// Chunks of other kinds.
    pub(crate) others: Vec<(u32, Vec<u8>)>,
    /// Whether the file was a GLB.
    pub(crate) is_glb: bool,
}

impl Container {
    /// Takes a file apart.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self> {
        if !bytes.starts_with(MAGIC) {
            let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
            return Ok(Self {
                text: text_of(bytes)?,
                ..Self::default()
            });
        }
        let version = word(bytes, 4)?;
        if version != 2 {
            return Err(Flaw::new("the GLB header", version, "version 2"));
        }
        let length = word(bytes, 8)? as usize;
        if length > bytes.len() || length < 12 {
            let there = bytes.len();
            let problem = format!("it names a length of {length} bytes, but the file has {there}");
            return Err(Flaw::saying("the GLB header", problem));
        }
        let mut found = Self {
            is_glb: true,
            ..Self::default()
        };
        let (mut rest, mut number) = (&bytes[12..length], 0);
        while !rest.is_empty() {
            let name = format!("chunk {number} of the GLB, at byte {}", length - rest.len());
            let (Ok(size), Ok(kind)) = (word(rest, 0), word(rest, 4)) else {
                return Err(Flaw::new(name, rest.len(), "a header of 8 bytes"));
            };
            let size = size as usize;
            let Some(content) = rest[8..].get(..size) else {
                let left = rest.len() - 8;
                let problem = format!("it names a length of {size} bytes, but {left} are left");
                return Err(Flaw::saying(name, problem));
            };
            match kind {
                JSON if number == 0 => found.text = text_of(content)?,
                _ if number == 0 => {
                    let found = format!("the kind {kind:#010x}");
                    return Err(Flaw::new(name, found, "JSON in the first chunk"));
                }
                BIN if found.bin.is_none() => found.bin = Some(content.to_vec()),
                _ => found.others.push((kind, content.to_vec())),
            }
            // The last chunk may lack its padding.
            rest = &rest[(8 + size).next_multiple_of(4).min(rest.len())..];
            number += 1;
        }
        if found.text.is_empty() {
            return Err(Flaw::saying("the GLB", "it has no chunk of JSON"));
        }
        Ok(found)
    }

    /// The bytes of a GLB; `None` if they are more than its 32-bit length can count.
    pub(crate) fn to_glb(&self) -> Option<Vec<u8>> {
        let padded = |content: &[u8]| content.len().next_multiple_of(4);
        let mut chunks = vec![(JSON, self.text.as_bytes())];
        chunks.extend(self.bin.iter().map(|bytes| (BIN, &bytes[..])));
        chunks.extend(self.others.iter().map(|(kind, bytes)| (*kind, &bytes[..])));
        let length = 12
            + chunks
                .iter()
                .map(|(_, content)| 8 + padded(content))
                .sum::<usize>();
        let mut out = Vec::with_capacity(length);
        out.extend(MAGIC);
        out.extend(2u32.to_le_bytes());
        out.extend(u32::try_from(length).ok()?.to_le_bytes());
        for (kind, content) in chunks {
            out.extend((padded(content) as u32).to_le_bytes());
            out.extend(kind.to_le_bytes());
            out.extend(content);
            let pad = if kind == JSON { b' ' } else { 0 };
            out.resize(out.len() + padded(content) - content.len(), pad);
        }
        Some(out)
    }
}

fn text_of(bytes: &[u8]) -> Result<String> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let problem = format!("byte {} is not UTF-8", error.valid_up_to());
        Flaw::saying("the JSON text", problem)
    })?;
    Ok(text.to_owned())
}

fn word(bytes: &[u8], at: usize) -> Result<u32> {
    let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
    let short = || Flaw::new("the GLB", bytes.len(), "at least 12 bytes");
    four.map(u32::from_le_bytes).ok_or_else(short)
}
