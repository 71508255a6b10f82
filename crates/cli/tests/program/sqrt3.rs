//! `refine --scheme sqrt3`: uniform steps, what they write, and what does not go with them.

use crate::common::{count, counts, done, folder, number, run, soup};

#[test]
fn steps_triple_the_triangles() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let mut faces = None;
    for (levels, limit) in [(0, ""), (1, "--limit"), (3, ""), (4, "--limit")] {
        let options =
            format!("--scheme sqrt3 --method uniform --levels {levels} {limit} --report -");
        let line = format!("refine builtin:torus -o {{}} {options}");
        let run = done(&line, &[&output]);
        let report = run.json();
        let triangles = count(&report["output"]["triangles"]);
        assert_eq!(
            triangles,
            *faces.get_or_insert(triangles) * 3u64.pow(levels)
        );
        assert_eq!(report["parameters"]["scheme"], "sqrt3");
        assert_eq!(report["output"]["watertight"], true);
        assert_eq!(counts(&soup(&output)).triangles, triangles);
    }
}

#[test]
fn what_does_not_go_with_it_is_told_by_both_names() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for (options, word) in [
        ("--method uniform --interpolate", "--interpolate"),
        ("--interpolate=0.1", "--interpolate"),
        ("--method amresh", "--method amresh"),
        ("--method limit-normal", "--method limit-normal"),
        ("--method planarity", "--method planarity"),
        ("--method vertex-error --angle 5", "--method vertex-error"),
        (
            "--method uniform --tolerance 1%",
            "--tolerance is for exact refinement",
        ),
        ("--limit", "--limit has no effect"),
        (
            "--shared-topology",
            "--scheme sqrt3 does not go with --shared-topology",
        ),
        ("--method uniform --angle 5", "--angle"),
        ("--method uniform --optimize", "--optimize"),
        ("--optimize", "--optimize"),
        ("--pixels 1", "--pixels"),
        ("--view 0,0,1 --angle 5", "--view"),
        ("--levels 0", "goals need 1"),
    ] {
        let line = format!("refine builtin:cup -o {{}} --scheme sqrt3 {options}");
        let run = run(&line, &[&output]).expect(2);
        assert!(run.stderr.contains(word), "{options}: {}", run.stderr);
    }
}

/// Adaptive refinement is closed, ends at what was asked, and calls its distance an estimate.
#[test]
fn goals_are_reached_without_cracks() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for options in [
        "--angle 20",
        "--triangles 900",
        "--tolerance 0.5%",
        "--angle 30 --provenance",
    ] {
        let asked = format!("refine builtin:torus -o {{}} --scheme sqrt3 --report - {options}");
        let done = done(&asked, &[&output]);
        let report = done.json();
        assert_eq!(report["output"]["watertight"], true, "{options}");
        assert_eq!(report["output"]["t_junctions"], 0, "{options}");
        assert_eq!(
            counts(&soup(&output)).triangles,
            count(&report["output"]["triangles"])
        );
        if options.starts_with("--triangles") {
            assert!(count(&report["output"]["triangles"]) <= 900);
        }
        if options.starts_with("--tolerance") {
            assert_eq!(report["error"]["certified"], false);
            assert!(number(&report["error"]["upper_percent"]) <= 0.5);
            assert!(done.stderr.contains("not certified"), "{}", done.stderr);
        }
    }
    let short = run(
        "refine builtin:torus -o {} --scheme sqrt3 --angle 2 --max-triangles 700",
        &[&output],
    );
    assert!(short.expect(3).stderr.contains("--max-triangles"));
}

#[test]
fn tags_that_fade_are_an_error_with_their_name() {
    let folder = folder();
    let input = folder.path().join("in.obj");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nt crease 2/1/0 0 1 2.5\n";
    std::fs::write(&input, text).expect("a file can be written");
    let output = folder.path().join("out.obj");
    let run = run(
        "refine {} -o {} --scheme sqrt3 --method uniform",
        &[&input, &output],
    )
    .expect(1);
    says!(run.stderr, "the sharpness 2.5, which is semi-sharp");
}
