//! Points against the limit surface: closest points, signed distances.

use limitmesh::{LimitSurface, Membership, Proximity, ProximityError};
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::control::Recipe;
use crate::options::{ControlOptions, Extent};
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// Rows for points: closest points, normals there, weights of their faces' corners; those faces; distances, their bounds from below, and the
/// distances with their signs.
type Told<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// Projects points onto the limit surface of a mesh.
#[pyfunction]
pub(crate) fn project<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    tolerance: Extent,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Told<'py>> {
    let points = points.as_slice()?.as_chunks::<3>().0.to_vec();
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let (closest, normals, signed) = run(py, threads, progress, move |observer| {
        let control = recipe.control(soup, observer)?;
        let surface = LimitSurface::new(&control.mesh, recipe.scheme)?;
        let proximity = Proximity::new_observed(&surface, observer)?;
        let closest =
            proximity.closest_observed(&points, tolerance.of(control.diagonal), observer)?;
        let places: Vec<_> = closest.iter().map(|at| (at.face, at.barycentric)).collect();
        let normals: Vec<[f64; 3]> = surface.at_all(&places).iter().map(|at| at.normal).collect();
        let behind = |row: usize| {
            let (point, at) = (points[row], closest[row].point);
            (0..3)
                .map(|axis| (point[axis] - at[axis]) * normals[row][axis])
                .sum::<f64>()
                < 0.0
        };
        let is_negative: Vec<bool> = match proximity.memberships_observed(&points, observer) {
            Ok(found) => found.iter().map(|&at| at == Membership::Inside).collect(),
            Err(ProximityError::Open { .. }) => (0..points.len()).map(behind).collect(),
            Err(error) => return Err(error.into()),
        };
        let sign = |(at, negative): (&limitmesh::Closest, bool)| match negative {
            true => -at.distance,
            false => at.distance,
        };
        let signed: Vec<f64> = closest.iter().zip(is_negative).map(sign).collect();
        Ok((closest, normals, signed))
    })?;
    Ok((
        tell::rows(py, closest.iter().map(|at| at.point).collect())?,
        tell::rows(py, normals)?,
        tell::rows(py, closest.iter().map(|at| at.barycentric).collect())?,
        PyArray1::from_vec(py, closest.iter().map(|at| i64::from(at.face.0)).collect()),
        PyArray1::from_vec(py, closest.iter().map(|at| at.distance).collect()),
        PyArray1::from_vec(py, closest.iter().map(|at| at.lower).collect()),
        PyArray1::from_vec(py, signed),
    ))
}
