//! Stanford PLY 1.0, little-endian or ASCII: `double` positions; normals, colours, quality and named properties if there
//! are any.

use super::split::Split;
use super::write_columns::{Columns, capacity, single};
use crate::channels::TEXTURE_LISTS;
use crate::faces::Faces;
use crate::names;
use crate::output::Output;
use crate::pieces::Pieces;
use std::io::{self, Write};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>, ascii: bool) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    let (positions, mut triangles) = (output.surface.positions, output.surface.triangles);
    let split = Split::of(output, &capacity());
    let columns = Columns::of(output, split.as_ref());
    let (mut count, mut sources) = (positions.len(), None);
    if let Some(split) = &split {
        (count, triangles, sources) = (split.sources.len(), &split.triangles, Some(&split.sources));
    }
    let faces = Faces::of(output);
    out.bytes(&header(output, &columns, [count, faces.count()], ascii))?;
    out.each(count, |out, vertex| {
        let source = sources.map_or(vertex, |all| all[vertex] as usize);
        match ascii {
            true => out.point(positions[source]),
            false => positions[source]
                .iter()
                .for_each(|x| out.bytes(&x.to_le_bytes())),
        }
        for own in columns.vertices.iter() {
            own.write(out, vertex, source, ascii);
        }
        if ascii {
            out.end_line();
        }
    })?;
    out.each(faces.count(), |out, face| {
        let corners = faces.corners(face);
        match ascii {
            true => out.bare_integer(corners.len() as u32),
            false => out.bytes(&[corners.len() as u8]),
        }
        for vertex in corners.iter().map(|&at| triangles.as_flattened()[at]) {
            match ascii {
                true => out.integer(vertex),
                false => out.bytes(&vertex.to_le_bytes()),
            }
        }
        let triangle = faces.triangle(face);
        for own in columns.faces.iter() {
            own.write(out, triangle, triangle, ascii);
        }
        if let Some(channel) = columns.textures {
            let numbers = 2 * corners.len();
            match ascii {
                true => out.integer(numbers as u32),
                false => out.bytes(&[numbers as u8]),
            }
            for value in corners.iter().map(|&corner| channel.value(corner)) {
                // A texture of one number has its other at 0.
                let v = value.get(1).copied().unwrap_or(0.0);
                for x in [value[0], v] {
                    single(out, x as f32, ascii);
                }
            }
        }
        if ascii {
            out.end_line();
        }
    })?;
    out.finish()
}

fn header(
    output: &Output<'_>,
    columns: &Columns<'_>,
    [vertices, faces]: [usize; 2],
    ascii: bool,
) -> Vec<u8> {
    let encoding = if ascii {
        "ascii"
    } else {
        "binary_little_endian"
    };
    let start = format!("ply\nformat {encoding} 1.0\ncomment written by limitmesh\n");
    let mut header = start.into_bytes();
    for file in output.texture_files {
        header.extend(b"comment TextureFile ");
        header.extend(names::write(file));
        header.push(b'\n');
    }
    header.extend(format!("element vertex {vertices}\n").bytes());
    header.extend(b"property double x\nproperty double y\nproperty double z\n");
    header.extend(
        columns
            .vertices
            .iter()
            .flat_map(|own| own.declaration().into_bytes()),
    );
    // Many readers know signed indices only, which reach far enough unless there are more than 2³¹ vertices.
    let index = if vertices > i32::MAX as usize {
        "uint"
    } else {
        "int"
    };
    header.extend(
        format!("element face {faces}\nproperty list uchar {index} vertex_indices\n").bytes(),
    );
    header.extend(
        columns
            .faces
            .iter()
            .flat_map(|own| own.declaration().into_bytes()),
    );
    if columns.textures.is_some() {
        header.extend(format!("property list uchar float {TEXTURE_LISTS}\n").bytes());
    }
    header.extend(b"end_header\n");
    header
}
