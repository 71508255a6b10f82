//! The mesh that approximates a limit surface when distances are measured, as in the paper: the control mesh refined
//! uniformly, all vertices moved to the limit.

use limitmesh::refine::{Stop, UniformOptions, reference_levels, uniform};
use limitmesh::scheme::Scheme;
use limitmesh::{Mesh, Triangles};

use crate::failure::usage;
use crate::format::thousands;

/// Fewer levels are hardly finer than what is measured against them.
const FEWEST: usize = 2;

/// Levels that are enough for most: the distance of such a mesh to the limit surface is about a thousandth of the
/// control mesh's.
pub(crate) const USUAL_LEVELS: usize = 5;

/// Triangles that a reference has at most if the program chooses: it and its search tree take about a gigabyte.
const CHOSEN_TRIANGLES: usize = 4_000_000;

/// Triangles that a reference has at most whatever is asked for.
const MOST_TRIANGLES: usize = 50_000_000;

/// A mesh that approximates a limit surface.
pub(crate) struct Reference {
    /// The mesh, its vertices on the limit surface.
    pub(crate) mesh: Mesh,
    /// Levels of uniform refinement.
    pub(crate) levels: usize,
}

/// As many of the `wanted` levels as keep the reference below [`CHOSEN_TRIANGLES`], but [`FEWEST`] at least.
pub(crate) fn affordable_levels(control_faces: usize, wanted: usize) -> usize {
    let fits =
        |&levels: &usize| faces_at(control_faces, levels).is_some_and(|n| n <= CHOSEN_TRIANGLES);
    (FEWEST..=wanted).rev().find(fits).unwrap_or(FEWEST)
}

/// The levels that were asked for, or those that suit what is measured.
///
/// # Errors
/// The reference would be the control mesh's own triangles, or too large.
pub(crate) fn levels_for(
    control: &Mesh,
    measured: Triangles<'_>,
    asked: Option<usize>,
) -> anyhow::Result<usize> {
    let found = match asked {
        Some(0) => {
            return usage(
                "--reference-levels 0 would measure against the control mesh's own triangles; 1 is the least",
            );
        }
        Some(levels) => return Ok(levels),
        None => reference_levels(control.face_count(), measured.triangles.len()),
    };
    let Some(levels) = found else {
        return usage(format!(
            "a mesh of {} triangles is not compared with a reference for the limit surface that is two levels finer, which \
             is too large; --certified measures against the limit surface itself, --reference-levels against a coarser \
             reference",
            thousands(measured.triangles.len())
        ));
    };
    Ok(levels)
}

/// Number of faces after so many levels of uniform refinement, if it can be counted.
fn faces_at(control_faces: usize, levels: usize) -> Option<usize> {
    4usize
        .checked_pow(levels as u32)?
        .checked_mul(control_faces)
}

/// Builds the reference at the given level.
///
/// # Errors
/// It would be too large for any use, or the scheme has no limit there.
pub(crate) fn at_level(
    control: &Mesh,
    scheme: &dyn Scheme,
    levels: usize,
) -> anyhow::Result<Reference> {
    let options = UniformOptions::default()
        .levels(levels)
        .limit(true)
        .max_triangles(Some(MOST_TRIANGLES));
    let refinement = uniform(control, scheme, &options)?;
    if let Stop::TriangleCap { .. } = refinement.stop {
        return usage(format!(
            "--reference-levels {levels} is too many for a control mesh of {} faces: the reference would have more \
             than {} triangles; {} levels are possible",
            thousands(control.face_count()),
            thousands(MOST_TRIANGLES),
            refinement.steps.len(),
        ));
    }
    Ok(Reference {
        mesh: refinement.mesh,
        levels,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_keep_within_the_budget() {
        assert_eq!(affordable_levels(142, 5), 5);
        assert_eq!(affordable_levels(530_450, 5), 2);
        assert_eq!(faces_at(142, 3), Some(9088));
        assert_eq!(faces_at(usize::MAX, 3), None);
    }
}
