//! Refinement step by step: uniform, by limit normals, by neighbouring normals.

use std::ops::ControlFlow;

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::limit::LimitTable;
use limitmesh::refine::{
    Refinement, StepReport, StepwiseOptions, Stop, UniformOptions, stepwise_observed, uniform,
    uniform_observed,
};
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::carried::Trail;
use super::{Refined, view, view_report};
use crate::arguments::{Method, RefineArguments, Seam};
use crate::failure::Outcome;
use crate::format::{counted, thousands};
use crate::progress::Progress;
use crate::report::refinement::stop_name;
use crate::report::{MethodReport, ParametersReport, StepEntry};

/// The angle where none is given, in degrees: the paper's middle one.
const USUAL_ANGLE: f64 = 10.0;

/// The number of steps where none is given: the paper's in most of its experiments.
const USUAL_LEVELS: usize = 3;

pub(super) fn levels(arguments: &RefineArguments) -> usize {
    arguments.levels.unwrap_or(USUAL_LEVELS)
}

/// Refines, and moves the vertices to the limit if asked.
pub(super) fn run(
    (control, channels, keeps_origins): (Mesh, &Channels, bool),
    arguments: &RefineArguments,
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let is_traced = keeps_origins || !channels.all().is_empty();
    let refined = refine(&control, is_traced, arguments, progress)?;
    // Where nothing moves, values stay what they are, too.
    let is_same = refined.mesh.positions() == control.positions() && !arguments.limit;
    let channels = if is_same {
        channels.clone()
    } else {
        channels.refined(&control, &refined, arguments.scheme()?)?
    };
    drop(control);
    let Refinement {
        mesh,
        steps,
        stop,
        origins,
        parents,
        ..
    } = refined;
    let (mesh, normals) = finish(mesh, arguments, format, progress)?;
    let early = if stop == Stop::Satisfied {
        ", no face is divisible any more"
    } else {
        ""
    };
    Ok(Refined {
        normals,
        channels,
        provenance: None,
        trail: Trail {
            origins,
            parents,
            sides: None,
        },
        achieved: Vec::new(),
        inverted: None,
        how: counted(steps.len(), "step", "steps") + early,
        outcome: outcome(arguments, &mesh, &steps, stop),
        report: report(&steps, stop),
        mesh,
    })
}

/// What the steps did.
pub(super) fn report(steps: &[StepReport], stop: Stop) -> MethodReport {
    MethodReport {
        steps: steps.iter().map(StepEntry::from).collect(),
        needed_triangles: match stop {
            Stop::TriangleCap { needed } => Some(needed),
            _ => None,
        },
        ..MethodReport::new(steps.len(), stop_name(stop))
    }
}

/// Shows each of at most so many steps as it begins.
pub(super) fn watch(
    levels: usize,
    progress: &Progress,
) -> impl FnMut(&limitmesh::progress::Progress) -> ControlFlow<()> {
    let mut shown = None;
    move |at| {
        if at.done < levels && shown.replace(at.done) != Some(at.done) {
            let faces = counted(at.triangles, "triangle", "triangles");
            progress.stage(format!(
                "{}: step {} of at most {levels}, from {faces}",
                at.stage,
                at.done + 1
            ));
        }
        progress.answer(at)
    }
}

/// Runs the method asked for.
fn refine(
    control: &Mesh,
    keeps_origins: bool,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Refinement> {
    let levels = levels(arguments);
    let mut observer = watch(levels, progress);
    let scheme = arguments.scheme()?;
    let cap = Some(arguments.max_triangles());
    let Some(criterion) = criterion(arguments) else {
        let options = UniformOptions::default()
            .levels(levels)
            .origins(keeps_origins)
            .max_triangles(cap);
        return Ok(uniform_observed(control, scheme, &options, &mut observer)?);
    };
    let options = StepwiseOptions::default()
        .levels(levels)
        .seam(arguments.seam.unwrap_or_default().rule())
        .origins(keeps_origins)
        .max_triangles(cap);
    Ok(stepwise_observed(
        control,
        scheme,
        criterion.as_ref(),
        &options,
        &mut observer,
    )?)
}

/// What marks the faces that a step divides; none where it divides all.
fn criterion(arguments: &RefineArguments) -> Option<Box<dyn Criterion>> {
    let angle = arguments.angle.unwrap_or(USUAL_ANGLE).to_radians();
    match (arguments.method, view(arguments)) {
        (Method::Amresh, _) => Some(Box::new(NeighbourNormal::new(angle))),
        (Method::LimitNormal, Some(view)) => Some(Box::new(LimitNormal::new(angle).view(view))),
        (Method::LimitNormal, None) => Some(Box::new(LimitNormal::new(angle))),
        _ => None,
    }
}

/// Takes limit normals where the output or the picture shows them, then moves the vertices to the limit if asked.
///
/// In this order: the normals of the moved vertices are those of the limit surface that they now lie on.
fn finish(
    mesh: Mesh,
    arguments: &RefineArguments,
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<(Mesh, Option<Normals>)> {
    let scheme = arguments.scheme()?;
    let wanted = format.is_some_and(Normals::are_held) || arguments.picture.is_some();
    let sided = match wanted.then(|| LimitTable::new(scheme).sided_normals(&mesh)) {
        Some(Err(why)) => {
            progress.note(format!("no limit normals: {why}"));
            None
        }
        sided => sided.and_then(Result::ok),
    };
    let mut mesh = mesh;
    if arguments.limit {
        progress.stage("moving the vertices to the limit");
        let options = UniformOptions::default().levels(0).limit(true);
        mesh = uniform(&mesh, scheme, &options)?.mesh;
    }
    let normals = sided.map(|sided| Normals::of_sides(&mesh, sided));
    Ok((mesh, normals))
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(arguments: &RefineArguments) -> ParametersReport {
    let adaptive = arguments.method != Method::Uniform;
    ParametersReport {
        angle_degrees: adaptive.then(|| arguments.angle.unwrap_or(USUAL_ANGLE)),
        levels: Some(levels(arguments)),
        seam: adaptive.then(|| arguments.seam.unwrap_or(Seam::All)),
        view: view_report(arguments),
        limit: arguments.limit,
        ..ParametersReport::common(arguments)
    }
}

pub(super) fn outcome(
    arguments: &RefineArguments,
    mesh: &Mesh,
    steps: &[StepReport],
    stop: Stop,
) -> Outcome {
    let Stop::TriangleCap { needed } = stop else {
        return Outcome::Done;
    };
    Outcome::StoppedShort(format!(
        "step {} of {} would have given {}, more than --max-triangles {}; {} was written with {}",
        steps.len() + 1,
        levels(arguments),
        counted(needed, "triangle", "triangles"),
        thousands(arguments.max_triangles()),
        arguments.output_name(),
        counted(mesh.face_count(), "triangle", "triangles"),
    ))
}
