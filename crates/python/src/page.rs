//! The page that shows a mesh in a browser, for notebooks.

use limitmesh_view::{Page, Report, Stop};
use pyo3::prelude::*;

use crate::errors::Error;

/// A page with one mesh, given as the bytes of a GLB file; `report` is its triangles, vertices, bounds of its distance, whether they are
/// proven, and the seconds that it took.
#[pyfunction]
pub(crate) fn page(
    name: String,
    glb: Vec<u8>,
    picture: Vec<u8>,
    diagonal: f64,
    report: (usize, usize, Option<f64>, Option<f64>, bool, f64),
) -> PyResult<String> {
    let (triangles, vertices, lower, upper, certified, seconds) = report;
    let share = upper.map_or(1.0, |upper| upper / diagonal);
    let stop = Stop {
        tolerance: share,
        report: Report {
            triangles,
            vertices,
            upper,
            lower,
            certified,
            seconds,
            ..Report::default()
        },
        glb,
        ..Stop::default()
    };
    let page = Page {
        name,
        diagonal,
        start: share,
        picture: Some(picture),
        stops: vec![stop],
        ..Page::default()
    };
    let (html, _) = page
        .html()
        .map_err(|error| Error::new_err(error.to_string()))?;
    Ok(html)
}
