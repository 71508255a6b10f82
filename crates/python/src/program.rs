//! The program `limitmesh`, its refinement of files, and its batches.

use std::cell::RefCell;
use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

use limitmesh::progress::{Observer, Progress};
use limitmesh_cli::{Host, RemoteFiles, refine_files};
use pyo3::prelude::*;

use crate::errors::Failure;
use crate::run::{run, run_with_patience};

/// The program with a command line; its exit code. `again` starts it in another process.
#[pyfunction]
pub(crate) fn program(py: Python<'_>, arguments: Vec<OsString>, again: Vec<OsString>) -> u8 {
    py.detach(|| limitmesh_cli::program(arguments, &again))
}

/// `limitmesh refine` with these arguments: why it stopped short, if it did, and the lines that it would print.
#[pyfunction]
pub(crate) fn refine_file(
    py: Python<'_>,
    arguments: Vec<OsString>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Option<String>, Vec<String>)> {
    run(py, threads, progress, move |observer| {
        let caller = Caller(RefCell::new(Ears {
            observer,
            notes: Some(Vec::new()),
            is_stopped: false,
        }));
        let result = refine_files(arguments, &caller);
        let (found, notes) = caller.heard(result)?;
        Ok((found.stopped_short, notes))
    })
}

/// How long a batch may take to end its processes and its copies, once it is to stop.
const PATIENCE: Duration = Duration::from_secs(60);

/// `limitmesh batch` with these arguments: how many jobs there are, results kept, done, stopped short and failed. `again` starts the program
/// in another process; `files` copies those at addresses.
#[pyfunction]
pub(crate) fn batch(
    py: Python<'_>,
    arguments: Vec<OsString>,
    again: Vec<OsString>,
    files: Py<PyAny>,
    progress: Option<Py<PyAny>>,
) -> PyResult<[usize; 5]> {
    run_with_patience(py, 1, progress, PATIENCE, move |observer| {
        let caller = Caller(RefCell::new(Ears {
            observer,
            notes: None,
            is_stopped: false,
        }));
        let result = limitmesh_cli::batch(arguments, &again, &Files(files), &caller);
        let (counts, _) = caller.heard(result)?;
        Ok([
            counts.jobs,
            counts.kept,
            counts.done,
            counts.short,
            counts.failed,
        ])
    })
}

/// An object of Python that copies files.
struct Files(Py<PyAny>);

impl RemoteFiles for Files {
    fn fetch(&self, address: &str, to: &Path) -> Result<(), String> {
        let copied = Python::attach(|py| self.0.call_method1(py, "fetch", (address, to)));
        copied
            .map(drop)
            .map_err(|why| format!("{address} cannot be read: {why}"))
    }

    fn store(&self, from: &Path, address: &str) -> Result<(), String> {
        let copied = Python::attach(|py| self.0.call_method1(py, "store", (from, address)));
        copied
            .map(drop)
            .map_err(|why| format!("{address} cannot be written: {why}"))
    }

    fn size(&self, address: &str) -> Option<u64> {
        // Where nothing is known of the file it is written again.
        Python::attach(|py| {
            let size = self.0.call_method1(py, "size", (address,)).ok()?;
            size.extract(py).ok()?
        })
    }
}

/// Whoever called from Python.
struct Caller<'a, 'o>(RefCell<Ears<'a, 'o>>);

struct Ears<'a, 'o> {
    observer: &'a mut Observer<'o>,
    /// What the program would print, where that is wanted.
    notes: Option<Vec<String>>,
    is_stopped: bool,
}

impl Caller<'_, '_> {
    /// The result of a command, and the lines that it would print.
    fn heard<T>(
        self,
        result: Result<T, limitmesh_cli::Failure>,
    ) -> Result<(T, Vec<String>), Failure> {
        let Ears {
            notes, is_stopped, ..
        } = self.0.into_inner();
        match result {
            _ if is_stopped => Err(Failure::Cancelled),
            Ok(found) => Ok((found, notes.unwrap_or_default())),
            Err(limitmesh_cli::Failure::Usage(what)) => Err(Failure::Option(what)),
            Err(limitmesh_cli::Failure::Input(what)) => Err(Failure::File(what)),
        }
    }
}

impl Host for Caller<'_, '_> {
    fn observe(&self, at: &Progress) -> ControlFlow<()> {
        let mut ears = self.0.borrow_mut();
        let answer = (ears.observer)(at);
        ears.is_stopped |= answer.is_break();
        answer
    }

    fn note(&self, line: &str) {
        if let Some(notes) = &mut self.0.borrow_mut().notes {
            notes.push(line.to_owned());
        }
    }
}
