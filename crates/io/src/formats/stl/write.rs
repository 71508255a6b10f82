//! STL, binary (`f32`) or ASCII (all digits): the corners of each facet and its normal.

use crate::capacity::{Capacity, Held};
use crate::channels::{ATTRIBUTE, OBJECT, UNNAMED_SOLID};
use crate::names;
use crate::output::{Output, WriteOptions};
use crate::pieces::{Piece, Pieces};
use limitmesh::mesh::{Channel, Domain};
use std::io::{self, Write};

/// The capacity of files: in text the names of solids, in bytes attributes.
pub(super) fn capacity(options: &WriteOptions) -> Capacity {
    if options.ascii {
        let text = Capacity::of_channels(|own| own.domain == Domain::Face && own.name == OBJECT);
        return Capacity {
            names_on_lines: true,
            ..text
        };
    }
    let binary = Capacity::of_channels(|own| {
        own.domain == Domain::Face && own.name == ATTRIBUTE && own.arity == 1
    });
    Capacity {
        coordinates: Held::Single,
        ..binary
    }
}

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

pub(super) fn write(
    writer: &mut dyn Write,
    output: &Output<'_>,
    options: &WriteOptions,
) -> io::Result<()> {
    let held = capacity(options).held(output).first().copied();
    let out = Pieces::new(writer);
    if options.ascii {
        write_ascii(out, output, held)
    } else {
        write_binary(out, output, held)
    }
}

fn write_binary(
    mut out: Pieces<'_>,
    output: &Output<'_>,
    attributes: Option<&Channel>,
) -> io::Result<()> {
    out.bytes(&HEADER)?;
    let triangles = output.surface.triangles.len();
    // Checked before: no more than u32::MAX.
    out.bytes(&(triangles as u32).to_le_bytes())?;
    out.each(triangles, |out, face| {
        let corners = output.surface.corners(face);
        let values = corners.into_iter().flatten().map(|x| x as f32);
        for value in facet_normal(corners).into_iter().chain(values) {
            out.bytes(&value.to_le_bytes());
        }
        let attribute = attributes.map_or(0.0, |channel| channel.value(face)[0]);
        out.bytes(&(attribute as u16).to_le_bytes());
    })?;
    out.finish()
}

fn write_ascii(
    mut out: Pieces<'_>,
    output: &Output<'_>,
    solids: Option<&Channel>,
) -> io::Result<()> {
    let number = |face: usize| solids.map_or(0, |channel| channel.indices[face]);
    let name = |face: usize| {
        let name = solids.and_then(|channel| channel.labels.get(number(face) as usize));
        names::write(name.map_or(UNNAMED_SOLID, String::as_str))
    };
    let triangles = output.surface.triangles.len();
    out.each(triangles, |out, face| {
        let is_first = face == 0 || number(face - 1) != number(face);
        if is_first && face > 0 {
            named(out, b"endsolid", &name(face - 1));
        }
        if is_first {
            named(out, b"solid", &name(face));
        }
        let corners = output.surface.corners(face);
        out.bytes(b"facet normal");
        facet_normal(corners).iter().for_each(|&x| out.single(x));
        out.bytes(b"\nouter loop\n");
        for corner in corners {
            out.bytes(b"vertex");
            out.numbers(&corner);
            out.end_line();
        }
        out.bytes(b"endloop\nendfacet\n");
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
