//! Threads for jobs, kept from one call to the next: to start them takes longer than a small job.
//!
//! A forked process has the thread that forked and no other, so idle threads must not be waited for there. Python ends them before it
//! forks ([`crate::front::end_threads`]). Who forks behind Python's back is known by the process's number: the copy of the pool is then left as it is.

use std::io;
use std::sync::Mutex;
use std::thread::{Builder, JoinHandle};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The pool that was used last, while nobody uses it.
static KEPT: Mutex<Option<Pool>> = Mutex::new(None);

/// Threads of one job at a time.
pub(crate) struct Pool {
    pool: ThreadPool,
    threads: Vec<JoinHandle<()>>,
    /// That the threads belong to.
    process: u32,
}

impl Pool {
    /// The kept pool, or a new one; with exactly `threads` threads.
    ///
    /// # Errors
    /// So many threads cannot be started.
    pub(crate) fn take(threads: usize) -> PyResult<Self> {
        match taken() {
            Some(pool) if pool.threads.len() == threads => Ok(pool),
            _ => Self::new(threads),
        }
    }

    /// A new pool.
    ///
    /// # Errors
    /// So many threads cannot be started.
    pub(crate) fn new(count: usize) -> PyResult<Self> {
        let mut threads = Vec::with_capacity(count);
        let pool = ThreadPoolBuilder::new()
            .num_threads(count)
            .spawn_handler(|thread| -> io::Result<()> {
                threads.push(
                    Builder::new()
                        .name("limitmesh".to_owned())
                        .spawn(|| thread.run())?,
                );
                Ok(())
            })
            // The panic is told by its hook, and by the job's channel that closes.
            .panic_handler(|_| ())
            .build()
            .map_err(|why| {
                PyRuntimeError::new_err(format!("{count} threads could not be started: {why}"))
            })?;
        Ok(Self {
            pool,
            threads,
            process: std::process::id(),
        })
    }

    pub(crate) fn start(&self, job: impl FnOnce() + Send + 'static) {
        self.pool.spawn(job);
    }

    /// Ends its threads, which are idle, and returns when they are gone; those of another process are not there.
    pub(crate) fn end(self) {
        if self.process != std::process::id() {
            std::mem::forget(self);
            return;
        }
        drop(self.pool);
        for thread in self.threads {
            // Jobs' panics are caught before they come here.
            let _ = thread.join();
        }
    }

    /// Whether its threads are this process's.
    pub(crate) fn is_here(&self) -> bool {
        self.process == std::process::id()
    }

    /// Keeps it for the next call, in place of another.
    pub(crate) fn keep(self) {
        if let Ok(mut kept) = KEPT.try_lock() {
            *kept = Some(self);
        }
    }
}

/// Ends the threads that are kept, and returns when they are gone.
pub(crate) fn end_kept() {
    if let Some(pool) = taken() {
        pool.end();
    }
}

/// The kept pool, which is no longer kept.
fn taken() -> Option<Pool> {
    // Not waited for: in a forked process nobody may be left to unlock it.
    let pool = KEPT.try_lock().ok()?.take()?;
    if pool.is_here() {
        return Some(pool);
    }
    std::mem::forget(pool);
    None
}
