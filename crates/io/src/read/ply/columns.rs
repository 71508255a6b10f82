//! What a PLY file's vertices and faces have beside positions and indices: one number each, or a list of texture coordinates.
//!
//! Numbers that belong together by their names become one channel: `s, t`, `u, v` or `texture_u, texture_v`, and `red, green, blue`
//! with `alpha`, whose bytes stand for 0 to 1; `nx, ny, nz` say where edges were meant to be sharp. Of the others, whole numbers name something, and floating-point ones are interpolated.

use limitmesh::mesh::{Channel, Domain, Semantic, Storage};

use super::header::{Element, Kind, Scalar};
use crate::channels::TEXTURE_LISTS;

/// Names of numbers that are one value together.
const GROUPS: [(&[&str], Semantic); 6] = [
    (&["s", "t"], Semantic::TextureCoordinates),
    (&["u", "v"], Semantic::TextureCoordinates),
    (&["texture_u", "texture_v"], Semantic::TextureCoordinates),
    (&["red", "green", "blue", "alpha"], Semantic::Colour),
    (&["red", "green", "blue"], Semantic::Colour),
    (&["r", "g", "b"], Semantic::Colour),
];

/// What is not carried.
const PASSED_OVER: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// What says where edges were meant to be sharp.
const NORMALS: [&str; 3] = ["nx", "ny", "nz"];

/// The numbers of an element that are kept, as they are read.
pub(super) struct Columns {
    /// By property, the column it fills.
    of_property: Vec<Option<usize>>,
    columns: Vec<Column>,
}

struct Column {
    name: String,
    scalar: Scalar,
    values: Vec<f64>,
}

impl Columns {
    /// Those of an element's single numbers.
    pub(super) fn of(element: &Element) -> Self {
        let (mut of_property, mut columns) = (Vec::new(), Vec::new());
        let is_scalar = |&at: &usize| matches!(element.properties[at].kind, Kind::Scalar(_));
        let has_normals = element.name == "vertex"
            && NORMALS
                .iter()
                .all(|name| element.find(&[name]).as_ref().is_some_and(is_scalar));
        let is_passed_over =
            |name: &str| PASSED_OVER.contains(&name) && !(has_normals && NORMALS.contains(&name));
        for property in &element.properties {
            let kept = match property.kind {
                Kind::Scalar(scalar) if !is_passed_over(&property.name) => Some(scalar),
                _ => None,
            };
            of_property.push(kept.map(|_| columns.len()));
            columns.extend(kept.map(|scalar| Column {
                name: property.name.clone(),
                scalar,
                values: Vec::new(),
            }));
        }
        Self {
            of_property,
            columns,
        }
    }

    /// Whether the numbers of a property are kept.
    #[inline]
    pub(super) fn has(&self, property: usize) -> bool {
        self.of_property[property].is_some()
    }

    /// Adds an element's number.
    #[inline]
    pub(super) fn push(&mut self, property: usize, value: f64) {
        if let Some(column) = self.of_property[property] {
            self.columns[column].values.push(value);
        }
    }

    /// The channels of so many elements; gives the names of those whose numbers are not all finite, too.
    pub(super) fn channels(mut self, domain: Domain, count: usize) -> (Vec<Channel>, Vec<String>) {
        let (mut found, mut lost) = (Vec::new(), Vec::new());
        self.columns.retain(|column| {
            let is_whole =
                column.values.len() == count && column.values.iter().all(|x| x.is_finite());
            if !is_whole && !NORMALS.contains(&column.name.as_str()) {
                lost.push(column.name.clone());
            }
            is_whole
        });
        let mut columns = self.columns;
        found.extend(normals(&mut columns, domain, count));
        for (names, semantic) in GROUPS {
            let place = |name: &&str| columns.iter().position(|column| column.name == *name);
            let Some(places) = names.iter().map(place).collect::<Option<Vec<usize>>>() else {
                continue;
            };
            let scale = |column: &Column| match (semantic, column.scalar) {
                (Semantic::Colour, Scalar::U8) => 255.0,
                (Semantic::Colour, Scalar::U16) => 65535.0,
                _ => 1.0,
            };
            let mut values = Vec::with_capacity(names.len() * count);
            for element in 0..count {
                values.extend(
                    places
                        .iter()
                        .map(|&at| columns[at].values[element] / scale(&columns[at])),
                );
            }
            let storage = match columns[places[0]].scalar {
                Scalar::U8 if semantic == Semantic::Colour => Storage::Byte,
                scalar => storage(scalar),
            };
            let channel =
                Channel::new(names.join(","), semantic, domain, names.len()).stored(storage);
            found.push(channel.with(values, (0..count as u32).collect()));
            columns.retain(|column| !names.contains(&column.name.as_str()));
        }
        for Column {
            name,
            scalar,
            values,
        } in columns
        {
            let semantic = if scalar.is_integer() {
                Semantic::Label
            } else {
                Semantic::Other
            };
            let channel = Channel::new(name, semantic, domain, 1).stored(storage(scalar));
            found.push(channel.with(values, (0..count as u32).collect()));
        }
        (found, lost)
    }
}

/// The channel of normals, if all three numbers are there; then none of them is in the columns any more.
fn normals(columns: &mut Vec<Column>, domain: Domain, count: usize) -> Option<Channel> {
    let places = NORMALS.map(|name| columns.iter().position(|column| column.name == name));
    let found = places
        .iter()
        .copied()
        .collect::<Option<Vec<usize>>>()
        .map(|places| {
            let values = (0..count).flat_map(|element| places.iter().map(move |&at| (at, element)));
            let values = values
                .map(|(at, element)| columns[at].values[element])
                .collect();
            let channel = Channel::new(crate::channels::NORMALS, Semantic::Other, domain, 3);
            channel
                .stored(Storage::Single)
                .with(values, (0..count as u32).collect())
        });
    columns.retain(|column| !NORMALS.contains(&column.name.as_str()));
    found
}

fn storage(scalar: Scalar) -> Storage {
    match scalar {
        Scalar::F64 => Storage::Double,
        Scalar::F32 => Storage::Single,
        Scalar::I8 => Storage::Int8,
        Scalar::U8 => Storage::Uint8,
        Scalar::I16 => Storage::Int16,
        Scalar::U16 => Storage::Uint16,
        Scalar::I32 => Storage::Int32,
        Scalar::U32 => Storage::Uint32,
    }
}

/// Texture coordinates by corner, as they are read face by face.
#[derive(Default)]
pub(super) struct CornerTextures {
    values: Vec<f64>,
    indices: Vec<u32>,
    is_wrong: bool,
}

impl CornerTextures {
    /// A face's list, and how many corners it has.
    pub(super) fn face(&mut self, list: &[f64], corners: usize) {
        if list.len() != 2 * corners || !list.iter().all(|x| x.is_finite()) {
            self.is_wrong = true;
            return;
        }
        for place in list.as_chunks::<2>().0 {
            // Corners that follow each other often share a place.
            self.indices.push(self.values.len() as u32 / 2);
            self.values.extend(place);
        }
    }

    /// The channel, if every face had a place for each corner.
    pub(super) fn channel(self) -> Option<Channel> {
        let Self {
            values,
            indices,
            is_wrong,
        } = self;
        let channel = Channel::new(
            TEXTURE_LISTS,
            Semantic::TextureCoordinates,
            Domain::Corner,
            2,
        );
        let channel = channel.stored(Storage::Single);
        (!is_wrong && !indices.is_empty()).then(|| channel.with(values, indices))
    }
}
