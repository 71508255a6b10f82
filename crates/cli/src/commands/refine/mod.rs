//! `limitmesh refine`: reads a control mesh, refines it, writes the result, a report and a picture.

mod cameras;
mod check;
mod estimate;
mod exact;
mod provenance;
mod stepwise;

use std::path::Path;
use std::time::{Duration, Instant};

use limitmesh::Mesh;
use limitmesh::criterion::{View, Viewpoint};
use limitmesh::mesh::Tags;
use limitmesh_io::{Format, Output, WriteOptions};
use limitmesh_render::Style;

use super::{interpolation, picture};
use crate::arguments::{Featured, Method, RefineArguments};
use crate::failure::Outcome;
use crate::format::{counted, seconds};
use crate::input::{self, Input};
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use crate::report::{
    InputReport, MethodReport, OutputReport, ParametersReport, RefineReport, SecondsReport, VERSION,
    ViewReport,
};
use exact::Goals;
use provenance::Provenance;

/// The dilatant factor where none is given: the paper's in most of its experiments.
const USUAL_DILATATION: f64 = 1.0;

/// What a method gave, and what is said of it.
struct Refined {
    mesh: Mesh,
    normals: Option<Vec<[f64; 3]>>,
    provenance: Option<Provenance>,
    /// How near the mesh is to the limit surface, in words.
    achieved: Option<String>,
    /// Triangles that are turned over against the limit surface; not known of the stepwise methods.
    inverted: Option<usize>,
    /// How it came about, in words.
    how: String,
    report: MethodReport,
    outcome: Outcome,
}

/// Refines a mesh.
pub(crate) fn run(arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let format = check::check(arguments)?;
    let input = input::load(&arguments.input, &arguments.build.options(), progress)?;
    let input_report = InputReport {
        path: input.name,
        format: input.format,
        vertices: input.diagnosis.input_vertices,
        faces: input.diagnosis.input_faces,
        left_out: input.left_out,
    };
    let Input { mesh: control, mut diagnosis, reading, building, .. } = input;
    if let Some(note) = format.and_then(|format| lost_tags(control.tags(), format)) {
        progress.note(note);
    }
    let control = arguments.features.apply(control)?;
    if let Some(note) = divided_corners(&control) {
        progress.note(note);
    }
    diagnosis.concave_corners = control.concave.corners.clone();
    let Featured { mesh, concave } = control;
    let diagonal = mesh.diagonal();
    let (mesh, interpolation) =
        interpolation::apply(mesh, arguments.interpolation, arguments.scheme.scheme(), progress)?;
    let control = Featured { mesh, concave };

    let goals = match arguments.method {
        Method::Exact => Some(Goals::new(arguments, &control.mesh, diagonal)?),
        _ => None,
    };
    let parameters = ParametersReport {
        interpolate_within: arguments.interpolation.within(diagonal),
        ..match &goals {
            Some(goals) => exact::parameters(arguments, goals),
            None => stepwise::parameters(arguments),
        }
    };
    // Without a name to write to, this is a dry run: the arguments see to that.
    let (Some(path), false) = (&arguments.output, arguments.exact.dry_run) else {
        let goals = goals.map_or_else(|| Goals::new(arguments, &control.mesh, diagonal), Ok)?;
        let told = (input_report, (&diagnosis).into(), parameters);
        estimate::run(&control.mesh, &goals, arguments, told, progress)?;
        return Ok(Outcome::Done);
    };
    let start = Instant::now();
    let refined = match &goals {
        Some(goals) => exact::run(&control, goals, arguments, progress)?,
        None => stepwise::run(control.mesh, arguments, format, progress)?,
    };
    let refining = start.elapsed();

    progress.stage(format!("writing {}", path.display()));
    let start = Instant::now();
    write(path, arguments.ascii, &refined)?;
    let writing = start.elapsed();
    progress.note(summary(arguments, &refined, refining));

    if let Some(note) = refined.inverted.and_then(turned_over) {
        progress.note(note);
    }
    let Refined { mesh, normals, inverted, report, outcome, .. } = refined;
    if let Some(report_path) = &arguments.report {
        progress.stage("examining the result");
        let report = RefineReport {
            version: VERSION,
            input: input_report,
            diagnosis: (&diagnosis).into(),
            parameters,
            interpolation,
            method: report,
            output: OutputReport::of(arguments.output_name(), &mesh, inverted),
            seconds: phases(reading, building, refining, writing),
        };
        progress.clear();
        output::write_json(report_path, &report)?;
    }
    if let Some(path) = &arguments.picture {
        progress.stage(format!("drawing {}", path.display()));
        let style = Style::default().wireframe(true);
        let view = picture::view_direction(arguments.view);
        picture::draw(path, mesh.as_triangles(), normals.as_deref(), view, &style, picture::SIZE)?;
    }
    Ok(outcome)
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

/// Tells about sharp edges that divide corners of 180° and more.
fn divided_corners(control: &Featured) -> Option<String> {
    let concave = &control.concave;
    let corners = counted(concave.corners.count, "corner", "corners");
    let edges = counted(concave.edges, "sharp edge", "sharp edges");
    let divide = if concave.edges == 1 { "divides" } else { "divide" };
    (concave.edges > 0)
        .then(|| format!("{edges} {divide} {corners} of 180° or more, so that flat faces stay flat"))
}

/// Tells about triangles that are turned over.
fn turned_over(inverted: usize) -> Option<String> {
    let triangles = counted(inverted, "triangle is", "triangles are");
    (inverted > 0).then(|| format!("{triangles} turned over against the limit surface: it folds there"))
}

fn write(path: &Path, ascii: bool, refined: &Refined) -> anyhow::Result<()> {
    let Refined { mesh, normals, provenance, .. } = refined;
    let mut output = Output::new(mesh.as_triangles());
    if let (Some(normals), Ok(Format::Ply)) = (normals, Format::from_path(path)) {
        output = output.normals(normals);
    }
    let of_vertices = provenance.as_ref().map(Provenance::of_vertices);
    let of_faces = provenance.as_ref().map(Provenance::of_faces);
    if let (Some(vertices), Some(faces)) = (&of_vertices, &of_faces) {
        output = output.vertex_properties(vertices).face_properties(faces);
    }
    let output = output.creases(&mesh.tags().creases).corners(&mesh.tags().corners);
    let options = WriteOptions::default().ascii(ascii);
    interrupt::uninterrupted(|| limitmesh_io::write(path, &output, &options))?;
    Ok(())
}

/// The view that makes the angle depend on the viewer.
fn view(arguments: &RefineArguments) -> Option<View> {
    let viewpoint = arguments.view.map(Viewpoint::Direction).or(arguments.eye.map(Viewpoint::Eye))?;
    Some(View { viewpoint, dilatation: arguments.dilatation.unwrap_or(USUAL_DILATATION) })
}

fn view_report(arguments: &RefineArguments) -> Option<ViewReport> {
    let dilatation = view(arguments)?.dilatation;
    Some(ViewReport { direction: arguments.view, eye: arguments.eye, dilatation })
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

fn summary(arguments: &RefineArguments, refined: &Refined, refining: Duration) -> String {
    let Refined { mesh, achieved, how, .. } = refined;
    let edges = match mesh.topology().boundary_edge_count() {
        0 => "closed".to_owned(),
        open => counted(open, "open edge", "open edges"),
    };
    format!(
        "{}: {}, {}, {edges}{} ({how}; refined in {})",
        arguments.output_name(),
        counted(mesh.face_count(), "triangle", "triangles"),
        counted(mesh.vertex_count(), "vertex", "vertices"),
        achieved.as_ref().map_or(String::new(), |achieved| format!(", {achieved}")),
        seconds(refining.as_secs_f64())
    )
}
