//! What is checked before anything is drawn: sizes, counts, numbers and indices.

use limitmesh::Triangles;

use crate::RenderError;

/// The longest side a picture may have, in pixels: one of 16384 × 16384 takes a gigabyte.
pub const MAX_SIDE: u32 = 16_384;

pub(crate) fn check_size(width: u64, height: u64) -> Result<(), RenderError> {
    let fits = |side: u64| (1..=u64::from(MAX_SIDE)).contains(&side);
    if fits(width) && fits(height) {
        Ok(())
    } else {
        Err(RenderError::Size {
            width,
            height,
            limit: MAX_SIDE,
        })
    }
}

pub(crate) fn check_count(
    what: &'static str,
    met: usize,
    expected: usize,
) -> Result<(), RenderError> {
    if met == expected {
        Ok(())
    } else {
        Err(RenderError::Count {
            what,
            met,
            expected,
        })
    }
}

pub(crate) fn check_finite<const N: usize>(
    what: &'static str,
    values: &[[f64; N]],
) -> Result<(), RenderError> {
    for (index, value) in values.iter().enumerate() {
        if let Some(&value) = value.iter().find(|x| !x.is_finite()) {
            return Err(RenderError::NotFinite { what, index, value });
        }
    }
    Ok(())
}

pub(crate) fn check_surface(surface: Triangles<'_>) -> Result<(), RenderError> {
    if surface.triangles.is_empty() {
        return Err(RenderError::Empty);
    }
    // Clipping may cut a triangle into seven; all pieces, and their corners, must have an index.
    let limit = (u32::MAX / 16) as usize;
    let count = surface.triangles.len().max(surface.positions.len());
    if count > limit {
        return Err(RenderError::TooMany { count, limit });
    }
    let count = surface.positions.len();
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
            return Err(RenderError::VertexOutOfRange {
                triangle,
                vertex,
                count,
            });
        }
    }
    check_finite("position", surface.positions)
}
