//! Values of vertices and faces as numbers of a PLY file: `columns` makes channels of them.

use super::split::{Split, is_of_vertices};
use crate::capacity::{Capacity, Held};
use crate::channels::{TEXTURE_LISTS, by_vertex};
use crate::output::{Output, Property, PropertyValues};
use crate::pieces::Piece;
use limitmesh::mesh::{Channel, Domain, Semantic, Storage};
use std::sync::Arc;

/// The capacity of files.
pub(super) fn capacity() -> Capacity {
    let holds = |channel: &Channel| match channel.semantic {
        Semantic::TextureCoordinates => channel.domain != Domain::Face,
        Semantic::Label => channel.labels.is_empty(),
        _ => true,
    };
    Capacity {
        normals: Held::Single,
        properties: true,
        names_files: true,
        ..Capacity::of_channels(holds)
    }
}

/// One number of each element.
pub(super) struct Column<'a> {
    name: String,
    storage: Storage,
    values: Values<'a>,
}

enum Values<'a> {
    /// An axis of normals.
    Normals(&'a [[f64; 3]], usize),
    /// A part of colours.
    Colours(&'a [[u8; 3]], usize),
    Integers(&'a [u32]),
    Numbers(&'a [f64]),
    Channel {
        channel: &'a Channel,
        /// Which number of a value.
        part: usize,
        /// By element, its value.
        indices: Arc<Vec<u32>>,
    },
}

/// The columns of an output.
#[derive(Default)]
pub(super) struct Columns<'a> {
    pub(super) vertices: Vec<Column<'a>>,
    pub(super) faces: Vec<Column<'a>>,
    /// Texture coordinates that a file had by corner, or with seams and no names of their own: a list for each face.
    pub(super) textures: Option<&'a Channel>,
}

impl<'a> Columns<'a> {
    /// Those of an output, some of whose vertices may stand several times.
    pub(super) fn of(output: &Output<'a>, split: Option<&Split>) -> Self {
        let mut found = Self::default();
        let column = |name: &str, storage, values| Column {
            name: name.to_owned(),
            storage,
            values,
        };
        for (axis, name) in ["nx", "ny", "nz"].iter().enumerate() {
            let values = output.vertex_normals();
            let values = values.map(|all| Values::Normals(all, axis));
            found
                .vertices
                .extend(values.map(|own| column(name, Storage::Single, own)));
        }
        for (part, name) in ["red", "green", "blue"].iter().enumerate() {
            let values = output.colours.map(|all| Values::Colours(all, part));
            found
                .vertices
                .extend(values.map(|own| column(name, Storage::Uint8, own)));
        }
        let quality = output.quality.map(Values::Numbers);
        found
            .vertices
            .extend(quality.map(|own| column("quality", Storage::Double, own)));
        found
            .vertices
            .extend(output.vertex_properties.iter().map(property));
        found
            .faces
            .extend(output.face_properties.iter().map(property));
        for channel in capacity().held(output) {
            found.add(channel, output, split);
        }
        found
    }

    /// Adds a channel. Where a name is taken already, what has it is newer.
    fn add(&mut self, channel: &'a Channel, output: &Output<'a>, split: Option<&Split>) {
        if channel.domain == Domain::Face {
            return add(
                &mut self.faces,
                channel,
                channel.indices.clone(),
                &["vertex_indices"],
            );
        }
        let mut count = output.surface.positions.len();
        let mut triangles = output.surface.triangles;
        if let Some(Split {
            triangles: own,
            sources,
        }) = split
        {
            (count, triangles) = (sources.len(), own);
            if channel.domain == Domain::Vertex {
                let all = sources.iter().map(|&v| channel.indices[v as usize]);
                let indices = all.collect();
                return add(&mut self.vertices, channel, indices, &VERTEX_NAMES);
            }
        }
        let own = by_vertex(channel, count, triangles);
        let is_by_corner =
            channel.domain == Domain::Corner && (own.torn > 0 || channel.name == TEXTURE_LISTS);
        let is_texture = channel.semantic == Semantic::TextureCoordinates;
        if is_texture && is_by_corner && !is_of_vertices(channel) {
            self.textures = self.textures.or(Some(channel));
            return;
        }
        add(&mut self.vertices, channel, own.indices, &VERTEX_NAMES);
    }
}

/// Names that are those of positions and normals alone.
const VERTEX_NAMES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

fn add<'a>(columns: &mut Vec<Column<'a>>, channel: &'a Channel, indices: Vec<u32>, taken: &[&str]) {
    let (storage, indices) = (storage(channel), Arc::new(indices));
    for (part, name) in names(channel).into_iter().enumerate() {
        if !taken.contains(&name.as_str()) && columns.iter().all(|column| column.name != name) {
            let values = Values::Channel {
                channel,
                part,
                indices: indices.clone(),
            };
            columns.push(Column {
                name,
                storage,
                values,
            });
        }
    }
}

fn property<'a>(property: &Property<'a>) -> Column<'a> {
    let (storage, values) = match property.values {
        PropertyValues::Numbers(all) => (Storage::Double, Values::Numbers(all)),
        // Many readers know signed integers only.
        PropertyValues::Integers(all) if all.iter().all(|&v| v <= i32::MAX as u32) => {
            (Storage::Int32, Values::Integers(all))
        }
        PropertyValues::Integers(all) => (Storage::Uint32, Values::Integers(all)),
    };
    Column {
        name: property.name.to_owned(),
        storage,
        values,
    }
}

/// Names of a value's numbers: those that the channel has, or those that are usual.
fn names(channel: &Channel) -> Vec<String> {
    let graphic = |c: char| if c.is_ascii_graphic() { c } else { '_' };
    let visible = |name: &str| -> String { name.chars().map(graphic).collect() };
    let own: Vec<String> = channel.name.split(',').map(visible).collect();
    let is_texture = channel.semantic == Semantic::TextureCoordinates;
    if own.len() == channel.arity && (is_texture || own.iter().all(|name| !name.is_empty())) {
        return own;
    }
    let usual: &[&str] = match channel.semantic {
        Semantic::TextureCoordinates => &["s", "t", "r"],
        Semantic::Colour => &["red", "green", "blue", "alpha"],
        _ => &[],
    };
    let name = |part: usize| match usual.get(part) {
        Some(&name) => name.to_owned(),
        None => format!("{}_{part}", visible(&channel.name)),
    };
    (0..channel.arity).map(name).collect()
}

/// The type that holds all numbers of a channel: its file's, or a wider one.
fn storage(channel: &Channel) -> Storage {
    let is_whole = |x: &f64, [low, high]: [f64; 2]| x.fract() == 0.0 && (low..=high).contains(x);
    let is_colour = channel.semantic == Semantic::Colour;
    match (channel.storage, range(channel.storage)) {
        // Other programs know colours as bytes.
        (Storage::Double, _) if is_colour => Storage::Byte,
        (Storage::Uint16, _) if is_colour => Storage::Uint16,
        (_, Some(range)) if !channel.values.iter().all(|x| is_whole(x, range)) => Storage::Double,
        (storage, _) => storage,
    }
}

/// The least and the greatest number of a type of whole numbers.
fn range(storage: Storage) -> Option<[f64; 2]> {
    Some(match storage {
        Storage::Int8 => [f64::from(i8::MIN), f64::from(i8::MAX)],
        Storage::Uint8 => [0.0, f64::from(u8::MAX)],
        Storage::Int16 => [f64::from(i16::MIN), f64::from(i16::MAX)],
        Storage::Uint16 => [0.0, f64::from(u16::MAX)],
        Storage::Int32 => [f64::from(i32::MIN), f64::from(i32::MAX)],
        Storage::Uint32 => [0.0, f64::from(u32::MAX)],
        _ => return None,
    })
}

impl Column<'_> {
    /// The line of the header that declares it.
    pub(super) fn declaration(&self) -> String {
        let kind = match self.storage {
            Storage::Single => "float",
            Storage::Byte | Storage::Uint8 => "uchar",
            Storage::Int8 => "char",
            Storage::Int16 => "short",
            Storage::Uint16 => "ushort",
            Storage::Int32 => "int",
            Storage::Uint32 => "uint",
            _ => "double",
        };
        format!("property {kind} {}\n", self.name)
    }

    /// An element's number, as the file holds it; of a vertex, `source` is the one that it is a copy of.
    #[inline]
    fn number(&self, element: usize, source: usize) -> f64 {
        let (channel, part, indices) = match &self.values {
            Values::Normals(all, axis) => return all[source][*axis],
            Values::Colours(all, part) => return f64::from(all[source][*part]),
            Values::Integers(all) => return f64::from(all[source]),
            Values::Numbers(all) => return all[source],
            Values::Channel {
                channel,
                part,
                indices,
            } => (channel, part, indices),
        };
        let number = channel.values[indices[element] as usize * channel.arity + part];
        let unit = match self.storage {
            Storage::Byte => 255.0,
            Storage::Uint16 if channel.semantic == Semantic::Colour => 65535.0,
            _ => return number,
        };
        (unit * number.clamp(0.0, 1.0)).round()
    }

    /// Writes an element's number: as text with a blank before it, or its little-endian bytes.
    #[inline]
    pub(super) fn write(&self, out: &mut Piece, element: usize, source: usize, ascii: bool) {
        let number = self.number(element, source);
        match self.storage {
            Storage::Single => single(out, number as f32, ascii),
            Storage::Byte | Storage::Uint8 if ascii => out.integer(number as u32),
            _ if ascii => out.number(number),
            Storage::Byte | Storage::Uint8 => out.bytes(&[number as u8]),
            Storage::Int8 => out.bytes(&(number as i8).to_le_bytes()),
            Storage::Int16 => out.bytes(&(number as i16).to_le_bytes()),
            Storage::Uint16 => out.bytes(&(number as u16).to_le_bytes()),
            Storage::Int32 => out.bytes(&(number as i32).to_le_bytes()),
            Storage::Uint32 => out.bytes(&(number as u32).to_le_bytes()),
            _ => out.bytes(&number.to_le_bytes()),
        }
    }
}

/// Writes a number of `f32`.
pub(super) fn single(out: &mut Piece, number: f32, ascii: bool) {
    match ascii {
        true => out.single(number),
        false => out.bytes(&number.to_le_bytes()),
    }
}
