//! Fewer triangles within a distance, and mended meshes.

use limitmesh::mesh::Diagnosis;
use limitmesh::simplify::{Features, SimplifyOptions, simplify_observed};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::channels;
use crate::control::Recipe;
use crate::errors::OptionError;
use crate::options::{ControlOptions, Extent};
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// Collapses edges of a mesh whose own triangles are the surface.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what Python hands over")]
pub(crate) fn simplify<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    tolerance: Option<Extent>,
    triangles: Option<usize>,
    certify: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (mut soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    if !soup.channels.is_empty() {
        return Err(OptionError::new_err("channels are not carried by simplify"));
    }
    let (found, inputs, diagnosis) = run(py, threads, progress, move |observer| {
        soup.channels.clear();
        let control = recipe.control(soup, observer)?;
        let options = SimplifyOptions::default()
            .tolerance(tolerance.map(|tolerance| tolerance.of(control.diagonal)))
            .triangles(triangles)
            .certify(certify);
        let found = simplify_observed(&control.mesh, &Features::default(), &options, observer)?;
        let mut inputs = vec![u32::MAX; control.mesh.vertex_count()];
        for (input, own) in control.vertices.iter().enumerate().rev() {
            if let Some(own) = own {
                inputs[*own as usize] = input as u32;
            }
        }
        // Copies of cut vertices are found through their corners.
        for (own, &input) in control
            .mesh
            .triangles()
            .as_flattened()
            .iter()
            .zip(&control.tables.corners)
        {
            if inputs[*own as usize] == u32::MAX {
                inputs[*own as usize] = input;
            }
        }
        let inputs: Vec<u32> = found.vertices.iter().map(|&v| inputs[v as usize]).collect();
        Ok((found, inputs, control.tables.diagnosis))
    })?;
    let dict = PyDict::new(py);
    dict.set_item("diagnosis", tell::diagnosis(py, &diagnosis)?)?;
    dict.set_item("estimate", found.estimate)?;
    dict.set_item("bound", found.bound)?;
    let (positions, triangles) = found.mesh.into_positions_and_triangles();
    dict.set_item("vertices", tell::rows(py, positions)?)?;
    dict.set_item("faces", tell::rows(py, triangles)?)?;
    dict.set_item("parent_vertex", PyArray1::from_vec(py, inputs))?;
    Ok(dict)
}

/// What comes of a mended mesh.
struct Mended {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    faces: Vec<u32>,
    corners: Vec<u32>,
    channels: Vec<limitmesh::mesh::Channel>,
    creases: Vec<(u32, u32, f64)>,
    corner_tags: Vec<(u32, f64)>,
    diagnosis: Diagnosis,
}

/// The control mesh that a soup gives: triangles, oriented and manifold.
#[pyfunction]
pub(crate) fn repair<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    threads: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let mended = run(py, threads, None, move |observer| {
        let control = recipe.control(soup, observer)?;
        let tags = control.mesh.tags();
        let creases = tags
            .creases
            .iter()
            .map(|tag| (tag.vertices[0], tag.vertices[1], tag.sharpness))
            .collect();
        let corner_tags = tags
            .corners
            .iter()
            .map(|tag| (tag.vertex, tag.sharpness))
            .collect();
        let (positions, triangles) = control.mesh.into_positions_and_triangles();
        Ok(Mended {
            positions,
            triangles,
            faces: control.tables.faces,
            corners: control.tables.corners,
            channels: control.channels,
            creases,
            corner_tags,
            diagnosis: control.tables.diagnosis,
        })
    })?;
    let dict = PyDict::new(py);
    let corners: Bound<'py, PyArray2<u32>> =
        tell::rows(py, mended.corners.as_chunks::<3>().0.to_vec())?;
    dict.set_item("vertices", tell::rows(py, mended.positions)?)?;
    dict.set_item("faces", tell::rows(py, mended.triangles)?)?;
    dict.set_item("parent_face", PyArray1::from_vec(py, mended.faces))?;
    dict.set_item("parent_vertices", corners)?;
    let channels = mended
        .channels
        .into_iter()
        .map(|channel| channels::told(py, channel));
    dict.set_item(
        "channels",
        PyList::new(py, channels.collect::<PyResult<Vec<_>>>()?)?,
    )?;
    dict.set_item("creases", mended.creases)?;
    dict.set_item("corners", mended.corner_tags)?;
    dict.set_item("diagnosis", tell::diagnosis(py, &mended.diagnosis)?)?;
    Ok(dict)
}
