//! The header of a PLY file: which elements with which properties follow, how many, and in which encoding.

use crate::channels::TEXTURE_LISTS;
use crate::flaw::{Flaw, Place, Result, quoted};
use crate::names;
use crate::reading::check_count;
use crate::scan::integer;
use limitmesh::mesh::Storage;
use std::fmt::Display;

/// The words before the name of a picture in a comment, as MeshLab writes them.
const TEXTURE_FILE: &[u8] = b"TextureFile";

/// Elements of a header, and properties of an element, at most: more than any program writes, few enough to be compared with each other.
const MOST_DECLARED: usize = 1000;

/// How the values after the header are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a binary value.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// How channels of such numbers are stored.
    pub(super) fn storage(self) -> Storage {
        match self {
            Self::F64 => Storage::Double,
            Self::F32 => Storage::Single,
            Self::I8 => Storage::Int8,
            Self::U8 => Storage::Uint8,
            Self::I16 => Storage::Int16,
            Self::U16 => Storage::Uint16,
            Self::I32 => Storage::Int32,
            Self::U32 => Storage::Uint32,
        }
    }
}

/// One value, or a count and that many values.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

impl Kind {
    /// Least bytes that a property of this kind takes.
    fn least_size(self, encoding: Encoding) -> usize {
        match (encoding, self) {
            // A digit and what separates it from the next.
            (Encoding::Ascii, _) => 2,
            (_, Self::Scalar(scalar)) => scalar.size(),
            (_, Self::List { count, .. }) => count.size(),
        }
    }
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// The line that declares it.
    pub(super) line: usize,
}

impl Element {
    /// Least bytes that one such element takes in the file.
    pub(super) fn least_size(&self, encoding: Encoding) -> usize {
        let all = self.properties.iter().map(|p| p.kind.least_size(encoding));
        all.sum()
    }

    /// Whether every such element takes equally many bytes in a binary file.
    pub(super) fn has_fixed_size(&self) -> bool {
        let mut own = self.properties.iter();
        own.all(|p| matches!(p.kind, Kind::Scalar(_)))
    }

    /// The place of the property with one of these names.
    pub(super) fn find(&self, names: &[&str]) -> Option<usize> {
        let mut all = self.properties.iter();
        all.position(|p| names.contains(&p.name.as_str()))
    }

    /// Whether it has all these properties.
    pub(super) fn has_all(&self, names: &[&str]) -> bool {
        names.iter().all(|name| self.find(&[name]).is_some())
    }
}

/// Where a body begins.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Start {
    pub(super) byte: usize,
    /// Counted from 1.
    pub(super) line: usize,
}

/// Numbers of a vertex that say where edges were meant to be sharp.
pub(super) const NORMALS: [&str; 3] = ["nx", "ny", "nz"];

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Pictures named in comments.
    pub(super) texture_files: Vec<String>,
    pub(super) body: Start,
}

impl Header {
    /// Elements and properties that a soup has no place for, in words.
    pub(super) fn left_out(&self) -> Vec<String> {
        let elements = || self.elements.iter().filter(|element| element.count > 0);
        let has_strips = elements().any(|e| e.name == "tristrips");
        let has_normals = elements().any(|e| e.name == "vertex" && e.has_all(&NORMALS));
        let extra = |element: &Element| -> Option<String> {
            let is_normal = |name: &str| NORMALS.contains(&name);
            let is_index = |name: &str| ["vertex_indices", "vertex_index"].contains(&name);
            let is_taken = |property: &Property| {
                let name = property.name.as_str();
                let is_scalar = matches!(property.kind, Kind::Scalar(_));
                match element.name.as_str() {
                    "vertex" if is_normal(name) => has_normals,
                    "vertex" => is_scalar || ["x", "y", "z"].contains(&name),
                    "face" if !has_strips && (is_scalar || name == TEXTURE_LISTS) => true,
                    _ => is_index(name),
                }
            };
            let left = element.properties.iter().filter(|p| !is_taken(p));
            let names: Vec<&str> = left.map(|p| &p.name[..]).collect();
            match element.name.as_str() {
                "vertex" | "face" | "tristrips" if names.is_empty() => None,
                "vertex" | "face" | "tristrips" => {
                    Some(format!("{} properties {}", element.name, names.join(", ")))
                }
                other => Some(format!("element {other}")),
            }
        };
        let normals = has_normals.then(|| "normals".to_owned());
        let all = normals.into_iter().chain(elements().filter_map(extra));
        all.collect()
    }
}

/// Reads the header at the beginning of `bytes`.
pub(super) fn read(bytes: &[u8]) -> Result<Header> {
    let mut lines = Lines::new(bytes);
    let first = lines.next()?;
    if first.trim_ascii() != b"ply" {
        return Err(lines.flaw(quoted(first), "the word ply alone on the first line"));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut texture_files = Vec::new();
    loop {
        let line = lines.next()?;
        let words = line.split(u8::is_ascii_whitespace);
        let words = words.filter(|word| !word.is_empty());
        let words: Vec<&[u8]> = words.collect();
        match *words.as_slice() {
            // Blanks are part of the name.
            [b"comment", b"TextureFile", _, ..] => {
                let at = memchr::memmem::find(line, TEXTURE_FILE);
                let name = at.map(|at| line[at + TEXTURE_FILE.len()..].trim_ascii());
                texture_files.extend(name.map(names::read));
            }
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", name, version] => encoding = Some(read_format(&lines, name, version)?),
            [b"element", name, count] => {
                let element = read_element(&lines, name, count)?;
                if elements.iter().any(|e| e.name == element.name) {
                    let problem = format!("the header has a second element {}", quoted(name));
                    return Err(lines.saying(problem));
                }
                if elements.len() >= MOST_DECLARED {
                    let met = format!("one more element {}", quoted(name));
                    return Err(lines.flaw(met, format!("at most {MOST_DECLARED} of them")));
                }
                elements.push(element);
            }
            [b"property", ref words @ ..] => {
                let property = read_property(&lines, words)?;
                let Some(element) = elements.last_mut() else {
                    return Err(lines.saying("a property stands before the first element"));
                };
                let name = quoted(property.name.as_bytes());
                if element.has_all(&[&property.name]) {
                    return Err(lines.saying(format!("the element has a second property {name}")));
                }
                if element.properties.len() >= MOST_DECLARED {
                    let met = format!("one more property {name}");
                    return Err(lines.flaw(met, format!("at most {MOST_DECLARED} in an element")));
                }
                element.properties.push(property);
            }
            [b"end_header"] => break,
            _ => {
                let expected = "format NAME 1.0, element NAME COUNT, property TYPE NAME, comment or end_header";
                return Err(lines.flaw(quoted(line), expected));
            }
        }
    }
    let none = || lines.saying("the header names no format, such as ascii 1.0");
    let encoding = encoding.ok_or_else(none)?;
    let body = Start {
        byte: lines.at,
        line: lines.line + 1,
    };
    Ok(Header {
        encoding,
        elements,
        texture_files,
        body,
    })
}

fn read_format(lines: &Lines<'_>, name: &[u8], version: &[u8]) -> Result<Encoding> {
    if version != b"1.0" {
        return Err(lines.flaw(quoted(version), "version 1.0"));
    }
    match name {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => {
            let expected = "ascii, binary_little_endian or binary_big_endian";
            Err(lines.flaw(quoted(name), expected))
        }
    }
}

fn read_element(lines: &Lines<'_>, name: &[u8], count: &[u8]) -> Result<Element> {
    let Some(count) = integer(count).and_then(|n| u64::try_from(n).ok()) else {
        return Err(lines.flaw(quoted(count), "the number of elements"));
    };
    let count = check_count(count, &format!("elements {}", quoted(name)), lines.place())?;
    let name = String::from_utf8_lossy(name).into_owned();
    Ok(Element {
        name,
        count,
        properties: Vec::new(),
        line: lines.line,
    })
}

fn read_property(lines: &Lines<'_>, words: &[&[u8]]) -> Result<Property> {
    let scalar = |name: &[u8]| {
        let expected = "a type: char, uchar, short, ushort, int, uint, float or double, or int8 to uint32, float32 or float64";
        Scalar::from_name(name).ok_or_else(|| lines.flaw(quoted(name), expected))
    };
    let (name, kind) = match *words {
        [b"list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if !count.is_integer() {
                let expected = "an integer type for the length of a list";
                return Err(lines.flaw(quoted(words[1]), expected));
            }
            (name, Kind::List { count, item })
        }
        [kind, name] => (name, Kind::Scalar(scalar(kind)?)),
        _ => return Err(lines.saying("a property is written as TYPE NAME or list TYPE TYPE NAME")),
    };
    let name = String::from_utf8_lossy(name).into_owned();
    Ok(Property { name, kind })
}

/// The lines of the header. All end as the first one does, since a binary body may begin with any byte.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    end: &'static [u8],
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let first = memchr::memchr2(b'\n', b'\r', bytes).unwrap_or(bytes.len());
        let end: &[u8] = match bytes[first..] {
            [b'\r', b'\n', ..] => b"\r\n",
            [b'\r', ..] => b"\r",
            _ => b"\n",
        };
        Self {
            bytes,
            at: 0,
            line: 0,
            end,
        }
    }

    fn next(&mut self) -> Result<&'a [u8]> {
        self.line += 1;
        let rest = &self.bytes[self.at..];
        let Some(length) = memchr::memmem::find(rest, self.end) else {
            return Err(self.flaw("the end of the file", "end_header"));
        };
        self.at += length + self.end.len();
        Ok(&rest[..length])
    }

    fn place(&self) -> Place {
        Place::Line(self.line)
    }

    fn flaw(&self, found: impl Display, expected: impl Display) -> Flaw {
        Flaw::new(self.place(), found, expected)
    }

    fn saying(&self, problem: impl Into<String>) -> Flaw {
        Flaw::saying(self.place(), problem)
    }
}
