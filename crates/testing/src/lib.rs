//! What unit tests of several crates share: random numbers that are the same on every run, and meshes.

pub mod models;
mod random;

pub use random::Random;
