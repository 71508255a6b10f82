//! Out of the document: the faces of meshes, where the scene shows them, and what materials look like.

pub(crate) mod attributes;
mod backs;
mod disjoint;
mod kinds;
pub(crate) mod materials;
mod mode;
pub(crate) mod parts;
mod polygons;
mod poses;
pub(crate) mod primitive;
pub(crate) mod scene;
pub(crate) mod scene_channels;

pub use kinds::Joining;
