//! Long jobs: on threads of their own, without the interpreter's lock, while the calling thread wakes for signals and progress.
//!
//! Each job has a [pool](crate::pool) to itself. The calling thread only waits: every [`WAKE`] it takes the lock, lets Python handle
//! signals and tells of progress. If either raises, the job is told to stop, and left to itself, with its pool, if it does not at once.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use limitmesh::progress::{Observer, Progress};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::Failure;
use crate::pool::Pool;

/// How often the calling thread looks for signals.
const WAKE: Duration = Duration::from_millis(50);

/// How long a job that is to stop may take for it before the caller goes on without it: it stops at its next block of work.
pub(crate) const PATIENCE: Duration = Duration::from_millis(150);

/// What job and caller tell each other.
#[derive(Default)]
struct Line {
    is_stopped: AtomicBool,
    /// What was told last, for callers who want to know.
    latest: Mutex<Option<Progress>>,
}

/// The result of a job on `threads` threads.
///
/// # Errors
/// The job's own; what a signal's handler or `progress` raises.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    progress: Option<Py<PyAny>>,
    job: impl FnOnce(&mut Observer<'_>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    run_with_patience(py, threads, progress, PATIENCE, job)
}

/// [`run`], for a job that may take so long to stop.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_with_patience<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    progress: Option<Py<PyAny>>,
    patience: Duration,
    job: impl FnOnce(&mut Observer<'_>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let pool = Pool::take(threads)?;
    let (worker, caller) = ends(progress);
    pool.start(move || worker.finish(job));
    let (result, is_idle) = caller.wait(py, patience);
    if is_idle {
        pool.keep();
    }
    Ok(result??)
}

/// Both ends of a line: of whoever does a job, and of the caller who waits for it.
pub(crate) fn ends<T>(progress: Option<Py<PyAny>>) -> (WorkerEnd<T>, CallerEnd<T>) {
    let line = Arc::new(Line::default());
    let (sender, receiver) = sync_channel(1);
    let worker = WorkerEnd {
        line: Arc::clone(&line),
        is_heard: progress.is_some(),
        sender,
    };
    (
        worker,
        CallerEnd {
            line,
            receiver,
            progress,
        },
    )
}

/// The end of whoever does a job.
pub(crate) struct WorkerEnd<T> {
    line: Arc<Line>,
    is_heard: bool,
    sender: SyncSender<Result<T, Failure>>,
}

impl<T> WorkerEnd<T> {
    /// Does the job, and sends what came of it.
    pub(crate) fn finish(self, job: impl FnOnce(&mut Observer<'_>) -> Result<T, Failure>) {
        let Self {
            line,
            is_heard,
            sender,
        } = self;
        let mut observer = |at: &Progress| {
            if is_heard {
                *line.latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(*at);
            }
            if line.is_stopped.load(Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        // Nobody listens any more if the caller went on.
        let _ = sender.send(job(&mut observer));
    }
}

/// The end of the caller.
pub(crate) struct CallerEnd<T> {
    line: Arc<Line>,
    receiver: Receiver<Result<T, Failure>>,
    progress: Option<Py<PyAny>>,
}

impl<T: Send> CallerEnd<T> {
    /// Waits for the job; what came of it, or what a signal's handler or `progress` raised, and whether it has come to its end.
    pub(crate) fn wait(
        self,
        py: Python<'_>,
        patience: Duration,
    ) -> (PyResult<Result<T, Failure>>, bool) {
        py.detach(move || wait(&self.receiver, &self.line, self.progress.as_ref(), patience))
    }
}

/// Waits for the job, waking now and then; what came of it, and whether it has come to its end.
fn wait<T>(
    receiver: &Receiver<Result<T, Failure>>,
    line: &Line,
    progress: Option<&Py<PyAny>>,
    patience: Duration,
) -> (PyResult<Result<T, Failure>>, bool) {
    loop {
        match receiver.recv_timeout(WAKE) {
            Ok(result) => return (Ok(result), true),
            Err(RecvTimeoutError::Disconnected) => {
                let why = "an internal error ended the job; please report it";
                return (Err(PyRuntimeError::new_err(why)), false);
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Err(raised) = Python::attach(|py| look_up(py, line, progress)) {
            line.is_stopped.store(true, Relaxed);
            return (Err(raised), receiver.recv_timeout(patience).is_ok());
        }
    }
}

/// Handles signals and tells of progress.
fn look_up(py: Python<'_>, line: &Line, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    py.check_signals()?;
    let Some(progress) = progress else {
        return Ok(());
    };
    let latest = line
        .latest
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take();
    let Some(Progress {
        stage,
        done,
        total,
        triangles,
        ..
    }) = latest
    else {
        return Ok(());
    };
    progress
        .call1(py, (stage.to_string(), done, total, triangles))
        .map(drop)
}
