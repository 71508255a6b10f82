//! STL, binary (`f32`) or ASCII (all digits): the corners of each facet and its normal.

use super::Output;
use super::numbers::Pieces;
use std::io::{self, Write};

/// First bytes of a binary file. They must not begin with `solid`, by which some readers know ASCII files.
const HEADER: [u8; 80] = {
    let mut header = [b' '; 80];
    let text = b"binary STL written by limitmesh";
    let mut i = 0;
    while i < text.len() {
        header[i] = text[i];
        i += 1;
    }
    header
};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>, ascii: bool) -> io::Result<()> {
    let out = Pieces::new(writer);
    if ascii { write_ascii(out, output) } else { write_binary(out, output) }
}

fn write_binary(mut out: Pieces<'_>, output: &Output<'_>) -> io::Result<()> {
    out.bytes(&HEADER);
    let triangles = output.surface.triangles.len();
    // Checked before: no more than u32::MAX.
    out.bytes(&(triangles as u32).to_le_bytes());
    for face in 0..triangles {
        let corners = output.surface.corners(face);
        for value in facet_normal(corners).into_iter().chain(corners.into_iter().flatten().map(|x| x as f32))
        {
            out.bytes(&value.to_le_bytes());
        }
        out.bytes(&[0, 0]);
        out.end()?;
    }
    out.finish()
}

fn write_ascii(mut out: Pieces<'_>, output: &Output<'_>) -> io::Result<()> {
    out.bytes(b"solid limitmesh\n");
    for face in 0..output.surface.triangles.len() {
        let corners = output.surface.corners(face);
        out.bytes(b"facet normal");
        facet_normal(corners).iter().for_each(|&x| out.single(x));
        out.bytes(b"\nouter loop\n");
        for corner in corners {
            out.bytes(b"vertex");
            corner.iter().for_each(|&x| out.number(x));
            out.bytes(b"\n");
        }
        out.bytes(b"endloop\nendfacet");
        out.end_line()?;
    }
    out.bytes(b"endsolid limitmesh\n");
    out.finish()
}

/// The unit normal of a facet; zero, as the format asks, where its corners lie on one line.
fn facet_normal([a, b, c]: [[f64; 3]; 3]) -> [f32; 3] {
    let edge = |from: [f64; 3], to: [f64; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let (u, v) = (edge(a, b), edge(a, c));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() { normal.map(|x| (x / length) as f32) } else { [0.0; 3] }
}
