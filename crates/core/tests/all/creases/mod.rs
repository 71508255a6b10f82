//! Creases, corners and darts: refinement against a plain implementation of the rules and against OpenSubdiv's, limits
//! against iteration, and what must hold for every tagged mesh.

// Helpers of a test fail it by panicking.
#![allow(clippy::unwrap_used)]

mod concave;
mod features;
mod limits;
mod plain;
mod random;
mod refinement;
