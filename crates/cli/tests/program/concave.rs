//! Corners of 180° and more: divided where the program tags edges, as they are where the file does.

use serde_json::{Value, json};

use crate::common::{count, done, file, folder, json_of, number, run};

/// An L of height 1: two caps of four triangles round a corner, and six sides.
const L: &str = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n\
    f 1 3 2\nf 1 4 3\nf 1 5 4\nf 1 6 5\nf 7 8 9\nf 7 9 10\nf 7 10 11\nf 7 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";

/// A flat sheet round the origin but for a quarter, with a tag on the corner there.
const TAGGED: &str = "v 0 0 0\nv 1 0 0\nv 0.8 0.6 0\nv 0.28 0.96 0\nv -0.28 0.96 0\nv -0.8 0.6 0\nv -1 0 0\nv -0.8 -0.6 0\n\
    v -0.28 -0.96 0\nv 0 -1 0\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\nf 1 6 7\nf 1 7 8\nf 1 8 9\nf 1 9 10\nt corner 1/1/0 0 10.0\n";

#[test]
fn creases_by_angle_keep_flat_faces_flat_and_what_that_took_is_told() {
    let folder = folder();
    let input = file(&folder, "l.obj", L);
    let output = folder.path().join("out.ply");
    let refine = |options: &str| {
        let words = format!("refine {{}} -o {{}} --crease-angle 30 --report - {options}");
        let run = done(&words, &[&input, &output]);
        (run.json(), run.stderr)
    };
    let off = || {
        let run = done("measure {} {} --certified --json", &[&output, &input]);
        number(&run.json()["hausdorff"]["upper"])
    };
    let (report, told) = refine("");
    assert_eq!(
        report["diagnosis"]["concave_corners"],
        json!({ "count": 2, "first": [3, 9] })
    );
    assert_eq!(report["diagnosis"]["clean"], true);
    assert_eq!(report["parameters"]["concave_corners"], "fixed");
    assert_eq!(
        (
            &report["output"]["inverted_triangles"],
            &report["output"]["triangles"]
        ),
        (&json!(0), &json!(20))
    );
    says!(told, "2 sharp edges divide 2 corners of 180° or more");
    assert!(!told.contains("turned over"), "{told}");
    assert!(off() < 1e-9);

    let (report, told) = refine("--concave-corners smooth");
    assert_eq!(report["diagnosis"]["concave_corners"]["count"], 0);
    assert_eq!(report["parameters"]["concave_corners"], "smooth");
    assert!(count(&report["output"]["inverted_triangles"]) > 0);
    says!(told, "triangles are turned over against the limit surface");
    assert!(off() > 0.02);
    let (report, _) = refine("--method uniform --levels 2");
    assert_eq!(report["output"]["inverted_triangles"], Value::Null);
    // Nothing is divided, but there are more than there may be.
    for (most, code) in [(19, 3), (20, 0)] {
        let words = format!("refine {{}} -o {{}} --crease-angle 30 --max-triangles {most}");
        let run = run(&words, &[&input, &output]).expect(code);
        assert_eq!(
            run.stderr
                .contains("the control mesh has more than --max-triangles 19 already"),
            code == 3
        );
    }
    // It is the same limit surface for measuring.
    refine("");
    let measure = "measure {} --limit-of {} --crease-angle 30 --certified --json";
    let measured = json_of(measure, &[&output, &input]);
    assert!(number(&measured["hausdorff"]["upper"]) < 1e-6);
    assert_eq!(measured["reference"]["limit"]["concave_corners"], "fixed");
}

#[test]
fn tags_of_files_are_followed_as_they_are_unless_asked() {
    let folder = folder();
    let input = file(&folder, "tagged.obj", TAGGED);
    let output = folder.path().join("out.ply");
    let report = |options: &str| {
        let line = format!("refine {{}} -o {{}} --report - {options}");
        json_of(&line, &[&input, &output])
    };
    let tagged = report("");
    assert_eq!(tagged["parameters"]["concave_corners"], "smooth");
    assert_eq!(tagged["diagnosis"]["concave_corners"]["count"], 0);
    let divided = report("--concave-corners fixed");
    assert_eq!(divided["diagnosis"]["concave_corners"]["count"], 1);
    assert_eq!(divided["output"]["inverted_triangles"], 0);
    assert_eq!(
        report("--boundary corners")["parameters"]["concave_corners"],
        "fixed"
    );
}
