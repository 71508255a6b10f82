//! `limitmesh refine`: reads a control mesh, refines it, writes the result, a report and a picture.

mod asset;
mod attribute_goals;
mod cameras;
mod carried;
mod check;
mod control;
mod estimate;
mod exact;
mod frames;
mod goals;
mod input_distance;
mod jobs;
mod nearness;
mod package;
mod proof;
mod provenance;
mod put_back;
mod restricted;
mod selection;
mod several;
mod sqrt3;
mod stepwise;
mod ways;
mod weights;

use std::borrow::Cow;
use std::path::Path;
use std::time::{Duration, Instant};

use limitmesh::criterion::{View, Viewpoint};
use limitmesh::mesh::{Channel, Semantic, Tags};
use limitmesh::refine::ExactStop;
use limitmesh::{Mesh, Triangles};
use limitmesh_io::{Format, Output};
use limitmesh_render::Style;

use super::channels::{Channels, Destination};
use super::normals::Normals;
use super::{interpolation, picture, shading};
use crate::arguments::{CreasesFrom, RefineArguments, Unit, Way};
use crate::bulk::{Bulk, Shown};
use crate::creases::Hints;
use crate::failure::Outcome;
use crate::format::{counted, number, seconds, thousands};
use crate::input::{self, Input};
use crate::output;
use crate::parts::{self, Decided};
use crate::progress::Progress;
use crate::report::{
    InputReport, MeshReport, MethodReport, OutputReport, ParametersReport, RefineReport,
    SecondsReport, SizeReport, VERSION, ViewReport,
};
use crate::written_unit::WrittenUnit;
use control::Control;
use provenance::Provenance;
use ways::Prepared;

/// The dilatant factor where none is given: the paper's in most of its experiments.
const USUAL_DILATATION: f64 = 1.0;

/// What a method gave, and what is said of it.
struct Refined {
    mesh: Mesh,
    normals: Option<Normals>,
    channels: Channels,
    provenance: Option<Provenance>,
    /// Where vertices came from, and the control face of each triangle, if that was to be kept and is known.
    trail: carried::Trail,
    /// How near the mesh is to the limit surface: sentences of a line each.
    achieved: Vec<String>,
    /// Triangles that are turned over against the limit surface; not known of the stepwise methods.
    inverted: Option<usize>,
    /// How it came about, in words.
    how: String,
    report: MethodReport,
    outcome: Outcome,
}

/// Refines a mesh, or each of several.
pub(crate) fn run(arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    if arguments.shared_topology {
        return frames::run(arguments, progress);
    }
    let jobs = jobs::jobs(arguments)?;
    check::together(arguments, &jobs)?;
    let formats = jobs
        .iter()
        .map(check::options)
        .collect::<anyhow::Result<Vec<_>>>()?;
    jobs::make_folders(arguments)?;
    jobs.iter().try_for_each(check::files)?;
    match (jobs.as_slice(), formats.as_slice()) {
        ([job], [format]) => refine(job, *format, progress),
        _ => {
            let jobs = jobs.into_iter().zip(formats).collect();
            jobs::each(jobs, |job, format| refine(job, format, progress))
        }
    }
}

fn refine(
    arguments: &RefineArguments,
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<Outcome> {
    if let Some(asset) = asset::Job::of(arguments, format)? {
        check::scenes(arguments)?;
        arguments.features.check_of_asset()?;
        return asset.run(progress);
    }
    if let Some(package) = package::Job::of(arguments, format)? {
        check::scenes(arguments)?;
        arguments.features.check_of_package()?;
        return package.run(progress);
    }
    let asked = (Normals::kept(format), &arguments.channels);
    let input = input::load_for(arguments.input(), &arguments.build, asked, progress)?;
    let arguments = &RefineArguments {
        build: arguments.build.in_unit(input.unit),
        ..arguments.clone()
    };
    let (decided, note) = looked_at(arguments, (&input.mesh, &input.trace.faces), &input.hints());
    let arguments = &decided;
    let notes = [
        note,
        format.and_then(|format| lost_tags(input.mesh.tags(), format)),
        split_normals((&input.hints(), &input.mesh), arguments),
    ];
    notes
        .into_iter()
        .flatten()
        .for_each(|note| progress.note(note));
    let input = input.with_creases(arguments.features.creases_from)?;
    let input_report = InputReport::of(&input, &arguments.channels);
    let files = [input.material_libraries, input.texture_files];
    let own = match arguments.way().is_sqrt3() {
        true => sqrt3::without_channels(input.channels, progress),
        false => input.channels,
    };
    let mut channels =
        Channels::of_input(own, files, &Destination::of(arguments, format), progress);
    let texture = |own: &Channel| own.semantic == Semantic::TextureCoordinates;
    let names = channels
        .all()
        .iter()
        .map(|own| (own.name.as_str(), texture(own)));
    arguments
        .channels
        .check_tolerances(&input_report.path, names)?;
    let Input {
        mesh,
        diagnosis,
        trace,
        reading,
        building,
        ..
    } = input;
    let control = Control::new(
        (mesh, diagnosis, trace.faces),
        Shown::default(),
        None,
        arguments,
        progress,
    )?;
    let Control {
        featured: control,
        diagnosis,
        before: read,
        bulk: before,
        interpolation,
        diagonal,
        took,
        ..
    } = control;
    channels.on_parts(&control.concave.parts, &control.mesh);
    let proven = arguments
        .proof
        .as_deref()
        .map(|path| (path, control.mesh.clone()));
    let way = Prepared::new(arguments, (&control.mesh, &channels), diagonal)?;
    let parameters = ParametersReport {
        interpolate_within: arguments
            .interpolation
            .within(diagonal, arguments.build.unit)?,
        ..way.parameters(arguments, diagonal)?
    };
    // Without a name to write to, this is a dry run, and that is exact: the checks of the arguments see to both.
    let (Some(path), Some(format), false) = (&arguments.output, format, arguments.exact.dry_run)
    else {
        if let Prepared::Exact(goals) = &way {
            let told = (input_report, (&diagnosis).into(), parameters);
            estimate::run(&control.mesh, goals, arguments, told, progress)?;
        }
        return Ok(Outcome::Done);
    };
    let start = Instant::now();
    let mut refined = way.run(
        (control, &read, diagonal),
        &channels,
        (arguments, format),
        progress,
    )?;
    let refining = took + start.elapsed();

    let after = Bulk::of(&refined.mesh);
    refined.tell_size([before, after], arguments);

    progress.stage(format!("writing {}", arguments.output_name()));
    let start = Instant::now();
    write_told(path, format, arguments, &refined, progress)?;
    let writing = start.elapsed();
    progress.note(summary(&arguments.output_name(), &refined, refining));

    if let Some(note) = refined.inverted.and_then(turned_over) {
        progress.note(note);
    }
    if let Some((path, control)) = proven {
        progress.stage("checking the proof");
        let proven = proof::write(path, &control, &refined, arguments)?;
        proven.note.into_iter().for_each(|note| progress.note(note));
        refined.report.error = refined
            .report
            .error
            .map(|error| error.proven(proven.within));
        if let Outcome::Done = refined.outcome {
            refined.outcome = proven.outcome;
        }
    }
    let Refined {
        mesh,
        normals,
        inverted,
        report,
        outcome,
        ..
    } = refined;
    if let Some(report_path) = &arguments.report {
        progress.stage("examining the result");
        let report = RefineReport {
            version: VERSION,
            of: MeshReport {
                input: input_report,
                diagnosis: (&diagnosis).into(),
                parameters,
                interpolation,
                method: report,
                size: SizeReport { before, after },
                output: OutputReport::of(arguments.output_name(), &mesh, inverted),
            },
            seconds: phases(reading, building, refining, writing),
        };
        progress.clear();
        output::write_json(report_path, &report)?;
    }
    if let Some(path) = &arguments.picture {
        draw(path, (&mesh, normals.as_ref()), arguments, progress)?;
    }
    Ok(outcome)
}

/// The arguments with what is sharp on a mesh by its looks, and what is said of that. Looks count for exact refinement, or where that is asked for.
fn looked_at(
    arguments: &RefineArguments,
    (mesh, faces): (&Mesh, &[u32]),
    hints: &Hints<'_>,
) -> (RefineArguments, Option<String>) {
    // What is as smooth as a distance allows has sharp edges only where somebody says so.
    let is_smoothed = arguments.exact.within.is_some();
    let features = match arguments.way() {
        Way::Exact if !is_smoothed => arguments.features.or_auto(),
        _ => arguments.features,
    };
    let can_be_led = !arguments.way().is_sqrt3() && !arguments.shared_topology && !is_smoothed;
    let Decided {
        features,
        interpolation,
        note,
    } = parts::decided(
        (features, arguments.interpolation),
        (mesh, faces),
        hints,
        can_be_led,
    );
    (
        RefineArguments {
            features,
            interpolation,
            ..arguments.clone()
        },
        note,
    )
}

/// Writes a mesh, and says what becomes of normals and of values where vertices have several.
fn write_told(
    path: &Path,
    format: Format,
    arguments: &RefineArguments,
    refined: &Refined,
    progress: &Progress,
) -> anyhow::Result<()> {
    let splits = refined
        .channels
        .split_vertices(format, refined.mesh.as_triangles());
    // Vertices on sharp edges stand once for each side as asked for, or as a file has vertices several times anyway.
    let is_split = arguments.split_normals || splits;
    let notes = [
        refined
            .normals
            .as_ref()
            .and_then(|all| all.note(format, is_split))
            .map(str::to_owned),
        refined
            .channels
            .note(format, refined.mesh.as_triangles(), splits),
    ];
    notes
        .into_iter()
        .flatten()
        .for_each(|note| progress.note(note));
    WrittenUnit::of(arguments.input(), &arguments.build, format)
        .note(&arguments.output_name(), progress);
    write(path, (format, is_split), arguments, refined)
}

/// Draws a mesh, shaded by its normals if it has some.
fn draw(
    path: &Path,
    (mesh, normals): (&Mesh, Option<&Normals>),
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<()> {
    progress.stage(format!("drawing {}", path.display()));
    let split;
    let (surface, normals) = match normals {
        Some(normals) => normals.surface(mesh),
        None => {
            split = shading::without_normals(mesh)?;
            (split.as_triangles(), &split.normals[..])
        }
    };
    let view = picture::view_direction(arguments.view);
    picture::draw(
        path,
        surface,
        Some(normals),
        view,
        &Style::default().wireframe(true),
        picture::SIZE,
    )?;
    progress.note(picture::drawn(path, mesh.face_count()));
    Ok(())
}

/// How methods end that take no triangles away: where there are more than asked, so many the control mesh had.
fn capped(mesh: &Mesh, stop: ExactStop, arguments: &RefineArguments) -> Outcome {
    let count = mesh.face_count();
    if let Some(asked) = arguments.exact.triangles.filter(|&asked| count > asked) {
        return Outcome::StoppedShort(format!(
            "the control mesh has {} already, more than --triangles {}; --method exact --optimize goes below",
            thousands(count),
            thousands(asked),
        ));
    }
    let cap = match stop {
        ExactStop::Met | ExactStop::Triangles => return Outcome::Done,
        ExactStop::LevelCap => "levels (--max-levels)",
        _ => "triangles (--max-triangles)",
    };
    Outcome::StoppedShort(format!(
        "a cap on {cap} was reached before what was asked for; {} was written with {}",
        arguments.output_name(),
        counted(count, "triangle", "triangles"),
    ))
}

/// Tells about normals that say that edges are sharp, where nothing says what to do about that.
fn split_normals(
    (hints, mesh): (&Hints<'_>, &Mesh),
    arguments: &RefineArguments,
) -> Option<String> {
    if arguments.features.angle().is_some() || arguments.features.creases_from != CreasesFrom::None
    {
        return None;
    }
    let edges = hints.split_edges(mesh);
    let have = counted(edges, "edge has", "edges have");
    (edges > 0).then(|| {
        format!(
            "{have} different normals on both sides; --creases-from normals keeps such edges sharp"
        )
    })
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
    Some(format!(
        "{}: followed, but left out of the output, whose format has none",
        found.join(" and ")
    ))
}

/// Tells about triangles that are turned over.
fn turned_over(inverted: usize) -> Option<String> {
    let triangles = counted(inverted, "triangle is", "triangles are");
    (inverted > 0)
        .then(|| format!("{triangles} turned over against the limit surface: it folds there"))
}

/// Writes a mesh; vertices on sharp edges once for each side if it `is_split`.
fn write(
    path: &Path,
    (format, is_split): (Format, bool),
    arguments: &RefineArguments,
    refined: &Refined,
) -> anyhow::Result<()> {
    let Refined {
        mesh,
        normals,
        channels,
        provenance,
        ..
    } = refined;
    let mut output = channels.add_to(Output::new(mesh.as_triangles()));
    if let Some(normals) = normals {
        output = normals.add_to(output, format, is_split);
    }
    let sources = normals
        .as_ref()
        .and_then(|all| all.sources(format, is_split));
    let provenance = provenance
        .as_ref()
        .map(|all| sources.map_or(Cow::Borrowed(all), |list| Cow::Owned(all.of(list))));
    let of_vertices = provenance.as_deref().map(Provenance::of_vertices);
    let of_faces = provenance.as_deref().map(Provenance::of_faces);
    if let (Some(vertices), Some(faces)) = (&of_vertices, &of_faces) {
        output = output.vertex_properties(vertices).face_properties(faces);
    }
    let output = output
        .creases(&mesh.tags().creases)
        .corners(&mesh.tags().corners);
    let unit = WrittenUnit::of(arguments.input(), &arguments.build, format);
    let positions = unit.positions(output.surface.positions);
    let output = Output {
        surface: Triangles {
            positions: &positions,
            ..output.surface
        },
        ..output
    };
    output::write_mesh(
        path,
        format,
        &output,
        &unit.options(arguments.write_options()),
    )
}

/// The view that makes the angle depend on the viewer.
fn view(arguments: &RefineArguments) -> Option<View> {
    let viewpoint = arguments
        .view
        .map(Viewpoint::Direction)
        .or(arguments.eye.map(Viewpoint::Eye))?;
    Some(View {
        viewpoint,
        dilatation: arguments.dilatation.unwrap_or(USUAL_DILATATION),
    })
}

fn view_report(arguments: &RefineArguments) -> Option<ViewReport> {
    let dilatation = view(arguments)?.dilatation;
    Some(ViewReport {
        direction: arguments.view,
        eye: arguments.eye,
        dilatation,
    })
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

/// The part of a closed surface's volume that may be gone before it is said what would keep it.
const MUCH_VOLUME: f64 = 0.1;

/// What keeps the size of a mesh.
const INTERPOLATE: &str = "(--interpolate would lead the surface through the vertices)";

impl Refined {
    /// Adds what became of area and volume to what is said, and what would have kept much of the volume that is gone.
    fn tell_size(&mut self, [before, after]: [Bulk; 2], arguments: &RefineArguments) {
        self.achieved
            .push(change_in_words(before, after, arguments.build.unit));
        let is_led = arguments.interpolation.is_led() || arguments.exact.within.is_some();
        let is_kept = is_led || arguments.way().is_sqrt3();
        let is_told = self.achieved.iter().any(|line| line == INTERPOLATE);
        if let (Some(before), Some(after), false) =
            (before.volume, after.volume, is_kept || is_told)
            && after / before < 1.0 - MUCH_VOLUME
        {
            self.achieved.push(INTERPOLATE.to_owned());
        }
    }
}

/// What became of area and volume.
fn change_in_words(before: Bulk, after: Bulk, unit: Option<Unit>) -> String {
    let unit = unit.map_or("", Unit::name);
    let change = |what: &str, power: &str, before: f64, after: f64| {
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" {unit}{power}")
        };
        if !(before.is_finite() && after.is_finite()) {
            return format!("{what} too large to be told");
        }
        let percent = 100.0 * (after / before - 1.0);
        let percent = if percent.is_finite() {
            format!(" ({percent:+.2} %)")
        } else {
            String::new()
        };
        format!(
            "{what} {} to {}{unit}{percent}",
            number(before),
            number(after)
        )
    };
    let area = change("area", "²", before.area, after.area);
    match (before.volume, after.volume) {
        (Some(before), Some(after)) => format!("{area}, {}", change("volume", "³", before, after)),
        _ => area,
    }
}

/// The result in lines of at most 100 columns, names of files aside.
fn summary(name: &str, refined: &Refined, refining: Duration) -> String {
    let Refined {
        mesh,
        achieved,
        how,
        ..
    } = refined;
    let edges = match mesh.open_edge_count() {
        0 => "closed".to_owned(),
        open => counted(open, "open edge", "open edges"),
    };
    let first = format!(
        "{name}: {}, {}, {edges} ({how}; {})",
        counted(mesh.face_count(), "triangle", "triangles"),
        counted(mesh.vertex_count(), "vertex", "vertices"),
        seconds(refining.as_secs_f64())
    );
    std::iter::once(first)
        .chain(achieved.iter().cloned())
        .collect::<Vec<_>>()
        .join("\n  ")
}
