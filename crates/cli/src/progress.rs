//! What the program says on standard error while it works: a spinner on a terminal, and notes.
//!
//! `--quiet` silences both; errors are not printed here.

use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::time::Duration;

use crate::format::counted;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How often the spinner turns.
const TICK: Duration = Duration::from_millis(100);

/// The program's voice.
pub(crate) struct Progress {
    spinner: ProgressBar,
    quiet: bool,
    moving: bool,
}

impl Progress {
    /// Silent if `quiet`; without the spinner if standard error is no terminal.
    pub(crate) fn new(quiet: bool) -> Self {
        let moving = !quiet && std::io::stderr().is_terminal();
        let target = if moving { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let spinner = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
            spinner.set_style(style);
        }
        Self { spinner, quiet, moving }
    }

    /// Shows what is being done now.
    pub(crate) fn stage(&self, what: impl Into<String>) {
        if self.moving {
            self.spinner.set_message(what.into());
            self.spinner.enable_steady_tick(TICK);
        }
    }

    /// Shows what a long function of the library tells of itself.
    pub(crate) fn observer(&self) -> impl FnMut(&limitmesh::progress::Progress) -> ControlFlow<()> {
        let mut shown = None;
        move |at| {
            let percent = at.total.map(|total| 100 * at.done / total.max(1));
            let now = (at.stage, percent.ok_or(at.triangles));
            if shown.replace(now) != Some(now) {
                let far = match now.1 {
                    Ok(percent) => format!("{percent} %"),
                    Err(triangles) => counted(triangles, "triangle", "triangles"),
                };
                self.stage(format!("{}: {far}", at.stage));
            }
            ControlFlow::Continue(())
        }
    }

    /// Prints a line that stays, above the spinner.
    pub(crate) fn note(&self, line: impl AsRef<str>) {
        if !self.quiet {
            // Nobody is left to tell if standard error is closed.
            self.spinner.suspend(|| writeln!(std::io::stderr(), "{}", line.as_ref()).unwrap_or_default());
        }
    }

    /// Takes the spinner away.
    pub(crate) fn clear(&self) {
        self.spinner.finish_and_clear();
    }
}
