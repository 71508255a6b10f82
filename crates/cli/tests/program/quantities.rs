//! Numbers as people write them: counts, bytes, lengths with their units.

use serde_json::Value;

use crate::common::{folder, run};

/// The parameters that a refinement was done with.
fn parameters(options: &str) -> Value {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let words = format!("refine builtin:cube -o {{}} --report - {options}");
    run(&words, &[&output]).expect(0).json()["parameters"].clone()
}

#[test]
fn counts_and_bytes_are_read_as_people_write_them() {
    for (text, count) in [
        ("2k", 2000),
        ("2,000", 2000),
        ("2e3", 2000),
        ("1.5K", 1500),
        ("2_000", 2000),
    ] {
        assert_eq!(
            parameters(&format!("--triangles {text}"))["exact"]["triangles"],
            count,
            "{text}"
        );
    }
    assert_eq!(
        parameters("--triangles 1k --max-triangles 1M")["max_triangles"],
        1_000_000
    );
    for (text, bytes) in [
        ("500MB", 500_000_000u64),
        ("500M", 500 << 20),
        ("1GiB", 1 << 30),
    ] {
        assert_eq!(
            parameters(&format!("--max-memory {text}"))["exact"]["max_memory"],
            bytes,
            "{text}"
        );
    }
    let measured = run("measure builtin:cube builtin:cube --samples 5k --json", &[])
        .expect(0)
        .json();
    assert!(measured["hausdorff"]["samples"].as_u64() < Some(20_000));
}

#[test]
fn lengths_may_have_a_unit_where_the_mesh_has_one() {
    let tolerance = |options: &str| {
        parameters(options)["exact"]["tolerance"]
            .as_f64()
            .expect("a number")
    };
    assert_eq!(tolerance("--tolerance 0.05"), 0.05);
    assert_eq!(tolerance("--tolerance 0.05mm --unit mm"), 0.05);
    assert_eq!(tolerance("--tolerance 0.5mm --unit cm"), 0.05);
    assert_eq!(tolerance("--tolerance 0.01in --unit mm"), 0.254);
    assert_eq!(tolerance("--tolerance 0.05 --unit mm"), 0.05);
    assert!(
        (parameters("--weld 1um --unit mm")["weld"]
            .as_f64()
            .expect("a number")
            - 0.001)
            .abs()
            < 1e-15
    );
    for (options, words) in [
        ("--tolerance 0.05mm", "--unit mm"),
        ("--tolerance 0.05mm --weld 1cm", "--unit cm"),
        ("--tolerance 0.05furlongs", "not a number"),
        ("--tolerance 0.05mm --unit furlong", "furlong"),
    ] {
        run(&format!("refine builtin:cube -o out.ply {options}"), &[])
            .expect(2)
            .saying(words);
    }
    let gap = "measure builtin:cube builtin:tetrahedron --certified --gap 1mm";
    run(gap, &[]).expect(2).saying("--unit mm");
    run(&format!("{gap} --unit m"), &[]).expect(0);
    // Results have the unit as well.
    let folder = folder();
    let output = folder.path().join("out.ply");
    let told = run(
        "refine builtin:cube -o {} --tolerance 0.01mm --unit mm",
        &[&output],
    )
    .expect(0)
    .stderr;
    assert!(told.contains(" mm) of the limit surface"), "{told}");
}

#[test]
fn what_a_tolerance_may_be_is_told_in_one_way() {
    for bad in ["0", "-1", "0%", "-0.5%", "-1mm"] {
        let words = format!("refine builtin:cube -o out.ply --tolerance={bad}");
        run(&words, &[])
            .expect(2)
            .saying(&format!("{bad} is out of range: a tolerance is above 0"));
    }
}
