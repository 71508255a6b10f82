//! Geomview OFF in text, with columns of normals and colours where there are any, and colours of faces after their corners.

use crate::capacity::{Capacity, Held};
use crate::channels::by_vertex;
use crate::faces::Faces;
use crate::output::Output;
use crate::pieces::{Piece, Pieces};
use limitmesh::mesh::{Channel, Domain, Semantic, Storage};
use std::io::{self, Write};

/// The capacity of files.
pub(super) fn capacity() -> Capacity {
    let holds = |own: &Channel| own.semantic == Semantic::Colour && [3, 4].contains(&own.arity);
    Capacity {
        normals: Held::Double,
        ..Capacity::of_channels(holds)
    }
}

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    let (positions, triangles) = (output.surface.positions, output.surface.triangles);
    let faces = Faces::of(output);
    let held = capacity().held(output);
    let (of_faces, of_vertices): (Vec<&Channel>, Vec<&Channel>) =
        held.into_iter().partition(|own| own.domain == Domain::Face);
    let of_faces = of_faces.first().copied();
    let of_vertices = of_vertices.first().filter(|_| output.colours.is_none());
    let of_vertices =
        of_vertices.map(|own| (own, by_vertex(own, positions.len(), triangles).indices));
    let has_colours = output.colours.is_some() || of_vertices.is_some();
    out.bytes(if has_colours { b"C" } else { b"" })?;
    out.bytes(if output.vertex_normals().is_some() {
        b"N"
    } else {
        b""
    })?;
    out.bytes(format!("OFF\n{} {} 0\n", positions.len(), faces.count()).as_bytes())?;
    out.each(positions.len(), |out, vertex| {
        out.point(positions[vertex]);
        if let Some(normals) = output.vertex_normals() {
            out.numbers(&normals[vertex]);
        }
        if let Some(colours) = output.colours {
            // Colours have a fourth column, the opacity.
            out.integers(&colours[vertex].map(u32::from));
            out.integer(255);
        } else if let Some((channel, indices)) = &of_vertices {
            colour(out, channel, indices[vertex]);
        }
        out.end_line();
    })?;
    out.each(faces.count(), |out, face| {
        let corners = faces.corners(face);
        out.bare_integer(corners.len() as u32);
        for &corner in corners.iter() {
            out.integer(triangles.as_flattened()[corner]);
        }
        if let Some(channel) = of_faces {
            colour(out, channel, channel.indices[faces.triangle(face)]);
        }
        out.end_line();
    })?;
    out.finish()
}

/// A colour with its opacity: bytes where the channel's file had them, else numbers with a point, by which readers distinguish them.
fn colour(out: &mut Piece, channel: &Channel, number: u32) {
    let mut own = [1.0; 4];
    let start = number as usize * channel.arity;
    own[..channel.arity].copy_from_slice(&channel.values[start..][..channel.arity]);
    for value in own {
        match channel.storage {
            Storage::Byte => out.integer((255.0 * value.clamp(0.0, 1.0)).round() as u32),
            _ => out.pointed(value),
        }
    }
}
