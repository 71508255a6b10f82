//! The greatest distance of a triangle from the piece of the limit surface that it approximates.
//! Knows no forest.
//!
//! [`Pieces::deviation`] bounds that distance, both ways: proven for known schemes, an estimate
//! from samples for other schemes. A triangle is prepared once as a [`TriangleFrame`], and
//! approximates a [`SubTriangle`] of a patch.
//!
//! NaN fails: every comparison with a limit requires that the value is known to be below it.

mod bent_parts;
mod borders;
mod bounds;
mod cell_rows;
mod deviation;
mod dihedral;
mod effort;
mod greatest;
mod hull_points;
mod interpolation;
mod net;
mod net_part;
mod parametric;
mod quartic_cell;
mod sampled;
mod search;
mod sub_triangle;
mod triangle_frame;
mod trilinear;

pub(crate) use bent_parts::{Bender, Bent, BentFour, FOUR, MovedFour, normals};
pub(crate) use bounds::{Pieces, at_a_glance};
pub(crate) use cell_rows::{CellRows, MOST_DIVISIONS, Mark, Marks, RowBlock, RowExtent, RowTarget};
pub(crate) use deviation::Deviation;
pub(crate) use dihedral::around;
pub(crate) use effort::Effort;
pub(crate) use interpolation::ParamPatch;
pub(crate) use net_part::NetPart;
pub(crate) use parametric::SecondDerivatives;
pub(crate) use quartic_cell::{Cell, EdgeBounds, Heights, QuarticJet, quadratic_height};
pub(crate) use search::QuadPieces;
pub(crate) use sub_triangle::SubTriangle;
pub(crate) use triangle_frame::{TriangleFrame, least_slope};

/// Whether a value is not known to be within a limit: also where either is NaN.
#[inline]
#[expect(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "what is not a number must not pass"
)]
pub(crate) fn exceeds(value: f64, limit: f64) -> bool {
    !(value <= limit)
}

/// The greater of two, infinite where either is NaN.
#[inline]
fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::INFINITY
    } else {
        a.max(b)
    }
}
