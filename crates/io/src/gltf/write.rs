//! Writing a document: one GLB, or the text with a file of bytes; and copies of the files that it names.

use super::changes::{Place, Written};
use super::{Asset, GltfFlaw};
use crate::error::WriteError;
use crate::format::Format;
use crate::write::{WholeFile, write_together};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

impl Asset {
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
        let is_glb = format == Format::Glb;
        let folder = path.parent().unwrap_or(Path::new(""));
        let files = self.source.files(is_glb);
        let name = self.name_beside(path, &files);
        let place = if is_glb { Place::Chunk } else { Place::File(&name) };
        let Written { container, beside } = self.written(&place)?;
        let mut whole = Vec::new();
        let mut missing = Vec::new();
        for file in files {
            let Ok(from) = self.source.file(&file) else {
                missing.push(file);
                continue;
            };
            let to = folder.join(&file);
            if to.canonicalize().is_ok_and(|there| there == from) {
                continue;
            }
            let reason = |reason| WriteError::File { path: to.clone(), reason };
            let bytes = std::fs::read(&from).map_err(reason)?;
            match std::fs::read(&to) {
                Ok(there) if there == bytes => continue,
                Ok(_) => {
                    let why = format!("it is there already, and not the same as {}", from.display());
                    return Err(reason(std::io::Error::new(std::io::ErrorKind::AlreadyExists, why)));
                }
                Err(_) => {}
            }
            if let Some(folder) = to.parent() {
                std::fs::create_dir_all(folder).map_err(reason)?;
            }
            whole.push(WholeFile { path: to, bytes });
        }
        whole.extend(beside.map(|bytes| WholeFile { path: folder.join(&name), bytes }));
        let bytes = if is_glb { glb(&container)? } else { container.text.into_bytes() };
        // The document last: what it names is there by then.
        whole.push(WholeFile { path: path.to_owned(), bytes });
        write_together(&whole)?;
        Ok(missing)
    }

    /// The document as one file: a GLB, or for [`Format::Gltf`] the text with the new bytes in it. Files that it names
    /// stay where they are.
    ///
    /// # Errors
    /// It is larger than a GLB can be, or a buffer that has to be moved cannot be read.
    pub fn to_bytes(&self, format: Format) -> Result<Vec<u8>, WriteError> {
        let place = if format == Format::Glb { Place::Chunk } else { Place::Inside };
        let container = self.written(&place)?.container;
        if format == Format::Glb { glb(&container) } else { Ok(container.text.into_bytes()) }
    }

    fn written(&self, place: &Place<'_>) -> Result<Written, WriteError> {
        self.changes.apply(&self.source, place).map_err(|flaw| WriteError::Gltf { flaw })
    }

    /// A name for the new bytes that none of the document's own files has.
    fn name_beside(&self, path: &Path, files: &BTreeSet<PathBuf>) -> String {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let names = std::iter::once(format!("{stem}.bin")).chain((2..).map(|i| format!("{stem}-{i}.bin")));
        let mut free = names.filter(|name| !files.contains(Path::new(name)));
        free.next().unwrap_or_default()
    }
}

fn glb(container: &super::container::Container) -> Result<Vec<u8>, WriteError> {
    container.to_glb().ok_or_else(|| {
        let flaw = GltfFlaw::new("the GLB", "more bytes than its 32-bit length can tell", "less than 4 GiB");
        WriteError::Gltf { flaw }
    })
}
