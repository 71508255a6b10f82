//! How long something takes.

use core::time::Duration;
use std::time::Instant;

/// A clock that was started; where the platform has none, as WebAssembly outside a browser's interface, it stands still.
pub(crate) struct Clock(Option<Instant>);

impl Clock {
    pub(crate) fn start() -> Self {
        let exists = !cfg!(all(target_family = "wasm", target_os = "unknown"));
        Self(exists.then(Instant::now))
    }

    /// The time since its start.
    pub(crate) fn elapsed(&self) -> Duration {
        self.0.map_or(Duration::ZERO, |start| start.elapsed())
    }
}
