//! Several inputs of one command: where each is written, and how they end together.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::ValueEnum;
use limitmesh_io::Format;

use super::check;
use crate::arguments::{RefineArguments, Unit};
use crate::failure::{self, Outcome, usage};
use crate::input;
use crate::output::{ends_with_separator, is_folder};

/// A command for one input, and the format that it writes; none for a dry run without a name.
pub(super) type Job = (RefineArguments, Option<Format>);

/// The command for each input by itself, with names of files for what was a folder.
///
/// # Errors
/// Several inputs for one file, or an input without a name for a folder.
fn jobs(arguments: &RefineArguments) -> anyhow::Result<Vec<RefineArguments>> {
    let is_unit = |input: &&PathBuf| {
        let name = input.to_str().unwrap_or_default();
        name == "%" || <Unit as ValueEnum>::from_str(name, false).is_ok()
    };
    if let Some(unit) = arguments
        .inputs
        .iter()
        .find(is_unit)
        .filter(|unit| !unit.exists())
    {
        let unit = unit.display();
        return usage(format!(
            "'{unit}' is no file; a length has its unit right behind the number, such as 0.1{unit}"
        ));
    }
    let named = [
        ("--output", &arguments.output),
        ("--report", &arguments.report),
        ("--picture", &arguments.picture),
        ("--proof", &arguments.proof),
    ];
    if arguments.inputs.len() > 1
        && let Some((option, _)) = named
            .iter()
            .find(|(_, path)| path.as_deref().is_some_and(|path| !is_folder(path)))
    {
        return usage(format!(
            "several inputs need a folder for {option}, such as {option} FOLDER/"
        ));
    }
    input::check_once(arguments.inputs.iter())?;
    arguments
        .inputs
        .iter()
        .map(|input| job(arguments, input))
        .collect()
}

fn job(arguments: &RefineArguments, input: &Path) -> anyhow::Result<RefineArguments> {
    let extension = || {
        let to = arguments.to;
        Ok(match (to, input::builtin_name(input)) {
            (Some(to), _) => to.extension(),
            (None, Some(_)) => "ply",
            (None, None) => input::format_of(input, arguments.build.from)?.extension(),
        })
    };
    let place = |path: &Option<PathBuf>, extension: &dyn Fn() -> anyhow::Result<&'static str>| {
        path.as_deref().map(|path| {
            if is_folder(path) {
                file_in(path, input, extension()?)
            } else {
                Ok(path.into())
            }
        })
    };
    let output = match place(&arguments.output, &extension).transpose()? {
        None if !arguments.exact.dry_run => Some(smooth_file(input, extension()?)?),
        given => given,
    };
    Ok(RefineArguments {
        inputs: vec![input.to_owned()],
        output,
        report: place(&arguments.report, &|| Ok("json")).transpose()?,
        picture: place(&arguments.picture, &|| Ok("png")).transpose()?,
        proof: place(&arguments.proof, &|| Ok("proof")).transpose()?,
        ..arguments.clone()
    })
}

/// The file in a folder that is called as the input is.
fn file_in(folder: &Path, input: &Path, extension: &str) -> anyhow::Result<PathBuf> {
    Ok(folder.join(named(stem(input)?, ".", extension)))
}

/// The file in the input's folder that is called as the input is, with `-smooth` behind: where a result goes without `--output`.
fn smooth_file(input: &Path, extension: &str) -> anyhow::Result<PathBuf> {
    let folder = match input::builtin_name(input) {
        Some(_) => Path::new(""),
        None => input.parent().unwrap_or(Path::new("")),
    };
    Ok(folder.join(named(stem(input)?, "-smooth.", extension)))
}

fn named(stem: &OsStr, middle: &str, extension: &str) -> OsString {
    [stem, OsStr::new(middle), OsStr::new(extension)]
        .into_iter()
        .collect()
}

/// The input's name without its folder and its extension.
fn stem(input: &Path) -> anyhow::Result<&OsStr> {
    let stem = match input::builtin_name(input) {
        Some(model) => Some(OsStr::new(model)),
        None => input.file_stem().filter(|&stem| stem != "-"),
    };
    match stem {
        Some(stem) => Ok(stem),
        None => usage(format!(
            "{} has no name that a file could have; --output FILE names it",
            input::display_name(input)
        )),
    }
}

/// The jobs of a command line with the formats that they write, after all checks of the arguments.
///
/// # Errors
/// The arguments make no sense, by themselves or together.
pub(super) fn planned(arguments: &RefineArguments) -> anyhow::Result<Vec<Job>> {
    let jobs = jobs(arguments)?;
    check::together(arguments, &jobs)?;
    let with_format = |job: RefineArguments| {
        let format = check::options(&job)?;
        Ok((job, format))
    };
    jobs.into_iter().map(with_format).collect()
}

/// Makes the folders that are named, and checks that all files can be written.
///
/// # Errors
/// One cannot be.
pub(super) fn make_ready(arguments: &RefineArguments, jobs: &[Job]) -> anyhow::Result<()> {
    make_folders(arguments)?;
    jobs.iter().try_for_each(|(job, _)| check::files(job))
}

/// Makes the folders that are named with a slash at the end.
fn make_folders(arguments: &RefineArguments) -> anyhow::Result<()> {
    let mesh = arguments
        .output
        .as_ref()
        .filter(|_| !arguments.exact.dry_run);
    let others = [&arguments.report, &arguments.picture, &arguments.proof];
    for folder in others.into_iter().flatten().chain(mesh) {
        if ends_with_separator(folder) {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("the folder {} cannot be made", folder.display()))?;
        }
    }
    Ok(())
}

/// Does all, goes on after one that fails, and says in the end how many did.
pub(super) fn each(
    jobs: &[Job],
    run: impl Fn(&RefineArguments, Option<Format>) -> anyhow::Result<Outcome>,
) -> anyhow::Result<Outcome> {
    let (count, mut failed, mut short) = (jobs.len(), 0, 0);
    for (job, format) in jobs {
        match run(job, *format) {
            Ok(Outcome::Done) => {}
            Ok(Outcome::StoppedShort(why)) => {
                short += 1;
                failure::print_stopped_short(&why);
            }
            Err(error) if failure::is_broken_pipe(&error) => return Err(error),
            Err(error) => {
                failed += 1;
                failure::print(&error);
            }
        }
    }
    anyhow::ensure!(
        failed == 0,
        "{failed} of {count} inputs failed, as reported above"
    );
    Ok(match short {
        0 => Outcome::Done,
        _ => Outcome::StoppedShort(format!("{short} of {count} inputs, as reported above")),
    })
}
