//! Geomview OFF in text, with columns of normals and colours where there are any.

use super::Output;
use super::numbers::Pieces;
use std::io::{self, Write};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    let keyword: &[u8] = match (output.colours.is_some(), output.vertex_normals().is_some()) {
        (false, false) => b"OFF",
        (true, false) => b"COFF",
        (false, true) => b"NOFF",
        (true, true) => b"CNOFF",
    };
    out.bytes(keyword);
    let (positions, triangles) = (output.surface.positions, output.surface.triangles);
    out.bytes(format!("\n{} {} 0\n", positions.len(), triangles.len()).as_bytes());
    for (vertex, &[x, y, z]) in positions.iter().enumerate() {
        out.bare_number(x);
        out.number(y);
        out.number(z);
        if let Some(normals) = output.vertex_normals() {
            normals[vertex].iter().for_each(|&x| out.number(x));
        }
        if let Some(colours) = output.colours {
            colours[vertex].iter().for_each(|&c| out.integer(u32::from(c)));
            // Colours have a fourth column, the opacity.
            out.integer(255);
        }
        out.end_line()?;
    }
    for triangle in triangles {
        out.bytes(b"3");
        triangle.iter().for_each(|&v| out.integer(v));
        out.end_line()?;
    }
    out.finish()
}
