//! Stanford PLY 1.0: ASCII and binary of both byte orders.
//!
//! Takes `x`, `y`, `z` of element `vertex` (any number types), the list `vertex_indices` or `vertex_index` of
//! element `face`, and the same list of element `tristrips`, where -1 ends a strip. Single numbers of vertices and faces, and lists of
//! texture coordinates, become channels (`columns`); all other properties and elements are passed over, and so is what follows the
//! last element, which is told.

mod columns;
mod header;
mod source;

use super::left_out::trailing_bytes;
use super::{check_count, push_face};
use crate::channels::TEXTURE_LISTS;
use crate::error::{Flaw, Place};
use columns::{Columns, CornerTextures};
use header::{Element, Encoding, Header, Kind, Scalar};
use limitmesh::mesh::{Domain, PolygonFaces, PolygonSoup};
use source::{Binary, Source, Text};

const INDEX_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let header = header::read(bytes)?;
    match header.encoding {
        Encoding::Ascii => read_body(&header, Text::new(bytes, header.body)),
        Encoding::LittleEndian => read_body(&header, Binary::<false>::new(bytes, header.body.0)),
        Encoding::BigEndian => read_body(&header, Binary::<true>::new(bytes, header.body.0)),
    }
}

fn read_body(header: &Header, mut source: impl Source) -> Result<PolygonSoup, Flaw> {
    let Some(vertices) = header.elements.iter().find(|e| e.name == "vertex") else {
        return Err(Flaw::saying(
            Place::Line(header.body.1 - 1),
            "the header has no element vertex",
        ));
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
fn check_room(encoding: Encoding, element: &Element, source: &impl Source) -> Result<(), Flaw> {
    let size = element.least_size(encoding);
    let left = source.remaining();
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

fn read_vertices(
    encoding: Encoding,
    element: &Element,
    source: &mut impl Source,
    soup: &mut PolygonSoup,
) -> Result<(), Flaw> {
    let mut axes = [0; 3];
    for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
        let found = element
            .find(&[name])
            .filter(|&p| matches!(element.properties[p].kind, Kind::Scalar(_)));
        *axis = found.ok_or_else(|| {
            Flaw::saying(
                Place::Line(element.line),
                format!("element vertex has no number {name}"),
            )
        })?;
    }
    // No more than the rest of the file can hold; the last line of a text may lack its end.
    let most = source.remaining() / element.least_size(encoding) + 1;
    let mut positions = Vec::with_capacity(element.count.min(most));
    let mut columns = Columns::of(element);
    for index in 0..element.count {
        let point = read_vertex(element, source, axes, &mut columns)
            .map_err(|flaw| flaw.element("vertex", index))?;
        positions.push(point);
    }
    soup.positions = positions;
    let (channels, lost) = columns.channels(Domain::Vertex, element.count);
    soup.channels.extend(channels);
    soup.left_out.extend(not_finite("vertex", &lost));
    Ok(())
}

/// Tells about properties some of whose numbers are none.
fn not_finite(element: &str, names: &[String]) -> Option<String> {
    (!names.is_empty())
        .then(|| format!("{element} properties {} (not all finite)", names.join(", ")))
}

#[inline]
fn read_vertex(
    element: &Element,
    source: &mut impl Source,
    axes: [usize; 3],
    columns: &mut Columns,
) -> Result<[f64; 3], Flaw> {
    let mut point = [0.0; 3];
    for (i, property) in element.properties.iter().enumerate() {
        match (property.kind, axes.iter().position(|&a| a == i)) {
            (Kind::Scalar(scalar), Some(axis)) => {
                let value = source.number(scalar)?;
                if !value.is_finite() {
                    let expected = format!("a finite number for {}", property.name);
                    return Err(Flaw::new(source.place(), value.to_string(), expected));
                }
                point[axis] = value;
            }
            (Kind::Scalar(scalar), None) if columns.has(i) => {
                columns.push(i, source.number(scalar)?)
            }
            (kind, _) => skip_property(kind, source)?,
        }
    }
    source.end_element()?;
    Ok(point)
}

/// The place of the list of vertex indices among the properties, and its types.
fn find_index_list(element: &Element) -> Result<(usize, Scalar, Scalar), Flaw> {
    let Some(list) = element.find(&INDEX_NAMES) else {
        let problem = format!("element {} has no list vertex_indices", element.name);
        return Err(Flaw::saying(Place::Line(element.line), problem));
    };
    match element.properties[list].kind {
        Kind::List { count, item } if item.is_integer() => Ok((list, count, item)),
        _ => {
            let (property, element_name) = (&element.properties[list].name, &element.name);
            let problem =
                format!("property {property} of element {element_name} is no list of integers");
            Err(Flaw::saying(Place::Line(element.line), problem))
        }
    }
}

/// Number of corners of all faces together: what to make room for, and what the file really holds.
fn count_corners(element: &Element, mut source: impl Source) -> Result<usize, Flaw> {
    let (list, count_type, item) = find_index_list(element)?;
    let mut corners = 0u64;
    for index in 0..element.count {
        let mut read = || {
            for (i, property) in element.properties.iter().enumerate() {
                if i == list {
                    let count = list_length(source.integer(count_type)?, &source)?;
                    source.skip(item, count)?;
                    corners += count as u64;
                } else {
                    skip_property(property.kind, &mut source)?;
                }
            }
            source.end_element()
        };
        read().map_err(|flaw| flaw.element(&element.name, index))?;
    }
    check_count(corners, "face corners", source.place())
}

/// Hands the indices of each element's list to `take`, with the source to name places by.
fn read_lists<S: Source>(
    element: &Element,
    source: &mut S,
    more: &mut impl FnMut(usize, Kind, &mut S) -> Result<(), Flaw>,
    mut take: impl FnMut(&[i64], &S) -> Result<(), Flaw>,
) -> Result<(), Flaw> {
    let (list, count_type, item) = find_index_list(element)?;
    let mut indices = Vec::new();
    for index in 0..element.count {
        let mut read = || {
            for (i, property) in element.properties.iter().enumerate() {
                if i == list {
                    let count = list_length(source.integer(count_type)?, source)?;
                    indices.clear();
                    source.integers(item, count, &mut indices)?;
                } else {
                    more(i, property.kind, source)?;
                }
            }
            take(&indices, source)?;
            source.end_element()
        };
        read().map_err(|flaw| flaw.element(&element.name, index))?;
    }
    Ok(())
}

fn read_polygons<S: Source>(
    element: &Element,
    source: &mut S,
    vertices: usize,
    soup: &mut PolygonSoup,
) -> Result<(), Flaw> {
    let corners = count_corners(element, source.fork())?;
    let faces = &mut soup.faces;
    let strips = std::mem::replace(faces, PolygonFaces::with_capacity(element.count, corners));
    for triangle in strips.iter() {
        push_face(faces, triangle, || source.place())?;
    }
    let textures = element
        .find(&[TEXTURE_LISTS])
        .filter(|&at| matches!(element.properties[at].kind, Kind::List { .. }));
    let (mut columns, mut places) = (Columns::of(element), (Vec::new(), Vec::new()));
    let mut more = |property: usize, kind: Kind, source: &mut S| match kind {
        Kind::Scalar(scalar) if columns.has(property) => {
            columns.push(property, source.number(scalar)?);
            Ok(())
        }
        Kind::List { count, item } if textures == Some(property) => {
            let count = list_length(source.integer(count)?, source)?;
            for _ in 0..count {
                places.0.push(source.number(item)?);
            }
            places.1.push(places.0.len());
            Ok(())
        }
        kind => skip_property(kind, source),
    };
    let mut polygon = Vec::new();
    read_lists(element, source, &mut more, |indices, source| {
        polygon.clear();
        for &index in indices {
            polygon.push(vertex_index(index, vertices, source)?);
        }
        push_face(faces, &polygon, || source.place())
    })?;
    if !strips.is_empty() {
        // What strips have beside is not known.
        return Ok(());
    }
    let (channels, lost) = columns.channels(Domain::Face, element.count);
    soup.left_out.extend(not_finite("face", &lost));
    soup.channels.extend(channels);
    if textures.is_some() {
        let mut corners = CornerTextures::default();
        let starts = std::iter::once(0).chain(places.1.iter().copied());
        for ((start, &end), face) in starts.zip(&places.1).zip(soup.faces.iter()) {
            corners.face(&places.0[start..end], face.len());
        }
        match corners.channel() {
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
) -> Result<(), Flaw> {
    let mut skip = |_, kind: Kind, source: &mut S| skip_property(kind, source);
    read_lists(element, source, &mut skip, |indices, source| {
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
fn vertex_index(index: i64, vertices: usize, source: &impl Source) -> Result<u32, Flaw> {
    match u32::try_from(index) {
        Ok(i) if (i as usize) < vertices => Ok(i),
        _ => {
            let expected = format!("a vertex index below {vertices} (the number of vertices)");
            Err(Flaw::new(source.place(), index.to_string(), expected))
        }
    }
}

fn list_length(count: i64, source: &impl Source) -> Result<usize, Flaw> {
    usize::try_from(count)
        .map_err(|_| Flaw::new(source.place(), count.to_string(), "the length of a list"))
}

fn skip_element(element: &Element, source: &mut impl Source) -> Result<(), Flaw> {
    if source.skip_all(element) {
        return Ok(());
    }
    for index in 0..element.count {
        let mut skip = || {
            for property in &element.properties {
                skip_property(property.kind, source)?;
            }
            source.end_element()
        };
        skip().map_err(|flaw| flaw.element(&element.name, index))?;
    }
    Ok(())
}

#[inline]
fn skip_property(kind: Kind, source: &mut impl Source) -> Result<(), Flaw> {
    match kind {
        Kind::Scalar(scalar) => source.skip(scalar, 1),
        Kind::List { count, item } => {
            let count = list_length(source.integer(count)?, source)?;
            source.skip(item, count)
        }
    }
}
