//! The file of results: lines are added as jobs end, so that nothing done is lost however the program ends; when all are there,
//! they are put into the order of the jobs, as one new file.

use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, bail, ensure};
use serde::Deserialize;

use super::status::Kind;
use crate::interrupt;
use crate::output;

/// Where a line stands in the file, without its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    start: u64,
    length: usize,
}

/// A result that was there.
#[derive(Debug)]
pub(super) struct Earlier {
    pub(super) place: Place,
    /// Whether a cap was reached before what was asked for.
    pub(super) is_short: bool,
    /// Of a job that is done, or stopped short; a dry run has none.
    pub(super) output_bytes: Option<u64>,
    /// Of a job that failed: of what kind, and at which limit.
    pub(super) failed: Option<(Kind, Option<f64>)>,
}

/// Earlier results by key, input and output.
pub(super) type EarlierResults = HashMap<(String, String, Option<String>), Earlier>;

/// Where results go.
pub(super) enum Results {
    File(ResultFile),
    Stream(Stream),
}

impl Results {
    /// Makes ready for results; gives those that are there already.
    ///
    /// # Errors
    /// The file cannot be written, is in use, or holds something else; there are results, and nobody asked to go on with them.
    pub(super) fn open(path: &Path, resumes: bool) -> anyhow::Result<(Self, EarlierResults)> {
        if output::is_standard_output(path) {
            return Ok((Self::Stream(Stream::default()), HashMap::new()));
        }
        let (file, earlier) = ResultFile::open(path, resumes)?;
        Ok((Self::File(file), earlier))
    }

    /// Adds the result of the job on a line, a JSON object.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn add(&mut self, line: usize, mut result: String) -> anyhow::Result<()> {
        match self {
            Self::File(own) => {
                result.push('\n');
                own.add(line, &result)
            }
            Self::Stream(own) => own.add(line, result),
        }
    }

    /// Keeps an earlier result for the job on a line.
    pub(super) fn keep(&mut self, line: usize, earlier: Place) {
        if let Self::File(own) = self {
            own.lines.insert(line, earlier);
        }
    }

    /// Says that there is nothing to wait for before the result of a line.
    pub(super) fn expect(&mut self, line: usize) {
        if let Self::Stream(own) = self {
            own.expected.insert(line, None);
        }
    }

    /// All jobs have ended.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn finish(self) -> anyhow::Result<()> {
        match self {
            Self::File(own) => own.finish(),
            Self::Stream(_) => Ok(()),
        }
    }
}

/// Standard output: results wait for those of earlier jobs.
#[derive(Default)]
pub(super) struct Stream {
    expected: BTreeMap<usize, Option<String>>,
}

impl Stream {
    fn add(&mut self, line: usize, result: String) -> anyhow::Result<()> {
        self.expected.insert(line, Some(result));
        while let Some((line, result)) = self.expected.pop_first() {
            let Some(result) = result else {
                self.expected.insert(line, None);
                break;
            };
            output::print(&result)?;
        }
        Ok(())
    }
}

/// A file of results.
pub(super) struct ResultFile {
    path: PathBuf,
    file: File,
    end: u64,
    /// Results by the lines of their jobs.
    lines: BTreeMap<usize, Place>,
}

/// The part of a result that counts when a batch is resumed.
#[derive(Deserialize)]
struct Known {
    key: Option<String>,
    input: Option<String>,
    output: Option<String>,
    status: String,
    output_bytes: Option<u64>,
    error: Option<KnownError>,
}

#[derive(Deserialize)]
struct KnownError {
    kind: Kind,
    limit: Option<f64>,
}

/// A batch that was killed while it started a process holds its file until that is another program: for some milliseconds, longer on a machine
/// that is busy.
const RELEASED: Duration = Duration::from_secs(2);
const TRIED_AGAIN: Duration = Duration::from_millis(20);

/// How each line begins, before the number.
const START: &str = "{\"line\":";

impl ResultFile {
    fn open(path: &Path, resumes: bool) -> anyhow::Result<(Self, EarlierResults)> {
        let name = path.display();
        output::check_writable(path)?;
        let mut options = OpenOptions::new();
        let file = options.read(true).append(true).create(true).open(path);
        let file = file.with_context(|| format!("{name} cannot be written"))?;
        let end = Instant::now() + RELEASED;
        // Some file systems have no locks.
        while let Err(TryLockError::WouldBlock) = file.try_lock() {
            ensure!(Instant::now() < end, "{name} is in use by another batch");
            std::thread::sleep(TRIED_AGAIN);
        }
        let length = file
            .metadata()
            .with_context(|| format!("{name} cannot be read"))?
            .len();
        ensure!(
            resumes || length == 0,
            "{name} is there already; --resume goes on with it"
        );
        let mut own = Self {
            path: path.to_owned(),
            file,
            end: 0,
            lines: BTreeMap::new(),
        };
        let earlier = own
            .read()
            .with_context(|| format!("{name} cannot be resumed"))?;
        // A line that was being written when the program was killed.
        own.file
            .set_len(own.end)
            .with_context(|| format!("{name} cannot be written"))?;
        Ok((own, earlier))
    }

    /// Reads whole lines.
    fn read(&mut self) -> anyhow::Result<EarlierResults> {
        let mut found = HashMap::new();
        let mut reader = BufReader::new(&self.file);
        let mut line = Vec::new();
        for number in 1usize.. {
            line.clear();
            let length = reader.read_until(b'\n', &mut line)?;
            if line.last() != Some(&b'\n') {
                break;
            }
            let text = std::str::from_utf8(&line)?;
            let read: Option<Known> = if text.starts_with(START) {
                serde_json::from_str(text).ok()
            } else {
                None
            };
            let Some(read) = read else {
                bail!("line {number} is no result of a job")
            };
            let place = Place {
                start: self.end,
                length: length - 1,
            };
            self.end += length as u64;
            let (Some(key), Some(input)) = (read.key, read.input) else {
                continue;
            };
            let failed = match read.status.as_str() {
                "failed" => Some(
                    read.error
                        .map_or((Kind::Crash, None), |own| (own.kind, own.limit)),
                ),
                _ => None,
            };
            let is_short = read.status == "stopped-short";
            let earlier = Earlier {
                place,
                is_short,
                output_bytes: read.output_bytes,
                failed,
            };
            found.insert((key, input, read.output), earlier);
        }
        Ok(found)
    }

    fn add(&mut self, line: usize, result: &str) -> anyhow::Result<()> {
        // In one piece, so that another reader sees whole lines.
        let written = self.file.write_all(result.as_bytes());
        written.with_context(|| format!("{} cannot be written", self.path.display()))?;
        self.lines.insert(
            line,
            Place {
                start: self.end,
                length: result.len() - 1,
            },
        );
        self.end += result.len() as u64;
        Ok(())
    }

    /// Puts the results into the order of their jobs, and leaves out those of jobs that are no more.
    fn finish(self) -> anyhow::Result<()> {
        let Self {
            path,
            mut file,
            lines,
            ..
        } = self;
        let mut result = Vec::new();
        let fill = |writer: &mut dyn Write| {
            for (number, place) in &lines {
                result.resize(place.length, 0);
                file.seek(SeekFrom::Start(place.start))?;
                file.read_exact(&mut result)?;
                // Jobs may stand on other lines than they did.
                let digits = result[START.len()..]
                    .iter()
                    .take_while(|byte| byte.is_ascii_digit())
                    .count();
                write!(writer, "{START}{number}")?;
                writer.write_all(&result[START.len() + digits..])?;
                writer.write_all(b"\n")?;
            }
            Ok(())
        };
        Ok(interrupt::whole_or_not(&path, || {
            limitmesh_io::write_whole_with(&path, fill)
        })?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(line: usize, key: &str) -> String {
        format!(
            "{{\"line\":{line},\"key\":\"{key}\",\"input\":\"i\",\"output\":null,\"status\":\"done\"}}"
        )
    }

    #[test]
    fn results_come_into_the_order_of_jobs_and_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r.jsonl");
        let (mut results, earlier) = Results::open(&path, true).unwrap();
        assert!(earlier.is_empty());
        results.add(12, result(12, "c")).unwrap();
        results.add(2, result(2, "a")).unwrap();
        assert!(
            Results::open(&path, true)
                .err()
                .unwrap()
                .to_string()
                .contains("in use")
        );
        // Killed in the middle of a line.
        drop(results);
        let mut file = OpenOptions::new().append(true).open(&path).unwrap();
        file.write_all(b"{\"line\":3,\"key\":").unwrap();
        drop(file);
        assert!(
            Results::open(&path, false)
                .err()
                .unwrap()
                .to_string()
                .contains("--resume")
        );
        let (mut results, earlier) = Results::open(&path, true).unwrap();
        assert_eq!(earlier.len(), 2);
        let key = |key: &str| (key.to_owned(), "i".to_owned(), None);
        // On other lines.
        results.keep(1, earlier[&key("a")].place);
        results.keep(7, earlier[&key("c")].place);
        results.add(5, result(5, "b")).unwrap();
        results.finish().unwrap();
        let expected = [result(1, "a"), result(5, "b"), result(7, "c")].join("\n") + "\n";
        assert_eq!(std::fs::read_to_string(&path).unwrap(), expected);
    }

    #[test]
    fn what_holds_something_else_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notes.txt");
        for text in ["dear diary\n", "{\"line\":1}\n"] {
            std::fs::write(&path, text).unwrap();
            let why = format!("{:#}", Results::open(&path, true).err().unwrap());
            assert!(why.contains("line 1 is no result"), "{why}");
            assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        }
    }
}
