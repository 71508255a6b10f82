//! Jobs whose files are at addresses such as `s3://bucket/a.stl`: the caller copies them to a folder of this machine, where the
//! job is done, and what it wrote is copied back.

use std::path::Path;

use anyhow::Context;
use tempfile::TempDir;

use super::job::{Job, is_address};

/// Files that only the caller of a batch can reach. Called from several threads at once.
pub trait RemoteFiles: Sync {
    /// Copies the file at an address, and those that it names, into the folder of `to`.
    ///
    /// # Errors
    /// It cannot, in words.
    fn fetch(&self, address: &str, to: &Path) -> Result<(), String>;

    /// Copies a file to an address, whole or not at all.
    ///
    /// # Errors
    /// It cannot, in words.
    fn store(&self, from: &Path, address: &str) -> Result<(), String>;

    /// Bytes of the file at an address, if there is one.
    fn size(&self, address: &str) -> Option<u64>;
}

/// A job with its remote files in a temporary folder.
pub(super) struct Copied {
    pub(super) job: Job,
    folder: TempDir,
    inputs: Vec<Pair>,
    outputs: Vec<Pair>,
}

/// A folder elsewhere, the folder here that has its files, and the name of one of them.
struct Pair {
    there: String,
    here: String,
    name: String,
}

impl Copied {
    /// A job with names in a new folder in place of addresses; none where it has no addresses.
    ///
    /// # Errors
    /// The folder cannot be made.
    pub(super) fn of(job: &Job) -> anyhow::Result<Option<Self>> {
        if !job.files().any(is_address) {
            return Ok(None);
        }
        let folder = tempfile::Builder::new().prefix("limitmesh-").tempdir();
        let folder = folder.context("there is no temporary folder for remote files")?;
        let mut own = Self {
            job: job.clone(),
            folder,
            inputs: vec![],
            outputs: vec![],
        };
        if is_address(&job.input) {
            let pair = own.pair(&job.input)?;
            own.job.input = pair.local();
            own.inputs.push(pair);
        }
        for other in job.others.iter().filter(|name| is_address(name)) {
            let pair = own.pair(other)?;
            own.job.rename(other, &pair.local());
            own.outputs.push(pair);
        }
        if let Some(output) = job.output.as_deref().filter(|name| is_address(name)) {
            let pair = own.pair(output)?;
            own.job.output = Some(pair.local());
            own.outputs.push(pair);
        }
        Ok(Some(own))
    }

    /// A folder of its own for the file at an address: of several files, the names may be the same.
    fn pair(&self, address: &str) -> anyhow::Result<Pair> {
        let (there, name) = address.rsplit_once('/').unwrap_or_default();
        let number = self.inputs.len() + self.outputs.len();
        let here = self.folder.path().join(number.to_string());
        std::fs::create_dir(&here)?;
        Ok(Pair {
            there: format!("{there}/"),
            here: format!("{}{}", here.display(), std::path::MAIN_SEPARATOR),
            name: name.to_owned(),
        })
    }

    /// Copies what the job reads to this machine.
    ///
    /// # Errors
    /// As [`RemoteFiles::fetch`].
    pub(super) fn fetch(&self, remote: &dyn RemoteFiles) -> Result<(), String> {
        let mut pairs = self.inputs.iter();
        pairs.try_for_each(|pair| remote.fetch(&pair.address(&pair.name), Path::new(&pair.local())))
    }

    /// Copies what the job wrote to where it belongs, the mesh last.
    ///
    /// # Errors
    /// As [`RemoteFiles::store`].
    pub(super) fn store(&self, remote: &dyn RemoteFiles) -> Result<(), String> {
        for pair in &self.outputs {
            let mut names = names_below(Path::new(&pair.here)).map_err(|why| why.to_string())?;
            // What it names, such as the buffers of a glTF document, goes before it.
            names.sort_by_key(|name| *name == pair.name);
            for name in names {
                let here = Path::new(&pair.here).join(&name);
                remote.store(&here, &pair.address(&name))?;
            }
        }
        Ok(())
    }

    /// JSON with the addresses in place of the names here.
    pub(super) fn with_addresses(&self, json: &str) -> String {
        let within = |name: &str| serde_json::Value::from(name).to_string();
        let pairs = self.inputs.iter().chain(&self.outputs);
        pairs.fold(json.to_owned(), |json, pair| {
            json.replace(
                within(&pair.here).trim_matches('"'),
                within(&pair.there).trim_matches('"'),
            )
        })
    }
}

impl Pair {
    fn local(&self) -> String {
        format!("{}{}", self.here, self.name)
    }

    fn address(&self, name: &str) -> String {
        format!("{}{name}", self.there)
    }
}

/// The files in a folder and the folders in it, by their ways from there with slashes.
fn names_below(folder: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.file_type()?.is_dir() {
            let below = names_below(&entry.path())?;
            names.extend(below.into_iter().map(|own| format!("{name}/{own}")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}
