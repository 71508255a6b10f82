//! `limitmesh-check`: the arguments, and what is found in words.

use std::io::Write;
use std::process::ExitCode;

use limitmesh_check::mesh::Mesh;
use limitmesh_check::proof::Proof;
use limitmesh_check::{read, verdict};

const USAGE: &str = "\
usage: limitmesh-check [CONTROL] RESULT PROOF [--at LENGTH] [--control FILE.obj]

Checks that each point of the mesh RESULT is within a length of the limit surface of the mesh CONTROL, and each point of
that surface within it of RESULT. PROOF, as `limitmesh refine --proof` writes it, says which length, and where the
vertices of RESULT come from. Where it holds the control mesh, CONTROL may be left out.
Meshes are OBJ, OFF or PLY files of triangles.

  --at LENGTH          checks another length than that of the proof, in the unit of the meshes
  --control FILE.obj   writes the control mesh that the proof holds into a new file
  --version

Exit code: 0 confirmed, 1 refused, 2 unreadable.";

/// Triangles that are named where many are refused.
const NAMED: usize = 10;

/// Takes an option and its value out of the arguments.
fn taken(words: &mut Vec<String>, option: &str) -> Result<Option<String>, String> {
    let Some(place) = words.iter().position(|word| word == option) else {
        return Ok(None);
    };
    let value = words.drain(place..words.len().min(place + 2)).nth(1);
    value.map(Some).ok_or(format!("{option} lacks its value"))
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    mesh.positions
        .iter()
        .for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
    mesh.triangles
        .iter()
        .for_each(|t| text += &format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1));
    text
}

/// Writes a file that is not there yet, whole or not at all.
fn write_new(file: &str, text: &str) -> std::io::Result<()> {
    let mut new = std::fs::File::create_new(file)?;
    let written = new.write_all(text.as_bytes());
    written.inspect_err(|_| _ = std::fs::remove_file(file))
}

fn run() -> Result<(bool, String), String> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    match words.first().map(String::as_str) {
        Some("-h" | "--help") => return Ok((true, USAGE.into())),
        Some("-V" | "--version") => {
            return Ok((
                true,
                concat!("limitmesh-check ", env!("CARGO_PKG_VERSION")).into(),
            ));
        }
        _ => {}
    }
    let at = taken(&mut words, "--at")?;
    let number = |at: String| {
        at.parse()
            .map_err(|_| format!("--at {at}: not a number; lengths are in the unit of the meshes"))
    };
    let at = at.map(number).transpose()?;
    let shown = taken(&mut words, "--control")?;
    let (control, [result, name]) = match &words[..] {
        [control, result, proof] => (Some(control), [result, proof]),
        [result, proof] => (None, [result, proof]),
        _ => return Err(USAGE.into()),
    };
    let bytes = |name: &String| std::fs::read(name).map_err(|error| format!("{name}: {error}"));
    let mesh =
        |name: &String| read::mesh(name, &bytes(name)?).map_err(|what| format!("{name}: {what}"));
    let proof = Proof::read(&bytes(name)?).map_err(|what| format!("{name}: {what}"))?;
    let result = mesh(result)?;
    let control = match (control, &proof.held) {
        (Some(control), _) => mesh(control)?,
        (None, Some(held)) => held.clone(),
        (None, None) => {
            return Err(format!(
                "{name} does not hold the control mesh: name its file first"
            ));
        }
    };
    let within = at.unwrap_or(proof.within);
    let refused = verdict::refused(&control, &result, &proof, within)
        .map_err(|what| format!("{name}: {what}"))?;
    // By now it is known that the proof is about this mesh.
    match (shown, &proof.held) {
        (Some(file), Some(held)) => {
            write_new(&file, &obj(held)).map_err(|error| format!("{file}: {error}"))?;
        }
        (Some(_), None) => {
            return Err(format!(
                "{name} holds no control mesh that --control could write"
            ));
        }
        (None, _) => {}
    }
    let [triangles, faces] = [&result, &control].map(|mesh| mesh.triangles.len());
    let mut text = match refused.len() {
        0 => format!(
            "confirmed: {triangles} triangles and the limit surface of {faces} are within {within} of each other"
        ),
        count => format!(
            "refused: {count} of {triangles} triangles are not proven to be within {within}"
        ),
    };
    refused
        .iter()
        .take(NAMED)
        .for_each(|(t, what)| text += &format!("\n  triangle {t} {what}"));
    if refused.len() > NAMED {
        text += &format!(
            "\n  and {} more (triangles are counted from 0)",
            refused.len() - NAMED
        );
    }
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
        Ok((is_confirmed, text)) => (
            u8::from(!is_confirmed),
            writeln!(std::io::stdout(), "{text}"),
        ),
        Err(what) => (2, writeln!(std::io::stderr(), "error: {what}")),
    };
    ExitCode::from(if written.is_ok() { code } else { 2 })
}
