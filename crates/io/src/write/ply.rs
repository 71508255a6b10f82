//! Stanford PLY 1.0, little-endian or ASCII: `double` positions; normals, colours, quality and named properties if there
//! are any.

use super::Output;
use super::numbers::{Piece, Pieces};
use super::ply_columns::{Columns, textures};
use crate::names;
use std::io::{self, Write};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>, ascii: bool) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    let columns = Columns::of(output);
    let told = (output, &columns);
    out.bytes(&header(told, ascii))?;
    out.each(output.surface.positions.len(), |out, vertex| match ascii {
        true => vertex_text(out, told, vertex),
        false => vertex_bytes(out, told, vertex),
    })?;
    out.each(output.surface.triangles.len(), |out, face| match ascii {
        true => face_text(out, told, face),
        false => face_bytes(out, told, face),
    })?;
    out.finish()
}

fn header((output, columns): (&Output<'_>, &Columns<'_>), ascii: bool) -> Vec<u8> {
    let (positions, triangles) = (output.surface.positions, output.surface.triangles);
    let encoding = if ascii {
        "ascii"
    } else {
        "binary_little_endian"
    };
    let mut header =
        format!("ply\nformat {encoding} 1.0\ncomment written by limitmesh\n").into_bytes();
    for file in output.texture_files {
        header.extend(b"comment TextureFile ");
        header.extend(names::write(file));
        header.push(b'\n');
    }
    let mut element = |name: &str, count: usize, properties: &[(&str, &str)]| {
        header.extend(format!("element {name} {count}\n").bytes());
        for (kind, name) in properties {
            header.extend(format!("property {kind} {name}\n").bytes());
        }
    };
    let mut properties = vec![("double", "x"), ("double", "y"), ("double", "z")];
    if output.vertex_normals().is_some() {
        properties.extend(["nx", "ny", "nz"].map(|name| ("float", name)));
    }
    if output.colours.is_some() {
        properties.extend(["red", "green", "blue"].map(|name| ("uchar", name)));
    }
    if output.quality.is_some() {
        properties.push(("double", "quality"));
    }
    properties.extend(
        output
            .vertex_properties
            .iter()
            .map(|property| (property.kind(), property.name)),
    );
    properties.extend(
        columns
            .vertices
            .iter()
            .map(|column| (column.kind(), &column.name[..])),
    );
    element("vertex", positions.len(), &properties);
    // Many readers know signed indices only, which reach far enough unless there are more than 2³¹ vertices.
    let index = if positions.len() > i32::MAX as usize {
        "list uchar uint"
    } else {
        "list uchar int"
    };
    let mut properties = vec![(index, "vertex_indices")];
    properties.extend(
        output
            .face_properties
            .iter()
            .map(|property| (property.kind(), property.name)),
    );
    properties.extend(
        columns
            .faces
            .iter()
            .map(|column| (column.kind(), &column.name[..])),
    );
    properties.extend(columns.textures.map(|_| ("list uchar float", "texcoord")));
    element("face", triangles.len(), &properties);
    header.extend(b"end_header\n");
    header
}

#[inline]
fn vertex_bytes(out: &mut Piece, (output, columns): (&Output<'_>, &Columns<'_>), vertex: usize) {
    output.surface.positions[vertex]
        .iter()
        .for_each(|x| out.bytes(&x.to_le_bytes()));
    if let Some(normals) = output.vertex_normals() {
        normals[vertex]
            .iter()
            .for_each(|&x| out.bytes(&(x as f32).to_le_bytes()));
    }
    if let Some(colours) = output.colours {
        out.bytes(&colours[vertex]);
    }
    if let Some(quality) = output.quality {
        out.bytes(&quality[vertex].to_le_bytes());
    }
    output
        .vertex_properties
        .iter()
        .for_each(|property| property.bytes(out, vertex));
    columns
        .vertices
        .iter()
        .for_each(|column| column.bytes(out, vertex));
}

fn vertex_text(out: &mut Piece, (output, columns): (&Output<'_>, &Columns<'_>), vertex: usize) {
    let [x, y, z] = output.surface.positions[vertex];
    out.bare_number(x);
    out.number(y);
    out.number(z);
    if let Some(normals) = output.vertex_normals() {
        normals[vertex].iter().for_each(|&x| out.single(x as f32));
    }
    if let Some(colours) = output.colours {
        colours[vertex]
            .iter()
            .for_each(|&c| out.integer(u32::from(c)));
    }
    if let Some(quality) = output.quality {
        out.number(quality[vertex]);
    }
    output
        .vertex_properties
        .iter()
        .for_each(|property| property.text(out, vertex));
    columns
        .vertices
        .iter()
        .for_each(|column| column.text(out, vertex));
    out.end_line();
}

#[inline]
fn face_bytes(out: &mut Piece, (output, columns): (&Output<'_>, &Columns<'_>), face: usize) {
    out.bytes(&[3]);
    output.surface.triangles[face]
        .iter()
        .for_each(|v| out.bytes(&v.to_le_bytes()));
    output
        .face_properties
        .iter()
        .for_each(|property| property.bytes(out, face));
    columns
        .faces
        .iter()
        .for_each(|column| column.bytes(out, face));
    columns
        .textures
        .iter()
        .for_each(|channel| textures(out, channel, face, false));
}

fn face_text(out: &mut Piece, (output, columns): (&Output<'_>, &Columns<'_>), face: usize) {
    out.bytes(b"3");
    output.surface.triangles[face]
        .iter()
        .for_each(|&v| out.integer(v));
    output
        .face_properties
        .iter()
        .for_each(|property| property.text(out, face));
    columns
        .faces
        .iter()
        .for_each(|column| column.text(out, face));
    columns
        .textures
        .iter()
        .for_each(|channel| textures(out, channel, face, true));
    out.end_line();
}
