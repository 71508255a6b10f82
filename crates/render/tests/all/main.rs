//! Pictures against what is known of them beforehand, in one program.

mod by_rays;
mod geometry;
mod images;
mod textures;
mod wires;
