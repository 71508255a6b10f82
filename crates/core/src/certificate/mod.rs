//! How far a triangle can be from the piece of the limit surface that it stands for. Knows no forest.
//!
//! [`Pieces::deviation`] bounds that distance, both ways: proven for schemes of Loop's family, an estimate from samples
//! for others. A triangle is prepared once as a [`TriangleFrame`], and stands for a [`SubTriangle`] of a patch.

mod bounds;
mod deviation;
mod sampled;
mod sub_triangle;
mod triangle_frame;

pub(crate) use bounds::{Effort, Pieces};
pub(crate) use deviation::Deviation;
pub(crate) use sampled::Samples;
pub(crate) use sub_triangle::SubTriangle;
pub(crate) use triangle_frame::TriangleFrame;
