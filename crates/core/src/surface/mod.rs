//! The limit surface of a control mesh in exact pieces.
//!
//! Each control face carries a [`Patch`]: its corners and their one-ring, which is all that the surface over it
//! depends on. Refining a patch gives the four over its parts, at any depth, so that only what is needed is ever
//! computed; limit positions and normals of new vertices come with it. [`Pieces::deviation`] certifies how far a triangle
//! can be from the piece that it stands for. Schemes of Loop's family have pieces of simple forms; for others, and where
//! tags still fade, a piece is a small mesh that is refined as a whole.

mod bound;
mod characteristic;
mod crop;
mod facet;
mod fan;
mod gauge;
mod lattice;
mod local;
mod net;
mod patch;
mod root;
mod rules;
mod sampled;
mod spoke;

pub(crate) use bound::{Effort, Part, Pieces};
pub(crate) use facet::Facet;
pub(crate) use gauge::Deviation;
pub(crate) use patch::{LimitPoint, Patch};
pub(crate) use root::root_patch;
pub(crate) use rules::Rules;
pub(crate) use sampled::Samples;
