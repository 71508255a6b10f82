//! `measure`: distances with known answers, limit surfaces, the JSON contract.

use std::path::Path;

use serde_json::Value;

use crate::common::{
    bytes, done, file, folder, is_png, json_file, json_of, number, refuses, run, usage_error,
};

fn measure(arguments: &str, paths: &[&Path]) -> Value {
    json_of(&format!("measure {arguments} --json"), paths)
}

fn near(value: &Value, expected: f64) {
    assert!(
        (number(value) - expected).abs() <= 1e-12,
        "{value} {expected}"
    );
}

#[test]
fn parallel_squares_are_as_far_apart_as_they_stand() {
    let folder = folder();
    let low = file(
        &folder,
        "low.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let high = file(
        &folder,
        "high.obj",
        "v 0 0 .25\nv 2 0 .25\nv 2 1 .25\nv 0 1 .25\nf 1 2 3 4\n",
    );
    let report = measure("{} {} --samples 5000", &[&low, &high]);
    let h = &report["hausdorff"];
    near(&h["forward"], 0.25);
    near(&h["forward_detail"]["mean"], 0.25);
    near(&h["forward_detail"]["rms"], 0.25);
    // From the far end of the longer square, which is sampled because it is a vertex.
    let far = (1.0f64 + 0.0625).sqrt();
    near(&h["backward"], far);
    near(&h["symmetric"], far);
    near(&h["symmetric_percent"], 100.0 * far / 5f64.sqrt());
    near(&h["diagonal"], 5f64.sqrt());
    near(&h["backward_detail"]["at"][0], 2.0);
    near(&h["backward_detail"]["to"][0], 1.0);
    assert_eq!(h["kind"], "sampled lower bound");
    let samples =
        number(&h["forward_detail"]["samples"]) + number(&h["backward_detail"]["samples"]);
    assert_eq!(number(&h["samples"]), samples);
    assert!(samples >= 8000.0, "{samples}");
}

#[test]
fn refinement_with_limit_vertices_approaches_the_limit_surface() {
    let folder = folder();
    let refined = folder.path().join("refined.ply");
    let mut last = f64::INFINITY;
    for levels in 0..4 {
        let options = format!("--method uniform --limit --levels {levels}");
        let line = format!("refine builtin:torus -o {{}} {options}");
        done(&line, &[&refined]);
        let report = measure("{} --limit-of builtin:torus", &[&refined]);
        let percent = number(&report["hausdorff"]["symmetric_percent"]);
        // The error of a regular mesh falls to a quarter with each level; the reference is finite itself.
        below!(percent, 0.3 * last, "level {levels}");
        assert_eq!(report["reference"]["limit"]["levels"], 5);
        assert_eq!(report["reference"]["limit"]["chosen"], true);
        assert_eq!(report["reference"]["triangles"], 256 * 1024);
        last = percent;
    }
    let same = measure(
        "{} --limit-of builtin:torus --reference-levels 3",
        &[&refined],
    );
    assert!(number(&same["hausdorff"]["symmetric_percent"]) < 1e-10);
    assert_eq!(same["reference"]["limit"]["chosen"], false);
}

#[test]
fn heat_maps_are_meshes_or_pictures() {
    let folder = folder();
    let low = file(
        &folder,
        "low.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let tilted = file(
        &folder,
        "tilted.obj",
        "v 0 0 0\nv 1 0 1\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\n",
    );
    let (mesh, picture) = (
        folder.path().join("heat.ply"),
        folder.path().join("heat.png"),
    );
    done("measure {} {} --heatmap {}", &[&tilted, &low, &mesh]);
    let written = crate::common::soup(&mesh);
    assert_eq!(written.positions.len(), 4);
    let bytes = bytes(&mesh);
    let header = String::from_utf8_lossy(&bytes[..bytes.len().min(1000)]);
    says!(header, "quality");
    says!(header, "uchar red");
    done("measure {} {} --heatmap {}", &[&tilted, &low, &picture]);
    is_png(&picture);
    usage_error("measure {} {} --heatmap {}", &[&tilted, &low, &low], ".png");
}

fn certified(arguments: &str, paths: &[&Path], code: i32) -> Value {
    let report = run(&format!("measure {arguments} --certified --json"), paths)
        .expect(code)
        .json();
    report["hausdorff"].clone()
}

#[test]
fn a_certified_interval_that_is_cut_short_is_given_with_code_3() {
    let arguments = "builtin:head builtin:shoe --gap 0 --max-work 1";
    let short = certified(arguments, &[], 3);
    assert_eq!(short["converged"], false);
    let whole = certified("builtin:head builtin:shoe", &[], 0);
    assert!(number(&short["lower"]) <= number(&whole["upper"]));
    assert!(number(&whole["lower"]) <= number(&short["upper"]));
    assert!(number(&short["upper"]) > number(&short["lower"]));
    run(&format!("measure {arguments} --certified"), &[])
        .expect(3)
        .saying("--max-work");
}

#[test]
fn what_belongs_to_certified_distances_and_what_does_not() {
    let two = "measure builtin:cup builtin:torus";
    usage_error(&format!("{two} --gap 1%"), &[], "--certified");
    usage_error(&format!("{two} --max-work 5"), &[], "--certified");
    usage_error(&format!("{two} --certified --gap -1"), &[], "at least 0");
    usage_error(&format!("{two} --certified --samples 9"), &[], "--samples");
    usage_error(
        "measure builtin:cup --limit-of builtin:cup --certified --reference-levels 3",
        &[],
        "sampled",
    );
}

#[test]
fn a_certified_interval_holds_the_distance_to_the_true_limit_surface() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let refined = json_of(
        "refine builtin:cup -o {} --tolerance 0.5% --report -",
        &[&output],
    );
    let (lower, upper) = (
        number(&refined["error"]["lower"]),
        number(&refined["error"]["upper"]),
    );
    for options in ["", "--gap 0.05%"] {
        let words = format!("measure {{}} --limit-of builtin:cup --certified --json {options}");
        let report = json_of(&words, &[&output]);
        let h = &report["hausdorff"];
        let (low, high) = (number(&h["lower"]), number(&h["upper"]));
        // Two intervals for one distance overlap.
        at_most!(low, upper);
        at_most!(lower, high);
        let wide = if options.is_empty() {
            0.1 * low
        } else {
            0.0005 * number(&refined["error"]["diagonal"])
        };
        assert!(high - low <= wide * (1.0 + 1e-9), "{low} {high}");
        let limit = &report["reference"]["limit"];
        assert!(number(&limit["error"]) > 0.0 && number(&limit["error"]) <= 0.5 * wide);
        assert_eq!(h["converged"], true);
    }
    let text = done("measure {} --limit-of builtin:cup --certified", &[&output]).stdout;
    says!(text, "limit surface of builtin:cup");
    says!(text, "certainly within");
    let cut = "measure {} --limit-of builtin:cup --certified --gap 0.01% --max-work 1";
    assert!(run(cut, &[&output]).expect(3).stdout.contains("at most"));
    refuses(
        &[("output", &output)],
        "
        2 | measure {output} --limit-of builtin:cup --certified --reference-levels 3 |
        2 | measure {output} --limit-of builtin:cup --certified --scheme butterfly |",
    );
}

/// The bounds of `refine` and the distances of `measure` are per cent of one diagonal, the control mesh's; its limit surface is
/// smaller, and so is the box of the refined mesh.
#[test]
fn refine_and_measure_speak_of_one_diagonal() {
    let folder = folder();
    let (mesh, report) = (
        folder.path().join("cup.ply"),
        folder.path().join("cup.json"),
    );
    done(
        "refine builtin:cup -o {} --tolerance 0.2% --report {}",
        &[&mesh, &report],
    );
    let refined = json_file(&report);
    let error = &refined["error"];
    let info = json_of("info builtin:cup --json", &[]);
    let diagonal = number(&info["mesh"]["bounding_box"]["diagonal"]);
    assert_eq!(number(&error["diagonal"]), diagonal);

    let sampled = measure("{} --limit-of builtin:cup", &[&mesh]);
    let certified = json_of(
        "measure {} --limit-of builtin:cup --certified --json",
        &[&mesh],
    );
    let (sampled, certified) = (&sampled["hausdorff"], &certified["hausdorff"]);
    for found in [sampled, certified] {
        assert_eq!(number(&found["diagonal"]), diagonal);
        assert_eq!(found["diagonal_of"], "control mesh");
    }
    // Per cent by per cent: what was proven holds what is found, and the other way round. The mesh that approximates the limit
    // surface is off by less than a tenth of that.
    let percent = |value: &Value, name: &str| number(&value[name]);
    assert!(percent(sampled, "symmetric_percent") <= 1.1 * percent(error, "upper_percent"));
    assert!(percent(sampled, "symmetric_percent") >= 0.9 * percent(error, "lower_percent"));
    assert!(percent(certified, "lower_percent") <= percent(error, "upper_percent"));
    assert!(percent(certified, "upper_percent") >= percent(error, "lower_percent"));
    near(
        &certified["upper_percent"],
        100.0 * percent(certified, "upper") / diagonal,
    );

    // Two meshes: the second one's.
    let between = measure("{} builtin:cup", &[&mesh]);
    assert_eq!(between["hausdorff"]["diagonal_of"], "second mesh");
    assert_eq!(number(&between["hausdorff"]["diagonal"]), diagonal);
    let back = measure("builtin:cup {}", &[&mesh]);
    assert!(number(&back["hausdorff"]["diagonal"]) < diagonal);
}
