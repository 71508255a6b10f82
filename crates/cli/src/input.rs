//! Input: a file or a built-in model becomes a control mesh, with what was found on the way.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::mesh::{BuildOptions, Diagnosis, MeshError};
use limitmesh::{Mesh, PolygonSoup, models};
use limitmesh_io::Format;

use crate::progress::Progress;
use crate::report;
use crate::words::counted;

/// What marks the name of a built-in model.
const BUILTIN: &str = "builtin:";

/// What a file or a built-in model held.
pub(crate) struct Soup {
    /// As given on the command line.
    pub(crate) name: String,
    /// `obj`, `ply`, `stl`, `off` or `builtin`.
    pub(crate) format: &'static str,
    /// Positions, polygons and tags.
    pub(crate) soup: PolygonSoup,
    /// Time taken to read or generate it.
    pub(crate) reading: Duration,
}

/// A control mesh and where it came from.
pub(crate) struct Input {
    /// As given on the command line.
    pub(crate) name: String,
    /// `obj`, `ply`, `stl`, `off` or `builtin`.
    pub(crate) format: &'static str,
    /// The mesh.
    pub(crate) mesh: Mesh,
    /// What was found and repaired.
    pub(crate) diagnosis: Diagnosis,
    /// Time taken to read or generate it.
    pub(crate) reading: Duration,
    /// Time taken to repair and connect it.
    pub(crate) building: Duration,
}

/// Reads a file, or generates the model after `builtin:`.
///
/// # Errors
/// The file cannot be read, or there is no such model; the message lists those that there are.
pub(crate) fn read(name: &str, progress: &Progress) -> anyhow::Result<Soup> {
    progress.stage(format!("reading {name}"));
    let start = Instant::now();
    let (soup, format) = match name.strip_prefix(BUILTIN) {
        Some(model) => (builtin(model)?, "builtin"),
        None => {
            let path = Path::new(name);
            let soup = limitmesh_io::read(path)?;
            (soup, Format::from_path(path)?.extension())
        }
    };
    Ok(Soup { name: name.to_owned(), format, soup, reading: start.elapsed() })
}

fn builtin(name: &str) -> anyhow::Result<PolygonSoup> {
    let model = models::find(name).with_context(|| {
        let names: Vec<&str> = models::all().iter().map(|model| model.name).collect();
        format!("there is no built-in model '{name}'; there are: {}", names.join(", "))
    })?;
    Ok(model.soup())
}

/// Reads a control mesh and says on standard error what had to be repaired.
///
/// # Errors
/// As for [`read`]; or no mesh can be made of it, or only by a repair that `options` forbid.
pub(crate) fn load(name: &str, options: &BuildOptions, progress: &Progress) -> anyhow::Result<Input> {
    let Soup { name, format, soup, reading } = read(name, progress)?;
    progress.stage(format!("connecting {}", counted(soup.faces.len(), "face", "faces")));
    let start = Instant::now();
    let (mesh, diagnosis) = Mesh::from_soup(&soup, options).map_err(|error| describe(&name, error))?;
    // Large soups are given back before refinement needs the memory.
    drop(soup);
    let building = start.elapsed();
    for line in report::diagnosis::repairs_in_words(&diagnosis) {
        progress.note(format!("{name}: {line}"));
    }
    Ok(Input { name, format, mesh, diagnosis, reading, building })
}

/// An error of building with the input's name before it.
pub(crate) fn describe(name: &str, error: MeshError) -> anyhow::Error {
    anyhow::Error::new(error).context(format!("{name} gives no control mesh"))
}

/// Whether both paths name one file, as far as can be told without reading it.
pub(crate) fn same_file(a: &Path, b: &Path) -> bool {
    let full = |path: &Path| -> PathBuf {
        std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned())
    };
    full(a) == full(b)
}
