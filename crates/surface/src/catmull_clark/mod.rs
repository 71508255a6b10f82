//! Catmull–Clark subdivision of quads: rules, limits and pieces of its surface.
//!
//! Its rules need the points opposite a vertex in its quads, so that its rings (`ring`) are not those of triangle schemes. Quads
//! (`quads`) refine by weights (`step`, `masks`). The surface over half a quad is a bicubic polynomial (`bicubic`) where it is regular;
//! elsewhere it is refined with its surroundings until it is (`form`, `piece`). Polygons become quads first (`control`).

pub mod bicubic;
mod control;
pub(crate) mod form;
pub(crate) mod limits;
pub(crate) mod masks;
pub mod piece;
pub(crate) mod quads;
pub(crate) mod ring;
pub mod sextic;
mod step;

pub use control::QuadControl;
