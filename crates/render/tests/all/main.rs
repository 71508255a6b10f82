//! Pictures against what is known of them beforehand, in one program.

mod by_rays;
mod geometry;
mod images;
mod support;
mod textures;
mod wires;
