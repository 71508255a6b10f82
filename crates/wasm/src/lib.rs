//! The engine of the npm package limitmesh: options in, arrays out.
//!
//! TypeScript checks options and completes them ([`inputs`]); here they become the library's, and results become arrays. Whatever goes wrong
//! is thrown as an array of three texts: code, place and message ([`failure`]).
//!
//! ```text
//! inputs ─▶ soup ─▶ control ─▶ refine, limit, measure ─▶ arrays
//! ```

// What JavaScript calls is public in private modules.
#![allow(unreachable_pub)]

#[cfg(feature = "io")]
mod asset;
mod channels;
mod control;
mod failure;
#[cfg(feature = "io")]
mod files;
mod inputs;
mod limit;
mod measure;
mod options;
mod panics;
mod refine;
mod soup;
mod told;
