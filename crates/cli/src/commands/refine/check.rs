//! Checks of the command line of `limitmesh refine`, before any work is done.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::Path;

use limitmesh_io::Format;

use super::super::picture;
use super::proof;
use crate::arguments::{
    FaceKind, MAX_STEPS, Method, MorphTolerance, RefineArguments, SMOOTH_TRIANGLES, Viewer, Way,
};
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
    if let (true, Some(option)) = (arguments.has_quads(), arguments.needs_triangles()) {
        return usage(format!(
            "{option} is for triangles, and does not go with --scheme catmull-clark"
        ));
    }
    if arguments.smooth_triangles && !arguments.has_quads() {
        return usage(SMOOTH_TRIANGLES);
    }
    if let Some((_, why)) = rules(arguments)
        .into_iter()
        .find(|&(is_broken, _)| is_broken)
    {
        return usage(why);
    }
    goals(arguments)?;
    let format = arguments.format()?;
    if let Some(why) = arguments.no_quads(format)
        && arguments.faces == Some(FaceKind::Quads)
    {
        return usage(why);
    }
    let is_other = format.is_some_and(|format| format != Format::Ply);
    if arguments.exact.provenance && is_other {
        let name = arguments.output_name();
        return usage(format!(
            "--provenance writes properties of PLY files; {name} is none"
        ));
    }
    if arguments.split_normals && is_other {
        return usage(
            "--split-normals is for PLY files: OBJ holds normals by corner, and the others none",
        );
    }
    proof::check(arguments, format)?;
    Ok(format)
}

/// Whether a rule is broken, and why it holds.
fn rules(arguments: &RefineArguments) -> [(bool, &'static str); 12] {
    let (exact, method, way) = (&arguments.exact, arguments.method, arguments.way());
    let has_angle = arguments.angle.is_some();
    let is_one = |viewer: &&Viewer| matches!(viewer, Viewer::Direction(_) | Viewer::Eye(_));
    let viewers = arguments.view.iter().filter(is_one).count();
    let by_steps = matches!(way, Way::Stepwise | Way::Sqrt3Steps);
    let is_uniform = method == Method::Uniform;
    let has_limit_normals = matches!(method, Method::Exact | Method::LimitNormal);
    let is_whole = has_angle || arguments.has_cameras() || exact.balance;
    [
        (
            viewers == 0 && arguments.dilatation.is_some(),
            "--dilatation widens the angle of faces that look at a viewer; it needs --view X,Y,Z or --view @X,Y,Z",
        ),
        (
            viewers > 0 && !has_limit_normals,
            "a direction or an eye in --view makes the angle from limit normals depend on the viewer; it needs --method exact or limit-normal",
        ),
        (
            viewers > 0 && method == Method::Exact && !has_angle,
            "a direction or an eye in --view makes --angle depend on the viewer; with --method exact it needs one",
        ),
        (
            viewers > 1,
            "--view knows one direction or eye at a time; of cameras there may be several",
        ),
        (
            !by_steps && arguments.levels == Some(0),
            "--levels 0 lets nothing be divided; goals need 1 at least",
        ),
        (
            by_steps && arguments.levels.is_some_and(|levels| levels > MAX_STEPS),
            "12 steps are the most, as each gives up to four times the triangles; --levels is a cap with --method exact alone",
        ),
        (
            is_uniform && has_angle,
            "--angle has no effect with --method uniform, which divides every face",
        ),
        (
            method == Method::VertexError && has_angle,
            "--angle does not go with --method vertex-error, whose goal is a distance: --tolerance",
        ),
        (
            method == Method::Planarity && has_angle && exact.tolerance.is_some(),
            "--method planarity goes by angles or by distances: --angle and --tolerance are not given together",
        ),
        (
            exact.optimize && is_whole,
            "--optimize keeps --tolerance and --triangles; not --angle, cameras or --balance",
        ),
        (
            exact.pixels.is_some() && !arguments.has_cameras(),
            "--pixels is what cameras see; it needs a camera in --view",
        ),
        (
            arguments.exact.dry_run && arguments.picture.is_some(),
            "--dry-run gives no mesh that --picture could draw",
        ),
    ]
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
    let read = inputs
        .iter()
        .zip(0..)
        .map(|(input, number)| (FileIdentity::of(input), number));
    let read: BTreeMap<FileIdentity, usize> = read.collect();
    for (number, job) in jobs.iter().enumerate() {
        let Some(output) = job.output.as_deref() else {
            continue;
        };
        let reader = read.get(&FileIdentity::of(output));
        if reader.is_some_and(|&other| other != number) {
            let (output, input) = (output.display(), job.input().display());
            return usage(format!(
                "{output} is an input, too, which the result of {input} would replace"
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

/// Refuses 3MF packages for what they cannot hold.
pub(super) fn package(arguments: &RefineArguments) -> anyhow::Result<()> {
    if arguments.has_quads() {
        return usage(
            "--scheme catmull-clark is for polygons, of which 3MF packages have none but triangles; OBJ, PLY and OFF files have others",
        );
    }
    arguments.features.check_of_package()
}

/// An option that not all methods know.
struct Limited {
    name: &'static str,
    known: &'static [Way],
}

/// The first option that is given, and unknown to the method. What depends on other options has rules of its own.
fn unknown(arguments: &RefineArguments) -> Option<Limited> {
    const EXACT: &[Way] = &[Way::Exact];
    const IN_QUARTERS: &[Way] = &[Way::Exact, Way::Stepwise, Way::Restricted];
    const GOALS: &[Way] = &[Way::Exact, Way::Restricted, Way::Sqrt3];
    const STEPS: &[Way] = &[Way::Stepwise, Way::Sqrt3Steps];
    let exact = &arguments.exact;
    let is_led = arguments.interpolation.given().is_some();
    let has_tolerance = arguments.channels.given_tolerance().is_some();
    let has_morphs = arguments.asset.morph_tolerance.is_some();
    let all = [
        ("--limit", arguments.limit, STEPS),
        ("--interpolate", is_led, IN_QUARTERS),
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
        ("--morph-tolerance", has_morphs, EXACT),
    ];
    let way = arguments.way();
    let mut given = all.into_iter().filter(|&(_, is_given, _)| is_given);
    let (name, _, known) = given.find(|(.., known)| !known.contains(&way))?;
    Some(Limited { name, known })
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
    if exact.within.is_some() && arguments.scheme()?.family().is_none() {
        return usage(format!(
            "--scheme {} passes through the vertices of the input, so that --within has nothing to smooth; loop and loop-warren do not",
            arguments.scheme()?.name()
        ));
    }
    let morph = arguments.asset.morph_tolerance;
    let is_within = matches!(morph, Some(MorphTolerance::Within(_)));
    let goal = arguments.channels.given_tolerance();
    let goal = goal.or(is_within.then_some("--morph-tolerance"));
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
    Ok(())
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
