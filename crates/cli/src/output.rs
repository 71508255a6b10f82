//! Writing: text and JSON to standard output, files whole or not at all.

use std::io::Write;
use std::path::Path;

use anyhow::Context;
use serde::Serialize;

use crate::interrupt;

/// Stands for standard output where a file is expected.
pub(crate) const STANDARD_OUTPUT: &str = "-";

/// Prints text on standard output.
pub(crate) fn print(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    if !text.ends_with('\n') {
        out.write_all(b"\n")?;
    }
    out.flush()?;
    Ok(())
}

/// A value as indented JSON with a line end.
pub(crate) fn json(value: &impl Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Writes a file of bytes, whole or not at all.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    interrupt::uninterrupted(|| limitmesh_io::write_whole(path, bytes))?;
    Ok(())
}

/// Writes JSON to a file, or to standard output for `-`.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> anyhow::Result<()> {
    let text = json(value)?;
    if path.as_os_str() == STANDARD_OUTPUT { print(&text) } else { write_file(path, text.as_bytes()) }
}

/// Finds out before the work whether a file could be written where `path` says.
pub(crate) fn check_folder(path: &Path) -> anyhow::Result<()> {
    if path.as_os_str() == STANDARD_OUTPUT {
        return Ok(());
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let kind = std::fs::metadata(folder)
        .with_context(|| format!("{} cannot be written: no folder {}", path.display(), folder.display()))?;
    anyhow::ensure!(kind.is_dir(), "{} cannot be written: {} is no folder", path.display(), folder.display());
    anyhow::ensure!(!path.is_dir(), "{} cannot be written: it is a folder", path.display());
    Ok(())
}
