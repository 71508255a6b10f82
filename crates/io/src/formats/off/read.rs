//! Geomview OFF in text: the keyword, three counts, vertices, faces.
//!
//! The keyword may carry `C`, `N`, `ST` for columns of colours, normals and texture coordinates, may be in small letters, may
//! touch the first count, and may be missing altogether. What vertices have after their positions (`vertex_columns`) and
//! colours of faces (`colours`) become channels; lines after the last face are passed over and reported. Indices count
//! from 0.

use super::colours::Colours;
use super::keyword::{self, Keyword};
use super::vertex_columns::{self, VertexColumns};
use crate::channels::FACE_COLOUR;
use crate::flaw::{Flaw, Result};
use crate::reading::{Kind, LeftOut, check_count, push_face};
use crate::scan::{Scanner, Syntax, integer};
use limitmesh::mesh::{Domain, PolygonFaces, PolygonSoup};

/// Least bytes of a vertex: `0 0 0` and the end of its line.
const LEAST_VERTEX: usize = 6;
/// Least bytes of a face: `0` and the end of its line.
const LEAST_FACE: usize = 2;
/// Least bytes of an index: a digit and what separates it from the next.
const LEAST_INDEX: usize = 2;

fn scanner(bytes: &[u8]) -> Scanner<'_> {
    Scanner::new(
        bytes,
        Syntax {
            comments: true,
            continuations: false,
        },
    )
}

/// Whether the first word is the keyword.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let found = scanner(bytes).first_word().and_then(keyword::keyword);
    found.is_some()
}

/// The header before the vertices.
struct Header<'a> {
    keyword: Keyword<'a>,
    vertices: usize,
    faces: usize,
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup> {
    let mut scanner = scanner(bytes);
    let Header {
        keyword,
        vertices,
        faces,
    } = read_header(&mut scanner)?;
    let mut columns = VertexColumns::new(&keyword);
    let mut of_faces = Colours::default();
    let mut soup = PolygonSoup {
        positions: read_vertices(&mut scanner, vertices, &mut columns)?,
        faces: read_faces(&mut scanner, faces, vertices, &mut of_faces)?,
        ..PolygonSoup::default()
    };
    let mut left_out = LeftOut::default();
    scanner.skip_empty_lines();
    if !scanner.is_at_end() {
        left_out.other("what stands after the last face".to_owned());
    }
    soup.channels = columns.channels(vertices, &mut left_out);
    match of_faces.channel(FACE_COLOUR, Domain::Face, soup.faces.len()) {
        Ok(channel) => soup.channels.extend(channel),
        Err(()) => left_out.note(Kind::FaceColours),
    }
    soup.left_out = left_out.in_words();
    Ok(soup)
}

/// The keyword and the counts, on one line or several.
fn read_header<'a>(scanner: &mut Scanner<'a>) -> Result<Header<'a>> {
    let first = scanner.first_word();
    let (mut vertices, mut keyword) = (first, Keyword::default());
    if let Some(found) = first.and_then(keyword::keyword) {
        if found.has_other_dimension {
            let expected = "three coordinates a vertex (OFF, COFF, NOFF, STOFF)";
            return Err(scanner.unexpected(first, expected));
        }
        let is_glued = !found.glued.is_empty();
        vertices = if is_glued {
            Some(found.glued)
        } else {
            scanner.first_word()
        };
        if vertices == Some(b"BINARY") {
            return Err(Flaw::saying(
                scanner.place(),
                "binary OFF files are not read",
            ));
        }
        keyword = found;
    } else if first.and_then(integer).is_none() {
        return Err(scanner.unexpected(first, "the keyword OFF"));
    }
    let vertices = count(scanner, vertices, "vertices")?;
    let faces = scanner.word();
    let faces = count(scanner, faces, "faces")?;
    // The third count, of edges, is always passed over and sometimes missing.
    scanner.next_line();
    Ok(Header {
        keyword,
        vertices,
        faces,
    })
}

fn count(scanner: &Scanner<'_>, word: Option<&[u8]>, what: &str) -> Result<usize> {
    match word.and_then(integer).and_then(|n| u64::try_from(n).ok()) {
        Some(count) => check_count(count, what, scanner.place()),
        None => Err(scanner.unexpected(word, format!("the number of {what}"))),
    }
}

/// `count`, but no more elements of `least` bytes than the rest of the file can hold: a count at the beginning of
/// a file may be anything, and the end is met in the element that it cuts.
fn room(scanner: &Scanner<'_>, count: usize, least: usize) -> usize {
    // The last line may lack its end.
    count.min(scanner.remaining() / least + 1)
}

/// The positions; what follows them on their lines goes to `columns`.
fn read_vertices<'a>(
    scanner: &mut Scanner<'a>,
    count: usize,
    columns: &mut VertexColumns,
) -> Result<Vec<[f64; 3]>> {
    let mut positions = Vec::with_capacity(room(scanner, count, LEAST_VERTEX));
    let mut words: Vec<&'a [u8]> = Vec::new();
    for index in 0..count {
        scanner.skip_empty_lines();
        let point = scanner.point();
        positions.push(point.map_err(|flaw| flaw.element("vertex", index))?);
        words_of_line(scanner, &mut words);
        columns.read(&words, index);
        scanner.next_line();
    }
    Ok(positions)
}

/// Leaves the other words of the line in `words`, as far as they can mean something.
fn words_of_line<'a>(scanner: &mut Scanner<'a>, words: &mut Vec<&'a [u8]>) {
    words.clear();
    while let Some(word) = scanner.word() {
        if words.len() < vertex_columns::MOST {
            words.push(word);
        }
    }
}

fn read_faces(
    scanner: &mut Scanner<'_>,
    count: usize,
    vertices: usize,
    colours: &mut Colours,
) -> Result<PolygonFaces> {
    let lines = room(scanner, count, LEAST_FACE);
    // Most faces are triangles.
    let mut faces = PolygonFaces::with_capacity(lines, room(scanner, 3 * count, LEAST_INDEX));
    let (mut polygon, mut words) = (Vec::new(), Vec::new());
    for index in 0..count {
        read_face(scanner, vertices, &mut polygon).map_err(|flaw| flaw.element("face", index))?;
        push_face(&mut faces, &polygon, || scanner.place())?;
        words_of_line(scanner, &mut words);
        colours.read(&words, index);
        scanner.next_line();
    }
    Ok(faces)
}

fn read_face(scanner: &mut Scanner<'_>, vertices: usize, polygon: &mut Vec<u32>) -> Result<()> {
    polygon.clear();
    let word = scanner.first_word();
    let Some(corners) = word.and_then(integer).filter(|&n| n >= 0) else {
        return Err(scanner.unexpected(word, "the face's number of corners"));
    };
    for _ in 0..corners {
        let word = scanner.word();
        let index = word.and_then(integer);
        match index.and_then(|i| u32::try_from(i).ok()) {
            Some(index) if (index as usize) < vertices => polygon.push(index),
            _ if index.is_some() => {
                let expected = format!("a vertex index below {vertices} (the number of vertices)");
                return Err(scanner.unexpected(word, expected));
            }
            _ => return Err(scanner.unexpected(word, format!("{corners} vertex indices"))),
        }
    }
    Ok(())
}
