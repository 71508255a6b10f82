//! Stanford PLY 1.0, little-endian or ASCII: `double` positions; normals, colours, quality and named properties if there
//! are any.

use super::Output;
use super::numbers::Pieces;
use super::ply_columns::{Columns, textures};
use crate::names;
use std::io::{self, Write};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>, ascii: bool) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    let columns = Columns::of(output);
    out.bytes(&header((output, &columns), ascii));
    for vertex in 0..output.surface.positions.len() {
        match ascii {
            true => vertex_text(&mut out, (output, &columns), vertex)?,
            false => vertex_bytes(&mut out, (output, &columns), vertex)?,
        }
    }
    for (face, triangle) in output.surface.triangles.iter().enumerate() {
        if ascii {
            out.bytes(b"3");
            triangle.iter().for_each(|&v| out.integer(v));
            output.face_properties.iter().for_each(|property| property.text(&mut out, face));
            columns.faces.iter().for_each(|column| column.text(&mut out, face));
            columns.textures.iter().for_each(|channel| textures(&mut out, channel, face, true));
            out.end_line()?;
        } else {
            out.bytes(&[3]);
            triangle.iter().for_each(|v| out.bytes(&v.to_le_bytes()));
            output.face_properties.iter().for_each(|property| property.bytes(&mut out, face));
            columns.faces.iter().for_each(|column| column.bytes(&mut out, face));
            columns.textures.iter().for_each(|channel| textures(&mut out, channel, face, false));
            out.end()?;
        }
    }
    out.finish()
}

fn header((output, columns): (&Output<'_>, &Columns<'_>), ascii: bool) -> Vec<u8> {
    let (positions, triangles) = (output.surface.positions, output.surface.triangles);
    let encoding = if ascii { "ascii" } else { "binary_little_endian" };
    let mut header = format!("ply\nformat {encoding} 1.0\ncomment written by limitmesh\n").into_bytes();
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
    properties.extend(output.vertex_properties.iter().map(|property| (property.kind(), property.name)));
    properties.extend(columns.vertices.iter().map(|column| (column.kind(), &column.name[..])));
    element("vertex", positions.len(), &properties);
    // Many readers know signed indices only, which reach far enough unless there are more than 2³¹ vertices.
    let index = if positions.len() > i32::MAX as usize { "list uchar uint" } else { "list uchar int" };
    let mut properties = vec![(index, "vertex_indices")];
    properties.extend(output.face_properties.iter().map(|property| (property.kind(), property.name)));
    properties.extend(columns.faces.iter().map(|column| (column.kind(), &column.name[..])));
    properties.extend(columns.textures.map(|_| ("list uchar float", "texcoord")));
    element("face", triangles.len(), &properties);
    header.extend(b"end_header\n");
    header
}

#[inline]
fn vertex_bytes(
    out: &mut Pieces<'_>,
    (output, columns): (&Output<'_>, &Columns<'_>),
    vertex: usize,
) -> io::Result<()> {
    output.surface.positions[vertex].iter().for_each(|x| out.bytes(&x.to_le_bytes()));
    if let Some(normals) = output.vertex_normals() {
        normals[vertex].iter().for_each(|&x| out.bytes(&(x as f32).to_le_bytes()));
    }
    if let Some(colours) = output.colours {
        out.bytes(&colours[vertex]);
    }
    if let Some(quality) = output.quality {
        out.bytes(&quality[vertex].to_le_bytes());
    }
    output.vertex_properties.iter().for_each(|property| property.bytes(out, vertex));
    columns.vertices.iter().for_each(|column| column.bytes(out, vertex));
    out.end()
}

fn vertex_text(
    out: &mut Pieces<'_>,
    (output, columns): (&Output<'_>, &Columns<'_>),
    vertex: usize,
) -> io::Result<()> {
    let [x, y, z] = output.surface.positions[vertex];
    out.bare_number(x);
    out.number(y);
    out.number(z);
    if let Some(normals) = output.vertex_normals() {
        normals[vertex].iter().for_each(|&x| out.single(x as f32));
    }
    if let Some(colours) = output.colours {
        colours[vertex].iter().for_each(|&c| out.integer(u32::from(c)));
    }
    if let Some(quality) = output.quality {
        out.number(quality[vertex]);
    }
    output.vertex_properties.iter().for_each(|property| property.text(out, vertex));
    columns.vertices.iter().for_each(|column| column.text(out, vertex));
    out.end_line()
}
