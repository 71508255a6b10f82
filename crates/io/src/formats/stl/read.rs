//! STL, ASCII and binary: three vertices a facet, not merged.
//!
//! A file is binary if its length is what the count at byte 80 asks for; otherwise ASCII if it begins with
//! `solid` and goes on with `facet` or `endsolid`; otherwise binary. Names of solids and attributes of facets become channels; bytes
//! after the last binary facet are passed over, which is reported; facet normals follow from the corners.

use crate::channels::{ATTRIBUTE, OBJECT, UNNAMED_SOLID};
use crate::flaw::{Flaw, Place, Result};
use crate::reading::{Labels, by_element, check_count, push_face, trailing_bytes};
use crate::scan::{BYTE_ORDER_MARK, Scanner, Syntax};
use limitmesh::mesh::{Domain, PolygonFaces, PolygonSoup, Semantic, Storage};

const HEADER: usize = 84;
const FACET: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup> {
    if !is_binary(bytes) && begins(bytes) {
        read_ascii(bytes)
    } else {
        read_binary(bytes)
    }
}

/// Whether `bytes` have exactly the length that the facet count of a binary file at byte 80 asks for.
pub(crate) fn is_binary(bytes: &[u8]) -> bool {
    let length = |facets| HEADER as u64 + FACET as u64 * u64::from(facets);
    facet_count(bytes).is_some_and(|facets| bytes.len() as u64 == length(facets))
}

/// The facet count of a binary file; `None` if the bytes end before it.
fn facet_count(bytes: &[u8]) -> Option<u32> {
    let found = bytes.get(80..HEADER)?.try_into().ok();
    found.map(u32::from_le_bytes)
}

/// Whether a text begins as an ASCII file does: `solid` and, after its line, `facet` or `endsolid`.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    let text = text.trim_ascii_start();
    let begins = |text: &[u8], word: &[u8]| {
        text.get(..word.len())
            .is_some_and(|own| own.eq_ignore_ascii_case(word))
    };
    let Some(line_end) = memchr::memchr2(b'\n', b'\r', text).filter(|_| begins(text, b"solid"))
    else {
        return false;
    };
    let body = text[line_end..].trim_ascii_start();
    // A file cut right after its first line is an ASCII file still.
    let words: [&[u8]; 3] = [b"facet", b"endsolid", b"solid"];
    body.is_empty() || words.iter().any(|word| begins(body, word))
}

fn read_binary(bytes: &[u8]) -> Result<PolygonSoup> {
    let end = || Place::Byte(bytes.len());
    let Some(promised) = facet_count(bytes) else {
        let expected = format!("'solid', or the {HEADER} bytes that begin a binary file");
        return Err(Flaw::new(end(), "the end of the file", expected));
    };
    let count = promised as usize;
    let facets = &bytes[HEADER..];
    let there = facets.len() / FACET;
    if there < count {
        let expected = format!("{promised} facets of {FACET} bytes, as byte 80 promises");
        let flaw = Flaw::new(end(), "the end of the file", expected);
        return Err(flaw.element("facet", there));
    }
    if count == 0 && !facets.is_empty() {
        let follow = facets.len();
        let problem = format!("the file promises no facet, but {follow} bytes follow");
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
                let flaw = Flaw::new(place, value, "a finite number");
                return Err(flaw.element("facet", index));
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
        let channel = by_element(ATTRIBUTE, Semantic::Label, Domain::Face, 1, attributes);
        soup.channels.push(channel.stored(Storage::Uint16));
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
) -> Result<()> {
    let first = soup.positions.len() as u32;
    soup.positions.extend(corners);
    push_face(&mut soup.faces, &[first, first + 1, first + 2], place)
}

fn read_ascii(bytes: &[u8]) -> Result<PolygonSoup> {
    let mut text = Text {
        scanner: Scanner::new(bytes, Syntax::default()),
    };
    let mut soup = with_room(memchr::memmem::find_iter(bytes, b"outer").count());
    let mut solids = Labels::default();
    text.keyword(&["solid"])?;
    loop {
        solids.begin(text.scanner.rest_of_line(), soup.faces.len());
        while text.keyword(&["facet", "endsolid"])? == 0 {
            let index = soup.positions.len() / 3;
            check_count(3 * (index as u64 + 1), "vertices", text.scanner.place())?;
            let corners = text.facet().map_err(|flaw| flaw.element("facet", index))?;
            push_facet(&mut soup, corners, || text.scanner.place())?;
        }
        text.scanner.next_line();
        text.scanner.skip_empty_lines();
        if text.scanner.is_at_end() {
            break;
        }
        text.keyword(&["solid"])?;
    }
    if !solids
        .names
        .iter()
        .all(|name| name.is_empty() || name == UNNAMED_SOLID)
    {
        soup.channels
            .extend(solids.channel(OBJECT, soup.faces.len()));
    }
    Ok(soup)
}

struct Text<'a> {
    scanner: Scanner<'a>,
}

impl Text<'_> {
    /// Which of `keywords` the next word is, in capitals or small letters.
    fn keyword(&mut self, keywords: &[&str]) -> Result<usize> {
        let word = self.scanner.first_word();
        let is_word = |own: &&str| word.is_some_and(|w| w.eq_ignore_ascii_case(own.as_bytes()));
        let found = keywords.iter().position(is_word);
        found.ok_or_else(|| self.scanner.unexpected(word, keywords.join(" or ")))
    }

    /// The corners of a facet whose keyword has been read.
    fn facet(&mut self) -> Result<[[f64; 3]; 3]> {
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
}

fn is_facet_keyword(word: &[u8]) -> bool {
    let keywords = ["vertex", "endloop", "endfacet", "facet", "endsolid"];
    let mut all = keywords.iter();
    all.any(|own| word.eq_ignore_ascii_case(own.as_bytes()))
}
