//! Limit positions and limit normals of any scheme, by eigen-analysis of its ring matrix (the paper's
//! section 3.2, with left eigenvectors).
//!
//! Takes a scheme's masks and the shape of a ring; gives weights, tabulated by shape and built once on demand.

mod closed;
mod eigen;
mod error;
mod evaluate;
mod neighbourhood;
mod open;
mod refined;
mod stencil;
mod table;
mod weights;

pub use error::LimitError;
pub use neighbourhood::{difference_matrix, ring_matrix};
pub use stencil::{LimitStencil, TangentPlane};
pub use table::LimitTable;

#[cfg(test)]
mod tests;
