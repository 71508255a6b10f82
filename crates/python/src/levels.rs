//! Levels of detail: meshes of one limit surface, each nested in the next, and what one is on the coarser one.

use std::time::Instant;

use limitmesh::carry::carried;
use limitmesh::refine::{Caps, Geomorph, LodOptions, levels_of_detail_observed};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::control::Recipe;
use crate::errors::Failure;
use crate::options::{ControlOptions, Extent};
use crate::refine::Refined;
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// What levels are to be.
#[derive(FromPyObject, Clone)]
#[pyo3(from_item_all)]
pub(crate) struct Detail {
    /// From the coarsest to the finest.
    tolerances: Vec<Extent>,
    morph: bool,
    max_triangles: Option<usize>,
    max_memory: Option<usize>,
}

impl Detail {
    /// For a mesh with this diagonal.
    ///
    /// # Errors
    /// Tolerances that do not fall.
    fn options(&self, diagonal: f64) -> Result<LodOptions, Failure> {
        let lengths: Vec<f64> = self
            .tolerances
            .iter()
            .map(|extent| extent.of(diagonal))
            .collect();
        if let Some(row) = (1..lengths.len()).find(|&row| lengths[row] >= lengths[row - 1]) {
            let (own, before) = (lengths[row], lengths[row - 1]);
            return Err(Failure::Option(format!(
                "tolerances[{row}] is {own}, expected less than the coarser one before it, which is {before}"
            )));
        }
        let usual = Caps::default();
        Ok(LodOptions::new(lengths).geomorphs(self.morph).caps(Caps {
            triangles: self.max_triangles.or(usual.triangles),
            memory: self.max_memory,
            ..usual
        }))
    }
}

/// A level of detail.
struct Told {
    refined: Refined,
    tolerance: f64,
    deviation: f64,
    geomorph: Option<Geomorph>,
}

/// Levels of detail of a mesh from the coarsest to the finest: a dictionary each, with that of a refinement in it.
#[pyfunction]
pub(crate) fn levels_of_detail<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    detail: Detail,
    has_wide_indices: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let levels = run(py, threads, progress, move |observer| {
        let start = Instant::now();
        let control = recipe.control(soup, observer)?;
        let options = detail.options(control.diagonal)?;
        let levels = levels_of_detail_observed(&control.mesh, recipe.scheme, &options, observer)?;
        let mut told = Vec::with_capacity(levels.len());
        for level in levels {
            let channels = match control.channels.is_empty() {
                true => Vec::new(),
                false => carried(
                    &control.channels,
                    &control.mesh,
                    recipe.scheme,
                    &level.exact,
                )?,
            };
            let refined =
                Refined::of_exact(level.exact, control.tables.clone()).with_channels(channels);
            told.push(Told {
                refined: if has_wide_indices {
                    refined.widened()
                } else {
                    refined
                },
                tolerance: level.tolerance,
                deviation: level.parametric,
                geomorph: level.geomorph,
            });
        }
        let seconds = start.elapsed().as_secs_f64();
        told.iter_mut()
            .for_each(|level| level.refined.took(seconds));
        Ok(told)
    })?;
    PyList::new(
        py,
        levels
            .into_iter()
            .map(|level| level.told(py))
            .collect::<PyResult<Vec<_>>>()?,
    )
}

impl Told {
    fn told(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("refined", self.refined.told(py)?)?;
        dict.set_item("tolerance", self.tolerance)?;
        dict.set_item("deviation", self.deviation)?;
        let (mut positions, mut normals, mut sides, mut start) = (None, None, None, None);
        if let Some(morph) = self.geomorph {
            let (corners, of_corners): (Vec<u32>, Vec<[f64; 3]>) = morph.sides.into_iter().unzip();
            positions = Some(tell::rows(py, morph.positions)?);
            normals = Some(tell::rows(py, morph.normals)?);
            sides = Some((PyArray1::from_vec(py, corners), tell::rows(py, of_corners)?));
            start = Some(morph.start);
        }
        dict.set_item("coarser", positions)?;
        dict.set_item("coarser_normals", normals)?;
        dict.set_item("_coarser_sides", sides)?;
        dict.set_item("coarser_deviation", start)?;
        Ok(dict)
    }
}

/// How near a camera may come until a deviation shows as more than so many pixels.
#[pyfunction]
pub(crate) fn switching_distance(
    deviation: f64,
    pixels: f64,
    height: f64,
    fov_degrees: f64,
) -> f64 {
    limitmesh::refine::switching_distance(deviation, pixels, height, fov_degrees.to_radians())
}
