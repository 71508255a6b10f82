//! Conforming triangles out of a refinement: the split patterns of the paper's Figure 5.
//!
//! Takes which edges of a triangle are split, gives the triangles that cover it and how they hang together.

mod closure;

pub use closure::{Diagonal, Pattern, closure};
