//! The program `limitmesh`, and its refinement of files.

use std::cell::RefCell;
use std::ffi::OsString;
use std::ops::ControlFlow;

use limitmesh::progress::{Observer, Progress};
use limitmesh_cli::{Host, refine_files};
use pyo3::prelude::*;

use crate::errors::Failure;
use crate::run::run;

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
            notes: Vec::new(),
            is_stopped: false,
        }));
        let result = refine_files(arguments, &caller);
        let Ears {
            notes, is_stopped, ..
        } = caller.0.into_inner();
        match result {
            _ if is_stopped => Err(Failure::Cancelled),
            Ok(found) => Ok((found.stopped_short, notes)),
            Err(limitmesh_cli::Failure::Usage(what)) => Err(Failure::Option(what)),
            Err(limitmesh_cli::Failure::Input(what)) => Err(Failure::File(what)),
        }
    })
}

/// Whoever called from Python.
struct Caller<'a, 'o>(RefCell<Ears<'a, 'o>>);

struct Ears<'a, 'o> {
    observer: &'a mut Observer<'o>,
    notes: Vec<String>,
    is_stopped: bool,
}

impl Host for Caller<'_, '_> {
    fn observe(&self, at: &Progress) -> ControlFlow<()> {
        let mut ears = self.0.borrow_mut();
        let answer = (ears.observer)(at);
        ears.is_stopped |= answer.is_break();
        answer
    }

    fn note(&self, line: &str) {
        self.0.borrow_mut().notes.push(line.to_owned());
    }
}
