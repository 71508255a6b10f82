//! Properties of the vertices and faces of a PLY file, apart from positions and indices: one number each, or a list of texture coordinates.
//!
//! Numbers that belong together by their names become one channel: `s, t`, `u, v` or `texture_u, texture_v`, and `red, green, blue`
//! with `alpha`, whose bytes are parts of 1; `nx, ny, nz` say where edges were meant to be sharp. Of the others, whole numbers name something, and floating-point ones are interpolated.

use super::header::{Element, Kind, NORMALS, Scalar};
use crate::channels::{self, TEXTURE_LISTS};
use crate::reading::by_element;
use limitmesh::mesh::{Channel, Domain, PolygonFaces, PolygonSoup, Semantic, Storage};

/// Names of numbers that are one value together.
const GROUPS: [(&[&str], Semantic); 7] = [
    (&NORMALS, Semantic::Other),
    (&["s", "t"], Semantic::TextureCoordinates),
    (&["u", "v"], Semantic::TextureCoordinates),
    (&["texture_u", "texture_v"], Semantic::TextureCoordinates),
    (&["red", "green", "blue", "alpha"], Semantic::Colour),
    (&["red", "green", "blue"], Semantic::Colour),
    (&["r", "g", "b"], Semantic::Colour),
];

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
        let is_scalar = |at: usize| matches!(element.properties[at].kind, Kind::Scalar(_));
        let has_normals = element.name == "vertex"
            && NORMALS
                .iter()
                .all(|name| element.find(&[name]).is_some_and(is_scalar));
        for property in &element.properties {
            let name = property.name.as_str();
            let is_passed_over =
                ["x", "y", "z"].contains(&name) || NORMALS.contains(&name) && !has_normals;
            let Kind::Scalar(scalar) = property.kind else {
                of_property.push(None);
                continue;
            };
            of_property.push((!is_passed_over).then_some(columns.len()));
            if !is_passed_over {
                let name = name.to_owned();
                columns.push(Column {
                    name,
                    scalar,
                    values: Vec::new(),
                });
            }
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

    /// Adds the channels of all elements to a soup, and the names of those whose numbers are not all finite to what is left out.
    pub(super) fn add_to(self, element: &Element, soup: &mut PolygonSoup) {
        let domain = if element.name == "vertex" {
            Domain::Vertex
        } else {
            Domain::Face
        };
        let is_normal = |own: &Column| NORMALS.contains(&own.name.as_str());
        let is_whole = |own: &Column| {
            own.values.len() == element.count && own.values.iter().all(|x| x.is_finite())
        };
        let (mut columns, lost): (Vec<_>, Vec<_>) = self.columns.into_iter().partition(is_whole);
        let lost = lost.into_iter().filter(|own| !is_normal(own));
        let lost: Vec<String> = lost.map(|own| own.name).collect();
        if !lost.is_empty() {
            let (element, lost) = (&element.name, lost.join(", "));
            soup.left_out
                .push(format!("{element} properties {lost} (not all finite)"));
        }
        for (names, semantic) in GROUPS {
            if let Some(channel) = group(&columns, names, semantic, domain) {
                soup.channels.push(channel);
                columns.retain(|own| !names.contains(&own.name.as_str()));
            }
        }
        for Column {
            name,
            scalar,
            values,
        } in columns.into_iter().filter(|own| !is_normal(own))
        {
            let semantic = if scalar.is_integer() {
                Semantic::Label
            } else {
                Semantic::Other
            };
            let channel = by_element(name, semantic, domain, 1, values);
            soup.channels.push(channel.stored(scalar.storage()));
        }
    }
}

/// The channel of the numbers of these names, if there is a column of each.
fn group(
    columns: &[Column],
    names: &[&str],
    semantic: Semantic,
    domain: Domain,
) -> Option<Channel> {
    let find = |name: &&str| columns.iter().find(|column| column.name == *name);
    let own: Vec<&Column> = names.iter().map(find).collect::<Option<_>>()?;
    let scale = |column: &Column| match (semantic, column.scalar) {
        (Semantic::Colour, Scalar::U8) => 255.0,
        (Semantic::Colour, Scalar::U16) => 65535.0,
        _ => 1.0,
    };
    let count = own[0].values.len();
    let mut values = Vec::with_capacity(names.len() * count);
    for element in 0..count {
        values.extend(
            own.iter()
                .map(|column| column.values[element] / scale(column)),
        );
    }
    let is_normals = names == NORMALS;
    let storage = match own[0].scalar {
        _ if is_normals => Storage::Single,
        Scalar::U8 if semantic == Semantic::Colour => Storage::Byte,
        scalar => scalar.storage(),
    };
    let name = if is_normals {
        channels::NORMALS.to_owned()
    } else {
        names.join(",")
    };
    let channel = by_element(name, semantic, domain, names.len(), values);
    Some(channel.stored(storage))
}

/// Lists of texture coordinates by corner, as they are read face by face.
#[derive(Default)]
pub(super) struct CornerTextures {
    pub(super) values: Vec<f64>,
    /// By face, where its list ends.
    pub(super) ends: Vec<usize>,
}

impl CornerTextures {
    /// The channel, if every face has two finite numbers for each corner, and there are faces.
    pub(super) fn channel(self, faces: &PolygonFaces) -> Option<Channel> {
        let mut start = 0;
        let mut fits = |(&end, face): (&usize, &[u32])| {
            std::mem::replace(&mut start, end) + 2 * face.len() == end
        };
        let fit = self.ends.iter().zip(faces.iter()).all(&mut fits);
        if !fit || self.values.is_empty() || !self.values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let semantic = Semantic::TextureCoordinates;
        let channel = by_element(TEXTURE_LISTS, semantic, Domain::Corner, 2, self.values);
        Some(channel.stored(Storage::Single))
    }
}
