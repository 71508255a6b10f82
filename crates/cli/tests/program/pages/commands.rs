//! Commands on pages: what `console` fences show is what the program says.
//!
//! The commands of a page run one after the other through a shell in a folder with the files of `examples/models`, so that one
//! can use what an earlier one wrote. What a command prints, on both streams, is compared line by line with what follows it on the page.
//! Durations are not compared, a line `...` is any number of lines, and an exit code other than 0 is a last line `exit code N`.
//! Pictures in the folder that is called as the page (`pictures/gallery` of `gallery.md`) are those that its commands draw, to the byte.
//! `LIMITMESH_REWRITE=1` puts what the program says into the page, and writes these pictures.

#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;

use super::links::targets;
use super::{Page, pages};
use crate::common::folder;
use crate::kept::{is_rewriting, root};

/// How the README calls the program, for those who have not installed it.
const FROM_SOURCE: &str = "cargo run --release -- ";

#[test]
fn commands_give_what_their_pages_show() {
    let pages = pages();
    let shown: Vec<&Page> = pages
        .iter()
        .filter(|page| page.text.contains("```console"))
        .collect();
    let wrong: Vec<String> = thread::scope(|scope| {
        let runs: Vec<_> = shown
            .iter()
            .map(|page| scope.spawn(|| checked(page)))
            .collect();
        runs.into_iter()
            .flat_map(|run| run.join().expect("a page is read to its end"))
            .collect()
    });
    assert!(
        wrong.is_empty(),
        "{}\nLIMITMESH_REWRITE=1 cargo test -p limitmesh-cli pages writes what the program says",
        wrong.join("\n")
    );
}

#[test]
fn what_can_run_is_run() {
    for page in pages() {
        let mut is_shell = false;
        for line in page.text.lines() {
            if line.starts_with("```") {
                is_shell = line == "```sh";
            }
            assert!(
                !(is_shell && line.starts_with("limitmesh ")),
                "not in a console fence, {}: {line}",
                page.name
            );
        }
    }
}

#[test]
fn elided_lines_are_any_number() {
    let fits = |shown: &[&str], said: &[&str]| {
        fits(
            shown,
            &said.iter().map(|&line| line.to_owned()).collect::<Vec<_>>(),
        )
    };
    assert!(fits(&["a", "...", "c"], &["a", "b", "b", "c"]));
    assert!(fits(&["...", "c"], &["c"]));
    assert!(fits(&["done in 3.2 ms"], &["done in 12 s"]));
    assert!(!fits(&["a", "...", "c"], &["a", "b"]));
    assert!(!fits(&["3 triangles"], &["4 triangles"]));
    assert!(!fits(&[], &["a"]));
}

/// Runs the commands of a page; gives what is wrong, or writes the page anew.
fn checked(page: &Page) -> Vec<String> {
    let folder = folder();
    for entry in std::fs::read_dir(root().join("examples/models")).expect("the example models") {
        let path = entry.expect("an entry").path();
        std::fs::copy(&path, folder.path().join(path.file_name().expect("a name")))
            .expect("copied");
    }
    let mut wrong = Vec::new();
    let mut anew = Vec::new();
    let mut lines = page.text.lines().peekable();
    let mut is_console = false;
    while let Some(line) = lines.next() {
        anew.push(line.to_owned());
        if line.starts_with("```") {
            is_console = line == "```console";
        }
        let Some(command) = line.strip_prefix("$ ").filter(|_| is_console) else {
            continue;
        };
        let mut shown = Vec::new();
        while let Some(line) =
            lines.next_if(|line| !line.starts_with("$ ") && !line.starts_with("```"))
        {
            shown.push(line);
        }
        // Lines without a word part commands.
        let blank = shown
            .iter()
            .rev()
            .take_while(|line| line.is_empty())
            .count();
        let shown = &shown[..shown.len() - blank];
        let said = said(command, folder.path());
        if fits(shown, &said) {
            anew.extend(shown.iter().map(|&line| line.to_owned()));
        } else {
            wrong.push(format!(
                "{}: $ {command}\nshown:\n{}\nsaid:\n{}\n",
                page.name,
                shown.join("\n"),
                said.join("\n")
            ));
            anew.extend(elided(said, shown));
        }
        anew.extend(std::iter::repeat_n(String::new(), blank));
    }
    if is_rewriting() && !wrong.is_empty() {
        std::fs::write(root().join(&page.name), anew.join("\n") + "\n")
            .expect("the page can be written");
        wrong.clear();
    }
    wrong.extend(pictures(page, folder.path()));
    wrong
}

/// Compares the pictures of a page with those that its commands have drawn; gives what is wrong, or writes them anew.
fn pictures(page: &Page, drawn: &Path) -> Vec<String> {
    let file = root().join(&page.name);
    let own = Path::new("pictures").join(file.file_stem().expect("a name"));
    let mut wrong = Vec::new();
    for target in targets(&page.text) {
        let target = Path::new(target);
        if target.parent() != Some(&own) {
            continue;
        }
        let kept = file.with_file_name("").join(target);
        let anew = std::fs::read(drawn.join(target.file_name().expect("a name")));
        match anew {
            Err(_) => wrong.push(format!(
                "{}: no command draws {}",
                page.name,
                target.display()
            )),
            Ok(anew) if is_rewriting() => std::fs::write(&kept, anew).expect("written"),
            Ok(anew) if std::fs::read(&kept).ok().as_ref() != Some(&anew) => {
                wrong.push(format!("{}: {} differs", page.name, target.display()));
            }
            Ok(_) => {}
        }
    }
    wrong
}

/// The output of a command, and its exit code if it is not 0.
fn said(command: &str, folder: &Path) -> Vec<String> {
    let command = match command.strip_prefix(FROM_SOURCE) {
        Some(arguments) => format!("limitmesh {arguments}"),
        None => command.to_owned(),
    };
    let program = Path::new(env!("CARGO_BIN_EXE_limitmesh"))
        .parent()
        .expect("a folder")
        .display();
    let path = std::env::var("PATH").unwrap_or_default();
    let run = Command::new("sh")
        .args(["-c", &format!("{{ {command}\n}} 2>&1")])
        .current_dir(folder)
        .env("PATH", format!("{program}:{path}"))
        .env("LC_ALL", "C")
        .stdin(Stdio::null())
        .output()
        .expect("a shell");
    let text = String::from_utf8(run.stdout).expect("output is UTF-8");
    let mut lines: Vec<String> = text
        .lines()
        .map(|line| line.trim_end().to_owned())
        .collect();
    if !run.status.success() {
        lines.push(run.status.code().map_or_else(
            || "ended by a signal".to_owned(),
            |code| format!("exit code {code}"),
        ));
    }
    while lines.last().is_some_and(String::is_empty) {
        lines.pop();
    }
    lines
}

/// A line that was said, or the one on the page that differs from it in durations alone.
fn as_shown(line: String, shown: &[&str]) -> String {
    let same = shown
        .iter()
        .find(|shown| without_durations(shown) == without_durations(&line));
    same.map_or(line, |&shown| shown.to_owned())
}

/// The messages, as the page would show them: they end after as many lines as there were if it ended with `...`.
fn elided(said: Vec<String>, shown: &[&str]) -> Vec<String> {
    let kept = if shown.last() == Some(&"...") {
        shown.len() - 1
    } else {
        said.len()
    };
    let rest = if kept < said.len() {
        vec!["...".to_owned()]
    } else {
        Vec::new()
    };
    said.into_iter()
        .take(kept)
        .map(|line| as_shown(line, shown))
        .chain(rest)
        .collect()
}

/// Whether lines on a page are those that were said.
fn fits(shown: &[&str], said: &[String]) -> bool {
    match shown.split_first() {
        None => said.is_empty(),
        Some((&"...", rest)) => (0..=said.len()).any(|skipped| fits(rest, &said[skipped..])),
        Some((line, rest)) => said.split_first().is_some_and(|(first, others)| {
            without_durations(line) == without_durations(first) && fits(rest, others)
        }),
    }
}

/// A line with `TIME` for each number that a unit of time follows; columns may be as wide as they like.
fn without_durations(line: &str) -> String {
    let mut words: Vec<&str> = Vec::new();
    for word in line.split_whitespace() {
        let unit = word.trim_end_matches([',', ';', ')', '.']);
        let number = words.last().map(|last| last.trim_start_matches('('));
        let is_number = number.is_some_and(|number| number.parse::<f64>().is_ok());
        if ["µs", "ms", "s"].contains(&unit) && is_number {
            words.pop();
            words.push("TIME");
        } else {
            words.push(word);
        }
    }
    words.join(" ")
}
