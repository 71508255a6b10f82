//! `refine --method planarity` and `vertex-error`: criteria of the literature over a restricted quadtree.

use crate::common::{count, done, folder, json_of, refuses, run, usage_error};

/// Triangles and what was reached, from a report.
fn refined(words: &str) -> (u64, serde_json::Value) {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let line = format!("refine builtin:head -o {{}} --report - {words}");
    let report = json_of(&line, &[&output]);
    (count(&report["output"]["triangles"]), report)
}

#[test]
fn smaller_limits_take_more_triangles() {
    for (coarse, fine) in [
        (
            "--method planarity --tolerance 0.5%",
            "--method planarity --tolerance 0.1%",
        ),
        (
            "--method vertex-error --tolerance 0.5%",
            "--method vertex-error",
        ),
    ] {
        let ((few, report), (many, _)) = (refined(coarse), refined(fine));
        assert!(few < many, "{coarse}: {few}, {fine}: {many}");
        assert!(report["error"].is_null());
        assert_eq!(report["stop"], "met", "{report}");
    }
    // The head has boundary vertices without a tangent plane, where angles never close.
    let folder = folder();
    let output = folder.path().join("out.ply");
    let words = "refine builtin:head -o {} --method planarity --angle 20 --levels 5";
    run(words, &[&output]).expect(3).saying("--levels");
    // There are never fewer than the control mesh has.
    for method in ["--method vertex-error", "--scheme sqrt3"] {
        let words = format!("refine builtin:head -o {{}} {method} --triangles 100");
        run(&words, &[&output]).expect(3).saying("has 142 already");
    }
}

#[test]
fn what_does_not_go_together_is_said() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    refuses(
        &[("output", &output)],
        "
        2 | refine builtin:cup -o {output} --method vertex-error --angle 5 | --angle
        2 | refine builtin:cup -o {output} --method planarity --angle 5 --tolerance 1% | not given together
        2 | refine builtin:cup -o {output} --method planarity --balance | --balance
        2 | refine builtin:cup -o {output} --method vertex-error --levels 0 | goals need 1
        2 | refine builtin:cup -o {output} --method planarity --view 0,0,1 | --view
        2 | refine builtin:cup -o {output} --method planarity --scheme sqrt3 | sqrt3",
    );
    assert!(!output.exists());
    let asset = folder.path().join("out.glb");
    done(
        "refine builtin:cup -o {} --method vertex-error --tolerance 1%",
        &[&asset],
    );
    usage_error(
        "refine {} -o {} --method vertex-error",
        &[&asset, &folder.path().join("again.glb")],
        "do not edit glTF",
    );
}
