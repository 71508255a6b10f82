//! The two forms of a glTF file: JSON text alone, or a GLB with the text and one buffer in chunks.
//!
//! A GLB is `glTF`, its version (2) and length, then chunks: length, kind, bytes, each padded to four bytes. Chunks of
//! other kinds are carried along.

use super::flaw::{GltfFlaw, Result};
use crate::format::BYTE_ORDER_MARK;

const MAGIC: &[u8; 4] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// The parts of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Container {
    /// The JSON text.
    pub(super) text: String,
    /// The chunk with the first buffer, if the file is a GLB that has one.
    pub(super) bin: Option<Vec<u8>>,
    /// Chunks of other kinds.
    pub(super) others: Vec<(u32, Vec<u8>)>,
    /// Whether the file was a GLB.
    pub(super) is_glb: bool,
}

impl Container {
    /// Takes a file apart.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self> {
        if !bytes.starts_with(MAGIC) {
            let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
            return Ok(Self {
                text: text_of(bytes)?,
                ..Self::default()
            });
        }
        let version = word(bytes, 4)?;
        if version != 2 {
            return Err(GltfFlaw::new(
                "the GLB header",
                version.to_string(),
                "version 2",
            ));
        }
        let length = word(bytes, 8)? as usize;
        if length > bytes.len() || length < 12 {
            let problem = format!(
                "it names a length of {length} bytes, but the file has {}",
                bytes.len()
            );
            return Err(GltfFlaw::saying("the GLB header", problem));
        }
        let mut found = Self {
            is_glb: true,
            ..Self::default()
        };
        let mut rest = &bytes[12..length];
        let mut place = 12;
        for number in 0.. {
            if rest.is_empty() {
                break;
            }
            let name = format!("chunk {number} of the GLB, at byte {place}");
            let (size, kind) = match (word(rest, 0), word(rest, 4)) {
                (Ok(size), Ok(kind)) => (size as usize, kind),
                _ => {
                    return Err(GltfFlaw::new(
                        name,
                        rest.len().to_string(),
                        "a header of 8 bytes",
                    ));
                }
            };
            let Some(content) = rest[8..].get(..size) else {
                let problem = format!(
                    "it names a length of {size} bytes, but {} are left",
                    rest.len() - 8
                );
                return Err(GltfFlaw::saying(name, problem));
            };
            match kind {
                JSON if number == 0 => found.text = text_of(content)?,
                _ if number == 0 => {
                    return Err(GltfFlaw::new(
                        name,
                        format!("the kind {kind:#010x}"),
                        "JSON in the first chunk",
                    ));
                }
                BIN if found.bin.is_none() => found.bin = Some(content.to_vec()),
                _ => found.others.push((kind, content.to_vec())),
            }
            // The last chunk may lack its padding.
            let step = (8 + size).next_multiple_of(4).min(rest.len());
            rest = &rest[step..];
            place += step;
        }
        if found.text.is_empty() {
            return Err(GltfFlaw::saying("the GLB", "it has no chunk of JSON"));
        }
        Ok(found)
    }

    /// The bytes of a GLB; `None` if they are more than its 32-bit length can tell.
    pub(super) fn to_glb(&self) -> Option<Vec<u8>> {
        let bin = self.bin.iter().map(|bytes| (BIN, bytes, 0));
        let others = self.others.iter().map(|(kind, bytes)| (*kind, bytes, 0));
        let text = self.text.as_bytes();
        let padded = |length: usize| 8 + length.next_multiple_of(4);
        let length = 12
            + padded(text.len())
            + bin
                .clone()
                .chain(others.clone())
                .map(|c| padded(c.1.len()))
                .sum::<usize>();
        let mut out = Vec::with_capacity(length);
        out.extend(MAGIC);
        out.extend(2u32.to_le_bytes());
        out.extend(u32::try_from(length).ok()?.to_le_bytes());
        let mut push = |kind: u32, content: &[u8], pad: u8| {
            let padded = content.len().next_multiple_of(4);
            out.extend((padded as u32).to_le_bytes());
            out.extend(kind.to_le_bytes());
            out.extend(content);
            out.resize(out.len() + padded - content.len(), pad);
        };
        push(JSON, text, b' ');
        bin.chain(others)
            .for_each(|(kind, bytes, pad)| push(kind, bytes, pad));
        Some(out)
    }
}

fn text_of(bytes: &[u8]) -> Result<String> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text.to_owned()),
        Err(error) => {
            let problem = format!("byte {} is not UTF-8", error.valid_up_to());
            Err(GltfFlaw::saying("the JSON text", problem))
        }
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32> {
    let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
    four.map(u32::from_le_bytes)
        .ok_or_else(|| GltfFlaw::new("the GLB", bytes.len().to_string(), "at least 12 bytes"))
}
