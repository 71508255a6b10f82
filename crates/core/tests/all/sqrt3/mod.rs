//! √3-subdivision: steps against a plain implementation from maps of edges, limits against closed forms and against the steps.

// Helpers of a test fail it by panicking.
#![allow(clippy::unwrap_used)]

mod adaptive;
mod limits;
mod models;
mod plain;
mod uniform;
