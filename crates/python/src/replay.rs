//! A refinement for other positions of its control vertices: replayed, and for the frames of an animation.

use std::sync::Arc;
use std::time::Instant;

use limitmesh::carry::carried;
use limitmesh::refine::{ExactStop, Frame, Frames, exact_frames_observed, exact_observed};
use limitmesh::{PolygonSoup, QuadControl};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::control::{Control, Recipe};
use crate::errors::Failure;
use crate::options::{ControlOptions, Goals};
use crate::refine::Refined;
use crate::run::run;
use crate::soup::{MeshIn, positions};
use crate::tell;

/// What gives the vertices of a refined mesh for positions of the input's vertices.
#[pyclass(frozen)]
pub(crate) struct Replay {
    own: Arc<limitmesh::refine::Replay>,
    sources: Arc<Sources>,
}

/// Positions that follow from others differ by no more than this share of the diagonal.
const ROUNDING: f64 = 1e-12;

fn elsewhere(what: &str, at: [f64; 3]) -> Failure {
    Failure::Mesh(format!(
        "{what} became one at {at:?}: sheets were cut apart within edges, or vertices welded within a distance, of which other positions \
         tell nothing"
    ))
}

/// Rows of positions and of normals.
type Told<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

#[pymethods]
impl Replay {
    /// Positions and limit normals for a row of positions for each vertex of the input.
    fn at<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'py, f64>,
        threads: usize,
    ) -> PyResult<Told<'py>> {
        let positions = self::positions(&positions)?;
        let (own, sources) = (Arc::clone(&self.own), Arc::clone(&self.sources));
        let frame = run(py, threads, None, move |_| {
            let mut frame = Frame::default();
            own.frame(&sources.positions(&positions, "positions")?, &mut frame)?;
            Ok(frame)
        })?;
        Ok((
            tell::rows(py, frame.positions)?,
            tell::rows(py, frame.normals)?,
        ))
    }
}

/// Where the vertices of a control mesh are among the input's.
enum Sources {
    Vertices {
        /// By control vertex, the first that it was.
        rows: Vec<u32>,
        /// That and another one that it was.
        alike: Vec<[u32; 2]>,
    },
    /// They follow from the polygons.
    Quads(Box<(QuadControl, PolygonSoup)>),
}

impl Sources {
    /// Those of the control mesh that came of a soup.
    ///
    /// # Errors
    /// It has vertices elsewhere, of which other positions tell nothing.
    fn of(recipe: &Recipe, control: &Control, soup: PolygonSoup) -> Result<Self, Failure> {
        if let Some((quads, _)) = recipe.quads(&soup)? {
            let found = quads.positions(&soup, &soup.positions)?;
            let near = |(a, b): (&[f64; 3], &[f64; 3])| {
                let apart = (0..3).map(|axis| (a[axis] - b[axis]).abs());
                apart.fold(0.0, f64::max) <= ROUNDING * control.diagonal
            };
            let mut both = found.iter().zip(control.mesh.positions());
            return match both.find(|&both| !near(both)) {
                None => Ok(Self::Quads(Box::new((quads, soup)))),
                Some((_, at)) => Err(elsewhere("a vertex", *at)),
            };
        }
        let input = &soup.positions;
        let mut rows = vec![u32::MAX; control.mesh.vertex_count()];
        let mut alike = Vec::new();
        for (&own, &input) in control
            .mesh
            .triangles()
            .as_flattened()
            .iter()
            .zip(&control.tables.corners)
        {
            let row = &mut rows[own as usize];
            match *row {
                u32::MAX => *row = input,
                first if first != input => alike.push([first.min(input), first.max(input)]),
                _ => {}
            }
        }
        alike.sort_unstable();
        alike.dedup();
        let of_row = |row: u32| input.get(row as usize);
        let is_elsewhere =
            |&(position, &row): &(&[f64; 3], &u32)| of_row(row).is_some_and(|own| own != position);
        if let Some((at, &row)) = control
            .mesh
            .positions()
            .iter()
            .zip(&rows)
            .find(is_elsewhere)
        {
            return Err(elsewhere(&format!("vertices[{row}]"), *at));
        }
        Ok(Self::Vertices { rows, alike })
    }

    /// Those of the control mesh's vertices.
    ///
    /// # Errors
    /// What is one vertex has several; `name` is what the rows are called.
    fn positions(&self, input: &[[f64; 3]], name: &str) -> Result<Vec<[f64; 3]>, Failure> {
        let (rows, alike) = match self {
            Self::Vertices { rows, alike } => (rows, alike),
            Self::Quads(known) => return Ok(known.0.positions(&known.1, input)?),
        };
        if let Some([a, b]) = alike
            .iter()
            .find(|pair| input[pair[0] as usize] != input[pair[1] as usize])
        {
            return Err(Failure::Mesh(format!(
                "{name}[{a}] and {name}[{b}] are apart, which are one vertex in the control mesh; weld=None keeps all apart"
            )));
        }
        let place = |&row: &u32| input.get(row as usize).copied().unwrap_or_default();
        Ok(rows.iter().map(place).collect())
    }
}

/// Refines a mesh, and prepares a replay of it: the dictionary of a refinement, and the replay.
#[pyfunction]
pub(crate) fn replay<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    goals: Goals,
    has_wide_indices: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Replay)> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let (refined, replay) = run(py, threads, progress, move |observer| {
        let start = Instant::now();
        let control = recipe.control(soup.clone(), observer)?;
        let sources = Sources::of(&recipe, &control, soup)?;
        let options = control
            .options(&goals, &recipe)
            .flat_regions(false)
            .origins(true);
        let found = exact_observed(&control.mesh, recipe.scheme, &options, observer)?;
        let own = limitmesh::refine::Replay::new_observed(
            &control.mesh,
            recipe.scheme,
            &found,
            observer,
        )?;
        let channels = match control.channels.is_empty() {
            true => Vec::new(),
            false => carried(&control.channels, &control.mesh, recipe.scheme, &found)?,
        };
        let replay = Replay {
            own: Arc::new(own),
            sources: Arc::new(sources),
        };
        let refined = Refined::of_exact(found, control.tables).with_channels(channels);
        Ok((finished(refined, has_wide_indices, start), replay))
    })?;
    Ok((refined.told(py)?, replay))
}

/// Lower and upper bound, whether that is proven, and where the lower one was found.
type Bounds = (f64, f64, bool, (f64, f64, f64));

/// Refines a mesh for several positions of its vertices, one frame after the other in `frames`: the dictionary of a refinement, what
/// is proven of each frame, and the replay.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what Python hands over")]
pub(crate) fn refine_frames<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    frames: PyReadonlyArray2<'py, f64>,
    control: ControlOptions,
    goals: Goals,
    has_wide_indices: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Vec<Bounds>, Replay)> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let frames = positions(&frames)?;
    let (refined, errors, replay) = run(py, threads, progress, move |observer| {
        let start = Instant::now();
        let vertices = soup.positions.len();
        let control = recipe.control(soup.clone(), observer)?;
        let sources = Sources::of(&recipe, &control, soup)?;
        let frames = frames
            .chunks_exact(vertices.max(1))
            .enumerate()
            .map(|(frame, own)| sources.positions(own, &format!("frames[{frame}]")))
            .collect::<Result<Vec<_>, _>>()?;
        let options = control.options(&goals, &recipe);
        let found =
            exact_frames_observed(&control.mesh, recipe.scheme, &frames, &options, observer)?;
        let Frames {
            mut refined,
            replay,
            errors,
            ..
        } = found;
        let worst = errors.iter().map(|error| error.upper).fold(0.0, f64::max);
        let is_beyond = goals
            .tolerance
            .is_some_and(|tolerance| worst > tolerance.of(control.diagonal));
        if refined.stop == ExactStop::Met && is_beyond {
            refined.stop = ExactStop::Rounding;
        }
        let channels = match control.channels.is_empty() {
            true => Vec::new(),
            false => carried(&control.channels, &control.mesh, recipe.scheme, &refined)?,
        };
        let errors = errors
            .iter()
            .map(|e| (e.lower, e.upper, e.certified, e.at.into()))
            .collect();
        let refined = Refined::of_exact(refined, control.tables).with_channels(channels);
        let replay = Replay {
            own: Arc::new(replay),
            sources: Arc::new(sources),
        };
        Ok((finished(refined, has_wide_indices, start), errors, replay))
    })?;
    Ok((refined.told(py)?, errors, replay))
}

fn finished(refined: Refined, has_wide_indices: bool, start: Instant) -> Refined {
    let mut refined = if has_wide_indices {
        refined.widened()
    } else {
        refined
    };
    refined.took(start.elapsed().as_secs_f64());
    refined
}
