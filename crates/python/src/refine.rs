//! Refinement, and what it would give.

use std::time::Instant;

use limitmesh::carry::{borders, carried};
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{Channel, Diagnosis};
use limitmesh::progress::Observer;
use limitmesh::refine::{
    ExactStop, Origin, StepwiseOptions, Stop, UniformOptions, exact_estimate_observed, exact_observed,
    stepwise_observed, uniform_observed,
};
use limitmesh::{HalfEdgeId, Mesh};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::channels;
use crate::control::{Control, InterpolatedTold, Recipe};
use crate::errors::{Failure, OptionError};
use crate::options::{ControlOptions, Goals};
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// A refined mesh with everything that is told of it; what it was made of is gone by then.
struct Refined {
    /// What was found in the input.
    diagnosis: Diagnosis,
    /// How control points were found, if that was asked for.
    interpolated: Option<InterpolatedTold>,
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[f64; 3]>,
    /// Corners, three a triangle, whose normal is not that of their vertex, and these normals.
    side_corners: Vec<u32>,
    side_normals: Vec<[f64; 3]>,
    origins: Option<Origins>,
    /// By triangle, the input's face; none where triangles reach over several.
    parents: Option<Vec<u32>>,
    channels: Vec<Channel>,
    /// Lower, upper, whether that is proven, and where the lower one was found.
    error: Option<(f64, f64, bool, [f64; 3])>,
    stop: &'static str,
    levels: usize,
    pixels: Option<f64>,
    open_cones: usize,
    unfolded: usize,
    inverted: Option<usize>,
}

/// Where vertices came from: the input's face, the input's vertices at a triangle of it, and the weights of these.
struct Origins {
    faces: Vec<u32>,
    vertices: Vec<[u32; 3]>,
    barycentric: Vec<[f64; 3]>,
}

/// Refines a mesh; a dictionary with all that is known of the result.
#[pyfunction]
pub(crate) fn refine<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    goals: Goals,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let method = Method::of(&goals)?;
    drop(mesh);
    let (refined, seconds) = run(py, threads, progress, move |observer| {
        let start = Instant::now();
        let mut control = recipe.control(soup, observer)?;
        let refined = match method {
            Method::Exact => exact(&mut control, &recipe, &goals, observer)?,
            _ => stepwise(&mut control, &recipe, (method, &goals), observer)?,
        };
        drop(control);
        Ok((refined, start.elapsed().as_secs_f64()))
    })?;
    let dict = PyDict::new(py);
    dict.set_item("seconds", seconds)?;
    dict.set_item("diagnosis", tell::diagnosis(py, &refined.diagnosis)?)?;
    dict.set_item("interpolation", refined.interpolated.map(|told| told.told(py)).transpose()?)?;
    dict.set_item("vertices", tell::rows(py, refined.positions)?)?;
    dict.set_item("faces", tell::rows(py, refined.triangles)?)?;
    dict.set_item("normals", tell::rows(py, refined.normals)?)?;
    dict.set_item("side_corners", PyArray1::from_vec(py, refined.side_corners))?;
    dict.set_item("side_normals", tell::rows(py, refined.side_normals)?)?;
    dict.set_item("parent_face", refined.parents.map(|list| PyArray1::from_vec(py, list)))?;
    let (faces, vertices, barycentric) = match refined.origins {
        Some(all) => (Some(all.faces), Some(all.vertices), Some(all.barycentric)),
        None => (None, None, None),
    };
    dict.set_item("vertex_face", faces.map(|list| PyArray1::from_vec(py, list)))?;
    dict.set_item("vertex_corners", vertices.map(|list| tell::rows(py, list)).transpose()?)?;
    dict.set_item("barycentric", barycentric.map(|list| tell::rows(py, list)).transpose()?)?;
    let channels = refined.channels.into_iter().map(|channel| channels::told(py, channel));
    dict.set_item("channels", PyList::new(py, channels.collect::<PyResult<Vec<_>>>()?)?)?;
    dict.set_item("error", refined.error)?;
    dict.set_item("stop", refined.stop)?;
    dict.set_item("levels", refined.levels)?;
    dict.set_item("pixels", refined.pixels)?;
    dict.set_item("open_cones", refined.open_cones)?;
    dict.set_item("unfolded", refined.unfolded)?;
    dict.set_item("inverted", refined.inverted)?;
    Ok(dict)
}

/// The triangles and bytes that an exact refinement would take, and whether the triangles were counted.
#[pyfunction]
pub(crate) fn estimate(
    py: Python<'_>,
    mesh: MeshIn<'_>,
    control: ControlOptions,
    goals: Goals,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(usize, usize, bool)> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    run(py, threads, progress, move |observer| {
        let control = recipe.control(soup, observer)?;
        let options = goals.exact(control.diagonal, control.tells_faces_apart(), recipe.unfolds());
        let found = exact_estimate_observed(&control.mesh, recipe.scheme, &options, observer)?;
        Ok((found.triangles, found.memory_bytes, found.is_counted))
    })
}

/// What decides which faces are divided.
#[derive(Clone, Copy, PartialEq)]
enum Method {
    Exact,
    LimitNormal,
    Amresh,
    Uniform,
}

impl Method {
    fn of(goals: &Goals) -> PyResult<Self> {
        match goals.method.as_str() {
            "exact" => Ok(Self::Exact),
            "limit-normal" => Ok(Self::LimitNormal),
            "amresh" => Ok(Self::Amresh),
            "uniform" => Ok(Self::Uniform),
            other => Err(OptionError::new_err(format!(
                "method is '{other}', expected 'exact', 'limit-normal', 'amresh' or 'uniform'"
            ))),
        }
    }
}

fn exact(
    control: &mut Control,
    recipe: &Recipe,
    goals: &Goals,
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let options = goals
        .exact(control.diagonal, control.tells_faces_apart(), recipe.unfolds())
        .kept_edges(borders(&control.channels, &control.mesh));
    let mut found = exact_observed(&control.mesh, recipe.scheme, &options, observer)?;
    let channels = match control.channels.is_empty() {
        true => Vec::new(),
        false => carried(&control.channels, &control.mesh, recipe.scheme, &found)?,
    };
    let inverted = found.inverted_triangles();
    let (side_corners, side_normals) = std::mem::take(&mut found.sides).into_iter().unzip();
    let origins = Origins::new(control, &found.origins);
    let parents = control.input_faces(&found.parents);
    let error = found.error;
    let (positions, triangles) = found.mesh.into_positions_and_triangles();
    Ok(Refined {
        diagnosis: std::mem::take(&mut control.diagnosis),
        interpolated: control.interpolated.take(),
        positions,
        triangles,
        normals: found.normals,
        side_corners,
        side_normals,
        origins,
        parents,
        channels,
        error: Some((error.lower, error.upper, error.certified, error.at)),
        stop: match found.stop {
            ExactStop::Met => "met",
            ExactStop::Triangles => "triangles",
            ExactStop::TriangleCap => "triangle-cap",
            ExactStop::LevelCap => "level-cap",
            ExactStop::MemoryCap => "memory-cap",
            ExactStop::Rounding => "rounding",
            ExactStop::Cones => "cones",
            _ => "other",
        },
        levels: found.levels,
        pixels: found.pixels,
        open_cones: found.open_cones,
        unfolded: found.unfolded,
        inverted: Some(inverted),
    })
}

impl Origins {
    /// None where the library tells of none.
    fn new(control: &Control, origins: &[Origin]) -> Option<Self> {
        if origins.is_empty() {
            return None;
        }
        let on_whole = |origin: &Origin| control.parts.on_whole(origin.face, origin.barycentric);
        let (faces, barycentric): (Vec<u32>, Vec<[f64; 3]>) = origins.iter().map(on_whole).unzip();
        let corners = |&face: &u32| [0, 1, 2].map(|corner| control.corners[3 * face as usize + corner]);
        let vertices = faces.iter().map(corners).collect();
        let faces = faces.into_iter().map(|face| control.faces[face as usize]).collect();
        Some(Self { faces, vertices, barycentric })
    }
}

/// The angle where none is given, in degrees: the paper's middle one.
const USUAL_ANGLE: f64 = 10.0;

fn stepwise(
    control: &mut Control,
    recipe: &Recipe,
    (method, goals): (Method, &Goals),
    observer: &mut Observer<'_>,
) -> Result<Refined, Failure> {
    let angle = goals.angle.unwrap_or(USUAL_ANGLE).to_radians();
    let criterion: Option<Box<dyn Criterion>> = match method {
        Method::LimitNormal => {
            let criterion = LimitNormal::new(angle);
            let viewer = goals.viewer();
            Some(Box::new(viewer.map_or(criterion, |view| criterion.view(view))))
        }
        Method::Amresh => Some(Box::new(NeighbourNormal::new(angle))),
        Method::Uniform | Method::Exact => None,
    };
    let (mesh, scheme, cap) = (&control.mesh, recipe.scheme, goals.cap());
    let carries = !control.channels.is_empty();
    let traces = carries || goals.origins;
    let found = match criterion {
        Some(criterion) => {
            let options = StepwiseOptions::default().levels(goals.levels).origins(traces).max_triangles(cap);
            stepwise_observed(mesh, scheme, criterion.as_ref(), &options, observer)?
        }
        None => {
            let options = UniformOptions::default().levels(goals.levels).origins(traces).max_triangles(cap);
            uniform_observed(mesh, scheme, &options, observer)?
        }
    };
    let channels = match carries {
        true => carried(&control.channels, mesh, scheme, &found)?,
        false => Vec::new(),
    };
    let origins = Origins::new(control, &found.origins);
    let parents = control.input_faces(&found.parents);
    let (side_corners, side_normals, normals) = sided_normals(&found.mesh, recipe)?;
    let (positions, triangles) = found.mesh.into_positions_and_triangles();
    Ok(Refined {
        diagnosis: std::mem::take(&mut control.diagnosis),
        interpolated: control.interpolated.take(),
        positions,
        triangles,
        normals,
        side_corners,
        side_normals,
        origins,
        parents,
        channels,
        error: None,
        stop: match found.stop {
            Stop::Levels => "levels",
            Stop::Satisfied => "satisfied",
            Stop::TriangleCap { .. } => "triangle-cap",
            _ => "other",
        },
        levels: found.steps.len(),
        pixels: None,
        open_cones: 0,
        unfolded: 0,
        inverted: None,
    })
}

/// Limit normals: by corner where these differ, and by vertex.
#[expect(clippy::type_complexity, reason = "three lists that are taken apart at once")]
fn sided_normals(mesh: &Mesh, recipe: &Recipe) -> Result<(Vec<u32>, Vec<[f64; 3]>, Vec<[f64; 3]>), Failure> {
    let sided = LimitTable::new(recipe.scheme).sided_normals(mesh)?;
    let topology = mesh.topology();
    let differs = |&h: &HalfEdgeId| sided.at(topology, h) != sided.by_vertex()[topology.origin(h).index()];
    let corners: Vec<HalfEdgeId> = match mesh.tags().creases.is_empty() {
        true => Vec::new(),
        false => topology.half_edges().filter(differs).collect(),
    };
    let normals = corners.iter().map(|&h| sided.at(topology, h)).collect();
    Ok((corners.iter().map(|h| h.0).collect(), normals, sided.into_by_vertex()))
}
