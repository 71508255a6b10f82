//! How far a refined mesh is from the mesh that was read: what the library proves of it, with faces that were divided and triangles that
//! reach over several, and the lines about that.

use std::borrow::Cow;

use limitmesh::mesh::FaceParts;
use limitmesh::part::Look;
use limitmesh::refine::{Exact, ExactOptions, InputDistance, Origin, exact_observed};
use limitmesh::{FaceId, Mesh};

use super::goals::Goals;
use super::refined::INTERPOLATE;
use super::task::Task;
use crate::arguments::MOST_EXACT;
use crate::format::{counted, number};
use crate::report::{ErrorReport, IntervalReport};
use crate::vector::{cross, dot, length};

/// Where triangles reach over several control faces, a mesh approximates the limit surface within this share of the diagonal.
const BETWEEN: f64 = 5e-4;

/// How far the result is from the mesh that was read; `None` where nobody asks, or nothing is proven.
///
/// # Errors
/// Coordinates too large to be measured, or somebody asked to stop.
pub(super) fn measured(
    task: &Task<'_>,
    found: &Exact,
    goals: &Goals,
) -> anyhow::Result<Option<InputDistance>> {
    let control = task.control;
    let Some(input) = control.surface() else {
        return Ok(None);
    };
    let (parts, residual) = (&control.concave.parts, control.residual);
    let observer = &mut task.progress.observer();
    let origins = on_whole(parts, found);
    let moved = match InputDistance::new(input, found, &origins, residual)? {
        Some(moved) => moved,
        None if !found.error.certified => return Ok(None),
        None => {
            // Triangles that reach over several control faces: the limit surface lies between, with another mesh near it.
            let most = BETWEEN * control.diagonal;
            let tolerance = goals.near.map_or(most, |near| most.min(near.tolerance));
            let options = ExactOptions::default()
                .tolerance(tolerance)
                .max_triangles(Some(MOST_EXACT));
            let between = exact_observed(task.mesh(), task.scheme()?, &options, observer)?;
            let apart = between.error.upper + found.error.upper;
            let own = on_whole(parts, &between);
            match InputDistance::new(input, &between, &own, residual)? {
                Some(moved) => moved.of_other(input, found, &origins, apart)?,
                None => return Ok(None),
            }
        }
    };
    let meshes = [input, found.mesh.as_triangles()];
    Ok(Some(match goals.near {
        Some(near) => moved.decided(meshes, near.within, observer)?,
        None => moved.narrowed(meshes, goals.expected(Some(found.error.upper)), observer)?,
    }))
}

/// Where vertices came from, on faces that were divided where they are whole.
fn on_whole<'a>(parts: &FaceParts, found: &'a Exact) -> Cow<'a, [Origin]> {
    if parts.is_empty() {
        return Cow::Borrowed(&found.origins);
    }
    let whole = |origin: &Origin| {
        let (face, barycentric) = parts.on_whole(origin.face, origin.barycentric);
        Origin { face, barycentric }
    };
    found.origins.iter().map(whole).collect()
}

/// How far the result is from the mesh that was read, if that is farther than it is from the limit surface, and what would
/// keep it nearer.
pub(super) fn in_words(
    moved: &IntervalReport,
    error: &ErrorReport,
    goals: &Goals,
    task: &Task<'_>,
) -> Vec<String> {
    if moved.upper <= goals.expected(error.upper) {
        return Vec::new();
    }
    let (arguments, control) = (task.arguments, task.mesh());
    let mut lines = vec![moved.in_words(&task.unit())];
    if lies_in_a_plane(control) {
        // All that can move is the outline.
        let is_open = control.topology().boundary_edge_count() > 0;
        if arguments.features.boundary.is_none() && is_open {
            lines.push("(--boundary fixed would keep the outline)".to_owned());
        }
        return lines;
    }
    let is_decided = arguments.features.angle().is_some() || !control.tags().creases.is_empty();
    if let Some(Look::Part(part)) = (!is_decided).then(|| Look::of(control, &[])) {
        let edges = counted(
            part.creases.edges.len(),
            "edge that looks",
            "edges that look",
        );
        let degrees = number(part.degrees);
        lines.push(format!(
            "(--crease-angle {degrees} would keep {edges} sharp)"
        ));
    }
    if !arguments.interpolation.is_led() {
        lines.push(INTERPOLATE.to_owned());
    }
    lines
}

/// How far the normals of faces in one plane may differ, as a sine: single precision leaves less.
const IN_PLANE: f64 = 1e-5;

/// Whether all faces are in one plane, or in parallel ones, whichever side of them is up.
fn lies_in_a_plane(mesh: &Mesh) -> bool {
    let normals = || (0..mesh.face_count() as u32).map(|face| mesh.face_normal(FaceId(face)));
    let largest = normals().max_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)));
    let Some(plane) = largest else { return false };
    normals()
        .all(|normal| length(cross(normal, plane)) <= IN_PLANE * length(normal) * length(plane))
}
