//! The file formats, by name and by the look of their content.

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
    /// glTF 2.0 as JSON text, with files beside it.
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
            Some(extension) => write!(
                out,
                "{path}: the extension '{}' is unknown; known are .obj, .ply, .stl, .off, .gltf, .glb and .3mf",
                extension.display()
            ),
            None => write!(
                out,
                "{path}: the name has no extension; known are .obj, .ply, .stl, .off, .gltf, .glb and .3mf"
            ),
        }
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

    /// The usual extension, in small letters and without the point.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::ThreeMf => "3mf",
        }
    }

    /// The format that `path` is named as, by its extension in capitals or small letters.
    ///
    /// # Errors
    /// The extension is missing or none of the known ones.
    pub fn from_path(path: &Path) -> Result<Self, UnknownFormat> {
        let extension = path.extension().and_then(|e| e.to_str());
        extension
            .and_then(|e| {
                Self::ALL
                    .iter()
                    .copied()
                    .find(|f| f.extension().eq_ignore_ascii_case(e))
            })
            .ok_or_else(|| UnknownFormat {
                path: path.to_owned(),
            })
    }

    /// Whether it is glTF, in either form.
    pub fn is_gltf(self) -> bool {
        matches!(self, Self::Gltf | Self::Glb)
    }

    fn article(self) -> &'static str {
        match self {
            Self::Ply => "a PLY file",
            Self::Obj => "an OBJ file",
            Self::Stl => "an STL file",
            Self::Off => "an OFF file",
            Self::Gltf | Self::Glb => "a glTF file",
            Self::ThreeMf => "a 3MF file",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Off => "OFF",
            Self::Gltf => "glTF",
            Self::Glb => "GLB",
            Self::ThreeMf => "3MF",
        })
    }
}

/// What some editors put before text in UTF-8.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Beginnings of files that are often met under a wrong name.
const SIGNATURES: [(&[u8], &str); 11] = [
    (b"glTF", "a binary glTF file"),
    (b"\x1f\x8b", "gzip data"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"Kaydara FBX", "an FBX file"),
    (b"\xff\xfe", "UTF-16 text"),
    (b"\xfe\xff", "UTF-16 text"),
    (
        b"version https://git-lfs",
        "a Git LFS pointer, not the file itself",
    ),
    (b"<", "XML or HTML"),
    (b"{", "JSON, as glTF is"),
];

/// What else `bytes` plainly are, in words, if they cannot be of format `named`; `None` if they may be.
pub(crate) fn looks_like_other(bytes: &[u8], named: Format) -> Option<&'static str> {
    // Both forms of glTF are met under both names, and tell themselves apart.
    if named.is_gltf() && (bytes.starts_with(b"glTF") || bytes.starts_with(b"{")) {
        return None;
    }
    if named == Format::ThreeMf && bytes.starts_with(b"PK") {
        return None;
    }
    // A binary STL may begin with any 80 bytes at all, so that its length speaks first.
    if is_binary_stl(bytes) {
        return (named != Format::Stl).then_some("a binary STL file");
    }
    if let Some((_, words)) = SIGNATURES
        .iter()
        .find(|(start, _)| bytes.starts_with(start))
    {
        return Some(words);
    }
    let seen = sniff_text(bytes)?;
    (seen != named).then(|| seen.article())
}

/// Whether `bytes` have exactly the length that the facet count of a binary STL at byte 80 asks for.
pub(crate) fn is_binary_stl(bytes: &[u8]) -> bool {
    stl_facet_count(bytes).is_some_and(|facets| bytes.len() as u64 == 84 + 50 * u64::from(facets))
}

/// The facet count of a binary STL; `None` if the bytes end before it.
pub(crate) fn stl_facet_count(bytes: &[u8]) -> Option<u32> {
    bytes.get(80..84)?.try_into().ok().map(u32::from_le_bytes)
}

/// The format that the first statement of a text is in, if it is characteristic of one.
fn sniff_text(bytes: &[u8]) -> Option<Format> {
    let mut words = first_statement(bytes)?;
    let word = words.next()?;
    let mut next_is_number = || {
        words
            .next()
            .is_some_and(|w| crate::scan::number(w).is_some())
    };
    match word {
        b"ply" => Some(Format::Ply),
        b"v" | b"vn" | b"vt" if next_is_number() => Some(Format::Obj),
        b"mtllib" | b"usemtl" | b"o" | b"g" => Some(Format::Obj),
        _ if off_keyword(word).is_some() => Some(Format::Off),
        _ if is_ascii_stl(bytes) => Some(Format::Stl),
        _ => None,
    }
}

/// What the keyword of an OFF file says.
#[derive(Default)]
pub(crate) struct OffKeyword<'a> {
    /// Whether normals, colours and texture coordinates follow a vertex's position, in this order.
    pub(crate) has_normals: bool,
    pub(crate) has_colours: bool,
    pub(crate) has_textures: bool,
    /// Whether a vertex has another number of coordinates than three.
    pub(crate) has_other_dimension: bool,
    /// Digits that follow the keyword without a blank: the number of vertices, as in many files of ModelNet.
    pub(crate) glued: &'a [u8],
}

/// Reads a word as the keyword of an OFF file, such as `STCNOFF`, `coff` or `OFF216`; `None` for any other word.
pub(crate) fn off_keyword(word: &[u8]) -> Option<OffKeyword<'_>> {
    const OFF: usize = 3;
    let at = word
        .windows(OFF)
        .position(|three| three.eq_ignore_ascii_case(b"OFF"))?;
    let (mut letters, off, glued) = (&word[..at], &word[at..at + OFF], &word[at + OFF..]);
    if !glued.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let mut keyword = OffKeyword {
        glued,
        ..OffKeyword::default()
    };
    // Geomview: "[ST][C][N][4][n]OFF". In small letters, n is taken for normals, which are far more common.
    for dimension in [b'n', b'4'] {
        if (dimension == b'4' || off == b"OFF") && letters.last() == Some(&dimension) {
            keyword.has_other_dimension = true;
            letters = &letters[..letters.len() - 1];
        }
    }
    // All orders of the other letters are met in files.
    while !letters.is_empty() {
        let (is_met, length) = match letters.to_ascii_uppercase().as_slice() {
            [b'S', b'T', ..] => (&mut keyword.has_textures, 2),
            [b'C', ..] => (&mut keyword.has_colours, 1),
            [b'N', ..] => (&mut keyword.has_normals, 1),
            _ => return None,
        };
        if std::mem::replace(is_met, true) {
            return None;
        }
        letters = &letters[length..];
    }
    Some(keyword)
}

/// Whether a text begins as an ASCII STL does: `solid` and, after its line, `facet` or `endsolid`.
pub(crate) fn is_ascii_stl(bytes: &[u8]) -> bool {
    let text = bytes
        .strip_prefix(BYTE_ORDER_MARK)
        .unwrap_or(bytes)
        .trim_ascii_start();
    let Some((keyword, rest)) = text.split_at_checked(5) else {
        return false;
    };
    if !keyword.eq_ignore_ascii_case(b"solid") {
        return false;
    }
    let Some(line_end) = rest.iter().position(|&b| b == b'\n' || b == b'\r') else {
        return false;
    };
    let body = rest[line_end..].trim_ascii_start();
    let begins = |word: &[u8]| {
        body.get(..word.len())
            .is_some_and(|w| w.eq_ignore_ascii_case(word))
    };
    // A file cut right after its first line is an ASCII file still.
    body.is_empty() || begins(b"facet") || begins(b"endsolid") || begins(b"solid")
}

/// The words of the first line that is neither empty nor a comment.
fn first_statement(bytes: &[u8]) -> Option<impl Iterator<Item = &[u8]>> {
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    text.split(|&b| b == b'\n' || b == b'\r')
        .map(<[u8]>::trim_ascii)
        .find(|line| !line.is_empty() && !line.starts_with(b"#"))
        .map(|line| {
            line.split(u8::is_ascii_whitespace)
                .filter(|w| !w.is_empty())
        })
}
