//! How far the output's format rounds vertices, and the room that goals leave for it.

use limitmesh::Mesh;
use limitmesh::refine::ErrorBounds;

use crate::arguments::RefineArguments;

/// The part of a length that is left where rounding takes some of it afterwards, unless that is most of it.
pub(super) fn with_room(length: f64, rounding: f64) -> f64 {
    let room = length - rounding;
    if room > 0.5 * length { room } else { length }
}

/// How far the output's format rounds a vertex at most: all lie in the box of the control mesh's.
///
/// # Errors
/// The output's name has no known format.
pub(super) fn most_rounding(arguments: &RefineArguments, control: &Mesh) -> anyhow::Result<f64> {
    if rounding(arguments, &[[0.1; 3]])? == 0.0 {
        return Ok(0.0);
    }
    let coordinates = control.positions().as_flattened();
    let largest = coordinates.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    // Half of the last place of `f32`, and of its least number, along each axis.
    let half = largest * f64::from(f32::EPSILON) * 0.5 + 0.5 * f64::from(f32::from_bits(1));
    Ok(3f64.sqrt() * half)
}

/// How far the output's format rounds these positions; not at all without a file.
///
/// # Errors
/// The output's name has no known format.
pub(super) fn rounding(arguments: &RefineArguments, positions: &[[f64; 3]]) -> anyhow::Result<f64> {
    let options = &arguments.write_options();
    Ok(arguments.format()?.map_or(0.0, |format| {
        limitmesh_io::rounding(format, options, positions)
    }))
}

/// The bounds of a distance after a file rounded the vertices by so much.
pub(super) fn rounded(mut error: ErrorBounds, rounding: f64) -> ErrorBounds {
    error.lower = (error.lower - rounding).max(0.0);
    error.upper += rounding;
    error
}
