//! √3-subdivision: uniform steps, and adaptive refinement to an angle, an estimated distance or a number of triangles.

use limitmesh::Mesh;
use limitmesh::mesh::Channel;
use limitmesh::refine::{Refinement, UniformOptions};
use limitmesh::sqrt3::{Sqrt3, Sqrt3Options, adaptive_observed, uniform_observed};
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::carried::Trail;
use super::control::Before;
use super::goals::unit_in_words;
use super::provenance::Provenance;
use super::stepwise;
use super::{Refined, capped};
use crate::arguments::{Extent, Featured, RefineArguments};
use crate::format::counted;
use crate::progress::Progress;
use crate::report::refinement::{ErrorReport, ExactParametersReport, exact_stop_name};
use crate::report::{MethodReport, ParametersReport};

/// The tolerance where there is no other goal, in per cent of the diagonal: that of the exact method.
const USUAL_PERCENT: f64 = 0.1;

/// Leaves out what the input carries, and says so.
pub(super) fn without_channels(channels: Vec<Channel>, progress: &Progress) -> Vec<Channel> {
    if !channels.is_empty() {
        let names: Vec<&str> = channels
            .iter()
            .map(|channel| channel.name.as_str())
            .collect();
        progress.note(format!(
            "left out: {} (--scheme sqrt3 carries no values)",
            names.join("; ")
        ));
    }
    Vec::new()
}

/// What was asked for of adaptive refinement, defaults filled in.
pub(super) fn parameters(
    arguments: &RefineArguments,
    diagonal: f64,
) -> anyhow::Result<ParametersReport> {
    let goals = goals(arguments, diagonal)?;
    Ok(ParametersReport {
        angle_degrees: arguments.angle,
        exact: Some(ExactParametersReport::new(
            goals.tolerance,
            diagonal,
            goals.max_levels,
            &arguments.exact,
        )),
        ..ParametersReport::common(arguments)
    })
}

/// The goals and caps of an adaptive refinement.
fn goals(arguments: &RefineArguments, diagonal: f64) -> anyhow::Result<Sqrt3Options> {
    let exact = &arguments.exact;
    let usual = (arguments.angle.is_none() && exact.triangles.is_none())
        .then_some(Extent::Percent(USUAL_PERCENT));
    let tolerance = exact
        .tolerance
        .or(usual)
        .map(|extent| extent.length(diagonal, arguments.build.unit));
    let options = Sqrt3Options::default()
        .angle(arguments.angle.map(f64::to_radians))
        .tolerance(tolerance.transpose()?)
        .triangles(exact.triangles)
        .max_triangles(Some(arguments.max_triangles()))
        .origins(exact.provenance);
    Ok(exact
        .max_levels
        .map_or(options, |levels| options.max_levels(levels)))
}

/// Divides what fails, by its centre, the worst first. `before` tells the input's faces, `diagonal` what lengths in per cent are of.
pub(super) fn to_goals(
    (control, before, diagonal): (&Featured, &Before, f64),
    arguments: &RefineArguments,
    format: Format,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let options = goals(arguments, diagonal)?;
    progress.stage(format!(
        "refining {}",
        counted(control.mesh.face_count(), "triangle", "triangles")
    ));
    let found = adaptive_observed(&control.mesh, &options, &mut progress.observer())?;
    let Sqrt3 {
        mesh,
        normals,
        origins,
        parents,
        levels,
        estimated_distance,
        stop,
        ..
    } = found;
    let error =
        estimated_distance.map(|distance| ErrorReport::estimated(distance, diagonal, &mesh));
    let unit = unit_in_words(arguments.build.unit);
    let achieved = error
        .as_ref()
        .map_or_else(Vec::new, |error| error.in_words(&unit));
    let places = (&before.faces[..], &control.concave.parts);
    let provenance = arguments
        .exact
        .provenance
        .then(|| Provenance::new(&origins, parents, places));
    let wanted = Normals::are_held(format) || arguments.picture.is_some();
    Ok(Refined {
        normals: wanted.then(|| Normals::of_sides(&mesh, normals)),
        channels: Channels::default(),
        provenance,
        trail: Trail::default(),
        achieved,
        inverted: None,
        how: counted(levels, "level", "levels") + " of √3-subdivision",
        outcome: capped(&mesh, stop, arguments),
        report: MethodReport {
            error,
            ..MethodReport::new(levels, exact_stop_name(stop))
        },
        mesh,
    })
}

/// Refines by steps, and moves the vertices to the limit if asked.
pub(super) fn by_steps(
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
    let mut observer = stepwise::watch(levels, progress);
    let Refinement {
        mesh,
        normals,
        steps,
        stop,
        ..
    } = uniform_observed(control, &options, &mut observer)?;
    let normals = normals.map(|sided| Normals::of_sides(&mesh, sided));
    Ok(Refined {
        normals,
        channels: Channels::default(),
        provenance: None,
        trail: Trail::default(),
        achieved: Vec::new(),
        inverted: None,
        how: counted(
            steps.len(),
            "step of √3-subdivision",
            "steps of √3-subdivision",
        ),
        outcome: stepwise::outcome(arguments, &mesh, &steps, stop),
        report: stepwise::report(&steps, stop),
        mesh,
    })
}
