//! A front that Python keeps: a thread of its own has it and the mesh that it borrows, and answers one demand after the other.
//!
//! Threads do not live on in a forked process, so they end before Python forks. An update that somebody interrupts leaves a front
//! between two demands, which goes on from there with the next one; a thread that does not stop at once is left to itself. In all these
//! cases the next update names all there is as changed, and may begin with a fresh front: what a front is for a demand does not depend on
//! those before.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use limitmesh::Mesh;
use limitmesh::front::{Demand, Front as CoreFront, FrontError, Measure};
use limitmesh::progress::Observer;
use limitmesh::scheme::Scheme;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::control::Recipe;
use crate::errors::Failure;
use crate::options::{CameraIn, ControlOptions, Extent, camera, front_levels};
use crate::pool::{self, Pool};
use crate::run::{PATIENCE, ends, run};
use crate::soup::MeshIn;
use crate::tell;

/// What the thread of a front is given.
type Job = Box<dyn FnOnce(&mut Slot<'_>) + Send>;

/// The thread of a front that waits for its next job, and where to send that.
struct Worker {
    jobs: Sender<Job>,
    pool: Pool,
    /// Whether Python knows what the last job left.
    is_told: bool,
}

impl Worker {
    fn start(control: Arc<Mesh>, scheme: &'static dyn Scheme, threads: usize) -> PyResult<Self> {
        let pool = Pool::new(threads)?;
        let (jobs, received) = channel();
        pool.start(move || serve(&control, scheme, &received));
        Ok(Self {
            jobs,
            pool,
            is_told: false,
        })
    }

    fn end(self) {
        drop(self.jobs);
        self.pool.end();
    }
}

/// Does jobs until nobody can send any more.
fn serve(control: &Mesh, scheme: &'static dyn Scheme, jobs: &Receiver<Job>) {
    let mut slot = Slot {
        control,
        scheme,
        front: None,
    };
    for job in jobs {
        job(&mut slot);
    }
}

/// Where the thread of a front has it, once a job has made it.
struct Slot<'a> {
    control: &'a Mesh,
    scheme: &'static dyn Scheme,
    front: Option<CoreFront<'a>>,
}

impl<'a> Slot<'a> {
    /// The front for a demand; without one, the control mesh's own triangles if it is fresh.
    ///
    /// # Errors
    /// The front's; one that was cancelled goes on from where it is, any other failure leaves none.
    fn updated(
        &mut self,
        demand: Option<&Demand>,
        observer: &mut Observer<'_>,
    ) -> Result<&CoreFront<'a>, FrontError> {
        let mut front = match self.front.take() {
            Some(front) => front,
            None => CoreFront::measured_by_observed(
                self.control,
                self.scheme,
                Measure::Distance,
                observer,
            )?,
        };
        let done = demand.map_or(Ok(()), |demand| {
            front.update_observed(demand, observer).map(drop)
        });
        match done {
            Ok(()) => Ok(self.front.insert(front)),
            Err(why) => {
                self.front = matches!(why, FrontError::Cancelled(_)).then_some(front);
                Err(why)
            }
        }
    }
}

/// Where a worker is between two jobs.
type Place = Mutex<Option<Worker>>;

/// The places of all fronts.
static PLACES: Mutex<Vec<Weak<Place>>> = Mutex::new(Vec::new());

fn taken(place: &Place) -> Option<Worker> {
    // Not waited for: in a forked process nobody may be left to unlock it.
    place.try_lock().ok()?.take()
}

/// Ends the threads that are kept and those of fronts that wait for a job, and returns when they are gone.
#[pyfunction]
pub(crate) fn end_threads() {
    pool::end_kept();
    let Ok(mut places) = PLACES.try_lock() else {
        return;
    };
    places.retain(|place| place.strong_count() > 0);
    places
        .iter()
        .filter_map(Weak::upgrade)
        .filter_map(|place| taken(&place))
        .for_each(Worker::end);
}

/// What is asked of a front.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct DemandIn {
    tolerance: Option<Extent>,
    pixels: Option<f64>,
    cameras: Vec<CameraIn>,
    triangles: Option<usize>,
    max_levels: Option<usize>,
}

impl DemandIn {
    fn demand(&self, diagonal: f64) -> Result<Demand, Failure> {
        let cameras: Vec<_> = self.cameras.iter().map(camera).collect();
        let demand = match (self.pixels, self.tolerance) {
            (Some(pixels), _) => Demand::pixels(pixels, &cameras),
            (None, tolerance) => {
                Demand::tolerance(tolerance.map_or(0.0, |length| length.of(diagonal)))
            }
        };
        let demand = self
            .triangles
            .map_or(demand.clone(), |most| demand.triangles(most));
        let demand = demand.max_levels(front_levels(self.max_levels)?);
        demand.check()?;
        Ok(demand)
    }
}

/// A front of a mesh.
#[pyclass]
pub(crate) struct Front {
    control: Arc<Mesh>,
    diagonal: f64,
    scheme: &'static dyn Scheme,
    threads: usize,
    place: Arc<Place>,
}

/// How many vertices there are, which are new, and their positions; the same of triangles.
type Told<'py> = (
    usize,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray2<f64>>,
    usize,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray2<u32>>,
    Numbers,
);

/// Nodes that were divided and merged; the bound of the distance, whether it is proven, that in pixels, and the levels.
type Numbers = (usize, usize, f64, bool, Option<f64>, u32);

/// What an update changed.
struct News {
    counts: [usize; 2],
    vertices: Vec<u32>,
    positions: Vec<[f64; 3]>,
    triangles: Vec<u32>,
    corners: Vec<[u32; 3]>,
    numbers: Numbers,
}

impl News {
    /// Those of a front of which Python knows what it was before; else all there is.
    fn of(front: &CoreFront<'_>, is_known: bool) -> Self {
        let (positions, triangles) = (front.positions(), front.triangles());
        let changes = front.changes();
        let (vertices, slots) = match is_known {
            true => (changes.vertices.clone(), changes.triangles.clone()),
            false => (
                (0..positions.len() as u32).collect(),
                (0..triangles.len() as u32).collect(),
            ),
        };
        Self {
            counts: [positions.len(), triangles.len()],
            positions: vertices
                .iter()
                .map(|&v: &u32| positions[v as usize])
                .collect(),
            corners: slots
                .iter()
                .map(|&slot: &u32| triangles[slot as usize])
                .collect(),
            vertices,
            triangles: slots,
            numbers: (
                changes.divided,
                changes.merged,
                front.bound(),
                front.is_certified(),
                front.pixels(),
                front.depth(),
            ),
        }
    }
}

#[pymethods]
impl Front {
    #[new]
    fn new(
        py: Python<'_>,
        mesh: MeshIn<'_>,
        control: ControlOptions,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
        let scheme = recipe.scheme;
        let (control, diagonal) = run(py, threads, progress, move |observer| {
            let control = recipe.control(soup, observer)?;
            Ok((control.mesh, control.diagonal))
        })?;
        let place = Arc::default();
        PLACES
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(Arc::downgrade(&place));
        Ok(Self {
            control: Arc::new(control),
            diagonal,
            scheme,
            threads,
            place,
        })
    }

    /// Brings the front to a demand; without one, to the control mesh's own triangles if it is fresh.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        demand: Option<DemandIn>,
        progress: Option<Py<PyAny>>,
        is_told: bool,
    ) -> PyResult<Told<'py>> {
        let demand = demand
            .map(|demand| demand.demand(self.diagonal))
            .transpose()?;
        let mut worker = match taken(&self.place) {
            Some(worker) if worker.pool.is_here() => worker,
            other => {
                // The copy of a thread in a forked process is none.
                if let Some(copy) = other {
                    copy.end();
                }
                Worker::start(Arc::clone(&self.control), self.scheme, self.threads)?
            }
        };
        let (end, caller) = ends(progress);
        // What was told may have been lost on the way, by an interrupt.
        let is_told = worker.is_told && is_told;
        let job: Job = Box::new(move |slot| {
            end.finish(|observer| Ok(News::of(slot.updated(demand.as_ref(), observer)?, is_told)));
        });
        worker
            .jobs
            .send(job)
            .map_err(|_| PyRuntimeError::new_err("the front's thread has ended"))?;
        let (result, is_idle) = caller.wait(py, PATIENCE);
        worker.is_told = matches!(result, Ok(Ok(_)));
        if is_idle {
            *self.place.lock().unwrap_or_else(PoisonError::into_inner) = Some(worker);
        }
        let news = result??;
        Ok((
            news.counts[0],
            PyArray1::from_vec(py, news.vertices),
            tell::rows(py, news.positions)?,
            news.counts[1],
            PyArray1::from_vec(py, news.triangles),
            tell::rows(py, news.corners)?,
            news.numbers,
        ))
    }
}

impl Drop for Front {
    fn drop(&mut self) {
        if let Some(worker) = taken(&self.place) {
            worker.end();
        }
    }
}
