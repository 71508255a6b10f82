//! What makes no sense on a command line of `limitmesh refine`, found before any work is done.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::Path;

use limitmesh_io::Format;

use super::super::picture;
use super::proof;
use crate::arguments::{MAX_STEPS, Method, MorphTolerance, RefineArguments, Viewer, Way};
use crate::failure::usage;
use crate::file_identity::FileIdentity;
use crate::format::thousands;
use crate::output;

/// Checks options; gives the format to write, none for a dry run without a name.
pub(super) fn options(arguments: &RefineArguments) -> anyhow::Result<Option<Format>> {
    let way = arguments.way();
    if way == Way::Sqrt3 && arguments.method != Method::Exact {
        return usage(format!(
            "--scheme sqrt3 has criteria of its own, so that --method {} does not go with it; without --method, --angle, \
             --tolerance and --triangles are its goals, and --method uniform divides all triangles",
            arguments.method.name()
        ));
    }
    if let Some(option) = unknown(arguments) {
        return usage(option.refusal(way, arguments.method));
    }
    match way {
        Way::Exact | Way::Sqrt3 => goals(arguments)?,
        Way::Stepwise | Way::Sqrt3Steps => steps(arguments)?,
        Way::Restricted => restricted(arguments)?,
    }
    viewers(arguments)?;
    let format = arguments.format()?;
    if arguments.exact.provenance && format.is_some_and(|format| format != Format::Ply) {
        return usage(format!(
            "--provenance writes properties of PLY files; {} is none",
            arguments.output_name()
        ));
    }
    proof::check(arguments, format)?;
    if arguments.split_normals && format.is_some_and(|format| format != Format::Ply) {
        return usage(
            "--split-normals is for PLY files: OBJ holds normals by corner, and the others none",
        );
    }
    if arguments.exact.dry_run && arguments.picture.is_some() {
        return usage("--dry-run gives no mesh that --picture could draw");
    }
    Ok(format)
}

/// Refuses viewers whom a method or the others do not know.
fn viewers(arguments: &RefineArguments) -> anyhow::Result<()> {
    let is_one = |viewer: &&Viewer| matches!(viewer, Viewer::Direction(_) | Viewer::Eye(_));
    match arguments.view.iter().filter(is_one).count() {
        0 if arguments.dilatation.is_some() => usage(
            "--dilatation widens the angle of faces that look at a viewer; it needs --view X,Y,Z or --view @X,Y,Z",
        ),
        0 => Ok(()),
        1 if !matches!(arguments.method, Method::Exact | Method::LimitNormal) => usage(
            "a direction or an eye in --view makes the angle from limit normals depend on the viewer; it needs --method exact or \
             limit-normal",
        ),
        1 if arguments.method == Method::Exact && arguments.angle.is_none() => usage(
            "a direction or an eye in --view makes --angle depend on the viewer; with --method exact it needs one",
        ),
        1 => Ok(()),
        _ => usage("--view knows one direction or eye at a time; of cameras there may be several"),
    }
}

/// Refuses two jobs that would write one file, and one that would replace an input of any of them.
pub(super) fn together(
    arguments: &RefineArguments,
    jobs: &[RefineArguments],
) -> anyhow::Result<()> {
    if arguments.exact.dry_run {
        return Ok(());
    }
    let written: Vec<&Path> = jobs
        .iter()
        .filter_map(|job| job.output.as_deref())
        .collect();
    let inputs: Vec<&Path> = jobs.iter().map(RefineArguments::input).collect();
    output::check_replaced(&written, &inputs, Some(arguments.overwrite))?;
    output::check_once(&written)?;
    // Where that is asked for a result may replace its own input, but not what another result is to be made from.
    let read: BTreeMap<FileIdentity, usize> = inputs
        .iter()
        .enumerate()
        .map(|(number, input)| (FileIdentity::of(input), number))
        .collect();
    for (number, job) in jobs.iter().enumerate() {
        let Some(output) = job.output.as_deref() else {
            continue;
        };
        if read
            .get(&FileIdentity::of(output))
            .is_some_and(|&other| other != number)
        {
            return usage(format!(
                "{} is an input, too, which the result of {} would replace",
                output.display(),
                job.input().display()
            ));
        }
    }
    Ok(())
}

/// Refuses glTF assets and 3MF packages, which are edited mesh by mesh, where that cannot be.
pub(super) fn scenes(arguments: &RefineArguments) -> anyhow::Result<()> {
    match arguments.way() {
        Way::Exact | Way::Stepwise => Ok(()),
        Way::Sqrt3 | Way::Sqrt3Steps => usage(
            "--scheme sqrt3 carries no attributes, so it does not edit glTF assets and 3MF packages; OBJ, PLY, STL and OFF \
             files it refines",
        ),
        // Their meshes share one tolerance.
        Way::Restricted => usage(
            "--method planarity and vertex-error are there to be compared with, mesh by mesh, so they do not edit glTF assets and \
             3MF packages; OBJ, PLY, STL and OFF files they refine",
        ),
    }
}

/// An option that not all ways to refine know.
struct Limited {
    name: &'static str,
    is_given: bool,
    known: &'static [Way],
}

/// The first option that is given, and unknown to the way that is gone.
fn unknown(arguments: &RefineArguments) -> Option<Limited> {
    let way = arguments.way();
    limited(arguments)
        .into_iter()
        .find(|option| option.is_given && !option.known.contains(&way))
}

/// All of them. What depends on other options has checks of its own.
fn limited(arguments: &RefineArguments) -> Vec<Limited> {
    const EXACT: &[Way] = &[Way::Exact];
    const IN_QUARTERS: &[Way] = &[Way::Exact, Way::Stepwise, Way::Restricted];
    const GOALS: &[Way] = &[Way::Exact, Way::Restricted, Way::Sqrt3];
    const STEPS: &[Way] = &[Way::Stepwise, Way::Sqrt3Steps];
    let exact = &arguments.exact;
    let has_tolerance = arguments.channels.given_tolerance().is_some();
    [
        ("--seam", arguments.seam.is_some(), STEPS),
        ("--limit", arguments.limit, STEPS),
        (
            "--interpolate",
            arguments.interpolation.given().is_some(),
            IN_QUARTERS,
        ),
        ("--tolerance", exact.tolerance.is_some(), GOALS),
        ("--triangles", exact.triangles.is_some(), GOALS),
        ("--provenance", exact.provenance, GOALS),
        ("--within", exact.within.is_some(), EXACT),
        ("--pixels", exact.pixels.is_some(), EXACT),
        ("cameras in --view", arguments.has_cameras(), EXACT),
        ("--view", !arguments.view.is_empty(), IN_QUARTERS),
        ("--balance", exact.balance, EXACT),
        ("--optimize", exact.optimize, EXACT),
        ("--divide-flat", exact.divide_flat, EXACT),
        ("--max-memory", exact.max_memory.is_some(), EXACT),
        ("--dry-run", exact.dry_run, EXACT),
        ("--attribute-tolerance", has_tolerance, EXACT),
        (
            "--morph-tolerance",
            arguments.asset.morph_tolerance.is_some(),
            EXACT,
        ),
    ]
    .map(|(name, is_given, known)| Limited {
        name,
        is_given,
        known,
    })
    .into()
}

impl Limited {
    /// Why it does not go with a way that does not know it.
    fn refusal(&self, way: Way, method: Method) -> String {
        let name = self.name;
        let is_of_steps = self.known.contains(&Way::Sqrt3Steps);
        match way {
            Way::Exact | Way::Sqrt3 if is_of_steps => {
                format!(
                    "{name} has no effect with --method exact, whose vertices lie on the limit surface"
                )
            }
            Way::Sqrt3 | Way::Sqrt3Steps if !self.known.contains(&Way::Sqrt3) => format!(
                "{name} does not go with --scheme sqrt3; it knows the schemes that split triangles in four: loop, loop-warren, \
                 butterfly"
            ),
            Way::Restricted => format!(
                "{name} does not go with --method {}, a criterion of the literature; it is for other methods",
                method.name()
            ),
            _ => format!("{name} is for exact refinement; it needs --method exact"),
        }
    }
}

/// Refuses goals and caps that do not go together.
fn goals(arguments: &RefineArguments) -> anyhow::Result<()> {
    let exact = &arguments.exact;
    if exact.within.is_some() && arguments.scheme()?.loop_family().is_none() {
        return usage(format!(
            "--scheme {} passes through the vertices of the input, so that --within has nothing to smooth; loop and loop-warren do not",
            arguments.scheme()?.name()
        ));
    }
    if arguments.levels == Some(0) {
        return usage("--levels 0 lets nothing be divided; goals need 1 at least");
    }
    let cameras = arguments.has_cameras();
    if exact.optimize && (arguments.angle.is_some() || cameras || exact.balance) {
        return usage(
            "--optimize keeps --tolerance and --triangles; not --angle, cameras or --balance",
        );
    }
    let within = matches!(
        arguments.asset.morph_tolerance,
        Some(MorphTolerance::Within(_))
    );
    let goal = arguments
        .channels
        .given_tolerance()
        .or(within.then_some("--morph-tolerance"));
    let other = [
        ("--triangles", exact.triangles.is_some()),
        ("--balance", exact.balance),
        ("--optimize", exact.optimize),
    ];
    if let (Some(goal), Some((other, _))) = (goal, other.into_iter().find(|&(_, given)| given)) {
        return usage(format!(
            "{goal} divides until it is met; that does not go with {other}"
        ));
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
        return usage("--pixels is what cameras see; it needs a camera in --view");
    }
    Ok(())
}

/// Refuses goals that the criteria of the literature do not have.
fn restricted(arguments: &RefineArguments) -> anyhow::Result<()> {
    let why = match (arguments.method, arguments.angle) {
        _ if arguments.levels == Some(0) => {
            "--levels 0 lets nothing be divided; goals need 1 at least"
        }
        (_, None) => return Ok(()),
        (Method::VertexError, _) => {
            "--angle does not go with --method vertex-error, whose goal is a distance: --tolerance"
        }
        _ if arguments.exact.tolerance.is_some() => {
            "--method planarity goes by angles or by distances: --angle and --tolerance are not given together"
        }
        _ => return Ok(()),
    };
    usage(why)
}

/// Refuses too many steps, and what has no effect on uniform refinement.
fn steps(arguments: &RefineArguments) -> anyhow::Result<()> {
    if arguments.levels.is_some_and(|levels| levels > MAX_STEPS) {
        return usage(format!(
            "{MAX_STEPS} steps are the most, as each gives up to four times the triangles; --levels is a cap with --method exact alone"
        ));
    }
    let why = match arguments.method {
        Method::Uniform if arguments.angle.is_some() => {
            "--angle has no effect with --method uniform, which divides every face"
        }
        Method::Uniform if arguments.seam.is_some() => {
            "--seam has no effect with --method uniform, where divided and undivided faces never meet"
        }
        _ => return Ok(()),
    };
    usage(why)
}

/// Checks that what is to be written can be, replaces no input, and is written once.
pub(super) fn files(arguments: &RefineArguments) -> anyhow::Result<()> {
    let mut written: Vec<&Path> = Vec::with_capacity(4);
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
    let after_mesh = written.len();
    if let Some(picture) = &arguments.picture {
        picture::check_name(picture)?;
        written.push(picture);
    }
    for path in arguments.proof.iter().chain(&arguments.report) {
        output::check_writable(path)?;
        written.push(path);
    }
    output::check_replaced(&written[after_mesh..], &[arguments.input()], None)?;
    output::check_once(&written)
}
