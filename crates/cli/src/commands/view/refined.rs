//! One answer of the slider: the file refined to a tolerance as `limitmesh refine` does it, with distances and its uniform counterpart.

use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;

use anyhow::Context;
use clap::Parser;
use limitmesh_io::gltf::with_images;
use limitmesh_view::{Report, Stop, UniformReport};
use serde_json::Value;
use tempfile::TempDir;

use super::super::refine;
use super::subject::Subject;
use crate::arguments::{Arguments, Command, RefineArguments, Way};
use crate::input;
use crate::progress::{Host, Progress};

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    /// A share of the diagonal.
    pub(super) tolerance: f64,
    /// Whether a uniform mesh is to stand next to it.
    pub(super) uniform: bool,
}

/// Levels of uniform refinement at most: beyond them a control face has over a million triangles.
const MOST_LEVELS: u32 = 10;

/// Whoever waits for a mesh: work ends once nobody does, and what there is to say is kept.
pub(super) struct Listener<'a> {
    is_gone: &'a (dyn Fn() -> bool + 'a),
    notes: Mutex<Vec<String>>,
}

impl<'a> Listener<'a> {
    pub(super) fn new(is_gone: &'a (dyn Fn() -> bool + 'a)) -> Self {
        Self {
            is_gone,
            notes: Mutex::default(),
        }
    }

    /// What there was to say, but of files that nobody sees.
    fn notes(&self, folder: &TempDir) -> Vec<String> {
        let folder = folder.path().to_string_lossy();
        let all = self.notes.lock().map(|notes| notes.clone());
        let seen = all.unwrap_or_default().into_iter();
        // Lines that begin with blanks go on about a file.
        seen.filter(|line| !line.contains(&*folder) && !line.starts_with(' '))
            .collect()
    }
}

impl Host for Listener<'_> {
    fn observe(&self, _: &limitmesh::progress::Progress) -> ControlFlow<()> {
        match (self.is_gone)() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    fn note(&self, line: &str) {
        if let Ok(mut notes) = self.notes.lock() {
            notes.push(line.to_owned());
        }
    }
}

/// The mesh at a stop of the slider.
///
/// # Errors
/// The file cannot be refined, or nobody waits for it any more.
pub(super) fn stop(
    subject: &Subject<'_>,
    wanted: Wanted,
    listener: &Listener<'_>,
) -> anyhow::Result<Stop> {
    let progress = &Progress::to_host(listener);
    let folder = tempfile::tempdir()?;
    let percent = format!("{}%", 100.0 * wanted.tolerance);
    let glb = refined(
        subject,
        &folder,
        "refined.glb",
        &["--tolerance", &percent],
        progress,
    )?;
    let glb = with_images(&glb, folder.path())?;
    let mut report = report(&folder)?;
    report.words = listener.notes(&folder);
    let distances = distances(subject, &folder.path().join("refined.glb"), &glb, progress)?;
    let stop = Stop {
        tolerance: wanted.tolerance,
        report,
        glb,
        distances,
        ..Stop::default()
    };
    match wanted.uniform {
        true => with_uniform(stop, subject, &folder, progress),
        false => Ok(stop),
    }
}

/// The refined mesh as a file of some kind.
///
/// # Errors
/// Those of [`stop`].
pub(super) fn file(
    subject: &Subject<'_>,
    tolerance: f64,
    extension: &str,
    listener: &Listener<'_>,
) -> anyhow::Result<Vec<u8>> {
    let progress = &Progress::to_host(listener);
    let folder = tempfile::tempdir()?;
    let percent = format!("{}%", 100.0 * tolerance);
    let name = format!("refined.{extension}");
    refined(
        subject,
        &folder,
        &name,
        &["--tolerance", &percent],
        progress,
    )
}

/// Adds uniform subdivision with about as many triangles, all on the limit surface.
fn with_uniform(
    mut stop: Stop,
    subject: &Subject<'_>,
    folder: &TempDir,
    progress: &Progress,
) -> anyhow::Result<Stop> {
    let apart = |levels: &u32| {
        let triangles = subject.faces as f64 * 4f64.powi(*levels as i32);
        (triangles / stop.report.triangles.max(1) as f64).ln().abs()
    };
    // Without a level it would be the control mesh.
    let levels = (1..=MOST_LEVELS).min_by(|a, b| apart(a).total_cmp(&apart(b)));
    let levels = levels.unwrap_or(1);
    let words = levels.to_string();
    let options = ["--method", "uniform", "--limit", "--levels", &words];
    let glb = refined(subject, folder, "uniform.glb", &options, progress)?;
    let own = report(folder)?;
    let path = folder.path().join("uniform.glb");
    stop.uniform_distances = distances(subject, &path, &glb, progress)?;
    let greatest = stop
        .uniform_distances
        .as_ref()
        .map(|all| all.iter().copied().fold(0.0, f32::max));
    stop.report.uniform = Some(UniformReport {
        levels,
        triangles: own.triangles,
        upper: greatest.map(f64::from),
    });
    stop.uniform = Some(with_images(&glb, folder.path())?);
    Ok(stop)
}

/// Refines the file with these options; gives the file that comes out.
fn refined(
    subject: &Subject<'_>,
    folder: &TempDir,
    name: &str,
    options: &[&str],
    progress: &Progress,
) -> anyhow::Result<Vec<u8>> {
    let path = folder.path().join(name);
    let report = folder.path().join(REPORT);
    let mut words: Vec<OsString> = vec!["limitmesh".into(), "refine".into()];
    words.extend([
        subject.file.clone().into(),
        "-o".into(),
        path.clone().into(),
    ]);
    words.extend(["--overwrite".into(), "--report".into(), report.into()]);
    words.extend(options.iter().map(OsString::from));
    let Command::Refine(own) = Arguments::try_parse_from(words)?.command else {
        anyhow::bail!("these are no arguments of refine");
    };
    let limit = subject.limit;
    // What looks sharp is decided by exact refinement itself; uniform refinement takes what was decided.
    let sharpness = match own.way() {
        Way::Exact => limit,
        _ => subject.decided,
    };
    let arguments = RefineArguments {
        features: sharpness.features,
        interpolation: sharpness.interpolation,
        build: limit.build,
        scheme: limit.scheme.map(Into::into),
        smooth_triangles: limit.smooth_triangles,
        ..*own
    };
    refine::run(&arguments, progress)?;
    std::fs::read(&path).with_context(|| path.display().to_string())
}

const REPORT: &str = "report.json";

/// What `refine` reports, of one mesh or of all meshes of an asset together.
fn report(folder: &TempDir) -> anyhow::Result<Report> {
    let text = std::fs::read(folder.path().join(REPORT))?;
    let all: Value = serde_json::from_slice(&text)?;
    let meshes = match all["meshes"].as_array() {
        Some(meshes) => meshes.iter().collect(),
        None => vec![&all],
    };
    let count = |name: &str| {
        let own = |mesh: &&Value| mesh["output"][name].as_u64().unwrap_or_default() as usize;
        meshes.iter().map(own).sum()
    };
    let greatest = |name: &str| {
        let own = meshes.iter().map(|mesh| mesh["error"][name].as_f64());
        own.collect::<Option<Vec<f64>>>()?
            .into_iter()
            .reduce(f64::max)
    };
    Ok(Report {
        triangles: count("triangles"),
        vertices: count("vertices"),
        upper: greatest("upper"),
        lower: greatest("lower"),
        certified: meshes.iter().all(|mesh| mesh["error"]["certified"] == true),
        seconds: all["seconds"]["refine"].as_f64().unwrap_or_default(),
        words: Vec::new(),
        uniform: None,
    })
}

/// The distances of a GLB file's triangles; none where the order of its triangles is not that of its primitives, or where they are too
/// many.
fn distances(
    subject: &Subject<'_>,
    path: &Path,
    glb: &[u8],
    progress: &Progress,
) -> anyhow::Result<Option<Vec<f32>>> {
    let Some(measure) = subject.distances() else {
        return Ok(None);
    };
    if !is_one_mesh(glb) {
        return Ok(None);
    }
    let read = input::read(path, &subject.limit.build, progress)?;
    Ok(measure.of(&read.soup, progress))
}

/// Whether a GLB file shows one mesh, once.
fn is_one_mesh(glb: &[u8]) -> bool {
    let length = glb.get(12..16).and_then(|bytes| bytes.try_into().ok());
    let length = length.map_or(0, |bytes| u32::from_le_bytes(bytes) as usize);
    let text = glb.get(20..20 + length).unwrap_or_default();
    let document: Value = serde_json::from_slice(text).unwrap_or_default();
    let nodes = document["nodes"].as_array();
    let shown = nodes.map_or(0, |nodes| {
        nodes
            .iter()
            .filter(|node| node.get("mesh").is_some())
            .count()
    });
    let meshes = document["meshes"].as_array().map_or(0, Vec::len);
    shown == 1 && meshes == 1
}
