//! Processor time and memory of this process, from Linux's `/proc`: on a machine that others use as well, seconds by
//! the clock on the wall say little.

use anyhow::{Context, Result};

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
        Ok((Seconds { all: after.all - before.all, user: after.user - before.user }, result))
    })
}

/// `schedstat` counts nanoseconds, but not where they went; `stat` tells that in ticks of a hundredth of a second.
fn of_this_thread() -> Result<Seconds> {
    const TICKS_A_SECOND: f64 = 100.0;
    let read = |name: &str| {
        let path = format!("/proc/thread-self/{name}");
        std::fs::read_to_string(&path).with_context(|| format!("processor time needs Linux's {path}"))
    };
    let all = read("schedstat")?.split_whitespace().next().context("an empty schedstat")?.parse::<f64>()?;
    // The second field is the thread's name in brackets, which may hold blanks; user time is the twelfth after it.
    let stat = read("stat")?;
    let (_, fields) = stat.rsplit_once(')').context("no name in /proc/thread-self/stat")?;
    let user = fields.split_whitespace().nth(11).context("a short /proc/thread-self/stat")?;
    Ok(Seconds { all: all * 1e-9, user: user.parse::<f64>()? / TICKS_A_SECOND })
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
    let status = std::fs::read_to_string("/proc/self/status").context("memory needs Linux's /proc")?;
    let line = status.lines().find(|line| line.starts_with(name)).with_context(|| format!("no {name}"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1).context("no number after the name")?.parse()?;
    Ok(kilobytes * 1024)
}
