//! Writing: from triangles and what is known of their vertices to a file.

mod copies;
mod numbers;
mod obj;
mod off;
mod ply;
mod ply_columns;
mod property;
mod split;
mod stl;
mod whole;

pub(crate) use copies::copies;
pub(crate) use numbers::Pieces;
pub use property::{Property, PropertyValues};
pub use split::splits_vertices;
pub use whole::{
    Abandoned, abandon_unfinished, check_writable, finished_files, write_whole, write_whole_with,
};
pub(crate) use whole::{WholeFile, write_together};

use crate::error::WriteError;
use crate::format::Format;
use crate::gltf;
use crate::mtl::MaterialLibraries;
use crate::threemf::{self, LengthUnit};
use limitmesh::mesh::{Channel, CornerTag, CreaseTag, Triangles};
use split::Split;
use std::io::Write;
use std::path::Path;

/// What is to be written: triangles and, for each vertex, what else is known.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    /// Positions and triangles.
    pub surface: Triangles<'a>,
    /// A normal for each vertex. OBJ, PLY and glTF (both as `float`), and OFF hold them.
    pub normals: Option<&'a [[f64; 3]]>,
    /// By triangle, the normals of its corners among these, where vertices have several: then there may be any number of normals. Only
    /// OBJ holds that; other formats hold no normals then.
    pub corner_normals: Option<&'a [[u32; 3]]>,
    /// Red, green and blue for each vertex. OBJ (after the coordinates), PLY and OFF hold them.
    pub colours: Option<&'a [[u8; 3]]>,
    /// A number for each vertex, such as a distance. PLY holds it, as property `quality`.
    pub quality: Option<&'a [f64]>,
    /// Further properties of the vertices. PLY holds them.
    pub vertex_properties: &'a [Property<'a>],
    /// Further properties of the triangles. PLY holds them.
    pub face_properties: &'a [Property<'a>],
    /// What corners and faces carry: see [`holds`](crate::holds). PLY may have vertices several times for it: see [`splits_vertices`].
    pub channels: &'a [Channel],
    /// Files that describe materials. OBJ names them.
    pub material_libraries: &'a [String],
    /// What the materials of the channel [`MATERIAL`](crate::MATERIAL) look like. glTF holds their base colours and pictures. The files are copied
    /// below the folder of an OBJ or PLY file, which names them.
    pub materials: Option<&'a MaterialLibraries>,
    /// Pictures that texture coordinates are places on. PLY names them.
    pub texture_files: &'a [String],
    /// Sharp edges. OBJ holds them.
    pub creases: &'a [CreaseTag],
    /// Sharp vertices. OBJ holds them.
    pub corners: &'a [CornerTag],
}

impl<'a> Output<'a> {
    /// The triangles alone.
    pub fn new(surface: Triangles<'a>) -> Self {
        Self {
            surface,
            normals: None,
            corner_normals: None,
            colours: None,
            quality: None,
            vertex_properties: &[],
            face_properties: &[],
            channels: &[],
            material_libraries: &[],
            materials: None,
            texture_files: &[],
            creases: &[],
            corners: &[],
        }
    }

    /// Sets [`Self::normals`].
    pub fn normals(mut self, normals: &'a [[f64; 3]]) -> Self {
        self.normals = Some(normals);
        self
    }

    /// Sets [`Self::normals`] and [`Self::corner_normals`].
    pub fn normals_of_corners(mut self, normals: &'a [[f64; 3]], corners: &'a [[u32; 3]]) -> Self {
        (self.normals, self.corner_normals) = (Some(normals), Some(corners));
        self
    }

    /// Sets [`Self::colours`].
    pub fn colours(mut self, colours: &'a [[u8; 3]]) -> Self {
        self.colours = Some(colours);
        self
    }

    /// Sets [`Self::quality`].
    pub fn quality(mut self, quality: &'a [f64]) -> Self {
        self.quality = Some(quality);
        self
    }

    /// Sets [`Self::vertex_properties`].
    pub fn vertex_properties(mut self, properties: &'a [Property<'a>]) -> Self {
        self.vertex_properties = properties;
        self
    }

    /// Sets [`Self::face_properties`].
    pub fn face_properties(mut self, properties: &'a [Property<'a>]) -> Self {
        self.face_properties = properties;
        self
    }

    /// Sets [`Self::channels`].
    pub fn channels(mut self, channels: &'a [Channel]) -> Self {
        self.channels = channels;
        self
    }

    /// Sets [`Self::material_libraries`].
    pub fn material_libraries(mut self, libraries: &'a [String]) -> Self {
        self.material_libraries = libraries;
        self
    }

    /// Sets [`Self::materials`].
    pub fn materials(mut self, materials: &'a MaterialLibraries) -> Self {
        self.materials = Some(materials);
        self
    }

    /// Sets [`Self::texture_files`].
    pub fn texture_files(mut self, files: &'a [String]) -> Self {
        self.texture_files = files;
        self
    }

    /// Sets [`Self::creases`].
    pub fn creases(mut self, creases: &'a [CreaseTag]) -> Self {
        self.creases = creases;
        self
    }

    /// Sets [`Self::corners`].
    pub fn corners(mut self, corners: &'a [CornerTag]) -> Self {
        self.corners = corners;
        self
    }
}

impl Output<'_> {
    /// Normals where each vertex has one.
    pub(crate) fn vertex_normals(&self) -> Option<&[[f64; 3]]> {
        self.normals.filter(|_| self.corner_normals.is_none())
    }
}

/// How a file is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct WriteOptions {
    /// Text where the format has a binary form as well (PLY, STL). Default: binary there.
    pub ascii: bool,
    /// What the numbers are measured in, where that is known. 3MF says so, and that they are millimetres where it is not known. In glTF, whose
    /// unit is the metre, the node of the mesh scales them; where it is not known they are as they are.
    pub unit: Option<LengthUnit>,
}

impl WriteOptions {
    /// Sets [`Self::ascii`].
    pub fn ascii(mut self, ascii: bool) -> Self {
        self.ascii = ascii;
        self
    }

    /// Sets [`Self::unit`].
    pub fn unit(mut self, unit: LengthUnit) -> Self {
        self.unit = Some(unit);
        self
    }
}

/// The greatest distance from one of these positions to what a file of this format holds of it, at most: 0 but for binary STL and
/// glTF, which round coordinates to `f32`.
pub fn rounding(format: Format, options: &WriteOptions, positions: &[[f64; 3]]) -> f64 {
    if !is_single(format, options) {
        return 0.0;
    }
    let off = |x: f64| match format {
        // Half the last place at most, which holds at whatever scale a scene shows the mesh.
        Format::Gltf | Format::Glb => x.abs() * f64::from(f32::EPSILON) * 0.5,
        _ => (x - f64::from(x as f32)).abs(),
    };
    positions.iter().fold(0.0, |greatest: f64, position| {
        let [x, y, z] = position.map(off);
        // Hardly any is greater than all before.
        if x + y + z > greatest {
            greatest.max(x.hypot(y).hypot(z))
        } else {
            greatest
        }
    })
}

/// Whether coordinates are rounded to `f32`.
fn is_single(format: Format, options: &WriteOptions) -> bool {
    match format {
        Format::Stl => !options.ascii,
        Format::Gltf | Format::Glb => true,
        Format::Obj | Format::Ply | Format::Off | Format::ThreeMf => false,
    }
}

/// Writes a mesh file in the format of its extension, whole or not at all (see [`write_whole`]).
///
/// What the format cannot hold is left out: [`Output`] says which holds what. Positions keep every bit in
/// OBJ, PLY, OFF, 3MF and ASCII STL; binary STL and glTF round them to `f32`. STL repeats them in each facet.
///
/// # Errors
/// The extension is unknown, the output does not fit together or into the format, or the system refuses.
pub fn write(path: &Path, output: &Output<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    write_as(path, Format::from_path(path)?, output, options)
}

/// [`write()`] in a format that the name need not tell.
///
/// # Errors
/// The output does not fit together or into the format, the system refuses, or a file that would be copied is there already and not the same.
pub fn write_as(
    path: &Path,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    check(output, format, options)?;
    if matches!(format, Format::Gltf | Format::Glb) {
        return gltf::write_fresh(Some(path), format, output, options).map(drop);
    }
    let copied = named_files(path, format, output)?;
    whole::write_whole_with(path, |writer| {
        write_checked(writer, format, output, options)
    })?;
    write_together(&copied)
}

/// Copies of the files that an OBJ or PLY file names, if it is a file.
fn named_files(
    path: &Path,
    format: Format,
    output: &Output<'_>,
) -> Result<Vec<WholeFile>, WriteError> {
    let is_device = std::fs::metadata(path).is_ok_and(|there| !there.is_file());
    match output.materials {
        Some(found) if matches!(format, Format::Obj | Format::Ply) && !is_device => {
            let files = found
                .files
                .iter()
                .map(|file| (file.as_path(), found.folder.join(file)));
            copies(files, path.parent().unwrap_or(Path::new("")))
        }
        _ => Ok(Vec::new()),
    }
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
    check(output, format, options)?;
    write_checked(writer, format, output, options)
}

fn write_checked(
    writer: &mut dyn Write,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    match format {
        Format::Obj => obj::write(writer, output)?,
        Format::Ply => match Split::of(output) {
            None => ply::write(writer, output, options.ascii)?,
            Some(split) => {
                let properties = split.properties(output);
                ply::write(writer, &split.output(output, &properties), options.ascii)?;
            }
        },
        Format::Stl => stl::write(writer, output, options.ascii)?,
        Format::Off => off::write(writer, output)?,
        Format::Gltf | Format::Glb => {
            whole::write_in_pieces(writer, &gltf::write_fresh(None, format, output, options)?)?;
        }
        Format::ThreeMf => {
            whole::write_in_pieces(
                writer,
                &threemf::write_fresh(output.surface, options.unit.unwrap_or_default())?,
            )?;
        }
    }
    Ok(writer.flush()?)
}

/// Checks that the parts of the output fit together and into the format.
pub(crate) fn check(
    output: &Output<'_>,
    format: Format,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let Triangles {
        positions,
        triangles,
    } = output.surface;
    let vertices = positions.len();
    let counts = [
        ("normals", output.vertex_normals().map(<[_]>::len)),
        ("colours", output.colours.map(<[_]>::len)),
        ("quality values", output.quality.map(<[_]>::len)),
    ];
    for (what, count) in counts {
        if let Some(count) = count.filter(|&count| count != vertices) {
            return Err(WriteError::AttributeCount {
                what,
                count,
                vertices,
            });
        }
    }
    for (what, count) in [("vertices", vertices), ("triangles", triangles.len())] {
        if count > u32::MAX as usize {
            return Err(WriteError::TooMany {
                what,
                count,
                limit: u32::MAX,
                format,
            });
        }
    }
    let named = [
        ("triangle", first_triangle_beyond(triangles, vertices)),
        (
            "crease tag",
            first_beyond(
                output.creases.iter().map(|tag| tag.vertices.as_slice()),
                vertices,
            ),
        ),
        (
            "corner tag",
            first_beyond(
                output
                    .corners
                    .iter()
                    .map(|tag| std::slice::from_ref(&tag.vertex)),
                vertices,
            ),
        ),
    ];
    for (what, beyond) in named {
        if let Some((index, vertex)) = beyond {
            return Err(WriteError::VertexOutOfRange {
                what,
                index,
                vertex,
                vertices,
            });
        }
    }
    if let Some(corners) = output.corner_normals {
        let (count, normals) = (corners.len(), output.normals.unwrap_or_default().len());
        if count != triangles.len() {
            return Err(WriteError::CornerNormals {
                count,
                triangles: triangles.len(),
            });
        }
        if normals > u32::MAX as usize {
            return Err(WriteError::TooMany {
                what: "normals",
                count: normals,
                limit: u32::MAX,
                format,
            });
        }
        if let Some((triangle, normal)) = first_triangle_beyond(corners, normals) {
            return Err(WriteError::NormalOutOfRange {
                triangle,
                normal,
                normals,
            });
        }
    }
    check_finite(
        "position",
        positions.as_flattened(),
        3,
        format,
        is_single(format, options),
    )?;
    if is_single(format, options) && !triangles.is_empty() {
        let is_left = |round: fn(f64) -> f64| {
            let at = |vertex: u32| positions[vertex as usize].map(round);
            triangles.iter().any(|&[a, b, c]| {
                let [a, b, c] = [a, b, c].map(at);
                a != b && b != c && c != a
            })
        };
        if !is_left(|x| f64::from(x as f32)) && is_left(|x| x) {
            return Err(WriteError::Rounded {
                triangles: triangles.len(),
                format,
            });
        }
    }
    if let Some(normals) = output.normals.filter(|_| format != Format::Stl) {
        check_finite(
            "normal",
            normals.as_flattened(),
            3,
            format,
            format == Format::Ply,
        )?;
    }
    if let Some(quality) = output.quality.filter(|_| format == Format::Ply) {
        check_finite("quality", quality, 1, format, false)?;
    }
    for channel in output
        .channels
        .iter()
        .filter(|channel| crate::holds(format, options, channel))
    {
        channel.check(vertices, 3 * triangles.len(), triangles.len())?;
        if channel.value_count() == 0 && vertices > 0 {
            return Err(WriteError::NoValues {
                name: channel.name.clone(),
            });
        }
    }
    let names = output
        .channels
        .iter()
        .flat_map(|channel| &channel.labels)
        .chain(output.material_libraries);
    let names = names.filter(|_| format == Format::Obj || format == Format::Stl && options.ascii);
    let pictures = output
        .texture_files
        .iter()
        .filter(|_| format == Format::Ply);
    if let Some(name) = names
        .chain(pictures)
        .find(|name| name.contains(['\n', '\r']))
    {
        return Err(WriteError::LineBreak { name: name.clone() });
    }
    if format == Format::Ply {
        property::check(output)
    } else {
        Ok(())
    }
}

/// Items that are checked together.
const CHECKED: usize = 1 << 12;

/// The first of `groups` that names a vertex that does not exist, and that vertex.
fn first_beyond<'g>(
    groups: impl Iterator<Item = &'g [u32]>,
    vertices: usize,
) -> Option<(usize, u32)> {
    groups
        .enumerate()
        .find_map(|(index, group)| Some((index, *group.iter().find(|&&v| v as usize >= vertices)?)))
}

/// The same of triangles.
fn first_triangle_beyond(triangles: &[[u32; 3]], vertices: usize) -> Option<(usize, u32)> {
    let index = first_failing(triangles, |triangle| {
        triangle.iter().all(|&v| (v as usize) < vertices)
    })?;
    triangles[index]
        .iter()
        .find(|&&v| v as usize >= vertices)
        .map(|&v| (index, v))
}

/// The number of the first item that fails.
fn first_failing<T: Sync>(items: &[T], passes: impl Fn(&T) -> bool + Sync + Send) -> Option<usize> {
    // No early end within some: then many are looked at in one step.
    let fails = |some: &[T]| !some.iter().fold(true, |all, item| all & passes(item));
    #[cfg(feature = "parallel")]
    let some = {
        use rayon::prelude::*;
        items.par_chunks(CHECKED).position_first(fails)
    };
    #[cfg(not(feature = "parallel"))]
    let some = items.chunks(CHECKED).position(fails);
    let start = CHECKED * some?;
    items[start..]
        .iter()
        .position(|item| !passes(item))
        .map(|at| start + at)
}

/// Refuses what the readers of files refuse: NaN and infinity, also where they come of rounding to `f32`.
fn check_finite(
    what: &'static str,
    values: &[f64],
    width: usize,
    format: Format,
    single: bool,
) -> Result<(), WriteError> {
    let fits = |v: f64| {
        if single {
            (v as f32).is_finite()
        } else {
            v.is_finite()
        }
    };
    match first_failing(values, |&v| fits(v)) {
        Some(i) => Err(WriteError::NotFinite {
            what,
            vertex: i / width,
            value: values[i],
            format,
        }),
        None => Ok(()),
    }
}
