//! Exact refinement: from the goals on the command line to the mesh, its certified distance, and what is said of it.

use limitmesh::progress::Stage;
use limitmesh::refine::{Exact, ExactStop, InputDistance, exact_observed, turned_over_triangles};
use limitmesh::{Mesh, Triangles};

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::carried::Trail;
use super::control::{Before, BeforeSurface};
use super::goals::{Goals, unit_in_words, written};
use super::input_distance;
use super::provenance::Provenance;
use super::{Refined, view_report};
use crate::arguments::{Featured, RefineArguments};
use crate::failure::Outcome;
use crate::format::{bytes, counted, thousands, upper_bound};
use crate::progress::{Phases, Progress};
use crate::report::refinement::exact_stop_name;
use crate::report::{
    CameraReport, ErrorReport, ExactParametersReport, InputDistanceReport, MethodReport,
    ParametersReport, RoundEntry,
};

/// A part of the distance that rounding makes up and that is told.
const NOTED: f64 = 0.01;

/// Refines until the goals are met or a cap is reached.
///
/// `before` is the mesh that was read.
pub(super) fn run(
    (
        Featured {
            mesh: control,
            concave,
            ..
        },
        before,
        channels,
    ): (&Featured, &Before, &Channels),
    goals: &Goals,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let mut rounds: Vec<RoundEntry> = Vec::new();
    let phases = arguments.exact.optimize.then(Phases::default);
    let (mut last, mut show) = (0, progress.observer_in_phases(phases));
    let mut observer = |at: &limitmesh::progress::Progress| {
        // Where refinement tries two ways, the second starts again; the report counts on.
        if at.stage == Stage::Refining && at.done > 0 && at.done != last {
            last = at.done;
            rounds.push(RoundEntry {
                round: rounds.len() + 1,
                triangles: at.triangles,
            });
        }
        show(at)
    };
    progress.stage(format!(
        "refining {}",
        counted(control.face_count(), "triangle", "triangles")
    ));
    let options = goals.options(arguments);
    let mut found = exact_observed(control, arguments.scheme()?, &options, &mut observer)?;
    let moved = input_distance::measured(
        (control, before, &concave.parts),
        &found,
        goals,
        arguments,
        progress,
    )?;
    let rounding = written(arguments).map_or(0.0, |(format, options)| {
        limitmesh_io::rounding(format, &options, found.mesh.positions())
    });
    if let Some(note) = round(&mut found, rounding, goals) {
        progress.note(note);
    }
    let moved = moved.map(|moved| {
        let InputDistance { lower, upper } = moved.rounded(rounding);
        InputDistanceReport::new(lower, upper, goals.diagonal)
    });
    let error = ErrorReport::new(&found.error, goals.diagonal);
    let mut achieved = achieved(&found, &error, goals, arguments);
    let attributes = goals.attributes.reached(&found);
    achieved.extend(
        goals
            .attributes
            .achieved(&attributes, &unit_in_words(arguments.build.unit)),
    );
    match (&moved, goals.near) {
        (Some(moved), Some(_)) => {
            achieved.insert(0, moved.near_in_words(&unit_in_words(arguments.build.unit)))
        }
        (Some(moved), None) => {
            achieved.extend(input_distance::in_words(
                moved, &error, control, goals, arguments,
            ));
        }
        (None, _) => {}
    }
    let inverted = match &before.surface {
        Some(BeforeSurface {
            positions,
            triangles,
        }) if goals.near.is_some() => turned_over_triangles(
            Triangles {
                positions,
                triangles,
            },
            &found,
            &concave.parts,
        ),
        _ => found.inverted_triangles(),
    };
    let outcome = match outcome(&found, control, goals, arguments) {
        Outcome::Done => goals.near.map_or(Outcome::Done, |near| {
            near.outcome(moved.as_ref(), inverted, arguments)
        }),
        short => short,
    };
    let channels = channels.refined(control, &found, arguments.scheme()?)?;
    let wanted = written(arguments).is_some_and(|(format, _)| Normals::are_held(format))
        || arguments.picture.is_some();
    let normals = wanted.then(|| Normals::of_exact(&mut found));
    let Exact {
        mesh,
        origins,
        parents,
        is_optimized,
        side_origins,
        pixels,
        open_cones,
        stop,
        levels,
        ..
    } = found;
    let places = (&before.faces[..], &concave.parts);
    let provenance = arguments
        .exact
        .provenance
        .then(|| Provenance::new(&origins, parents.clone(), places));
    let sides = is_optimized.then_some(side_origins);
    let trail = if goals.keeps_origins || arguments.proof.is_some() {
        Trail {
            origins,
            parents,
            sides,
        }
    } else {
        Trail::default()
    };
    Ok(Refined {
        mesh,
        normals,
        channels,
        trail,
        provenance,
        achieved,
        inverted: Some(inverted),
        how: counted(levels, "level", "levels"),
        report: MethodReport {
            rounds,
            error: Some(error),
            input_distance: moved,
            pixels: pixels.filter(|pixels| pixels.is_finite()),
            open_cones: goals.angle_degrees.map(|_| open_cones),
            attributes,
            ..MethodReport::new(levels, exact_stop_name(stop))
        },
        outcome,
    })
}

/// Counts what writing rounds among the distance; a note where that is much of it.
fn round(found: &mut Exact, rounding: f64, goals: &Goals) -> Option<String> {
    let proven = found.error.upper;
    found.error.upper += rounding;
    found.error.lower = (found.error.lower - rounding).max(0.0);
    let is_beyond = goals
        .length
        .is_some_and(|length| proven <= length && found.error.upper > length);
    if is_beyond && found.stop == ExactStop::Met {
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

/// What was reached, in sentences of a line each.
fn achieved(
    found: &Exact,
    error: &ErrorReport,
    goals: &Goals,
    arguments: &RefineArguments,
) -> Vec<String> {
    let mut lines = error.in_words(&unit_in_words(arguments.build.unit));
    if error.upper.is_none() {
        lines.push(unproven(goals).to_owned());
    } else if !error.certified {
        let scheme = arguments
            .scheme
            .in_quarters()
            .map_or("", |name| name.scheme().name());
        lines.push(format!(
            "(nothing is proven for the scheme {scheme}, only for Loop's and Warren's)"
        ));
    }
    let is_exact = error
        .upper
        .is_some_and(|upper| upper <= EXACT * goals.diagonal);
    if found.levels == 0
        && !found.is_optimized
        && found.stop == ExactStop::Met
        && goals.length.is_some()
        && goals.near.is_none()
        && !is_exact
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
    if found.unfolded > 0 {
        let regions = counted(found.unfolded, "flat region", "flat regions");
        lines.push(format!(
            "{regions} would fold by the scheme's rules: what the rim encloses stands there"
        ));
    }
    let is_reached = matches!(found.stop, ExactStop::Met | ExactStop::Triangles);
    if arguments.exact.optimize && !found.is_optimized && is_reached && found.levels > 0 {
        lines.push("no edges collapsed: refinement alone takes no more triangles".to_owned());
    }
    if found.refused > 0 {
        let vertices = counted(found.refused, "vertex", "vertices");
        lines.push(format!("{vertices} kept where a collapse was not proven"));
    }
    lines.extend(open_cones(found));
    lines
}

/// How many triangles stay outside the angle, where that is all that was not reached.
pub(super) fn open_cones(found: &Exact) -> Option<String> {
    let triangles = counted(found.open_cones, "triangle stays", "triangles stay");
    (found.stop == ExactStop::Cones).then(|| {
        format!("{triangles} outside the angle, where the surface has no tangent plane or as good as none")
    })
}

/// Why no distance is certified.
fn unproven(goals: &Goals) -> &'static str {
    if goals.length.is_none() && goals.triangles.is_none() {
        "(no distance was asked for, and what is proven is far more than was found: --tolerance proves one)"
    } else {
        "(no bound was found)"
    }
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(arguments: &RefineArguments, goals: &Goals) -> ParametersReport {
    let options = goals.options(arguments);
    ParametersReport {
        angle_degrees: goals.angle_degrees,
        within: goals.near.map(|near| near.within),
        view: view_report(arguments),
        exact: Some(ExactParametersReport {
            pixels: goals.pixels,
            cameras: goals.cameras.iter().map(CameraReport::from).collect(),
            balance: options.balance,
            optimize: options.optimize,
            divide_flat: arguments.divides_flat(),
            max_memory: options.max_memory,
            ..ExactParametersReport::new(
                goals.length,
                goals.diagonal,
                options.max_levels,
                &arguments.exact,
            )
        }),
        ..ParametersReport::common(arguments)
    }
}

/// Whether a cap ended the refinement before the goals were met, and what was reached.
fn outcome(found: &Exact, control: &Mesh, goals: &Goals, arguments: &RefineArguments) -> Outcome {
    let triangles = found.mesh.face_count();
    let cap = match found.stop {
        ExactStop::TriangleCap => {
            format!("--max-triangles {}", thousands(arguments.max_triangles()))
        }
        ExactStop::MemoryCap => {
            format!(
                "--max-memory {}",
                bytes(arguments.exact.max_memory.unwrap_or_default())
            )
        }
        ExactStop::LevelCap => format!("--max-levels {}", goals.options(arguments).max_levels),
        _ => String::new(),
    };
    let why = match found.stop {
        ExactStop::TriangleCap | ExactStop::MemoryCap if triangles > arguments.max_triangles() => {
            format!("the control mesh has more than {cap} already")
        }
        // What is met with as many triangles as there are in any case.
        ExactStop::Met if triangles > arguments.max_triangles() => {
            let most = thousands(arguments.max_triangles());
            format!("the control mesh has more than --max-triangles {most} already")
        }
        ExactStop::TriangleCap | ExactStop::MemoryCap if triangles == control.face_count() => {
            format!(
                "{} would take more than {cap}, and nothing was divided",
                goals.in_words(found)
            )
        }
        ExactStop::TriangleCap | ExactStop::MemoryCap | ExactStop::LevelCap => {
            format!("{cap} was reached before {}", goals.in_words(found))
        }
        ExactStop::Triangles | ExactStop::Met
            if goals.triangles.is_some_and(|wanted| triangles > wanted) =>
        {
            let wanted = thousands(goals.triangles.unwrap_or_default());
            if arguments.exact.optimize {
                format!("no more edges could be collapsed before --triangles {wanted}")
            } else {
                format!(
                    "the control mesh has {} already, more than --triangles {wanted}; --optimize goes below",
                    thousands(control.face_count())
                )
            }
        }
        ExactStop::Rounding => format!(
            "{} is finer than rounding leaves certain",
            goals.in_words(found)
        ),
        _ => return Outcome::Done,
    };
    let written = format!(
        "{} was written with {}",
        arguments.output_name(),
        counted(triangles, "triangle", "triangles")
    );
    Outcome::StoppedShort(format!("{why}\n  {written}"))
}
