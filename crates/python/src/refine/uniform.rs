//! Uniform refinement onto the limit surface, of triangles alone: connections and where vertices came from are made for those who ask.

use limitmesh::carry::carried;
use limitmesh::progress::Observer;
use limitmesh::refine::{
    UniformOptions, UniformTriangles, uniform_observed, uniform_triangles_observed,
};

use super::stepwise::{BYTES_PER_TRIANGLE, stop_name};
use super::{Normals, Refined};
use crate::control::{Control, Recipe};
use crate::errors::Failure;
use crate::options::Goals;
use crate::origins::Trail;

/// Divides every triangle in four at each level.
pub(super) fn refined(
    control: Control,
    recipe: &Recipe,
    goals: &Goals,
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let options = UniformOptions::default()
        .levels(goals.levels)
        .max_triangles(goals.cap(BYTES_PER_TRIANGLE));
    let at_limit = options.limit(true).normals(true);
    let found = uniform_triangles_observed(&control.mesh, recipe.scheme, &at_limit, observer)?;
    let channels = match control.channels.is_empty() {
        true => Vec::new(),
        false => {
            // The same triangles, which know where they came from.
            let traced = uniform_observed(
                &control.mesh,
                recipe.scheme,
                &options.origins(true),
                observer,
            )?;
            carried(&control.channels, &control.mesh, recipe.scheme, &traced)?
        }
    };
    let UniformTriangles {
        positions,
        triangles,
        normals,
        sides,
        levels,
        stop,
        ..
    } = found;
    let (corners, of_corners) = sides.into_iter().unzip();
    let normals = Normals {
        corners,
        of_corners,
        by_vertex: normals,
    };
    let quads = if goals.quads {
        0..triangles.len() as u32 / 2
    } else {
        0..0
    };
    // As the control mesh has them: the diagonal is the second edge of both halves.
    let quads = quads.map(|quad| [6 * quad + 1, 6 * quad + 4]).collect();
    let faces = 0..control.mesh.face_count() as u32;
    Ok(Refined {
        // The triangles of a face stand together: Python repeats its number for each.
        parents: if goals.origins {
            control.tables.input_faces(faces.collect())
        } else {
            None
        },
        origins: if goals.origins {
            Trail::uniform(control.mesh, levels)
        } else {
            Trail::default()
        },
        quads,
        channels,
        stop: stop_name(&stop, goals),
        levels,
        ..Refined::of_triangles((positions, triangles), normals, control.tables)
    })
}
