//! `limitmesh refine`: meshes of a source become control meshes, a method refines them, and the source takes them back.
//!
//! ```text
//! jobs ─▶ checks ─▶ source: item ─▶ control ─▶ method ─▶ source: put ─▶ source: write ─▶ report
//! ```

mod attribute_goals;
mod check;
mod control;
mod done;
mod estimate;
mod exact;
mod frames;
mod goals;
mod input_distance;
mod jobs;
mod method;
mod nearness;
mod proof;
mod provenance;
mod refined;
mod restricted;
mod rounding;
mod source;
mod sqrt3;
mod stepwise;
mod task;
mod trail;
mod written;

use std::time::Instant;

use limitmesh_io::Format;

use crate::arguments::RefineArguments;
use crate::bulk::Bulk;
use crate::failure::Outcome;
use crate::input;
use crate::progress::Progress;
use crate::report::SizeReport;
use control::{Control, Read};
use done::Done;
use method::Method;
use source::{AssetSource, FileSource, Item, PackageSource, Source};
use task::Task;

/// Refines a mesh, or each of several.
pub(crate) fn run(arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    if arguments.shared_topology {
        return frames::run(arguments, progress);
    }
    let jobs = jobs::planned(arguments)?;
    jobs::make_ready(arguments, &jobs)?;
    match jobs.as_slice() {
        [(job, format)] => refine(job, *format, progress),
        _ => jobs::each(&jobs, |job, format| refine(job, format, progress)),
    }
}

/// Refines an input: a glTF asset or a 3MF package that stays one, or else one mesh.
fn refine(
    arguments: &RefineArguments,
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<Outcome> {
    let is_file = input::builtin_name(arguments.input()).is_none();
    let is_gltf = |format: Format| format.is_gltf();
    let is_package = |format: Format| format == Format::ThreeMf;
    if is_file && format.is_none_or(|format| is_gltf(format) || is_package(format)) {
        let own = input::format_of(arguments.input(), arguments.build.from)?;
        if is_gltf(own) && format.is_none_or(is_gltf) {
            check::scenes(arguments)?;
            arguments.features.check_of_asset()?;
            let (source, arguments) = AssetSource::open(arguments, own, format, progress)?;
            return refine_all(source, &arguments, format, progress);
        }
        if is_package(own) && format.is_none_or(is_package) {
            arguments.asset.refuse()?;
            check::scenes(arguments)?;
            check::package(arguments)?;
            let (source, arguments) = PackageSource::open(arguments, progress)?;
            return refine_all(source, &arguments, format, progress);
        }
    }
    arguments.asset.refuse()?;
    refine_all(FileSource { format }, arguments, format, progress)
}

/// Refines all meshes of a source, and writes what came of them.
fn refine_all<S: Source>(
    mut source: S,
    arguments: &RefineArguments,
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<Outcome> {
    let mut done = Done::default();
    for number in 0..source.count() {
        if let Some((read, item)) = source.item(number, &done.share(arguments), progress)? {
            refine_one(&mut source, read, item, format, &mut done, progress)?;
        }
    }
    if format.is_none() || arguments.exact.dry_run {
        return Ok(Outcome::Done);
    }
    if S::NOUNS.is_some() {
        progress.stage(format!("writing {}", arguments.output_name()));
    }
    let start = Instant::now();
    source.write(arguments, progress)?;
    done.writing += start.elapsed();
    done.finish(S::NOUNS, source.left_out(), arguments, progress)
}

/// Refines a mesh and puts it back.
fn refine_one<S: Source>(
    source: &mut S,
    read: Read,
    mut item: Item<S::Own>,
    format: Option<Format>,
    done: &mut Done,
    progress: &Progress,
) -> anyhow::Result<()> {
    let start = Instant::now();
    let control = Control::new(read, source.diagonal(), &item.arguments, progress)?;
    item.channels
        .on_parts(&control.concave.parts, &control.mesh);
    let task = Task {
        control: &control,
        channels: &item.channels,
        arguments: &item.arguments,
        format,
        is_traced: item.is_traced,
        progress,
    };
    let mut method = Method::new(&task)?;
    if let Method::Exact(goals) = &mut method {
        source.add_goals(&item.own, goals, &task)?;
    }
    let parameters = method.parameters(&task)?;
    // Without a format to write, this is a dry run, and that is exact: the checks of the arguments see to both.
    if let (Method::Exact(goals), true) =
        (&method, format.is_none() || task.arguments.exact.dry_run)
    {
        return estimate::run(&task, goals, item.input, parameters);
    }
    let mut refined = method.run(&task)?;
    let refining = start.elapsed();
    let size = SizeReport {
        before: control.bulk,
        after: Bulk::as_shown(&refined.mesh, &control.shown),
    };
    refined.add_size(&size, task.arguments);
    if S::NOUNS.is_none() {
        progress.stage(format!("writing {}", task.arguments.output_name()));
    }
    let start = Instant::now();
    source.put(&item, &mut refined, &task)?;
    done.writing += start.elapsed();
    let name = item
        .name
        .clone()
        .unwrap_or_else(|| task.arguments.output_name());
    progress.note(refined.summary(&name, refining.as_secs_f64()));
    progress.notes(refined.inverted_in_words().map(|words| item.line(&words)));
    source.prove_and_draw(&mut refined, &task)?;
    done.refining += refining;
    done.add(item, control, refined, parameters, size, progress);
    Ok(())
}
