//! `info` and `models`: what is in a file, in words and as JSON.

use crate::common::{done, file, folder, json_of, list, run, words};

#[test]
fn every_listed_model_can_be_examined() {
    let report = json_of("models --json", &[]);
    let list = list(&report);
    assert!(list.len() >= 8, "{list:?}");
    let text = done("models", &[]).stdout;
    for model in list {
        let name = words(&model["name"]);
        assert!(text.contains(&format!("builtin:{name}")), "{text}");
        let report = json_of(&format!("info builtin:{name} --json"), &[]);
        assert_eq!(report["diagnosis"]["clean"], true, "{name}");
        assert_eq!(report["input"]["format"], "builtin");
    }
}

#[test]
fn known_shapes_have_their_topology() {
    // Components, genus, Euler characteristic, boundary loops.
    for (name, expected) in [
        ("torus", [1, 1, 0, 0]),
        ("cup", [1, 1, 0, 0]),
        ("sphere", [1, 0, 2, 0]),
        ("sheet", [1, 0, 1, 1]),
    ] {
        let mesh = json_of(&format!("info builtin:{name} --json"), &[])["mesh"].clone();
        let found = [
            "components",
            "genus",
            "euler_characteristic",
            "boundary_loops",
        ]
        .map(|key| mesh[key].as_i64().expect("a number"));
        assert_eq!(found, expected, "{name}");
    }
    let text = done("info builtin:cube", &[]).stdout;
    for words in [
        "6 with 4 corners",
        "cut into triangles",
        "8 vertices, 18 edges, 12 triangles",
        "watertight",
    ] {
        assert!(text.contains(words), "{words} in:\n{text}");
    }
}

#[test]
fn findings_are_named_in_words() {
    let folder = folder();
    let bad = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 5 5 5\nf 1 2 3\nf 2 3 4\nf 1 1 2\nf 3 1 2\n";
    let input = file(&folder, "bad.obj", bad);
    let text = done("info {}", &[&input]).stdout;
    for words in [
        "1 face with fewer than three different corners: left out (face 2)",
        "1 face that repeats another: left out (face 3)",
        "1 vertex in no face: left out (vertex 4)",
        "turned round",
    ] {
        assert!(text.contains(words), "{words} in:\n{text}");
    }
}

#[test]
fn a_file_without_faces_is_an_error() {
    let folder = folder();
    let input = file(&folder, "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for command in ["info {}", "measure {} builtin:cube", "compare {}"] {
        run(command, &[&input]).expect(1).saying("points.obj");
    }
}
