//! Organic control meshes with an exact number of triangles, sculpted from an implicit body.
//!
//! Takes a field (negative inside), mirror-symmetric in x; gives a closed, symmetric control mesh: the half with
//! x ≥ 0 is contoured on a grid, coarsened by edge collapses, smoothed, mirrored, and its vertices moved so that
//! Loop's limit surface, not the control mesh, lies on the body.
//!
//! Only +, −, ·, / and √ decide, which IEEE 754 rounds alike everywhere: the meshes are the same on every platform.

mod collapse;
mod contour;
pub(super) mod field;
mod fit;
mod polish;
mod surface;
#[cfg(test)]
mod tests;

pub(super) use contour::Grid;
pub(super) use fit::mirrored_with_limit_through;
pub(super) use surface::Surface;

use glam::DVec3;

/// A signed field: negative inside the body, positive outside, roughly a distance near its surface.
pub(super) type Field<'a> = &'a dyn Fn(DVec3) -> f64;

/// The control mesh of `triangles` triangles (even) for the body where `field` is negative.
///
/// `grid` must cover the half of the body with x ≥ 0 from the plane x = 0 on; `field` must not depend on the
/// sign of x.
pub(super) fn sculpt(field: Field<'_>, grid: &Grid, triangles: usize) -> Surface {
    let mut half = contour::contour(field, grid);
    // Smoothing between the collapses lets the second half of them start from well-shaped triangles.
    collapse::collapse_to(&mut half, triangles);
    polish::polish(&mut half, field);
    collapse::collapse_to(&mut half, triangles / 2);
    polish::polish(&mut half, field);
    mirrored_with_limit_through(&half, 6)
}
