//! Channels: the data that a mesh carries in addition to positions, such as texture coordinates,
//! colours, weights of skins, materials.
//!
//! A channel is a table of values and, for each element of its domain, the index of its value. Two
//! corners at one vertex have one value if their indices are equal; where they differ, the channel
//! has a *seam*.

use super::{FaceParts, Mesh, PolygonFaces, PolygonSoup};
use crate::error_messages;
use crate::index::HalfEdgeId;

/// The elements that have the values of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// The vertices.
    Vertex,
    /// The corners of the faces, face by face.
    Corner,
    /// The faces.
    Face,
}

/// The meaning of a channel's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Semantic {
    /// Places on a texture.
    TextureCoordinates,
    /// Red, green, blue and opacity, from 0 to 1.
    Colour,
    /// The weight of a skin's joint at a vertex.
    SkinWeight,
    /// The displacement of a morph target's vertex from the base's.
    Displacement,
    /// Numbers that name something: materials, groups, regions.
    Label,
    /// Any other meaning.
    Other,
}

impl Semantic {
    /// The usual interpolation of values of this kind.
    pub fn interpolation(self) -> Interpolation {
        match self {
            Self::TextureCoordinates => Interpolation::Smooth(SeamRule::Boundaries),
            Self::SkinWeight | Self::Displacement => Interpolation::Smooth(SeamRule::None),
            Self::Colour | Self::Other => Interpolation::Linear,
            Self::Label => Interpolation::Nearest,
        }
    }
}

/// The interpolation of values between those of the control mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Refined as positions are, by the scheme's masks and their limits; the rule decides along
    /// seams.
    Smooth(SeamRule),
    /// Linear over each control face.
    Linear,
    /// The value of the nearest corner of the control face, never blended.
    Nearest,
}

/// The places along seams where smooth channels keep their values: OpenSubdiv's face-varying modes.
/// A kept value is that of the control mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SeamRule {
    /// Nowhere: seams are smooth boundaries.
    None,
    /// At values that one face alone has.
    CornersOnly,
    /// As [`Self::CornersOnly`], and where more than two values meet at a vertex, or two and a
    /// sharp edge.
    CornersPlus1,
    /// As [`Self::CornersPlus1`], and where a seam ends or one of two values is kept.
    CornersPlus2,
    /// Along all seams and boundaries, which stay straight from vertex to vertex.
    #[default]
    Boundaries,
}

/// The storage of a channel's numbers in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Storage {
    /// In double precision, or as digits.
    #[default]
    Double,
    /// In single precision.
    Single,
    /// Unsigned bytes, 255 for 1: colours.
    Byte,
    /// Signed integers of 32 bits.
    Int32,
    /// Signed integers of 8 bits.
    Int8,
    /// Unsigned integers of 8 bits, 0 to 255.
    Uint8,
    /// Signed integers of 16 bits.
    Int16,
    /// Unsigned integers of 16 bits, 0 to 65,535; colours of 65,535 for 1.
    Uint16,
    /// Unsigned integers of 32 bits.
    Uint32,
}

/// Values on the elements of a mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Channel {
    /// Its name in the file.
    pub name: String,
    /// The meaning of the values.
    pub semantic: Semantic,
    /// The elements that have the values.
    pub domain: Domain,
    /// Numbers in a value.
    pub arity: usize,
    /// The values, one after the other.
    pub values: Vec<f64>,
    /// By element of the domain, the number of its value.
    pub indices: Vec<u32>,
    /// The interpolation between the values of the control mesh.
    pub interpolation: Interpolation,
    /// The storage in its file.
    pub storage: Storage,
    /// The name of each number where the values are [`Semantic::Label`]; empty where they have no
    /// names.
    pub labels: Vec<String>,
}

/// An error of a channel on its mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ChannelError {
    /// There are more or fewer indices than elements.
    Count {
        /// The channel.
        name: String,
        /// Indices.
        count: usize,
        /// Elements.
        expected: usize,
        /// The kind of element.
        elements: &'static str,
    },
    /// An index is out of the values' range.
    Index {
        /// The channel.
        name: String,
        /// The element.
        element: usize,
        /// Its index.
        index: u32,
        /// Values.
        count: usize,
    },
    /// A value is not finite, or the table ends within one.
    Value {
        /// The channel.
        name: String,
        /// The value.
        value: usize,
        /// The actual count.
        what: String,
        /// Numbers in a value.
        arity: usize,
    },
    /// The result's triangles do not know where on the control faces they are.
    Unknown {
        /// Why not.
        why: &'static str,
    },
    /// Limits of the channel could not be computed.
    Limit {
        /// The channel.
        name: String,
        /// Why not.
        why: String,
    },
}

error_messages! {
    ChannelError {
        Self::Count { name, count, expected, elements } => ("channel {name} has {count} indices for {expected} {elements}: each needs one"),
        Self::Index { name, element, index, count } => ("channel {name} has index {index} at element {element}, but there are {count} values"),
        Self::Value { name, value, what, arity } => ("value {value} of channel {name} is {what}; it must be {arity} finite numbers"),
        Self::Unknown { why } => ("{why}: channels are carried by triangles that each come from one control face, with origins"),
        Self::Limit { name, why } => ("channel {name}: {why}"),
    }
}

/// The faces and corners of a soup of which those of a mesh are made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Trace {
    /// By face of the mesh, the soup's face.
    pub faces: Vec<u32>,
    /// For each corner of the mesh, three a face, the soup's corner, counted over all its faces.
    /// Where a repair gave a face a corner that its polygon has not, it is a corner of another
    /// polygon at that vertex. For a corner that a step of subdivision put between others it is the
    /// first of these.
    pub corners: Vec<u32>,
    /// By corner of the mesh, the row of `rows` with all corners of the soup that it was put
    /// between; empty where there was no step.
    #[doc(hidden)]
    pub between: Vec<u32>,
    #[doc(hidden)]
    pub rows: PolygonFaces,
}

impl Trace {
    /// By corner of the mesh, its vertex in the soup.
    pub fn vertices(&self, soup: &PolygonSoup) -> Vec<u32> {
        self.corners
            .iter()
            .map(|&corner| soup.faces.corner(corner as usize))
            .collect()
    }

    /// By vertex of the soup, the mesh's, the first of copies; none where no face of it was kept.
    pub fn of_soup(&self, soup: &PolygonSoup, mesh: &Mesh) -> Vec<Option<u32>> {
        let mut vertices = vec![None; soup.positions.len()];
        let corners = mesh.triangles().as_flattened().iter().zip(&self.corners);
        for (place, (&own, &corner)) in corners.enumerate() {
            let row = self.between.get(place);
            if row.is_none_or(|&row| self.rows.get(row as usize).len() == 1) {
                vertices[soup.faces.corner(corner as usize) as usize].get_or_insert(own);
            }
        }
        vertices
    }
}

impl Channel {
    /// A channel with the usual interpolation for its meaning.
    pub fn new(name: impl Into<String>, semantic: Semantic, domain: Domain, arity: usize) -> Self {
        Self {
            name: name.into(),
            semantic,
            domain,
            arity,
            values: Vec::new(),
            indices: Vec::new(),
            interpolation: semantic.interpolation(),
            storage: Storage::default(),
            labels: Vec::new(),
        }
    }

    /// The channel with other values and indices.
    pub fn with(mut self, values: Vec<f64>, indices: Vec<u32>) -> Self {
        (self.values, self.indices) = (values, indices);
        self
    }

    /// The channel with another storage in files.
    pub fn stored(self, storage: Storage) -> Self {
        Self { storage, ..self }
    }

    /// The channel with another interpolation.
    pub fn interpolated(self, interpolation: Interpolation) -> Self {
        Self {
            interpolation,
            ..self
        }
    }

    /// The number of values of the table.
    pub fn value_count(&self) -> usize {
        self.values.len().checked_div(self.arity).unwrap_or(0)
    }

    /// The value of an element of the domain; empty if there is none.
    pub fn value(&self, element: usize) -> &[f64] {
        let index = self
            .indices
            .get(element)
            .map_or(usize::MAX, |&index| index as usize);
        let start = index.saturating_mul(self.arity);
        self.values
            .get(start..start.saturating_add(self.arity))
            .unwrap_or_default()
    }

    /// Whether all elements have one value.
    #[doc(hidden)]
    pub fn is_constant(&self) -> bool {
        (1..self.indices.len()).all(|element| self.value(element) == self.value(0))
    }

    /// Whether its values differ within a face.
    pub fn varies_within_faces(&self) -> bool {
        self.domain != Domain::Face && !self.is_constant()
    }

    /// Checks that the channel fits a mesh with these numbers of vertices, corners and faces.
    ///
    /// # Errors
    /// The first index or value that does not fit.
    pub fn check(&self, vertices: usize, corners: usize, faces: usize) -> Result<(), ChannelError> {
        let (expected, elements) = match self.domain {
            Domain::Vertex => (vertices, "vertices"),
            Domain::Corner => (corners, "corners"),
            Domain::Face => (faces, "faces"),
        };
        let name = || self.name.clone();
        if self.indices.len() != expected {
            return Err(ChannelError::Count {
                name: name(),
                count: self.indices.len(),
                expected,
                elements,
            });
        }
        let error = |value, what: String| ChannelError::Value {
            name: name(),
            value,
            what,
            arity: self.arity,
        };
        if self.arity == 0 || !self.values.len().is_multiple_of(self.arity) {
            let left = self.values.len().checked_rem(self.arity).unwrap_or(0);
            return Err(error(self.value_count(), format!("{left} numbers")));
        }
        if let Some(at) = self.values.iter().position(|x| !x.is_finite()) {
            return Err(error(at / self.arity, self.values[at].to_string()));
        }
        let count = self.value_count();
        match self
            .indices
            .iter()
            .position(|&index| index as usize >= count)
        {
            Some(element) => Err(ChannelError::Index {
                name: name(),
                element,
                index: self.indices[element],
                count,
            }),
            None => Ok(()),
        }
    }

    /// The soup's channel as one of the mesh's corners or faces. Equal values of corners at one
    /// vertex become one value, so that a seam is where values differ.
    ///
    /// # Errors
    /// The channel does not fit the soup.
    pub fn on_mesh(
        &self,
        soup: &PolygonSoup,
        mesh: &Mesh,
        trace: &Trace,
    ) -> Result<Self, ChannelError> {
        self.check(
            soup.positions.len(),
            soup.faces.corner_count(),
            soup.faces.len(),
        )?;
        let element = |corner: u32| match self.domain {
            Domain::Vertex => soup.faces.corner(corner as usize) as usize,
            _ => corner as usize,
        };
        if self.domain == Domain::Face {
            let indices = trace
                .faces
                .iter()
                .map(|&face| self.indices[face as usize])
                .collect();
            return Ok(Self {
                indices,
                ..self.clone()
            });
        }
        let index = |&corner: &u32| self.indices[element(corner)];
        let mut carried = Self {
            indices: trace.corners.iter().map(index).collect(),
            domain: Domain::Corner,
            ..self.clone()
        };
        if self.semantic != Semantic::Label && !trace.between.is_empty() {
            let rows = trace.rows.iter();
            let own: Vec<u32> = rows
                .map(|row| carried.mean(row.iter().map(index)))
                .collect();
            let between = trace.between.iter();
            carried.indices = between.map(|&row| own[row as usize]).collect();
        }
        Ok(if self.semantic == Semantic::Label {
            carried
        } else {
            carried.joined(mesh)
        })
    }

    /// The number of the mean of some values, which is added where they are not one.
    fn mean(&mut self, of: impl Iterator<Item = u32>) -> u32 {
        let mut of: Vec<u32> = of.collect();
        of.sort_unstable();
        if of.first() == of.last() {
            return of.first().copied().unwrap_or(0);
        }
        for at in 0..self.arity {
            let value = |&i: &u32| self.values[i as usize * self.arity + at];
            let sum: f64 = of.iter().map(value).sum();
            self.values.push(sum / of.len() as f64);
        }
        // The last one that is whole.
        (self.values.len() / self.arity) as u32 - 1
    }

    /// The channel with one value where corners at a vertex have equal ones.
    fn joined(self, mesh: &Mesh) -> Self {
        let mut values = Vec::with_capacity(self.values.len());
        let mut indices = vec![0; self.indices.len()];
        let mut met: Vec<u32> = Vec::new();
        for vertex in mesh.topology().vertices() {
            met.clear();
            for corner in mesh.topology().outgoing_ring(vertex) {
                let value = self.value(corner.index());
                let same = met.iter().copied().find(|&index| {
                    let start = index as usize * self.arity;
                    values[start..start + self.arity]
                        .iter()
                        .zip(value)
                        .all(|(a, b): (&f64, &f64)| a == b)
                });
                indices[corner.index()] = same.unwrap_or_else(|| {
                    let index = (values.len() / self.arity) as u32;
                    values.extend_from_slice(value);
                    met.push(index);
                    index
                });
            }
        }
        Self {
            values,
            indices,
            ..self
        }
    }

    /// The channel on a mesh whose faces are parts of the original's: linear inside the faces that
    /// were divided.
    pub fn on_parts(&self, parts: &FaceParts, mesh: &Mesh) -> Self {
        if parts.is_empty() {
            return self.clone();
        }
        let faces = mesh.face_count() as u32;
        if self.domain == Domain::Face {
            let indices = (0..faces)
                .map(|face| self.indices[parts.whole(face) as usize])
                .collect();
            return Self {
                indices,
                ..self.clone()
            };
        }
        let mut found = Self {
            indices: Vec::with_capacity(3 * faces as usize),
            ..self.clone()
        };
        for face in 0..faces {
            for corner in 0..3 {
                let unit = core::array::from_fn(|i| if i == corner { 1.0 } else { 0.0 });
                let (whole, weights) = parts.on_whole(face, unit);
                let own = |k: usize| self.indices[3 * whole as usize + k];
                let nearest = (0..3)
                    .max_by(|&a, &b| weights[a].total_cmp(&weights[b]))
                    .unwrap_or(0);
                if weights[nearest] == 1.0 || self.semantic == Semantic::Label {
                    found.indices.push(own(nearest));
                    continue;
                }
                let index = found.value_count() as u32;
                for i in 0..self.arity {
                    let number = |k: usize| self.values[own(k) as usize * self.arity + i];
                    found
                        .values
                        .push((0..3).map(|k| weights[k] * number(k)).sum());
                }
                found.indices.push(index);
            }
        }
        if self.semantic == Semantic::Label {
            found
        } else {
            found.joined(mesh)
        }
    }

    /// Whether the values at both ends of an edge are equal on both sides, for a channel of
    /// corners; the half-edge's twin is `twin`.
    #[doc(hidden)]
    pub fn is_continuous(&self, h: HalfEdgeId, twin: HalfEdgeId) -> bool {
        let index = |corner: HalfEdgeId| self.indices[corner.index()];
        index(h) == index(twin.next()) && index(h.next()) == index(twin)
    }
}
