//! The size that a mesh was and is: the distance to the input, area and volume, what is inside out, sharp edges.

use serde_json::{Value, json};

use crate::common::{file, folder, has_keys, run};

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// What is said of the distance to the input, and what the certified measurement of the two files finds.
fn distances(input: &str, options: &str) -> ([f64; 2], [f64; 2]) {
    let folder = folder();
    let output = folder.path().join("out.off");
    let report = run(
        &format!("refine {input} -o {{}} --report - {options}"),
        &[&output],
    )
    .expect(0)
    .json();
    has_keys(
        &report,
        "input_distance.lower_percent size.before.area size.before.volume size.after.area size.after.volume",
    );
    let told = &report["input_distance"];
    let diagonal = number(&report["error"]["diagonal"]);
    for end in ["lower", "upper"] {
        let percent = number(&told[format!("{end}_percent")]);
        assert!((percent - 100.0 * number(&told[end]) / diagonal).abs() < 1e-9);
    }
    let found = run(
        &format!("measure {{}} {input} --certified --gap 0.5% --json"),
        &[&output],
    )
    .expect(0)
    .json();
    let ends = |of: &Value| ["lower", "upper"].map(|end| number(&of[end]));
    (ends(told), ends(&found["hausdorff"]))
}

/// The other witness is the search over both meshes, which knows nothing of where vertices came from.
#[test]
fn the_distance_to_the_input_is_what_measuring_both_finds() {
    let cases = [
        ("builtin:cup", ""),
        ("builtin:head", ""),
        ("builtin:sphere", "--tolerance 1%"),
        ("builtin:cube", "--crease-angle 30"),
        ("builtin:cube", "--scheme butterfly --tolerance 1%"),
        ("builtin:bunny", "--balance"),
        ("builtin:bumpy", "--optimize --tolerance 0.3%"),
        ("builtin:shoe", "--angle 20"),
        ("builtin:sheet", "--triangles 2k"),
    ];
    for (input, options) in cases {
        let ([low, high], [least, most]) = distances(input, options);
        assert!(
            low <= high && low <= most && least <= high,
            "{input} {options}: {low}, {high}; {least}, {most}"
        );
        // Half of it is found: the vertices that are looked at are not just any.
        assert!(
            low >= 0.5 * least,
            "{input} {options}: {low}, {high}; {least}, {most}"
        );
    }
}

#[test]
fn what_has_moved_is_told_and_what_would_keep_it() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    run("refine builtin:cube -o {}", &[&output])
        .expect(0)
        .saying("of the diagonal (")
        .saying("from the input, certified")
        .saying("(--crease-angle 30 would keep 12 edges that look sharp)")
        .saying("area 6 to ")
        .saying("volume 1 to ");
    let kept = run("refine builtin:cube -o {} --crease-angle 30", &[&output])
        .expect(0)
        .saying("volume 1 to 1 (+0.00 %)");
    assert!(
        !kept.stderr.contains("moved by") && !kept.stderr.contains("would keep"),
        "{}",
        kept.stderr
    );
    let square = file(
        &folder,
        "square.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let report = run(
        "refine {} -o {} --boundary fixed --report -",
        &[&square, &output],
    )
    .expect(0)
    .json();
    assert!(number(&report["input_distance"]["upper"]) < 1e-6);
    let silent = run(
        "refine builtin:cube -o {} --no-input-distance --report -",
        &[&output],
    )
    .expect(0);
    assert!(!silent.stderr.contains("moved by"), "{}", silent.stderr);
    assert_eq!(silent.json()["input_distance"], Value::Null);
    assert_eq!(
        report["size"]["after"],
        json!({"area": 1.0, "volume": null})
    );
    // Other methods do not know where vertices came from.
    let stepwise = run(
        "refine builtin:cube -o {} --method uniform --report -",
        &[&output],
    )
    .expect(0)
    .json();
    assert_eq!(stepwise["input_distance"], Value::Null);
    assert!(number(&stepwise["size"]["after"]["volume"]) < 1.0);
    // Where much of the volume is gone, it is said what would keep it, once, whether the way is known or not.
    let hints = |options: &str| {
        let said = run(&format!("refine {options} -o {{}}"), &[&output])
            .expect(0)
            .stderr;
        said.matches("(--interpolate would lead the surface through the vertices)")
            .count()
    };
    for options in [
        "",
        "--no-input-distance",
        "--method uniform --levels 2",
        "--scheme loop-warren --angle 5",
    ] {
        assert_eq!(hints(&format!("builtin:cube {options}")), 1, "{options}");
    }
    for options in [
        "--interpolate",
        "--interpolate-within 1%",
        "--crease-angle 30",
        "--scheme sqrt3 --angle 20",
    ] {
        assert_eq!(hints(&format!("builtin:cube {options}")), 0, "{options}");
    }
    // A sheet has no volume, and a fine mesh keeps its own.
    assert_eq!(hints("builtin:sheet --no-input-distance"), 0);
    assert_eq!(hints("builtin:bumpy --no-input-distance"), 0);
    // What lies in a plane can lose its outline alone.
    let flat = run("refine {} -o {} --interpolate", &[&square, &output]).expect(0);
    let flat = flat
        .saying("moved by")
        .saying("(--boundary fixed would keep the outline)");
    assert!(!flat.stderr.contains("--crease-angle"), "{}", flat.stderr);
    let plain = run("refine {} -o {}", &[&square, &output]).expect(0).stderr;
    assert!(
        plain.contains("--boundary fixed") && !plain.contains("--interpolate would"),
        "{plain}"
    );
    let folded = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 2 2 0\nv 3 2 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 2 1 5\nf 3 2 5\nf 1 3 5\n";
    let folded = file(&folder, "folded.obj", folded);
    let said = run(
        "refine {} -o {} --interpolate --tolerance 2%",
        &[&folded, &output],
    )
    .expect(0)
    .stderr;
    assert!(!said.contains("--crease-angle"), "{said}");
    // With a unit.
    run("refine builtin:cube -o {} --unit mm", &[&output])
        .expect(0)
        .saying(" mm²")
        .saying(" mm³");
}

#[test]
fn area_volume_and_sharp_edges_are_examined() {
    let mesh =
        |input: &str| run(&format!("info {input} --json"), &[]).expect(0).json()["mesh"].clone();
    let cube = mesh("builtin:cube");
    assert_eq!((number(&cube["area"]), number(&cube["volume"])), (6.0, 1.0));
    // The diagonals of the squares, and the edges.
    let mut histogram = [0; 18];
    (histogram[0], histogram[9]) = (6, 12);
    let dihedrals = json!({"histogram": histogram, "suggested_crease_angle_degrees": 30.0, "sharp_edges": 12, "look": "cage"});
    assert_eq!(cube["dihedrals"], dihedrals);
    for smooth in ["sphere", "torus", "bunny", "teddy", "bumpy"] {
        let found = mesh(&format!("builtin:{smooth}"));
        assert_eq!(
            found["dihedrals"]["suggested_crease_angle_degrees"],
            Value::Null,
            "{smooth}: {found}"
        );
        assert_eq!(found["dihedrals"]["look"], "smooth");
    }
    assert_eq!(mesh("builtin:sheet")["volume"], Value::Null);
    let text = run("info builtin:cube", &[]).expect(0).stdout;
    assert!(
        text.contains("area 6, volume 1")
            && text.contains("12 edges look sharp; --crease-angle 30"),
        "{text}"
    );
    assert!(
        run("info builtin:bunny", &[])
            .expect(0)
            .stdout
            .contains("none stand out as sharp")
    );

    let folder = folder();
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
    let input = file(&folder, "turned.obj", tetrahedron);
    let turned = run("info {} --json", &[&input]).expect(0).json();
    assert_eq!(
        turned["diagnosis"]["inside_out_components"]["first"],
        json!([0])
    );
    assert!((number(&turned["mesh"]["volume"]) - 1.0 / 6.0).abs() < 1e-15);
    let line = "1 closed component that is inside out: turned round (face 0)";
    assert!(run("info {}", &[&input]).expect(0).stdout.contains(line));
    run(
        "refine {} -o {} --strict",
        &[&input, &folder.path().join("out.ply")],
    )
    .expect(1)
    .saying("inside out");
}

/// A box with one more vertex near the end of an edge: its limit is elsewhere on that edge, but it is the same box.
#[test]
fn what_slides_along_the_mesh_has_not_moved() {
    let folder = folder();
    let profile = [[0, 0], [5, 0], [60, 0], [60, 40], [0, 40]];
    let mut text: String = [0, 5]
        .iter()
        .flat_map(|z| profile.map(|[x, y]| format!("v {x} {y} {z}\n")))
        .collect();
    (1..=5).for_each(|i| text += &format!("f {i} {} {} {}\n", i % 5 + 1, i % 5 + 6, i + 5));
    text += "f 5 4 3 2 1\nf 6 7 8 9 10\n";
    let (input, output) = (
        file(&folder, "box.obj", &text),
        folder.path().join("out.ply"),
    );
    for interpolate in ["", "--interpolate"] {
        let words = format!("refine {{}} -o {{}} --crease-angle 30 --report - {interpolate}");
        let report = run(&words, &[&input, &output]).expect(0).json();
        assert!(
            report["input_distance"]["upper"]
                .as_f64()
                .expect("a number")
                < 1e-3,
            "{report}"
        );
        let measured = run("measure {} {} --certified --json", &[&output, &input])
            .expect(0)
            .json();
        assert!(measured["hausdorff"]["upper"].as_f64().expect("a number") < 1e-6);
    }
}
