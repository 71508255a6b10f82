//! Catmull–Clark subdivision of quads: its rules, and control meshes of quads.
//!
//! Its rules need the points opposite a vertex in its quads, so that its rings (`ring`) are not those of triangle schemes. Quads
//! (`quads`) refine by weights (`step`, `masks`); what a step makes of the surroundings of one is found once (`form`). Polygons become
//! quads first (`control`).

mod channels;
mod control;
pub(crate) mod form;
pub(crate) mod masks;
pub(crate) mod quads;
pub(crate) mod ring;
pub(crate) mod step;

pub use control::{QuadControl, QuadOptions};
