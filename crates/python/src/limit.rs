//! Limits of a mesh's own vertices.

use limitmesh::limit::LimitTable;
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::control::Recipe;
use crate::options::ControlOptions;
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// Rows of points and of normals.
type PointsAndNormals<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// Limit positions and normals of the input's vertices; NaN where a vertex is in no face.
#[pyfunction]
pub(crate) fn limit<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<PointsAndNormals<'py>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let (positions, normals) = run(py, threads, progress, move |observer| {
        let control = recipe.control(soup, observer)?;
        let table = LimitTable::new(recipe.scheme);
        let (positions, normals) = (
            table.positions(&control.mesh)?,
            table.normals(&control.mesh)?,
        );
        let of_input = |all: &[[f64; 3]]| -> Vec<[f64; 3]> {
            let own = |v: &Option<u32>| v.map_or([f64::NAN; 3], |v| all[v as usize]);
            control.vertices.iter().map(own).collect()
        };
        Ok((of_input(&positions), of_input(&normals)))
    })?;
    Ok((tell::rows(py, positions)?, tell::rows(py, normals)?))
}
