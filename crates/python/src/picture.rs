//! Small pictures for notebooks.

use limitmesh::Triangles;
use limitmesh_render::{Camera, Style, ViewDirection, render};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{Failure, MeshError};
use crate::run::run;
use crate::soup;

/// A picture of triangles as the bytes of a PNG file.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what Python hands over")]
pub(crate) fn picture<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    normals: Option<PyReadonlyArray2<'py, f64>>,
    width: u32,
    height: u32,
    wireframe: bool,
    threads: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    let (positions, triangles) = (soup::positions(&vertices)?, soup::triangles(&faces)?);
    let normals = normals.as_ref().map(soup::positions).transpose()?;
    if triangles
        .as_flattened()
        .iter()
        .any(|&v| v as usize >= positions.len())
    {
        return Err(MeshError::new_err(
            "a face names a vertex that there is not",
        ));
    }
    let png = run(py, threads, None, move |_| {
        let failed = |why: limitmesh_render::RenderError| Failure::Mesh(why.to_string());
        let surface = Triangles {
            positions: &positions,
            triangles: &triangles,
        };
        let camera = Camera::fit_tightly(surface, ViewDirection::default(), width, height)
            .map_err(failed)?;
        let style = Style::default().wireframe(wireframe);
        let image = render(
            surface,
            normals.as_deref(),
            None,
            &camera,
            &style,
            width,
            height,
        );
        image.and_then(|image| image.encode_png()).map_err(failed)
    })?;
    Ok(PyBytes::new(py, &png))
}
