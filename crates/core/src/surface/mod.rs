//! The limit surface of a control mesh in exact pieces, for schemes of Loop's family.
//!
//! Each control face carries a [`Patch`]: its corners and their one-ring, which is all that the surface over it
//! depends on. Refining a patch gives the four over its parts, at any depth, so that only what is needed is ever
//! computed; limit positions and normals of new vertices come with it. [`Pieces::deviation`] certifies how far a triangle
//! can be from the piece that it stands for.

mod bound;
mod characteristic;
mod facet;
mod fan;
mod gauge;
mod lattice;
mod net;
mod patch;
mod root;
mod rules;
mod spoke;

pub(crate) use bound::{Effort, Part, Pieces};
pub(crate) use facet::Facet;
pub(crate) use gauge::Deviation;
pub(crate) use patch::{LimitPoint, Patch};
pub(crate) use root::root_patch;
pub(crate) use rules::Rules;
