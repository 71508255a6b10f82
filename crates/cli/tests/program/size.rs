//! The size that a mesh was and is: the distance to the input, area and volume, what is inside out, sharp edges.

use serde_json::{Value, json};

use crate::common::{done, file, folder, json_of, number};

/// The reported distance to the input, and the certified measurement of the two files.
fn distances(input: &str, options: &str) -> ([f64; 2], [f64; 2]) {
    let folder = folder();
    let output = folder.path().join("out.off");
    let line = format!("refine {input} -o {{}} --report - {options}");
    let report = json_of(&line, &[&output]);
    let told = &report["input_distance"];
    let diagonal = number(&report["error"]["diagonal"]);
    for end in ["lower", "upper"] {
        let percent = number(&told[format!("{end}_percent")]);
        assert!((percent - 100.0 * number(&told[end]) / diagonal).abs() < 1e-9);
    }
    let line = format!("measure {{}} {input} --certified --gap 0.5% --json");
    let found = json_of(&line, &[&output]);
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
        at_most!(low, high, "{input} {options}");
        at_most!(low, most, "{input} {options}");
        at_most!(least, high, "{input} {options}");
        // Half of it is found: the vertices that are looked at are not just any.
        at_least!(low, 0.5 * least, "{input} {options}, {high}, {most}");
    }
}

#[test]
fn what_has_moved_is_told_and_what_would_keep_it() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    done("refine builtin:cube -o {}", &[&output])
        .saying("of the diagonal (")
        .saying("from the input, certified")
        .saying("(--crease-angle 30 would keep 12 edges that look sharp)")
        .saying("area 6 to ")
        .saying("volume 1 to ");
    let kept = done("refine builtin:cube -o {} --crease-angle 30", &[&output])
        .saying("volume 1 to 1 (+0.00 %)");
    silent!(kept.stderr, "moved by");
    silent!(kept.stderr, "would keep");
    let square = file(
        &folder,
        "square.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let report = json_of(
        "refine {} -o {} --boundary fixed --report -",
        &[&square, &output],
    );
    assert!(number(&report["input_distance"]["upper"]) < 1e-6);
    assert_eq!(
        report["size"]["after"],
        json!({"area": 1.0, "volume": null})
    );
    // Other methods do not know where vertices came from.
    let stepwise = json_of(
        "refine builtin:cube -o {} --method uniform --report -",
        &[&output],
    );
    assert_eq!(stepwise["input_distance"], Value::Null);
    assert!(number(&stepwise["size"]["after"]["volume"]) < 1.0);
    // Where much of the volume is gone, it is said what would keep it, once, whether the way is known or not.
    let hints = |options: &str| {
        let said = done(&format!("refine {options} -o {{}}"), &[&output]).stderr;
        said.matches("(--interpolate would lead the surface through the vertices)")
            .count()
    };
    for options in [
        "",
        "--method uniform --levels 2",
        "--scheme loop-warren --angle 5",
    ] {
        assert_eq!(hints(&format!("builtin:cube {options}")), 1, "{options}");
    }
    for options in [
        "--interpolate",
        "--interpolate=1%",
        "--crease-angle 30",
        "--scheme sqrt3 --angle 20",
    ] {
        assert_eq!(hints(&format!("builtin:cube {options}")), 0, "{options}");
    }
    // What lies in a plane can lose its outline alone.
    let flat = done("refine {} -o {} --interpolate", &[&square, &output]);
    let flat = flat
        .saying("moved by")
        .saying("(--boundary fixed would keep the outline)");
    assert!(!flat.stderr.contains("--crease-angle"), "{}", flat.stderr);
    let plain = done("refine {} -o {}", &[&square, &output]).stderr;
    says!(plain, "--boundary fixed");
    silent!(plain, "--interpolate would");
    let folded = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 2 2 0\nv 3 2 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 2 1 5\nf 3 2 5\nf 1 3 5\n";
    let folded = file(&folder, "folded.obj", folded);
    let said = done(
        "refine {} -o {} --interpolate --tolerance 2%",
        &[&folded, &output],
    )
    .stderr;
    assert!(!said.contains("--crease-angle"), "{said}");
    // With a unit.
    done("refine builtin:cube -o {} --unit mm", &[&output])
        .saying(" mm²")
        .saying(" mm³");
}
