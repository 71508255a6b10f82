//! Writing a document: one GLB, or the text with a file of bytes; and copies of the files that it names.

use super::asset::Asset;
use super::document::container::Container;
use super::document::uri;
use super::edit::apply::{Place, Written};
use crate::error::WriteError;
use crate::files::{absolute, copies, folder_of};
use crate::flaw::Flaw;
use crate::format::Format;
use crate::whole::{WholeFile, write_together};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

impl Asset {
    /// Files below the document's folder that it names and that are there, such as buffers and images: by the names the document has for
    /// them, and where they are.
    pub fn files_beside(&self) -> Vec<(PathBuf, PathBuf)> {
        let files = self.source.files(false, false).into_iter();
        let found = |name: PathBuf| self.source.file(&name).ok().map(|path| (name, path));
        files.filter_map(found).collect()
    }

    /// Writes the document with what was replaced: a GLB, or for [`Format::Gltf`] the text with a `.bin` of the same name.
    ///
    /// Files that the document names, such as images, are copied to the same places below the new document's folder, unless
    /// they are there. Gives those that could not be found, by the names the document has for them. All files are written
    /// under other names first and then renamed, so that a failure leaves earlier ones as they were.
    ///
    /// # Errors
    /// The system refuses, a file that would be replaced is not the one that is to be copied there, or a buffer that
    /// has to be moved cannot be read.
    pub fn write(&self, path: &Path, format: Format) -> Result<Vec<PathBuf>, WriteError> {
        self.write_with(path, format, None)
    }

    /// [`Self::write`], with images left where they are: the new document names those of the old one by the way from its own folder.
    ///
    /// # Errors
    /// As for [`Self::write`]; or there is no such way, as from one drive to another.
    pub fn write_linked(&self, path: &Path, format: Format) -> Result<Vec<PathBuf>, WriteError> {
        let found = self.path.as_ref();
        let from = found.map(|from| way(folder_of(path), folder_of(from)));
        let way = from.transpose().map_err(WriteError::of(path))?;
        self.write_with(path, format, way.as_deref())
    }

    /// `way` leads from the new document's folder to the old one's, for images that stay there.
    fn write_with(
        &self,
        path: &Path,
        format: Format,
        way: Option<&str>,
    ) -> Result<Vec<PathBuf>, WriteError> {
        let is_glb = format == Format::Glb;
        let folder = folder_of(path);
        let files = self.source.files(is_glb, way.is_some());
        let name = name_of_bytes(path, &files);
        let place = if is_glb {
            Place::Chunk
        } else {
            Place::File(&name)
        };
        let Written { container, file } = self.written(&place, way)?;
        let mut missing = files.clone();
        let found = files
            .iter()
            .filter_map(|file| Some((&**file, self.source.file(file).ok()?)));
        let found: Vec<(&Path, PathBuf)> = found.collect();
        missing.retain(|file| !found.iter().any(|(own, _)| *own == file.as_path()));
        let mut whole = copies(found.into_iter(), folder)?;
        whole.extend(file.map(|bytes| WholeFile {
            path: folder.join(&name),
            bytes,
        }));
        let bytes = if is_glb {
            glb(&container)?
        } else {
            container.text.into_bytes()
        };
        // The document last: what it names is there by then.
        whole.push(WholeFile {
            path: path.to_owned(),
            bytes,
        });
        write_together(&whole)?;
        Ok(missing.into_iter().collect())
    }

    /// The document as one file: a GLB, or for [`Format::Gltf`] the text with the new bytes in it. Files that it names
    /// stay where they are.
    ///
    /// # Errors
    /// It is larger than a GLB can be, or a buffer that has to be moved cannot be read.
    pub fn to_bytes(&self, format: Format) -> Result<Vec<u8>, WriteError> {
        let is_glb = format == Format::Glb;
        let place = if is_glb { Place::Chunk } else { Place::Inside };
        let container = self.written(&place, None)?.container;
        if is_glb {
            glb(&container)
        } else {
            Ok(container.text.into_bytes())
        }
    }

    fn written(&self, place: &Place<'_>, way: Option<&str>) -> Result<Written, WriteError> {
        Ok(self.changes.apply(&self.source, place, way)?)
    }
}

/// A name for the new bytes that none of the document's own files has.
fn name_of_bytes(path: &Path, files: &BTreeSet<PathBuf>) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let (mut name, mut number) = (format!("{stem}.bin"), 1);
    while files.contains(Path::new(&name)) {
        number += 1;
        name = format!("{stem}-{number}.bin");
    }
    name
}

fn glb(container: &Container) -> Result<Vec<u8>, WriteError> {
    let problem = "it would have 4 GiB or more, which its 32-bit length cannot count";
    let found = container.to_glb();
    found.ok_or_else(|| Flaw::saying("the GLB", problem).into())
}

/// The way from a folder to another as a URI has it, with a slash at its end; nothing if they are one.
fn way(from: &Path, to: &Path) -> std::io::Result<String> {
    let (from, to) = (absolute(from)?, absolute(to)?);
    let both = from.components().zip(to.components());
    let shared = both.take_while(|(a, b)| a == b).count();
    let none = || std::io::Error::other(format!("there is no way from it to {}", to.display()));
    let mut way = "../".repeat(from.components().count() - shared);
    for part in to.components().skip(shared) {
        let Component::Normal(name) = part else {
            return Err(none());
        };
        way.push_str(&uri::escaped(name.to_str().ok_or_else(none)?));
        way.push('/');
    }
    Ok(way)
}
