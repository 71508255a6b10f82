//! Wavefront OBJ: `v` (with colours after the coordinates), `vt`, `vn`, `f`, `o`, `g`, `usemtl`, `s`, `mtllib` and OpenSubdiv's tags.

use super::Output;
use super::numbers::{Piece, Pieces};
use crate::channels;
use crate::names;
use limitmesh::mesh::{Channel, Domain, Semantic};
use std::io::{self, Write};

/// Statements that name what the faces after them belong to, with the channels that have these names.
const STATEMENTS: [(&str, &[u8]); 4] = [
    (channels::OBJECT, b"o"),
    (channels::GROUP, b"g"),
    (channels::MATERIAL, b"usemtl"),
    (channels::SMOOTHING_GROUP, b"s"),
];

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    for library in output.material_libraries {
        out.element(|out| {
            out.bytes(b"mtllib ");
            out.bytes(&names::write(library));
            out.end_line();
        })?;
    }
    vertices(&mut out, output)?;
    let of = |semantic| {
        output
            .channels
            .iter()
            .find(move |channel: &&Channel| channel.semantic == semantic)
    };
    let textures = of(Semantic::TextureCoordinates);
    let places = textures.map_or((&[][..], 1), |channel| {
        (&channel.values[..], channel.arity.max(1))
    });
    out.each(places.0.len() / places.1, |out, at| {
        out.bytes(b"vt");
        places.0[at * places.1..][..places.1.min(3)]
            .iter()
            .for_each(|&x| out.number(x));
        out.end_line();
    })?;
    let normals = output.normals.unwrap_or_default();
    out.each(normals.len(), |out, at| {
        out.bytes(b"vn");
        normals[at].iter().for_each(|&x| out.number(x));
        out.end_line();
    })?;
    let named = |name: &str| output.channels.iter().find(|channel| channel.name == name);
    let labels =
        STATEMENTS.map(|(name, statement)| (named(name).filter(|c| is_label(c)), statement));
    out.each(output.surface.triangles.len(), |out, at| {
        for (channel, statement) in &labels {
            change_of_label(out, *channel, statement, at);
        }
        face(out, output, textures, at);
    })?;
    for tag in output.creases {
        out.element(|out| {
            out.bytes(b"t crease 2/1/0");
            tag.vertices.iter().for_each(|&v| out.integer(v));
            out.number(tag.sharpness);
            out.end_line();
        })?;
    }
    for tag in output.corners {
        out.element(|out| {
            out.bytes(b"t corner 1/1/0");
            out.integer(tag.vertex);
            out.number(tag.sharpness);
            out.end_line();
        })?;
    }
    out.finish()
}

/// Vertices, with their colours.
fn vertices(out: &mut Pieces<'_>, output: &Output<'_>) -> io::Result<()> {
    let colours = output.channels.iter().find(|channel| {
        channel.semantic == Semantic::Colour
            && crate::holds(crate::Format::Obj, &Default::default(), channel)
    });
    let (count, triangles) = (output.surface.positions.len(), output.surface.triangles);
    let colours =
        colours.map(|channel| (channel, channels::by_vertex(channel, count, triangles).0));
    out.each(count, |out, vertex| {
        out.bytes(b"v");
        output.surface.positions[vertex]
            .iter()
            .for_each(|&x| out.number(x));
        if let Some(colours) = output.colours {
            // Three decimals tell the 256 steps apart.
            colours[vertex]
                .iter()
                .for_each(|&c| out.number((f64::from(c) / 255.0 * 1000.0).round() / 1000.0));
        } else if let Some((channel, numbers)) = &colours {
            let start = numbers[vertex] as usize * channel.arity;
            channel.values[start..start + channel.arity]
                .iter()
                .for_each(|&c| out.number(c));
        }
        out.end_line();
    })
}

/// A triangle, with the numbers of its texture coordinates and normals.
fn face(out: &mut Piece, output: &Output<'_>, textures: Option<&Channel>, at: usize) {
    let triangle = &output.surface.triangles[at];
    out.bytes(b"f");
    let normals = output
        .corner_normals
        .map_or(triangle, |corners| &corners[at]);
    for (corner, (&vertex, &normal)) in triangle.iter().zip(normals).enumerate() {
        // There may be 2³² − 1 vertices, so that the last one's number fits.
        out.integer(vertex + 1);
        let texture = textures.map(|channel| texture(channel, vertex, 3 * at + corner));
        if let Some(texture) = texture {
            out.bytes(b"/");
            out.bare_integer(texture + 1);
        }
        if output.normals.is_some() {
            out.bytes(if texture.is_some() { b"/" } else { b"//" });
            out.bare_integer(normal + 1);
        }
    }
    out.end_line();
}

fn texture(channel: &Channel, vertex: u32, corner: usize) -> u32 {
    let element = match channel.domain {
        Domain::Vertex => vertex as usize,
        Domain::Corner => corner,
        Domain::Face => corner / 3,
    };
    channel.indices[element]
}

fn is_label(channel: &Channel) -> bool {
    channel.semantic == Semantic::Label && channel.domain == Domain::Face
}

/// Says what a triangle belongs to, where the one before it belonged to something else.
fn change_of_label(out: &mut Piece, channel: Option<&Channel>, statement: &[u8], triangle: usize) {
    let Some(channel) = channel else { return };
    let number = channel.indices[triangle];
    if triangle
        .checked_sub(1)
        .is_some_and(|before| channel.indices[before] == number)
    {
        return;
    }
    let name = channel
        .labels
        .get(number as usize)
        .map_or("", String::as_str);
    // What comes before the first name has none.
    if triangle == 0 && name.is_empty() {
        return;
    }
    out.bytes(statement);
    out.bytes(b" ");
    out.bytes(&names::write(name));
    out.end_line();
}
