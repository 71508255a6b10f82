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
    write("control.obj", obj(&cage.control).as_bytes());
    write("result.obj", obj(&cage.mesh).as_bytes());
    write("result.proof", &cage.proof(within));
    let files = ["control.obj", "result.obj", "result.proof"];
    let (code, said) = run(&folder, &files);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.starts_with("confirmed: 128 triangles") && said.contains("0.09"),
        "{said}"
    );
    let (code, said) = run(&folder, &[&files[..], &["--at", "0.01"]].concat());
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.starts_with("refused: ") && said.contains("\n  triangle "),
        "{said}"
    );
    // One vertex moved by twice the length is refused by name; moved by next to nothing it is near enough, but another result.
    let mut moved = cage.clone();
    moved.mesh.positions[20][2] += 1e-6;
    write("moved.obj", obj(&moved.mesh).as_bytes());
    let (code, said) = run(&folder, &["control.obj", "moved.obj", "result.proof"]);
    assert!(code == Some(0) && said.contains("not the one"), "{said}");
    moved.mesh.positions[20][2] += 2.0 * within;
    write("moved.obj", obj(&moved.mesh).as_bytes());
    let (code, said) = run(&folder, &["control.obj", "moved.obj", "result.proof"]);
    assert!(code == Some(1) && said.contains("not the one"), "{said}");
    let named = |t: usize| said.contains(&format!("\n  triangle {t} "));
    let at_20 = (0..cage.mesh.triangles.len()).filter(|&t| cage.mesh.triangles[t].contains(&20));
    assert!(at_20.into_iter().any(named), "{said}");
    for (words, what) in [
        (&["result.obj", "result.proof"][..], "name its file first"),
        (&["control.obj", "result.obj", "control.obj"], "is no proof"),
        (&["none.obj", "result.obj", "result.proof"], "none.obj"),
        (&["control.obj"], "usage"),
        (
            &["control.obj", "result.obj", "result.proof", "--at", "x"],
            "not a number",
        ),
        (
            &["control.obj", "result.obj", "result.proof", "--at", "0"],
            "too small",
        ),
        (
            &["control.obj", "result.obj", "result.proof", "--at"],
            "lacks its value",
        ),
        (
            &["result.obj", "control.obj", "result.proof"],
            "the order is",
        ),
    ] {
        let (code, said) = run(&folder, words);
        assert!(
            code == Some(2) && said.contains(what),
            "{words:?}: {code:?}, {said}"
        );
    }
    // A control mesh that the proof holds can be looked at, in a file that was not there before.
    let (code, said) = run(&folder, &[&files[..], &["--control", "shown.obj"]].concat());
    assert!(
        code == Some(2) && said.contains("holds no control mesh"),
        "{said}"
    );
    write("held.proof", &holding(&cage.control, &cage.proof(within)));
    let held = ["result.obj", "held.proof", "--control"];
    let (code, said) = run(&folder, &[&held[..], &["result.obj"]].concat());
    assert!(code == Some(2) && said.contains("result.obj: "), "{said}");
    assert_eq!(
        std::fs::read(folder.join("result.obj")).unwrap(),
        obj(&cage.mesh).as_bytes()
    );
    let (code, said) = run(&folder, &[&held[..], &["shown.obj"]].concat());
    assert_eq!(code, Some(0), "{said}");
    let shown = limitmesh_check::read::mesh(
        "shown.obj",
        &std::fs::read(folder.join("shown.obj")).unwrap(),
    );
    assert_eq!(shown.unwrap(), cage.control);
    for (word, what) in [
        ("--help", "usage"),
        ("--version", env!("CARGO_PKG_VERSION")),
    ] {
        let (code, said) = run(&folder, &[word]);
        assert!(code == Some(0) && said.contains(what), "{said}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
