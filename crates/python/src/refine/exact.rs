//! Exact refinement: within a proven distance, an angle, pixels, or with a number of triangles.

use limitmesh::carry::carried;
use limitmesh::progress::Observer;
use limitmesh::refine::{Exact, exact_observed, quads_observed};

use super::within::Near;
use super::{Indices, Refined};
use crate::control::{Control, Recipe, Tables};
use crate::errors::Failure;
use crate::options::Goals;
use crate::origins::Trail;

/// Refines a control mesh to goals.
pub(super) fn refined(
    mut control: Control,
    recipe: &Recipe,
    goals: &Goals,
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let near = goals
        .within
        .map(|within| Near::of(&mut control, within, (recipe, goals), observer))
        .transpose()?;
    let mut options = control.options(goals, recipe);
    if let Some(near) = &near {
        options = near.asked_of(options);
    }
    let found = exact_observed(&control.mesh, recipe.scheme, &options, observer)?;
    let distance = near
        .as_ref()
        .map(|near| near.distance(&found, &control.tables.parts, observer))
        .transpose()?;
    let inverted = near
        .as_ref()
        .map(|near| near.inverted(&found, &control.tables.parts));
    let channels = match control.channels.is_empty() {
        true => Vec::new(),
        false => carried(&control.channels, &control.mesh, recipe.scheme, &found)?,
    };
    let quads = match goals.quads {
        true => quads_observed(&found, &control.mesh, recipe.scheme, observer)?,
        false => Vec::new(),
    };
    let mut refined = Refined::of_exact(found, control.tables).with_channels(channels);
    refined.quads = quads.into_iter().map(|pair| pair.map(|h| h.0)).collect();
    if let (Some(near), Some(distance)) = (near, distance) {
        near.tell(distance, &mut refined);
        refined.inverted = inverted;
    }
    Ok(refined)
}

impl Refined {
    /// What is told of an exact refinement, but for channels.
    pub(crate) fn of_exact(found: Exact, tables: Tables) -> Self {
        let (error, stop, inverted) = (found.error, found.stop.name(), found.inverted_triangles());
        let (side_corners, side_normals) = found.sides.into_iter().unzip();
        let (positions, triangles) = found.mesh.into_positions_and_triangles();
        Self {
            parents: tables.input_faces(found.parents),
            tables,
            positions,
            triangles: Indices::Narrow(triangles),
            quads: Vec::new(),
            normals: found.normals,
            side_corners,
            side_normals,
            origins: Trail::Known(found.origins),
            channels: Vec::new(),
            input_distance: None,
            error: Some((error.lower, error.upper, error.certified, error.at.into())),
            stop,
            levels: found.statistics.levels,
            pixels: found.pixels,
            open_cones: found.statistics.open_cones,
            unfolded: found.statistics.unfolded,
            inverted: Some(inverted),
            seconds: 0.0,
        }
    }
}
