//! STL, binary (`f32`) or ASCII (all digits): the corners of each facet and its normal.

use super::Output;
use super::WriteOptions;
use super::numbers::{Piece, Pieces};
use crate::channels::UNNAMED_SOLID;
use crate::format::Format;
use crate::names;
use limitmesh::mesh::Channel;
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
    if ascii {
        write_ascii(out, output)
    } else {
        write_binary(out, output)
    }
}

fn write_binary(mut out: Pieces<'_>, output: &Output<'_>) -> io::Result<()> {
    out.bytes(&HEADER)?;
    let triangles = output.surface.triangles.len();
    let attributes = find(output, false);
    // Checked before: no more than u32::MAX.
    out.bytes(&(triangles as u32).to_le_bytes())?;
    out.each(triangles, |out, face| {
        let corners = output.surface.corners(face);
        for value in facet_normal(corners)
            .into_iter()
            .chain(corners.into_iter().flatten().map(|x| x as f32))
        {
            out.bytes(&value.to_le_bytes());
        }
        let attribute = attributes.map_or(0.0, |channel| channel.value(face)[0]);
        out.bytes(&(attribute as u16).to_le_bytes());
    })?;
    out.finish()
}

fn write_ascii(mut out: Pieces<'_>, output: &Output<'_>) -> io::Result<()> {
    let solids = find(output, true);
    let number = |face: usize| solids.map_or(0, |channel| channel.indices[face]);
    let name = |face: usize| {
        let name = solids.and_then(|channel| channel.labels.get(channel.indices[face] as usize));
        name.map_or_else(
            || UNNAMED_SOLID.as_bytes().to_vec(),
            |name| names::write(name),
        )
    };
    let triangles = output.surface.triangles.len();
    out.each(triangles, |out, face| {
        let before = face
            .checked_sub(1)
            .filter(|&before| number(before) != number(face));
        if let Some(before) = before {
            named(out, b"endsolid", &name(before));
        }
        if face == 0 || before.is_some() {
            named(out, b"solid", &name(face));
        }
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
        out.end_line();
    })?;
    out.element(|out| match triangles.checked_sub(1) {
        Some(last) => named(out, b"endsolid", &name(last)),
        None => {
            named(out, b"solid", UNNAMED_SOLID.as_bytes());
            named(out, b"endsolid", UNNAMED_SOLID.as_bytes());
        }
    })?;
    out.finish()
}

/// A keyword with the name of a solid.
fn named(out: &mut Piece, keyword: &[u8], name: &[u8]) {
    out.bytes(keyword);
    if !name.is_empty() {
        out.bytes(b" ");
        out.bytes(name);
    }
    out.end_line();
}

/// The channel that a file holds: in text the names of solids, else attributes.
fn find<'a>(output: &Output<'a>, ascii: bool) -> Option<&'a Channel> {
    let options = WriteOptions::default().ascii(ascii);
    output
        .channels
        .iter()
        .find(|channel| crate::holds(Format::Stl, &options, channel))
}

/// The unit normal of a facet; zero, as the format asks, where its corners lie on one line.
fn facet_normal([a, b, c]: [[f64; 3]; 3]) -> [f32; 3] {
    let edge = |from: [f64; 3], to: [f64; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let (u, v) = (edge(a, b), edge(a, c));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() {
        normal.map(|x| (x / length) as f32)
    } else {
        [0.0; 3]
    }
}
