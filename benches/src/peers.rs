//! Peers: built or found where they are installed, left out where not.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use limitmesh::Mesh;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peers")
}

/// What OpenSubdiv is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OpenSubdiv {
    /// `Far`: the refined topology and its positions.
    Far,
    /// `Bfr`: limit positions and normals of all vertices, and the triangles.
    Bfr,
    /// `Far`: limit stencils, for frame after frame.
    Stencils,
}

/// Least CPU seconds of OpenSubdiv's uniform refinement; `None` where `libosd-dev` (3.5 or later for `Bfr`) or a C++
/// compiler is missing.
pub(crate) fn opensubdiv(
    what: OpenSubdiv,
    model: &Path,
    level: usize,
    repeats: usize,
) -> Result<Option<f64>> {
    let Some(program) = program(what)? else {
        return Ok(None);
    };
    let output = Command::new(&program)
        .arg(model)
        .arg(level.to_string())
        .arg(repeats.to_string())
        .output()?;
    ensure!(
        output.status.success(),
        "OpenSubdiv's program failed on {}",
        model.display()
    );
    let text = String::from_utf8(output.stdout)?;
    let seconds = text
        .lines()
        .filter_map(|line| line.split_whitespace().nth(1)?.parse().ok());
    Ok(seconds.reduce(f64::min))
}

/// The program that does it, for this processor, built unless it is there; `None` where that is not possible.
pub(crate) fn program(what: OpenSubdiv) -> Result<Option<PathBuf>> {
    program_for(what, "native")
}

/// The same for the given kind of processor, as the compiler names it.
pub(crate) fn program_for(what: OpenSubdiv, processor: &str) -> Result<Option<PathBuf>> {
    let build = folder().join("build");
    std::fs::create_dir_all(&build)?;
    let name = match what {
        OpenSubdiv::Far => "opensubdiv_far",
        OpenSubdiv::Bfr => "opensubdiv_bfr",
        OpenSubdiv::Stencils => "opensubdiv_stencils",
    };
    let program = build.join(format!("{name}_{processor}"));
    if !program.exists() {
        let compiler = Command::new("g++")
            .args(["-O3", &format!("-march={processor}"), "-o"])
            .arg(&program)
            .arg(folder().join(name).with_extension("cpp"))
            .arg("-losdCPU")
            .output();
        if !compiler.is_ok_and(|output| output.status.success()) {
            return Ok(None);
        }
    }
    Ok(Some(program))
}

/// MeshLab's one-sided distances and the seconds that both took together.
pub(crate) struct MeshLab {
    pub(crate) forward: f64,
    pub(crate) backward: f64,
    pub(crate) seconds: f64,
}

/// MeshLab's `get_hausdorff_distance`, both ways; `None` where Python has no `pymeshlab`.
pub(crate) fn meshlab_distance(a: &Mesh, b: &Mesh, samples: usize) -> Result<Option<MeshLab>> {
    let found = Command::new("python3")
        .args(["-c", "import pymeshlab"])
        .output();
    if !found.is_ok_and(|output| output.status.success()) {
        return Ok(None);
    }
    let folder_of_files = tempfile::tempdir()?;
    let write = |name: &str, mesh: &Mesh| -> Result<PathBuf> {
        let path = folder_of_files.path().join(name);
        let output = limitmesh_io::Output::new(mesh.as_triangles());
        limitmesh_io::write(&path, &output, &Default::default())?;
        Ok(path)
    };
    let (a, b) = (write("a.ply", a)?, write("b.ply", b)?);
    let output = Command::new("python3")
        .arg(folder().join("meshlab_distance.py"))
        .args([&a, &b])
        .arg(samples.to_string())
        .output()?;
    ensure!(
        output.status.success(),
        "MeshLab: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout)?;
    let line = text
        .lines()
        .last()
        .context("MeshLab's script printed nothing")?;
    let numbers = line
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<Vec<f64>, _>>()?;
    let [forward, backward, seconds] = numbers[..] else {
        anyhow::bail!("MeshLab's script printed {line}, expected three numbers");
    };
    Ok(Some(MeshLab {
        forward,
        backward,
        seconds,
    }))
}

/// Programs that simplify meshes by quadrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simplifier {
    MeshLab,
    Meshoptimizer,
}

impl Simplifier {
    pub(crate) const ALL: [Self; 2] = [Self::MeshLab, Self::Meshoptimizer];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::MeshLab => "MeshLab",
            Self::Meshoptimizer => "meshoptimizer",
        }
    }

    /// As `simplify.py` calls it; meshoptimizer's meshes are read and written by MeshLab.
    fn modules(self) -> (&'static str, &'static str) {
        match self {
            Self::MeshLab => ("meshlab", "import pymeshlab, numpy"),
            Self::Meshoptimizer => ("meshoptimizer", "import pymeshlab, numpy, meshoptimizer"),
        }
    }
}

/// A simplified mesh and the processor seconds of the collapses, without reading and writing.
pub(crate) struct Simplified {
    pub(crate) mesh: Mesh,
    pub(crate) seconds: f64,
}

/// `mesh` with about so many triangles; `None` where Python lacks the modules.
pub(crate) fn simplified(
    simplifier: Simplifier,
    mesh: &Mesh,
    triangles: usize,
) -> Result<Option<Simplified>> {
    let (name, import) = simplifier.modules();
    let found = Command::new("python3").args(["-c", import]).output();
    if !found.is_ok_and(|output| output.status.success()) {
        return Ok(None);
    }
    let folder_of_files = tempfile::tempdir()?;
    let [fine, coarse] = ["fine.ply", "coarse.ply"].map(|name| folder_of_files.path().join(name));
    let output = limitmesh_io::Output::new(mesh.as_triangles());
    limitmesh_io::write(&fine, &output, &Default::default())?;
    let output = Command::new("python3")
        .arg(folder().join("simplify.py"))
        .arg(name)
        .args([&fine, &coarse])
        .arg(triangles.to_string())
        .output()?;
    ensure!(
        output.status.success(),
        "{}: {}",
        simplifier.name(),
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout)?;
    let line = text.lines().last().context("the script printed nothing")?;
    Ok(Some(Simplified {
        mesh: crate::mesh(&coarse)?,
        seconds: line.trim().parse()?,
    }))
}

/// Seconds of writing a file and of reading it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exported {
    pub(crate) written: f64,
    pub(crate) read: f64,
}

/// Least seconds of trimesh for the triangles in a file, by ending; `None` where Python has no `trimesh`.
pub(crate) fn exported(
    file: &Path,
    to: &Path,
    repeats: usize,
    endings: &[&str],
) -> Result<Option<Vec<Exported>>> {
    // 3MF needs the other two.
    let found = Command::new("python3")
        .args(["-c", "import trimesh, lxml, networkx"])
        .output();
    if !found.is_ok_and(|output| output.status.success()) {
        return Ok(None);
    }
    let output = Command::new("python3")
        .arg(folder().join("export.py"))
        .args([file, to])
        .arg(repeats.to_string())
        .args(endings)
        .output()?;
    ensure!(
        output.status.success(),
        "trimesh: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout)?;
    let seconds = text.lines().map(|line| {
        let numbers = line
            .split_whitespace()
            .map(str::parse)
            .collect::<Result<Vec<f64>, _>>()?;
        let [written, read] = numbers[..] else {
            anyhow::bail!("trimesh's script printed {line}")
        };
        Ok(Exported { written, read })
    });
    Ok(Some(seconds.collect::<Result<_>>()?))
}
