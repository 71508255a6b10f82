//! Refinement, and what it would give.

use std::time::Instant;

use limitmesh::carry::{borders, carried};
use limitmesh::criterion::{Criterion, LimitNormal, NeighbourNormal};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{Channel, Diagnosis};
use limitmesh::progress::Observer;
use limitmesh::refine::{
    ExactStop, StepwiseOptions, Stop, UniformOptions, exact_estimate_observed, exact_observed,
    stepwise_observed, uniform_observed,
};
use limitmesh::{HalfEdgeId, Mesh};
use numpy::PyArray1;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;

use crate::channels;
use crate::control::{Control, InterpolatedTold, Recipe};
use crate::errors::{Failure, OptionError};
use crate::options::{ControlOptions, Goals};
use crate::origins::Origins;
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
    triangles: Indices,
    normals: Vec<[f64; 3]>,
    /// Corners, three a triangle, whose normal is not that of their vertex, and these normals.
    side_corners: Vec<u32>,
    side_normals: Vec<[f64; 3]>,
    origins: Option<Origins>,
    /// By triangle, the input's face; none where triangles reach over several.
    parents: Option<Vec<u32>>,
    channels: Vec<Channel>,
    /// Lower, upper, whether that is proven, and where the lower one was found.
    error: Option<(f64, f64, bool, Point)>,
    stop: &'static str,
    levels: usize,
    pixels: Option<f64>,
    open_cones: usize,
    unfolded: usize,
    inverted: Option<usize>,
    /// That the library took.
    seconds: f64,
}

/// A tuple for Python, not a list.
type Point = (f64, f64, f64);

/// Rows of vertices, as wide as Python wants them, so that nobody has to convert them while others wait for the interpreter.
enum Indices {
    Narrow(Vec<[u32; 3]>),
    Wide(Vec<[i64; 3]>),
}

/// Refines a mesh; a dictionary of what a result is made of, by the names of its parts.
#[pyfunction]
pub(crate) fn refine<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    goals: Goals,
    has_wide_indices: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let method = Method::of(&goals)?;
    drop(mesh);
    let refined = run(py, threads, progress, move |observer| {
        let start = Instant::now();
        let mut control = recipe.control(soup, observer)?;
        let mut refined = match method {
            Method::Exact => exact(&mut control, &recipe, &goals, start, observer)?,
            _ => stepwise(&mut control, &recipe, (method, &goals), start, observer)?,
        };
        if has_wide_indices {
            refined.triangles = refined.triangles.widened();
        }
        Ok(refined)
    })?;
    let dict = PyDict::new(py);
    dict.set_item(intern!(py, "seconds"), refined.seconds)?;
    dict.set_item(intern!(py, "diagnosis"), tell::diagnosis(py, &refined.diagnosis)?)?;
    dict.set_item(intern!(py, "interpolation"), refined.interpolated.map(|told| told.told(py)).transpose()?)?;
    dict.set_item(intern!(py, "vertices"), tell::rows(py, refined.positions)?)?;
    match refined.triangles {
        Indices::Narrow(rows) => dict.set_item(intern!(py, "faces"), tell::rows(py, rows)?)?,
        Indices::Wide(rows) => dict.set_item(intern!(py, "faces"), tell::rows(py, rows)?)?,
    }
    dict.set_item(intern!(py, "normals"), tell::rows(py, refined.normals)?)?;
    let sides = (PyArray1::from_vec(py, refined.side_corners), tell::rows(py, refined.side_normals)?);
    dict.set_item(intern!(py, "_sides"), sides)?;
    let parents = refined.parents.map(|list| PyArray1::from_vec(py, list));
    dict.set_item(intern!(py, "_parents"), parents)?;
    dict.set_item(intern!(py, "_origins"), refined.origins)?;
    let channels = refined.channels.into_iter().map(|channel| channels::told(py, channel));
    dict.set_item(intern!(py, "channels"), PyList::new(py, channels.collect::<PyResult<Vec<_>>>()?)?)?;
    dict.set_item(intern!(py, "error"), refined.error)?;
    dict.set_item(intern!(py, "stop"), refined.stop)?;
    dict.set_item(intern!(py, "levels"), refined.levels)?;
    dict.set_item(intern!(py, "pixels"), refined.pixels)?;
    dict.set_item(intern!(py, "open_cones"), refined.open_cones)?;
    dict.set_item(intern!(py, "unfolded"), refined.unfolded)?;
    dict.set_item(intern!(py, "inverted"), refined.inverted)?;
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
    start: Instant,
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
    let seconds = start.elapsed().as_secs_f64();
    let (side_corners, side_normals) = std::mem::take(&mut found.sides).into_iter().unzip();
    let parents = control.input_faces(std::mem::take(&mut found.parents));
    let origins = Origins::new(control, std::mem::take(&mut found.origins));
    let error = found.error;
    let (positions, triangles) = found.mesh.into_positions_and_triangles();
    Ok(Refined {
        diagnosis: std::mem::take(&mut control.diagnosis),
        interpolated: control.interpolated.take(),
        positions,
        triangles: Indices::Narrow(triangles),
        normals: found.normals,
        side_corners,
        side_normals,
        origins,
        parents,
        channels,
        error: Some((error.lower, error.upper, error.certified, error.at.into())),
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
        seconds,
    })
}

impl Indices {
    fn widened(self) -> Self {
        match self {
            Self::Narrow(rows) => {
                Self::Wide(rows.into_par_iter().with_min_len(ROWS).map(|row| row.map(i64::from)).collect())
            }
            wide => wide,
        }
    }
}

/// Rows that are widened on one thread: for fewer it is not worth waking another.
const ROWS: usize = 1 << 14;

/// The angle where none is given, in degrees: the paper's middle one.
const USUAL_ANGLE: f64 = 10.0;

fn stepwise(
    control: &mut Control,
    recipe: &Recipe,
    (method, goals): (Method, &Goals),
    start: Instant,
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
    let mut found = match criterion {
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
    let (side_corners, side_normals, normals) = sided_normals(&found.mesh, recipe)?;
    let seconds = start.elapsed().as_secs_f64();
    let parents = control.input_faces(std::mem::take(&mut found.parents));
    let origins = Origins::new(control, std::mem::take(&mut found.origins));
    let (positions, triangles) = found.mesh.into_positions_and_triangles();
    Ok(Refined {
        diagnosis: std::mem::take(&mut control.diagnosis),
        interpolated: control.interpolated.take(),
        positions,
        triangles: Indices::Narrow(triangles),
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
        seconds,
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
