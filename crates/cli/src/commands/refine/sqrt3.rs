//! √3-subdivision: uniform steps, and adaptive refinement to an angle, an estimated distance or a number of triangles.

use limitmesh::Mesh;
use limitmesh::mesh::Channel;
use limitmesh::refine::{ExactStop, Refinement, Stop, UniformOptions};
use limitmesh::sqrt3::{Sqrt3, Sqrt3Options, adaptive_observed, uniform_observed};
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::carried::Trail;
use super::exact::Before;
use super::provenance::Provenance;
use super::stepwise;
use super::{Refined, has_more};
use crate::arguments::{Extent, Featured, Method, RefineArguments, RefiningScheme};
use crate::failure::{Outcome, usage};
use crate::format::counted;
use crate::progress::Progress;
use crate::report::refinement::{ErrorReport, ExactParametersReport, exact_stop_name};
use crate::report::{MethodReport, ParametersReport};

/// The tolerance where there is no other goal, in per cent of the diagonal: that of the exact method.
const USUAL_PERCENT: f64 = 0.1;

/// Refuses what √3-subdivision has no answer to.
pub(super) fn options(arguments: &RefineArguments) -> anyhow::Result<()> {
    if !matches!(arguments.method, Method::Uniform | Method::Exact) {
        return usage(
            "--scheme sqrt3 has criteria of its own: --method limit-normal and amresh do not go with it; without --method, \
             --angle, --tolerance and --triangles are its goals, and --method uniform divides everything",
        );
    }
    let exact = &arguments.exact;
    let given = [
        ("--view", arguments.view.is_some()),
        ("--eye", arguments.eye.is_some()),
        ("--pixels", exact.pixels.is_some()),
        ("--camera", !exact.camera.is_empty()),
        ("--camera-path", !exact.camera_path.is_empty()),
        ("--balance", exact.balance),
        ("--optimize", exact.optimize),
        ("--divide-flat", exact.divide_flat),
        ("--max-memory", exact.max_memory.is_some()),
        ("--dry-run", exact.dry_run),
        ("--uv-tolerance", arguments.channels.uv_tolerance.is_some()),
        ("--attribute-tolerance", !arguments.channels.attribute_tolerance.is_empty()),
        ("--morph-tolerance", arguments.asset.morph_tolerance.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|&(_, given)| given) {
        return usage(format!(
            "{option} does not go with --scheme sqrt3; it knows the schemes that split triangles in four: loop, loop-warren, \
             butterfly"
        ));
    }
    if arguments.interpolation.are_given() {
        return usage(
            "--interpolate and --interpolate-within do not go with --scheme sqrt3; they know the schemes that split \
             triangles in four: loop, loop-warren, butterfly",
        );
    }
    Ok(())
}

/// Refuses assets and packages, which are edited mesh by mesh.
pub(super) fn refuse_scenes(arguments: &RefineArguments) -> anyhow::Result<()> {
    match arguments.scheme {
        RefiningScheme::Sqrt3 => usage(
            "--scheme sqrt3 carries no attributes, so it does not edit glTF assets and 3MF packages; OBJ, PLY, STL and OFF \
             files it refines",
        ),
        _ => Ok(()),
    }
}

/// Leaves out what the input carries, and says so.
pub(super) fn without_channels(channels: Vec<Channel>, progress: &Progress) -> Vec<Channel> {
    if !channels.is_empty() {
        let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
        progress.note(format!("left out: {} (--scheme sqrt3 carries no values)", names.join("; ")));
    }
    Vec::new()
}

/// Refines uniformly, or to goals. `before` tells the input's faces, `diagonal` what lengths in per cent are of.
pub(super) fn run(
    (control, before, diagonal): (Featured, &Before, f64),
    arguments: &RefineArguments,
    format: Format,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    match arguments.method {
        Method::Uniform => by_steps(&control.mesh, arguments, format, progress),
        _ => to_goals((&control, before, diagonal), arguments, format, progress),
    }
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(arguments: &RefineArguments, diagonal: f64) -> anyhow::Result<ParametersReport> {
    if arguments.method == Method::Uniform {
        return Ok(stepwise::parameters(arguments));
    }
    let goals = goals(arguments, diagonal)?;
    Ok(ParametersReport {
        angle_degrees: arguments.angle,
        exact: Some(ExactParametersReport {
            tolerance: goals.tolerance,
            tolerance_percent: goals.tolerance.map(|tolerance| 100.0 * tolerance / diagonal),
            triangles: goals.triangles,
            pixels: None,
            cameras: Vec::new(),
            balance: false,
            divide_flat: false,
            optimize: false,
            max_levels: goals.max_levels,
            max_memory: None,
            provenance: arguments.exact.provenance,
        }),
        ..ParametersReport::common(arguments)
    })
}

/// The goals and caps of an adaptive refinement.
fn goals(arguments: &RefineArguments, diagonal: f64) -> anyhow::Result<Sqrt3Options> {
    let exact = &arguments.exact;
    let usual =
        (arguments.angle.is_none() && exact.triangles.is_none()).then_some(Extent::Percent(USUAL_PERCENT));
    let tolerance = exact.tolerance.or(usual).map(|extent| extent.length(diagonal, arguments.build.unit));
    let options = Sqrt3Options::default()
        .angle(arguments.angle.map(f64::to_radians))
        .tolerance(tolerance.transpose()?)
        .triangles(exact.triangles)
        .max_triangles(Some(arguments.max_triangles()))
        .origins(exact.provenance);
    Ok(exact.max_levels.map_or(options, |levels| options.max_levels(levels)))
}

/// Divides what fails, by its centre, the worst first.
fn to_goals(
    (control, before, diagonal): (&Featured, &Before, f64),
    arguments: &RefineArguments,
    format: Format,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let options = goals(arguments, diagonal)?;
    progress.stage(format!("refining {}", counted(control.mesh.face_count(), "triangle", "triangles")));
    let found = adaptive_observed(&control.mesh, &options, &mut progress.observer())?;
    let Sqrt3 { mesh, normals, origins, parents, levels, estimated_distance, stop, .. } = found;
    let error = estimated_distance.map(|distance| ErrorReport::estimated(distance, diagonal, &mesh));
    let unit = arguments.build.unit.map_or(String::new(), |unit| format!(" {}", unit.name()));
    let achieved = match &error {
        Some(error) => error.in_words(&unit),
        None => Vec::new(),
    };
    let places = (&before.faces[..], &control.concave.parts);
    let provenance = arguments.exact.provenance.then(|| Provenance::new(&origins, parents, places));
    let wanted = Normals::are_held(format) || arguments.picture.is_some();
    let outcome = match (has_more(&mesh, arguments), stop) {
        (Some(short), _) => short,
        (None, ExactStop::Met | ExactStop::Triangles) => Outcome::Done,
        _ => Outcome::StoppedShort(format!(
            "a cap on {} was reached before what was asked for; {} was written with {}",
            if stop == ExactStop::LevelCap { "levels (--max-levels)" } else { "triangles (--max-triangles)" },
            arguments.output_name(),
            counted(mesh.face_count(), "triangle", "triangles"),
        )),
    };
    Ok(Refined {
        normals: wanted.then(|| Normals::of_sides(&mesh, normals)),
        channels: Channels::default(),
        provenance,
        trail: Trail::default(),
        achieved,
        inverted: None,
        how: counted(levels, "level", "levels") + " of √3-subdivision",
        outcome,
        report: MethodReport {
            levels,
            stop: exact_stop_name(stop),
            error,
            ..stepwise::report(&[], Stop::Levels)
        },
        mesh,
    })
}

/// Refines by steps, and moves the vertices to the limit if asked.
fn by_steps(
    control: &Mesh,
    arguments: &RefineArguments,
    format: Format,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let levels = stepwise::levels(arguments);
    let wanted = Normals::are_held(format) || arguments.picture.is_some();
    let options = UniformOptions::default()
        .levels(levels)
        .limit(arguments.limit)
        .normals(wanted)
        .max_triangles(Some(arguments.max_triangles()));
    let mut shown = None;
    let mut observer = |at: &limitmesh::progress::Progress| {
        if at.done < levels && shown.replace(at.done) != Some(at.done) {
            let faces = counted(at.triangles, "triangle", "triangles");
            progress.stage(format!("{}: step {} of at most {levels}, from {faces}", at.stage, at.done + 1));
        }
        progress.answer(at)
    };
    let Refinement { mesh, normals, steps, stop, .. } = uniform_observed(control, &options, &mut observer)?;
    let normals = normals.map(|sided| Normals::of_sides(&mesh, sided));
    Ok(Refined {
        normals,
        channels: Channels::default(),
        provenance: None,
        trail: Trail::default(),
        achieved: Vec::new(),
        inverted: None,
        how: counted(steps.len(), "step of √3-subdivision", "steps of √3-subdivision"),
        outcome: stepwise::outcome(arguments, &mesh, &steps, stop),
        report: stepwise::report(&steps, stop),
        mesh,
    })
}
