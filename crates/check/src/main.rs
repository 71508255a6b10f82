//! `limitmesh-check`: the arguments, and what is found in words.

use std::io::Write;
use std::process::ExitCode;

use limitmesh_check::proof::Proof;
use limitmesh_check::{read, verdict};

const USAGE: &str = "\
usage: limitmesh-check [CONTROL] RESULT PROOF [--at LENGTH]

Checks that each point of the mesh RESULT is within a length of the limit surface of the mesh CONTROL, and each point of
that surface within it of RESULT. PROOF, as `limitmesh refine --proof` writes it, says which length, and where the
vertices of RESULT come from. Where it holds the control mesh, CONTROL is left out.
Meshes are OBJ, OFF or PLY files of triangles. --at checks another length than that of the proof.

Exit code: 0 confirmed, 1 refused, 2 unreadable.";

/// Triangles that are named where many are refused.
const NAMED: usize = 10;

fn run() -> Result<(bool, String), String> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let mut at = None;
    if let Some(place) = words.iter().position(|word| word == "--at") {
        let length = words.drain(place..words.len().min(place + 2)).nth(1).ok_or("--at lacks its length")?;
        at = Some(length.parse().map_err(|_| format!("{length} is no length"))?);
    }
    let (control, [result, name]) = match &words[..] {
        [control, result, proof] => (Some(control), [result, proof]),
        [result, proof] => (None, [result, proof]),
        _ => return Err(USAGE.into()),
    };
    let bytes = |name: &String| std::fs::read(name).map_err(|error| format!("{name}: {error}"));
    let mesh = |name: &String| read::mesh(name, &bytes(name)?).map_err(|what| format!("{name}: {what}"));
    let proof = Proof::read(&bytes(name)?).map_err(|what| format!("{name}: {what}"))?;
    let (held, result) = (proof.held.clone(), mesh(result)?);
    let control = match (held, control) {
        (Some(held), None) => held,
        (None, Some(control)) => mesh(control)?,
        (Some(_), Some(control)) => {
            return Err(format!(
                "{name} holds the control mesh, which may not be what {control} holds: leave that out"
            ));
        }
        (None, None) => return Err(format!("{name} does not hold the control mesh: name its file first")),
    };
    let within = at.unwrap_or(proof.within);
    let refused =
        verdict::refused(&control, &result, &proof, within).map_err(|what| format!("{name}: {what}"))?;
    let [triangles, faces] = [&result, &control].map(|mesh| mesh.triangles.len());
    let mut text = match refused.len() {
        0 => format!(
            "confirmed: {triangles} triangles and the limit surface of {faces} are within {within} of each other"
        ),
        count => format!("refused: {count} of {triangles} triangles are not proven to be within {within}"),
    };
    refused.iter().take(NAMED).for_each(|(t, what)| text += &format!("\n  triangle {t} {what}"));
    let (edges, vertices) = (proof.creases.len(), proof.corners.len());
    text += &format!(
        "\nby the proof: scheme {}, {edges} sharp edges, {vertices} sharp vertices",
        proof.scheme.name()
    );
    if result.digest() != proof.result {
        text += "\nnote: this result is not the one that the proof was made of";
    }
    Ok((refused.is_empty(), text))
}

fn main() -> ExitCode {
    let (code, written) = match run() {
        Ok((is_confirmed, text)) => (u8::from(!is_confirmed), writeln!(std::io::stdout(), "{text}")),
        Err(what) => (2, writeln!(std::io::stderr(), "error: {what}")),
    };
    ExitCode::from(if written.is_ok() { code } else { 2 })
}
