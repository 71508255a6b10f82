//! The `limitmesh` program.
fn main() {}
