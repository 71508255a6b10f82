//! Channels as numbers of a PLY file's vertices and faces: what `read::ply` makes channels of.

use std::sync::Arc;

use limitmesh::mesh::{Channel, Domain, Semantic, Storage};

use super::Output;
use super::numbers::Piece;
use super::split::is_of_vertices;
use crate::channels::{TEXTURE_LISTS, by_vertex};
use crate::format::Format;

/// One number of each element.
pub(super) struct Column<'a> {
    pub(super) name: String,
    storage: Storage,
    channel: &'a Channel,
    /// Which number of a value.
    part: usize,
    /// By element, its value.
    values: Arc<Vec<u32>>,
}

/// What an output's channels become.
#[derive(Default)]
pub(super) struct Columns<'a> {
    pub(super) vertices: Vec<Column<'a>>,
    pub(super) faces: Vec<Column<'a>>,
    /// Texture coordinates that a file had by corner, or with seams and no names of their own: a list for each face.
    pub(super) textures: Option<&'a Channel>,
}

impl<'a> Columns<'a> {
    /// Those of an output. Where a name is taken already, what has it is newer.
    pub(super) fn of(output: &Output<'a>) -> Self {
        let mut found = Self::default();
        let (vertices, triangles) = (output.surface.positions.len(), output.surface.triangles);
        for channel in output
            .channels
            .iter()
            .filter(|channel| crate::holds(Format::Ply, &Default::default(), channel))
        {
            if channel.domain == Domain::Face {
                let values = Arc::new(channel.indices.clone());
                let is_taken = |name: &str| {
                    output.face_properties.iter().any(|p| p.name == name)
                        || name == "vertex_indices"
                };
                add(&mut found.faces, channel, values, is_taken);
                continue;
            }
            let (values, torn) = by_vertex(channel, vertices, triangles);
            let is_by_corner =
                channel.domain == Domain::Corner && (torn > 0 || channel.name == TEXTURE_LISTS);
            if channel.semantic == Semantic::TextureCoordinates
                && is_by_corner
                && !is_of_vertices(channel)
            {
                found.textures = found.textures.or(Some(channel));
                continue;
            }
            let is_taken = |name: &str| {
                let has_colours =
                    output.colours.is_some() && ["red", "green", "blue"].contains(&name);
                let is_own = ["x", "y", "z", "nx", "ny", "nz"].contains(&name);
                let has_quality = output.quality.is_some() && name == "quality";
                has_colours
                    || is_own
                    || has_quality
                    || output.vertex_properties.iter().any(|p| p.name == name)
            };
            add(&mut found.vertices, channel, Arc::new(values), is_taken);
        }
        found
    }
}

fn add<'a>(
    columns: &mut Vec<Column<'a>>,
    channel: &'a Channel,
    values: Arc<Vec<u32>>,
    is_taken: impl Fn(&str) -> bool,
) {
    for (part, name) in names(channel).into_iter().enumerate() {
        if !is_taken(&name) && columns.iter().all(|column| column.name != name) {
            let storage = storage(channel);
            columns.push(Column {
                name,
                storage,
                channel,
                part,
                values: values.clone(),
            });
        }
    }
}

/// Names of a value's numbers: those that the channel has, or those that are usual.
fn names(channel: &Channel) -> Vec<String> {
    let visible = |name: &str| -> String {
        name.chars()
            .map(|c| if c.is_ascii_graphic() { c } else { '_' })
            .collect()
    };
    let own: Vec<String> = channel.name.split(',').map(visible).collect();
    if own.len() == channel.arity
        && own.iter().all(|name| !name.is_empty())
        && channel.semantic != Semantic::TextureCoordinates
    {
        return own;
    }
    let usual: &[&str] = match channel.semantic {
        Semantic::TextureCoordinates if own.len() == channel.arity => return own,
        Semantic::TextureCoordinates => &["s", "t", "r"],
        Semantic::Colour => &["red", "green", "blue", "alpha"],
        _ => &[],
    };
    let name = |part: usize| {
        usual.get(part).map_or_else(
            || format!("{}_{part}", visible(&channel.name)),
            |&name| name.to_owned(),
        )
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
    /// PLY's name of the numbers' type.
    pub(super) fn kind(&self) -> &'static str {
        match self.storage {
            Storage::Single => "float",
            Storage::Byte | Storage::Uint8 => "uchar",
            Storage::Int8 => "char",
            Storage::Int16 => "short",
            Storage::Uint16 => "ushort",
            Storage::Int32 => "int",
            Storage::Uint32 => "uint",
            _ => "double",
        }
    }

    /// An element's number, as the file holds it.
    #[inline]
    fn number(&self, element: usize) -> f64 {
        let number =
            self.channel.values[self.values[element] as usize * self.channel.arity + self.part];
        let unit = match self.storage {
            Storage::Byte => 255.0,
            Storage::Uint16 if self.channel.semantic == Semantic::Colour => 65535.0,
            _ => return number,
        };
        (unit * number.clamp(0.0, 1.0)).round()
    }

    /// Writes the little-endian bytes of an element's number.
    #[inline]
    pub(super) fn bytes(&self, out: &mut Piece, element: usize) {
        let number = self.number(element);
        match self.storage {
            Storage::Single => out.bytes(&(number as f32).to_le_bytes()),
            Storage::Byte | Storage::Uint8 => out.bytes(&[number as u8]),
            Storage::Int8 => out.bytes(&(number as i8).to_le_bytes()),
            Storage::Int16 => out.bytes(&(number as i16).to_le_bytes()),
            Storage::Uint16 => out.bytes(&(number as u16).to_le_bytes()),
            Storage::Int32 => out.bytes(&(number as i32).to_le_bytes()),
            Storage::Uint32 => out.bytes(&(number as u32).to_le_bytes()),
            _ => out.bytes(&number.to_le_bytes()),
        }
    }

    /// Writes an element's number as text, a blank before it.
    pub(super) fn text(&self, out: &mut Piece, element: usize) {
        let number = self.number(element);
        match self.storage {
            Storage::Single => out.single(number as f32),
            Storage::Byte => out.integer(number as u32),
            _ => out.number(number),
        }
    }
}

/// Writes the texture coordinates of a face's corners.
pub(super) fn textures(out: &mut Piece, channel: &Channel, face: usize, ascii: bool) {
    if ascii {
        out.integer(6);
    } else {
        out.bytes(&[6]);
    }
    for corner in 3 * face..3 * face + 3 {
        let value = channel.value(corner);
        for part in 0..2 {
            let number = value.get(part).copied().unwrap_or(0.0) as f32;
            if ascii {
                out.single(number)
            } else {
                out.bytes(&number.to_le_bytes())
            }
        }
    }
}
