//! Rays against the limit surface.

use limitmesh::{Crossing, Hit, LimitSurface, Ray, RayCaster, RayOptions};
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::control::Recipe;
use crate::errors::Failure;
use crate::options::{ControlOptions, Extent};
use crate::run::run;
use crate::soup::{MeshIn, positions};
use crate::tell;

/// What of rays counts, and how exactly.
#[derive(FromPyObject, Clone, Copy)]
#[pyo3(from_item_all)]
pub(crate) struct Casting {
    /// Whether the first hit of a ray is all that is asked for.
    first: bool,
    /// The least and the greatest multiple of the direction.
    between: (f64, f64),
    tolerance: Option<Extent>,
}

/// Rows for hits: numbers of rays, multiples of their directions, control faces, weights of their corners, points, normals; and 1 where
/// a ray comes through the front, −1 through the back, 0 where it grazes.
type Told<'py> = (
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i8>>,
);

/// Where rays meet the limit surface of a mesh, ray by ray, in their order along each.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what Python hands over")]
pub(crate) fn intersect<'py>(
    py: Python<'py>,
    origins: PyReadonlyArray2<'py, f64>,
    directions: PyReadonlyArray2<'py, f64>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    casting: Casting,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Told<'py>> {
    let (origins, directions) = (positions(&origins)?, positions(&directions)?);
    let of_rows = |(origin, direction)| Ray { origin, direction };
    let rays: Vec<Ray> = origins.into_iter().zip(directions).map(of_rows).collect();
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let hits = run(py, threads, progress, move |observer| {
        let control = recipe.control(soup, observer)?;
        let surface = LimitSurface::new(&control.mesh, recipe.scheme)?;
        let caster = RayCaster::new_observed(&surface, observer)?;
        let mut options = RayOptions::default().between(casting.between.0, casting.between.1);
        if let Some(tolerance) = casting.tolerance {
            options = options.tolerance(tolerance.of(control.diagonal));
        }
        let hits: Vec<(i64, Hit)> = match casting.first {
            true => {
                let found = caster.first_of_all_observed(&rays, &options, observer)?;
                (0..)
                    .zip(found)
                    .filter_map(|(ray, hit)| Some((ray, hit?)))
                    .collect()
            }
            false => {
                let found = caster.intersections_of_all_observed(&rays, &options, observer)?;
                (0..)
                    .zip(found)
                    .flat_map(|(ray, hits)| hits.into_iter().map(move |hit| (ray, hit)))
                    .collect()
            }
        };
        match surface.failure() {
            Some(error) => Err(Failure::Mesh(error.to_string())),
            None => Ok(hits),
        }
    })?;
    let crossing = |(_, hit): &(i64, Hit)| match hit.crossing {
        Crossing::Entering => 1,
        Crossing::Leaving => -1,
        Crossing::Grazing => 0,
    };
    Ok((
        PyArray1::from_vec(py, hits.iter().map(|&(ray, _)| ray).collect()),
        PyArray1::from_vec(py, hits.iter().map(|(_, hit)| hit.t).collect()),
        PyArray1::from_vec(
            py,
            hits.iter().map(|(_, hit)| i64::from(hit.face.0)).collect(),
        ),
        tell::rows(py, hits.iter().map(|(_, hit)| hit.barycentric).collect())?,
        tell::rows(py, hits.iter().map(|(_, hit)| hit.position).collect())?,
        tell::rows(py, hits.iter().map(|(_, hit)| hit.normal).collect())?,
        PyArray1::from_vec(py, hits.iter().map(crossing).collect()),
    ))
}
