//! From the document that was read, and geometry that takes the place of its own, to the document that is written.

pub(crate) mod apply;
pub(crate) mod geometry;
mod idle;
pub(crate) mod rest;
mod unused;
mod used;
