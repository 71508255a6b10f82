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
        /// The system's error.
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
        /// The format that it seems to have.
        looks_like: &'static str,
    },
    /// Something in the content breaks the rules of the format.
    #[error("{}{format} {flaw}", prefix(path))]
    Flaw {
        /// The file, if it was one.
        path: Option<PathBuf>,
        /// The format.
        format: Format,
        /// The problem, and its place.
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
        /// The system's error.
        reason: io::Error,
    },
    /// The writer that was given failed.
    #[error("cannot write: {reason}")]
    Writer {
        /// Its message.
        #[from]
        reason: io::Error,
    },
    /// The output does not fit together, or not into the format.
    #[error("{problem}")]
    Unfit {
        /// The problem, in words.
        problem: String,
    },
}

impl From<Flaw> for WriteError {
    /// Documents that flaws are met in while they are written are glTF.
    fn from(flaw: Flaw) -> Self {
        let problem = format!("{} {flaw}", Format::Gltf);
        Self::Unfit { problem }
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
