//! Ctrl-C: ends the program at once, but never in the middle of writing a file.
//!
//! Files are written to a temporary neighbour and renamed, so no reader ever sees half of one. The guard here
//! keeps an interrupt from leaving such a temporary file behind: it waits for the file in hand, unless the
//! user insists with a second Ctrl-C.

use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::Context;

/// What shells report for a program ended by Ctrl-C: 128 + SIGINT.
const INTERRUPTED: i32 = 130;

struct State {
    writing: bool,
    asked: bool,
}

static STATE: Mutex<State> = Mutex::new(State { writing: false, asked: false });

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes Ctrl-C end the program in good order.
pub(crate) fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        // Held while exiting, so that no write can begin meanwhile.
        let mut state = state();
        if !state.writing || state.asked {
            std::process::exit(INTERRUPTED);
        }
        state.asked = true;
    })
    .context("could not arrange for Ctrl-C")
}

/// Runs `write` to its end even if Ctrl-C is pressed meanwhile; then ends the program if it was.
pub(crate) fn uninterrupted<T>(write: impl FnOnce() -> T) -> T {
    state().writing = true;
    let result = write();
    let mut state = state();
    state.writing = false;
    if state.asked {
        std::process::exit(INTERRUPTED);
    }
    result
}
