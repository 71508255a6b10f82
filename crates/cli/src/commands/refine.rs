//! `limitmesh refine`: reads a control mesh, refines it, writes the result, a report and a picture.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal, Sight, View};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{Tags, Weld};
use limitmesh::refine::{Refinement, StepReport, StepwiseOptions, Stop, UniformOptions, stepwise, uniform};
use limitmesh_io::{Format, Output, WriteOptions};
use limitmesh_render::Style;

use super::picture;
use crate::arguments::{Method, RefineArguments, Seam};
use crate::failure::{Outcome, UsageError, usage};
use crate::input::{self, Input};
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use crate::report::refinement::stop_name;
use crate::report::{
    InputReport, OutputReport, ParametersReport, RefineReport, SecondsReport, StepEntry, VERSION, ViewReport,
};
use crate::words::{counted, seconds, thousands};

/// The angle where none is given, in degrees: the paper's middle one.
const USUAL_ANGLE: f64 = 10.0;

/// The dilatant factor where none is given: the paper's in most of its experiments.
const USUAL_DILATATION: f64 = 1.0;

/// Refines a mesh.
pub(crate) fn run(arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let format = check(arguments)?;
    let input = input::load(&arguments.input, &arguments.build.options(), progress)?;
    let input_report = InputReport {
        path: input.name,
        format: input.format,
        vertices: input.diagnosis.input_vertices,
        faces: input.diagnosis.input_faces,
        left_out: input.left_out,
    };
    let Input { mesh: control, diagnosis, reading, building, .. } = input;
    if let Some(note) = lost_tags(control.tags(), format) {
        progress.note(note);
    }

    let start = Instant::now();
    let Refinement { mesh, steps, stop, .. } = refine(&control, arguments, progress)?;
    drop(control);
    let (mesh, normals) = finish(mesh, arguments, format, progress)?;
    let refining = start.elapsed();

    progress.stage(format!("writing {}", arguments.output.display()));
    let start = Instant::now();
    write(&arguments.output, &mesh, normals.as_deref(), arguments.ascii)?;
    let writing = start.elapsed();
    progress.note(summary(arguments, &mesh, &steps, stop, refining));

    if let Some(path) = &arguments.report {
        progress.stage("examining the result");
        let report = RefineReport {
            version: VERSION,
            input: input_report,
            diagnosis: (&diagnosis).into(),
            parameters: parameters(arguments),
            steps: steps.iter().map(StepEntry::from).collect(),
            stop: stop_name(stop),
            needed_triangles: match stop {
                Stop::TriangleCap { needed } => Some(needed),
                _ => None,
            },
            output: OutputReport::of(arguments.output.display().to_string(), &mesh),
            seconds: phases(reading, building, refining, writing),
        };
        progress.clear();
        output::write_json(path, &report)?;
    }
    if let Some(path) = &arguments.picture {
        progress.stage(format!("drawing {}", path.display()));
        let style = Style::default().wireframe(true);
        let view = picture::view_direction(arguments.view);
        picture::draw(path, mesh.as_triangles(), normals.as_deref(), view, &style, picture::SIZE)?;
    }
    Ok(outcome(arguments, &mesh, &steps, stop))
}

/// Tells about tags of the input that the output's format has no place for.
fn lost_tags(tags: &Tags, format: Format) -> Option<String> {
    if tags.is_empty() || format == Format::Obj {
        return None;
    }
    let kinds = [
        (tags.creases.len(), "crease tag", "crease tags"),
        (tags.corners.len(), "corner tag", "corner tags"),
    ];
    let found: Vec<String> = kinds
        .into_iter()
        .filter(|&(count, ..)| count > 0)
        .map(|(count, one, many)| counted(count, one, many))
        .collect();
    Some(format!("{}: followed, but left out of the output, whose format has none", found.join(" and ")))
}

/// Finds what makes no sense before any work is done; gives the format to write.
fn check(arguments: &RefineArguments) -> anyhow::Result<Format> {
    let uniform = arguments.method == Method::Uniform;
    if uniform && arguments.angle.is_some() {
        return usage("--angle has no effect with --method uniform, which divides every face");
    }
    if uniform && arguments.seam.is_some() {
        return usage(
            "--seam has no effect with --method uniform, where divided and undivided faces never meet",
        );
    }
    let view = arguments.view.is_some() || arguments.eye.is_some();
    if view && arguments.method != Method::LimitNormal {
        return usage(
            "--view and --eye make the limit-normal method depend on the viewer; they need --method limit-normal",
        );
    }
    if arguments.dilatation.is_some() && !view {
        return usage(
            "--dilatation widens the angle of faces that look at a viewer; it needs --view or --eye",
        );
    }
    let format = Format::from_path(&arguments.output).map_err(|unknown| UsageError(unknown.to_string()))?;
    output::check_folder(&arguments.output)?;
    let input = Path::new(&arguments.input);
    let mut written = vec![arguments.output.as_path()];
    if let Some(picture) = &arguments.picture {
        picture::check_name(picture)?;
        written.push(picture);
    }
    if let Some(report) = &arguments.report {
        output::check_folder(report)?;
        written.push(report);
    }
    if let Some(path) = written[1..].iter().find(|path| input::same_file(input, path)) {
        return usage(format!("{} is the input; a report or picture would replace it", path.display()));
    }
    for (i, path) in written.iter().enumerate() {
        if written[..i].iter().any(|earlier| input::same_file(earlier, path)) {
            return usage(format!("{} would be written twice", path.display()));
        }
    }
    Ok(format)
}

/// Runs the method asked for.
fn refine(control: &Mesh, arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Refinement> {
    let levels = arguments.levels;
    let stage = |done: usize, faces: usize| {
        if done < levels {
            let faces = counted(faces, "triangle", "triangles");
            progress.stage(format!("refining: step {} of at most {levels}, from {faces}", done + 1));
        }
    };
    stage(0, control.face_count());
    let observer = |report: &StepReport| {
        stage(report.step, report.faces_after);
        ControlFlow::Continue(())
    };
    let scheme = arguments.scheme.scheme();
    let cap = Some(arguments.max_triangles);
    let angle = arguments.angle.unwrap_or(USUAL_ANGLE).to_radians();
    let criterion: Box<dyn Criterion> = match arguments.method {
        Method::Uniform => {
            let options = UniformOptions::default().levels(levels).max_triangles(cap).observer(&observer);
            return Ok(uniform(control, scheme, &options)?);
        }
        Method::Amresh => Box::new(NeighbourNormal::new(angle)),
        Method::LimitNormal => match view(arguments) {
            Some(view) => Box::new(LimitNormal::new(angle).view(view)),
            None => Box::new(LimitNormal::new(angle)),
        },
    };
    let options = StepwiseOptions::default()
        .levels(levels)
        .seam(arguments.seam.unwrap_or_default().rule())
        .max_triangles(cap)
        .observer(&observer);
    Ok(stepwise(control, scheme, criterion.as_ref(), &options)?)
}

fn view(arguments: &RefineArguments) -> Option<View> {
    let sight = arguments.view.map(Sight::Direction).or(arguments.eye.map(Sight::Eye))?;
    Some(View { sight, dilatation: arguments.dilatation.unwrap_or(USUAL_DILATATION) })
}

/// Takes limit normals where the output or the picture shows them, then moves the vertices to the limit if asked.
///
/// In this order: the normals of the moved vertices are those of the limit surface that they now lie on.
fn finish(
    mesh: Mesh,
    arguments: &RefineArguments,
    format: Format,
    progress: &Progress,
) -> anyhow::Result<(Mesh, Option<Vec<[f64; 3]>>)> {
    let scheme = arguments.scheme.scheme();
    let wanted = format == Format::Ply || arguments.picture.is_some();
    let normals = match wanted.then(|| LimitTable::new(scheme).normals(&mesh)) {
        Some(Err(why)) => {
            progress.note(format!("no limit normals: {why}"));
            None
        }
        normals => normals.and_then(Result::ok),
    };
    if !arguments.limit {
        return Ok((mesh, normals));
    }
    progress.stage("moving the vertices to the limit");
    let options = UniformOptions::default().levels(0).limit(true);
    Ok((uniform(&mesh, scheme, &options)?.mesh, normals))
}

fn write(path: &Path, mesh: &Mesh, normals: Option<&[[f64; 3]]>, ascii: bool) -> anyhow::Result<()> {
    let mut output = Output::new(mesh.as_triangles());
    if let (Some(normals), Ok(Format::Ply)) = (normals, Format::from_path(path)) {
        output = output.normals(normals);
    }
    let output = output.creases(&mesh.tags().creases).corners(&mesh.tags().corners);
    let options = WriteOptions::default().ascii(ascii);
    interrupt::uninterrupted(|| limitmesh_io::write(path, &output, &options))?;
    Ok(())
}

fn parameters(arguments: &RefineArguments) -> ParametersReport {
    let adaptive = arguments.method != Method::Uniform;
    ParametersReport {
        method: arguments.method,
        angle_degrees: adaptive.then(|| arguments.angle.unwrap_or(USUAL_ANGLE)),
        levels: arguments.levels,
        scheme: arguments.scheme,
        seam: adaptive.then(|| arguments.seam.unwrap_or(Seam::All)),
        view: view(arguments).map(|view| ViewReport {
            direction: arguments.view,
            eye: arguments.eye,
            dilatation: view.dilatation,
        }),
        limit: arguments.limit,
        max_triangles: arguments.max_triangles,
        weld: match arguments.build.options().weld {
            Weld::Never => None,
            Weld::Within(distance) => Some(distance),
            _ => Some(0.0),
        },
        strict: arguments.build.strict,
    }
}

fn phases(read: Duration, repair: Duration, refine: Duration, write: Duration) -> SecondsReport {
    SecondsReport {
        read: read.as_secs_f64(),
        repair: repair.as_secs_f64(),
        refine: refine.as_secs_f64(),
        write: write.as_secs_f64(),
        total: (read + repair + refine + write).as_secs_f64(),
    }
}

fn summary(
    arguments: &RefineArguments,
    mesh: &Mesh,
    steps: &[StepReport],
    stop: Stop,
    refining: Duration,
) -> String {
    let early = if stop == Stop::Satisfied { ", no face is divisible any more" } else { "" };
    let edges = match mesh.topology().boundary_edge_count() {
        0 => "closed".to_owned(),
        open => counted(open, "open edge", "open edges"),
    };
    format!(
        "{}: {}, {}, {edges} ({}{early}; refined in {})",
        arguments.output.display(),
        counted(mesh.face_count(), "triangle", "triangles"),
        counted(mesh.vertex_count(), "vertex", "vertices"),
        counted(steps.len(), "step", "steps"),
        seconds(refining.as_secs_f64())
    )
}

fn outcome(arguments: &RefineArguments, mesh: &Mesh, steps: &[StepReport], stop: Stop) -> Outcome {
    let Stop::TriangleCap { needed } = stop else { return Outcome::Done };
    Outcome::StoppedShort(format!(
        "step {} of {} would have given {}, more than --max-triangles {}; {} was written with {}",
        steps.len() + 1,
        arguments.levels,
        counted(needed, "triangle", "triangles"),
        thousands(arguments.max_triangles),
        arguments.output.display(),
        counted(mesh.face_count(), "triangle", "triangles"),
    ))
}
