//! Requests that nothing can meet, and inputs at the ends of what numbers can be: an end, and true words about it.

use std::fmt::Write;

use crate::common::{counts, file, folder, run, soup};

#[test]
fn angles_and_pixels_that_nothing_meets_use_up_the_cap() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let camera = "--camera 0,0,5,0,0,0,0,1,0,40,800x600";
    for goal in [
        "--angle 1e-300".to_owned(),
        format!("--pixels 1e-300 {camera}"),
    ] {
        let words = format!("refine builtin:sphere -o {{}} {goal} --max-triangles 5000");
        run(&words, &[&output])
            .expect(3)
            .saying("--max-triangles 5,000 was reached before");
        let triangles = counts(&soup(&output)).triangles;
        assert!((2500..=5000).contains(&triangles), "{goal}: {triangles}");
        let words = format!("refine builtin:sphere -o {{}} {goal} --max-triangles 360");
        run(&words, &[&output])
            .expect(3)
            .saying("nothing was divided");
    }
}

#[test]
fn predictions_of_tolerances_that_nothing_meets_come_to_an_end() {
    for goal in [
        "--tolerance 1e-9",
        "--tolerance 1e-300",
        "--angle 1e-6",
        "--angle 1e-300",
    ] {
        let text = run(&format!("refine builtin:bunny --dry-run {goal}"), &[])
            .expect(0)
            .stdout;
        assert!(
            text.contains("30,000,000 triangles, where --max-triangles ends it"),
            "{goal}: {text}"
        );
    }
}

#[test]
fn more_triangles_than_are_given_at_most_are_refused() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for count in ["18446744073709551615", "31M"] {
        let words = format!("refine builtin:cube -o {{}} --triangles {count}");
        run(&words, &[&output])
            .expect(2)
            .saying("--max-triangles raises that");
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
    run(
        "refine builtin:shoe -o {} --triangles 300 --optimize",
        &[&output],
    )
    .expect(0);
    assert!(counts(&soup(&output)).triangles <= 300);
}

#[test]
fn a_polygon_that_goes_round_and_round_ends() {
    let folder = folder();
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf");
    for corner in 0..30_000 {
        write!(text, " {}", corner % 3 + 1).expect("text");
    }
    let input = file(&folder, "round.obj", &text);
    let found = run("info {} --json", &[&input]).expect(0).json();
    assert_eq!(found["diagnosis"]["twisted_polygons"]["count"], 1);
    assert_eq!(found["mesh"]["triangles"], 4);
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
        let told = run("refine {} -o {} --report -", &[&input, &output])
            .expect(0)
            .json();
        assert_eq!(told["diagnosis"]["clean"], true, "{exponent}");
        triangles.push(told["output"]["triangles"].clone());
    }
    assert!(
        triangles.iter().all(|count| *count == triangles[2]),
        "{triangles:?}"
    );
}

#[test]
fn cameras_too_far_away_to_be_measured_are_refused() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for camera in [
        "0,0,1e300,0,0,0,0,1,0,40,800x600",
        "0,0,5,1e200,0,0,0,1,0,40,800x600",
    ] {
        run(
            &format!("refine builtin:sphere -o {{}} --camera {camera}"),
            &[&output],
        )
        .expect(2)
        .saying("up to 1e150");
    }
    run(
        "refine builtin:sphere -o {} --camera 0,0,1e9,0,0,0,0,1,0,40,800x600",
        &[&output],
    )
    .expect(0);
}

#[test]
fn why_nothing_is_certified_is_told() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    // There is no memory for a mesh that tells more.
    for goal in ["--angle 20", "--angle 20 --balance"] {
        let words = format!("refine builtin:shoe -o {{}} {goal} --max-memory 3M");
        run(&words, &[&output])
            .expect(0)
            .saying("not certified")
            .saying("(no distance was asked for");
    }
    run("refine builtin:cube -o {} --scheme butterfly", &[&output])
        .expect(0)
        .saying("by samples, not certified")
        .saying("(nothing is proven for the scheme butterfly");
}
