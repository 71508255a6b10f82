//! glTF: numbers by hand, flaws by name, edits that touch nothing else.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests fail as the tests do"
)]

mod accessors;
mod assets;
mod editing;
mod embedded;
mod extensions;
mod flaws;
mod fresh_documents;
mod joining;
mod levels;
mod mutations;
mod polygons;
mod scenes;
mod stale;
mod support;
mod unused;
