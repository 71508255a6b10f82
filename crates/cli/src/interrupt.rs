//! Ctrl-C, SIGTERM and SIGHUP: end the program at once, also while it writes a file, and say what was cancelled.
//!
//! Files are written to a temporary neighbour and renamed, so no reader ever sees half of one; a signal on the way removes
//! the neighbour. Only a batch finishes writing its results first.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::Context;

/// The current stage, for the message of an interrupt.
struct State {
    /// The file that is being written, and how many had been finished before.
    writing: Option<(PathBuf, usize)>,
    /// The signal that came meanwhile.
    asked: Option<Signal>,
    doing: String,
    written: Vec<String>,
    /// Whether signals are only noted.
    is_left_to_caller: bool,
}

static STATE: Mutex<State> = Mutex::new(State {
    writing: None,
    asked: None,
    doing: String::new(),
    written: Vec::new(),
    is_left_to_caller: false,
});

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A signal that ends the program.
#[derive(Clone, Copy)]
struct Signal {
    name: &'static str,
    number: i32,
}

/// The signals that end the program in good order.
const SIGNALS: [Signal; 3] = [
    Signal {
        name: "SIGHUP",
        number: 1,
    },
    Signal {
        name: "Ctrl-C",
        number: 2,
    },
    Signal {
        name: "SIGTERM",
        number: 15,
    },
];

/// Makes the signals end the program in good order, but for those that whoever started it has it ignore, as `nohup` does.
#[cfg(unix)]
pub(crate) fn install() -> anyhow::Result<()> {
    let ignored = ignored_signals();
    let heeded = SIGNALS.map(|signal| signal.number);
    let heeded = heeded
        .into_iter()
        .filter(|number| ignored >> (number - 1) & 1 == 0);
    let mut signals =
        signal_hook::iterator::Signals::new(heeded).context("could not arrange for signals")?;
    std::thread::spawn(move || {
        for number in signals.forever() {
            SIGNALS
                .iter()
                .filter(|signal| signal.number == number)
                .for_each(|&signal| end(signal));
        }
    });
    Ok(())
}

/// A bit for each signal that is ignored from the start, where the system says.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    line.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok())
        .unwrap_or(0)
}

/// Makes Ctrl-C end the program in good order.
#[cfg(not(unix))]
pub(crate) fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| end(SIGNALS[1])).context("could not arrange for Ctrl-C")
}

/// Ends the program, or leaves that to its caller.
fn end(signal: Signal) {
    // Held while exiting, so that no write can begin meanwhile.
    let mut state = state();
    if state.is_left_to_caller {
        if let Some((path, _)) = &state.writing {
            say(&format!("{} is written to its end first", path.display()));
        }
        state.asked = Some(signal);
        return;
    }
    // Held, too, so that no file takes its name any longer.
    let abandoned = limitmesh_io::abandon_unfinished();
    if let Some((path, _)) = state
        .writing
        .take_if(|(_, before)| abandoned.finished_files() > *before)
    {
        state.written.push(path.display().to_string());
    }
    exit(&state, signal)
}

/// From now on signals are only noted: the caller has work of its own to end. It asks [`is_asked`], and then calls
/// [`end_as_asked`].
pub(crate) fn leave_to_caller() {
    state().is_left_to_caller = true;
}

/// Whether a signal wants the program to end.
pub(crate) fn is_asked() -> bool {
    state().asked.is_some()
}

/// Ends the program if a signal wants that; the file of that name is there, as far as the work went.
pub(crate) fn end_as_asked(written: String) {
    let mut state = state();
    state.written.push(written);
    if let Some(signal) = state.asked {
        exit(&state, signal);
    }
}

/// Ends the program, as SIGTERM does, when its standard input ends: when whoever started it is no more, or wants that.
pub(crate) fn end_with_standard_input() {
    std::thread::spawn(|| {
        // An error is an end, too.
        let _ = std::io::copy(&mut std::io::stdin().lock(), &mut std::io::sink());
        end(Signal {
            name: "the end of standard input",
            number: 15,
        });
    });
}

/// Says what was cancelled, and exits with what shells report for a program that a signal ended.
fn exit(state: &State, signal: Signal) -> ! {
    let unfinished = state.writing.as_ref().map(|(path, _)| path);
    let doing = match unfinished {
        Some(path) => format!(" while writing {}", path.display()),
        None if state.doing.is_empty() => String::new(),
        None => format!(" while {}", state.doing),
    };
    // Whoever reads from a pipe may have some of it.
    let is_read = |path: &PathBuf| std::fs::metadata(path).is_ok_and(|there| !there.is_file());
    let written = match state.written.as_slice() {
        [] if unfinished.is_some_and(is_read) => "part of it may have been read".to_owned(),
        [] => "nothing was written".to_owned(),
        names => format!("{} written by then", names.join(", ")),
    };
    say(&format!("cancelled by {}{doing}; {written}", signal.name));
    std::process::exit(128 + signal.number)
}

/// Prints a line on standard error, if anybody is left to read it.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}{line}", line_start());
}

/// Clears the line of the spinner on a terminal.
fn line_start() -> &'static str {
    if std::io::stderr().is_terminal() {
        "\r\u{1b}[K"
    } else {
        ""
    }
}

/// Remembers what is being done.
pub(crate) fn doing(what: &str) {
    state().doing.replace_range(.., what);
}

/// Runs what takes a moment and leaves nothing behind; a signal that comes meanwhile waits.
pub(crate) fn undisturbed<T>(work: impl FnOnce() -> T) -> T {
    let _held = state();
    work()
}

/// Runs `write`, which writes this file: whole or not at all, also where a signal ends the program meanwhile.
///
/// Where signals are left to the caller, one that came meanwhile ends the program afterwards.
pub(crate) fn whole_or_not<T, E>(
    path: &Path,
    write: impl FnOnce() -> Result<T, E>,
) -> Result<T, E> {
    state().writing = Some((path.to_owned(), limitmesh_io::finished_files()));
    let result = write();
    let mut state = state();
    state.writing = None;
    if result.is_ok() {
        state.written.push(path.display().to_string());
    }
    if let Some(signal) = state.asked {
        exit(&state, signal);
    }
    drop(state);
    result
}
