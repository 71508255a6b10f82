//! How good the meshes are, over many models: exact refinement beside the paper's method, uniform refinement, quadric
//! simplification and the asymptotic optimum; how fast it is, and how tight its certificate.
//!
//! Every comparison prints one table in Markdown, as it stands in docs/benchmarks.md.

mod cast;
mod certificate;
mod judge;
mod optimum;
mod paper;
mod simplified;
mod table;
mod throughput;
mod uniform;

pub(crate) use cast::builtin;
pub(crate) use certificate::certificate;
pub(crate) use judge::{Judge, Reference};
pub(crate) use optimum::{against_optimum, optimized};
pub(crate) use paper::{against_paper, best};
pub(crate) use simplified::against_simplified;
pub(crate) use throughput::{child as throughput_child, throughput};
pub(crate) use uniform::against_uniform;
