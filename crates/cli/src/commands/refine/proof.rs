//! Proofs of distances (`--proof`): made of what was written, and checked before they are.

use std::path::Path;

use anyhow::Context;
use limitmesh::{Mesh, Triangles};
use limitmesh_check::proof::Proof as Claim;
use limitmesh_check::{mesh::Mesh as Plain, read, verdict};
use limitmesh_io::{Format, Proof};

use super::Refined;
use super::carried::Trail;
use crate::arguments::{RefineArguments, Way};
use crate::failure::{Outcome, usage};
use crate::format::{counted, upper_bound};
use crate::input;
use crate::output;

/// What is tried, as multiples of what refinement certifies. Where that came from a search, or is next to nothing, triangles prove a little less.
const TRIED: [f64; 18] = [
    1.0, 1.1, 1.25, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 13.0, 16.0, 32.0, 64.0,
];

/// Refuses options of which there is no proof.
pub(super) fn check(arguments: &RefineArguments, format: Option<Format>) -> anyhow::Result<()> {
    if arguments.proof.is_none() {
        return Ok(());
    }
    let exact = &arguments.exact;
    let is_proven = arguments.way() == Way::Exact && arguments.scheme()?.loop_family().is_some();
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

/// What a proof says.
pub(super) struct Proven {
    /// The length, if one was proven.
    pub(super) within: Option<f64>,
    /// What is said of that.
    pub(super) note: Option<String>,
    pub(super) outcome: Outcome,
}

/// Writes the proof of a result that was written, as soon as a length is confirmed: at best what was certified, at worst the tolerance.
///
/// # Errors
/// A file cannot be read or written, or there can be no proof of this result.
pub(super) fn write(
    path: &Path,
    control: &Mesh,
    refined: &Refined,
    arguments: &RefineArguments,
) -> anyhow::Result<Proven> {
    let written = arguments.output.as_deref().unwrap_or(Path::new(""));
    let result = read_plain(written)
        .with_context(|| format!("{} cannot be read again", written.display()))?;
    let Trail {
        origins, parents, ..
    } = &refined.trail;
    let none = |why: String| {
        let text = format!("no proof was written: {why}");
        Ok(Proven {
            within: None,
            note: None,
            outcome: Outcome::StoppedShort(text),
        })
    };
    if result.positions.len() != origins.len() || result.triangles.len() != parents.len() {
        return none(format!(
            "vertices stand several times in {}",
            written.display()
        ));
    }
    let Some(scheme) = arguments.scheme()?.loop_family() else {
        return none("of this scheme".into());
    };
    let own = Plain {
        positions: control.positions().to_vec(),
        triangles: control.as_triangles().triangles.to_vec(),
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
        return none("no distance is certified".into());
    };
    let mut refused = Vec::new();
    for within in TRIED.map(|times| times * upper) {
        let bytes = match proof.to_bytes(within) {
            Ok(bytes) => bytes,
            Err(why) => return none(why.to_string()),
        };
        let claim = Claim::read(&bytes).map_err(anyhow::Error::msg)?;
        refused = verdict::refused(&own, &result, &claim, within).map_err(anyhow::Error::msg)?;
        if refused.is_empty() {
            output::write_file(path, &bytes)?;
            let why = match within > upper {
                true => " (less is certified, by a search that no proof holds)",
                false => "",
            };
            let note = format!(
                "{}: proves {}, as limitmesh-check confirms{why}",
                path.display(),
                upper_bound(within)
            );
            return Ok(Proven {
                within: Some(within),
                note: Some(note),
                outcome: Outcome::Done,
            });
        }
    }
    let count = counted(refused.len(), "triangle is", "triangles are");
    let example = refused
        .first()
        .map(|(t, what)| format!(": triangle {t} {what}"))
        .unwrap_or_default();
    none(format!(
        "{count} not proven within {}{example}",
        upper_bound(TRIED[TRIED.len() - 1] * upper)
    ))
}

/// A mesh as the checker reads it.
fn read_plain(path: &Path) -> anyhow::Result<Plain> {
    read::mesh(&path.to_string_lossy(), &std::fs::read(path)?).map_err(anyhow::Error::msg)
}
