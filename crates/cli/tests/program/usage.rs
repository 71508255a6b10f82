//! Wrong command lines: exit code 2, a message that says what is wrong, and no file touched.

use crate::common::{done, folder, names, refuses, run, usage_error};

#[test]
fn nothing_to_do_is_a_usage_error() {
    usage_error("", &[], "Usage: limitmesh");
    usage_error("polish x.obj", &[], "polish");
    usage_error("refine", &[], "INPUT");
}

#[test]
fn help_and_version_are_printed() {
    let help = done("--help", &[]).stdout;
    for command in [
        "refine",
        "measure",
        "compare",
        "render",
        "info",
        "models",
        "batch",
        "Exit codes",
    ] {
        assert!(help.contains(command), "{command} in:\n{help}");
    }
    let help = done("refine --help", &[]).stdout;
    for word in [
        "degrees",
        "default: 3",
        "Examples:",
        "limit-normal",
        "silhouette",
        "--tolerance",
        "0.1%",
    ] {
        assert!(help.contains(word), "{word} in:\n{help}");
    }
    let version = done("--version", &[]).stdout;
    assert_eq!(
        version.trim(),
        concat!("limitmesh ", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn the_short_help_shows_what_most_people_need() {
    let help = done("refine -h", &[]).stdout;
    let is_option = |line: &&str| line.trim_start().starts_with('-') && line.starts_with("  ");
    let options: Vec<&str> = help.lines().filter(is_option).collect();
    at_most!(options.len(), 20, "{help}");
    above!(options.len(), 12, "{help}");
    for option in [
        "--output",
        "--tolerance",
        "--triangles",
        "--crease-angle",
        "--picture",
    ] {
        assert!(
            options.iter().any(|line| line.contains(option)),
            "{option} in:\n{help}"
        );
    }
    let whole = done("refine --help", &[]).stdout;
    for option in [
        "--provenance",
        "--attribute-tolerance",
        "--max-memory",
        "--weld-ignores",
    ] {
        assert!(whole.contains(option) && !help.contains(option), "{option}");
    }
}

/// A command offers the schemes that it takes, and no others.
#[test]
fn help_offers_the_schemes_that_there_are() {
    for command in [
        "render builtin:cube -o x.png --exact",
        "project builtin:cube --onto builtin:cube",
    ] {
        let name = command.split(' ').next().expect("a command");
        let help = done(&format!("{name} --help"), &[]).stdout;
        says!(help, "loop-warren");
        silent!(help, "butterfly");
        let line = format!("{command} --scheme butterfly");
        usage_error(&line, &[], "loop, loop-warren, catmull-clark]");
    }
}

/// A line on how commands are written helps who wrote an option wrong, and nobody who asked for what makes no sense.
#[test]
fn usage_is_shown_for_what_is_written_wrong_alone() {
    let shown = |words: &str| run(words, &[]).expect(2).stderr.contains("Usage:");
    for written_wrong in [
        "refine",
        "refine builtin:cup -o x.ply --tolerence 1",
        "measure builtin:cup",
    ] {
        assert!(shown(written_wrong), "{written_wrong}");
    }
    for makes_no_sense in [
        "refine builtin:cup -o x.ply --levels 0",
        "refine builtin:cup -o x.vtk",
        "refine builtin:cup -o x.ply --tolerance 0",
        "refine builtin:cup -o x.ply --angle 5 --view 0,0,1 --view @0,0,1",
        "render builtin:cup -o x.png --flat --smooth",
        "lod builtin:cup -o -",
    ] {
        assert!(!shown(makes_no_sense), "{makes_no_sense}");
    }
}

/// Hints for a unit apart from its number, a folder for a file, or a file without a command.
#[test]
fn slips_are_answered_with_what_was_meant() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for unit in ["mm", "in", "%"] {
        let line = format!("refine builtin:cup {unit} -o {{}} --tolerance 0.02");
        let said = run(&line, &[&output]).expect(2);
        said.saying(&format!("such as 0.1{unit}"));
    }
    usage_error(
        "refine {} -o {}",
        &[folder.path(), &output],
        "is a folder; give its files, such as",
    );
    usage_error("peg.stl", &[], "`limitmesh refine peg.stl` smooths a file");
}

#[test]
fn options_out_of_range_are_refused_before_any_work() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let wrong = [
        ("--angle 0", "above 0"),
        ("--method uniform --levels 13", "12 steps are the most"),
        ("--levels two", "whole number"),
        ("--view 0,0,0", "no direction"),
        (
            "--angle 5 --view 0,0,1 --view @0,0,1",
            "one direction or eye",
        ),
        ("--dilatation 2", "it needs --view"),
        ("--view 0,0,1 --dilatation -1", "at least 0"),
        ("--view 0,0,1 --method amresh", "limit-normal"),
        ("--view @0,0,1 --method uniform", "limit-normal"),
        ("--method uniform --angle 5", "divides every face"),
        ("--max-triangles 0", "at least 1"),
        ("--tolerance 0", "above 0"),
        ("--triangles 0", "at least 1"),
        ("--triangles -5", "'-5' is not a whole number"),
        ("--levels -3", "'-3' is not a whole number"),
        ("--threads -1", "'-1' is not a whole number"),
        ("--tolerance 0,02", "a length such as 0.05 or 0.05mm"),
        ("--tolerance 1furlong", "a length such as 0.05 or 0.05mm"),
        ("--levels 0", "goals need 1"),
        ("--levels 25", "at most 24"),
        ("--limit", "lie on the limit surface"),
        ("--method uniform --tolerance 1", "--method exact"),
        ("--method amresh --triangles 1000", "--method exact"),
        ("--method limit-normal --provenance", "--method exact"),
        ("--pixels 1", "a camera in --view"),
        ("--pixels 0 --view 0,0,5,0,0,0,0,1,0,40,800x600", "above 0"),
        ("--view 0,0,5,1", "eye, target and up"),
        ("--optimize --angle 5", "--optimize"),
        ("--optimize --balance", "--optimize"),
        ("--method uniform --optimize", "--method exact"),
        ("--max-memory 0", "at least one byte"),
        ("--view 0,0,1", "--angle"),
        ("--dry-run --picture p.png", "--dry-run"),
        ("--method uniform --dry-run", "--method exact"),
        ("--method limit-normal --balance", "--method exact"),
        ("--weld -1", "at least 0"),
        ("--scheme catmull", "loop-warren"),
        ("--picture p.jpg", ".png"),
        ("--threads 100000", "at most"),
    ];
    for (options, words) in wrong {
        let line = format!("refine builtin:head -o {{}} {options}");
        usage_error(&line, &[&output], words);
    }
    usage_error(
        "refine builtin:head -o {} --provenance",
        &[&folder.path().join("out.obj")],
        "PLY",
    );
    let other = folder.path().join("out.vtk");
    usage_error("refine builtin:head -o {}", &[&other], "'vtk'").saying(".ply");
    usage_error(
        "refine builtin:head -o {} --report {}",
        &[&output, &output],
        "twice",
    );
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn measuring_needs_exactly_one_reference() {
    refuses(
        &[],
        "
        2 | measure builtin:head |
        2 | measure builtin:head builtin:cup --limit-of builtin:head | cannot be used with
        2 | measure builtin:head builtin:cup --reference-levels 3 | --limit-of",
    );
    for option in [
        "--crease-angle 30",
        "--creases-from normals",
        "--scheme loop",
        "--interpolate",
    ] {
        let name = option.split(' ').next().expect("a name");
        usage_error(
            &format!("measure builtin:head builtin:cup {option}"),
            &[],
            &format!("{name} belongs to a limit surface; it needs --limit-of"),
        );
    }
    refuses(
        &[],
        "
        2 | measure builtin:head builtin:cup --samples 0 | at least 1
        2 | measure builtin:head --limit-of builtin:head --reference-levels 12 | levels are possible
        2 | measure builtin:head --limit-of builtin:head --reference-levels 0 | would measure against the control mesh's own triangles",
    );
}

#[test]
fn an_empty_file_is_called_that() {
    let folder = folder();
    for name in ["empty.glb", "empty.gltf", "empty.3mf", "empty.obj"] {
        let input = folder.path().join(name);
        std::fs::write(&input, b"").expect("written");
        for (command, output) in [
            ("info {}", ""),
            ("refine {} -o {}", "out.glb"),
            ("render {} -o {}", "out.png"),
            ("lod {} -o {}", "out.glb"),
        ] {
            let output = folder.path().join(output);
            run(command, &[&input, &output])
                .expect(1)
                .saying(&format!("{name}: the file is empty"));
        }
    }
}

#[test]
fn an_unknown_built_in_model_lists_those_there_are() {
    let run = run("info builtin:dragon", &[]).expect(1).saying("dragon");
    for model in limitmesh_models::all() {
        assert!(
            run.stderr.contains(model.name),
            "{} in {}",
            model.name,
            run.stderr
        );
    }
}

#[test]
fn a_missing_file_is_named() {
    let run = run("info no-such-file.obj", &[])
        .expect(1)
        .saying("no-such-file.obj");
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    assert_eq!(run.stdout, "");
}
