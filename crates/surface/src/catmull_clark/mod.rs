//! Catmull–Clark subdivision of quads: rules, limits and pieces of its surface.
//!
//! Its rules need the points opposite a vertex in its quads, so that its rings are not those of triangle schemes ([`ring`]). Quads
//! ([`quads`]) refine by weights ([`step`]). The surface over half a quad is a bicubic polynomial ([`bicubic`]) where it is regular;
//! elsewhere it is refined with its surroundings until it is ([`form`]).

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
