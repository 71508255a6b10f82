//! STL, ASCII and binary: three vertices a facet, not merged.
//!
//! A file is binary if its length is what the count at byte 80 asks for; otherwise ASCII if it begins with
//! `solid` and goes on with `facet` or `endsolid`; otherwise binary. Names of solids and attributes of facets become channels; bytes
//! after the last binary facet are passed over, which is told; facet normals follow from the corners.

use super::left_out::trailing_bytes;
use super::{check_count, push_face};
use crate::channels;
use crate::error::{Flaw, Place};
use crate::format::{is_ascii_stl, is_binary_stl, stl_facet_count};
use crate::names;
use crate::scan::{Scanner, Syntax};
use limitmesh::mesh::{Channel, Domain, PolygonFaces, PolygonSoup, Semantic, Storage};
use std::collections::HashMap;

const HEADER: usize = 84;
const FACET: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    if !is_binary_stl(bytes) && is_ascii_stl(bytes) {
        read_ascii(bytes)
    } else {
        read_binary(bytes)
    }
}

fn read_binary(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let Some(promised) = stl_facet_count(bytes) else {
        let expected = format!("'solid', or the {HEADER} bytes that begin a binary file");
        return Err(Flaw::new(
            Place::Byte(bytes.len()),
            "the end of the file",
            expected,
        ));
    };
    let count = promised as usize;
    let facets = &bytes[HEADER..];
    if facets.len() / FACET < count {
        let expected = format!("{promised} facets of {FACET} bytes, as byte 80 promises");
        return Err(
            Flaw::new(Place::Byte(bytes.len()), "the end of the file", expected)
                .element("facet", facets.len() / FACET),
        );
    }
    if count == 0 && !facets.is_empty() {
        let problem = format!(
            "the file promises no facet, but {} bytes follow",
            facets.len()
        );
        return Err(Flaw::saying(Place::Byte(80), problem));
    }
    check_count(3 * u64::from(promised), "vertices", Place::Byte(80))?;
    let mut soup = with_room(count);
    let mut attributes: Vec<f64> = Vec::new();
    for (index, facet) in facets.chunks_exact(FACET).take(count).enumerate() {
        let mut corners = [[0.0; 3]; 3];
        // The normal's 12 bytes come first, two attribute bytes last.
        for (i, bytes) in facet[12..48].as_chunks::<4>().0.iter().enumerate() {
            let value = f32::from_le_bytes(*bytes);
            if !value.is_finite() {
                let place = Place::Byte(HEADER + index * FACET + 12 + 4 * i);
                return Err(
                    Flaw::new(place, value.to_string(), "a finite number").element("facet", index)
                );
            }
            corners[i / 3][i % 3] = f64::from(value);
        }
        push_facet(&mut soup, corners, || Place::Byte(HEADER + index * FACET))?;
        // Some programs use them for colours; most write none.
        let attribute = u16::from_le_bytes([facet[48], facet[49]]);
        if attribute != 0 || !attributes.is_empty() {
            attributes.resize(index, 0.0);
            attributes.push(f64::from(attribute));
        }
    }
    if !attributes.is_empty() {
        let channel = Channel::new(channels::ATTRIBUTE, Semantic::Label, Domain::Face, 1);
        let channel = channel.stored(Storage::Uint16);
        soup.channels
            .push(channel.with(attributes, (0..promised).collect()));
    }
    soup.left_out
        .extend(trailing_bytes(facets.len() - FACET * count, "facet"));
    Ok(soup)
}

fn with_room(facets: usize) -> PolygonSoup {
    PolygonSoup {
        positions: Vec::with_capacity(3 * facets),
        faces: PolygonFaces::with_capacity(facets, 3 * facets),
        ..PolygonSoup::default()
    }
}

fn push_facet(
    soup: &mut PolygonSoup,
    corners: [[f64; 3]; 3],
    place: impl Fn() -> Place,
) -> Result<(), Flaw> {
    let first = soup.positions.len() as u32;
    soup.positions.extend(corners);
    push_face(&mut soup.faces, &[first, first + 1, first + 2], place)
}

fn read_ascii(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let facets = memchr::memmem::find_iter(bytes, b"outer").count();
    let mut text = Text {
        scanner: Scanner::new(bytes, Syntax::default()),
    };
    let mut soup = with_room(facets);
    text.keyword(&["solid"])?;
    let mut solids = Solids::default();
    solids.begin(text.name(), 0);
    loop {
        match text.keyword(&["facet", "endsolid"])? {
            0 => {
                let index = soup.positions.len() / 3;
                check_count(3 * (index as u64 + 1), "vertices", text.scanner.place())?;
                let corners = text.facet().map_err(|flaw| flaw.element("facet", index))?;
                push_facet(&mut soup, corners, || text.scanner.place())?;
            }
            _ => {
                text.scanner.next_line();
                if !text.another_solid()? {
                    soup.channels.extend(solids.channel(soup.faces.len()));
                    return Ok(soup);
                }
                solids.begin(text.name(), soup.faces.len());
            }
        }
    }
}

/// The solids of an ASCII file.
#[derive(Default)]
struct Solids {
    names: Vec<String>,
    numbers: HashMap<String, u32>,
    /// From which face on which name holds.
    starts: Vec<(usize, u32)>,
}

impl Solids {
    fn begin(&mut self, name: String, face: usize) {
        let number = *self.numbers.entry(name).or_insert_with_key(|name| {
            self.names.push(name.clone());
            self.names.len() as u32 - 1
        });
        self.starts.push((face, number));
    }

    /// The names of all faces' solids, if any has one.
    fn channel(self, faces: usize) -> Option<Channel> {
        let Self { names, starts, .. } = self;
        if faces == 0
            || names
                .iter()
                .all(|name| name.is_empty() || name == channels::UNNAMED_SOLID)
        {
            return None;
        }
        let mut indices = Vec::with_capacity(faces);
        for (at, &(_, number)) in starts.iter().enumerate() {
            let end = starts.get(at + 1).map_or(faces, |&(face, _)| face);
            indices.resize(end, number);
        }
        let values = (0..names.len()).map(|number| number as f64).collect();
        let mut channel =
            Channel::new(channels::OBJECT, Semantic::Label, Domain::Face, 1).with(values, indices);
        channel.labels = names;
        Some(channel)
    }
}

struct Text<'a> {
    scanner: Scanner<'a>,
}

impl Text<'_> {
    /// Which of `keywords` the next word is, in capitals or small letters.
    fn keyword(&mut self, keywords: &[&str]) -> Result<usize, Flaw> {
        let word = self.scanner.first_word();
        word.and_then(|w| {
            keywords
                .iter()
                .position(|k| w.eq_ignore_ascii_case(k.as_bytes()))
        })
        .ok_or_else(|| self.scanner.unexpected(word, keywords.join(" or ")))
    }

    /// The corners of a facet whose keyword has been read.
    fn facet(&mut self) -> Result<[[f64; 3]; 3], Flaw> {
        // The normal is passed over unread: it follows from the corners, and is often `nan` in files.
        loop {
            let word = self.scanner.first_word();
            match word {
                Some(word) if word.eq_ignore_ascii_case(b"outer") => break,
                Some(word) if !is_facet_keyword(word) => {}
                _ => return Err(self.scanner.unexpected(word, "outer loop")),
            }
        }
        self.keyword(&["loop"])?;
        let mut corners = [[0.0; 3]; 3];
        for corner in &mut corners {
            self.keyword(&["vertex"])?;
            *corner = self.scanner.point()?;
        }
        self.keyword(&["endloop"])?;
        self.keyword(&["endfacet"])?;
        Ok(corners)
    }

    /// The rest of a solid's first line.
    fn name(&mut self) -> String {
        let mut words = Vec::new();
        while let Some(word) = self.scanner.word() {
            words.push(names::read(word));
        }
        self.scanner.next_line();
        words.join(" ")
    }

    /// Whether another solid follows, whose keyword is then stepped over.
    fn another_solid(&mut self) -> Result<bool, Flaw> {
        self.scanner.skip_empty_lines();
        if self.scanner.is_at_end() {
            return Ok(false);
        }
        self.keyword(&["solid"])?;
        Ok(true)
    }
}

fn is_facet_keyword(word: &[u8]) -> bool {
    ["vertex", "endloop", "endfacet", "facet", "endsolid"]
        .iter()
        .any(|k| word.eq_ignore_ascii_case(k.as_bytes()))
}
