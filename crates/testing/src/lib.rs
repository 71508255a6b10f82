//! What tests of several crates share: random numbers that are the same on every run, meshes,
//! and comparisons.

pub mod models;
mod ordered;
mod random;

pub use random::Random;
