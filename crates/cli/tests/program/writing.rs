//! Files are written whole or not at all, messages where they belong.

use std::process::Stdio;

use crate::common::{command, file, folder, names, run, soup};

#[test]
fn a_failed_run_leaves_an_earlier_file_as_it_was() {
    let folder = folder();
    let input = file(&folder, "bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n");
    let output = file(&folder, "out.ply", "precious");
    run("refine {} -o {}", &[&input, &output]).expect(1).saying("bad.obj");
    assert_eq!(std::fs::read_to_string(&output).expect("a file"), "precious");
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
    run("refine builtin:cube -o {} --levels 0 --method uniform", &[&mesh]).expect(0);
    assert_eq!(soup(&mesh).faces.len(), 12);
    run("refine {} -o {} --levels 1 --method uniform", &[&mesh, &mesh]).expect(0);
    assert_eq!(soup(&mesh).faces.len(), 48);
    assert_eq!(names(folder.path()), ["mesh.off"]);
}

#[test]
fn a_folder_that_does_not_exist_is_found_before_the_work() {
    let folder = folder();
    let nowhere = folder.path().join("nowhere").join("out.ply");
    run("refine builtin:head -o {}", &[&nowhere]).expect(1).saying("nowhere");
    let output = folder.path().join("out.ply");
    let report = folder.path().join("nowhere").join("report.json");
    run("refine builtin:head -o {} --report {}", &[&output, &report]).expect(1).saying("nowhere");
    run("refine builtin:head -o {}", &[&folder.path().join("sub.ply")]).expect(0);
    assert_eq!(names(folder.path()), ["sub.ply"]);
}

#[test]
fn quiet_says_nothing_and_otherwise_only_results_go_to_standard_output() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let picture = folder.path().join("out.png");
    let silent =
        run("refine builtin:head -o {} --tolerance 1% --picture {} --quiet", &[&output, &picture]).expect(0);
    assert_eq!((silent.stdout.as_str(), silent.stderr.as_str()), ("", ""));
    assert_eq!(names(folder.path()), ["out.ply", "out.png"]);
    let told = run("refine builtin:head -o {} --tolerance 1%", &[&output]).expect(0);
    assert_eq!(told.stdout, "");
    assert_eq!(told.stderr.lines().count(), 1, "one line of summary, no progress: {}", told.stderr);
    for command in ["info builtin:cup", "measure builtin:cup builtin:cup", "models"] {
        let run = run(&format!("{command} -q"), &[]).expect(0);
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
fn an_interrupt_leaves_the_whole_file_or_none() {
    use std::time::Duration;
    for delay in [20, 200, 600] {
        let folder = folder();
        let output = folder.path().join("out.ply");
        let mut child = command("refine builtin:shoe -o {} -q --method uniform --levels 5", &[&output])
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        std::thread::sleep(Duration::from_millis(delay));
        // Fails if the program has ended by then, which is fine.
        let _ = std::process::Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .stderr(Stdio::null())
            .status();
        let code = child.wait().expect("it ends").code();
        match names(folder.path()).as_slice() {
            [] => assert_eq!(code, Some(130)),
            [name] if name == "out.ply" => {
                assert!(code == Some(0) || code == Some(130), "{code:?}");
                assert_eq!(soup(&output).faces.len(), 684 * 4usize.pow(5));
            }
            other => panic!("left behind: {other:?}"),
        }
    }
}
