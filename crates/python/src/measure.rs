//! Distances between meshes, and from a mesh to a limit surface; what kind of mesh it is.

use limitmesh::Triangles;
use limitmesh::measure::{
    Bounds, CertifiedHausdorff, CertifiedOptions, Hausdorff, OneSided, SamplingOptions,
    certified_hausdorff_observed, hausdorff_observed,
};
use limitmesh::progress::Observer;
use limitmesh::refine::{LimitDistanceOptions, is_certified, limit_distance_observed};
use limitmesh::refine::{UniformOptions, reference_levels, uniform_triangles_observed};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::control::Recipe;
use crate::errors::{Failure, OptionError};
use crate::options::{ControlOptions, Extent};
use crate::run::run;
use crate::soup::{MeshIn, as_triangles};
use crate::tell;

/// How a distance is found.
#[derive(FromPyObject, Clone)]
#[pyo3(from_item_all)]
pub(crate) struct How {
    certified: bool,
    samples: usize,
    /// How narrow the interval is to be.
    gap: Option<Extent>,
    max_work: Option<u64>,
}

/// A distance that was found.
enum Distance {
    Sampled(Hausdorff),
    Certified(CertifiedHausdorff),
}

/// The distance between two meshes as they are.
#[pyfunction]
pub(crate) fn measure<'py>(
    py: Python<'py>,
    surface: MeshIn<'py>,
    reference: MeshIn<'py>,
    how: How,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (a, b) = (surface.soup()?, reference.soup()?);
    let distance = run(py, threads, progress, move |observer| {
        let (of_a, of_b) = (as_triangles(&a), as_triangles(&b));
        let a = Triangles {
            positions: &a.positions,
            triangles: &of_a,
        };
        let b = Triangles {
            positions: &b.positions,
            triangles: &of_b,
        };
        between(a, b, &how, observer)
    })?;
    told(py, &distance)
}

/// The distance between a mesh as it is and the limit surface of another. That stands uniformly refined by `levels` where the distance
/// is sampled.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what Python hands over")]
pub(crate) fn measure_limit<'py>(
    py: Python<'py>,
    surface: MeshIn<'py>,
    reference: MeshIn<'py>,
    control: ControlOptions,
    how: How,
    levels: Option<usize>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (surface, soup, recipe) = (surface.soup()?, reference.soup()?, Recipe::new(control)?);
    if how.certified && !is_certified(recipe.scheme) {
        let what = format!(
            "nothing is certain about limit surfaces of the scheme {}",
            recipe.scheme.name()
        );
        return Err(OptionError::new_err(what));
    }
    let distance = run(py, threads, progress, move |observer| {
        let triangles = as_triangles(&surface);
        let a = Triangles {
            positions: &surface.positions,
            triangles: &triangles,
        };
        let control = recipe.control(soup, observer)?;
        if how.certified {
            let mut options = LimitDistanceOptions::default().unfold(recipe.unfolds());
            if let Some(gap) = how.gap {
                options = options.gap(Some(gap.of(control.diagonal)));
            }
            if let Some(work) = how.max_work {
                options = options.max_work(work);
            }
            let found =
                limit_distance_observed(a, &control.mesh, recipe.scheme, &options, observer)?;
            return Ok(Distance::Certified(found.distance));
        }
        let suiting = || reference_levels(control.mesh.face_count(), a.triangles.len());
        let Some(levels) = levels.or_else(suiting) else {
            return Err(Failure::Option(TOO_LARGE.to_owned()));
        };
        let limit = UniformOptions::default().levels(levels).limit(true);
        let limit = uniform_triangles_observed(&control.mesh, recipe.scheme, &limit, observer)?;
        drop(control);
        between(a, limit.as_triangles(), &how, observer)
    })?;
    told(py, &distance)
}

/// Why meshes are not compared with references as fine as themselves.
const TOO_LARGE: &str = "a reference for the limit surface two levels finer than the mesh is too large; certified=True measures \
     against the limit surface itself, levels= against a coarser reference";

fn between(
    a: Triangles<'_>,
    b: Triangles<'_>,
    how: &How,
    observer: &mut Observer<'_>,
) -> Result<Distance, Failure> {
    if !how.certified {
        let options = SamplingOptions::default().samples(how.samples);
        return Ok(Distance::Sampled(hausdorff_observed(
            a, b, &options, observer,
        )?));
    }
    let mut options = CertifiedOptions::default();
    if let Some(gap) = how.gap {
        options = options.gap(Some(gap.of(b.diagonal()))).relative_gap(0.0);
    }
    if let Some(work) = how.max_work {
        options = options.max_work(work);
    }
    Ok(Distance::Certified(certified_hausdorff_observed(
        a, b, &options, observer,
    )?))
}

fn told<'py>(py: Python<'py>, distance: &Distance) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    match distance {
        Distance::Sampled(found) => {
            dict.set_item("certified", false)?;
            dict.set_item("lower", found.symmetric())?;
            dict.set_item("upper", f64::INFINITY)?;
            dict.set_item("converged", true)?;
            dict.set_item("forward", sampled(py, &found.forward)?)?;
            dict.set_item("backward", sampled(py, &found.backward)?)?;
            dict.set_item("diagonal", found.reference_diagonal)?;
        }
        Distance::Certified(found) => {
            dict.set_item("certified", true)?;
            dict.set_item("lower", found.lower())?;
            dict.set_item("upper", found.upper())?;
            dict.set_item("converged", found.converged())?;
            dict.set_item("forward", bounded(py, &found.forward)?)?;
            dict.set_item("backward", bounded(py, &found.backward)?)?;
            dict.set_item("diagonal", found.reference_diagonal)?;
        }
    }
    Ok(dict)
}

fn sampled<'py>(py: Python<'py>, found: &OneSided) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("lower", found.max)?;
    dict.set_item("upper", f64::INFINITY)?;
    dict.set_item("mean", found.mean)?;
    dict.set_item("rms", found.rms)?;
    dict.set_item("percentile_95", found.percentile_95)?;
    dict.set_item("samples", found.samples)?;
    dict.set_item("at", found.at)?;
    dict.set_item("to", found.to)?;
    Ok(dict)
}

fn bounded<'py>(py: Python<'py>, found: &Bounds) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("lower", found.lower)?;
    dict.set_item("upper", found.upper)?;
    dict.set_item("mean", None::<f64>)?;
    dict.set_item("rms", None::<f64>)?;
    dict.set_item("percentile_95", None::<f64>)?;
    dict.set_item("samples", None::<usize>)?;
    dict.set_item("at", found.at)?;
    dict.set_item("to", found.to)?;
    Ok(dict)
}

/// What kind of mesh a control mesh is, as JSON, and what was found on the way to it.
#[pyfunction]
pub(crate) fn examine<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    threads: usize,
) -> PyResult<(String, Option<Bound<'py, PyDict>>)> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let (json, diagnosis) = run(py, threads, None, move |_| {
        let (mesh, faces, diagnosis) = recipe.plain(&soup)?;
        let json =
            limitmesh_cli::examined(&mesh, &faces).map_err(|why| Failure::Mesh(why.to_string()))?;
        Ok((json, diagnosis))
    })?;
    Ok((json, tell::diagnosis(py, &diagnosis)?))
}
