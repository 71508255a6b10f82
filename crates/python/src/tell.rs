//! Arrays and dictionaries of results: vectors are handed over without a copy.

use limitmesh::mesh::Diagnosis;
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Rows as an array.
pub(crate) fn rows<T: Element, const N: usize>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.into_flattened()).reshape([count, N])
}

/// What was found in the input, for the Python half; none where nothing was, as in most meshes.
pub(crate) fn diagnosis<'py>(
    py: Python<'py>,
    found: &Diagnosis,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    if found.findings().all(|(_, finding)| finding.is_empty()) {
        return Ok(None);
    }
    let dict = PyDict::new(py);
    dict.set_item("clean", found.is_clean())?;
    dict.set_item("repairs", PyTuple::new(py, found.repairs())?)?;
    dict.set_item("preparations", PyTuple::new(py, found.preparations())?)?;
    let findings = PyDict::new(py);
    for (name, finding) in found.findings().filter(|(_, finding)| !finding.is_empty()) {
        findings.set_item(name, (finding.count, PyTuple::new(py, &finding.first)?))?;
    }
    dict.set_item("findings", findings)?;
    Ok(Some(dict))
}
