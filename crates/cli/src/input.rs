//! Input: a file or a built-in model becomes a control mesh, with what was found on the way.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::mesh::{BuildOptions, Diagnosis, MeshError, Weld};
use limitmesh::{Mesh, PolygonSoup};
use limitmesh_io::Format;

use crate::format::{counted, thousands};
use crate::progress::Progress;

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
    /// What else the file held and was left out, in words.
    pub(crate) left_out: Vec<String>,
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
    let model = limitmesh_models::find(name).with_context(|| {
        let names: Vec<&str> = limitmesh_models::all().iter().map(|model| model.name).collect();
        format!("there is no built-in model '{name}'; there are: {}", names.join(", "))
    })?;
    Ok(model.soup())
}

/// Reads a control mesh and says on standard error what had to be repaired.
///
/// # Errors
/// As for [`read`]; or no mesh can be made of it, or only by a repair that `options` forbid.
pub(crate) fn load(name: &str, options: &BuildOptions, progress: &Progress) -> anyhow::Result<Input> {
    let Soup { name, format, mut soup, reading } = read(name, progress)?;
    progress.stage(format!("connecting {}", counted(soup.faces.len(), "face", "faces")));
    let start = Instant::now();
    let (mesh, diagnosis) = Mesh::from_soup(&soup, options).map_err(|error| describe(&name, error))?;
    let near = nearly_closed(&soup, &mesh, options);
    let left_out = std::mem::take(&mut soup.left_out);
    // Large soups are given back before refinement needs the memory.
    drop(soup);
    let building = start.elapsed();
    if !left_out.is_empty() {
        progress.note(format!("{name}: left out: {}", left_out.join("; ")));
    }
    for line in diagnosis.repairs() {
        progress.note(format!("{name}: {line}"));
    }
    if let Some(near) = near {
        progress.note(format!("{name}: {near}"));
    }
    Ok(Input { name, format, left_out, mesh, diagnosis, reading, building })
}

/// Vertices nearer to each other than this share of the diagonal are usually one, written with too few digits: about
/// ten steps of single precision.
const NEAR: f64 = 1e-6;

/// Tells where open edges would close if nearly equal positions were merged too.
pub(crate) fn nearly_closed(soup: &PolygonSoup, mesh: &Mesh, options: &BuildOptions) -> Option<String> {
    let open = mesh.topology().boundary_edge_count();
    if open == 0 || options.weld != Weld::Exact {
        return None;
    }
    // As it would be typed: one digit.
    let distance: f64 = format!("{:.0e}", NEAR * mesh.diagonal()).parse().ok()?;
    let (welded, _) = Mesh::from_soup(soup, &BuildOptions::default().weld(Weld::Within(distance))).ok()?;
    let left = welded.topology().boundary_edge_count();
    (left < open).then(|| {
        let closing = if left == 0 { "all of them".to_owned() } else { thousands(open - left) };
        let open = counted(open, "edge is open", "edges are open");
        format!("{open}; {closing} would close with --weld {distance:e}, which merges nearly equal positions")
    })
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
