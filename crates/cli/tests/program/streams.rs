//! Where meshes come from and go to: standard input and output, formats that names do not show, several inputs, names in
//! any encoding.

use std::io::Write;
use std::path::Path;
use std::process::{Output, Stdio};

use serde_json::Value;

use crate::common::{
    TETRAHEDRON, bytes, command, count, done, file, folder, json_file, names, run, soup,
    usage_error, words,
};

/// Runs the program with bytes on standard input.
fn fed(bytes: &[u8], arguments: &str, paths: &[&Path]) -> Output {
    let mut child = command(arguments, paths)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut input = child.stdin.take().expect("piped");
    let bytes = bytes.to_vec();
    // One that refuses its arguments goes away before it reads.
    let writer = std::thread::spawn(move || input.write_all(&bytes).unwrap_or_default());
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("written");
    output
}

#[test]
fn a_mesh_goes_from_standard_input_to_standard_output() {
    let folder = folder();
    let input = file(&folder, "in.obj", TETRAHEDRON);
    let whole = folder.path().join("whole.ply");
    done("refine {} -o {}", &[&input, &whole]);
    let expected = bytes(&whole);
    let piped = fed(
        TETRAHEDRON.as_bytes(),
        "refine - --from obj -o - --to ply",
        &[],
    );
    assert_eq!(
        piped.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&piped.stderr)
    );
    assert!(piped.stdout == expected);
    assert!(String::from_utf8_lossy(&piped.stderr).contains("standard output: "));
    // As a frame, too, which is read once.
    let frame = fed(
        TETRAHEDRON.as_bytes(),
        "refine - --from obj -o - --to ply --shared-topology",
        &[],
    );
    assert_eq!(
        frame.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&frame.stderr)
    );
    assert!(frame.stdout.starts_with(b"ply\n"));
    // Half of it by name.
    let half = fed(
        &expected,
        "refine - --from ply -o {} --quiet",
        &[&folder.path().join("half.off")],
    );
    assert_eq!(half.status.code(), Some(0));
    let told = fed(TETRAHEDRON.as_bytes(), "info - --from obj --json", &[]);
    let told: Value = serde_json::from_slice(&told.stdout).expect("JSON");
    assert_eq!(
        (&told["input"]["path"], &told["mesh"]["triangles"]),
        (&"standard input".into(), &4.into())
    );
    let measured = fed(
        TETRAHEDRON.as_bytes(),
        "measure - {} --from obj --json",
        &[&input],
    );
    let measured: Value = serde_json::from_slice(&measured.stdout).expect("JSON");
    assert!(measured["hausdorff"]["symmetric"].as_f64() < Some(1e-12));
    let picture = fed(
        TETRAHEDRON.as_bytes(),
        "render - --from obj -o - --size 64x48",
        &[],
    );
    assert!(picture.stdout.starts_with(b"\x89PNG"));
}

#[test]
fn formats_that_nothing_tells_are_asked_for() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    usage_error("refine - -o {}", &[&output], "--from");
    usage_error("refine builtin:head -o -", &[], "--to");
    usage_error("measure - -", &[], "once");
    usage_error("refine builtin:head -o - --to ply --report -", &[], "twice");
    let run_of = fed(b"", "refine - --from obj -o {}", &[&output]);
    assert_eq!(run_of.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&run_of.stderr).contains("standard input: the file is empty"));
    // Names without an extension that is known, on both sides.
    let (input, unnamed) = (
        file(&folder, "scan.dat", TETRAHEDRON),
        folder.path().join("unnamed"),
    );
    run("refine {} -o {}", &[&input, &output])
        .expect(1)
        .saying("'dat'");
    done("refine {} -o {} --from obj --to off", &[&input, &unnamed]);
    assert!(bytes(&unnamed).starts_with(b"OFF"));
    // A name that shows its format wins over --from, which is for standard input and the like.
    let named = file(&folder, "named.obj", TETRAHEDRON);
    done("info {} --from stl", &[&named]);
    assert_eq!(names(folder.path()), ["named.obj", "scan.dat", "unnamed"]);
}

#[test]
fn several_inputs_go_into_a_folder_by_their_names() {
    let folder = folder();
    let (one, two) = (
        file(&folder, "one.obj", TETRAHEDRON),
        file(&folder, "two.obj", TETRAHEDRON),
    );
    let out = folder.path().join("out/");
    let words = "refine {} {} builtin:cube -o {} --report {} --picture {} --triangles 100";
    done(words, &[&one, &two, &out, &out, &out]).saying("two.obj: 100 triangles");
    let expected = [
        "cube.json",
        "cube.ply",
        "cube.png",
        "one.json",
        "one.obj",
        "one.png",
        "two.json",
        "two.obj",
        "two.png",
    ];
    assert_eq!(names(&out), expected);
    let report = json_file(out.join("two.json"));
    assert_eq!(report["input"]["path"], two.display().to_string());
    assert_eq!(
        soup(&out.join("two.obj")).faces.len() as u64,
        count(&report["output"]["triangles"])
    );
    // One input into a folder that is there, with a format of its own.
    let there = folder.path().join("there");
    std::fs::create_dir(&there).expect("a folder");
    done("refine {} -o {} --to stl", &[&one, &there]);
    assert_eq!(names(&there), ["one.stl"]);
}

#[test]
fn several_inputs_go_on_after_one_that_fails() {
    let folder = folder();
    let good = file(&folder, "good.obj", TETRAHEDRON);
    let bad = file(&folder, "bad.obj", "v 0 0 0\nf 1 2 3\n");
    let out = folder.path().join("out/");
    let told = run("refine {} {} -o {}", &[&bad, &good, &out]).expect(1);
    says!(told.stderr, "bad.obj");
    says!(told.stderr, "1 of 2 inputs failed");
    assert_eq!(names(&out), ["good.obj"]);
    let short = "refine {} builtin:head -o {} --tolerance 1e-9 --max-triangles 500";
    run(short, &[&good, &out]).expect(3).saying("2 of 2 inputs");
    // What makes no sense is found before anything is done.
    let file_for_two = folder.path().join("both.ply");
    usage_error(
        "refine {} {} -o {}",
        &[&good, &bad, &file_for_two],
        "FOLDER/",
    );
    usage_error("refine {} {} -o {}", &[&good, &good, &out], "twice");
    usage_error("refine - --from obj -o {}", &[&out], "has no name");
    let none = folder.path().join("none/");
    run("refine {} -o {} --limit", &[&good, &none]).expect(2);
    assert!(!none.exists());
}

#[cfg(target_os = "linux")]
#[test]
fn names_may_be_in_any_encoding() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    // ü in Latin-1, which is no UTF-8.
    let [input, output, report] = [&b"B\xfcste.obj"[..], b"B\xfcste.ply", b"B\xfcste.json"]
        .map(|name| folder.path().join(OsStr::from_bytes(name)));
    std::fs::write(&input, TETRAHEDRON).expect("writable");
    done("refine {} -o {} --report {}", &[&input, &output, &report]);
    assert!(soup(&output).faces.len() > 100);
    let report = json_file(&report);
    assert!(words(&report["input"]["path"]).ends_with("B\u{fffd}ste.obj"));
    done("info {}", &[&input]);
    done("measure {} --limit-of {}", &[&output, &input]);
}

/// Whoever cannot take what is written is named.
#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_output_is_named() {
    for arguments in [
        "refine builtin:cube -o - --to ply",
        "info builtin:cube --json",
    ] {
        let full = std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("Linux has one");
        let ended = command(arguments, &[])
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .expect("it ends");
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(1), "{arguments}: {said}");
        says!(said, "standard output");
        says!(said, "No space left");
    }
}
