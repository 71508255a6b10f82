//! `refine --method planarity` and `vertex-error`: criteria of the literature over a restricted quadtree.

use limitmesh::scheme::Loop;
use limitmesh::{FaceId, LimitSurface, Mesh};

use crate::common::{folder, run, soup};

/// Triangles and what was reached, from a report.
fn refined(words: &str) -> (u64, serde_json::Value) {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let report = run(
        &format!("refine builtin:head -o {{}} --report - {words}"),
        &[&output],
    )
    .expect(0)
    .json();
    (
        report["output"]["triangles"].as_u64().expect("a count"),
        report,
    )
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
    let words = "refine builtin:head -o {} --method planarity --angle 20 --max-levels 5";
    run(words, &[&output]).expect(3).saying("--max-levels");
    // There are never fewer than the control mesh has.
    for method in ["--method vertex-error", "--scheme sqrt3"] {
        let words = format!("refine builtin:head -o {{}} {method} --triangles 100");
        run(&words, &[&output]).expect(3).saying("has 142 already");
    }
}

#[test]
fn vertices_are_where_the_provenance_says() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    run(
        "refine builtin:cup -o {} --method planarity --angle 15 --provenance --ascii",
        &[&output],
    )
    .expect(0);
    let text = std::fs::read_to_string(&output).expect("a file");
    let (head, body) = text.split_once("end_header\n").expect("a header");
    let properties: Vec<&str> = head
        .lines()
        .skip_while(|l| !l.starts_with("element vertex"))
        .skip(1)
        .take_while(|l| l.starts_with("property"))
        .collect();
    let column = |name: &str| {
        properties
            .iter()
            .position(|l| l.ends_with(&format!(" {name}")))
            .unwrap_or_else(|| panic!("{name} in {properties:?}"))
    };
    let model = limitmesh_models::find("cup").expect("a model");
    let (control, _) = Mesh::from_soup(&model.soup(), &Default::default()).expect("a mesh");
    let surface = LimitSurface::new(&control, &Loop).expect("limits");
    let names = [
        "x",
        "y",
        "z",
        "nx",
        "ny",
        "nz",
        "parent_face",
        "parent_a",
        "parent_b",
        "parent_c",
    ]
    .map(column);
    let vertices = soup(&output).positions.len();
    for line in body.lines().take(vertices).step_by(17) {
        let own: Vec<f64> = line
            .split(' ')
            .map(|word| word.parse().expect("a number"))
            .collect();
        let [x, y, z, nx, ny, nz, face, w0, w1, w2] = names.map(|column| own[column]);
        let there = surface.at(FaceId(face as u32), [w0, w1, w2]);
        for (a, b) in [x, y, z]
            .into_iter()
            .zip(there.position)
            .chain([nx, ny, nz].into_iter().zip(there.normal))
        {
            assert!((a - b).abs() < 1e-6, "{line}");
        }
    }
}

#[test]
fn what_does_not_go_together_is_said() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for (words, said) in [
        ("--method vertex-error --angle 5", "--angle"),
        (
            "--method planarity --angle 5 --tolerance 1%",
            "not given together",
        ),
        ("--method planarity --balance", "--balance"),
        ("--method vertex-error --levels 3", "--levels"),
        ("--method planarity --view 0,0,1", "--view"),
        ("--method planarity --scheme sqrt3", "sqrt3"),
    ] {
        run(&format!("refine builtin:cup -o {{}} {words}"), &[&output])
            .expect(2)
            .saying(said);
    }
    assert!(!output.exists());
    let asset = folder.path().join("out.glb");
    run(
        "refine builtin:cup -o {} --method vertex-error --tolerance 1%",
        &[&asset],
    )
    .expect(0);
    run(
        "refine {} -o {} --method vertex-error",
        &[&asset, &folder.path().join("again.glb")],
    )
    .expect(2)
    .saying("do not edit glTF");
}
