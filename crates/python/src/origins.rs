//! Where vertices came from, as arrays once somebody asks for them: few do, and to make them takes as long as all else that is handed over.

use limitmesh::mesh::FaceParts;
use limitmesh::refine::Origin;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::control::Tables;
use crate::tell;

/// Where vertices are on the control mesh, and what that was made of.
#[pyclass(frozen)]
pub(crate) struct Origins {
    origins: Vec<Origin>,
    parts: FaceParts,
    faces: Vec<u32>,
    corners: Vec<u32>,
}

/// By vertex the input's face, the input's vertices at a triangle of it, and the weights of these.
type Rows<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray2<i64>>, Bound<'py, PyArray2<f64>>);

impl Origins {
    /// None where the library tells of none.
    pub(crate) fn new(tables: Tables, origins: Vec<Origin>) -> Option<Self> {
        let Tables { parts, faces, corners, .. } = tables;
        (!origins.is_empty()).then_some(Self { origins, parts, faces, corners })
    }
}

#[pymethods]
impl Origins {
    /// As arrays.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let (faces, vertices, barycentric) = py.detach(|| {
            let count = self.origins.len();
            let (mut faces, mut vertices) = (Vec::with_capacity(count), Vec::with_capacity(count));
            let mut barycentric = Vec::with_capacity(count);
            for origin in &self.origins {
                let (face, weights) = self.parts.on_whole(origin.face, origin.barycentric);
                let face = face as usize;
                faces.push(i64::from(self.faces[face]));
                vertices.push([0, 1, 2].map(|corner| i64::from(self.corners[3 * face + corner])));
                barycentric.push(weights);
            }
            (faces, vertices, barycentric)
        });
        Ok((PyArray1::from_vec(py, faces), tell::rows(py, vertices)?, tell::rows(py, barycentric)?))
    }
}
