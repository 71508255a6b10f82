//! Geomview OFF in text: the keyword, three counts, vertices, faces.
//!
//! The keyword may carry `C`, `N`, `ST` for columns of colours, normals and texture coordinates, and may be
//! missing altogether. What follows the coordinates or the indices on a line is passed over. Indices count
//! from 0.

use super::{check_count, push_face};
use crate::error::Flaw;
use crate::format::off_prefix;
use crate::scan::{Scanner, Syntax, integer, quoted};
use limitmesh::mesh::{PolygonFaces, PolygonSoup};

/// Least bytes of a vertex: `0 0 0` and the end of its line.
const LEAST_VERTEX: usize = 6;
/// Least bytes of a face: `0` and the end of its line.
const LEAST_FACE: usize = 2;
/// Least bytes of an index: a digit and what separates it from the next.
const LEAST_INDEX: usize = 2;

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let mut scanner = Scanner::new(bytes, Syntax { comments: true, continuations: false });
    let (vertices, faces) = read_header(&mut scanner)?;
    let positions = read_vertices(&mut scanner, vertices)?;
    let faces = read_faces(&mut scanner, faces, vertices)?;
    Ok(PolygonSoup { positions, faces, ..PolygonSoup::default() })
}

/// The keyword and the counts, on one line or several; gives the numbers of vertices and faces.
fn read_header(scanner: &mut Scanner<'_>) -> Result<(usize, usize), Flaw> {
    let first = scanner.first_word();
    let mut vertices = first;
    if let Some(prefix) = first.and_then(off_prefix) {
        if prefix.ends_with(b"n") || prefix.ends_with(b"4") {
            return Err(scanner.unexpected(first, "three coordinates a vertex (OFF, COFF, NOFF, STOFF)"));
        }
        vertices = scanner.first_word();
        if vertices == Some(b"BINARY") {
            return Err(scanner.unexpected(vertices, "an OFF file in text; binary ones are not read"));
        }
    } else if first.and_then(integer).is_none() {
        return Err(scanner.unexpected(first, "the keyword OFF"));
    }
    let vertices = count(scanner, vertices, "vertices")?;
    let faces = scanner.word();
    let faces = count(scanner, faces, "faces")?;
    // The third count, of edges, is always passed over and sometimes missing.
    scanner.next_line();
    Ok((vertices, faces))
}

fn count(scanner: &Scanner<'_>, word: Option<&[u8]>, what: &str) -> Result<usize, Flaw> {
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

fn read_vertices(scanner: &mut Scanner<'_>, count: usize) -> Result<Vec<[f64; 3]>, Flaw> {
    let mut positions = Vec::with_capacity(room(scanner, count, LEAST_VERTEX));
    for index in 0..count {
        scanner.skip_empty_lines();
        let point = scanner.point().map_err(|flaw| flaw.element("vertex", index))?;
        positions.push(point);
        scanner.next_line();
    }
    Ok(positions)
}

fn read_faces(scanner: &mut Scanner<'_>, count: usize, vertices: usize) -> Result<PolygonFaces, Flaw> {
    let lines = room(scanner, count, LEAST_FACE);
    // Most faces are triangles.
    let mut faces = PolygonFaces::with_capacity(lines, room(scanner, 3 * count, LEAST_INDEX));
    let mut polygon = Vec::new();
    for index in 0..count {
        read_face(scanner, vertices, &mut polygon).map_err(|flaw| flaw.element("face", index))?;
        push_face(&mut faces, &polygon, || scanner.place())?;
        scanner.next_line();
    }
    Ok(faces)
}

fn read_face(scanner: &mut Scanner<'_>, vertices: usize, polygon: &mut Vec<u32>) -> Result<(), Flaw> {
    polygon.clear();
    let word = scanner.first_word();
    let Some(corners) = word.and_then(integer).filter(|&n| n >= 0) else {
        return Err(scanner.unexpected(word, "the face's number of corners"));
    };
    for _ in 0..corners {
        let word = scanner.word();
        let index = word.and_then(integer).filter(|&i| 0 <= i && i < vertices as i64);
        match (word, index.and_then(|i| u32::try_from(i).ok())) {
            (_, Some(index)) => polygon.push(index),
            (Some(word), None) if integer(word).is_some() => {
                let expected = format!("a vertex index below {vertices}, the number of vertices");
                return Err(Flaw::new(scanner.place(), quoted(word), expected));
            }
            (word, None) => {
                return Err(scanner.unexpected(word, format!("{corners} vertex indices")));
            }
        }
    }
    Ok(())
}
