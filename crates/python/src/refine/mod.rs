//! Refinement, and what it would give: by distances that are proven ([`exact`]), by the criteria of the literature in steps ([`stepwise`]) and
//! over restricted quadtrees ([`restricted`]), by √3-subdivision ([`sqrt3`]), and
//! uniformly ([`uniform`]); exactly and near the input ([`mod@within`]).

mod exact;
mod restricted;
mod sqrt3;
mod stepwise;
mod uniform;
mod within;

use std::time::Instant;

use limitmesh::limit::SidedNormals;
use limitmesh::mesh::Channel;
use limitmesh::refine::exact_estimate_observed;
use limitmesh::{HalfEdgeId, Mesh};
use numpy::PyArray1;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;

use crate::channels;
use crate::control::{Recipe, Tables};
use crate::errors::OptionError;
use crate::options::{ControlOptions, Goals};
use crate::origins::{Origins, Trail};
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// A refined mesh with everything that is told of it.
pub(crate) struct Refined {
    /// What was found in the input, and how control points were found.
    tables: Tables,
    positions: Vec<[f64; 3]>,
    triangles: Indices,
    /// Pairs of triangles that make quads, by the two corners where the edges between them begin.
    quads: Vec<[u32; 2]>,
    normals: Vec<[f64; 3]>,
    /// Corners, three a triangle, whose normal is not that of their vertex, and these normals.
    side_corners: Vec<u32>,
    side_normals: Vec<[f64; 3]>,
    origins: Trail,
    /// By triangle, the input's face; none where triangles reach over several, and one for each of so many that stand together.
    parents: Option<Vec<u32>>,
    channels: Vec<Channel>,
    /// Lower, upper, whether that is proven, and where the lower one was found.
    error: Option<(f64, f64, bool, Point)>,
    /// Lower and upper, where it was to be near the input.
    input_distance: Option<(f64, f64)>,
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
        let control = recipe.control(soup, observer)?;
        let refined = match method {
            Method::Exact => exact::refined(control, &recipe, &goals, observer)?,
            Method::Planarity | Method::VertexError => {
                restricted::refined(control, &recipe, (method, &goals), observer)?
            }
            Method::Sqrt3 => sqrt3::to_goals(control, &goals, observer)?,
            Method::Sqrt3Uniform => sqrt3::by_steps(control, &goals, observer)?,
            Method::Uniform => uniform::refined(control, &recipe, &goals, observer)?,
            Method::LimitNormal | Method::Amresh => {
                stepwise::refined(control, &recipe, (method, &goals), observer)?
            }
        };
        let mut refined = if has_wide_indices {
            refined.widened()
        } else {
            refined
        };
        refined.took(start.elapsed().as_secs_f64());
        Ok(refined)
    })?;
    refined.told(py)
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
        let options = control.options(&goals, &recipe);
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
    Planarity,
    VertexError,
    Sqrt3,
    Sqrt3Uniform,
}

impl Method {
    fn of(goals: &Goals) -> PyResult<Self> {
        match (goals.method.as_str(), goals.sqrt3) {
            ("exact", false) => Ok(Self::Exact),
            ("limit-normal", false) => Ok(Self::LimitNormal),
            ("amresh", false) => Ok(Self::Amresh),
            ("uniform", false) => Ok(Self::Uniform),
            ("planarity", false) => Ok(Self::Planarity),
            ("vertex-error", false) => Ok(Self::VertexError),
            ("exact", true) => Ok(Self::Sqrt3),
            ("uniform", true) => Ok(Self::Sqrt3Uniform),
            (other, true) => {
                let what = format!(
                    "method is '{other}', expected 'exact' or 'uniform' with scheme='sqrt3'"
                );
                Err(OptionError::new_err(what))
            }
            (other, false) => Err(OptionError::new_err(format!(
                "there is no method '{other}'"
            ))),
        }
    }
}

impl Refined {
    /// A mesh of which no more is told.
    fn of_mesh(mesh: Mesh, normals: Normals, tables: Tables) -> Self {
        Self::of_triangles(mesh.into_positions_and_triangles(), normals, tables)
    }

    /// Triangles of which no more is told.
    fn of_triangles(
        (positions, triangles): (Vec<[f64; 3]>, Vec<[u32; 3]>),
        normals: Normals,
        tables: Tables,
    ) -> Self {
        Self {
            tables,
            positions,
            triangles: Indices::Narrow(triangles),
            quads: Vec::new(),
            normals: normals.by_vertex,
            side_corners: normals.corners,
            side_normals: normals.of_corners,
            origins: Trail::default(),
            parents: None,
            channels: Vec::new(),
            error: None,
            input_distance: None,
            stop: "",
            levels: 0,
            pixels: None,
            open_cones: 0,
            unfolded: 0,
            inverted: None,
            seconds: 0.0,
        }
    }

    /// With what was carried along.
    pub(crate) fn with_channels(self, channels: Vec<Channel>) -> Self {
        Self { channels, ..self }
    }

    /// With vertex numbers of 64 bits.
    pub(crate) fn widened(self) -> Self {
        Self {
            triangles: self.triangles.widened(),
            ..self
        }
    }

    /// Puts down how long it took.
    pub(crate) fn took(&mut self, seconds: f64) {
        self.seconds = seconds;
    }

    /// A dictionary of its parts, by their names in Python.
    pub(crate) fn told(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item(intern!(py, "seconds"), self.seconds)?;
        dict.set_item(
            intern!(py, "diagnosis"),
            tell::diagnosis(py, &self.tables.diagnosis)?,
        )?;
        dict.set_item(intern!(py, "crease_angle"), self.tables.crease_angle)?;
        let interpolated = self
            .tables
            .interpolated
            .map(|told| told.told(py))
            .transpose()?;
        dict.set_item(intern!(py, "interpolation"), interpolated)?;
        dict.set_item(intern!(py, "vertices"), tell::rows(py, self.positions)?)?;
        match self.triangles {
            Indices::Narrow(rows) => dict.set_item(intern!(py, "faces"), tell::rows(py, rows)?)?,
            Indices::Wide(rows) => dict.set_item(intern!(py, "faces"), tell::rows(py, rows)?)?,
        }
        dict.set_item(intern!(py, "_quads"), tell::rows(py, self.quads)?)?;
        dict.set_item(intern!(py, "normals"), tell::rows(py, self.normals)?)?;
        let sides = (
            PyArray1::from_vec(py, self.side_corners),
            tell::rows(py, self.side_normals)?,
        );
        dict.set_item(intern!(py, "_sides"), sides)?;
        let parents = self.parents.map(|list| PyArray1::from_vec(py, list));
        dict.set_item(intern!(py, "_parents"), parents)?;
        dict.set_item(
            intern!(py, "_origins"),
            Origins::new(self.tables, self.origins),
        )?;
        let channels = self
            .channels
            .into_iter()
            .map(|channel| channels::told(py, channel));
        dict.set_item(
            intern!(py, "channels"),
            PyList::new(py, channels.collect::<PyResult<Vec<_>>>()?)?,
        )?;
        dict.set_item(intern!(py, "error"), self.error)?;
        dict.set_item(intern!(py, "input_distance"), self.input_distance)?;
        dict.set_item(intern!(py, "stop"), self.stop)?;
        dict.set_item(intern!(py, "levels"), self.levels)?;
        dict.set_item(intern!(py, "pixels"), self.pixels)?;
        dict.set_item(intern!(py, "open_cones"), self.open_cones)?;
        dict.set_item(intern!(py, "unfolded"), self.unfolded)?;
        dict.set_item(intern!(py, "inverted"), self.inverted)?;
        Ok(dict)
    }
}

/// Limit normals: by corner where these differ, and by vertex.
struct Normals {
    corners: Vec<u32>,
    of_corners: Vec<[f64; 3]>,
    by_vertex: Vec<[f64; 3]>,
}

impl Normals {
    fn of_sides(mesh: &Mesh, sided: SidedNormals) -> Self {
        let topology = mesh.topology();
        let differs = |&h: &HalfEdgeId| {
            sided.at(topology, h) != sided.by_vertex()[topology.origin(h).index()]
        };
        let corners: Vec<HalfEdgeId> = match mesh.tags().creases.is_empty() {
            true => Vec::new(),
            false => topology.half_edges().filter(differs).collect(),
        };
        let of_corners = corners.iter().map(|&h| sided.at(topology, h)).collect();
        Self {
            corners: corners.iter().map(|h| h.0).collect(),
            of_corners,
            by_vertex: sided.into_by_vertex(),
        }
    }
}

impl Indices {
    fn widened(self) -> Self {
        match self {
            Self::Narrow(rows) => Self::Wide(
                rows.into_par_iter()
                    .with_min_len(ROWS)
                    .map(|row| row.map(i64::from))
                    .collect(),
            ),
            wide => wide,
        }
    }
}

/// Rows that are widened on one thread: for fewer it is not worth waking another.
const ROWS: usize = 1 << 14;
