//! Refinement over a restricted quadtree by criteria of the literature, to be compared with: planarity (Zorin, Schröder and Sweldens)
//! and vertex errors (Müller and Jaeschke).

use limitmesh::carry::carried;
use limitmesh::front::{Demand, Front, Measure, Snapshot};
use limitmesh::progress::Observer;
use limitmesh::refine::{Origin, Traced};
use limitmesh::{FaceId, HalfEdgeId, LimitSurface};

use super::{Method, Normals, Refined};
use crate::control::{Control, Recipe};
use crate::errors::Failure;
use crate::options::{Goals, front_levels};
use crate::origins::Trail;

/// A triangle with the pieces of the surface that its front keeps, in bytes: measured, rounded up.
const BYTES_PER_TRIANGLE: usize = 1500;

/// Divides nodes until all meet the criterion.
pub(super) fn refined(
    control: Control,
    recipe: &Recipe,
    (method, goals): (Method, &Goals),
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let (measure, limit) = limit(method, goals, control.diagonal);
    let demand = Demand::tolerance(limit).max_levels(front_levels(goals.max_levels)?);
    let mut front = Front::measured_by_observed(&control.mesh, recipe.scheme, measure, observer)?;
    let cap = goals.cap(BYTES_PER_TRIANGLE);
    let most = goals.triangles.into_iter().chain(cap).min();
    front.update_observed(
        &most.map_or(demand.clone(), |most| demand.triangles(most)),
        observer,
    )?;
    let stop = match goals.triangles {
        _ if front.worst() <= limit => "met",
        _ if front.limit() <= limit => "level-cap",
        Some(asked) if cap.is_none_or(|cap| asked <= cap) => "triangles",
        _ => goals.cap_name(BYTES_PER_TRIANGLE),
    };
    let levels = front.depth() as usize;
    let found = front.snapshot()?;
    drop(front);
    let channels = match control.channels.is_empty() {
        true => Vec::new(),
        false => carried(&control.channels, &control.mesh, recipe.scheme, &found)?,
    };
    let normals = normals(&found, &control, recipe)?;
    Ok(Refined {
        parents: control.tables.input_faces(found.parents),
        origins: Trail::Known(if goals.origins {
            found.origins
        } else {
            Vec::new()
        }),
        channels,
        stop,
        levels,
        ..Refined::of_mesh(found.mesh, normals, control.tables)
    })
}

/// What is measured, and what it may be; without a limit as little as so many triangles allow.
fn limit(method: Method, goals: &Goals, diagonal: f64) -> (Measure, f64) {
    let tolerance = goals.tolerance.map(|tolerance| tolerance.of(diagonal));
    match (method, tolerance) {
        (Method::VertexError, tolerance) => (Measure::VertexError, tolerance.unwrap_or(0.0)),
        (_, Some(tolerance)) => (Measure::PlanarityDistance, tolerance),
        (_, None) => (
            Measure::PlanarityAngle,
            goals.angle.unwrap_or(0.0).to_radians(),
        ),
    }
}

/// The limit normals of the control mesh's surface at the vertices, by side where edges are sharp.
fn normals(found: &Snapshot, control: &Control, recipe: &Recipe) -> Result<Normals, Failure> {
    let surface = LimitSurface::new(&control.mesh, recipe.scheme)?;
    let place = |origin: &Origin| (FaceId(origin.face), origin.barycentric);
    let at = |places: &[_]| {
        surface
            .at_all(places)
            .into_iter()
            .map(|point| point.normal)
            .collect()
    };
    let mut by_vertex: Vec<[f64; 3]> = at(&found.origins.iter().map(place).collect::<Vec<_>>());
    let mut is_sided = vec![false; by_vertex.len()];
    found
        .mesh
        .tags()
        .creases
        .iter()
        .flat_map(|tag| tag.vertices)
        .for_each(|v| is_sided[v as usize] = true);
    let flat = found.mesh.triangles().as_flattened();
    let corners: Vec<u32> = (0..)
        .zip(flat)
        .filter(|&(_, &v)| is_sided[v as usize])
        .map(|(h, _)| h)
        .collect();
    let of_corner = |&h: &u32| {
        let own = found.corner_origin(control.mesh.triangles(), HalfEdgeId(h));
        place(&own.unwrap_or(found.origins[flat[h as usize] as usize]))
    };
    let of_corners: Vec<[f64; 3]> = at(&corners.iter().map(of_corner).collect::<Vec<_>>());
    for &h in &corners {
        by_vertex[flat[h as usize] as usize] = [0.0; 3];
    }
    for (&h, normal) in corners.iter().zip(&of_corners) {
        let sum = &mut by_vertex[flat[h as usize] as usize];
        *sum = [0, 1, 2].map(|axis| sum[axis] + normal[axis]);
    }
    for (normal, _) in by_vertex
        .iter_mut()
        .zip(is_sided)
        .filter(|(_, is_sided)| *is_sided)
    {
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        *normal = normal.map(|x| if length > 0.0 { x / length } else { 0.0 });
    }
    Ok(Normals {
        corners,
        of_corners,
        by_vertex,
    })
}
