//! The file formats by name.

use std::fmt;
use std::path::{Path, PathBuf};

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Wavefront OBJ, with OpenSubdiv's `t crease` and `t corner` tags.
    Obj,
    /// Stanford PLY, ASCII or binary.
    Ply,
    /// Stereolithography STL, ASCII or binary.
    Stl,
    /// Geomview OFF, ASCII.
    Off,
    /// glTF 2.0 as JSON text, with files in the same folder.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// 3MF: a ZIP archive of XML models.
    ThreeMf,
}

/// A file name whose extension is none of the formats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFormat {
    /// The file.
    pub path: PathBuf,
}

impl fmt::Display for UnknownFormat {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match self.path.extension() {
            Some(own) => write!(out, "{path}: the extension '{}' is unknown", own.display())?,
            None => write!(out, "{path}: the name has no extension")?,
        }
        out.write_str("; known are .obj, .ply, .stl, .off, .gltf, .glb and .3mf")
    }
}

impl std::error::Error for UnknownFormat {}

impl Format {
    /// All formats.
    pub const ALL: &[Self] = &[
        Self::Obj,
        Self::Ply,
        Self::Stl,
        Self::Off,
        Self::Gltf,
        Self::Glb,
        Self::ThreeMf,
    ];

    /// The usual extension in small letters and without the point, the name, and the words for such a file.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Obj => ["obj", "OBJ", "an OBJ file"],
            Self::Ply => ["ply", "PLY", "a PLY file"],
            Self::Stl => ["stl", "STL", "an STL file"],
            Self::Off => ["off", "OFF", "an OFF file"],
            Self::Gltf => ["gltf", "glTF", "a glTF file"],
            Self::Glb => ["glb", "GLB", "a glTF file"],
            Self::ThreeMf => ["3mf", "3MF", "a 3MF file"],
        }
    }

    /// The usual extension, in small letters and without the point.
    pub fn extension(self) -> &'static str {
        self.words()[0]
    }

    /// The format that `path` is named as, by its extension in capitals or small letters.
    ///
    /// # Errors
    /// The extension is missing or none of the known ones.
    pub fn from_path(path: &Path) -> Result<Self, UnknownFormat> {
        let extension = path.extension().unwrap_or_default();
        let is_own = |format: &&Self| extension.eq_ignore_ascii_case(format.extension());
        let unknown = || UnknownFormat {
            path: path.to_owned(),
        };
        Self::ALL.iter().find(is_own).copied().ok_or_else(unknown)
    }

    /// Whether it is glTF, in either form.
    pub fn is_gltf(self) -> bool {
        matches!(self, Self::Gltf | Self::Glb)
    }

    /// A file of the format, in words.
    pub(crate) fn article(self) -> &'static str {
        self.words()[2]
    }
}

impl fmt::Display for Format {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.words()[1])
    }
}
