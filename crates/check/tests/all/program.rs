//! The program as somebody uses it who has three files.

use std::path::PathBuf;
use std::process::Command;

use limitmesh_check::mesh::Mesh;

use crate::cage::{Cage, octahedron};

fn obj(mesh: &Mesh) -> String {
    let vertices = mesh
        .positions
        .iter()
        .map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = mesh
        .triangles
        .iter()
        .map(|t| t.map(|v| v + 1))
        .map(|[a, b, c]| format!("f {a} {b} {c}\n"));
    vertices.chain(faces).collect()
}

/// A proof with a control mesh in the place of the two zeros that say that it holds none.
fn holding(control: &Mesh, proof: &[u8]) -> Vec<u8> {
    let head = proof
        .windows(5)
        .position(|window| window == b"\nend\n")
        .unwrap()
        + 5;
    // Numbers below 128 are one byte.
    let mut held = vec![control.positions.len() as u8, control.triangles.len() as u8];
    held.extend(
        control
            .positions
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes()),
    );
    held.extend(
        control
            .triangles
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes()),
    );
    [&proof[..head], &held, &proof[head + 2..]].concat()
}

/// Runs the program in a folder; its exit code and what it says.
fn run(folder: &PathBuf, words: &[&str]) -> (Option<i32>, String) {
    let ran = Command::new(env!("CARGO_BIN_EXE_limitmesh-check"))
        .args(words)
        .current_dir(folder)
        .output()
        .unwrap();
    let said = [ran.stdout, ran.stderr].concat();
    (ran.status.code(), String::from_utf8(said).unwrap())
}

#[test]
fn three_files_are_confirmed_or_refused() {
    let folder = std::env::temp_dir().join(format!("limitmesh-check-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (within, cage) = (0.09, Cage::new(octahedron()).refined().refined().settled(4));
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    // Runs the program, which ends with a code and says something.
    let ends = |words: &str, code: i32, what: &str| {
        let words: Vec<&str> = words.split(' ').collect();
        let (found, said) = run(&folder, &words);
        assert_eq!(found, Some(code), "{words:?}: {said}");
        assert!(said.contains(what), "{words:?}: no '{what}' in {said}");
        said
    };
    write("control.obj", obj(&cage.control).as_bytes());
    write("result.obj", obj(&cage.mesh).as_bytes());
    write("result.proof", &cage.proof(within));
    let files = "control.obj result.obj result.proof";
    let said = ends(files, 0, "0.09");
    assert!(said.starts_with("confirmed: 128 triangles"), "{said}");
    let said = ends(&format!("{files} --at 0.01"), 1, "\n  triangle ");
    assert!(said.starts_with("refused: "), "{said}");
    // One vertex moved by twice the length is refused by name; moved by next to nothing it is near enough, but another result.
    let mut moved = cage.clone();
    let other = "control.obj moved.obj result.proof";
    moved.mesh.positions[20][2] += 1e-6;
    write("moved.obj", obj(&moved.mesh).as_bytes());
    ends(other, 0, "not the one");
    moved.mesh.positions[20][2] += 2.0 * within;
    write("moved.obj", obj(&moved.mesh).as_bytes());
    let said = ends(other, 1, "not the one");
    let named = |t: usize| said.contains(&format!("\n  triangle {t} "));
    let at_20 = (0..cage.mesh.triangles.len()).filter(|&t| cage.mesh.triangles[t].contains(&20));
    assert!(at_20.into_iter().any(named), "{said}");
    for (words, what) in [
        ("result.obj result.proof", "name its file first"),
        ("control.obj result.obj control.obj", "is no proof"),
        ("none.obj result.obj result.proof", "none.obj"),
        ("control.obj", "usage"),
        ("control.obj result.obj result.proof --at x", "not a number"),
        ("control.obj result.obj result.proof --at 0", "too small"),
        (
            "control.obj result.obj result.proof --at",
            "lacks its value",
        ),
        ("result.obj control.obj result.proof", "the order is"),
    ] {
        ends(words, 2, what);
    }
    // A control mesh that the proof holds can be looked at, in a file that was not there before.
    ends(
        &format!("{files} --control shown.obj"),
        2,
        "holds no control mesh",
    );
    write("held.proof", &holding(&cage.control, &cage.proof(within)));
    let held = "result.obj held.proof --control";
    ends(&format!("{held} result.obj"), 2, "result.obj: ");
    let bytes = |name: &str| std::fs::read(folder.join(name)).unwrap();
    assert_eq!(bytes("result.obj"), obj(&cage.mesh).as_bytes());
    ends(&format!("{held} shown.obj"), 0, "");
    let shown = limitmesh_check::read::mesh("shown.obj", &bytes("shown.obj"));
    assert_eq!(shown.unwrap(), cage.control);
    ends("--help", 0, "usage");
    ends("--version", 0, env!("CARGO_PKG_VERSION"));
    std::fs::remove_dir_all(&folder).unwrap();
}
