//! MTL: what the materials of OBJ files look like, as far as base colours say it, and which files they name.
//!
//! `newmtl`, `Kd`, `d`, `Tr` and `map_Kd` are followed; of other statements that name pictures, these alone. A library that is missing or
//! damaged costs what it would have said, and nothing else. Files are reached below the OBJ file's folder only.

use crate::files::{file_below, folder_of};
use crate::names;
use crate::scan::{Scanner, joined, number};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// The libraries of an OBJ file, and what they lead to.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MaterialLibraries {
    /// The OBJ file's folder.
    pub folder: PathBuf,
    /// All materials, in the order of the libraries.
    pub materials: Vec<Material>,
    /// Libraries and pictures that are there, by their paths from the folder.
    pub files: BTreeSet<PathBuf>,
    /// Statements, and options of pictures, that [`Material`] has no place for.
    pub left_out: BTreeSet<String>,
    /// Files that are named and cannot be read.
    pub problems: BTreeSet<Problem>,
}

/// A file that is named and cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub struct Problem {
    /// As it is named.
    pub name: String,
    /// Why, in words.
    pub reason: String,
}

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub struct Picture {
    /// Its path from the OBJ file's folder.
    pub file: PathBuf,
    /// `image/png` or `image/jpeg`, which glTF knows; `None` for others.
    pub mime_type: Option<&'static str>,
}

/// A material's base colour.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Red, green and blue, 0 to 1, which multiply the picture: `Kd`.
    pub colour: [f64; 3],
    /// From 0, which is invisible, to 1: `d`, or 1 − `Tr`.
    pub opacity: f64,
    /// The picture of `map_Kd`, if it is there.
    pub picture: Option<Picture>,
}

impl MaterialLibraries {
    /// Reads the libraries that an OBJ file names: a name may be several with blanks between.
    pub fn read(obj: &Path, names: &[String]) -> Self {
        let mut found = Self::of_file(obj);
        for name in names {
            for name in found.one_or_several(name) {
                let known = found.files.len();
                if let Some(file) = found.find(Path::new(""), name)
                    && found.files.len() > known
                {
                    found.library(&file, name);
                }
            }
        }
        found
    }

    /// Pictures that a file names itself: no materials.
    pub fn of_pictures(file: &Path, names: &[String]) -> Self {
        let mut found = Self::of_file(file);
        for name in names {
            found.find(Path::new(""), name);
        }
        found
    }

    /// Nothing yet, for a file.
    fn of_file(file: &Path) -> Self {
        Self {
            folder: folder_of(file).to_owned(),
            ..Self::default()
        }
    }

    /// The names between blanks, if there is no file of the whole name but of one of them.
    fn one_or_several<'n>(&self, name: &'n str) -> Vec<&'n str> {
        let is_there = |name: &str| self.below(Path::new(""), name).is_ok();
        let several: Vec<&str> = name.split_whitespace().collect();
        let are_several = !is_there(name) && several.iter().any(|name| is_there(name));
        if are_several { several } else { vec![name] }
    }

    /// A file that is named in a folder, if it can be read.
    fn find(&mut self, folder: &Path, name: &str) -> Option<PathBuf> {
        let file = self.below(folder, name);
        let file = self.unless_refused(name, file)?;
        self.files.insert(file.clone());
        Some(file)
    }

    /// The picture of a name; notes why it cannot be read.
    fn unless_refused<T>(&mut self, name: &str, found: io::Result<T>) -> Option<T> {
        let noted = found.map_err(|why| {
            let (name, reason) = (name.to_owned(), why.to_string());
            self.problems.insert(Problem { name, reason })
        });
        noted.ok()
    }

    /// A file that is named in a folder, by its path from the OBJ file's.
    ///
    /// # Errors
    /// It cannot be read, or is not below the OBJ file's folder.
    fn below(&self, folder: &Path, name: &str) -> io::Result<PathBuf> {
        let outside = || io::Error::other("it is not below the folder of the file that names it");
        let name = name.replace('\\', "/");
        // As drives and schemes have it.
        if name.contains([':', '\0']) {
            return Err(outside());
        }
        let mut file = PathBuf::new();
        for part in folder.join(name).components() {
            match part {
                Component::Normal(part) => file.push(part),
                Component::CurDir => {}
                Component::ParentDir if file.pop() => {}
                _ => return Err(outside()),
            }
        }
        File::open(file_below(&self.folder, &file)?)?;
        Ok(file)
    }

    fn library(&mut self, file: &Path, name: &str) {
        let bytes = std::fs::read(self.folder.join(file));
        let Some(bytes) = self.unless_refused(name, bytes) else {
            return;
        };
        let first = self.materials.len();
        let mut scanner = Scanner::of_statements(&bytes);
        while let Some(keyword) = scanner.first_word() {
            let words: Vec<&[u8]> = std::iter::from_fn(|| scanner.word()).collect();
            if keyword.eq_ignore_ascii_case(b"newmtl") {
                let (name, colour) = (joined(&words), [1.0; 3]);
                self.materials.push(Material {
                    name,
                    colour,
                    opacity: 1.0,
                    picture: None,
                });
            } else if self.materials.len() > first {
                self.follow(&names::read(keyword), &words, folder_of(file));
            }
            scanner.next_line();
        }
    }

    /// Follows what is said of the last material.
    fn follow(&mut self, keyword: &str, words: &[&[u8]], folder: &Path) {
        let lower = keyword.to_ascii_lowercase();
        if lower.starts_with("map_") || PICTURES.contains(&lower.as_str()) {
            return self.follow_picture(keyword, words, folder);
        }
        let Some(material) = self.materials.last_mut() else {
            return;
        };
        let followed = match lower.as_str() {
            "kd" => colour(words).map(|colour| material.colour = colour),
            "d" => share(words).map(|opacity| material.opacity = opacity),
            // 1 would be invisible: programs that write it mean opaque.
            "tr" => share(words)
                .filter(|&x| x < 1.0)
                .map(|x| material.opacity = 1.0 - x),
            other if OTHERS.contains(&other) => None,
            _ => Some(()),
        };
        if followed.is_none() {
            self.left_out.insert(keyword.to_owned());
        }
    }

    fn follow_picture(&mut self, keyword: &str, words: &[&[u8]], folder: &Path) {
        let (options, name) = words.split_at(length_of_options(words));
        let name = (!name.is_empty()).then(|| joined(name));
        let file = name.and_then(|name| self.find(folder, &name));
        if !keyword.eq_ignore_ascii_case("map_kd") {
            self.left_out.insert(keyword.to_owned());
            return;
        }
        let options = options.iter().filter(|word| arguments(word).is_some());
        let options = options.map(|option| format!("{keyword} {}", names::read(option)));
        self.left_out.extend(options);
        let kind = |file: &Path| mime_type(&self.folder.join(file));
        let picture = file.map(|file| Picture {
            mime_type: kind(&file),
            file,
        });
        if let Some(material) = self.materials.last_mut() {
            material.picture = picture;
        }
    }
}

/// Statements that name pictures, but for `map_Kd` and others that begin so.
const PICTURES: [&str; 5] = ["bump", "disp", "decal", "norm", "refl"];

/// Other statements that are not followed.
const OTHERS: [&str; 15] = [
    "ka",
    "ks",
    "ke",
    "tf",
    "ns",
    "ni",
    "illum",
    "sharpness",
    "pr",
    "pm",
    "ps",
    "pc",
    "pcr",
    "aniso",
    "anisor",
];

/// The first number, from 0 to 1: options such as `-halo` may stand before it.
fn share(words: &[&[u8]]) -> Option<f64> {
    let first = words.iter().find_map(|word| number(word));
    first.filter(|x| x.is_finite()).map(|x| x.clamp(0.0, 1.0))
}

/// Red, green and blue; one number is a grey.
fn colour(words: &[&[u8]]) -> Option<[f64; 3]> {
    match words {
        [r, g, b, ..] => Some([share(&[r])?, share(&[g])?, share(&[b])?]),
        [grey] => Some([share(&[grey])?; 3]),
        _ => None,
    }
}

/// How many words the options of a picture are, which stand before its name.
fn length_of_options(words: &[&[u8]]) -> usize {
    let mut length = 0;
    while let Some(range) = words.get(length).and_then(|word| arguments(word)) {
        let next = words[length + 1..].iter().take(*range.end());
        let numbers = next.take_while(|word| number(word).is_some()).count();
        length = (length + 1 + numbers.max(*range.start())).min(words.len());
    }
    length
}

/// How many arguments an option of a picture has; `None` for what is no option.
fn arguments(option: &[u8]) -> Option<std::ops::RangeInclusive<usize>> {
    match option {
        b"-o" | b"-s" | b"-t" => Some(1..=3),
        b"-mm" => Some(2..=2),
        b"-blendu" | b"-blendv" | b"-bm" | b"-boost" | b"-cc" | b"-clamp" | b"-colorspace"
        | b"-imfchan" | b"-texres" | b"-type" => Some(1..=1),
        _ => None,
    }
}

/// The kind of a picture that glTF knows without extensions, by its first bytes.
fn mime_type(path: &Path) -> Option<&'static str> {
    let mut first = [0; 8];
    File::open(path)
        .and_then(|mut file| file.read_exact(&mut first))
        .ok()?;
    match first {
        [b'\x89', b'P', b'N', b'G', b'\r', b'\n', b'\x1a', b'\n'] => Some("image/png"),
        [0xFF, 0xD8, 0xFF, ..] => Some("image/jpeg"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_pictures_follow_options() {
        let cases = [
            ("a.png", "a.png"),
            ("my wood.png", "my wood.png"),
            ("-s 2 2 1 -o 0.5 a.png", "a.png"),
            ("-clamp on -mm 0 1 a b.png", "a b.png"),
            ("-bm 1.0 -texres 512 3.png", "3.png"),
            ("-s 2 2 a.png", "a.png"),
            ("-a.png", "-a.png"),
            ("-s 2", ""),
            ("-mm 1", ""),
            ("-clamp", ""),
            ("", ""),
        ];
        for (line, expected) in cases {
            let words: Vec<&[u8]> = line.split_whitespace().map(str::as_bytes).collect();
            assert_eq!(
                joined(&words[length_of_options(&words)..]),
                expected,
                "{line}"
            );
        }
    }
}
