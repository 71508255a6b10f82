//! `limitmesh refine --shared-topology`: the frames of an animation, refined with the same triangles.
//!
//! Takes files that share faces and tags; writes a file for each, and a report with what is proven of every frame.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::mesh::Tags;
use limitmesh::refine::{Exact, ExactStop, Frame, Frames, exact_frames_observed};
use limitmesh::{Mesh, PolygonSoup};
use limitmesh_io::Format;

use super::super::channels::{Channels, Destination};
use super::super::normals::Normals;
use super::carried::Trail;
use super::control::Control;
use super::exact;
use super::goals::Goals;
use super::{Refined, check, jobs, looked_at, write};
use crate::arguments::{RefineArguments, Way};
use crate::bulk::Shown;
use crate::failure::{Outcome, usage};
use crate::format::{counted, number, seconds, upper_bound};
use crate::input::{self, Input};
use crate::output;
use crate::progress::Progress;
use crate::report::refinement::exact_stop_name;
use crate::report::{
    ErrorReport, FrameReport, FramesReport, FramesSeconds, MethodReport, VERSION, percent,
};

/// Refines all inputs as frames of one mesh.
pub(super) fn run(arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    refuse(arguments)?;
    // The report is about all of them.
    let each = RefineArguments {
        report: None,
        ..arguments.clone()
    };
    let jobs = jobs::jobs(&each)?;
    check::together(arguments, &jobs)?;
    let formats = jobs
        .iter()
        .map(check::options)
        .collect::<anyhow::Result<Vec<_>>>()?;
    if let Some(Some(format)) = formats.iter().find(|format| format.is_none_or(is_scene)) {
        return usage(format!(
            "--shared-topology is for OBJ, PLY, OFF and STL files, not {format:?}"
        ));
    }
    jobs::make_folders(&each)?;
    jobs.iter().try_for_each(check::files)?;
    check_report(arguments, &jobs)?;
    let (first, frames) = read(&jobs, formats[0], progress)?;
    let (decided, note) = looked_at(&jobs[0], (&first.mesh, &first.trace.faces), &first.hints());
    note.into_iter().for_each(|note| progress.note(note));
    let first = first.with_creases(decided.features.creases_from)?;
    let Input {
        mesh,
        diagnosis,
        trace,
        name,
        channels,
        material_libraries,
        texture_files,
        ..
    } = first;
    let files = [material_libraries, texture_files];
    let channels = Channels::of_input(
        channels,
        files,
        &Destination::of(&jobs[0], formats[0]),
        progress,
    );
    let arguments_of_one = RefineArguments {
        exact: without_input_distance(arguments),
        ..decided
    };
    let count = mesh.vertex_count();
    let control = Control::new(
        (mesh, diagnosis, trace.faces),
        Shown::default(),
        None,
        &arguments_of_one,
        progress,
    )?;
    let (control, diagonal) = (control.featured.mesh, control.diagonal);
    if control.vertex_count() != count {
        return usage(format!(
            "{name}: corners of 180° or more are divided by where they are, which frames do not share; \
             --concave-corners as-tagged leaves them"
        ));
    }
    let goals = Goals::new(&arguments_of_one, &control, diagonal)?;
    let start = Instant::now();
    progress.stage(format!(
        "refining {} for {}",
        counted(control.face_count(), "triangle", "triangles"),
        counted(frames.len(), "frame", "frames")
    ));
    let options = goals
        .options(&arguments_of_one)
        .flat_regions(false)
        .origins(true);
    let scheme = arguments.scheme()?;
    let found = exact_frames_observed(
        &control,
        scheme,
        &frames,
        &options,
        &mut progress.observer(),
    )?;
    let refining = start.elapsed();
    let start = Instant::now();
    let carried = channels.refined(&control, &found.refined, scheme)?;
    let errors = write_all(&found, &frames, (&jobs, &formats), carried, progress)?;
    let writing = start.elapsed();
    let worst = errors.iter().map(|error| error.upper).fold(0.0, f64::max);
    let mesh = &found.refined.mesh;
    progress.note(in_words(&found, (worst, diagonal), &name, refining));
    let stop = match found.refined.stop {
        ExactStop::Met | ExactStop::Cones if goals.length.is_some_and(|length| worst > length) => {
            ExactStop::Rounding
        }
        stop => stop,
    };
    if let Some(path) = &arguments.report {
        let frames = jobs
            .iter()
            .zip(&errors)
            .zip(&frames)
            .map(|((job, error), positions)| FrameReport {
                input: input::display_name(job.input()),
                output: job.output_name(),
                error: ErrorReport::new(error, diagonal_of(&control, positions)),
            });
        let report = FramesReport {
            version: VERSION,
            frames: frames.collect(),
            parameters: exact::parameters(&arguments_of_one, &goals),
            triangles: mesh.face_count(),
            vertices: mesh.vertex_count(),
            levels: found.refined.levels,
            stop: exact_stop_name(stop),
            pixels: found.refined.pixels.filter(|pixels| pixels.is_finite()),
            open_cones: arguments.angle.map(|_| found.refined.open_cones),
            table_bytes: found.replay.table_bytes(),
            seconds: FramesSeconds {
                refine: refining.as_secs_f64(),
                write: writing.as_secs_f64(),
            },
        };
        progress.clear();
        output::write_json(path, &report)?;
    }
    Ok(match stop {
        ExactStop::Met | ExactStop::Cones => Outcome::Done,
        ExactStop::Rounding => Outcome::StoppedShort(format!(
            "the tolerance of {} is finer than rounding leaves certain",
            number(goals.length.unwrap_or_default())
        )),
        // Caps on triangles and memory are errors: there would be no mesh for all frames.
        _ => Outcome::StoppedShort(format!(
            "--max-levels {} was reached before the goals were met for every frame",
            options.max_levels
        )),
    })
}

/// What came of all frames: `worst` is the greatest distance of any, per cent are of the diagonal of the first, which is called `name`.
fn in_words(
    found: &Frames,
    (worst, diagonal): (f64, f64),
    name: &str,
    refining: Duration,
) -> String {
    let mesh = &found.refined.mesh;
    let made = format!(
        "{}: {}, {} each ({}, {} for all frames; {})",
        counted(found.errors.len(), "frame", "frames"),
        counted(mesh.face_count(), "triangle", "triangles"),
        counted(mesh.vertex_count(), "vertex", "vertices"),
        counted(found.refined.levels, "level", "levels"),
        crate::format::bytes(found.replay.table_bytes()),
        seconds(refining.as_secs_f64()),
    );
    let near = format!(
        "within {} of the limit surface of every frame ({:.4} % of the diagonal of {name})",
        upper_bound(worst),
        percent(worst, diagonal),
    );
    let lines = [Some(made), Some(near), exact::open_cones(&found.refined)];
    lines.into_iter().flatten().collect::<Vec<_>>().join("\n  ")
}

fn is_scene(format: Format) -> bool {
    format.is_gltf() || format == Format::ThreeMf
}

/// Checks that the report of all frames can be written, and replaces none.
fn check_report(arguments: &RefineArguments, jobs: &[RefineArguments]) -> anyhow::Result<()> {
    let Some(report) = arguments.report.as_deref() else {
        return Ok(());
    };
    output::check_writable(report)?;
    let inputs: Vec<&Path> = jobs.iter().map(RefineArguments::input).collect();
    output::check_replaced(&[report], &inputs, None)?;
    let outputs = jobs.iter().filter_map(|job| job.output.as_deref());
    output::check_once(&outputs.chain([report]).collect::<Vec<_>>())
}

/// Refuses what has no meaning for frames, or is not done for them.
fn refuse(arguments: &RefineArguments) -> anyhow::Result<()> {
    let given = [
        ("--scheme sqrt3", arguments.way().is_sqrt3()),
        ("--method other than exact", arguments.way() != Way::Exact),
        ("--within", arguments.exact.within.is_some()),
        ("--triangles", arguments.exact.triangles.is_some()),
        ("--balance", arguments.exact.balance),
        ("--optimize", arguments.exact.optimize),
        ("--dry-run", arguments.exact.dry_run),
        ("--provenance", arguments.exact.provenance),
        ("--split-normals", arguments.split_normals),
        ("--proof", arguments.proof.is_some()),
        ("--picture", arguments.picture.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|&(_, given)| given) {
        return usage(format!("{option} does not go with --shared-topology"));
    }
    let others = arguments
        .channels
        .given_tolerance()
        .or(arguments.asset.given());
    if let Some(option) = others.or(arguments.interpolation.given()) {
        return usage(format!("{option} does not go with --shared-topology"));
    }
    Ok(())
}

/// How far results are from the inputs is not looked at.
fn without_input_distance(arguments: &RefineArguments) -> crate::arguments::ExactArguments {
    crate::arguments::ExactArguments {
        no_input_distance: true,
        ..arguments.exact.clone()
    }
}

/// The first frame, and the positions of all.
///
/// # Errors
/// A file cannot be read, or has other faces or tags than the first.
fn read(
    jobs: &[RefineArguments],
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<(Input, Vec<Vec<[f64; 3]>>)> {
    let (job, kept) = (&jobs[0], Normals::kept(format));
    let read = input::read_for(job.input(), &job.build, &job.channels, progress)?;
    let soup = read.soup.clone();
    // Polygons are cut into triangles by where their corners are: as in the first frame, in all.
    let first = input::connect(read, &job.build, kept, progress)?;
    let own = Own {
        name: &first.name,
        mesh: &first.mesh,
        vertices: first.trace.vertices(&soup),
        soup: &soup,
    };
    if own.positions(&soup)? != first.mesh.positions() {
        anyhow::bail!(
            "{}: sheets are cut apart within edges there, which frames do not share",
            first.name
        );
    }
    let mut frames = vec![first.mesh.positions().to_vec()];
    for job in &jobs[1..] {
        let frame = input::read(job.input(), &job.build, progress)?;
        if let Some(what) = own.difference(&frame.soup) {
            anyhow::bail!("{}: {what}; frames must share faces and tags", frame.name);
        }
        frames.push(
            own.positions(&frame.soup)
                .with_context(|| frame.name.clone())?,
        );
    }
    Ok((first, frames))
}

/// What all frames must share with the first.
struct Own<'a> {
    name: &'a str,
    soup: &'a PolygonSoup,
    mesh: &'a Mesh,
    /// By corner of the mesh, the vertex in the file.
    vertices: Vec<u32>,
}

impl Own<'_> {
    /// The positions of the mesh's vertices in a frame.
    fn positions(&self, frame: &PolygonSoup) -> anyhow::Result<Vec<[f64; 3]>> {
        let mut found: Vec<Option<u32>> = vec![None; self.mesh.vertex_count()];
        for (&corner, &vertex) in self
            .mesh
            .triangles()
            .as_flattened()
            .iter()
            .zip(&self.vertices)
        {
            let first = *found[corner as usize].get_or_insert(vertex);
            let [a, b] = [first, vertex].map(|vertex| frame.positions[vertex as usize]);
            if a != b {
                anyhow::bail!(
                    "vertices {first} and {vertex} are apart, which are one in {}",
                    self.name
                );
            }
        }
        let place = |vertex: Option<u32>| {
            vertex.map_or([0.0; 3], |vertex| frame.positions[vertex as usize])
        };
        Ok(found.into_iter().map(place).collect())
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
        ];
        for (one, many, own, theirs) in counts {
            if own != theirs {
                return Some(format!(
                    "{}, where {name} has {theirs}",
                    counted(own, one, many)
                ));
            }
        }
        let differs = |(_, (own, theirs)): &(usize, (&[u32], &[u32]))| own != theirs;
        if let Some((face, (own, theirs))) = frame
            .faces
            .iter()
            .zip(first.faces.iter())
            .enumerate()
            .find(differs)
        {
            return Some(format!(
                "face {face} is {own:?}, where that of {name} is {theirs:?}"
            ));
        }
        let tags = |soup: &PolygonSoup| Tags {
            creases: soup.creases.clone(),
            corners: soup.corners.clone(),
        };
        tag_difference(name, &tags(first), &tags(frame))
    }
}

fn tag_difference(name: &str, first: &Tags, frame: &Tags) -> Option<String> {
    let counts = [
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
            return Some(format!(
                "{}, where {name} has {theirs}",
                counted(own, one, many)
            ));
        }
    }
    let crease = frame
        .creases
        .iter()
        .zip(&first.creases)
        .find(|(own, theirs)| own != theirs);
    if let Some((own, theirs)) = crease {
        let [a, b] = own.vertices;
        return Some(format!(
            "a crease of sharpness {} from vertex {a} to {b}, where {name} has one of {} from {} to {}",
            own.sharpness, theirs.sharpness, theirs.vertices[0], theirs.vertices[1]
        ));
    }
    let corner = frame
        .corners
        .iter()
        .zip(&first.corners)
        .find(|(own, theirs)| own != theirs);
    corner.map(|(own, theirs)| {
        format!(
            "a corner of sharpness {} at vertex {}, where {name} has one of {} at {}",
            own.sharpness, own.vertex, theirs.sharpness, theirs.vertex
        )
    })
}

/// Writes all frames; gives what is proven of them as they were written.
fn write_all(
    found: &Frames,
    frames: &[Vec<[f64; 3]>],
    (jobs, formats): (&[RefineArguments], &[Option<Format>]),
    channels: Channels,
    progress: &Progress,
) -> anyhow::Result<Vec<limitmesh::refine::ErrorBounds>> {
    let mut frame = Frame::default();
    let mut refined = refined(&found.refined, channels);
    let mut errors = Vec::with_capacity(frames.len());
    for (number, (job, format)) in jobs.iter().zip(formats).enumerate() {
        let (Some(path), &Some(format)) = (&job.output, format) else {
            continue;
        };
        progress.stage(format!("writing {}", job.output_name()));
        found.replay.frame(&frames[number], &mut frame)?;
        let mut moved = found.refined.clone().moved_to(&frame)?;
        let options = job.write_options();
        let rounding = limitmesh_io::rounding(format, &options, moved.mesh.positions());
        let mut error = found.errors[number];
        error.upper += rounding;
        error.lower = (error.lower - rounding).max(0.0);
        errors.push(error);
        refined.normals = Normals::are_held(format).then(|| Normals::of_exact(&mut moved));
        if number == 0 {
            let splits = refined
                .channels
                .split_vertices(format, moved.mesh.as_triangles());
            let notes = [
                refined
                    .normals
                    .as_ref()
                    .and_then(|all| all.note(format, false))
                    .map(str::to_owned),
                refined
                    .channels
                    .note(format, moved.mesh.as_triangles(), splits),
            ];
            notes
                .into_iter()
                .flatten()
                .for_each(|note| progress.note(note));
        }
        refined.mesh = moved.mesh;
        // Frames have as many vertices as each other, whatever their normals.
        write(path, (format, false), job, &refined)?;
    }
    Ok(errors)
}

/// What is written, but for positions and normals.
fn refined(found: &Exact, channels: Channels) -> Refined {
    Refined {
        mesh: found.mesh.clone(),
        normals: None,
        channels,
        provenance: None,
        trail: Trail::default(),
        achieved: Vec::new(),
        inverted: None,
        how: String::new(),
        report: MethodReport::new(found.levels, exact_stop_name(found.stop)),
        outcome: Outcome::Done,
    }
}

/// The diagonal of a frame's control mesh.
fn diagonal_of(control: &Mesh, positions: &[[f64; 3]]) -> f64 {
    limitmesh::Triangles {
        positions,
        triangles: control.triangles(),
    }
    .diagonal()
}
