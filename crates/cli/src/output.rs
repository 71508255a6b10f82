//! Writing: text and JSON to standard output, files whole or not at all.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf, is_separator};

use anyhow::Context;
use limitmesh_io::{Asset, Format, Output, WriteError, WriteOptions};
use serde::Serialize;

use crate::arguments::OverwriteArguments;
use crate::failure::usage;
use crate::file_identity::FileIdentity;
use crate::interrupt;

/// Standard output where a file is expected.
const STANDARD_OUTPUT: &str = "-";

/// Prints text on standard output.
pub(crate) fn print(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let end: &[u8] = if text.ends_with('\n') { b"" } else { b"\n" };
    let written = out
        .write_all(text.as_bytes())
        .and_then(|()| out.write_all(end))
        .and_then(|()| out.flush());
    written.context("standard output")
}

/// A value as indented JSON with a line end.
pub(crate) fn json(value: &impl Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Whether this means standard output.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path.as_os_str() == STANDARD_OUTPUT
}

/// Whether a name is that of a folder: it ends with a slash, or there is one.
pub(crate) fn is_folder(path: &Path) -> bool {
    ends_with_separator(path) || path.is_dir()
}

/// Whether a name ends with a slash.
pub(crate) fn ends_with_separator(path: &Path) -> bool {
    path.as_os_str()
        .as_encoded_bytes()
        .last()
        .is_some_and(|&last| is_separator(char::from(last)))
}

/// Writes a file of bytes, whole or not at all; or to standard output for `-`.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    if is_standard_output(path) {
        let mut out = std::io::stdout().lock();
        return out
            .write_all(bytes)
            .and_then(|()| out.flush())
            .context("standard output");
    }
    interrupt::whole_or_not(path, || limitmesh_io::write_whole(path, bytes))?;
    Ok(())
}

/// Writes a mesh in a format: a file, whole or not at all, or to standard output for `-`.
pub(crate) fn write_mesh(
    path: &Path,
    format: Format,
    mesh: &Output<'_>,
    options: &WriteOptions,
) -> anyhow::Result<()> {
    if !is_standard_output(path) {
        interrupt::whole_or_not(path, || limitmesh_io::write_as(path, format, mesh, options))?;
        return Ok(());
    }
    match limitmesh_io::write_to(&mut std::io::stdout().lock(), format, mesh, options) {
        // As it is below that, so that a reader that went away is known.
        Err(WriteError::Writer { reason }) => Err(reason).context("standard output"),
        result => Ok(result?),
    }
}

/// Writes an asset and what belongs to it, whole or not at all; gives files that it names and that were not found.
pub(crate) fn write_asset(
    path: &Path,
    asset: &Asset,
    format: Format,
    are_images_linked: bool,
) -> anyhow::Result<Vec<PathBuf>> {
    let write = || match are_images_linked {
        true => asset.write_linked(path, format),
        false => asset.write(path, format),
    };
    Ok(interrupt::whole_or_not(path, write)?)
}

/// Writes JSON to a file, or to standard output for `-`.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> anyhow::Result<()> {
    write_file(path, json(value)?.as_bytes())
}

/// Refuses files that would replace an input, unless that is asked for.
pub(crate) fn check_replaced(
    written: &[&Path],
    inputs: &[&Path],
    asked: Option<OverwriteArguments>,
) -> anyhow::Result<()> {
    let inputs: BTreeSet<FileIdentity> = inputs.iter().map(|path| FileIdentity::of(path)).collect();
    let is_input =
        |path: &Path| !is_standard_output(path) && inputs.contains(&FileIdentity::of(path));
    let replaced = written
        .iter()
        .find(|path| is_input(path))
        .map(|path| path.display());
    match (replaced, asked) {
        (None, _) | (_, Some(OverwriteArguments { overwrite: true })) => Ok(()),
        (Some(path), Some(_)) => usage(format!(
            "{path} is an input, which the result would replace; --overwrite allows that"
        )),
        (Some(path), None) => usage(format!("{path} is an input, which it would replace")),
    }
}

/// Refuses to write a file twice.
pub(crate) fn check_once(written: &[&Path]) -> anyhow::Result<()> {
    let mut seen = BTreeSet::new();
    match written
        .iter()
        .find(|path| !seen.insert(FileIdentity::of(path)))
    {
        Some(path) => usage(format!("{} would be written twice", path.display())),
        None => Ok(()),
    }
}

/// Finds out before the work whether a file could be written where `path` says.
pub(crate) fn check_writable(path: &Path) -> anyhow::Result<()> {
    if is_standard_output(path) {
        return Ok(());
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let kind = std::fs::metadata(folder).with_context(|| {
        format!(
            "{} cannot be written: no folder {}",
            path.display(),
            folder.display()
        )
    })?;
    anyhow::ensure!(
        kind.is_dir(),
        "{} cannot be written: {} is no folder",
        path.display(),
        folder.display()
    );
    anyhow::ensure!(
        !path.is_dir(),
        "{} cannot be written: it is a folder",
        path.display()
    );
    // It makes a file and removes it.
    Ok(interrupt::undisturbed(|| {
        limitmesh_io::check_writable(path)
    })?)
}
