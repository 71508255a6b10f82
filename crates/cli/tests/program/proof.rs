//! `refine --proof`: what is written is confirmed by the checker, which shares nothing with the program.

#![allow(clippy::unwrap_used, reason = "a test's helpers fail the test")]

use std::path::Path;
use std::process::Command;

use limitmesh_check::proof::Proof;
use limitmesh_check::{read, verdict};
use serde_json::{Value, json};

use crate::common::{done, file, folder, json_of, refuses, usage_error};

/// Triangles that are refused, the files being as they are.
fn refused(control: Option<&Path>, result: &Path, proof: &Path, times: f64) -> usize {
    let mesh =
        |path: &Path| read::mesh(&path.to_string_lossy(), &std::fs::read(path).unwrap()).unwrap();
    let proof = Proof::read(&std::fs::read(proof).unwrap()).unwrap();
    let control = proof.held.clone().unwrap_or_else(|| mesh(control.unwrap()));
    verdict::refused(&control, &mesh(result), &proof, times * proof.within)
        .unwrap()
        .len()
}

/// Refines with a proof and checks that; the report.
#[track_caller]
fn proven(input: &str, options: &str, ending: &str) -> Value {
    let folder = folder();
    let [result, proof] =
        ["result", "proof"].map(|name| folder.path().join(format!("{name}.{ending}")));
    let command = format!("refine {input} -o {{}} {options} --proof {{}} --report -");
    let report = done(&command, &[&result, &proof]).saying("proves").json();
    let control = (!input.starts_with("builtin:")).then_some(Path::new(input));
    assert_eq!(
        refused(control, &result, &proof, 1.0),
        0,
        "{input} {options}"
    );
    let lower =
        report["error"]["lower"].as_f64().unwrap() / report["error"]["upper"].as_f64().unwrap();
    if lower > 0.5 && report["error"]["proven"].is_null() {
        assert_ne!(
            refused(control, &result, &proof, 0.999 * lower),
            0,
            "{input} {options}"
        );
    }
    report
}

/// Whatever else is asked for, in all formats that the checker reads.
#[test]
fn all_kinds_of_results_are_confirmed() {
    for (options, ending) in [
        ("--tolerance 0.3% --balance", "obj"),
        ("--triangles 3k", "off"),
        ("--angle 12", "ply --ascii"),
        ("--tolerance 0.3% --interpolate", "obj"),
        ("--within 2%", "ply"),
        ("--tolerance 0.3% --scheme loop-warren", "ply"),
        ("--tolerance 0.3% --crease-angle 20", "obj"),
        (
            "--tolerance 0.3% --pixels 0.5 --view 0,0,5,0,0,0,0,1,0,40,300x200",
            "ply",
        ),
    ] {
        let (ending, more) = ending.split_once(' ').unwrap_or((ending, ""));
        for model in ["cup", "head"] {
            proven(
                &format!("builtin:{model}"),
                &format!("{options} {more}"),
                ending,
            );
        }
    }
    // Tags that fade, sheets that are cut where three meet, a border.
    let folder = folder();
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0.3\nv 1 1 0.2\nv 0 -1 0.4\nv 1 -1 0\nv 0 0.2 1\nv 1 0.1 1.2\n\
        f 1 2 4\nf 1 4 3\nf 1 5 6\nf 1 6 2\nf 1 8 7\nf 1 2 8\nt crease 2/1/0 0 3 1.5\nt corner 1/1/0 3 0.5\n";
    let book = file(&folder, "book.obj", book);
    proven(
        &book.to_string_lossy(),
        "--tolerance 0.2% --crease-angle none",
        "ply",
    );
}

#[test]
fn what_has_no_proof_is_refused_by_name() {
    let folder = folder();
    let [result, proof] = ["result.ply", "result.proof"].map(|name| folder.path().join(name));
    for (options, words) in [
        ("--optimize", "--optimize"),
        ("--split-normals", "--split-normals"),
        ("--scheme butterfly", "loop"),
        ("--scheme sqrt3", "loop"),
        ("--method uniform", "--method exact"),
    ] {
        let line = format!("refine builtin:cube -o {{}} {options} --proof {{}}");
        usage_error(&line, &[&result, &proof], words);
        assert!(!proof.exists() && !result.exists(), "{options}");
    }
    for name in ["result.stl", "result.glb", "result.3mf"] {
        usage_error(
            "refine builtin:cube -o {} --proof {}",
            &[&folder.path().join(name), &proof],
            ".ply",
        );
    }
    refuses(
        &[("proof", &proof), ("result", &result)],
        "
        2 | refine builtin:cube -o - --to ply --ascii --proof {proof} | file
        2 | refine builtin:cube -o {result} --proof {result} | twice",
    );
}

#[test]
fn batches_and_folders_have_proofs() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let job = json!({"input": "builtin:cube", "output": at("a.ply"), "tolerance": "1%", "proof": at("a.proof")});
    let jobs = file(&folder, "jobs.jsonl", &format!("{job}\n"));
    done("batch {} -o {}", &[&jobs, &at("results.jsonl")]);
    assert_eq!(refused(None, &at("a.ply"), &at("a.proof"), 1.0), 0);
    std::fs::create_dir(at("out")).unwrap();
    done(
        "refine builtin:cube builtin:cup -o {} --tolerance 1% --proof {}",
        &[&at("out"), &at("out")],
    );
    for name in ["cube", "cup"] {
        let [result, proof] =
            ["ply", "proof"].map(|ending| at("out").join(format!("{name}.{ending}")));
        assert_eq!(refused(None, &result, &proof, 1.0), 0);
    }
}

/// The second checker, exact and slow, and written from the page alone, says the same.
#[test]
fn the_checker_in_python_agrees() {
    let check = Path::new(env!("CARGO_MANIFEST_DIR")).join("../check/tests/check.py");
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: there is no python3");
        return;
    }
    let folder = folder();
    let [result, proof] = ["result.ply", "result.proof"].map(|name| folder.path().join(name));
    for (input, options) in [
        ("builtin:tetrahedron", "--tolerance 1%"),
        ("builtin:cube", "--tolerance 1.5% --crease-angle none"),
        ("builtin:head", "--triangles 300"),
        ("builtin:torus", "--triangles 400 --balance"),
        (
            "builtin:cube",
            "--tolerance 1% --scheme loop-warren --crease-angle none",
        ),
    ] {
        let command = format!("refine {input} -o {{}} {options} --proof {{}} --report -");
        let report = json_of(&command, &[&result, &proof]);
        let check = |within: f64| {
            let files = [Path::new("-"), &result, &proof];
            let mut python = Command::new("python3");
            let ran = python
                .arg(&check)
                .args(files)
                .args(["--at", &within.to_string()])
                .output()
                .unwrap();
            (
                ran.status.code(),
                String::from_utf8_lossy(&ran.stdout).into_owned(),
            )
        };
        let within = Proof::read(&std::fs::read(&proof).unwrap()).unwrap().within;
        let (code, said) = check(within);
        assert_eq!(code, Some(0), "{input} {options}: {said}");
        let below = 0.999 * report["error"]["lower"].as_f64().unwrap();
        let (code, said) = check(below);
        assert_eq!(code, Some(1), "{input} {options} at {below}: {said}");
    }
}
