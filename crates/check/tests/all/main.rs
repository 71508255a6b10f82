//! The checker on meshes made by hand and at random, by witnesses that are here alone: another Loop refinement, and distances by brute force.

// Helpers of a test fail it by panicking.
#![allow(clippy::unwrap_used, clippy::panic, clippy::expect_used)]

mod cage;
mod manifest;
mod program;
mod readers;
mod tilings;
mod wild;
