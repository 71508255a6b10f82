//! How far a refined mesh is from the mesh that was read: what the library proves of it, with faces that were divided and triangles that reach
//! over several, and what is said of that.

use std::borrow::Cow;

use limitmesh::mesh::FaceParts;
use limitmesh::part::Look;
use limitmesh::refine::{Exact, ExactOptions, InputDistance, Origin, exact_observed};
use limitmesh::{FaceId, Mesh, Triangles};

use super::INTERPOLATE;
use super::control::{Before, BeforeSurface};
use super::goals::{Goals, unit_in_words};
use crate::arguments::{MOST_EXACT, RefineArguments};
use crate::format::{counted, number};
use crate::progress::Progress;
use crate::report::{ErrorReport, InputDistanceReport};
use crate::vector::{cross, dot, length};

/// Share of the diagonal that a mesh may be off by that stands for the limit surface, where triangles reach over several control
/// faces.
const STAND_IN: f64 = 5e-4;

/// How far the result is from the mesh that was read; `None` where nobody asks, or nothing is proven.
///
/// # Errors
/// Coordinates too large to be measured, or somebody asked to stop.
pub(super) fn measured(
    (control, before, parts): (&Mesh, &Before, &FaceParts),
    found: &Exact,
    goals: &Goals,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Option<InputDistance>> {
    let Some(BeforeSurface {
        positions,
        triangles,
    }) = &before.surface
    else {
        return Ok(None);
    };
    let input = Triangles {
        positions,
        triangles,
    };
    let residual = before.residual.unwrap_or(0.0);
    let origins = on_whole(parts, found);
    let narrowed = |moved: InputDistance| {
        let meshes = [input, found.mesh.as_triangles()];
        let observer = &mut progress.observer();
        match goals.near {
            Some(near) => moved.decided(meshes, near.within, observer),
            None => moved.narrowed(meshes, goals.expected(Some(found.error.upper)), observer),
        }
    };
    if let Some(moved) = InputDistance::new(input, found, &origins, residual)? {
        return Ok(Some(narrowed(moved)?));
    }
    if !found.error.certified {
        return Ok(None);
    }
    // Triangles that reach over several control faces: the limit surface lies between, with another mesh near it.
    let most = STAND_IN * goals.diagonal;
    let tolerance = goals.near.map_or(most, |near| most.min(near.tolerance));
    let options = ExactOptions::default()
        .tolerance(tolerance)
        .max_triangles(Some(MOST_EXACT));
    let between = exact_observed(
        control,
        arguments.scheme()?,
        &options,
        &mut progress.observer(),
    )?;
    let apart = between.error.upper + found.error.upper;
    let moved = InputDistance::new(input, &between, &on_whole(parts, &between), residual)?;
    Ok(moved
        .map(|moved| narrowed(moved.of_other(input, found, &origins, apart)?))
        .transpose()?)
}

/// Where vertices came from, on faces that were divided where they are whole.
fn on_whole<'a>(parts: &FaceParts, found: &'a Exact) -> Cow<'a, [Origin]> {
    if parts.is_empty() {
        return Cow::Borrowed(&found.origins);
    }
    let origins = found
        .origins
        .iter()
        .map(|origin| parts.on_whole(origin.face, origin.barycentric));
    origins
        .map(|(face, barycentric)| Origin { face, barycentric })
        .collect()
}

/// How far the result is from the mesh that was read, if that is farther than it is from the limit surface, and what would
/// keep it nearer.
pub(super) fn in_words(
    moved: &InputDistanceReport,
    error: &ErrorReport,
    control: &Mesh,
    goals: &Goals,
    arguments: &RefineArguments,
) -> Vec<String> {
    if moved.upper <= goals.expected(error.upper) {
        return Vec::new();
    }
    let mut lines = vec![moved.in_words(&unit_in_words(arguments.build.unit))];
    if lies_in_a_plane(control) {
        // All that can move is the outline.
        let is_open =
            arguments.features.boundary.is_none() && control.topology().boundary_edge_count() > 0;
        lines.extend(is_open.then(|| "(--boundary fixed would keep the outline)".to_owned()));
        return lines;
    }
    let is_decided = arguments.features.angle().is_some() || !control.tags().creases.is_empty();
    if let Some(Look::Part(part)) = (!is_decided).then(|| Look::of(control, &[])) {
        let edges = counted(
            part.creases.edges.len(),
            "edge that looks",
            "edges that look",
        );
        lines.push(format!(
            "(--crease-angle {} would keep {edges} sharp)",
            number(part.degrees)
        ));
    }
    if arguments
        .interpolation
        .within(goals.diagonal, arguments.build.unit)
        .is_ok_and(|within| within.is_none())
    {
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
