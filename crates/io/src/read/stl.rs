//! STL, ASCII and binary: three vertices a facet, not merged.
//!
//! A file is binary if its length is what the count at byte 80 asks for; otherwise ASCII if it begins with
//! `solid` and goes on with `facet` or `endsolid`; otherwise binary. Names of solids, attributes of facets and bytes after
//! the last binary facet are passed over, which is told; facet normals follow from the corners.

use super::left_out::trailing_bytes;
use super::{check_count, push_face};
use crate::error::{Flaw, Place};
use crate::format::{is_ascii_stl, is_binary_stl, stl_facet_count};
use crate::scan::{Scanner, Syntax};
use limitmesh::mesh::{PolygonFaces, PolygonSoup};

const HEADER: usize = 84;
const FACET: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    if !is_binary_stl(bytes) && is_ascii_stl(bytes) { read_ascii(bytes) } else { read_binary(bytes) }
}

fn read_binary(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let Some(promised) = stl_facet_count(bytes) else {
        let expected = format!("'solid', or the {HEADER} bytes that begin a binary file");
        return Err(Flaw::new(Place::Byte(bytes.len()), "the end of the file", expected));
    };
    let count = promised as usize;
    let facets = &bytes[HEADER..];
    if facets.len() / FACET < count {
        let expected = format!("{promised} facets of {FACET} bytes, as byte 80 promises");
        return Err(Flaw::new(Place::Byte(bytes.len()), "the end of the file", expected)
            .element("facet", facets.len() / FACET));
    }
    if count == 0 && !facets.is_empty() {
        let met = format!("no facet promised, but {} bytes after the count", facets.len());
        return Err(Flaw::new(Place::Byte(80), met, "the number of facets"));
    }
    check_count(3 * u64::from(promised), "vertices", Place::Byte(80))?;
    let mut soup = with_room(count);
    let mut has_attributes = false;
    for (index, facet) in facets.chunks_exact(FACET).take(count).enumerate() {
        let mut corners = [[0.0; 3]; 3];
        // The normal's 12 bytes come first, two attribute bytes last.
        for (i, bytes) in facet[12..48].as_chunks::<4>().0.iter().enumerate() {
            let value = f32::from_le_bytes(*bytes);
            if !value.is_finite() {
                let place = Place::Byte(HEADER + index * FACET + 12 + 4 * i);
                return Err(Flaw::new(place, value.to_string(), "a finite number").element("facet", index));
            }
            corners[i / 3][i % 3] = f64::from(value);
        }
        push_facet(&mut soup, corners, || Place::Byte(HEADER + index * FACET))?;
        has_attributes |= facet[48..] != [0, 0];
    }
    let attributes =
        has_attributes.then(|| "attributes of facets, which some programs use for colours".to_owned());
    let trailing = trailing_bytes(facets.len() - FACET * count, "facet");
    soup.left_out = attributes.into_iter().chain(trailing).collect();
    Ok(soup)
}

fn with_room(facets: usize) -> PolygonSoup {
    PolygonSoup {
        positions: Vec::with_capacity(3 * facets),
        faces: PolygonFaces::with_capacity(facets, 3 * facets),
        ..PolygonSoup::default()
    }
}

fn push_facet(soup: &mut PolygonSoup, corners: [[f64; 3]; 3], place: impl Fn() -> Place) -> Result<(), Flaw> {
    let first = soup.positions.len() as u32;
    soup.positions.extend(corners);
    push_face(&mut soup.faces, &[first, first + 1, first + 2], place)
}

fn read_ascii(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let facets = memchr::memmem::find_iter(bytes, b"outer").count();
    let mut text = Text { scanner: Scanner::new(bytes, Syntax::default()) };
    let mut soup = with_room(facets);
    text.keyword(&["solid"])?;
    let (mut solids, mut has_name) = (1, text.name());
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
                    soup.left_out = left_out(solids, has_name);
                    return Ok(soup);
                }
                solids += 1;
                has_name |= text.name();
            }
        }
    }
}

/// What an ASCII file of so many solids held beside its facets.
fn left_out(solids: usize, has_name: bool) -> Vec<String> {
    let words = match (solids, has_name) {
        (1, false) => return Vec::new(),
        (1, true) => "the solid's name".to_owned(),
        (_, false) => format!("that these are {solids} solids"),
        (_, true) => format!("that these are {solids} solids, and their names"),
    };
    vec![words]
}

struct Text<'a> {
    scanner: Scanner<'a>,
}

impl Text<'_> {
    /// Which of `keywords` the next word is, in capitals or small letters.
    fn keyword(&mut self, keywords: &[&str]) -> Result<usize, Flaw> {
        let word = self.scanner.first_word();
        word.and_then(|w| keywords.iter().position(|k| w.eq_ignore_ascii_case(k.as_bytes())))
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

    /// Steps over the rest of a solid's first line; whether that has a name.
    fn name(&mut self) -> bool {
        let has_name = self.scanner.word().is_some();
        self.scanner.next_line();
        has_name
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
