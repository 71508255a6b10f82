//! `limitmesh refine --shared-topology`: the frames of an animation, refined with the same triangles.
//!
//! Takes files that share faces and tags; writes a file for each, and a report with what is proven of every frame.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::refine::{ErrorBounds, ExactStop, Frame, Frames, exact_frames_observed};
use limitmesh::{Mesh, PolygonSoup, QuadControl, Triangles};
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::control::Control;
use super::exact;
use super::goals::Goals;
use super::jobs::{self, Job};
use super::refined::Refined;
use super::source::{by_faces, item_of};
use super::task::Task;
use super::written;
use crate::arguments::{RefineArguments, Way};
use crate::failure::{Outcome, usage};
use crate::format::{bytes, counted, number, seconds, upper_bound};
use crate::input::{self, Input};
use crate::output;
use crate::progress::Progress;
use crate::report::{
    ErrorReport, FrameReport, FramesReport, FramesSeconds, MethodReport, VERSION, percent,
};

/// Positions that follow from others differ by no more than this share of the diagonal.
const ROUNDING: f64 = 1e-12;

/// Refines all inputs as frames of one mesh.
pub(super) fn run(arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    refuse(arguments)?;
    // The report is about all of them.
    let each = RefineArguments {
        report: None,
        ..arguments.clone()
    };
    let jobs = jobs::planned(&each)?;
    let is_scene = |format: &Format| format.is_gltf() || *format == Format::ThreeMf;
    if let Some(format) = jobs.iter().filter_map(|job| job.1).find(is_scene) {
        return usage(format!(
            "--shared-topology is for OBJ, PLY, OFF and STL files, not {format:?}"
        ));
    }
    jobs::make_ready(&each, &jobs)?;
    check_report(arguments, &jobs)?;
    let (_, format) = &jobs[0];
    let Read {
        first,
        frames,
        arguments: job,
    } = read(&jobs, progress)?;
    let (name, count) = (first.name.clone(), first.mesh.vertex_count());
    let (read, item) = item_of(first, &job, *format, progress)?;
    let control = Control::new(read, None, &item.arguments, progress)?;
    if control.mesh.vertex_count() != count {
        return usage(format!(
            "{name}: corners of 180° or more are divided by where they are, which frames do not share; \
             --concave-corners smooth leaves them"
        ));
    }
    let task = Task {
        control: &control,
        channels: &item.channels,
        arguments: &item.arguments,
        format: *format,
        is_traced: true,
        progress,
    };
    let goals = Goals::new(&task)?;
    let start = Instant::now();
    progress.stage(format!(
        "refining {} for {}",
        counted(control.mesh.face_count(), "triangle", "triangles"),
        counted(frames.len(), "frame", "frames")
    ));
    let options = goals.options(&task).flat_regions(false);
    let (scheme, observer) = (task.scheme()?, &mut progress.observer());
    let found = exact_frames_observed(&control.mesh, scheme, &frames, &options, observer)?;
    let refining = start.elapsed();
    let start = Instant::now();
    let channels = task
        .channels
        .refined(&control.mesh, &found.refined, scheme)?;
    let errors = write_all(&found, &frames, &jobs, channels, progress)?;
    let writing = start.elapsed();
    let worst = errors.iter().map(|error| error.upper).fold(0.0, f64::max);
    progress.note(in_words(&found, worst, control.diagonal, &name, refining));
    let refined = &found.refined;
    let is_beyond = goals.length.is_some_and(|length| worst > length);
    let stop = match refined.stop {
        ExactStop::Met | ExactStop::Cones if is_beyond => ExactStop::Rounding,
        stop => stop,
    };
    if let Some(path) = &arguments.report {
        let all = jobs.iter().zip(&errors).zip(&frames);
        let frames = all.map(|((job, error), positions)| {
            let own = Triangles {
                positions,
                triangles: control.mesh.triangles(),
            };
            FrameReport {
                input: input::display_name(job.0.input()),
                output: job.0.output_name(),
                error: ErrorReport::new(error, own.diagonal()),
            }
        });
        let report = FramesReport {
            version: VERSION,
            frames: frames.collect(),
            parameters: exact::parameters(&task, &goals)?,
            triangles: refined.mesh.face_count(),
            vertices: refined.mesh.vertex_count(),
            levels: refined.statistics.levels,
            stop: stop.name(),
            pixels: refined.pixels.filter(|pixels| pixels.is_finite()),
            open_cones: arguments.angle.map(|_| refined.statistics.open_cones),
            table_bytes: found.replay.table_bytes(),
            seconds: FramesSeconds {
                refine: refining.as_secs_f64(),
                write: writing.as_secs_f64(),
            },
        };
        progress.clear();
        output::write_json(path, &report)?;
    }
    Ok(match (stop, goals.length) {
        (ExactStop::Met | ExactStop::Cones, _) => Outcome::Done,
        (ExactStop::Rounding, Some(length)) => Outcome::StoppedShort(format!(
            "the tolerance of {} is finer than rounding leaves certain",
            number(length)
        )),
        // Caps on triangles and memory are errors: there would be no mesh for all frames.
        _ => Outcome::StoppedShort(format!(
            "--levels {} was reached before the goals were met for every frame",
            options.caps.levels
        )),
    })
}

/// The result for all frames in words: `worst` is the greatest distance of any, per cent are of the diagonal of the first, which is called `name`.
fn in_words(found: &Frames, worst: f64, diagonal: f64, name: &str, refining: Duration) -> String {
    let refined = &found.refined;
    let made = format!(
        "{}: {}, {} each ({}, {} for all frames; {})",
        counted(found.errors.len(), "frame", "frames"),
        counted(refined.mesh.face_count(), "triangle", "triangles"),
        counted(refined.mesh.vertex_count(), "vertex", "vertices"),
        counted(refined.statistics.levels, "level", "levels"),
        bytes(found.replay.table_bytes()),
        seconds(refining.as_secs_f64()),
    );
    let near = format!(
        "within {} of the limit surface of every frame ({:.4} % of the diagonal of {name})",
        upper_bound(worst),
        percent(worst, diagonal),
    );
    let lines = [Some(made), Some(near), exact::open_cones(refined)];
    lines.into_iter().flatten().collect::<Vec<_>>().join("\n  ")
}

/// Checks that the report of all frames can be written, and replaces none.
fn check_report(arguments: &RefineArguments, jobs: &[Job]) -> anyhow::Result<()> {
    let Some(report) = arguments.report.as_deref() else {
        return Ok(());
    };
    output::check_writable(report)?;
    let inputs: Vec<&Path> = jobs.iter().map(|(job, _)| job.input()).collect();
    output::check_replaced(&[report], &inputs, None)?;
    let outputs = jobs.iter().filter_map(|(job, _)| job.output.as_deref());
    output::check_once(&outputs.chain([report]).collect::<Vec<_>>())
}

/// Refuses what has no meaning for frames, or is not done for them.
fn refuse(arguments: &RefineArguments) -> anyhow::Result<()> {
    let exact = &arguments.exact;
    let given = [
        ("--scheme sqrt3", arguments.way().is_sqrt3()),
        ("--method other than exact", arguments.way() != Way::Exact),
        ("--within", exact.within.is_some()),
        ("--triangles", exact.triangles.is_some()),
        ("--balance", exact.balance),
        ("--optimize", exact.optimize),
        ("--dry-run", exact.dry_run),
        ("--provenance", exact.provenance),
        ("--split-normals", arguments.split_normals),
        ("--proof", arguments.proof.is_some()),
        ("--picture", arguments.picture.is_some()),
    ];
    let others = [
        arguments.channels.given_tolerance(),
        arguments.asset.given(),
        arguments.interpolation.given(),
    ];
    let given = given
        .into_iter()
        .filter_map(|(option, is_given)| is_given.then_some(option));
    match given.chain(others.into_iter().flatten()).next() {
        Some(option) => usage(format!("{option} does not go with --shared-topology")),
        None => Ok(()),
    }
}

/// What was read.
struct Read {
    first: Input,
    /// The positions of all frames.
    frames: Vec<Vec<[f64; 3]>>,
    /// The arguments, with the scheme that the faces decide.
    arguments: RefineArguments,
}

/// Reads all frames.
///
/// # Errors
/// A file cannot be read, or has other faces or tags than the first.
fn read(jobs: &[Job], progress: &Progress) -> anyhow::Result<Read> {
    let (job, format) = &jobs[0];
    let mut read = input::read_for(job.input(), &job.build, &job.channels, progress)?;
    let job = by_faces(job, &read.name, read.is_of_quads(), progress);
    read.quads = job.quads();
    let soup = read.soup.clone();
    let options = job.build.in_unit(read.unit).options()?;
    let quads = read.quads.as_ref();
    let quads = quads.map(|rules| QuadControl::from_soup_with(&soup, &options, rules));
    let quads = quads.transpose().with_context(|| read.name.clone())?;
    // Polygons are cut into triangles by where their corners are: as in the first frame, in all.
    let first = input::connect(read, &job.build, Normals::kept(*format), progress)?;
    let own = FirstFrame {
        name: &first.name,
        mesh: &first.mesh,
        vertices: first.trace.vertices(&soup),
        soup: &soup,
        quads: quads.map(|(quads, _)| quads),
    };
    if !own.is_moved_by_vertices(first.mesh.as_triangles().diagonal())? {
        anyhow::bail!(
            "{}: sheets are cut apart within edges there, which frames do not share",
            first.name
        );
    }
    let mut frames = vec![first.mesh.positions().to_vec()];
    for (job, _) in &jobs[1..] {
        let frame = input::read(job.input(), &job.build, progress)?;
        if let Some(what) = own.difference(&frame.soup) {
            anyhow::bail!("{}: {what}; frames must share faces and tags", frame.name);
        }
        let positions = own.positions(&frame.soup.positions);
        frames.push(positions.with_context(|| frame.name.clone())?);
    }
    Ok(Read {
        first,
        frames,
        arguments: job,
    })
}

/// The properties that all frames must share with the first.
struct FirstFrame<'a> {
    name: &'a str,
    soup: &'a PolygonSoup,
    mesh: &'a Mesh,
    /// By corner of the mesh, the vertex in the file.
    vertices: Vec<u32>,
    /// The mesh as quads, where its scheme is for these.
    quads: Option<QuadControl>,
}

impl FirstFrame<'_> {
    /// Whether the mesh's own positions follow from those of the file's vertices; `diagonal` is its size.
    fn is_moved_by_vertices(&self, diagonal: f64) -> anyhow::Result<bool> {
        let own = self.positions(&self.soup.positions)?;
        let near = |(a, b): (&[f64; 3], &[f64; 3])| {
            (0..3).all(|axis| (a[axis] - b[axis]).abs() <= ROUNDING * diagonal)
        };
        Ok(own.iter().zip(self.mesh.positions()).all(near))
    }

    /// The positions of the mesh's vertices in a frame, given those of the file's.
    fn positions(&self, frame: &[[f64; 3]]) -> anyhow::Result<Vec<[f64; 3]>> {
        if let Some(quads) = &self.quads {
            return Ok(quads.positions(self.soup, frame)?);
        }
        let at = |vertex: u32| frame[vertex as usize];
        let mut found: Vec<Option<u32>> = vec![None; self.mesh.vertex_count()];
        let corners = self.mesh.triangles().as_flattened();
        for (&corner, &vertex) in corners.iter().zip(&self.vertices) {
            let first = *found[corner as usize].get_or_insert(vertex);
            anyhow::ensure!(
                at(first) == at(vertex),
                "vertices {first} and {vertex} are apart, which are one in {}",
                self.name
            );
        }
        Ok(found
            .into_iter()
            .map(|vertex| vertex.map_or([0.0; 3], at))
            .collect())
    }

    /// The first thing in which what a frame's file holds differs from what the first one's does.
    fn difference(&self, frame: &PolygonSoup) -> Option<String> {
        let (name, first) = (self.name, self.soup);
        let counts = [
            (
                "vertex",
                "vertices",
                frame.positions.len(),
                first.positions.len(),
            ),
            ("face", "faces", frame.faces.len(), first.faces.len()),
            (
                "crease tag",
                "crease tags",
                frame.creases.len(),
                first.creases.len(),
            ),
            (
                "corner tag",
                "corner tags",
                frame.corners.len(),
                first.corners.len(),
            ),
        ];
        for (one, many, own, theirs) in counts {
            if own != theirs {
                let own = counted(own, one, many);
                return Some(format!("{own}, where {name} has {theirs}"));
            }
        }
        let mut faces = frame.faces.iter().zip(first.faces.iter()).enumerate();
        if let Some((face, (own, theirs))) = faces.find(|(_, (own, theirs))| own != theirs) {
            return Some(format!(
                "face {face} is {own:?}, where that of {name} is {theirs:?}"
            ));
        }
        let mut creases = frame.creases.iter().zip(&first.creases);
        if let Some((own, theirs)) = creases.find(|(own, theirs)| own != theirs) {
            let ([a, b], [c, d]) = (own.vertices, theirs.vertices);
            return Some(format!(
                "a crease of sharpness {} from vertex {a} to {b}, where {name} has one of {} from {c} to {d}",
                own.sharpness, theirs.sharpness
            ));
        }
        let mut corners = frame.corners.iter().zip(&first.corners);
        corners
            .find(|(own, theirs)| own != theirs)
            .map(|(own, theirs)| {
                format!(
                    "a corner of sharpness {} at vertex {}, where {name} has one of {} at {}",
                    own.sharpness, own.vertex, theirs.sharpness, theirs.vertex
                )
            })
    }
}

/// Writes all frames; gives what is proven of them as they were written.
fn write_all(
    found: &Frames,
    frames: &[Vec<[f64; 3]>],
    jobs: &[Job],
    channels: Channels,
    progress: &Progress,
) -> anyhow::Result<Vec<ErrorBounds>> {
    let exact = &found.refined;
    let report = MethodReport::new(exact.statistics.levels, exact.stop.name());
    let mut frame = Frame::default();
    let mut refined = Refined {
        channels,
        ..Refined::new(exact.mesh.clone(), String::new(), report, Outcome::Done)
    };
    let mut errors = Vec::with_capacity(frames.len());
    for (number, (job, format)) in jobs.iter().enumerate() {
        let file = job.output.as_deref().zip(*format);
        debug_assert!(file.is_some(), "a frame has a file and its format");
        let (path, format) = file.context("a frame has no file to be written to")?;
        progress.stage(format!("writing {}", job.output_name()));
        found.replay.frame(&frames[number], &mut frame)?;
        let mut moved = exact.clone().moved_to(&frame)?;
        let options = job.write_options();
        let rounding = limitmesh_io::rounding(format, &options, moved.mesh.positions());
        errors.push(found.errors[number].rounded(rounding));
        refined.normals = Normals::are_held(format).then(|| Normals::of_exact(&mut moved));
        refined.mesh = moved.mesh;
        if number == 0 {
            let surface = refined.mesh.as_triangles();
            let splits = refined.channels.split_vertices(format, surface);
            let normals = refined.normals.as_ref();
            progress.notes(normals.and_then(|all| all.note(format, false)));
            progress.notes(refined.channels.note(format, surface, splits));
        }
        // Frames have as many vertices as each other, whatever their normals.
        written::write(path, format, false, job, &refined)?;
    }
    Ok(errors)
}
