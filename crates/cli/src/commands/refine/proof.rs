//! Proofs of distances (`--proof`): made of what was written, and checked before they are.

use std::path::Path;

use anyhow::Context;
use limitmesh::Triangles;
use limitmesh::scheme::Family;
use limitmesh_check::proof::Proof as Claim;
use limitmesh_check::{mesh::Mesh as Plain, read, verdict};
use limitmesh_io::{Format, Proof};

use super::refined::Refined;
use super::task::Task;
use crate::arguments::{RefineArguments, Way};
use crate::failure::{Outcome, usage};
use crate::format::{counted, upper_bound};
use crate::input;
use crate::output;

/// Multiples of the certified distance that are tried. Where that came from a search, or is next to nothing, triangles prove a little less.
const TRIED: [f64; 18] = [
    1.0, 1.1, 1.25, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 13.0, 16.0, 32.0, 64.0,
];

/// Refuses options of which there is no proof.
pub(super) fn check(arguments: &RefineArguments, format: Option<Format>) -> anyhow::Result<()> {
    if arguments.proof.is_none() {
        return Ok(());
    }
    let exact = &arguments.exact;
    let is_proven = arguments.way() == Way::Exact
        && matches!(arguments.scheme()?.family(), Some(Family::Loop(_)));
    let given = [
        ("--dry-run", exact.dry_run, "writes no mesh"),
        (
            "--optimize",
            exact.optimize,
            "gives triangles that reach over several control faces",
        ),
        (
            "--split-normals",
            arguments.split_normals,
            "writes vertices several times",
        ),
    ];
    if !is_proven {
        return usage("--proof is for --method exact and the schemes loop and loop-warren");
    }
    if let Some((option, _, why)) = given.into_iter().find(|&(_, is_given, _)| is_given) {
        return usage(format!("{option} {why}; of that --proof has no proof"));
    }
    let is_read = matches!(format, Some(Format::Obj | Format::Off | Format::Ply));
    if !is_read
        || arguments
            .output
            .as_deref()
            .is_some_and(output::is_standard_output)
    {
        return usage(
            "--proof needs a result in a file that limitmesh-check reads: -o NAME.ply, NAME.obj or NAME.off",
        );
    }
    Ok(())
}

/// Writes the proof of a result that was written, as soon as a length is confirmed: at best what was certified, at worst the tolerance.
///
/// The result's report has that length then, and a note says it. Without a proof, the result stopped short.
///
/// # Errors
/// A file cannot be read or written, or there can be no proof of this result.
pub(super) fn write(path: &Path, refined: &mut Refined, task: &Task<'_>) -> anyhow::Result<()> {
    match proven(path, refined, task)? {
        Ok(within) => {
            if let Some(error) = &mut refined.report.error {
                error.proven = Some(within).filter(|&within| error.upper != Some(within));
                let why = match error.proven {
                    Some(_) => " (less is certified, by a search that no proof holds)",
                    None => "",
                };
                let (path, within) = (path.display(), upper_bound(within));
                task.progress.note(format!(
                    "{path}: proves {within}, as limitmesh-check confirms{why}"
                ));
            }
        }
        Err(why) => {
            if let Outcome::Done = refined.outcome {
                refined.outcome = Outcome::StoppedShort(format!("no proof was written: {why}"));
            }
        }
    }
    Ok(())
}

/// The length that a proof confirms, once it is written, or why there is none.
fn proven(path: &Path, refined: &Refined, task: &Task<'_>) -> anyhow::Result<Result<f64, String>> {
    let (arguments, control) = (task.arguments, task.mesh());
    let written = arguments.output.as_deref();
    debug_assert!(written.is_some(), "--proof needs a result in a file");
    let written = written.context("--proof needs a result in a file")?;
    let result = read_plain(written)
        .with_context(|| format!("{} cannot be read again", written.display()))?;
    let (origins, parents) = (&refined.trail.origins, &refined.trail.parents);
    if result.positions.len() != origins.len() || result.triangles.len() != parents.len() {
        return Ok(Err(format!(
            "vertices stand several times in {}",
            written.display()
        )));
    }
    let Some(Family::Loop(scheme)) = arguments.scheme()?.family() else {
        return Ok(Err("the scheme has none".to_owned()));
    };
    let own = Plain {
        positions: control.positions().to_vec(),
        triangles: control.triangles().to_vec(),
    };
    let is_file = input::builtin_name(arguments.input()).is_none();
    let proof = Proof {
        control,
        holds_control: !is_file || read_plain(arguments.input()).ok().as_ref() != Some(&own),
        scheme,
        result: Triangles {
            positions: &result.positions,
            triangles: &result.triangles,
        },
        origins,
        parents,
    };
    let Some(upper) = refined.report.error.as_ref().and_then(|error| error.upper) else {
        return Ok(Err("no distance is certified".to_owned()));
    };
    let mut refused = Vec::new();
    for within in TRIED.map(|times| times * upper) {
        let bytes = match proof.to_bytes(within) {
            Ok(bytes) => bytes,
            Err(why) => return Ok(Err(why.to_string())),
        };
        let claim = Claim::read(&bytes).map_err(anyhow::Error::msg)?;
        refused = verdict::refused(&own, &result, &claim, within).map_err(anyhow::Error::msg)?;
        if refused.is_empty() {
            output::write_file(path, &bytes)?;
            return Ok(Ok(within));
        }
    }
    let count = counted(refused.len(), "triangle is", "triangles are");
    let most = upper_bound(TRIED[TRIED.len() - 1] * upper);
    let example = refused
        .first()
        .map(|(t, what)| format!(": triangle {t} {what}"));
    let example = example.unwrap_or_default();
    Ok(Err(format!("{count} not proven within {most}{example}")))
}

/// A mesh as the checker reads it.
fn read_plain(path: &Path) -> anyhow::Result<Plain> {
    read::mesh(&path.to_string_lossy(), &std::fs::read(path)?).map_err(anyhow::Error::msg)
}
