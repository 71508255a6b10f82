//! Tests that look into the program.

pub(crate) mod pages;
