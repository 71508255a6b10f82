//! A job in a process of its own: watched for its limits, ended in good order.
//!
//! The process is this program again, with the hidden command `batch-job`. It prints the report and then its [`Verdict`], and
//! ends when its standard input does: when the batch wants it to, or is no more.

use std::ffi::OsString;
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::interrupt;

/// How often limits are looked at.
const LOOK: Duration = Duration::from_millis(20);

/// How long a process that is to end may take to remove what it has begun.
const PATIENCE: Duration = Duration::from_secs(2);

/// The end of what a process that crashed said is kept, up to so many bytes.
const MOST_WORDS: usize = 400;

/// The last message of a job's process.
#[derive(Serialize, Deserialize)]
#[serde(tag = "verdict", rename_all = "kebab-case")]
pub(in crate::commands) enum Verdict {
    Done,
    StoppedShort { why: String },
    Options { message: String },
    File { message: String },
}

/// The limits of jobs.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    pub(super) time: Option<Duration>,
    /// In bytes.
    pub(super) memory: Option<usize>,
}

/// How to start a job's process: its name and first arguments, up to those of `refine`.
pub(super) struct Starter {
    pub(super) program: Vec<OsString>,
    pub(super) threads: usize,
    pub(super) limits: Limits,
    /// Whether jobs that run are to end.
    pub(super) is_stopped: AtomicBool,
}

/// How a process ended.
pub(super) enum Ended {
    Said {
        report: Option<Box<RawValue>>,
        verdict: Verdict,
    },
    /// It took longer than this.
    TooLong(Duration),
    /// It took more memory than this.
    TooLarge(usize),
    /// It ended without a verdict: what is known of that.
    Crashed(String),
    /// The batch is to end.
    Cancelled,
}

impl Starter {
    /// Runs a job to its end.
    ///
    /// # Errors
    /// No process can be started.
    pub(super) fn run(&self, words: &[OsString]) -> anyhow::Result<Ended> {
        let mut child = self
            .start(words)
            .context("no process can be started for a job")?;
        // Closed to end it.
        let mut line = child.stdin.take();
        let said = listen(child.stdout.take());
        let messages = listen(child.stderr.take());
        let start = Instant::now();
        let mut asked: Option<(Ended, Instant)> = None;
        let bytes = loop {
            match said.recv_timeout(LOOK) {
                Ok(bytes) => break bytes,
                Err(RecvTimeoutError::Disconnected) => break Vec::new(),
                Err(RecvTimeoutError::Timeout) => {}
            }
            match &asked {
                Some((_, since)) if since.elapsed() > PATIENCE => {
                    child.kill().context("a job cannot be ended")?
                }
                Some(_) => {}
                None => {
                    asked = self.end_for(&child, start).map(|why| (why, Instant::now()));
                    line = line.filter(|_| asked.is_none());
                }
            }
        };
        let status = child.wait().context("a job cannot be waited for")?;
        if let Some((why, _)) = asked {
            return Ok(why);
        }
        let mut values = serde_json::Deserializer::from_slice(&bytes).into_iter::<Box<RawValue>>();
        let mut values = values
            .by_ref()
            .collect::<Result<Vec<_>, _>>()
            .unwrap_or_default();
        let verdict = values
            .pop()
            .and_then(|last| serde_json::from_str(last.get()).ok());
        Ok(match verdict {
            Some(verdict) => Ended::Said {
                report: values.pop(),
                verdict,
            },
            None => Ended::Crashed(in_words(status, &messages.recv().unwrap_or_default())),
        })
    }

    fn start(&self, words: &[OsString]) -> std::io::Result<Child> {
        let (program, first) = self
            .program
            .split_first()
            .ok_or(std::io::ErrorKind::NotFound)?;
        let mut command = Command::new(program);
        command.args(first).args([
            "batch-job",
            "--quiet",
            "--threads",
            &self.threads.to_string(),
            "--",
        ]);
        command
            .args(words)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt;
            // Ctrl-C is for the batch, which ends its jobs.
            command.process_group(0);
        }
        command.spawn()
    }

    /// Why a job must end now, if it must.
    fn end_for(&self, child: &Child, start: Instant) -> Option<Ended> {
        if self.is_stopped.load(Relaxed) || interrupt::is_asked() {
            return Some(Ended::Cancelled);
        }
        let Limits { time, memory } = self.limits;
        let is_long = |most: &Duration| start.elapsed() > *most;
        let is_large = |most: &usize| resident(child.id()).is_some_and(|now| now > *most);
        let too_long = time.filter(is_long).map(Ended::TooLong);
        too_long.or_else(|| memory.filter(is_large).map(Ended::TooLarge))
    }
}

/// Reads a stream to its end on a thread.
fn listen(stream: Option<impl Read + Send + 'static>) -> Receiver<Vec<u8>> {
    let (sender, receiver) = sync_channel(1);
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // What was read before an error counts; nobody listens any more if the batch went on.
        let _ = stream.map(|mut stream| stream.read_to_end(&mut bytes));
        let _ = sender.send(bytes);
    });
    receiver
}

/// Bytes that a process has in memory, where the system says.
pub(super) fn resident(process: u32) -> Option<usize> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: usize = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

/// How a process ended without a verdict, with the end of what it said.
fn in_words(status: std::process::ExitStatus, messages: &[u8]) -> String {
    let messages = String::from_utf8_lossy(messages);
    let lines: Vec<&str> = messages
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    let words = lines.join("; ");
    let skipped = words
        .char_indices()
        .rev()
        .nth(MOST_WORDS)
        .map_or(0, |(at, _)| at);
    match words.is_empty() {
        true => format!("it ended without a word ({status})"),
        false => format!(
            "it ended without a result ({status}): {}",
            &words[skipped..]
        ),
    }
}
