//! `limitmesh batch`: many refinements, each in a process of its own, and what became of each as a line.
//!
//! ```text
//! lines ─▶ jobs ─▶ claims: no file twice ─▶ keys: what is there already? ─▶ processes ─▶ lines, in the end in order
//! ```
//!
//! Processes, because what one mesh does must not end the others: memory that is not there, a limit that is passed, an error of
//! the program. What it costs to start one is small against a mesh (docs/fleet.md).

mod job;
mod key;
mod process;
mod remote;
mod results;
mod status;

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::Read;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::progress::{Stage, Watch};
use serde_json::value::RawValue;

use crate::arguments::{BatchArguments, Shard};
use crate::failure::{Outcome, usage};
use crate::format::{counted, seconds, thousands};
use crate::input;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use job::{Claims, Job, Reader, is_address};
pub(super) use process::Verdict;
use process::{Ended, Limits, Starter};
use remote::Copied;
pub use remote::RemoteFiles;
use results::{EarlierResults, Place, Results};
#[cfg(test)]
pub(crate) use status::Line as BatchLine;
use status::{JobError, JobStatus, Kind, Line};

/// Where nobody sees a spinner, a note says so often how things stand.
const TELL: Duration = Duration::from_secs(30);

/// How often the batch looks whether it is to end.
const LOOK: Duration = Duration::from_millis(100);

/// A job on its line, or why there is none.
struct Task {
    line: usize,
    job: Result<Job, String>,
}

/// The outcome of a task.
enum Fate {
    /// An earlier result holds.
    Kept(Place, Standing),
    New(String, Standing),
    /// No process can be started.
    Broken(anyhow::Error),
    Cancelled,
}

/// The kind of a result.
#[derive(Clone, PartialEq)]
enum Standing {
    Done,
    Short,
    /// With what is said of it on standard error.
    Failed(String),
}

/// Does the jobs. `program` starts this program again.
pub(crate) fn run(
    arguments: &BatchArguments,
    program: &[OsString],
    threads: usize,
    progress: &Progress,
) -> anyhow::Result<Outcome> {
    let start = Instant::now();
    let counts = work(arguments, program, threads, None, progress)?;
    let took = seconds(start.elapsed().as_secs_f64());
    progress.note(format!("{}; {took}", counts.in_words()));
    let jobs = counted(counts.jobs, "job", "jobs");
    let failed = thousands(counts.failed);
    anyhow::ensure!(counts.failed == 0, "{failed} of {jobs} failed");
    Ok(match counts.short {
        0 => Outcome::Done,
        short => Outcome::StoppedShort(format!("{} of {jobs}", thousands(short))),
    })
}

/// Does the jobs, with files at addresses if the caller copies these.
pub(crate) fn work(
    arguments: &BatchArguments,
    program: &[OsString],
    threads: usize,
    remote: Option<&dyn RemoteFiles>,
    progress: &Progress,
) -> anyhow::Result<BatchCounts> {
    check(arguments)?;
    progress.stage("reading the jobs");
    let tasks = tasks(arguments, remote.is_some())?;
    interrupt::leave_to_caller();
    let (results, earlier) = Results::open(&arguments.output, arguments.resume)?;
    make_folders(&tasks)?;
    let starter = Starter {
        program: program.to_vec(),
        // All processors for one job are asked for by their number.
        threads: threads.max(1),
        limits: Limits {
            time: arguments.time_limit,
            memory: arguments.memory_limit,
        },
        is_stopped: AtomicBool::new(false),
    };
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let processes = arguments
        .processes
        .unwrap_or((processors / starter.threads).max(1));
    let with_seconds = arguments.seconds;
    let batch = Batch {
        starter,
        earlier,
        with_seconds,
        remote,
    };
    let name = output_name(arguments);
    batch.run(tasks, processes, results, &name, progress)
}

fn check(arguments: &BatchArguments) -> anyhow::Result<()> {
    if arguments.resume && output::is_standard_output(&arguments.output) {
        return usage("--resume goes on with a file of results; standard output is none");
    }
    if arguments.memory_limit.is_some() && process::resident(std::process::id()).is_none() {
        return usage(
            "--memory-limit needs a system that says in /proc what processes have in memory",
        );
    }
    Ok(())
}

/// The jobs of the shard by their lines; blank lines are none.
fn tasks(arguments: &BatchArguments, takes_addresses: bool) -> anyhow::Result<Vec<Task>> {
    let name = input::display_name(&arguments.jobs);
    let mut bytes = Vec::new();
    let read = match output::is_standard_output(&arguments.jobs) {
        true => std::io::stdin().lock().read_to_end(&mut bytes).map(drop),
        false => std::fs::read(&arguments.jobs).map(|all| bytes = all),
    };
    read.with_context(|| format!("{name} cannot be read"))?;
    let reader = Reader::new(takes_addresses);
    let lines = bytes.split(|&byte| byte == b'\n').enumerate();
    let lines = lines.filter(|(_, line)| !line.trim_ascii().is_empty());
    let mut tasks: Vec<Task> = lines
        .map(|(i, line)| Task {
            line: i + 1,
            job: reader.job(line.trim_ascii()),
        })
        .collect();
    let mut claims = Claims::default();
    [&arguments.jobs, &arguments.output]
        .into_iter()
        .for_each(|own| claims.take(own));
    for job in tasks.iter().filter_map(|task| task.job.as_ref().ok()) {
        let read = std::iter::once(&job.input)
            .chain(&job.option_files)
            .map(Path::new);
        read.filter(|path| input::builtin_name(path).is_none())
            .for_each(|path| claims.read(path));
    }
    for task in &mut tasks {
        if let Ok(job) = &task.job
            && let Err(what) = claims.write(job, task.line)
        {
            task.job = Err(what);
        }
    }
    // After all of them said what they read and write, so that a result does not depend on the shard.
    let shard = arguments.shard;
    tasks.retain(|task| shard.is_none_or(|shard: Shard| shard.has(task.line)));
    Ok(tasks)
}

/// How messages call the results.
fn output_name(arguments: &BatchArguments) -> String {
    match output::is_standard_output(&arguments.output) {
        true => "standard output".to_owned(),
        false => arguments.output.display().to_string(),
    }
}

/// Makes the folders of what is written.
fn make_folders(tasks: &[Task]) -> anyhow::Result<()> {
    let written = tasks
        .iter()
        .filter_map(|task| task.job.as_ref().ok())
        .flat_map(Job::written)
        .filter(|name| !is_address(name));
    let mut last = None;
    for folder in written.filter_map(|name| Path::new(name).parent()) {
        if last.replace(folder) != Some(folder) {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("the folder {} cannot be made", folder.display()))?;
        }
    }
    Ok(())
}

/// The common data of all jobs.
struct Batch<'a> {
    starter: Starter,
    earlier: EarlierResults,
    with_seconds: bool,
    remote: Option<&'a dyn RemoteFiles>,
}

/// How many results there are of each kind.
#[derive(Clone, Copy, Debug, Default)]
pub struct BatchCounts {
    /// Jobs of the shard.
    pub jobs: usize,
    /// Results that were there and hold.
    pub kept: usize,
    /// Jobs that met all goals.
    pub done: usize,
    /// Jobs that a cap ended before that.
    pub short: usize,
    /// Jobs without a result.
    pub failed: usize,
}

impl BatchCounts {
    fn all(&self) -> usize {
        self.done + self.short + self.failed
    }

    fn in_words(&self) -> String {
        let mut words = format!(
            "{} of {} ended",
            thousands(self.all()),
            counted(self.jobs, "job", "jobs")
        );
        let parts = [
            (self.failed, "failed"),
            (self.short, "stopped short"),
            (self.kept, "kept from before"),
        ];
        for (count, what) in parts.into_iter().filter(|(count, _)| *count > 0) {
            words.push_str(&format!(", {} {what}", thousands(count)));
        }
        words
    }
}

impl Batch<'_> {
    fn run(
        &self,
        tasks: Vec<Task>,
        processes: usize,
        mut results: Results,
        name: &str,
        progress: &Progress,
    ) -> anyhow::Result<BatchCounts> {
        let jobs = tasks.len();
        tasks.iter().for_each(|task| results.expect(task.line));
        let tasks = Mutex::new(VecDeque::from(tasks));
        let mut counts = BatchCounts {
            jobs,
            ..BatchCounts::default()
        };
        let mut observer = |at: &limitmesh::progress::Progress| progress.answer(at);
        let mut watch = Watch::new(&mut observer, Stage::Refining);
        watch.stage(Stage::Refining, Some(jobs))?;
        let (sender, receiver) = channel();
        thread::scope(|scope| -> anyhow::Result<()> {
            for _ in 0..processes.min(jobs) {
                let (sender, tasks) = (sender.clone(), &tasks);
                scope.spawn(move || self.work(tasks, &sender));
            }
            drop(sender);
            let mut noted = Instant::now();
            let outcome = loop {
                progress.stage(format!("refining: {}", counts.in_words()));
                if let Err(why) = watch.done(counts.all()) {
                    break Err(why.into());
                }
                if noted.elapsed() > TELL {
                    noted = Instant::now();
                    progress.note_where_nothing_moves(counts.in_words());
                }
                let (line, result) = match receiver.recv_timeout(LOOK) {
                    Ok(ended) => ended,
                    Err(RecvTimeoutError::Timeout) => continue,
                    Err(RecvTimeoutError::Disconnected) => break Ok(()),
                };
                let standing = match result {
                    Fate::Cancelled => continue,
                    Fate::Broken(why) => break Err(why),
                    Fate::Kept(place, standing) => {
                        results.keep(line, place);
                        counts.kept += 1;
                        standing
                    }
                    Fate::New(text, standing) => {
                        if let Err(why) = results.add(line, text) {
                            break Err(why);
                        }
                        standing
                    }
                };
                match standing {
                    Standing::Done => counts.done += 1,
                    Standing::Short => counts.short += 1,
                    Standing::Failed(what) => {
                        counts.failed += 1;
                        progress.note(format!("line {line}: {what}"));
                    }
                }
            };
            // Nothing more is begun, and after an error nothing finished.
            self.starter.is_stopped.store(true, Relaxed);
            tasks.lock().unwrap_or_else(PoisonError::into_inner).clear();
            outcome
        })?;
        if interrupt::is_asked() {
            progress.stage(format!("refining: {}", counts.in_words()));
            progress.clear();
            interrupt::end_as_asked(name.to_owned());
        }
        results.finish()?;
        Ok(counts)
    }

    /// Does tasks as long as there are any.
    fn work(&self, tasks: &Mutex<VecDeque<Task>>, sender: &Sender<(usize, Fate)>) {
        while !interrupt::is_asked() {
            let next = tasks
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .pop_front();
            let Some(task) = next else { return };
            let result = self.result(&task).unwrap_or_else(Fate::Broken);
            // Nobody listens any more if the batch failed.
            if sender.send((task.line, result)).is_err() {
                return;
            }
        }
    }

    fn result(&self, task: &Task) -> anyhow::Result<Fate> {
        let job = match &task.job {
            Ok(job) => job,
            Err(what) => {
                let status = failed(Kind::Line, None, what.clone());
                return new(Line {
                    line: task.line,
                    key: None,
                    input: None,
                    output: None,
                    status,
                });
            }
        };
        let copied = Copied::of(job)?.zip(self.remote);
        let fetched = copied.as_ref().map(|(own, remote)| own.fetch(*remote));
        let here = copied.as_ref().map_or(job, |(own, _)| &own.job);
        let key = key::key(job, &here.input).ok();
        if let Some(earlier) = key.as_ref().and_then(|key| self.kept(key, job)) {
            return Ok(earlier);
        }
        let mut status = match fetched {
            Some(Err(what)) => failed(Kind::File, None, what),
            _ => match self.status(here)? {
                Some(status) => status,
                None => return Ok(Fate::Cancelled),
            },
        };
        if let (Some((own, remote)), true) = (&copied, status.has_output())
            && let Err(what) = own.store(*remote)
        {
            status = failed(Kind::File, None, what);
        }
        let result = Line {
            line: task.line,
            key: key.as_deref(),
            input: Some(&job.input),
            output: job.output.as_deref(),
            status,
        };
        Ok(match (new(result)?, copied) {
            (Fate::New(text, standing), Some((own, _))) => {
                Fate::New(own.with_addresses(&text), standing)
            }
            (fate, _) => fate,
        })
    }

    /// The status of a job after its process; `None` where it is cancelled.
    fn status(&self, job: &Job) -> anyhow::Result<Option<JobStatus>> {
        let (verdict, report) = match self.starter.run(&job.words())? {
            Ended::Cancelled => return Ok(None),
            Ended::TooLong(most) => {
                let most = most.as_secs_f64();
                let message = format!("it took more than {most} s (--time-limit)");
                let limit = serde_json::Number::from_f64(most);
                return Ok(Some(failed(Kind::Time, limit, message)));
            }
            Ended::TooLarge(most) => {
                let bytes = crate::format::bytes(most);
                let message = format!("it took more than {bytes} of memory (--memory-limit)");
                return Ok(Some(failed(Kind::Memory, Some(most.into()), message)));
            }
            Ended::Crashed(how) => return Ok(Some(failed(Kind::Crash, None, how))),
            Ended::Said { verdict, report } => (verdict, report),
        };
        let on_one_line = |report: &RawValue| status::on_one_line(report, self.with_seconds);
        let report = report.as_deref().map(on_one_line).transpose()?;
        let output_bytes = self.size(job.output.as_deref());
        Ok(Some(match (verdict, report) {
            (Verdict::Done, Some(report)) => JobStatus::Done {
                output_bytes,
                report,
            },
            (Verdict::StoppedShort { why }, Some(report)) => JobStatus::StoppedShort {
                why,
                output_bytes,
                report,
            },
            (Verdict::Options { message }, _) => failed(Kind::Options, None, message),
            (Verdict::File { message }, _) => failed(Kind::File, None, message),
            _ => failed(Kind::Crash, None, "it ended without a report".to_owned()),
        }))
    }

    /// The earlier result of a job, if it holds.
    fn kept(&self, key: &str, job: &Job) -> Option<Fate> {
        let earlier = self
            .earlier
            .get(&(key.to_owned(), job.input.clone(), job.output.clone()))?;
        let Limits { time, memory } = self.starter.limits;
        let standing = match earlier.failed {
            Some((kind @ (Kind::Time | Kind::Memory), Some(at))) => {
                let now = match kind {
                    Kind::Time => time.map(|most| most.as_secs_f64()),
                    _ => memory.map(|most| most as f64),
                };
                if now.is_none_or(|most| most > at) {
                    return None;
                }
                Standing::Failed(format!("error ({}), as before", kind.name()))
            }
            Some(_) => return None,
            None if earlier.is_short => Standing::Short,
            None => Standing::Done,
        };
        let is_there = matches!(standing, Standing::Failed(_))
            || self.size(job.output.as_deref()) == earlier.output_bytes
                && job.written().all(|name| self.size(Some(name)).is_some());
        is_there.then(|| Fate::Kept(earlier.place, standing))
    }

    /// Bytes of a file, if there is one.
    fn size(&self, name: Option<&str>) -> Option<u64> {
        match (name?, self.remote) {
            (name, Some(remote)) if is_address(name) => remote.size(name),
            (name, _) => std::fs::metadata(name).ok().map(|file| file.len()),
        }
    }
}

fn failed(kind: Kind, limit: Option<serde_json::Number>, message: String) -> JobStatus {
    JobStatus::Failed {
        error: JobError {
            kind,
            limit,
            message,
        },
    }
}

/// A result as its line.
fn new(line: Line<'_>) -> anyhow::Result<Fate> {
    let standing = match &line.status {
        JobStatus::Done { .. } => Standing::Done,
        JobStatus::StoppedShort { .. } => Standing::Short,
        JobStatus::Failed { error } => {
            Standing::Failed(format!("error ({}): {}", error.kind.name(), error.message))
        }
    };
    Ok(Fate::New(serde_json::to_string(&line)?, standing))
}
