//! Wavefront OBJ: `v` (with colours after the coordinates), `vt`, `vn`, `f`, `o`, `g`, `usemtl`, `s`, `mtllib` and OpenSubdiv's tags.

use super::attributes::LABELS;
use crate::capacity::{Capacity, Held};
use crate::channels::by_vertex;
use crate::faces::Faces;
use crate::names;
use crate::output::Output;
use crate::pieces::{Piece, Pieces};
use limitmesh::mesh::{Channel, Domain, Semantic};
use std::io::{self, Write};

/// The capacity of files.
pub(super) fn capacity() -> Capacity {
    let holds = |channel: &Channel| match (channel.semantic, channel.domain) {
        (Semantic::TextureCoordinates, _) => true,
        (Semantic::Colour, domain) => domain != Domain::Face && channel.arity == 3,
        (Semantic::Label, Domain::Face) => LABELS.iter().any(|&(_, own)| own == channel.name),
        _ => false,
    };
    Capacity {
        normals: Held::Double,
        names_on_lines: true,
        names_files: true,
        ..Capacity::of_channels(holds)
    }
}

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    for library in output.material_libraries {
        out.element(|out| named(out, b"mtllib", library))?;
    }
    let held = capacity().held(output);
    let of = |semantic| held.iter().copied().find(|own| own.semantic == semantic);
    vertices(&mut out, output, of(Semantic::Colour))?;
    let textures = of(Semantic::TextureCoordinates);
    if let Some(Channel { values, arity, .. }) = textures {
        out.each(values.len() / arity, |out, at| {
            line(out, b"vt", &values[at * arity..][..(*arity).min(3)]);
        })?;
    }
    let normals = output.normals.unwrap_or_default();
    out.each(normals.len(), |out, at| line(out, b"vn", &normals[at]))?;
    let is_label = |own: &Channel, name| own.semantic == Semantic::Label && own.name == name;
    let labelled = |name| held.iter().find(|own| is_label(own, name));
    let labels = LABELS.map(|(keyword, name)| (keyword, labelled(name)));
    let faces = Faces::of(output);
    out.each(faces.count(), |out, at| {
        let before = at.checked_sub(1).map(|before| faces.triangle(before));
        for (keyword, channel) in &labels {
            if let Some(channel) = channel {
                change_of_label(out, keyword, channel, faces.triangle(at), before);
            }
        }
        face(out, output, textures, &faces.corners(at));
    })?;
    for tag in output.creases {
        out.element(|out| self::tag(out, b"t crease 2/1/0", &tag.vertices, tag.sharpness))?;
    }
    for tag in output.corners {
        out.element(|out| self::tag(out, b"t corner 1/1/0", &[tag.vertex], tag.sharpness))?;
    }
    out.finish()
}

/// A keyword and numbers.
fn line(out: &mut Piece, keyword: &[u8], numbers: &[f64]) {
    out.bytes(keyword);
    out.numbers(numbers);
    out.end_line();
}

/// A keyword and a name.
fn named(out: &mut Piece, keyword: &[u8], name: &str) {
    out.bytes(keyword);
    out.bytes(b" ");
    out.bytes(&names::write(name));
    out.end_line();
}

fn tag(out: &mut Piece, keyword: &[u8], vertices: &[u32], sharpness: f64) {
    out.bytes(keyword);
    out.integers(vertices);
    out.number(sharpness);
    out.end_line();
}

/// Vertices, with their colours.
fn vertices(
    out: &mut Pieces<'_>,
    output: &Output<'_>,
    colours: Option<&Channel>,
) -> io::Result<()> {
    let (positions, triangles) = (output.surface.positions, output.surface.triangles);
    let colours = colours.map(|own| (own, by_vertex(own, positions.len(), triangles).indices));
    out.each(positions.len(), |out, vertex| {
        out.bytes(b"v");
        out.numbers(&positions[vertex]);
        if let Some(colours) = output.colours {
            // Three decimals distinguish the 256 steps.
            let rounded = |c: u8| (f64::from(c) / 255.0 * 1000.0).round() / 1000.0;
            out.numbers(&colours[vertex].map(rounded));
        } else if let Some((channel, indices)) = &colours {
            out.numbers(&channel.values[indices[vertex] as usize * 3..][..3]);
        }
        out.end_line();
    })
}

/// A face with these corners, with the numbers of their texture coordinates and normals.
fn face(out: &mut Piece, output: &Output<'_>, textures: Option<&Channel>, corners: &[usize]) {
    let vertices = output.surface.triangles.as_flattened();
    let normals = output.corner_normals;
    let normals = normals.map_or(vertices, |corners| corners.as_flattened());
    out.bytes(b"f");
    for &corner in corners {
        let (vertex, normal) = (vertices[corner], normals[corner]);
        // There may be 2³² − 1 vertices, so that the last one's number fits.
        out.integer(vertex + 1);
        if let Some(channel) = textures {
            let element = match channel.domain {
                Domain::Vertex => vertex as usize,
                Domain::Corner => corner,
                Domain::Face => corner / 3,
            };
            out.bytes(b"/");
            out.bare_integer(channel.indices[element] + 1);
        }
        if output.normals.is_some() {
            out.bytes(if textures.is_some() { b"/" } else { b"//" });
            out.bare_integer(normal + 1);
        }
    }
    out.end_line();
}

/// Says what a triangle's face belongs to, where the one `before` it belonged to something else.
fn change_of_label(
    out: &mut Piece,
    keyword: &[u8],
    channel: &Channel,
    triangle: usize,
    before: Option<usize>,
) {
    let number = channel.indices[triangle];
    if before.is_some_and(|before| channel.indices[before] == number) {
        return;
    }
    let name = channel.labels.get(number as usize);
    let name = name.map_or("", String::as_str);
    // What comes before the first name has none.
    if before.is_some() || !name.is_empty() {
        named(out, keyword, name);
    }
}
