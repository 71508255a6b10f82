//! Files and built-in models.

use std::path::PathBuf;

use limitmesh::{HalfEdgeId, PolygonSoup, Triangles};
use limitmesh_io::{Format, Output, WriteOptions};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::channels::{self, ChannelIn};
use crate::errors::{Failure, OptionError};
use crate::run::run;
use crate::soup;
use crate::tell;

/// What marks the name of a built-in model.
const BUILTIN: &str = "builtin:";

/// Name and description of each built-in model.
#[pyfunction]
pub(crate) fn models() -> Vec<(&'static str, &'static str)> {
    limitmesh_models::all()
        .iter()
        .map(|model| (model.name, model.about))
        .collect()
}

/// What a file or a built-in model holds.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let soup = run(py, 1, None, move |_| {
        match path.to_str().and_then(|name| name.strip_prefix(BUILTIN)) {
            Some(name) => builtin(name),
            None => Ok(limitmesh_io::read(&path)?),
        }
    })?;
    let dict = PyDict::new(py);
    let mut starts = vec![0i64];
    let mut corners: Vec<i64> = Vec::with_capacity(soup.faces.corner_count());
    for face in soup.faces.iter() {
        corners.extend(face.iter().map(|&v| i64::from(v)));
        starts.push(corners.len() as i64);
    }
    dict.set_item("vertices", tell::rows(py, soup.positions)?)?;
    dict.set_item("corners", PyArray1::from_vec(py, corners))?;
    dict.set_item("starts", PyArray1::from_vec(py, starts))?;
    let creases = soup
        .creases
        .iter()
        .map(|tag| (tag.vertices[0], tag.vertices[1], tag.sharpness));
    dict.set_item("creases", PyList::new(py, creases.collect::<Vec<_>>())?)?;
    let tags = soup.corners.iter().map(|tag| (tag.vertex, tag.sharpness));
    dict.set_item("corner_tags", PyList::new(py, tags.collect::<Vec<_>>())?)?;
    let channels = soup
        .channels
        .into_iter()
        .map(|channel| channels::told(py, channel));
    dict.set_item(
        "channels",
        PyList::new(py, channels.collect::<PyResult<Vec<_>>>()?)?,
    )?;
    dict.set_item("material_libraries", soup.material_libraries)?;
    dict.set_item("texture_files", soup.texture_files)?;
    dict.set_item("left_out", soup.left_out)?;
    Ok(dict)
}

fn builtin(name: &str) -> Result<PolygonSoup, Failure> {
    let model = limitmesh_models::find(name).ok_or_else(|| {
        let names: Vec<&str> = limitmesh_models::all()
            .iter()
            .map(|model| model.name)
            .collect();
        Failure::File(format!(
            "there is no built-in model '{name}'; there are: {}",
            names.join(", ")
        ))
    })?;
    Ok(model.soup())
}

/// Writes triangles and what they carry, whole or not at all; the names of channels that the format has no place for.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what Python hands over")]
pub(crate) fn save(
    py: Python<'_>,
    path: PathBuf,
    vertices: PyReadonlyArray2<'_, f64>,
    faces: PyReadonlyArray2<'_, u32>,
    quads: Vec<[u32; 2]>,
    normals: Option<PyReadonlyArray2<'_, f64>>,
    normals_of_corners: Option<PyReadonlyArray2<'_, u32>>,
    channels: Vec<ChannelIn<'_>>,
    linked: [Vec<String>; 2],
    ascii: bool,
) -> PyResult<Vec<String>> {
    let [material_libraries, texture_files] = linked;
    let (positions, triangles) = (soup::positions(&vertices)?, soup::triangles(&faces)?);
    let quads: Vec<_> = quads.into_iter().map(|pair| pair.map(HalfEdgeId)).collect();
    let normals = normals.as_ref().map(soup::positions).transpose()?;
    let normals_of_corners = normals_of_corners
        .as_ref()
        .map(soup::triangles)
        .transpose()?;
    let channels = channels
        .iter()
        .map(ChannelIn::channel)
        .collect::<PyResult<Vec<_>>>()?;
    let format = Format::from_path(&path).map_err(|why| OptionError::new_err(why.to_string()))?;
    run(py, 1, None, move |_| {
        let surface = Triangles {
            positions: &positions,
            triangles: &triangles,
        };
        let (held, lost): (Vec<_>, Vec<_>) = channels.into_iter().partition(|channel| {
            limitmesh_io::holds(format, &WriteOptions::default().ascii(ascii), channel)
        });
        let output = Output::new(surface)
            .quads(&quads)
            .channels(&held)
            .material_libraries(&material_libraries);
        let mut output = output.texture_files(&texture_files);
        output = match (&normals, &normals_of_corners) {
            (Some(normals), Some(corners)) => output.normals_of_corners(normals, corners),
            (Some(normals), None) => output.normals(normals),
            (None, _) => output,
        };
        limitmesh_io::write_as(
            &path,
            format,
            &output,
            &WriteOptions::default().ascii(ascii),
        )?;
        Ok(lost.into_iter().map(|channel| channel.name).collect())
    })
}
