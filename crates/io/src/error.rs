//! What can go wrong with a file, and where.

use crate::format::{Format, UnknownFormat};
use crate::gltf::GltfFlaw;
use crate::threemf::PackageFlaw;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The extension is none of the known ones.
    #[error("{0}")]
    UnknownFormat(UnknownFormat),
    /// The system refused: no such file, a folder, no permission.
    #[error("cannot read {}: {reason}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// There is not a single byte.
    #[error("{}the file is empty", prefix(path))]
    Empty {
        /// The file, if it was one.
        path: Option<PathBuf>,
        /// The format it is named as.
        format: Format,
    },
    /// The content is plainly of another kind than the name says.
    #[error(
        "{}named as {format}, but the content looks like {looks_like}",
        prefix(path)
    )]
    OtherContent {
        /// The file, if it was one.
        path: Option<PathBuf>,
        /// The format it is named as.
        format: Format,
        /// What it seems to be.
        looks_like: &'static str,
    },
    /// Something in the content breaks the rules of the format.
    #[error("{}{format} {flaw}", prefix(path))]
    Flaw {
        /// The file, if it was one.
        path: Option<PathBuf>,
        /// The format.
        format: Format,
        /// What is wrong, and where.
        flaw: Flaw,
    },
    /// Something in a glTF document breaks its rules.
    #[error("{}glTF {flaw}", prefix(path))]
    Gltf {
        /// The file, if it was one.
        path: Option<PathBuf>,
        /// What is wrong, and where.
        flaw: GltfFlaw,
    },
    /// Something in a 3MF package breaks its rules.
    #[error("{}3MF {flaw}", prefix(path))]
    Package {
        /// The file, if it was one.
        path: Option<PathBuf>,
        /// What is wrong, and where.
        flaw: Box<PackageFlaw>,
    },
}

impl From<UnknownFormat> for ReadError {
    fn from(unknown: UnknownFormat) -> Self {
        Self::UnknownFormat(unknown)
    }
}

impl ReadError {
    /// The same error with the file's name.
    pub(crate) fn in_file(mut self, file: &Path) -> Self {
        match &mut self {
            Self::Empty { path, .. }
            | Self::OtherContent { path, .. }
            | Self::Flaw { path, .. }
            | Self::Gltf { path, .. }
            | Self::Package { path, .. } => {
                *path = Some(file.to_owned());
            }
            Self::UnknownFormat(_) | Self::Io { .. } => {}
        }
        self
    }
}

fn prefix(path: &Option<PathBuf>) -> String {
    path.as_ref()
        .map_or_else(String::new, |path| format!("{}: ", path.display()))
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(out, "line {line}"),
            Self::Byte(byte) => write!(out, "byte {byte}"),
        }
    }
}

/// Something that breaks the rules of a format.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Flaw {
    /// Where.
    pub place: Place,
    /// The element there, such as `vertex 5`, counted from 0; empty outside elements.
    pub element: String,
    /// What is wrong, in words.
    pub problem: String,
}

/// What is wrong where something else was found than a format asks for.
pub(crate) fn expected_but_found(expected: &str, found: &str) -> String {
    format!("expected {expected}, found {found}")
}

impl Flaw {
    /// Something was found where the format asks for something else.
    pub(crate) fn new(place: Place, found: impl AsRef<str>, expected: impl AsRef<str>) -> Self {
        Self::saying(place, expected_but_found(expected.as_ref(), found.as_ref()))
    }

    /// A problem in words.
    pub(crate) fn saying(place: Place, problem: impl Into<String>) -> Self {
        Self {
            place,
            element: String::new(),
            problem: problem.into(),
        }
    }

    /// The same flaw with the element it is in.
    pub(crate) fn element(mut self, name: &str, index: usize) -> Self {
        self.element = format!("{name} {index}");
        self
    }

    pub(crate) fn in_format(self, format: Format) -> ReadError {
        ReadError::Flaw {
            path: None,
            format,
            flaw: self,
        }
    }
}

impl fmt::Display for Flaw {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.place)?;
        if !self.element.is_empty() {
            write!(out, ", {}", self.element)?;
        }
        write!(out, ": {}", self.problem)
    }
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The extension is none of the known ones.
    #[error("{0}")]
    UnknownFormat(UnknownFormat),
    /// The system refused: no such folder, no permission, no space.
    #[error("cannot write {}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// The writer that was given failed.
    #[error("cannot write: {reason}")]
    Writer {
        /// What it says.
        reason: io::Error,
    },
    /// There is not one attribute for each vertex.
    #[error("there are {count} {what} for {vertices} vertices: each vertex needs one")]
    AttributeCount {
        /// Which attribute.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A channel has no value at all, and there are vertices.
    #[error("channel {name} has no values")]
    NoValues {
        /// The channel.
        name: String,
    },
    /// A name would end its line in an OBJ file.
    #[error("the name {name:?} has a line break, which OBJ files cannot hold")]
    LineBreak {
        /// The name.
        name: String,
    },
    /// A channel does not fit the triangles.
    #[error(transparent)]
    Channel(#[from] limitmesh::mesh::ChannelError),
    /// There are not three corner normals for each triangle.
    #[error(
        "there are corner normals of {count} triangles for {triangles}: each triangle needs three"
    )]
    CornerNormals {
        /// Triangles that have some.
        count: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// A corner has a normal that does not exist.
    #[error("triangle {triangle} has normal {normal}, but there are {normals}")]
    NormalOutOfRange {
        /// The triangle at fault.
        triangle: usize,
        /// The index met.
        normal: u32,
        /// Number of normals.
        normals: usize,
    },
    /// A property's name is empty, has other than visible ASCII characters, or is there twice.
    #[error("property '{name}' needs a name of visible ASCII characters that nothing else has")]
    PropertyName {
        /// The name.
        name: String,
    },
    /// A property does not have one number for each element.
    #[error("property '{name}' has {count} numbers for {elements} {what}: each needs one")]
    PropertyCount {
        /// The property's name.
        name: String,
        /// How many numbers there are.
        count: usize,
        /// Number of vertices or triangles.
        elements: usize,
        /// `vertices` or `triangles`.
        what: &'static str,
    },
    /// A property is NaN or infinite somewhere.
    #[error(
        "property '{name}' of element {element} is {value}: {format} files hold finite numbers only"
    )]
    PropertyNotFinite {
        /// The property's name.
        name: String,
        /// The vertex or triangle.
        element: usize,
        /// The value.
        value: f64,
        /// The format.
        format: Format,
    },
    /// A triangle or a tag names a vertex that does not exist.
    #[error("{what} {index} names vertex {vertex}, but there are {vertices} vertices")]
    VertexOutOfRange {
        /// What names it: `triangle`, `crease tag` or `corner tag`.
        what: &'static str,
        /// Which one, counted from 0.
        index: usize,
        /// The vertex named.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A number is NaN or infinite, or too large for the format's `f32`.
    #[error("{what} of vertex {vertex} is {value}: {format} files hold finite numbers only")]
    NotFinite {
        /// Which number: `position`, `normal` or `quality`.
        what: &'static str,
        /// The vertex.
        vertex: usize,
        /// The value.
        value: f64,
        /// The format.
        format: Format,
    },
    /// Rounded to the format's `f32`, no triangle is left.
    #[error(
        "{format} files round coordinates so much that none of {triangles} triangles keeps three different corners: coordinates must \
         differ by more than a ten millionth of the greatest, and by more than 1e-45; PLY, OBJ and OFF files hold them as they are"
    )]
    Rounded {
        /// Number of triangles.
        triangles: usize,
        /// The format.
        format: Format,
    },
    /// More elements than the format can count.
    #[error("{count} {what} are too many for {format} files, which count to {limit}")]
    TooMany {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: u32,
        /// The format.
        format: Format,
    },
    /// A glTF document cannot be put together.
    #[error("glTF {flaw}")]
    Gltf {
        /// What is wrong, and where.
        flaw: GltfFlaw,
    },
}

impl From<UnknownFormat> for WriteError {
    fn from(unknown: UnknownFormat) -> Self {
        Self::UnknownFormat(unknown)
    }
}

impl From<io::Error> for WriteError {
    fn from(reason: io::Error) -> Self {
        Self::Writer { reason }
    }
}

impl WriteError {
    /// The same error with the file's name, if it is one of input and output.
    pub(crate) fn in_file(self, path: &Path) -> Self {
        match self {
            Self::Writer { reason } => Self::File {
                path: path.to_owned(),
                reason,
            },
            other => other,
        }
    }
}
