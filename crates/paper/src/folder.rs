//! The folder that is written: made where it is missing, each file whole or not at all.

use std::fs;
use std::path::PathBuf;

use anyhow::Context;

use crate::Host;

/// The output folder and what was written there.
pub(super) struct Folder<'a> {
    path: PathBuf,
    host: &'a dyn Host,
    files: Vec<String>,
}

impl<'a> Folder<'a> {
    /// The folder at `path`, made with its parents where it is missing.
    ///
    /// # Errors
    /// It cannot be made, or something else has that name.
    pub(super) fn new(path: PathBuf, host: &'a dyn Host) -> anyhow::Result<Self> {
        fs::create_dir_all(&path)
            .with_context(|| format!("the folder {} cannot be made", path.display()))?;
        Ok(Self {
            path,
            host,
            files: Vec::new(),
        })
    }

    /// Writes a file over an earlier one of that name.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn write(&mut self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        self.host.write(&self.path.join(name), bytes)?;
        self.files.push(name.to_owned());
        Ok(())
    }

    /// Where a file of that name is.
    pub(super) fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Number of files written.
    pub(super) fn count(&self) -> usize {
        self.files.len()
    }
}
