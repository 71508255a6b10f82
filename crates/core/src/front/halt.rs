//! Whether an observer has asked to stop, for loops whose steps are short.

use crate::progress::{Observer, Stage, Watch};

/// Steps between two calls of the observer: a fraction of a millisecond.
const STEPS: u32 = 256;

/// An observer that is called now and then, and its answer.
pub(super) struct Halt<'o> {
    watch: Watch<'o>,
    left: u32,
    is_asked: bool,
}

impl<'o> Halt<'o> {
    pub(super) fn new(observer: &'o mut Observer<'_>) -> Self {
        Self {
            watch: Watch::new(observer, Stage::Refining),
            left: 0,
            is_asked: false,
        }
    }

    /// Whether to go on after a step, with the number of triangles; once false, always false.
    pub(super) fn goes_on(&mut self, triangles: usize) -> bool {
        if self.left == 0 {
            self.left = STEPS;
            self.watch.triangles(triangles);
            self.is_asked |= self.watch.poll().is_err();
        }
        self.left -= 1;
        !self.is_asked
    }

    pub(super) fn is_asked(&self) -> bool {
        self.is_asked
    }

    /// The watch that other loops poll.
    pub(super) fn watch(&mut self) -> &mut Watch<'o> {
        &mut self.watch
    }
}
