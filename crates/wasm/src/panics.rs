//! What is left to say after a panic: the instance is lost, but its memory can be read once more.

use std::sync::{Mutex, PoisonError};

use wasm_bindgen::prelude::*;

static LAST: Mutex<Option<String>> = Mutex::new(None);

/// Keeps what a panic says, as there is no console to print it on.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| {
        *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic.to_string());
    }));
}

/// What the last panic said; none where something else ended the module, such as an allocation that failed.
#[wasm_bindgen]
pub fn last_panic() -> Option<String> {
    LAST.lock().unwrap_or_else(PoisonError::into_inner).take()
}
