//! `limitmesh measure`: the distance between two surfaces, or between a mesh and a limit surface.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use limitmesh::measure::{CertifiedHausdorff, Hausdorff, SamplingOptions, hausdorff_observed};
use limitmesh::{Mesh, Triangles};

use super::limit_control;
use super::{certified, heatmap};
use crate::arguments::{ConcaveCorners, MeasureArguments};
use crate::bulk::Bulk;
use crate::failure::{Outcome, usage};
use crate::format::{counted, number, point, table, thousands, upper_bound};
use crate::input::{self, Input};
use crate::output;
use crate::progress::Progress;
use crate::reference;
use crate::report::Whole;
use crate::report::measurement::{HausdorffReport, MeasureSeconds};
use crate::report::{
    CertifiedReport, DistanceReport, LimitReport, MeasureReport, SurfaceReport, VERSION,
};

/// Measures one surface against another.
pub(crate) fn run(arguments: &MeasureArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    check(arguments)?;
    let start = Instant::now();
    let surface = input::load(&arguments.surface, &arguments.limit.build, &[], progress)?;
    let second = arguments
        .limit_of
        .as_deref()
        .or(arguments.reference.as_deref());
    let second = second.context("there is nothing to measure against")?;
    let (second, limit) = match arguments.limit_of {
        Some(_) => limit_control::load(second, &arguments.limit, progress)?,
        None => {
            let input = input::load(second, &arguments.limit.build, &[], progress)?;
            (input, arguments.limit)
        }
    };
    let limit = limit.in_unit(second.unit);
    let arguments = &MeasureArguments {
        limit,
        ..arguments.clone()
    };
    let surface = surface.in_unit(second.unit, progress)?;
    let a = surface.mesh.as_triangles();
    let (control, reference_report, whole) = reference(second, a, arguments, progress)?;
    let prepare = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let (reference, reference_report, measured) = match reference_report.limit {
        Some(_) if arguments.certified => {
            against_limit(a, &control, reference_report, arguments, progress)?
        }
        _ => {
            let b = control.as_triangles();
            progress.stage(format!(
                "measuring {} against {}",
                counted(a.triangles.len(), "triangle", "triangles"),
                counted(b.triangles.len(), "triangle", "triangles")
            ));
            let measured = Distance::between(a, b, arguments, progress)?;
            (control, reference_report, measured)
        }
    };
    let b = reference.as_triangles();
    let report = MeasureReport {
        version: VERSION,
        surface: describe(&surface, Some(Bulk::of(&surface.mesh))),
        reference: reference_report,
        hausdorff: measured.report(whole),
        seconds: MeasureSeconds {
            prepare,
            measure: start.elapsed().as_secs_f64(),
        },
    };
    if let Some(path) = &arguments.heatmap {
        progress.stage(format!("writing {}", path.display()));
        heatmap::write(path, a, b, whole, progress)?;
    }
    progress.clear();
    if arguments.json {
        output::print(&output::json(&report)?)?;
    } else {
        output::print(&in_words(&report, &measured, whole))?;
    }
    Ok(measured.outcome())
}

/// The distance as it was asked for.
enum Distance {
    Sampled(Hausdorff),
    /// Perhaps with the triangles of a mesh that could not approximate a limit surface better.
    Certified(CertifiedHausdorff, Option<usize>),
}

impl Distance {
    fn between(
        a: Triangles<'_>,
        b: Triangles<'_>,
        arguments: &MeasureArguments,
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        if arguments.certified {
            let found = certified::between(a, b, arguments, progress)?;
            return Ok(Self::Certified(found, None));
        }
        let options = SamplingOptions::default().samples(arguments.samples);
        let found = hausdorff_observed(a, b, &options, &mut progress.observer())?;
        Ok(Self::Sampled(found))
    }

    fn report(&self, whole: Whole) -> DistanceReport {
        match self {
            Self::Sampled(measured) => {
                DistanceReport::Sampled(HausdorffReport::new(measured, whole))
            }
            Self::Certified(measured, _) => {
                DistanceReport::Certified(CertifiedReport::new(measured, whole))
            }
        }
    }

    fn outcome(&self) -> Outcome {
        match self {
            Self::Sampled(_) => Outcome::Done,
            Self::Certified(measured, capped) => certified::outcome(measured, *capped),
        }
    }
}

/// Bounds the distance to the limit surface of a control mesh; gives also the mesh that approximates it.
fn against_limit(
    surface: Triangles<'_>,
    control: &Mesh,
    report: SurfaceReport,
    arguments: &MeasureArguments,
    progress: &Progress,
) -> anyhow::Result<(Mesh, SurfaceReport, Distance)> {
    let is_fixed = |limit: &LimitReport| limit.features.concave_corners == ConcaveCorners::Fixed;
    let unfolds = report.limit.as_ref().is_some_and(is_fixed);
    let found = certified::to_limit(surface, control, unfolds, arguments, progress)?;
    let limit = report.limit.map(|limit| LimitReport {
        levels: found.levels,
        error: Some(found.error),
        ..limit
    });
    let (vertices, triangles) = (found.reference.vertex_count(), found.reference.face_count());
    let report = SurfaceReport {
        vertices,
        triangles,
        limit,
        ..report
    };
    let capped = found.is_capped.then_some(triangles);
    Ok((
        found.reference,
        report,
        Distance::Certified(found.distance, capped),
    ))
}

/// The second surface: a mesh as it is, or one that approximates a limit surface; the control mesh itself, where the
/// distance to its limit surface is to be certified. And what lengths are given in per cent of.
fn reference(
    input: Input,
    measured: Triangles<'_>,
    arguments: &MeasureArguments,
    progress: &Progress,
) -> anyhow::Result<(Mesh, SurfaceReport, Whole)> {
    if arguments.limit_of.is_none() {
        let report = describe(&input, Some(Bulk::of(&input.mesh)));
        let whole = Whole {
            diagonal: input.mesh.diagonal(),
            of: "second mesh",
        };
        return Ok((input.mesh, report, whole));
    }
    let scheme = arguments.limit.scheme();
    let report = describe(&input, None);
    let whole = Whole {
        diagonal: input.mesh.diagonal(),
        of: "control mesh",
    };
    let prepared = limit_control::prepared(input, &arguments.limit, progress)?;
    let (mesh, limit) = (prepared.input.mesh, prepared.limit);
    // Beyond what numbers hold they are not known; distances are.
    let bulk = Bulk::of_limit(&mesh, scheme.scheme()).ok().flatten();
    let (mesh, levels) = if arguments.certified {
        (mesh, 0)
    } else {
        let levels = reference::levels_for(&mesh, measured, arguments.reference_levels)?;
        progress.stage(format!(
            "refining {} by {levels} levels to approximate its limit surface",
            report.path
        ));
        (
            reference::at_level(&mesh, scheme.scheme(), levels)?.mesh,
            levels,
        )
    };
    let chosen = arguments.reference_levels.is_none();
    let limit = LimitReport {
        chosen,
        ..LimitReport::new(&limit, whole.diagonal, levels)?
    };
    let report = SurfaceReport {
        vertices: mesh.vertex_count(),
        triangles: mesh.face_count(),
        limit: Some(limit),
        area: bulk.map(|bulk| bulk.area),
        volume: bulk.and_then(|bulk| bulk.volume),
        ..report
    };
    Ok((mesh, report, whole))
}

fn describe(input: &Input, bulk: Option<Bulk>) -> SurfaceReport {
    SurfaceReport {
        path: input.name.clone(),
        vertices: input.mesh.vertex_count(),
        triangles: input.mesh.face_count(),
        area: bulk.map(|bulk| bulk.area),
        volume: bulk.and_then(|bulk| bulk.volume),
        diagnosis: (&input.diagnosis).into(),
        limit: None,
    }
}

fn in_words(report: &MeasureReport, measured: &Distance, whole: Whole) -> String {
    let mut text = format!("from  {}\n", surface_in_words(&report.surface));
    text.push_str(&format!(
        "to    {}\n\n",
        surface_in_words(&report.reference)
    ));
    text.push_str(&match measured {
        Distance::Sampled(measured) => sampled_in_words(measured, whole),
        Distance::Certified(measured, _) => certified::in_words(measured, whole),
    });
    text.push_str(&bulk_in_words(&report.surface, &report.reference));
    text
}

/// Both areas, and both volumes where both are closed, with their differences.
fn bulk_in_words(surface: &SurfaceReport, reference: &SurfaceReport) -> String {
    let line = |what: &str, own: Option<f64>, other: Option<f64>| {
        let (own, other) = (own?, other?);
        let percent = 100.0 * (own - other) / other;
        let more = if percent.is_finite() {
            format!("  ({percent:+.3} %)")
        } else {
            String::new()
        };
        Some(format!(
            "{what:<7} {} against {}{more}\n",
            number(own),
            number(other)
        ))
    };
    let lines = [
        line("area", surface.area, reference.area),
        line("volume", surface.volume, reference.volume),
    ];
    let lines: String = lines.into_iter().flatten().collect();
    if lines.is_empty() {
        lines
    } else {
        format!("\n{lines}")
    }
}

fn sampled_in_words(measured: &Hausdorff, whole: Whole) -> String {
    let percent = |length: f64| {
        whole.percent(length).map_or_else(
            || "-".to_owned(),
            |percent| format!("{} %", number(percent)),
        )
    };
    let mut text = format!(
        "symmetric Hausdorff distance  {}  ({} of {})\n",
        number(measured.symmetric()),
        percent(measured.symmetric()),
        whole.in_words()
    );
    text.push_str(&format!(
        "sampled: a lower bound, from {} samples of the first surface and {} of the second\n\n",
        thousands(measured.forward.samples),
        thousands(measured.backward.samples)
    ));
    text.push_str(&directions(measured, percent));
    text
}

/// A table of both directions, and where each maximum lies.
fn directions(measured: &Hausdorff, percent: impl Fn(f64) -> String) -> String {
    let cells = |words: [&str; 5]| words.map(str::to_owned).to_vec();
    let mut rows = vec![cells(["", "max", "mean", "RMS", "95 %"])];
    let mut places = String::new();
    for (name, one) in [
        ("forward", &measured.forward),
        ("backward", &measured.backward),
    ] {
        let values = [one.max, one.mean, one.rms, one.percentile_95];
        rows.push([vec![name.to_owned()], values.map(number).to_vec()].concat());
        rows.push([vec![String::new()], values.map(&percent).to_vec()].concat());
        places.push_str(&format!(
            "{name} maximum at {}, closest point {}\n",
            point(one.at),
            point(one.to)
        ));
    }
    format!("{}\n{places}", table(&rows))
}

fn surface_in_words(surface: &SurfaceReport) -> String {
    let triangles = counted(surface.triangles, "triangle", "triangles");
    let mut text = match &surface.limit {
        None => format!("{}: {triangles}", surface.path),
        Some(LimitReport {
            error: Some(error), ..
        }) => {
            let error = upper_bound(*error);
            format!(
                "limit surface of {}: {triangles}, certainly within {error} of it",
                surface.path
            )
        }
        Some(limit) => {
            let chosen = if limit.chosen {
                ", chosen to suit its size"
            } else {
                ""
            };
            let levels = counted(limit.levels, "level", "levels");
            format!(
                "limit surface of {}: {triangles} ({levels}{chosen})",
                surface.path
            )
        }
    };
    if !surface.diagnosis.clean {
        text.push_str("; repaired first");
    }
    text
}

/// Finds what makes no sense before any work is done.
fn check(arguments: &MeasureArguments) -> anyhow::Result<()> {
    let levels = arguments.reference_levels.map(|_| "--reference-levels");
    if let (Some(option), None) = (levels.or(arguments.limit.given()), &arguments.limit_of) {
        return usage(format!(
            "{option} belongs to a limit surface; it needs --limit-of"
        ));
    }
    let given = [
        Some(&arguments.surface),
        arguments.reference.as_ref(),
        arguments.limit_of.as_ref(),
    ];
    input::check_once(given.into_iter().flatten())?;
    certified::check(arguments)?;
    if let Some(heatmap) = &arguments.heatmap {
        heatmap::check_name(heatmap)?;
        let inputs: Vec<&Path> = given.into_iter().flatten().map(PathBuf::as_path).collect();
        output::check_replaced(&[heatmap], &inputs, None)?;
    }
    Ok(())
}
