//! Messages on standard error while the program works: a spinner on a terminal, and notes.
//!
//! `--quiet` silences both; errors are not printed here.

use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::time::Duration;

use crate::format::counted;
use crate::interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use limitmesh::progress::Stage;

/// How often the spinner turns.
const TICK: Duration = Duration::from_millis(100);

/// A program that runs a command, and hears how it goes on.
pub trait Host {
    /// Called by long functions of the library; may stop the command.
    fn observe(&self, at: &limitmesh::progress::Progress) -> ControlFlow<()>;
    /// A line that the program would print on standard error.
    fn note(&self, line: &str);
}

/// The phases of an optimised refinement: a fine mesh, collapses, and the result of these.
#[derive(Default)]
pub(crate) struct Phases {
    has_collapsed: bool,
    last: usize,
}

impl Phases {
    /// How many there are.
    const COUNT: usize = 3;

    /// The phase that a stage belongs to, counted from 1; never less than before.
    fn at(&mut self, stage: Stage) -> usize {
        self.has_collapsed |= stage == Stage::Simplifying;
        let phase = match stage {
            Stage::Simplifying => 2,
            // The fine mesh is made ready for the collapses, or what is left is measured.
            Stage::Indexing | Stage::Matching if !self.has_collapsed => 2,
            Stage::Limits | Stage::Refining | Stage::Assembling | Stage::Bounding
                if !self.has_collapsed =>
            {
                1
            }
            _ => 3,
        };
        self.last = self.last.max(phase);
        self.last
    }
}

/// The program's voice.
pub(crate) struct Progress<'a> {
    spinner: ProgressBar,
    quiet: bool,
    moving: bool,
    /// Another program that hears what there is to say.
    host: Option<&'a dyn Host>,
}

impl<'a> Progress<'a> {
    /// Tells another program.
    pub(crate) fn to_host(host: &'a dyn Host) -> Self {
        Self {
            host: Some(host),
            ..Self::new(true)
        }
    }

    /// Silent if `quiet`; without the spinner if standard error is no terminal.
    pub(crate) fn new(quiet: bool) -> Self {
        let moving = !quiet && std::io::stderr().is_terminal();
        let target = if moving {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let spinner = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
            spinner.set_style(style);
        }
        Self {
            spinner,
            quiet,
            moving,
            host: None,
        }
    }

    /// Shows what is being done now.
    pub(crate) fn stage(&self, what: impl Into<String>) {
        let what = what.into();
        interrupt::doing(&what);
        if self.moving {
            self.spinner.set_message(what);
            self.spinner.enable_steady_tick(TICK);
        }
    }

    /// Shows what a long function of the library reports.
    pub(crate) fn observer(&self) -> impl FnMut(&limitmesh::progress::Progress) -> ControlFlow<()> {
        self.observer_in_phases(None)
    }

    /// An observer that shows the stage after its phase.
    pub(crate) fn observer_in_phases(
        &self,
        mut phases: Option<Phases>,
    ) -> impl FnMut(&limitmesh::progress::Progress) -> ControlFlow<()> {
        let mut shown = None;
        move |at| {
            let percent = at.total.map(|total| 100 * at.done / total.max(1));
            let phase = phases.as_mut().map(|phases| phases.at(at.stage));
            let now = (at.stage, percent.ok_or(at.triangles));
            if shown.replace(now) != Some(now) {
                let far = match now.1 {
                    Ok(percent) => format!("{percent} %"),
                    Err(triangles) => counted(triangles, "triangle", "triangles"),
                };
                let phase = phase.map_or_else(String::new, |phase| {
                    format!("phase {phase} of {}, ", Phases::COUNT)
                });
                self.stage(format!("{phase}{}: {far}", at.stage));
            }
            self.answer(at)
        }
    }

    /// The answer of another program, if one listens.
    pub(crate) fn answer(&self, at: &limitmesh::progress::Progress) -> ControlFlow<()> {
        self.host
            .map_or(ControlFlow::Continue(()), |host| host.observe(at))
    }

    /// Prints a line that stays, above the spinner.
    pub(crate) fn note(&self, line: impl AsRef<str>) {
        if let Some(host) = self.host {
            host.note(line.as_ref());
        }
        if !self.quiet {
            // Nobody is left to read it if standard error is closed.
            self.spinner
                .suspend(|| writeln!(std::io::stderr(), "{}", line.as_ref()).unwrap_or_default());
        }
    }

    /// Prints lines that stay.
    pub(crate) fn notes(&self, lines: impl IntoIterator<Item = impl AsRef<str>>) {
        lines.into_iter().for_each(|line| self.note(line));
    }

    /// A note for those who see no spinner.
    pub(crate) fn note_where_nothing_moves(&self, line: impl AsRef<str>) {
        if !self.moving {
            self.note(line);
        }
    }

    /// Takes the spinner away.
    pub(crate) fn clear(&self) {
        self.spinner.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_go_on() {
        let mut phases = Phases::default();
        let stages = [
            (Stage::Limits, 1),
            (Stage::Refining, 1),
            (Stage::Bounding, 1),
            (Stage::Assembling, 1),
            (Stage::Indexing, 2),
            (Stage::Simplifying, 2),
            (Stage::Indexing, 3),
            (Stage::Sampling, 3),
            // A second attempt.
            (Stage::Refining, 3),
            (Stage::Simplifying, 3),
        ];
        for (stage, phase) in stages {
            assert_eq!(phases.at(stage), phase, "{stage}");
        }
    }
}
