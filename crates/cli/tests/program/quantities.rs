//! Numbers as people write them: counts, bytes, lengths with their units.

use serde_json::Value;

use crate::common::{done, folder, json_of, number, usage_error};

/// The parameters that a refinement was done with.
fn parameters(options: &str) -> Value {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let words = format!("refine builtin:cube -o {{}} --report - {options}");
    json_of(&words, &[&output])["parameters"].clone()
}

#[test]
fn lengths_may_have_a_unit_where_the_mesh_has_one() {
    let tolerance = |options: &str| number(&parameters(options)["exact"]["tolerance"]);
    assert_eq!(tolerance("--tolerance 0.05"), 0.05);
    assert_eq!(tolerance("--tolerance 0.05mm --unit mm"), 0.05);
    assert_eq!(tolerance("--tolerance 0.5mm --unit cm"), 0.05);
    assert_eq!(tolerance("--tolerance 0.01in --unit mm"), 0.254);
    assert_eq!(tolerance("--tolerance 0.05 --unit mm"), 0.05);
    assert!((number(&parameters("--weld 1um --unit mm")["weld"]) - 0.001).abs() < 1e-15);
    for (options, words) in [
        ("--tolerance 0.05mm", "--unit mm"),
        ("--tolerance 0.05mm --weld 1cm", "--unit cm"),
        ("--tolerance 0.05furlongs", "not a number"),
        ("--tolerance 0.05mm --unit furlong", "furlong"),
    ] {
        let line = format!("refine builtin:cube -o out.ply {options}");
        usage_error(&line, &[], words);
    }
    let gap = "measure builtin:cube builtin:tetrahedron --certified --gap 1mm";
    usage_error(gap, &[], "--unit mm");
    done(&format!("{gap} --unit m"), &[]);
    // Results have the unit as well.
    let folder = folder();
    let output = folder.path().join("out.ply");
    let told = done(
        "refine builtin:cube -o {} --tolerance 0.01mm --unit mm",
        &[&output],
    )
    .stderr;
    assert!(told.contains(" mm) of the limit surface"), "{told}");
}
