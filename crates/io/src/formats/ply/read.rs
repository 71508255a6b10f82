//! Stanford PLY 1.0: ASCII and binary of both byte orders.
//!
//! Takes `x`, `y`, `z` of element `vertex` (any number types), the list `vertex_indices` or `vertex_index` of
//! element `face`, and the same list of element `tristrips`, where -1 ends a strip. Single numbers of vertices and faces, and lists of
//! texture coordinates, become channels (`columns`); all other properties and elements are passed over, and so is what follows the
//! last element, which is reported.

use super::columns::{Columns, CornerTextures};
use super::header::{self, Element, Encoding, Header, Kind, Scalar};
use super::source::{Binary, Source, Text};
use crate::channels::TEXTURE_LISTS;
use crate::flaw::{Flaw, Place, Result};
use crate::reading::{check_count, push_face, trailing_bytes};
use crate::scan::{Scanner, Syntax};
use limitmesh::mesh::{PolygonFaces, PolygonSoup};

/// Whether the first word is that of PLY files.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let syntax = Syntax {
        comments: true,
        continuations: false,
    };
    Scanner::new(bytes, syntax).first_word() == Some(b"ply")
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup> {
    let header = header::read(bytes)?;
    let start = header.body.byte;
    match header.encoding {
        Encoding::Ascii => read_body(&header, Text::new(bytes, header.body)),
        Encoding::LittleEndian => read_body(&header, Binary::<false>::new(bytes, start)),
        Encoding::BigEndian => read_body(&header, Binary::<true>::new(bytes, start)),
    }
}

fn read_body(header: &Header, mut source: impl Source) -> Result<PolygonSoup> {
    let Some(vertices) = header.elements.iter().find(|e| e.name == "vertex") else {
        let end = Place::Line(header.body.line - 1);
        return Err(Flaw::saying(end, "the header has no element vertex"));
    };
    let vertices = vertices.count;
    let mut soup = PolygonSoup {
        left_out: header.left_out(),
        texture_files: header.texture_files.clone(),
        ..PolygonSoup::default()
    };
    for element in &header.elements {
        check_room(header.encoding, element, &source)?;
        match element.name.as_str() {
            "vertex" => read_vertices(header.encoding, element, &mut source, &mut soup)?,
            "face" => read_polygons(element, &mut source, vertices, &mut soup)?,
            "tristrips" => read_strips(element, &mut source, vertices, &mut soup.faces)?,
            _ => skip_element(element, &mut source)?,
        }
    }
    soup.left_out
        .extend(trailing_bytes(source.trailing(), "element"));
    Ok(soup)
}

/// Refuses a count that the rest of a binary file cannot hold. Where elements differ in size, the end of the
/// file is met on the way, in the element that it cuts.
fn check_room(encoding: Encoding, element: &Element, source: &impl Source) -> Result<()> {
    let (size, left) = (element.least_size(encoding), source.remaining());
    if encoding == Encoding::Ascii
        || !element.has_fixed_size()
        || left as u128 >= size as u128 * element.count as u128
    {
        return Ok(());
    }
    let met = format!("{left} bytes up to the end of the file");
    let Element {
        name, count, line, ..
    } = element;
    let expected = format!("{count} elements {name} of {size} bytes each, as line {line} promises");
    Err(Flaw::new(source.place(), met, expected).element(name, left / size))
}

/// Reads all of an element, one after the other; flaws name the one that they are in.
fn each<S: Source>(
    element: &Element,
    source: &mut S,
    mut read: impl FnMut(&mut S) -> Result<()>,
) -> Result<()> {
    for index in 0..element.count {
        let found = read(source).and_then(|()| source.end_element());
        found.map_err(|flaw| flaw.element(&element.name, index))?;
    }
    Ok(())
}

fn read_vertices<S: Source>(
    encoding: Encoding,
    element: &Element,
    source: &mut S,
    soup: &mut PolygonSoup,
) -> Result<()> {
    let mut axes = [0; 3];
    for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
        let is_scalar = |&p: &usize| matches!(element.properties[p].kind, Kind::Scalar(_));
        *axis = element.find(&[name]).filter(is_scalar).ok_or_else(|| {
            let problem = format!("element vertex has no number {name}");
            Flaw::saying(Place::Line(element.line), problem)
        })?;
    }
    // No more than the rest of the file can hold; the last line of a text may lack its end.
    let most = source.remaining() / element.least_size(encoding) + 1;
    soup.positions = Vec::with_capacity(element.count.min(most));
    let mut columns = Columns::of(element);
    each(element, source, |source| {
        let mut point = [0.0; 3];
        for (i, property) in element.properties.iter().enumerate() {
            match (property.kind, axes.iter().position(|&a| a == i)) {
                (Kind::Scalar(scalar), Some(axis)) => {
                    let value = source.number(scalar)?;
                    if !value.is_finite() {
                        let expected = format!("a finite number for {}", property.name);
                        return Err(Flaw::new(source.place(), value, expected));
                    }
                    point[axis] = value;
                }
                (Kind::Scalar(scalar), None) if columns.has(i) => {
                    columns.push(i, source.number(scalar)?);
                }
                (kind, _) => skip_property(kind, source)?,
            }
        }
        soup.positions.push(point);
        Ok(())
    })?;
    columns.add_to(element, soup);
    Ok(())
}

/// The list of vertex indices among the properties.
struct IndexList {
    property: usize,
    count: Scalar,
    item: Scalar,
}

impl IndexList {
    fn find(element: &Element) -> Result<Self> {
        let (name, place) = (&element.name, Place::Line(element.line));
        let Some(property) = element.find(&["vertex_indices", "vertex_index"]) else {
            return Err(Flaw::saying(
                place,
                format!("element {name} has no list vertex_indices"),
            ));
        };
        match element.properties[property].kind {
            Kind::List { count, item } if item.is_integer() => Ok(Self {
                property,
                count,
                item,
            }),
            _ => {
                let own = &element.properties[property].name;
                let problem = format!("property {own} of element {name} is no list of integers");
                Err(Flaw::saying(place, problem))
            }
        }
    }

    /// Hands the indices of each element to `take`, and its other properties to `more`.
    fn read<S: Source>(
        &self,
        element: &Element,
        source: &mut S,
        mut more: impl FnMut(usize, Kind, &mut S) -> Result<()>,
        mut take: impl FnMut(&[i64], &S) -> Result<()>,
    ) -> Result<()> {
        let mut indices = Vec::new();
        each(element, source, |source| {
            for (i, property) in element.properties.iter().enumerate() {
                if i == self.property {
                    let count = list_length(self.count, source)?;
                    indices.clear();
                    source.integers(self.item, count, &mut indices)?;
                } else {
                    more(i, property.kind, source)?;
                }
            }
            take(&indices, source)
        })
    }
}

/// Number of corners of all faces together: what to make room for, and what the file really holds.
fn count_corners<S: Source>(element: &Element, list: &IndexList, mut source: S) -> Result<usize> {
    let mut corners = 0u64;
    each(element, &mut source, |source| {
        for (i, property) in element.properties.iter().enumerate() {
            if i == list.property {
                let count = list_length(list.count, source)?;
                source.skip(list.item, count)?;
                corners += count as u64;
            } else {
                skip_property(property.kind, source)?;
            }
        }
        Ok(())
    })?;
    check_count(corners, "face corners", source.place())
}

fn read_polygons<S: Source>(
    element: &Element,
    source: &mut S,
    vertices: usize,
    soup: &mut PolygonSoup,
) -> Result<()> {
    let list = IndexList::find(element)?;
    let corners = count_corners(element, &list, source.fork())?;
    let faces = &mut soup.faces;
    let strips = std::mem::replace(faces, PolygonFaces::with_capacity(element.count, corners));
    for triangle in strips.iter() {
        push_face(faces, triangle, || source.place())?;
    }
    let is_list = |&at: &usize| matches!(element.properties[at].kind, Kind::List { .. });
    let texture_list = element.find(&[TEXTURE_LISTS]).filter(is_list);
    let (mut columns, mut textures) = (Columns::of(element), CornerTextures::default());
    let more = |property: usize, kind: Kind, source: &mut S| match kind {
        Kind::Scalar(scalar) if columns.has(property) => {
            columns.push(property, source.number(scalar)?);
            Ok(())
        }
        Kind::List { count, item } if texture_list == Some(property) => {
            for _ in 0..list_length(count, source)? {
                textures.values.push(source.number(item)?);
            }
            textures.ends.push(textures.values.len());
            Ok(())
        }
        kind => skip_property(kind, source),
    };
    let mut polygon = Vec::new();
    list.read(element, source, more, |indices, source| {
        polygon.clear();
        for &index in indices {
            polygon.push(vertex_index(index, vertices, source)?);
        }
        push_face(faces, &polygon, || source.place())
    })?;
    if !strips.is_empty() {
        // The attributes of strips are not known.
        return Ok(());
    }
    columns.add_to(element, soup);
    if texture_list.is_some() {
        match textures.channel(&soup.faces) {
            Some(channel) => soup.channels.push(channel),
            None => soup.left_out.push(format!(
                "face properties {TEXTURE_LISTS} (not two numbers for each corner)"
            )),
        }
    }
    Ok(())
}

/// Strips of triangles: each vertex after the second makes one with the two before it, turned every other time.
fn read_strips<S: Source>(
    element: &Element,
    source: &mut S,
    vertices: usize,
    faces: &mut PolygonFaces,
) -> Result<()> {
    let skip = |_, kind: Kind, source: &mut S| skip_property(kind, source);
    IndexList::find(element)?.read(element, source, skip, |indices, source| {
        for strip in indices.split(|&i| i == -1) {
            for (i, corners) in strip.windows(3).enumerate() {
                let mut triangle = [0; 3];
                for (corner, &index) in triangle.iter_mut().zip(corners) {
                    *corner = vertex_index(index, vertices, source)?;
                }
                if i % 2 == 1 {
                    triangle.swap(0, 1);
                }
                push_face(faces, &triangle, || source.place())?;
            }
        }
        Ok(())
    })
}

#[inline]
fn vertex_index(index: i64, vertices: usize, source: &impl Source) -> Result<u32> {
    let found = u32::try_from(index).ok();
    let found = found.filter(|&index| (index as usize) < vertices);
    found.ok_or_else(|| {
        let expected = format!("a vertex index below {vertices} (the number of vertices)");
        Flaw::new(source.place(), index, expected)
    })
}

fn list_length(count: Scalar, source: &mut impl Source) -> Result<usize> {
    let length = source.integer(count)?;
    usize::try_from(length).map_err(|_| Flaw::new(source.place(), length, "the length of a list"))
}

fn skip_element<S: Source>(element: &Element, source: &mut S) -> Result<()> {
    if source.skip_all(element) {
        return Ok(());
    }
    each(element, source, |source| {
        let mut all = element.properties.iter();
        all.try_for_each(|own| skip_property(own.kind, source))
    })
}

#[inline]
fn skip_property(kind: Kind, source: &mut impl Source) -> Result<()> {
    match kind {
        Kind::Scalar(scalar) => source.skip(scalar, 1),
        Kind::List { count, item } => {
            let count = list_length(count, source)?;
            source.skip(item, count)
        }
    }
}
