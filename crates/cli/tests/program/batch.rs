//! `limitmesh batch`: a line in, a line out, whatever happens in between.

use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{
    Running, TETRAHEDRON, bytes, command, done, file, folder, json_of, names, run, text,
    usage_error,
};

/// Writes jobs, a line each.
fn jobs(folder: &TempDir, jobs: &[Value]) -> std::path::PathBuf {
    let lines: Vec<String> = jobs.iter().map(Value::to_string).collect();
    file(folder, "jobs.jsonl", &(lines.join("\n") + "\n"))
}

/// The results by their order.
fn results(path: &Path) -> Vec<Value> {
    text(path)
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

/// A name below the folder, as text.
fn below(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).display().to_string()
}

/// A report without its times.
fn without_seconds(value: &mut Value) {
    match value {
        Value::Object(members) => {
            members.remove("seconds");
            members.values_mut().for_each(without_seconds);
        }
        Value::Array(items) => items.iter_mut().for_each(without_seconds),
        _ => {}
    }
}

#[test]
fn a_job_is_what_refine_does_with_its_options() {
    let folder = folder();
    let input = file(&folder, "in.obj", TETRAHEDRON).display().to_string();
    let out = |name: &str| below(&folder, &format!("made/here/{name}"));
    let list = jobs(
        &folder,
        &[
            json!({"input": input, "output": out("a.ply"), "tolerance": "1%", "picture": out("a.png")}),
            json!({"input": "builtin:cube", "output": out("b.obj"), "crease_angle": 30, "triangles": "1k"}),
            json!({"input": "builtin:cup", "output": out("c.ply"), "method": "limit-normal", "view": [0, 0, -1], "levels": 2}),
            json!({"input": "builtin:cup", "tolerance": "1%", "dry-run": true}),
        ],
    );
    let found = folder.path().join("results.jsonl");
    done("batch {} -o {} --jobs 3", &[&list, &found]).saying("4 of 4 jobs ended");
    let told = results(&found);
    let plain = [
        format!(
            "refine {input} -o {{}} --tolerance 1% --picture {}",
            below(&folder, "p.png")
        ),
        "refine builtin:cube -o {} --crease-angle 30 --triangles 1k".to_owned(),
        "refine builtin:cup -o {} --method limit-normal --view 0,0,-1 --levels 2".to_owned(),
    ];
    for (i, (words, name)) in plain.iter().zip(["a.ply", "b.obj", "c.ply"]).enumerate() {
        let own = folder.path().join(name);
        let mut report = json_of(&format!("{words} --report -"), &[&own]);
        without_seconds(&mut report);
        let mesh = bytes(out(name));
        assert!(mesh == bytes(&own), "{name}");
        report["output"]["path"] = out(name).into();
        assert_eq!(told[i]["report"], report, "{name}");
        assert_eq!(
            (&told[i]["line"], &told[i]["status"]),
            (&(i + 1).into(), &"done".into())
        );
        assert_eq!(told[i]["output_bytes"], mesh.len());
        assert_eq!(told[i]["key"].as_str().map(str::len), Some(64));
    }
    assert!(bytes(out("a.png")) == bytes(below(&folder, "p.png")));
    assert!(told[3]["report"]["estimate"]["triangles"].as_u64() > Some(100));
    assert_eq!(told[3]["output"], Value::Null);
    assert_eq!(
        names(&folder.path().join("made/here")),
        ["a.ply", "a.png", "b.obj", "c.ply"]
    );
    // Times are reported where they are asked for.
    let timed = folder.path().join("timed.jsonl");
    done("batch {} -o {} --seconds", &[&list, &timed]);
    assert!(results(&timed)[0]["report"]["seconds"]["total"].is_number());
}

#[test]
fn what_is_wrong_is_told_by_line_and_the_rest_is_done() {
    let folder = folder();
    let out = |name: &str| below(&folder, name);
    let bad = file(&folder, "bad.obj", "v 0 0 0\nf 1 2 3\n")
        .display()
        .to_string();
    let good = json!({"input": "builtin:cube", "output": out("good.ply"), "triangles": 100});
    let short = json!({"input": "builtin:cube", "output": out("short.ply"), "tolerance": 1e-9, "max-triangles": 500});
    let lines = [
        (good.to_string(), "done", ""),
        (String::new(), "", ""),
        ("{\"input\": ".to_owned(), "line", "column"),
        (
            json!({"input": "builtin:cube", "output": out("x.ply"), "optimise": 1}).to_string(),
            "line",
            "'optimise'",
        ),
        (
            json!({"input": "builtin:cube", "output": out("x.ply"), "tolerance": "-1"}).to_string(),
            "options",
            "above 0",
        ),
        (
            json!({"input": "builtin:cube", "output": out("w.ply"), "limit": true}).to_string(),
            "options",
            "--limit",
        ),
        (
            json!({"input": "builtin:cube", "output": out("x.doc")}).to_string(),
            "options",
            "'doc'",
        ),
        (
            json!({"input": out("none.stl"), "output": out("x.ply")}).to_string(),
            "line",
            "what line 5 writes",
        ),
        (
            json!({"input": out("none.stl"), "output": out("y.ply")}).to_string(),
            "file",
            "none.stl",
        ),
        (
            json!({"input": bad, "output": out("z.ply")}).to_string(),
            "file",
            "bad.obj",
        ),
        (
            json!({"input": "builtin:cup", "output": out("good.ply")}).to_string(),
            "line",
            "what line 1 writes",
        ),
        (
            json!({"input": "builtin:cup", "output": bad}).to_string(),
            "line",
            "the input of a job",
        ),
        (
            json!({"input": "builtin:cup", "output": out("jobs.jsonl")}).to_string(),
            "line",
            "the jobs or the results",
        ),
        (
            short.to_string(),
            "stopped-short",
            "--max-triangles 500 was reached",
        ),
    ];
    let all: Vec<&str> = lines.iter().map(|(line, ..)| line.as_str()).collect();
    let list = file(&folder, "jobs.jsonl", &all.join("\n"));
    let found = folder.path().join("results.jsonl");
    run("batch {} -o {}", &[&list, &found])
        .expect(1)
        .saying("line 10: error (file)")
        .saying("11 of 13 jobs failed");
    let expected = lines
        .iter()
        .enumerate()
        .filter(|(_, (line, ..))| !line.is_empty());
    let told = results(&found);
    assert_eq!(told.len(), expected.clone().count());
    for ((i, (line, how, words)), told) in expected.zip(&told) {
        assert_eq!(told["line"], i + 1);
        let (status, why) = match told["status"].as_str() {
            Some("failed") => (&told["error"]["kind"], &told["error"]["message"]),
            _ => (&told["status"], &told["why"]),
        };
        assert_eq!(status, how, "{line}: {told}");
        assert!(
            why.as_str().unwrap_or_default().contains(words),
            "{line}: {told}"
        );
    }
    assert_eq!(
        names(folder.path()),
        [
            "bad.obj",
            "good.ply",
            "jobs.jsonl",
            "results.jsonl",
            "short.ply"
        ]
    );
    // What failed is tried again, to the same end.
    let before = text(&found);
    run("batch {} -o {} --resume", &[&list, &found])
        .expect(1)
        .saying("2 kept from before");
    assert_eq!(text(&found), before);
    std::fs::write(&bad, TETRAHEDRON).expect("mended");
    run("batch {} -o {} --resume --quiet", &[&list, &found])
        .expect(1)
        .saying("10 of 13 jobs failed");
    assert_eq!(results(&found)[8]["status"], "done");
}

#[test]
fn jobs_that_take_too_much_do_not_take_the_others_along() {
    let folder = folder();
    let out = |name: &str| below(&folder, name);
    // A thousand million triangles: gigabytes within seconds, and minutes on any machine.
    let long = json!({"input": "builtin:bunny", "output": out("long.ply"), "method": "uniform", "levels": 10,
        "max-triangles": "2G"});
    let good = json!({"input": "builtin:cube", "output": out("good.ply"), "triangles": 100});
    let list = jobs(&folder, &[long, good]);
    let found = folder.path().join("results.jsonl");
    run("batch {} -o {} --time-limit 0.7 --jobs 2", &[&list, &found]).expect(1);
    let told = results(&found);
    assert_eq!(
        (&told[0]["error"]["kind"], &told[0]["error"]["limit"]),
        (&"time".into(), &0.7.into())
    );
    assert_eq!(told[1]["status"], "done");
    let before = text(&found);
    // A limit that is not higher is not tried again, one that is higher is.
    run("batch {} -o {} --time-limit 0.5 --resume", &[&list, &found])
        .expect(1)
        .saying("2 kept from before");
    assert_eq!(text(&found), before);
    if cfg!(target_os = "linux") {
        let words = "batch {} -o {} --memory-limit 64M --resume";
        run(words, &[&list, &found])
            .expect(1)
            .saying("1 kept from before")
            .saying("error (memory)");
        let told = results(&found);
        assert_eq!(
            (&told[0]["error"]["kind"], &told[0]["error"]["limit"]),
            (&"memory".into(), &(64 << 20).into())
        );
        run(words, &[&list, &found])
            .expect(1)
            .saying("2 kept from before");
    }
    assert_eq!(
        names(folder.path()),
        ["good.ply", "jobs.jsonl", "results.jsonl"]
    );
}

#[test]
fn results_are_kept_where_nothing_changed() {
    let folder = folder();
    let (one, two) = (
        file(&folder, "one.obj", TETRAHEDRON),
        file(&folder, "two.obj", TETRAHEDRON),
    );
    let out = |name: &str| below(&folder, name);
    let of = |input: &Path, output: &str, tolerance: &str| json!({"input": input.display().to_string(), "output": out(output), "tolerance": tolerance});
    let (a, b) = (of(&one, "a.ply", "1%"), of(&two, "b.ply", "1%"));
    let list = jobs(&folder, &[a.clone(), b.clone()]);
    let found = folder.path().join("results.jsonl");
    done("batch {} -o {} --resume", &[&list, &found]);
    let told = results(&found);
    // The key depends on all that decides on a result, wherever it is.
    assert_eq!(told[0]["key"], told[1]["key"]);
    run("batch {} -o {}", &[&list, &found])
        .expect(1)
        .saying("--resume goes on with it");
    let kept = |count: usize| {
        let told = done("batch {} -o {} --resume", &[&list, &found]).stderr;
        let words = if count == 0 {
            "jobs ended;".to_owned()
        } else {
            format!(" {count} kept from before")
        };
        assert!(told.contains(&words), "{told}");
    };
    kept(2);
    // The jobs changed their places, and one was added.
    jobs(&folder, &[of(&one, "c.ply", "1%"), b.clone(), a.clone()]);
    kept(2);
    assert_eq!(results(&found)[2]["output"], out("a.ply"));
    assert_eq!(results(&found)[2]["line"], 3);
    jobs(&folder, &[b.clone(), of(&one, "a.ply", "2%")]);
    kept(1);
    assert_eq!(results(&found).len(), 2);
    std::fs::remove_file(out("b.ply")).expect("a mesh");
    kept(1);
    std::fs::write(&two, TETRAHEDRON.replace("1 0 0", "2 0 0")).expect("changed");
    kept(1);
    kept(2);
}

/// Waits until the results have so many lines.
fn until_results(running: &mut Running, lines: usize, path: &Path) {
    running.until("results", || {
        std::fs::read_to_string(path)
            .unwrap_or_default()
            .lines()
            .count()
            >= lines
    });
}

/// Jobs of some tenths of a second into a folder, and the results of an undisturbed batch.
fn disturbed(folder: &TempDir, to: &str) -> (std::path::PathBuf, Vec<String>) {
    let models = [
        "head", "cup", "shoe", "bunny", "teddy", "sphere", "cube", "radish",
    ];
    let mut outputs: Vec<String> = models
        .iter()
        .map(|model| below(folder, &format!("{to}/{model}.ply")))
        .collect();
    outputs.sort();
    let all = models.iter().zip(
        models
            .iter()
            .map(|model| below(folder, &format!("{to}/{model}.ply"))),
    );
    let all = all.map(|(model, output)| {
        json!({"input": format!("builtin:{model}"), "output": output, "tolerance": "0.02%"})
    });
    (jobs(folder, &all.collect::<Vec<_>>()), outputs)
}

#[test]
fn killed_twice_and_resumed_it_gives_the_same_bytes() {
    let folder = folder();
    let (list, outputs) = disturbed(&folder, "out");
    let (found, again) = (
        folder.path().join("found.jsonl"),
        folder.path().join("again.jsonl"),
    );
    done("batch {} -o {} --jobs 1", &[&list, &found]);
    let meshes =
        |outputs: &[String]| -> Vec<Vec<u8>> { outputs.iter().map(|path| bytes(path)).collect() };
    let whole = meshes(&outputs);
    std::fs::remove_dir_all(below(&folder, "out")).expect("meshes");
    for (lines, processes) in [(2, 2), (5, 3)] {
        let mut running = Running::start(
            &format!("batch {{}} -o {{}} --jobs {processes} --resume --quiet"),
            &[&list, &again],
        );
        until_results(&mut running, lines, &again);
        // SIGKILL.
        drop(running);
        // Killed while it wrote a line.
        let cut = text(&again);
        std::fs::write(&again, &cut[..cut.len() - 3]).expect("cut");
    }
    done("batch {} -o {} --jobs 2 --resume", &[&list, &again]);
    assert_eq!(text(&again), text(&found));
    assert!(meshes(&outputs) == whole);
}

/// Whether a process has this word on its command line.
#[cfg(target_os = "linux")]
fn is_running(word: &str) -> bool {
    let processes = std::fs::read_dir("/proc")
        .expect("a folder")
        .filter_map(Result::ok);
    let mut lines = processes.filter_map(|own| std::fs::read(own.path().join("cmdline")).ok());
    lines.any(|line| String::from_utf8_lossy(&line).contains(word))
}

#[cfg(target_os = "linux")]
#[test]
fn jobs_do_not_outlive_a_batch_that_is_killed() {
    let folder = folder();
    let output = below(&folder, "long.ply");
    let list = jobs(
        &folder,
        &[json!({"input": "builtin:bunny", "output": output, "tolerance": 1e-12})],
    );
    let running = Running::start(
        "batch {} -o {}",
        &[&list, &folder.path().join("found.jsonl")],
    );
    let wait_until = |expected: bool| {
        let start = Instant::now();
        while is_running(&output) != expected {
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "running is not {expected}"
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    wait_until(true);
    drop(running);
    wait_until(false);
    assert_eq!(names(folder.path()), ["found.jsonl", "jobs.jsonl"]);
}

#[test]
fn jobs_come_from_standard_input_and_results_go_to_standard_output_in_order() {
    let folder = folder();
    let (list, outputs) = disturbed(&folder, "out");
    let mut child = command("batch - -o - --jobs 3 --quiet", &[])
        .stdin(std::fs::File::open(&list).expect("a file"))
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut told = String::new();
    std::io::Read::read_to_string(child.stdout.as_mut().expect("piped"), &mut told).expect("text");
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
    let found = folder.path().join("found.jsonl");
    done("batch {} -o {} --resume", &[&list, &found]);
    assert_eq!(told, text(&found));
    assert_eq!(told.lines().count(), outputs.len());
    usage_error("batch {} -o - --resume", &[&list], "--resume");
}

#[test]
fn shards_have_each_job_once() {
    let folder = folder();
    let out = |name: &str| below(&folder, name);
    let job = |name: &str, tolerance: &str| json!({"input": format!("builtin:{name}"), "output": out(&format!("{name}.ply")), "tolerance": tolerance});
    let lines = [
        job("cube", "1%").to_string(),
        job("cup", "1%").to_string(),
        String::new(),
        "no job".to_owned(),
        job("head", "2%").to_string(),
        // The first of another shard writes that file.
        job("cube", "2%").to_string(),
        job("radish", "-1").to_string(),
    ];
    let list = file(&folder, "jobs.jsonl", &lines.join("\n"));
    let whole = folder.path().join("whole.jsonl");
    run("batch {} -o {}", &[&list, &whole]).expect(1);
    let meshes = || ["cube", "cup", "head"].map(|name| bytes(out(&format!("{name}.ply"))));
    let expected = meshes();
    ["cube", "cup", "head"]
        .iter()
        .for_each(|name| std::fs::remove_file(out(&format!("{name}.ply"))).expect("a mesh"));
    for count in [1, 2, 3, 8] {
        let mut merged = Vec::new();
        for index in 0..count {
            let part = folder.path().join(format!("{index}-of-{count}.jsonl"));
            let words = format!("batch {{}} -o {{}} --quiet --shard {index}/{count}");
            run(&words, &[&list, &part]);
            let told = text(&part);
            let lines = told.lines().map(|line| (json_line(line), line.to_owned()));
            merged.extend(lines.inspect(|(line, _)| assert_eq!((line - 1) % count, index)));
        }
        merged.sort();
        let merged: String = merged.iter().map(|(_, line)| format!("{line}\n")).collect();
        assert_eq!(merged, text(&whole), "{count} shards");
        assert!(meshes() == expected, "{count} shards");
    }
    for (shard, words) in [
        ("2/2", "of 2 the last shard is 1"),
        ("0/0", "at least 1 shard"),
        ("1", "give I/N"),
        ("-1/2", "give I/N"),
    ] {
        usage_error(&format!("batch {{}} -o - --shard={shard}"), &[&list], words);
    }
}

/// The number of the line in a result.
fn json_line(result: &str) -> u64 {
    let result: Value = serde_json::from_str(result).expect("JSON");
    result["line"].as_u64().expect("a number")
}

#[test]
fn files_that_are_no_results_and_jobs_that_are_not_there_are_refused() {
    let folder = folder();
    let list = jobs(
        &folder,
        &[json!({"input": "builtin:cube", "output": below(&folder, "x.ply")})],
    );
    let notes = file(&folder, "notes.txt", "dear diary\n");
    run("batch {} -o {} --resume", &[&list, &notes])
        .expect(1)
        .saying("line 1 is no result");
    assert_eq!(text(&notes), "dear diary\n");
    let none = folder.path().join("none.jsonl");
    run("batch {} -o {}", &[&none, &folder.path().join("r.jsonl")])
        .expect(1)
        .saying("none.jsonl");
    usage_error("batch {} -o {} --time-limit 0", &[&list, &none], "above 0");
    assert_eq!(names(folder.path()), ["jobs.jsonl", "notes.txt"]);
    // No jobs at all.
    let empty = file(&folder, "empty.jsonl", "\n\n");
    done("batch {} -o {}", &[&empty, &none]);
    assert_eq!(text(&none), "");
}
