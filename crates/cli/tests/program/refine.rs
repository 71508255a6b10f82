//! `refine`: the mesh written, the report about it, the caps, the options' effects.

use std::path::Path;

use serde_json::Value;

use crate::common::{
    bytes, claimed, count, counts, done, file, folder, json_file, json_of, list, run, soup, text,
};

/// The keys that users of the report may rely on.
/// Refines and gives the report, after checking that it fits the file.
fn refine(input: &str, output: &Path, options: &str) -> Value {
    let line = format!("refine {input} -o {{}} --report - {options}");
    let run = done(&line, &[output]);
    let report = run.json();
    assert_eq!(
        claimed(&report["output"]),
        counts(&soup(output)),
        "{input} {options}"
    );
    check_steps(&report);
    report
}

/// Each step starts where the one before ended, and its faces add up: divisible ones and those of Figure 5's
/// case (d) give four, cases (a) to (c) one to three.
fn check_steps(report: &Value) {
    let number = |value: &Value| count(value);
    let steps = list(&report["steps"]);
    for (i, step) in steps.iter().enumerate() {
        assert_eq!(number(&step["step"]), i as u64 + 1);
        let [a, b, c, d] = [0, 1, 2, 3].map(|case| number(&step["closure"][case]));
        let divisible = number(&step["divisible"]);
        assert_eq!(number(&step["faces_before"]), divisible + a + b + c + d);
        assert_eq!(
            number(&step["faces_after"]),
            4 * (divisible + d) + 3 * c + 2 * b + a
        );
        if i > 0 {
            assert_eq!(step["faces_before"], steps[i - 1]["faces_after"]);
        }
    }
    if let Some(last) = steps.last() {
        assert_eq!(last["faces_after"], report["output"]["triangles"]);
    }
}

#[test]
fn every_built_in_model_is_refined_by_every_method() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for model in limitmesh_models::all() {
        let name = format!("builtin:{}", model.name);
        let methods = [
            "--faces triangles",
            "--method limit-normal --levels 2",
            "--method amresh --levels 2",
            "--method uniform --levels 1 --faces triangles",
        ];
        for options in methods {
            let report = refine(&name, &output, options);
            let info = json_of(&format!("info {name} --json"), &[]);
            assert_eq!(
                report["output"]["euler_characteristic"],
                info["mesh"]["euler_characteristic"]
            );
            assert_eq!(
                report["output"]["watertight"], info["mesh"]["watertight"],
                "{name} {options}"
            );
            assert_eq!(report["output"]["t_junctions"], 0, "{name} {options}");
            assert_eq!(
                report["output"]["non_manifold_edges"], 0,
                "{name} {options}"
            );
        }
    }
}

#[test]
fn defaults_of_the_paper_s_method_are_ten_degrees_three_levels_loop() {
    let folder = folder();
    let parameters = refine(
        "builtin:shoe",
        &folder.path().join("out.ply"),
        "--method limit-normal",
    )["parameters"]
        .clone();
    let expected = serde_json::json!({
        "method": "limit-normal", "angle_degrees": 10.0, "levels": 3, "scheme": "loop",
        "exact": null, "view": null, "limit": false, "boundary": "smooth", "crease_angle_degrees": null, "crease_angle_auto": false, "interpolate_within": null, "within": null,
        "creases_from": "none", "concave_corners": "smooth",
        "max_triangles": 50_000_000, "smooth_triangles": false, "weld": 0.0, "strict": false
    });
    assert_eq!(parameters, expected);
}

#[test]
fn the_cap_stops_before_the_step_that_would_pass_it() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let report_path = folder.path().join("report.json");
    let run = run(
        "refine builtin:head -o {} --method uniform --levels 5 --max-triangles 3000 --report {} --quiet",
        &[&output, &report_path],
    );
    let run = run
        .expect(3)
        .saying("9,088 triangles")
        .saying("--max-triangles 3,000");
    assert_eq!(run.stdout, "");
    let report = json_file(&report_path);
    assert_eq!(report["stop"], "triangle-cap");
    assert_eq!(report["needed_triangles"], 9088);
    assert_eq!(report["steps"].as_array().map(Vec::len), Some(2));
    let written = counts(&soup(&output));
    assert_eq!(written, claimed(&report["output"]));
    assert_eq!(written.triangles, 2272);
}

#[test]
fn results_are_the_same_bytes_for_any_number_of_threads() {
    let folder = folder();
    let bytes = |threads: usize, options: &str| {
        let output = folder.path().join(format!("out{threads}.ply"));
        let line = format!("refine builtin:shoe -o {{}} --threads {threads} {options}");
        done(&line, &[&output]);
        bytes(&output)
    };
    // Large enough that the loops do run in parallel.
    let methods = [
        "--tolerance 0.03%",
        "--triangles 20000",
        "--method limit-normal --angle 3 --levels 4",
        "--method uniform --levels 3 --limit",
        "--method limit-normal --scheme butterfly",
    ];
    for options in methods {
        let one = bytes(1, options);
        assert!(one.len() > 100_000, "{options}");
        assert!(one == bytes(2, options), "{options}");
        assert!(one == bytes(5, options), "{options}");
    }
}

#[test]
fn repairs_are_told_and_strict_refuses_them() {
    let folder = folder();
    // Three triangles on one edge, and a vertex that no face uses.
    let fan =
        "v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 1 0\nv -1 -1 0\nv 9 9 9\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";
    let input = file(&folder, "fan.obj", fan);
    let output = folder.path().join("out.ply");
    let report = done("refine {} -o {} --report -", &[&input, &output])
        .saying("1 edge with more than two faces")
        .saying("1 vertex in no face: left out (vertex 5)")
        .json();
    assert_eq!(report["diagnosis"]["clean"], false);
    assert_eq!(report["diagnosis"]["non_manifold_edges"]["count"], 1);
    assert_eq!(claimed(&report["output"]), counts(&soup(&output)));
    std::fs::remove_file(&output).expect("removable");
    run("refine {} -o {} --strict", &[&input, &output])
        .expect(1)
        .saying("strict");
    assert!(!output.exists());
}

#[test]
fn tags_are_kept_or_the_loss_is_told() {
    let folder = folder();
    let input = folder.path().join("tagged.obj");
    let content = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n\
        t crease 2/1/0 0 1 10\nt corner 1/1/0 3 10\n";
    std::fs::write(&input, content).expect("a file");
    for name in ["out.obj", "out.ply"] {
        let output = folder.path().join(name);
        let run = done(
            "refine {} -o {} --method limit-normal --levels 2",
            &[&input, &output],
        );
        let kept = name.ends_with("obj");
        let told = run
            .stderr
            .contains("1 crease tag and 1 corner tag: followed, but left out of the output");
        assert_eq!(told, !kept, "{}", run.stderr);
        let soup = soup(&output);
        assert_eq!(
            (soup.creases.len(), soup.corners.len()),
            if kept { (4, 1) } else { (0, 0) }
        );
    }
}

/// A tetrahedron whose faces name their own vertices, one of them a rounding away from the others at its place.
const NEARLY_CLOSED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1.0000001 0 0\n\
    f 1 3 2\nf 1 2 4\nf 5 3 4\nf 3 1 4\n";

#[test]
fn edges_that_nearly_equal_positions_keep_open_are_told() {
    let folder = folder();
    let input = file(&folder, "nearly.obj", NEARLY_CLOSED);
    let output = folder.path().join("out.ply");
    let first = done("refine {} -o {} --tolerance 1%", &[&input, &output]);
    let told = first
        .stderr
        .split("--weld ")
        .nth(1)
        .and_then(|rest| rest.split(',').next());
    let distance = told
        .unwrap_or_else(|| panic!("no distance in {}", first.stderr))
        .to_owned();
    let line = format!("refine {{}} -o {{}} --tolerance 1% --weld {distance}");
    let second = done(&line, &[&input, &output]);
    silent!(second.stderr, "--weld");
    says!(second.stderr, ", closed (");
    assert_eq!(counts(&self::soup(&output)).boundary_edges, 0);
    // The same option lets the result be measured against its own control mesh.
    let line = format!("measure {{}} --limit-of {{}} --weld {distance} --samples 1000");
    done(&line, &[&output, &input]);
}

#[test]
fn the_input_is_not_replaced_by_a_report_or_picture() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for (name, option) in [("in.obj", "--report"), ("in.png", "--picture")] {
        let input = file(&folder, name, NEARLY_CLOSED);
        let line = format!("refine {{}} -o {{}} {option} {{}}");
        let run = run(&line, &[&input, &output, &input]).expect(2);
        assert!(run.stderr.contains("is an input"), "{}", run.stderr);
        assert_eq!(text(&input), NEARLY_CLOSED);
    }
}

#[test]
fn what_is_left_out_is_told() {
    let folder = folder();
    let content = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1\n";
    let (input, output) = (
        file(&folder, "in.obj", content),
        folder.path().join("out.obj"),
    );
    let told = done("refine {} -o {}", &[&input, &output]).stderr;
    assert!(!told.contains("left out"), "{told}");
    let text = text(&output);
    says!(text, "vt 0 0\n");
    says!(text, "usemtl red\n");
    let carried = "carries: texture coordinates (2 numbers a corner); materials (by face)";
    assert!(done("info {}", &[&input]).stdout.contains(carried));
    let report = json_of("info {} --json", &[&input]);
    assert_eq!(report["input"]["left_out"], serde_json::json!([]));
    assert_eq!(
        report["input"]["channels"][0]["name"],
        "texture coordinates"
    );
    let stl = folder.path().join("out.stl");
    let words =
        "left out: texture coordinates; materials (the output's format has no place for them)";
    done("refine {} -o {}", &[&input, &stl]).saying(words);
    for options in [
        "--optimize",
        "--method uniform --levels 1",
        "--method limit-normal",
    ] {
        let line = format!("refine {{}} -o {{}} {options}");
        let told = done(&line, &[&input, &output]).stderr;
        assert!(!told.contains("left out"), "{options}: {told}");
    }
}
