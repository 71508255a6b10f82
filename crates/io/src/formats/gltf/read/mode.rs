//! How a primitive joins its vertices, and the indices by which it names them.

use crate::flaw::{Flaw, Result};
use crate::formats::gltf::document::extensions::LOOPS;
use crate::formats::gltf::document::json::At;

/// How a primitive joins its vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Points and lines, which are left as they are.
    Other,
    /// Line loops around polygons.
    Loops,
    Triangles,
    Strip,
    Fan,
}

/// The mode of a primitive.
pub(super) fn mode(primitive: &At<'_>) -> Result<Mode> {
    let Some(mode) = primitive.get("mode") else {
        return Ok(Mode::Triangles);
    };
    match mode.count()? {
        2 if primitive.path(&["extensions", LOOPS]).is_some() => Ok(Mode::Loops),
        0..=3 => Ok(Mode::Other),
        4 => Ok(Mode::Triangles),
        5 => Ok(Mode::Strip),
        6 => Ok(Mode::Fan),
        _ => Err(mode.unexpected("0 to 6")),
    }
}

/// The indices of an accessor, if all are below the number of vertices.
pub(super) fn checked(corners: Vec<u32>, count: usize, at: &At<'_>) -> Result<Vec<u32>> {
    let Some(i) = corners.iter().position(|&v| v as usize >= count) else {
        return Ok(corners);
    };
    let found = format!("{} in element {i}", corners[i]);
    let expected = format!("indices below {count} (the number of vertices)");
    Err(Flaw::new(at.place(), found, expected))
}
