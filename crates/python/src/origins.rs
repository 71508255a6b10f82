//! Where vertices came from, as arrays once somebody asks for them: few do, and to make them takes as long as all else that is handed over.

use std::borrow::Cow;
use std::sync::Arc;

use limitmesh::Mesh;
use limitmesh::mesh::FaceParts;
use limitmesh::progress::Observer;
use limitmesh::refine::{Origin, UniformOptions, uniform_observed};
use limitmesh::scheme::{CatmullClark, Loop, Scheme};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::control::Tables;
use crate::run::run;
use crate::tell;

/// Where vertices came from.
pub(crate) enum Trail {
    /// By vertex; nothing is known where there are none.
    Known(Vec<Origin>),
    /// As uniform refinement numbers them, which the control mesh's connections alone decide.
    Uniform { control: Arc<Mesh>, levels: usize },
}

impl Default for Trail {
    fn default() -> Self {
        Self::Known(Vec::new())
    }
}

impl Trail {
    /// That of the vertices of uniform refinement.
    pub(crate) fn uniform(control: Mesh, levels: usize) -> Self {
        Self::Uniform {
            control: Arc::new(control),
            levels,
        }
    }

    fn is_unknown(&self) -> bool {
        matches!(self, Self::Known(origins) if origins.is_empty())
    }

    fn origins(&self, py: Python<'_>) -> PyResult<Cow<'_, [Origin]>> {
        match self {
            Self::Known(origins) => Ok(Cow::Borrowed(origins)),
            Self::Uniform { control, levels } => {
                let (control, levels) = (Arc::clone(control), *levels);
                let options = UniformOptions::default().levels(levels).origins(true);
                let job = move |observer: &mut Observer<'_>| {
                    // Any scheme for such faces.
                    let scheme: &dyn Scheme = match control.topology().has_quads() {
                        true => &CatmullClark,
                        false => &Loop,
                    };
                    Ok(uniform_observed(&control, scheme, &options, observer)?.origins)
                };
                run(py, 1, None, job).map(Cow::Owned)
            }
        }
    }
}

/// Where vertices are on the control mesh, and what that was made of.
#[pyclass(frozen)]
pub(crate) struct Origins {
    trail: Trail,
    parts: FaceParts,
    faces: Vec<u32>,
    corners: Vec<u32>,
    is_stepped: bool,
}

/// By vertex the input's face, the input's vertices at a triangle of it, and the weights of these; and whether the place is theirs exactly:
/// where a step divided polygons, it is that of vertices near them.
type Rows<'py> = (
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray2<f64>>,
    bool,
);

impl Origins {
    /// None where the library tells of none.
    pub(crate) fn new(tables: Tables, trail: Trail) -> Option<Self> {
        let Tables {
            parts,
            faces,
            corners,
            is_stepped,
            ..
        } = tables;
        (!trail.is_unknown()).then_some(Self {
            trail,
            parts,
            faces,
            corners,
            is_stepped,
        })
    }
}

#[pymethods]
impl Origins {
    /// As arrays.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let origins = self.trail.origins(py)?;
        let (faces, vertices, barycentric) = py.detach(|| {
            let count = origins.len();
            let (mut faces, mut vertices) = (Vec::with_capacity(count), Vec::with_capacity(count));
            let mut barycentric = Vec::with_capacity(count);
            for origin in origins.iter() {
                let (face, weights) = self.parts.on_whole(origin.face, origin.barycentric);
                let face = face as usize;
                faces.push(i64::from(self.faces[face]));
                vertices.push([0, 1, 2].map(|corner| i64::from(self.corners[3 * face + corner])));
                barycentric.push(weights);
            }
            (faces, vertices, barycentric)
        });
        Ok((
            PyArray1::from_vec(py, faces),
            tell::rows(py, vertices)?,
            tell::rows(py, barycentric)?,
            !self.is_stepped,
        ))
    }
}
