//! Processor time of a thread and memory of this process: on a machine that others use as well, seconds by the clock on the wall say little.

use anyhow::{Context, Result};
use rustix::time::{ClockId, clock_gettime};

/// Processor seconds that a piece of work took on one thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seconds {
    /// In the program and in the kernel, which hands out fresh pages.
    pub(crate) all: f64,
    /// In the program alone; known to a hundredth of a second.
    pub(crate) user: f64,
}

/// Runs `work` on a pool of one thread and tells that thread's seconds.
pub(crate) fn one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> Result<(Seconds, T)> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(|| {
        let before = of_this_thread()?;
        let result = work();
        let after = of_this_thread()?;
        Ok((
            Seconds {
                all: after.all - before.all,
                user: after.user - before.user,
            },
            result,
        ))
    })
}

/// The thread's clock counts nanoseconds, but not where they went; Linux's `stat` tells that in ticks of a hundredth of a second. (Its
/// `schedstat` counts nanoseconds, too, but lags behind by up to four milliseconds, so that the least of several runs is too little.)
fn of_this_thread() -> Result<Seconds> {
    const TICKS_A_SECOND: f64 = 100.0;
    let path = "/proc/thread-self/stat";
    let stat = std::fs::read_to_string(path)
        .with_context(|| format!("processor time needs Linux's {path}"))?;
    let now = clock_gettime(ClockId::ThreadCPUTime);
    // The second field is the thread's name in brackets, which may hold blanks; user time is the twelfth after it.
    let (_, fields) = stat
        .rsplit_once(')')
        .context("no name in /proc/thread-self/stat")?;
    let user = fields
        .split_whitespace()
        .nth(11)
        .context("a short /proc/thread-self/stat")?;
    Ok(Seconds {
        all: now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9,
        user: user.parse::<f64>()? / TICKS_A_SECOND,
    })
}

/// The greatest resident memory this process has had, in bytes.
pub(crate) fn peak_bytes() -> Result<u64> {
    status("VmHWM:")
}

/// The resident memory this process has now, in bytes.
pub(crate) fn resident_bytes() -> Result<u64> {
    status("VmRSS:")
}

fn status(name: &str) -> Result<u64> {
    let status =
        std::fs::read_to_string("/proc/self/status").context("memory needs Linux's /proc")?;
    let line = status
        .lines()
        .find(|line| line.starts_with(name))
        .with_context(|| format!("no {name}"))?;
    let kilobytes: u64 = line
        .split_whitespace()
        .nth(1)
        .context("no number after the name")?
        .parse()?;
    Ok(kilobytes * 1024)
}
