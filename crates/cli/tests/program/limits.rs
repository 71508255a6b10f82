//! Requests that nothing can meet, and inputs at the ends of what numbers can be: an end, and true words about it.

use crate::common::{counts, done, file, folder, json_of, run, soup, usage_error};

#[test]
fn more_triangles_than_are_given_at_most_are_refused() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for count in ["18446744073709551615", "31M"] {
        let words = format!("refine builtin:cube -o {{}} --triangles {count}");
        usage_error(&words, &[&output], "--max-triangles raises that");
    }
    assert!(!output.exists());
}

#[test]
fn fewer_triangles_than_the_input_has_are_a_matter_of_optimize() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    run("refine builtin:shoe -o {} --triangles 300", &[&output])
        .expect(3)
        .saying("684 already")
        .saying("--optimize");
    done(
        "refine builtin:shoe -o {} --triangles 300 --optimize",
        &[&output],
    );
    assert!(counts(&soup(&output)).triangles <= 300);
}

#[test]
fn tiny_and_huge_models_are_refined_as_any_other() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let mut triangles = Vec::new();
    for exponent in ["e-300", "e-150", "", "e150", "e300"] {
        let one = format!("1{exponent}");
        let text = format!(
            "v 0 0 0\nv {one} 0 0\nv 0 {one} 0\nv 0 0 {one}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
        );
        let input = file(&folder, "in.obj", &text);
        let told = json_of("refine {} -o {} --report -", &[&input, &output]);
        assert_eq!(told["diagnosis"]["clean"], true, "{exponent}");
        triangles.push(told["output"]["triangles"].clone());
    }
    assert!(
        triangles.iter().all(|count| *count == triangles[2]),
        "{triangles:?}"
    );
}

#[test]
fn why_nothing_is_certified_is_told() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    // There is no memory for a mesh that would show more.
    for goal in ["--angle 20", "--angle 20 --balance"] {
        let words = format!("refine builtin:shoe -o {{}} {goal} --max-memory 3M");
        done(&words, &[&output])
            .saying("not certified")
            .saying("(no distance was asked for");
    }
    done("refine builtin:cube -o {} --scheme butterfly", &[&output])
        .saying("by samples, not certified")
        .saying("(nothing is proven for the scheme butterfly");
}
