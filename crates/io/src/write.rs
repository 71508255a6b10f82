//! Writing: from triangles and what is known of their vertices to a file.

use crate::capacity::Held;
use crate::channels::by_vertex;
use crate::error::WriteError;
use crate::files::{copies, folder_of};
use crate::format::Format;
use crate::formats::codec;
use crate::output::{Output, WriteOptions};
use crate::whole::{write_together, write_whole_with};
use limitmesh::math;
use limitmesh::mesh::{Channel, Domain, Semantic};
use std::io::Write;
use std::path::Path;

/// Whether files of a format have a place for a channel.
pub fn holds(format: Format, options: &WriteOptions, channel: &Channel) -> bool {
    (codec(format).capacity)(options).holds(channel)
}

/// How many vertices have several values of a channel of which a format holds one: these get the first of their corners'.
pub fn values_lost(
    format: Format,
    channel: &Channel,
    triangles: &[[u32; 3]],
    vertices: usize,
) -> usize {
    let is_by_corner = channel.semantic == Semantic::TextureCoordinates || format.is_gltf();
    let is_held = holds(format, &WriteOptions::default(), channel);
    if channel.domain != Domain::Corner || is_by_corner || !is_held {
        return 0;
    }
    by_vertex(channel, vertices, triangles).torn
}

/// The greatest distance from one of these positions to what a file of this format holds of it, at most: 0 but for binary STL and
/// glTF, which round coordinates to `f32`.
pub fn rounding(format: Format, options: &WriteOptions, positions: &[[f64; 3]]) -> f64 {
    if (codec(format).capacity)(options).coordinates != Held::Single {
        return 0.0;
    }
    let off = |x: f64| match format {
        // Half the last place at most, which holds at whatever scale a scene shows the mesh.
        _ if format.is_gltf() => x.abs() * f64::from(f32::EPSILON) * 0.5,
        _ => (x - f64::from(x as f32)).abs(),
    };
    positions.iter().fold(0.0, |greatest: f64, position| {
        let [x, y, z] = position.map(off);
        // Hardly any is greater than all before.
        if x + y + z > greatest {
            greatest.max(math::hypot(math::hypot(x, y), z))
        } else {
            greatest
        }
    })
}

/// Writes a mesh file in the format of its extension, whole or not at all (see [`write_whole`](crate::write_whole)).
///
/// Values that the format cannot hold are left out: [`Output`] says which holds what. Positions keep every bit in
/// OBJ, PLY, OFF, 3MF and ASCII STL; binary STL and glTF round them to `f32`. STL repeats them in each facet.
///
/// # Errors
/// The extension is unknown, the output does not fit together or into the format, or the system refuses.
pub fn write(path: &Path, output: &Output<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    write_as(path, Format::from_path(path)?, output, options)
}

/// [`write()`] in a format that the name need not say.
///
/// # Errors
/// The output does not fit together or into the format, the system refuses, or a file that would be copied is there already and not the same.
pub fn write_as(
    path: &Path,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let codec = codec(format);
    let capacity = (codec.capacity)(options);
    capacity.check(output, format)?;
    if let Some(write_file) = codec.write_file {
        return write_file(path, output, options);
    }
    let is_device = std::fs::metadata(path).is_ok_and(|there| !there.is_file());
    let named = output.materials;
    let named = named.filter(|_| capacity.names_files && !is_device);
    let files = named.into_iter().flat_map(|found| {
        let files = found.files.iter();
        files.map(|file| (file.as_path(), found.folder.join(file)))
    });
    let copied = copies(files, folder_of(path))?;
    write_whole_with(path, |writer| {
        write_checked(writer, format, output, options)
    })?;
    write_together(&copied)
}

/// Writes a mesh in the given format to any writer. On an error, part of it may have been written.
///
/// # Errors
/// The output does not fit together or into the format, or the writer fails.
pub fn write_to(
    writer: &mut dyn Write,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    (codec(format).capacity)(options).check(output, format)?;
    write_checked(writer, format, output, options)
}

fn write_checked(
    writer: &mut dyn Write,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    (codec(format).write)(writer, output, options)?;
    Ok(writer.flush()?)
}
