//! Refinement step by step: uniform, by limit normals, by neighbouring normals.

use std::ops::ControlFlow;

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::limit::LimitTable;
use limitmesh::progress::Progress as At;
use limitmesh::refine::{
    Refinement, StepReport, StepwiseOptions, Stop, UniformOptions, stepwise_observed, uniform,
    uniform_observed,
};

use super::super::normals::Normals;
use super::refined::Refined;
use super::task::Task;
use super::trail::Trail;
use crate::arguments::{Method, RefineArguments};
use crate::failure::Outcome;
use crate::format::{counted, thousands};
use crate::progress::Progress;
use crate::report::refinement::stop_name;
use crate::report::{MethodReport, ParametersReport, StepEntry, ViewReport};

/// The angle where none is given, in degrees: the paper's middle one.
const USUAL_ANGLE: f64 = 10.0;

/// The number of steps where none is given: the paper's in most of its experiments.
const USUAL_LEVELS: usize = 3;

pub(super) fn levels(arguments: &RefineArguments) -> usize {
    arguments.levels.unwrap_or(USUAL_LEVELS)
}

/// Refines, and moves the vertices to the limit if asked.
pub(super) fn run(task: &Task<'_>) -> anyhow::Result<Refined> {
    let (arguments, control) = (task.arguments, task.mesh());
    let refined = refine(task)?;
    // Where nothing moves, values stay what they are, too.
    let is_same = refined.mesh.positions() == control.positions() && !arguments.limit;
    let channels = match is_same {
        true => task.channels.clone(),
        false => task.channels.refined(control, &refined, task.scheme()?)?,
    };
    let (steps, stop) = (refined.steps, refined.stop);
    let (mesh, normals) = finish(task, refined.mesh)?;
    let early = match stop {
        Stop::Satisfied => ", no face is divisible any more",
        _ => "",
    };
    let how = counted(steps.len(), "step", "steps") + early;
    let outcome = outcome(arguments, &mesh, &steps, stop);
    let quads = match task.has_quads_out() {
        true => mesh.topology().quads().collect(),
        false => Vec::new(),
    };
    Ok(Refined {
        quads,
        normals,
        channels,
        trail: Trail {
            origins: refined.origins,
            parents: refined.parents,
            sides: None,
        },
        ..Refined::new(mesh, how, report(&steps, stop), outcome)
    })
}

/// The report on the steps.
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
pub(super) fn watch(levels: usize, progress: &Progress) -> impl FnMut(&At) -> ControlFlow<()> {
    let mut shown = None;
    move |at| {
        if at.done < levels && shown.replace(at.done) != Some(at.done) {
            let (stage, step) = (at.stage, at.done + 1);
            let faces = counted(at.triangles, "triangle", "triangles");
            progress.stage(format!(
                "{stage}: step {step} of at most {levels}, from {faces}"
            ));
        }
        progress.answer(at)
    }
}

/// Runs the method asked for.
fn refine(task: &Task<'_>) -> anyhow::Result<Refinement> {
    let (arguments, scheme) = (task.arguments, task.scheme()?);
    let levels = levels(arguments);
    let mut observer = watch(levels, task.progress);
    let is_traced = task.is_traced || !task.channels.all().is_empty();
    let cap = Some(arguments.max_triangles());
    Ok(match criterion(arguments) {
        None => {
            let options = UniformOptions::default()
                .levels(levels)
                .origins(is_traced)
                .max_triangles(cap);
            uniform_observed(task.mesh(), scheme, &options, &mut observer)?
        }
        Some(criterion) => {
            let options = StepwiseOptions::default()
                .levels(levels)
                .origins(is_traced)
                .max_triangles(cap);
            stepwise_observed(
                task.mesh(),
                scheme,
                criterion.as_ref(),
                &options,
                &mut observer,
            )?
        }
    })
}

/// The criterion that marks the faces that a step divides; none where it divides all.
fn criterion(arguments: &RefineArguments) -> Option<Box<dyn Criterion>> {
    let angle = arguments.angle.unwrap_or(USUAL_ANGLE).to_radians();
    match (arguments.method, arguments.viewer()) {
        (Method::Amresh, _) => Some(Box::new(NeighbourNormal::new(angle))),
        (Method::LimitNormal, Some(view)) => Some(Box::new(LimitNormal::new(angle).view(view))),
        (Method::LimitNormal, None) => Some(Box::new(LimitNormal::new(angle))),
        _ => None,
    }
}

/// Takes limit normals where the output or the picture shows them, then moves the vertices to the limit if asked.
///
/// In this order: the normals of the moved vertices are those of the limit surface that they now lie on.
fn finish(task: &Task<'_>, mesh: Mesh) -> anyhow::Result<(Mesh, Option<Normals>)> {
    let scheme = task.scheme()?;
    let sided = match task
        .wants_normals()
        .then(|| LimitTable::new(scheme).sided_normals(&mesh))
    {
        Some(Err(why)) => {
            task.progress.note(format!("no limit normals: {why}"));
            None
        }
        sided => sided.and_then(Result::ok),
    };
    let mut mesh = mesh;
    if task.arguments.limit {
        task.progress.stage("moving the vertices to the limit");
        let options = UniformOptions::default().levels(0).limit(true);
        mesh = uniform(&mesh, scheme, &options)?.mesh;
    }
    let normals = sided.map(|sided| Normals::of_sides(&mesh, sided));
    Ok((mesh, normals))
}

/// The options, defaults filled in.
///
/// # Errors
/// A length has a unit, and the mesh's is not known.
pub(super) fn parameters(arguments: &RefineArguments) -> anyhow::Result<ParametersReport> {
    let adaptive = arguments.method != Method::Uniform;
    Ok(ParametersReport {
        angle_degrees: adaptive.then(|| arguments.angle.unwrap_or(USUAL_ANGLE)),
        levels: Some(levels(arguments)),
        view: ViewReport::of(arguments),
        limit: arguments.limit,
        ..ParametersReport::common(arguments)?
    })
}

/// Whether the cap left a step undone.
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
