//! Exact refinement: from the goals on the command line to the mesh, its certified distance, and what is reported of it.

use std::ops::ControlFlow;

use limitmesh::progress::{Progress as At, Stage};
use limitmesh::refine::{Exact, ExactStop, exact_observed, quads_observed, turned_over_triangles};

use super::super::normals::Normals;
use super::goals::Goals;
use super::input_distance;
use super::refined::Refined;
use super::rounding::rounding;
use super::task::Task;
use super::trail::Trail;
use crate::failure::Outcome;
use crate::format::{bytes, counted, thousands, upper_bound};
use crate::progress::Phases;
use crate::report::{
    CameraReport, ErrorReport, ExactParametersReport, IntervalReport, MethodReport,
    ParametersReport, RoundEntry, ViewReport,
};

/// A note says that rounding makes up such a part of the distance.
const NOTED: f64 = 0.01;

/// Refines until the goals are met or a cap is reached.
pub(super) fn run(task: &Task<'_>, goals: &Goals) -> anyhow::Result<Refined> {
    let (control, arguments, unit) = (task.control, task.arguments, task.unit());
    let mut rounds: Vec<RoundEntry> = Vec::new();
    task.begin();
    let options = goals.options(task);
    let mut observer = watch(task, &mut rounds);
    let mut found = exact_observed(task.mesh(), task.scheme()?, &options, &mut observer)?;
    let quads = match task.has_quads_out() {
        true => quads_observed(&found, task.mesh(), task.scheme()?, &mut observer)?,
        false => Vec::new(),
    };
    drop(observer);
    let moved = input_distance::measured(task, &found, goals)?;
    let rounding = rounding(arguments, found.mesh.positions())?;
    let note = round(&mut found, rounding, goals);
    task.progress.notes(note);
    let diagonal = control.diagonal;
    let moved = moved.map(|moved| {
        let moved = moved.rounded(rounding);
        IntervalReport::new(moved.lower, moved.upper, diagonal)
    });
    let error = ErrorReport::new(&found.error, diagonal);
    let attributes = goals.attributes.reached(&found);
    let mut achieved = achieved(&found, &error, goals, task);
    achieved.extend(goals.attributes.achieved(&attributes, &unit));
    match &moved {
        Some(moved) if goals.near.is_some() => achieved.insert(0, moved.near_in_words(&unit)),
        Some(moved) => achieved.extend(input_distance::in_words(moved, &error, goals, task)),
        None => {}
    }
    let inverted = match control.surface() {
        Some(read) if goals.near.is_some() => {
            turned_over_triangles(read, &found, &control.concave.parts)
        }
        _ => found.inverted_triangles(),
    };
    let outcome = match (outcome(&found, goals, task), goals.near) {
        (Outcome::Done, Some(near)) => near.outcome(moved.as_ref(), inverted, arguments),
        (outcome, _) => outcome,
    };
    let channels = task.channels.refined(task.mesh(), &found, task.scheme()?)?;
    let normals = task.wants_normals().then(|| Normals::of_exact(&mut found));
    let report = MethodReport {
        rounds,
        error: Some(error),
        input_distance: moved,
        pixels: found.pixels.filter(|pixels| pixels.is_finite()),
        open_cones: arguments.angle.map(|_| found.statistics.open_cones),
        attributes,
        ..MethodReport::new(found.statistics.levels, found.stop.name())
    };
    let provenance = task.provenance(&found.origins, &found.parents);
    let trail = match task.is_traced || arguments.proof.is_some() {
        true => Trail {
            origins: found.origins,
            parents: found.parents,
            sides: found.side_origins,
        },
        false => Trail::default(),
    };
    let how = counted(found.statistics.levels, "level", "levels");
    Ok(Refined {
        quads,
        normals,
        channels,
        trail,
        provenance,
        achieved,
        inverted: Some(inverted),
        ..Refined::new(found.mesh, how, report, outcome)
    })
}

/// Shows how far refinement is, and keeps its rounds.
fn watch<'a>(
    task: &Task<'a>,
    rounds: &'a mut Vec<RoundEntry>,
) -> impl FnMut(&At) -> ControlFlow<()> + use<'a> {
    let phases = task.arguments.exact.optimize.then(Phases::default);
    let (mut last, mut show) = (0, task.progress.observer_in_phases(phases));
    move |at: &At| {
        // Where refinement tries two methods, the second starts again; the report counts on.
        if at.stage == Stage::Refining && at.done > 0 && at.done != last {
            last = at.done;
            rounds.push(RoundEntry {
                round: rounds.len() + 1,
                triangles: at.triangles,
            });
        }
        show(at)
    }
}

/// Counts what writing rounds among the distance; a note where that is much of it.
fn round(found: &mut Exact, rounding: f64, goals: &Goals) -> Option<String> {
    let proven = found.error.upper;
    found.error = found.error.rounded(rounding);
    let is_beyond = |length: f64| proven <= length && found.error.upper > length;
    if goals.length.is_some_and(is_beyond) && found.stop == ExactStop::Met {
        found.stop = ExactStop::Rounding;
    }
    (rounding > NOTED * found.error.upper).then(|| {
        format!(
            "binary STL and glTF round vertices by up to {}; ASCII STL, PLY, OBJ and OFF keep them as they are",
            upper_bound(rounding)
        )
    })
}

/// A mesh that is off by no more than this share of the diagonal is the surface itself, as files in single precision have it.
const EXACT: f64 = 1e-6;

/// The results, in sentences of a line each.
fn achieved(found: &Exact, error: &ErrorReport, goals: &Goals, task: &Task<'_>) -> Vec<String> {
    let arguments = task.arguments;
    let mut lines = vec![error.in_words(&task.unit())];
    if error.upper.is_none() {
        let is_asked = goals.length.is_some() || arguments.exact.triangles.is_some();
        let why = match is_asked {
            true => "(no bound was found)",
            false => {
                "(no distance was asked for, and what is proven is far more than was found: --tolerance proves one)"
            }
        };
        lines.push(why.to_owned());
    } else if !error.certified {
        let scheme = arguments.scheme_name().name();
        lines.push(format!(
            "(nothing is proven for the scheme {scheme}, only for Loop's, Warren's and Catmull–Clark's)"
        ));
    }
    let is_exact = |upper: f64| upper <= EXACT * task.control.diagonal;
    if found.statistics.levels == 0
        && !found.is_collapsed()
        && found.stop == ExactStop::Met
        && goals.length.is_some()
        && goals.near.is_none()
        && !error.upper.is_some_and(is_exact)
    {
        lines.push(
            "(no face was divided: all are near enough as they are; a smaller --tolerance makes it rounder)"
                .to_owned(),
        );
    }
    lines.extend(found.pixels.map(|pixels| match pixels.is_finite() {
        true => format!(
            "at most {} pixels as the cameras see it",
            upper_bound(pixels)
        ),
        false => "not bounded as the cameras see it".to_owned(),
    }));
    if found.statistics.unfolded > 0 {
        let regions = counted(found.statistics.unfolded, "flat region", "flat regions");
        lines.push(format!(
            "{regions} would fold by the scheme's rules: what the rim encloses takes their place"
        ));
    }
    let is_reached = matches!(found.stop, ExactStop::Met | ExactStop::Triangles);
    if arguments.exact.optimize
        && !found.is_collapsed()
        && is_reached
        && found.statistics.levels > 0
    {
        lines.push("no edges collapsed: refinement alone takes no more triangles".to_owned());
    }
    if found.statistics.refused > 0 {
        let vertices = counted(found.statistics.refused, "vertex", "vertices");
        lines.push(format!("{vertices} kept where a collapse was not proven"));
    }
    lines.extend(open_cones(found));
    lines
}

/// How many triangles stay outside the angle, where that is all that was not reached.
pub(super) fn open_cones(found: &Exact) -> Option<String> {
    let triangles = counted(
        found.statistics.open_cones,
        "triangle stays",
        "triangles stay",
    );
    (found.stop == ExactStop::Cones).then(|| {
        format!("{triangles} outside the angle, where the surface has no tangent plane or as good as none")
    })
}

/// The options, defaults filled in.
///
/// # Errors
/// A length has a unit, and the mesh's is not known.
pub(super) fn parameters(task: &Task<'_>, goals: &Goals) -> anyhow::Result<ParametersReport> {
    let (arguments, options) = (task.arguments, goals.options(task));
    let own = &arguments.exact;
    let (length, diagonal) = (goals.length, task.control.diagonal);
    Ok(ParametersReport {
        angle_degrees: arguments.angle,
        within: goals.near.map(|near| near.within),
        view: ViewReport::of(arguments),
        exact: Some(ExactParametersReport {
            pixels: goals.pixels,
            cameras: goals.cameras.iter().map(CameraReport::from).collect(),
            balance: own.balance,
            optimize: own.optimize,
            divide_flat: arguments.divides_flat(),
            max_memory: options.caps.memory,
            ..ExactParametersReport::new(length, diagonal, options.caps.levels, own)
        }),
        ..ParametersReport::common(arguments)?
    })
}

/// Whether a cap ended the refinement before the goals were met, and what was reached.
fn outcome(found: &Exact, goals: &Goals, task: &Task<'_>) -> Outcome {
    let (arguments, exact) = (task.arguments, &task.arguments.exact);
    let (most, triangles) = (arguments.max_triangles(), found.mesh.face_count());
    let control = task.mesh().face_count();
    let missed = || goals.in_words(found, arguments);
    let cap = match (found.stop, exact.max_memory) {
        (ExactStop::MemoryCap, Some(most)) => format!("--max-memory {}", bytes(most)),
        (ExactStop::LevelCap, _) => format!("--levels {}", goals.options(task).caps.levels),
        _ => format!("--max-triangles {}", thousands(most)),
    };
    let why = match found.stop {
        // With goals that are met by as many triangles as there are in any case, too.
        ExactStop::TriangleCap | ExactStop::MemoryCap | ExactStop::Met if triangles > most => {
            format!("the control mesh has more than {cap} already")
        }
        ExactStop::TriangleCap | ExactStop::MemoryCap if triangles == control => {
            format!(
                "{} would take more than {cap}, and nothing was divided",
                missed()
            )
        }
        ExactStop::TriangleCap | ExactStop::MemoryCap | ExactStop::LevelCap => {
            format!("{cap} was reached before {}", missed())
        }
        ExactStop::Rounding => format!("{} is finer than rounding leaves certain", missed()),
        ExactStop::Triangles | ExactStop::Met => {
            let Some(wanted) = exact.triangles.filter(|&wanted| triangles > wanted) else {
                return Outcome::Done;
            };
            let wanted = thousands(wanted);
            match exact.optimize {
                true => format!("no more edges could be collapsed before --triangles {wanted}"),
                false => format!(
                    "the control mesh has {} already, more than --triangles {wanted}; --optimize goes below",
                    thousands(control)
                ),
            }
        }
        _ => return Outcome::Done,
    };
    let written = counted(triangles, "triangle", "triangles");
    let name = arguments.output_name();
    Outcome::StoppedShort(format!("{why}\n  {name} was written with {written}"))
}
