//! Files are written whole or not at all, messages where they belong.

use std::path::Path;
use std::process::Stdio;

#[cfg(unix)]
use crate::common::{Running, done, text};
use crate::common::{command, file, folder, names, run, soup};

#[test]
fn a_failed_run_leaves_an_earlier_file_as_it_was() {
    let folder = folder();
    let input = file(&folder, "bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n");
    let output = file(&folder, "out.ply", "precious");
    run("refine {} -o {}", &[&input, &output])
        .expect(1)
        .saying("bad.obj");
    assert_eq!(text(&output), "precious");
    assert_eq!(names(folder.path()), ["bad.obj", "out.ply"]);
}

#[test]
fn numbers_that_overflow_are_not_written() {
    let folder = folder();
    let huge = "v 1.7e308 0 0\nv 0 1.7e308 0\nv 0 0 1.7e308\nv -1.7e308 -1.7e308 -1.7e308\n\
                f 1 2 3\nf 1 3 4\nf 3 2 4\nf 2 1 4\n";
    let input = file(&folder, "huge.obj", huge);
    let output = folder.path().join("out.stl");
    run("refine {} -o {} --method uniform", &[&input, &output]).expect(1);
    assert_eq!(names(folder.path()), ["huge.obj"]);
}

#[test]
fn a_mesh_may_be_refined_in_place() {
    let folder = folder();
    let mesh = folder.path().join("mesh.off");
    done(
        "refine builtin:cube -o {} --levels 0 --method uniform --faces triangles",
        &[&mesh],
    );
    assert_eq!(soup(&mesh).faces.len(), 12);
    done(
        "refine {} -o {} --levels 1 --method uniform --overwrite",
        &[&mesh, &mesh],
    );
    assert_eq!(soup(&mesh).faces.len(), 48);
    assert_eq!(names(folder.path()), ["mesh.off"]);
}

#[test]
fn a_folder_that_does_not_exist_is_found_before_the_work() {
    let folder = folder();
    let nowhere = folder.path().join("nowhere").join("out.ply");
    run("refine builtin:head -o {}", &[&nowhere])
        .expect(1)
        .saying("nowhere");
    let output = folder.path().join("out.ply");
    let report = folder.path().join("nowhere").join("report.json");
    run("refine builtin:head -o {} --report {}", &[&output, &report])
        .expect(1)
        .saying("nowhere");
    done(
        "refine builtin:head -o {}",
        &[&folder.path().join("sub.ply")],
    );
    assert_eq!(names(folder.path()), ["sub.ply"]);
}

#[test]
fn quiet_says_nothing_and_otherwise_only_results_go_to_standard_output() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let picture = folder.path().join("out.png");
    let silent = done(
        "refine builtin:head -o {} --tolerance 1% --picture {} --quiet",
        &[&output, &picture],
    );
    assert_eq!((silent.stdout.as_str(), silent.stderr.as_str()), ("", ""));
    assert_eq!(names(folder.path()), ["out.ply", "out.png"]);
    let told = done("refine builtin:head -o {} --tolerance 1%", &[&output]);
    assert_eq!(told.stdout, "");
    // The head folds over in places, and that is said.
    assert_eq!(
        told.stderr.lines().count(),
        6,
        "summary and a warning, no progress: {}",
        told.stderr
    );
    for command in [
        "info builtin:cup",
        "measure builtin:cup builtin:cup",
        "models",
    ] {
        let run = done(&format!("{command} -q"), &[]);
        assert_eq!(run.stderr, "", "{command}");
        assert!(!run.stdout.is_empty(), "{command}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = command("info builtin:cup --json", &[])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[cfg(unix)]
#[test]
fn signals_leave_the_whole_file_or_none_and_say_what_was_cancelled() {
    use std::time::Duration;
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        for delay in [20, 200, 600] {
            let folder = folder();
            let output = folder.path().join("out.ply");
            let child = command(
                "refine builtin:shoe -o {} -q --method uniform --levels 5",
                &[&output],
            )
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
            std::thread::sleep(Duration::from_millis(delay));
            // Fails if the program has ended by then, which is fine.
            let _ = std::process::Command::new("kill")
                .args([&format!("-{signal}"), &child.id().to_string()])
                .stderr(Stdio::null())
                .status();
            let output_of = child.wait_with_output().expect("it ends");
            let told = String::from_utf8_lossy(&output_of.stderr).into_owned();
            let ended = output_of.status.code();
            match names(folder.path()).as_slice() {
                // Before it could arrange for signals, it ends as any program does.
                [] if ended.is_none() && delay < 100 => {}
                [] => {
                    assert_eq!(ended, Some(code), "{told}");
                    says!(told, "cancelled by");
                    says!(told, "nothing was written");
                }
                [name] if name == "out.ply" => {
                    assert!(ended == Some(0) || ended == Some(code), "{ended:?} {told}");
                    assert_eq!(
                        told.contains("out.ply written by then"),
                        ended != Some(0),
                        "{told}"
                    );
                    assert_eq!(soup(&output).faces.len(), 684 * 4usize.pow(5));
                }
                other => panic!("left behind: {other:?}"),
            }
        }
    }
}

/// Of files that belong together none counts as written before all are.
#[cfg(unix)]
#[test]
fn a_document_is_not_written_when_what_it_names_is() {
    let folder = folder();
    let document = pipe(&folder, "pipe.gltf");
    let mut running = Running::start("refine builtin:cup -o {} -q", &[&document]);
    // Then nothing is left but the pipe, which nobody opens.
    running.until("pipe.bin", || {
        names(folder.path()).contains(&"pipe.bin".to_owned())
    });
    running.signal("TERM");
    let told = running.end().expect(143).saying("while writing ");
    assert!(!told.stderr.contains("written by then"), "{}", told.stderr);
}

#[cfg(unix)]
fn pipe(folder: &tempfile::TempDir, name: &str) -> std::path::PathBuf {
    let pipe = folder.path().join(name);
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .expect("mkfifo")
            .success()
    );
    pipe
}

/// A signal that is ignored at the start stays ignored, as `nohup` needs.
#[cfg(target_os = "linux")]
#[test]
fn an_ignored_hangup_stays_ignored() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let program = env!("CARGO_BIN_EXE_limitmesh");
    let script = format!(
        "trap '' HUP; {program} refine builtin:shoe -o '{}' --method uniform --levels 5 -q & sleep 0.3; kill -HUP $!; wait $!",
        output.display()
    );
    let status = std::process::Command::new("sh")
        .args(["-c", &script])
        .status()
        .expect("a shell");
    assert_eq!(status.code(), Some(0));
    assert_eq!(names(folder.path()), ["out.ply"]);
}

#[cfg(unix)]
#[test]
fn what_is_read_only_is_an_error_before_the_work() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let output = file(&folder, "out.ply", "precious");
    std::fs::set_permissions(&output, std::fs::Permissions::from_mode(0o444)).expect("own file");
    for words in [
        "refine builtin:head -o {}",
        "refine builtin:head -o x.ply --dry-run --report {}",
    ] {
        run(words, &[&output])
            .expect(1)
            .saying("out.ply")
            .saying("read-only");
    }
    assert_eq!(text(&output), "precious");
    assert_eq!(names(folder.path()), ["out.ply"]);
}

/// Results are reported in lines that fit a terminal of 100 columns.
#[test]
fn lines_of_results_are_short() {
    let folder = folder();
    let output = Path::new("out.ply");
    let long = [
        "builtin:head --tolerance 0.001% --max-triangles 20000",
        "builtin:head --tolerance 1e-9 --max-triangles 2000",
        "builtin:bumpy --scheme butterfly",
        "builtin:head --angle 3",
        "builtin:head --angle 40",
        "builtin:head --triangles 3000 --optimize",
        "builtin:head --pixels 0.5 --view 0,-4,2,0,0,0,0,0,1,40,1920x1080",
        "builtin:head --method uniform",
    ];
    for options in long {
        let told = command(&format!("refine -o {{}} {options}"), &[output])
            .current_dir(folder.path())
            .output()
            .expect("it runs");
        let told = String::from_utf8_lossy(&told.stderr).into_owned();
        let longest = told
            .lines()
            .map(|line| line.chars().count())
            .max()
            .expect("a line");
        assert!(longest <= 100, "{options}: {longest}\n{told}");
    }
}
