//! `--interpolate[=WITHIN]`: the limit surface through the vertices, in every command that has one.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::json;

use crate::common::{done, file, folder, json_of, number, soup};

/// A peg of 16 facets and radius 5 between flat ends, as OBJ.
fn peg() -> String {
    let mut text = String::new();
    for height in [-4.0, 4.0] {
        for i in 0..16 {
            let (sine, cosine) = (TAU * f64::from(i) / 16.0).sin_cos();
            writeln!(text, "v {} {} {height}", 5.0 * cosine, 5.0 * sine).expect("text");
        }
    }
    for i in 0..16 {
        let j = (i + 1) % 16;
        let (a, b, c, d) = (i + 1, j + 1, j + 17, i + 17);
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").expect("text");
    }
    let ring = |places: &mut dyn Iterator<Item = i32>| {
        places.map(|i| i.to_string()).collect::<Vec<_>>().join(" ")
    };
    writeln!(
        text,
        "f {}\nf {}",
        ring(&mut (1..=16).rev()),
        ring(&mut (17..=32))
    )
    .expect("text");
    text
}

fn radii(positions: &[[f64; 3]]) -> (f64, f64) {
    let radii = positions
        .iter()
        .map(|p| p[0].hypot(p[1]))
        .filter(|&r| r > 4.5);
    radii.fold((f64::INFINITY, 0.0), |(least, most), r| {
        (least.min(r), most.max(r))
    })
}

#[test]
fn a_peg_keeps_its_radius() {
    let folder = folder();
    let input = file(&folder, "peg.obj", &peg());
    let output = folder.path().join("out.ply");
    let refine = |options: &str| {
        let line =
            format!("refine {{}} -o {{}} --crease-angle 30 --tolerance 0.01 --report - {options}");
        let run = done(&line, &[&input, &output]);
        (run.json(), radii(&soup(&output).positions), run.stderr)
    };
    let (report, (_, most), _) = refine("");
    assert_eq!(
        (
            &report["interpolation"],
            &report["parameters"]["interpolate_within"]
        ),
        (&json!(null), &json!(null))
    );
    assert!(most < 4.9, "{most}");

    let (report, (_, most), said) = refine("--interpolate");
    assert!(most <= 5.0 + 1e-9 && most > 4.9997, "{most}");
    assert!(
        said.contains("passes through 32 vertices: control points moved by up to 0.13"),
        "{said}"
    );
    assert_eq!(report["parameters"]["interpolate_within"], 0.0);
    assert_eq!(report["error"]["certified"], true);
    // Lengths are in per cent of what was read.
    assert!((number(&report["error"]["diagonal"]) - 264f64.sqrt()).abs() < 1e-9);
    let found = &report["interpolation"];
    assert_eq!(
        (&found["within"], &found["method"]),
        (&json!(0.0), &json!("conjugate-gradients"))
    );
    assert!(number(&found["residual"]) < 1e-12 && number(&found["displacement"]) > 0.1);
    let percent = 100.0 * number(&found["displacement"]) / 264f64.sqrt();
    assert!((number(&found["displacement_percent"]) - percent).abs() < 1e-9);

    let (report, (_, most), said) = refine("--interpolate=0.02");
    let found = &report["interpolation"];
    assert!((4.97..4.985).contains(&most), "{most}");
    assert!(said.contains("passes within 0.02 of 32 vertices"), "{said}");
    assert!(number(&found["residual"]) <= 0.02 + 1e-11);
    at_most!(number(&found["least_energy"]), number(&found["energy"]));
    below!(number(&found["energy"]), 1.0);
    let (report, ..) = refine("--interpolate=0%");
    assert_eq!(report["interpolation"]["within"], 0.0);
}

#[test]
fn every_command_with_a_limit_surface_has_it() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    done(
        "refine builtin:cup -o {} --interpolate --tolerance 0.2%",
        &[&output],
    );
    let measured = |options: &str| {
        let line = format!("measure {{}} --limit-of builtin:cup --json {options}");
        json_of(&line, &[&output])
    };
    let (plain, through) = (measured(""), measured("--interpolate"));
    assert_eq!(
        plain["reference"]["limit"]["interpolate_within"],
        json!(null)
    );
    assert_eq!(through["reference"]["limit"]["interpolate_within"], 0.0);
    assert!(number(&through["hausdorff"]["symmetric_percent"]) <= 0.21);
    assert!(number(&plain["hausdorff"]["symmetric_percent"]) > 0.5);
    let compared = json_of(
        "compare builtin:tetrahedron --interpolate --json --samples 2000 --levels 1",
        &[],
    );
    assert_eq!(compared[0]["reference"]["interpolate_within"], 0.0);

    // Without refinement it is the control mesh.
    done(
        "refine builtin:cup -o {} --interpolate --method uniform --levels 0",
        &[&output],
    );
    let control = soup(&output);
    let plain = limitmesh_models::find("cup").expect("a model").soup();
    assert_eq!(control.positions.len(), plain.positions.len());
    assert!(control.positions != plain.positions);
    // A dry run knows of it.
    done("refine builtin:cup --dry-run --interpolate", &[]).saying("passes through");
}
