//! Why a file could not be read or written.

use crate::flaw::Flaw;
use crate::format::{Format, UnknownFormat};
use std::io;
use std::path::{Path, PathBuf};

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The extension is none of the known ones.
    #[error(transparent)]
    UnknownFormat(#[from] UnknownFormat),
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
}

impl ReadError {
    /// Adds the file's name.
    pub(crate) fn in_file(mut self, file: &Path) -> Self {
        match &mut self {
            Self::Empty { path, .. }
            | Self::OtherContent { path, .. }
            | Self::Flaw { path, .. } => {
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

impl Flaw {
    /// The error of a file in a format.
    pub(crate) fn read_as(self, format: Format) -> ReadError {
        ReadError::Flaw {
            path: None,
            format,
            flaw: self,
        }
    }
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The extension is none of the known ones.
    #[error(transparent)]
    UnknownFormat(#[from] UnknownFormat),
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
        #[from]
        reason: io::Error,
    },
    /// There is not one of something for each element.
    #[error("there are {count} {what} for {elements} {of}: each needs one")]
    Count {
        /// Of what, such as `normals`.
        what: String,
        /// How many there are.
        count: usize,
        /// Number of elements.
        elements: usize,
        /// `vertices` or `triangles`.
        of: &'static str,
    },
    /// A channel has no value at all, and there are vertices.
    #[error("channel {name} has no values")]
    NoValues {
        /// The channel.
        name: String,
    },
    /// A name would end its line in the file.
    #[error("the name {name:?} has a line break, which {format} files cannot hold")]
    LineBreak {
        /// The name.
        name: String,
        /// The format.
        format: Format,
    },
    /// A channel does not fit the triangles.
    #[error(transparent)]
    Channel(#[from] limitmesh::mesh::ChannelError),
    /// A property's name is empty, has other than visible ASCII characters, or is there twice.
    #[error("property '{name}' needs a name of visible ASCII characters that nothing else has")]
    PropertyName {
        /// The name.
        name: String,
    },
    /// Something names a vertex or a normal that does not exist.
    #[error("{what} {index} names {of} {named}, but there are {count}")]
    OutOfRange {
        /// What names it: `triangle`, `crease tag` or `corner tag`.
        what: &'static str,
        /// Which one, counted from 0.
        index: usize,
        /// `vertex` or `normal`.
        of: &'static str,
        /// The one that is named.
        named: u32,
        /// How many there are.
        count: usize,
    },
    /// A number is NaN or infinite, or too large for the format's `f32`.
    #[error("{what} of {of} {element} is {value}: {format} files hold finite numbers only")]
    NotFinite {
        /// Which number, such as `position`.
        what: String,
        /// `vertex` or `triangle`.
        of: &'static str,
        /// Which vertex or triangle.
        element: usize,
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
    /// A document cannot be put together.
    #[error("{format} {flaw}")]
    Flaw {
        /// The format.
        format: Format,
        /// What is wrong, and where.
        flaw: Flaw,
    },
}

impl From<Flaw> for WriteError {
    /// Documents that flaws are met in while they are written are glTF.
    fn from(flaw: Flaw) -> Self {
        Self::Flaw {
            format: Format::Gltf,
            flaw,
        }
    }
}

impl WriteError {
    /// Adds the file's name to an error of input and output.
    pub(crate) fn in_file(self, path: &Path) -> Self {
        match self {
            Self::Writer { reason } => Self::File {
                path: path.to_owned(),
                reason,
            },
            other => other,
        }
    }

    /// The error of a file that the system refuses.
    pub(crate) fn of(path: &Path) -> impl Fn(io::Error) -> Self {
        |reason| Self::File {
            path: path.to_owned(),
            reason,
        }
    }
}
