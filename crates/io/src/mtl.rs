//! MTL: what the materials of OBJ files look like, as far as base colours say it, and which files they name.
//!
//! Read are `newmtl`, `Kd`, `d`, `Tr` and `map_Kd`; of all other statements that name pictures, these alone. A library that is missing or
//! damaged costs what it would have said, and nothing else. Files are reached below the OBJ file's folder only.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// Bytes of a library at most.
const LARGEST: usize = 16 << 20;

/// Problems that are told at most.
const MOST_PROBLEMS: usize = 100;

/// The libraries of an OBJ file, and what they lead to.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MaterialLibraries {
    /// The OBJ file's folder.
    pub folder: PathBuf,
    /// All materials, in the order of the libraries.
    pub materials: Vec<Material>,
    /// Libraries and pictures that are there, by the way from the folder.
    pub files: BTreeSet<PathBuf>,
    /// What is named and could not be read, or not be reached; the first of many.
    pub problems: Vec<Problem>,
}

/// A file that is named and is not there for us.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Problem {
    /// As it is named.
    pub name: String,
    /// Why, in words.
    pub reason: String,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// The way to it from the OBJ file's folder.
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
    /// From 0, which is not seen at all, to 1: `d`, or 1 − `Tr`.
    pub opacity: f64,
    /// The picture of `map_Kd`, if it is there.
    pub picture: Option<Picture>,
}

impl MaterialLibraries {
    /// Reads the libraries that an OBJ file names: a name may be several with blanks between.
    pub fn read(obj: &Path, names: &[String]) -> Self {
        let mut found = Self::beside(obj);
        for name in names {
            for name in found.one_or_several(name) {
                if let Some(file) = found.found(Path::new(""), name) {
                    found.library(&file, name);
                }
            }
        }
        found
    }

    /// Pictures that a file names itself: no materials.
    pub fn of_pictures(file: &Path, names: &[String]) -> Self {
        let mut found = Self::beside(file);
        for name in names {
            found.found(Path::new(""), name);
        }
        found
    }

    /// Nothing yet, beside a file.
    fn beside(file: &Path) -> Self {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self { folder: folder.to_owned(), ..Self::default() }
    }

    /// A name as it is, if there is such a file or it has no blanks, or else the names between the blanks.
    fn one_or_several<'n>(&self, name: &'n str) -> Vec<&'n str> {
        match self.below(Path::new(""), name) {
            Ok(_) => vec![name],
            Err(_) => name.split_whitespace().collect(),
        }
    }

    /// A file that is named in a folder, if it is there; noted otherwise.
    fn found(&mut self, folder: &Path, name: &str) -> Option<PathBuf> {
        match self.below(folder, name) {
            Ok(file) => {
                self.files.insert(file.clone());
                Some(file)
            }
            Err(why) => {
                self.fails(name, &why);
                None
            }
        }
    }

    fn fails(&mut self, name: &str, why: &io::Error) {
        let problem = Problem { name: name.to_owned(), reason: why.to_string() };
        if self.problems.len() < MOST_PROBLEMS && !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }

    fn library(&mut self, file: &Path, name: &str) {
        let mut bytes = Vec::new();
        let opened = File::open(self.folder.join(file));
        let read = opened.and_then(|file| file.take(LARGEST as u64 + 1).read_to_end(&mut bytes));
        if let Err(why) = read {
            return self.fails(name, &why);
        }
        if bytes.len() > LARGEST {
            return self.fails(name, &io::Error::other("it is larger than 16 MiB"));
        }
        let folder = file.parent().unwrap_or(Path::new(""));
        for statement in statements(&String::from_utf8_lossy(&bytes)) {
            self.follow(statement, folder);
        }
    }

    fn follow(&mut self, statement: Statement, folder: &Path) {
        let mut picture = None;
        if let Statement::Base(name) | Statement::Picture(name) = &statement
            && let Some(file) = self.found(folder, name)
        {
            picture = Some(Picture { mime_type: mime_type(&self.folder.join(&file)), file });
        }
        if let Statement::New(name) = statement {
            self.materials.push(Material { name, colour: [1.0; 3], opacity: 1.0, picture: None });
            return;
        }
        // What is said before the first material is of none.
        let Some(material) = self.materials.last_mut() else { return };
        match statement {
            Statement::Colour(colour) => material.colour = colour,
            Statement::Opacity(opacity) => material.opacity = opacity,
            Statement::Base(_) => material.picture = picture,
            Statement::New(_) | Statement::Picture(_) => {}
        }
    }

    /// A file that is named in a folder, by the way from the OBJ file's.
    ///
    /// # Errors
    /// There is none, or it is not below the OBJ file's folder.
    fn below(&self, folder: &Path, name: &str) -> io::Result<PathBuf> {
        let outside = || io::Error::other("it is not below the folder of the file that names it");
        let name = name.trim().replace('\\', "/");
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
        // A link may lead elsewhere.
        let path = self.folder.join(&file).canonicalize()?;
        match path.starts_with(self.folder.canonicalize()?) {
            true if path.is_file() => Ok(file),
            true => Err(io::Error::other("it is no file")),
            false => Err(outside()),
        }
    }
}

/// The kind of a picture that glTF knows without extensions, by its first bytes.
fn mime_type(path: &Path) -> Option<&'static str> {
    let mut first = [0; 8];
    File::open(path).and_then(|mut file| file.read_exact(&mut first)).ok()?;
    let kinds = [(&b"\x89PNG\r\n\x1a\n"[..], "image/png"), (&b"\xFF\xD8\xFF"[..], "image/jpeg")];
    kinds.into_iter().find(|(start, _)| first.starts_with(start)).map(|(_, kind)| kind)
}

/// What a line of a library says.
enum Statement {
    New(String),
    Colour([f64; 3]),
    Opacity(f64),
    /// The picture of the base colour.
    Base(String),
    /// Another picture.
    Picture(String),
}

fn statements(text: &str) -> Vec<Statement> {
    // A backslash joins a line to the next one.
    let whole = text.replace("\\\r\n", " ").replace("\\\n", " ");
    whole.lines().filter_map(statement).collect()
}

fn statement(line: &str) -> Option<Statement> {
    // A name may have the sign of comments in it.
    let is_comment = |&(at, _): &(usize, &str)| at == 0 || line[..at].ends_with(char::is_whitespace);
    let comment = line.match_indices('#').find(is_comment);
    let line = line[..comment.map_or(line.len(), |(at, _)| at)].trim();
    let (keyword, rest) = line.split_once(char::is_whitespace)?;
    let rest = rest.trim();
    let numbers: Vec<f64> = rest.split_whitespace().map_while(|word| word.parse().ok()).collect();
    // `d -halo 0.5`.
    let number = || rest.split_whitespace().find_map(|word| word.parse::<f64>().ok());
    let share = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) } else { 1.0 };
    Some(match keyword.to_ascii_lowercase().as_str() {
        "newmtl" => Statement::New(rest.to_owned()),
        // One number is a grey.
        "kd" => Statement::Colour(match numbers[..] {
            [r, g, b, ..] => [r, g, b].map(share),
            [grey, ..] => [share(grey); 3],
            [] => return None,
        }),
        "d" => Statement::Opacity(share(number()?)),
        "tr" => Statement::Opacity(1.0 - share(number()?)),
        "map_kd" => Statement::Base(without_options(rest)?),
        "bump" | "disp" | "decal" | "norm" | "refl" => Statement::Picture(without_options(rest)?),
        keyword if keyword.starts_with("map_") => Statement::Picture(without_options(rest)?),
        _ => return None,
    })
}

/// The name of a picture, which may have blanks, after options with their arguments.
fn without_options(rest: &str) -> Option<String> {
    let mut rest = rest;
    while let Some(option) = rest.strip_prefix('-') {
        let (name, mut after) = option.split_once(char::is_whitespace)?;
        let is_number = |word: &str| word.parse::<f64>().is_ok();
        let (least, most) = match name {
            "o" | "s" | "t" => (1, 3),
            "mm" => (2, 2),
            _ => (1, 1),
        };
        for argument in 0..most {
            let word = after.split_whitespace().next()?;
            if argument >= least && !is_number(word) {
                break;
            }
            // The name is behind it.
            after = after.trim_start().split_once(char::is_whitespace)?.1;
        }
        rest = after.trim_start();
    }
    (!rest.is_empty()).then(|| rest.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_pictures_are_passed_over() {
        let cases = [
            ("a.png", Some("a.png")),
            ("my wood.png", Some("my wood.png")),
            ("-s 2 2 1 -o 0.5 a.png", Some("a.png")),
            ("-clamp on -mm 0 1 a b.png", Some("a b.png")),
            ("-bm 1.0 -texres 512 3.png", Some("3.png")),
            ("-s 2 2 a.png", Some("a.png")),
            ("-s 2", None),
            ("", None),
        ];
        for (rest, expected) in cases {
            assert_eq!(without_options(rest).as_deref(), expected, "{rest}");
        }
    }
}
