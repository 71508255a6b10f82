//! How far the output's format rounds vertices.

use limitmesh::Mesh;
use limitmesh::refine::most_rounding_to_single;

use crate::arguments::RefineArguments;

/// How far the output's format rounds a vertex at most: all lie in the box of the control mesh's.
///
/// # Errors
/// The output's name has no known format.
pub(super) fn most_rounding(arguments: &RefineArguments, control: &Mesh) -> anyhow::Result<f64> {
    if rounding(arguments, &[[0.1; 3]])? == 0.0 {
        return Ok(0.0);
    }
    Ok(most_rounding_to_single(control.positions()))
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
