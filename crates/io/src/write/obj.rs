//! Wavefront OBJ: `v` (with colours after the coordinates), `vn`, `f`, and OpenSubdiv's tags.

use super::Output;
use super::numbers::Pieces;
use std::io::{self, Write};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    for (vertex, position) in output.surface.positions.iter().enumerate() {
        out.bytes(b"v");
        position.iter().for_each(|&x| out.number(x));
        if let Some(colours) = output.colours {
            // Three decimals tell the 256 steps apart.
            colours[vertex]
                .iter()
                .for_each(|&c| out.number((f64::from(c) / 255.0 * 1000.0).round() / 1000.0));
        }
        out.end_line()?;
    }
    for normal in output.normals.unwrap_or_default() {
        out.bytes(b"vn");
        normal.iter().for_each(|&x| out.number(x));
        out.end_line()?;
    }
    for (at, triangle) in output.surface.triangles.iter().enumerate() {
        out.bytes(b"f");
        let normals = output.corner_normals.map_or(triangle, |corners| &corners[at]);
        for (&vertex, &normal) in triangle.iter().zip(normals) {
            // There may be 2³² − 1 vertices, so that the last one's number fits.
            out.integer(vertex + 1);
            if output.normals.is_some() {
                out.bytes(b"//");
                out.bare_integer(normal + 1);
            }
        }
        out.end_line()?;
    }
    for tag in output.creases {
        out.bytes(b"t crease 2/1/0");
        tag.vertices.iter().for_each(|&v| out.integer(v));
        out.number(tag.sharpness);
        out.end_line()?;
    }
    for tag in output.corners {
        out.bytes(b"t corner 1/1/0");
        out.integer(tag.vertex);
        out.number(tag.sharpness);
        out.end_line()?;
    }
    out.finish()
}
