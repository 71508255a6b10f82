//! `refine --shared-topology`: the frames of an animation with the same triangles.

use std::path::{Path, PathBuf};

use limitmesh::refine::{LimitDistanceOptions, limit_distance};
use limitmesh::scheme::{CatmullClark, Loop, Scheme};
use limitmesh::{Mesh, QuadControl};
use tempfile::TempDir;

use crate::common::{
    bytes, count, done, file, folder, json_file, list, number, run, text, usage_error,
};

/// A box of four sharp edges and texture coordinates, sheared by so much.
fn frame(shear: f64, faces: &str, tags: &str) -> String {
    let corners = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 0, 1],
        [1, 1, 1],
        [0, 1, 1],
    ];
    let vertex =
        |&[x, y, z]: &[i32; 3]| format!("v {} {y} {z}\n", f64::from(x) + shear * f64::from(z));
    let vertices: String = corners.iter().map(vertex).collect();
    format!("{vertices}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n{faces}{tags}")
}

const FACES: &str = "f 4/4 3/3 2/2 1/1\nf 5/1 6/2 7/3 8/4\nf 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n";
const TAGS: &str =
    "t crease 2/1/0 0 1 10\nt crease 2/1/0 1 2 10\nt crease 2/1/0 2 3 10\nt crease 2/1/0 3 0 2.5\n";

fn frames(folder: &TempDir, faces: &str) -> Vec<PathBuf> {
    let frame = |i: usize| {
        file(
            folder,
            &format!("box_{i}.obj"),
            &frame(0.4 * i as f64, faces, TAGS),
        )
    };
    (0..3).map(frame).collect()
}

/// The lines of a file that begin with a word; of faces without the numbers of normals, which are those of the frame.
fn lines(path: &Path, word: &str) -> Vec<String> {
    let text = text(path);
    let own = text
        .lines()
        .filter(|line| line.split_whitespace().next() == Some(word));
    let corner = |corner: &str| {
        corner
            .rsplit_once('/')
            .map_or(corner, |(rest, _)| rest)
            .to_owned()
    };
    let plain = |line: &str| match word {
        "f" => line
            .split_whitespace()
            .map(corner)
            .collect::<Vec<_>>()
            .join(" "),
        _ => line.to_owned(),
    };
    own.map(plain).collect()
}

fn mesh(path: &Path) -> Mesh {
    Mesh::from_soup(
        &limitmesh_io::read(path).expect("a mesh"),
        &Default::default(),
    )
    .expect("a mesh")
    .0
}

/// The control mesh of a frame's file, as quads if it has more of these than of others.
fn quads(path: &Path) -> Mesh {
    let soup = limitmesh_io::read(path).expect("a mesh");
    let (control, _) = QuadControl::from_soup(&soup, &Default::default()).expect("quads");
    control.mesh
}

#[test]
fn frames_have_the_same_triangles_and_proofs_of_their_own() {
    let folder = folder();
    let inputs = frames(&folder, FACES);
    // Its quads are cut into triangles as those of the first frame are.
    let control = |input: &Path| {
        let positions = mesh(input).positions().to_vec();
        mesh(&inputs[0])
            .with_positions(positions)
            .expect("the same vertices")
    };
    check(&inputs, "--scheme loop", &Loop, control);
    check(&inputs, "", &CatmullClark, quads);
    // With two triangles, so that a step divides all faces first.
    let mixed = FACES.replace("f 5/1 6/2 7/3 8/4", "f 5/1 6/2 7/3\nf 5/1 7/3 8/4");
    check(&frames(&folder, &mixed), "", &CatmullClark, quads);
}

fn check(inputs: &[PathBuf], options: &str, scheme: &dyn Scheme, control: impl Fn(&Path) -> Mesh) {
    let (folder, out) = (folder(), crate::common::folder());
    let report = folder.path().join("report.json");
    let command = format!(
        "refine {{}} {{}} {{}} -o {{}} --shared-topology --tolerance 0.02 --report {{}} {options}"
    );
    let mut paths: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    paths.extend([out.path(), report.as_path()]);
    let done = done(command.trim(), &paths);
    says!(done.stderr, "3 frames");
    says!(done.stderr, "every frame");
    let report = json_file(&report);
    assert_eq!(report["stop"], "met");
    let proven = list(&report["frames"]);
    assert_eq!(proven.len(), 3);
    let outputs: Vec<PathBuf> = (0..3)
        .map(|i| out.path().join(format!("box_{i}.obj")))
        .collect();
    for ((input, output), proven) in inputs.iter().zip(&outputs).zip(proven) {
        assert_eq!(proven["output"], output.display().to_string());
        let upper = number(&proven["error"]["upper"]);
        assert!(proven["error"]["certified"] == true);
        at_most!(upper, 0.02);
        for word in ["f", "t", "vt"] {
            let own = lines(output, word);
            assert!(!own.is_empty() && own == lines(&outputs[0], word), "{word}");
        }
        assert_eq!(lines(output, "f").len() as u64, count(&report["triangles"]));
        // Another search finds no more than is proven, between the file that was written and the limit surface of its input.
        let options = LimitDistanceOptions::default().gap(Some(2e-3));
        let written = mesh(output);
        let found = limit_distance(written.as_triangles(), &control(input), scheme, &options)
            .expect("a distance");
        assert!(found.distance.lower() <= upper && found.distance.upper() <= 0.02 + 2e-3);
        assert!(found.distance.lower() > 1e-3, "refined far too much");
    }
    let vertices: Vec<_> = outputs.iter().map(|output| lines(output, "v")).collect();
    assert!(vertices[0] != vertices[1] && vertices[0].len() == vertices[1].len());
}

#[test]
fn frames_of_other_meshes_are_refused_by_what_differs() {
    let (folder, out) = (folder(), crate::common::folder());
    let inputs = frames(&folder, FACES);
    let first = &inputs[0];
    let other_faces = FACES.replace("f 4/4 3/3 2/2 1/1", "f 3/3 2/2 1/1 4/4");
    let fewer = FACES
        .lines()
        .skip(1)
        .map(|line| format!("{line}\n"))
        .collect::<String>();
    let cases = [
        ("turned.obj", frame(0.1, &other_faces, TAGS), "face 0 is"),
        ("open.obj", frame(0.1, &fewer, TAGS), "5 faces, where"),
        (
            "soft.obj",
            frame(0.1, FACES, &TAGS.replace("2.5", "3.5")),
            "a crease of sharpness 3.5",
        ),
        ("plain.obj", frame(0.1, FACES, ""), "0 crease tags, where"),
    ];
    for (name, content, what) in cases {
        let other = file(&folder, name, &content);
        let refused = run(
            "refine {} {} -o {} --shared-topology",
            &[first, &other, out.path()],
        )
        .expect(1);
        says!(refused.stderr, name);
        says!(refused.stderr, what);
    }
    assert!(crate::common::names(out.path()).is_empty());
    for option in [
        "--triangles 500",
        "--balance",
        "--optimize",
        "--method uniform",
        "--interpolate",
        "--mesh box",
        "--material red",
        "--link-resources",
        "--weld-ignores skin",
        "--morph-tolerance 1%",
        "--scheme sqrt3",
    ] {
        let command = format!("refine {{}} {{}} -o {{}} --shared-topology {option}");
        run(&command, &[first, &inputs[1], out.path()]).expect(2);
    }
    // Before anything is read: there is no such file.
    let none = folder.path().join("none.obj");
    let command = "refine {} {} -o {} --shared-topology --scheme sqrt3";
    usage_error(command, &[first, &none, out.path()], "sqrt3");
    let command = "refine {} {} -o {} --shared-topology --report {}";
    let before = bytes(first);
    usage_error(
        command,
        &[first, &inputs[1], out.path(), first],
        "box_0.obj is an input",
    );
    assert_eq!(bytes(first), before);
    let own = out.path().join("box_1.obj");
    usage_error(
        command,
        &[first, &inputs[1], out.path(), &own],
        "would be written twice",
    );
    assert!(crate::common::names(out.path()).is_empty());
}
