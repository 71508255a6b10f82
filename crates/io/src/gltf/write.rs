//! Writing a document: one GLB, or the text with a file of bytes; and copies of the files that it names.

use super::changes::{Place, Written};
use super::{Asset, GltfFlaw, uri};
use crate::error::WriteError;
use crate::format::Format;
use crate::write::{WholeFile, copies, write_together};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

impl Asset {
    /// Files below the document's folder that it names and that are there, such as buffers and images: by the names the document has for
    /// them, and where they are.
    pub fn files_beside(&self) -> Vec<(PathBuf, PathBuf)> {
        let files = self.source.files(false, false).into_iter();
        files
            .filter_map(|name| self.source.file(&name).ok().map(|path| (name, path)))
            .collect()
    }

    /// Writes the document with what was replaced: a GLB, or for [`Format::Gltf`] the text with a `.bin` beside it.
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
        let reason = |reason| WriteError::File {
            path: path.to_owned(),
            reason,
        };
        let from = self.path.as_ref().and_then(|path| path.parent());
        let way = from
            .map(|from| way(path.parent().unwrap_or(Path::new("")), from))
            .transpose();
        self.write_with(path, format, way.map_err(reason)?.as_deref())
    }

    /// `way` leads from the new document's folder to the old one's, for images that stay there.
    fn write_with(
        &self,
        path: &Path,
        format: Format,
        way: Option<&str>,
    ) -> Result<Vec<PathBuf>, WriteError> {
        let is_glb = format == Format::Glb;
        let folder = path.parent().unwrap_or(Path::new(""));
        let files = self.source.files(is_glb, way.is_some());
        let name = self.name_beside(path, &files);
        let place = if is_glb {
            Place::Chunk
        } else {
            Place::File(&name)
        };
        let Written { container, beside } = self.written(&place, way)?;
        let found = files
            .iter()
            .map(|file| (file.as_path(), self.source.file(file)));
        let (found, missing): (Vec<_>, Vec<_>) = found.partition(|(_, path)| path.is_ok());
        let missing = missing
            .into_iter()
            .map(|(file, _)| file.to_owned())
            .collect();
        let found = found
            .into_iter()
            .filter_map(|(file, path)| Some((file, path.ok()?)));
        let mut whole = copies(found, folder)?;
        whole.extend(beside.map(|bytes| WholeFile {
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
        Ok(missing)
    }

    /// The document as one file: a GLB, or for [`Format::Gltf`] the text with the new bytes in it. Files that it names
    /// stay where they are.
    ///
    /// # Errors
    /// It is larger than a GLB can be, or a buffer that has to be moved cannot be read.
    pub fn to_bytes(&self, format: Format) -> Result<Vec<u8>, WriteError> {
        let place = if format == Format::Glb {
            Place::Chunk
        } else {
            Place::Inside
        };
        let container = self.written(&place, None)?.container;
        if format == Format::Glb {
            glb(&container)
        } else {
            Ok(container.text.into_bytes())
        }
    }

    fn written(&self, place: &Place<'_>, way: Option<&str>) -> Result<Written, WriteError> {
        self.changes
            .apply(&self.source, place, way)
            .map_err(|flaw| WriteError::Gltf { flaw })
    }

    /// A name for the new bytes that none of the document's own files has.
    fn name_beside(&self, path: &Path, files: &BTreeSet<PathBuf>) -> String {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let names =
            std::iter::once(format!("{stem}.bin")).chain((2..).map(|i| format!("{stem}-{i}.bin")));
        let mut free = names.filter(|name| !files.contains(Path::new(name)));
        free.next().unwrap_or_default()
    }
}

fn glb(container: &super::container::Container) -> Result<Vec<u8>, WriteError> {
    container.to_glb().ok_or_else(|| {
        let flaw = GltfFlaw::saying(
            "the GLB",
            "it would have 4 GiB or more, which its 32-bit length cannot count",
        );
        WriteError::Gltf { flaw }
    })
}

/// The way from a folder to another as a URI has it, with a slash at its end; nothing if they are one.
fn way(from: &Path, to: &Path) -> std::io::Result<String> {
    let whole = |folder: &Path| {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        folder.canonicalize()
    };
    let (from, to) = (whole(from)?, whole(to)?);
    let shared = from
        .components()
        .zip(to.components())
        .take_while(|(a, b)| a == b)
        .count();
    let none = || std::io::Error::other(format!("there is no way from it to {}", to.display()));
    let mut way = "../".repeat(from.components().count() - shared);
    for part in to.components().skip(shared) {
        let std::path::Component::Normal(name) = part else {
            return Err(none());
        };
        way.push_str(&uri::escaped(name.to_str().ok_or_else(none)?));
        way.push('/');
    }
    Ok(way)
}
