//! Geomview OFF in text, with columns of normals and colours where there are any, and colours of faces after their corners.

use super::Output;
use super::numbers::{Piece, Pieces};
use crate::channels::by_vertex;
use limitmesh::mesh::{Channel, Domain, Semantic, Storage};
use std::io::{self, Write};

pub(super) fn write(writer: &mut dyn Write, output: &Output<'_>) -> io::Result<()> {
    let mut out = Pieces::new(writer);
    let (positions, triangles) = (output.surface.positions, output.surface.triangles);
    let find = |is_by_face: bool| {
        let is_own = |channel: &&Channel| {
            let holds = crate::holds(crate::Format::Off, &Default::default(), channel);
            holds
                && channel.semantic == Semantic::Colour
                && (channel.domain == Domain::Face) == is_by_face
        };
        output.channels.iter().find(is_own)
    };
    let of_vertices = find(false).filter(|_| output.colours.is_none());
    let of_vertices = of_vertices.map(|own| (own, by_vertex(own, positions.len(), triangles).0));
    let of_faces = find(true);
    let has_colours = output.colours.is_some() || of_vertices.is_some();
    let keyword: &[u8] = match (has_colours, output.vertex_normals().is_some()) {
        (false, false) => b"OFF",
        (true, false) => b"COFF",
        (false, true) => b"NOFF",
        (true, true) => b"CNOFF",
    };
    out.bytes(keyword)?;
    out.bytes(format!("\n{} {} 0\n", positions.len(), triangles.len()).as_bytes())?;
    out.each(positions.len(), |out, vertex| {
        let [x, y, z] = positions[vertex];
        out.bare_number(x);
        out.number(y);
        out.number(z);
        if let Some(normals) = output.vertex_normals() {
            normals[vertex].iter().for_each(|&x| out.number(x));
        }
        if let Some(colours) = output.colours {
            colours[vertex]
                .iter()
                .for_each(|&c| out.integer(u32::from(c)));
            // Colours have a fourth column, the opacity.
            out.integer(255);
        } else if let Some((channel, numbers)) = &of_vertices {
            colour(out, channel, numbers[vertex]);
        }
        out.end_line();
    })?;
    out.each(triangles.len(), |out, face| {
        out.bytes(b"3");
        triangles[face].iter().for_each(|&v| out.integer(v));
        if let Some(channel) = of_faces {
            colour(out, channel, channel.indices[face]);
        }
        out.end_line();
    })?;
    out.finish()
}

/// A colour with its opacity: bytes where the channel's file had them, else numbers with a point, which tells them apart.
fn colour(out: &mut Piece, channel: &Channel, number: u32) {
    let start = number as usize * channel.arity;
    let own = &channel.values[start..start + channel.arity];
    for i in 0..4 {
        let value = own.get(i).copied().unwrap_or(1.0);
        match channel.storage {
            Storage::Byte => out.integer((255.0 * value.clamp(0.0, 1.0)).round() as u32),
            _ => out.pointed(value),
        }
    }
}
