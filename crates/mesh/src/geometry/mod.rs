//! Geometry that several rooms share: edges and their triangles, disjoint sets, the closest point
//! of a triangle and its solid angle, the inside of a rim in the plane, a tree of boxes,
//! coordinates in which a surface is about as large as 1. Knows no mesh.

pub mod box_tree;
mod disjoint_sets;
mod edges;
pub mod planar;
mod surface_frame;
mod triangle;

pub use disjoint_sets::DisjointSets;
pub(crate) use edges::{EdgeSide, every_edge, for_each_edge};
pub use surface_frame::SurfaceFrame;
pub use triangle::{Projection, closest_to_origin, nearer, solid_angle};

/// The index that means "no element".
pub const NONE: u32 = u32::MAX;
