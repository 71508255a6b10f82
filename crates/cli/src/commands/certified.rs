//! `limitmesh measure --certified`: the distance between two meshes, or to a true limit surface, bounded from both sides.

use limitmesh::measure::{
    Bounds, Bvh, CertifiedHausdorff, CertifiedOptions, certified_hausdorff_between_observed,
};
use limitmesh::refine::{
    LimitDistance, LimitDistanceOptions, is_certified, limit_distance_observed,
};
use limitmesh::{Mesh, Triangles};

use crate::arguments::MeasureArguments;
use crate::failure::{Outcome, usage};
use crate::format::{counted, interval, point, table};
use crate::progress::Progress;
use crate::report::Whole;

/// Finds what makes no sense before any work is done.
pub(super) fn check(arguments: &MeasureArguments) -> anyhow::Result<()> {
    if arguments.certified {
        if arguments.reference_levels.is_some() {
            return usage(
                "--reference-levels is for sampled distances; with --certified the limit surface is as fine as the \
                 interval needs it",
            );
        }
    } else if arguments.gap.is_some() || arguments.max_work.is_some() {
        return usage("--gap and --max-work belong to a certified distance; they need --certified");
    }
    Ok(())
}

/// Bounds the distance as the arguments ask for.
pub(super) fn between(
    a: Triangles<'_>,
    b: Triangles<'_>,
    arguments: &MeasureArguments,
    progress: &Progress,
) -> anyhow::Result<CertifiedHausdorff> {
    let observer = &mut progress.observer();
    let (surface, reference) = (
        Bvh::new_observed(a, observer)?,
        Bvh::new_observed(b, observer)?,
    );
    let mut options = CertifiedOptions::default();
    if let Some(gap) = arguments.gap {
        let gap = gap.length(reference.diagonal(), arguments.limit.build.unit)?;
        options = options.gap(Some(gap)).relative_gap(0.0);
    }
    if let Some(work) = arguments.max_work {
        options = options.max_work(work);
    }
    let found = certified_hausdorff_between_observed(&surface, &reference, &options, observer)?;
    Ok(found)
}

/// Bounds the distance to the limit surface of a control mesh, with finer and finer meshes until the interval is as narrow as asked
/// for; folded flat regions are what their rims enclose if the surface `unfolds`.
///
/// # Errors
/// Exact refinement proves nothing for the scheme, or a surface cannot be measured.
pub(super) fn to_limit(
    surface: Triangles<'_>,
    control: &Mesh,
    unfolds: bool,
    arguments: &MeasureArguments,
    progress: &Progress,
) -> anyhow::Result<LimitDistance> {
    let limit = &arguments.limit;
    let scheme = limit.scheme().scheme();
    if !is_certified(scheme) {
        return usage(format!(
            "nothing is certain about limit surfaces of the scheme {}; without --certified any can be measured against",
            scheme.name()
        ));
    }
    let gap = arguments
        .gap
        .map(|gap| gap.length(control.diagonal(), limit.build.unit));
    let options = LimitDistanceOptions::default();
    let mut options = options.gap(gap.transpose()?).unfold(unfolds);
    if let Some(work) = arguments.max_work {
        options = options.max_work(work);
    }
    let observer = &mut progress.observer();
    Ok(limit_distance_observed(
        surface, control, scheme, &options, observer,
    )?)
}

/// How the command ends; `capped` are the triangles of a mesh that could not approximate a limit surface better.
pub(super) fn outcome(measured: &CertifiedHausdorff, capped: Option<usize>) -> Outcome {
    if measured.converged() {
        return Outcome::Done;
    }
    let [from, to] = interval(measured.lower(), measured.upper());
    let why = match capped {
        None => "the search was cut short; raise --max-work or --gap".to_owned(),
        Some(triangles) => format!(
            "the mesh that approximates the limit surface has {} and may not have many more; raise --gap",
            counted(triangles, "triangle", "triangles")
        ),
    };
    Outcome::StoppedShort(format!(
        "the interval, from {from} to {to}, is as certain but wider than asked for: {why}"
    ))
}

/// All that was found.
pub(super) fn in_words(measured: &CertifiedHausdorff, whole: Whole) -> String {
    let [lower, upper] = interval(measured.lower(), measured.upper());
    let mut text = format!("symmetric Hausdorff distance  from {lower} to {upper}");
    if let [Some(lower), Some(upper)] =
        [measured.lower(), measured.upper()].map(|x| whole.percent(x))
    {
        let [lower, upper] = interval(lower, upper);
        text.push_str(&format!(
            "  ({lower} % to {upper} % of {})",
            whole.in_words()
        ));
    }
    text.push_str("\ncertified: the true distance lies in this interval\n\n");
    let mut rows = vec![["", "at least", "at most", ""].map(str::to_owned).to_vec()];
    let mut places = String::new();
    for (name, bounds) in [
        ("forward", &measured.forward),
        ("backward", &measured.backward),
    ] {
        rows.push(row(name, bounds));
        places.push_str(&format!(
            "{name} maximum near {}, closest point {}\n",
            point(bounds.at),
            point(bounds.to)
        ));
    }
    format!("{text}{}\n{places}", table(&rows))
}

fn row(name: &str, bounds: &Bounds) -> Vec<String> {
    let remark = if bounds.converged { "" } else { "cut short" };
    let [lower, upper] = interval(bounds.lower, bounds.upper);
    vec![name.to_owned(), lower, upper, remark.to_owned()]
}
