//! Running the program from tests: a command line in; exit code, output and messages out, within a time limit.

#![allow(clippy::panic, reason = "a test's helpers fail the test")]

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use limitmesh::PolygonSoup;
use serde_json::Value;
use tempfile::TempDir;

/// A text that has words in it; it is shown where it has not.
macro_rules! says {
    ($text:expr, $words:expr) => {
        assert!($text.contains($words), "no '{}' in:\n{}", $words, $text)
    };
}

/// A text that has not the words in it.
macro_rules! silent {
    ($text:expr, $words:expr) => {
        assert!(!$text.contains($words), "'{}' in:\n{}", $words, $text)
    };
}

/// Longer than any command takes here, and short enough to notice one that hangs.
const TIME_LIMIT: Duration = Duration::from_secs(120);

/// Corners in the order of the axes, faces counter-clockwise from outside.
pub(crate) const OCTAHEDRON: &str = "v 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\n\
    f 1 2 3\nf 2 4 3\nf 4 5 3\nf 5 1 3\nf 2 1 6\nf 4 2 6\nf 5 4 6\nf 1 5 6\n";

pub(crate) const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// The result of a run of the program.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    /// This run, if it ended with this code.
    #[track_caller]
    pub(crate) fn expect(self, code: i32) -> Self {
        assert_eq!(
            self.code,
            Some(code),
            "stdout:\n{}\nstderr:\n{}",
            self.stdout,
            self.stderr
        );
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e} in:\n{}", self.stdout))
    }

    /// This run, if its messages contain `words`.
    #[track_caller]
    pub(crate) fn saying(self, words: &str) -> Self {
        assert!(
            self.stderr.contains(words),
            "expected '{words}' in:\n{}",
            self.stderr
        );
        self
    }
}

/// The program with arguments separated by spaces, and paths put in for `{}` in turn.
pub(crate) fn command(arguments: &str, paths: &[&Path]) -> Command {
    let mut paths = paths.iter();
    let mut command = Command::new(env!("CARGO_BIN_EXE_limitmesh"));
    for word in arguments.split_whitespace() {
        match word {
            "{}" => command.arg(paths.next().expect("a path for each {}")),
            word => command.arg(word),
        };
    }
    command.stdin(Stdio::null());
    command
}

/// Runs the program to its end; one that takes too long is ended and fails the test.
#[track_caller]
pub(crate) fn run(arguments: &str, paths: &[&Path]) -> Run {
    let mut child = command(arguments, paths)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let stdout = read_all(child.stdout.take());
    let stderr = read_all(child.stderr.take());
    let code = wait(&mut child, arguments);
    let text = |reader: thread::JoinHandle<Vec<u8>>| {
        String::from_utf8(reader.join().expect("read")).expect("output is UTF-8")
    };
    Run {
        code,
        stdout: text(stdout),
        stderr: text(stderr),
    }
}

/// Runs the program, which must do all that is asked of it.
#[track_caller]
pub(crate) fn done(arguments: &str, paths: &[&Path]) -> Run {
    run(arguments, paths).expect(0)
}

/// The standard output of [`done`], as JSON.
#[track_caller]
pub(crate) fn json_of(arguments: &str, paths: &[&Path]) -> Value {
    done(arguments, paths).json()
}

/// Runs the program, which must refuse its command line with these words.
#[track_caller]
pub(crate) fn usage_error(arguments: &str, paths: &[&Path], words: &str) -> Run {
    run(arguments, paths).expect(2).saying(words)
}

/// Runs command lines that are refused, one a row: the exit code, the command with names of paths in braces, and words that are said.
#[track_caller]
pub(crate) fn refuses(paths: &[(&str, &Path)], table: &str) {
    for row in table.lines().filter(|row| !row.trim().is_empty()) {
        let columns: Vec<&str> = row.split('|').map(str::trim).collect();
        let [code, line, said] = columns[..] else {
            panic!("three columns in {row}")
        };
        let own = line.split(['{', '}']).skip(1).step_by(2);
        let named = |name: &str| paths.iter().find(|own| own.0 == name).expect("a path").1;
        let own: Vec<&Path> = own.map(named).collect();
        let line = paths.iter().fold(line.to_owned(), |line, (name, _)| {
            line.replace(&format!("{{{name}}}"), "{}")
        });
        run(&line, &own)
            .expect(code.parse().expect("a code"))
            .saying(said);
    }
}

/// The program at work; it is killed when this goes.
pub(crate) struct Running(Child);

impl Running {
    pub(crate) fn start(arguments: &str, paths: &[&Path]) -> Self {
        let mut command = command(arguments, paths);
        Self(
            command
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .expect("the program starts"),
        )
    }

    /// Waits until something holds; before that the program must not end.
    #[track_caller]
    pub(crate) fn until(&mut self, what: &str, holds: impl Fn() -> bool) {
        let start = Instant::now();
        while !holds() {
            let ended = self.0.try_wait().expect("a child can be waited for");
            assert!(ended.is_none() || holds(), "{what}: it has ended before");
            assert!(
                start.elapsed() < TIME_LIMIT,
                "{what}: nothing for {TIME_LIMIT:?}"
            );
            thread::sleep(Duration::from_millis(1));
        }
    }

    /// Sends it a signal, `TERM` for instance.
    #[cfg(unix)]
    #[track_caller]
    pub(crate) fn signal(&self, name: &str) {
        let kill = Command::new("kill")
            .args([&format!("-{name}"), &self.0.id().to_string()])
            .status();
        assert!(kill.expect("kill").success());
    }

    /// Waits for its end; what it said on standard output is not known.
    #[track_caller]
    pub(crate) fn end(mut self) -> Run {
        let stderr = read_all(self.0.stderr.take());
        let code = wait(&mut self.0, "to its end");
        let stderr = String::from_utf8(stderr.join().expect("read")).expect("output is UTF-8");
        Run {
            code,
            stdout: String::new(),
            stderr,
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn read_all(stream: Option<impl Read + Send + 'static>) -> thread::JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        stream
            .expect("piped")
            .read_to_end(&mut bytes)
            .expect("readable");
        bytes
    })
}

fn wait(child: &mut Child, what: &str) -> Option<i32> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child can be waited for") {
            return status.code();
        }
        if start.elapsed() > TIME_LIMIT {
            child.kill().expect("a child can be ended");
            panic!("limitmesh {what} took more than {TIME_LIMIT:?}");
        }
        thread::sleep(Duration::from_millis(5));
    }
}

/// A folder that goes when the test ends.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Names of the files in a folder, sorted.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|e| {
            e.expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

/// Writes a file and gives its path.
pub(crate) fn file(folder: &TempDir, name: &str, content: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).expect("writable");
    path
}

/// The text of a file.
#[track_caller]
pub(crate) fn text(path: impl AsRef<Path>) -> String {
    String::from_utf8(bytes(path)).expect("text")
}

#[track_caller]
pub(crate) fn bytes(path: impl AsRef<Path>) -> Vec<u8> {
    std::fs::read(path.as_ref()).unwrap_or_else(|e| panic!("{}: {e}", path.as_ref().display()))
}

#[track_caller]
pub(crate) fn json_file(path: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&bytes(path)).expect("JSON")
}

#[track_caller]
pub(crate) fn is_png(path: &Path) {
    assert!(bytes(path).starts_with(b"\x89PNG"), "{}", path.display());
}

#[track_caller]
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[track_caller]
pub(crate) fn count(value: &Value) -> u64 {
    value.as_u64().expect("a count")
}

#[track_caller]
pub(crate) fn words(value: &Value) -> &str {
    value.as_str().expect("words")
}

#[track_caller]
pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

/// The topology of a mesh file by its own indices, counted here from scratch.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) boundary_edges: u64,
    pub(crate) non_manifold_edges: u64,
    pub(crate) euler_characteristic: i64,
}

/// A small file that is kept with the tests.
pub(crate) fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// Reads a mesh back.
#[track_caller]
pub(crate) fn soup(path: &Path) -> PolygonSoup {
    limitmesh_io::read(path).expect("what was written can be read")
}

/// Counts the elements of triangles.
pub(crate) fn counts(soup: &PolygonSoup) -> Counts {
    let mut edges = std::collections::BTreeMap::<[u32; 2], u64>::new();
    for face in soup.faces.iter() {
        assert_eq!(face.len(), 3, "triangles are written");
        for i in 0..3 {
            let (a, b) = (face[i], face[(i + 1) % 3]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let having =
        |test: fn(u64) -> bool| edges.values().filter(|&&faces| test(faces)).count() as u64;
    let vertices = soup.positions.len() as u64;
    let triangles = soup.faces.len() as u64;
    Counts {
        vertices,
        triangles,
        boundary_edges: having(|faces| faces == 1),
        non_manifold_edges: having(|faces| faces > 2),
        euler_characteristic: vertices as i64 - edges.len() as i64 + triangles as i64,
    }
}

/// The counts that a report claims of its output.
pub(crate) fn claimed(output: &Value) -> Counts {
    let count = |key: &str| {
        output[key]
            .as_u64()
            .unwrap_or_else(|| panic!("{key} in {output}"))
    };
    Counts {
        vertices: count("vertices"),
        triangles: count("triangles"),
        boundary_edges: count("boundary_edges"),
        non_manifold_edges: count("non_manifold_edges"),
        euler_characteristic: output["euler_characteristic"].as_i64().expect("a number"),
    }
}
