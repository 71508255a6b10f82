//! What makes no sense on a command line of `limitmesh refine`, found before any work is done.

use std::io::IsTerminal;
use std::path::Path;

use limitmesh_io::Format;

use super::{picture, restricted, sqrt3};
use crate::arguments::{Method, MorphTolerance, RefineArguments, RefiningScheme};
use crate::failure::usage;
use crate::format::thousands;
use crate::output;

/// Checks options; gives the format to write, none for a dry run without a name.
pub(super) fn options(arguments: &RefineArguments) -> anyhow::Result<Option<Format>> {
    if arguments.scheme == RefiningScheme::Sqrt3 {
        sqrt3::options(arguments)?;
    }
    match arguments.method {
        Method::Exact => stepwise_options(arguments)?,
        Method::Planarity | Method::VertexError => restricted::options(arguments)?,
        _ => exact_options(arguments)?,
    }
    if arguments.method == Method::Uniform {
        uniform(arguments)?;
    }
    let view = arguments.view.is_some() || arguments.eye.is_some();
    if view && !matches!(arguments.method, Method::Exact | Method::LimitNormal) {
        return usage(
            "--view and --eye make the angle from limit normals depend on the viewer; they need --method exact or \
             limit-normal",
        );
    }
    if view && arguments.method == Method::Exact && arguments.angle.is_none() {
        return usage(
            "--view and --eye make --angle depend on the viewer; with --method exact they need one",
        );
    }
    if arguments.dilatation.is_some() && !view {
        return usage(
            "--dilatation widens the angle of faces that look at a viewer; it needs --view or --eye",
        );
    }
    let format = arguments.format()?;
    if arguments.exact.provenance && format.is_some_and(|format| format != Format::Ply) {
        return usage(format!(
            "--provenance writes properties of PLY files; {} is none",
            arguments.output_name()
        ));
    }
    if arguments.split_normals && format.is_some_and(|format| format != Format::Ply) {
        return usage("--split-normals is for PLY files: OBJ holds normals by corner, and the others none");
    }
    if arguments.exact.dry_run && arguments.picture.is_some() {
        return usage("--dry-run gives no mesh that --picture could draw");
    }
    Ok(format)
}

/// Refuses two jobs that would write one file.
pub(super) fn together(jobs: &[RefineArguments]) -> anyhow::Result<()> {
    for (i, job) in jobs.iter().enumerate() {
        let twice = jobs[..i].iter().any(|earlier| earlier.output.is_some() && earlier.output == job.output);
        if twice {
            return usage(format!("{} would be written twice, for inputs of one name", job.output_name()));
        }
    }
    Ok(())
}

/// Refuses options of the stepwise methods.
fn stepwise_options(arguments: &RefineArguments) -> anyhow::Result<()> {
    if arguments.levels.is_some() {
        return usage(
            "--levels is the number of steps of the other methods; with --method exact, --max-levels is a cap",
        );
    }
    if arguments.seam.is_some() {
        return usage("--seam has no effect with --method exact, whose vertices lie on the limit surface");
    }
    if arguments.limit {
        return usage("--limit has no effect with --method exact, whose vertices lie on the limit surface");
    }
    let exact = &arguments.exact;
    let cameras = !exact.camera.is_empty() || !exact.camera_path.is_empty();
    if exact.optimize && (arguments.angle.is_some() || cameras || exact.balance) {
        return usage("--optimize keeps --tolerance and --triangles; not --angle, cameras or --balance");
    }
    let within = matches!(arguments.asset.morph_tolerance, Some(MorphTolerance::Within(_)));
    let goal = arguments.channels.given_tolerance().or(within.then_some("--morph-tolerance"));
    let other = [
        ("--triangles", exact.triangles.is_some()),
        ("--balance", exact.balance),
        ("--optimize", exact.optimize),
    ];
    if let (Some(goal), Some((other, _))) = (goal, other.into_iter().find(|&(_, given)| given)) {
        return usage(format!("{goal} divides until it is met; that does not go with {other}"));
    }
    if let (Some(asked), None) = (exact.triangles, arguments.max_triangles)
        && asked > arguments.max_triangles()
    {
        return usage(format!(
            "--triangles {} is more than the {} that are given at most; --max-triangles raises that, at about 320 bytes \
             of memory each",
            thousands(asked),
            thousands(arguments.max_triangles())
        ));
    }
    if exact.pixels.is_some() && !cameras {
        return usage("--pixels is what cameras see; it needs --camera or --camera-path");
    }
    Ok(())
}

/// Refuses options of the exact method.
fn exact_options(arguments: &RefineArguments) -> anyhow::Result<()> {
    let exact = &arguments.exact;
    let given = [
        ("--tolerance", exact.tolerance.is_some()),
        ("--triangles", exact.triangles.is_some()),
        ("--pixels", exact.pixels.is_some()),
        ("--camera", !exact.camera.is_empty()),
        ("--camera-path", !exact.camera_path.is_empty()),
        ("--balance", exact.balance),
        ("--optimize", exact.optimize),
        ("--divide-flat", exact.divide_flat),
        ("--no-input-distance", exact.no_input_distance),
        ("--max-memory", exact.max_memory.is_some()),
        ("--dry-run", exact.dry_run),
        ("--max-levels", exact.max_levels.is_some()),
        ("--provenance", exact.provenance),
        ("--uv-tolerance", arguments.channels.uv_tolerance.is_some()),
        ("--attribute-tolerance", !arguments.channels.attribute_tolerance.is_empty()),
        ("--morph-tolerance", arguments.asset.morph_tolerance.is_some()),
    ];
    match given.into_iter().find(|&(_, given)| given) {
        Some((option, _)) => usage(format!("{option} is for exact refinement; it needs --method exact")),
        None => Ok(()),
    }
}

/// Refuses what has no effect on uniform refinement.
fn uniform(arguments: &RefineArguments) -> anyhow::Result<()> {
    if arguments.angle.is_some() {
        return usage("--angle has no effect with --method uniform, which divides every face");
    }
    if arguments.seam.is_some() {
        return usage(
            "--seam has no effect with --method uniform, where divided and undivided faces never meet",
        );
    }
    Ok(())
}

/// Checks that what is to be written can be, replaces no input, and is written once.
pub(super) fn files(arguments: &RefineArguments) -> anyhow::Result<()> {
    let mut written: Vec<&Path> = Vec::with_capacity(3);
    if let Some(output) = arguments.output.as_deref() {
        output::check_writable(output)?;
        let binary = match arguments.format()? {
            Some(Format::Ply | Format::Stl) => !arguments.ascii,
            format => matches!(format, Some(Format::Glb | Format::ThreeMf)),
        };
        if output::is_standard_output(output) && binary && std::io::stdout().is_terminal() {
            return usage(
                "binary files are not for a terminal; --ascii writes text, or send it on with > or |",
            );
        }
        written.push(output);
    }
    let beside_mesh = written.len();
    if let Some(picture) = &arguments.picture {
        picture::check_name(picture)?;
        written.push(picture);
    }
    if let Some(report) = &arguments.report {
        output::check_writable(report)?;
        written.push(report);
    }
    output::check_replaced(&written[beside_mesh..], &[arguments.input()], "a report or picture")?;
    output::check_once(&written)
}
