//! Progress and cancellation, alike for every long function of the library.
//!
//! A long function `f` has a twin `f_observed` with one more argument, last: an [`Observer`],
//! called on the calling thread, also while other threads work, that receives the stage, how much
//! of it is done and the number of triangles. It is called often: after each block of work, mostly
//! every few milliseconds and at least every 100, and costs little if it does little. An observer
//! that draws should limit how often it does. When it breaks, the function ends as soon as the
//! blocks in hand are finished, with an error that says [`Cancelled`]; an observer never influences
//! a result.
//!
//! ```
//! use core::ops::ControlFlow;
//! use limitmesh::progress::Progress;
//! use limitmesh::refine::{RefineError, UniformOptions, uniform_observed};
//! use limitmesh::{Mesh, scheme::Loop};
//!
//! let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let mesh = Mesh::from_triangles(corners, vec![[0, 1, 2]])?;
//! let mut observer = |progress: &Progress| {
//!     println!("{}: {} triangles", progress.stage, progress.triangles);
//!     if progress.triangles > 1_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
//! };
//! let options = UniformOptions::default().levels(10);
//! let result = uniform_observed(&mesh, &Loop, &options, &mut observer);
//! assert!(matches!(result, Err(RefineError::Cancelled(_))));
//! # Ok::<(), limitmesh::mesh::MeshError>(())
//! ```

use core::cell::{Cell, RefCell};
use core::fmt;
use core::ops::{ControlFlow, Range};

pub use crate::parallel::Cancelled;
use crate::parallel::{self, IsStopped};

/// The progress of a long function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// The current stage.
    pub stage: Stage,
    /// Units of this stage that are done; see [`Stage`] for the units.
    pub done: usize,
    /// The total of units, where it is known.
    pub total: Option<usize>,
    /// Triangles of the mesh that is being built, or of the surface that is being processed.
    pub triangles: usize,
}

/// The stages of long functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// Faces are being divided; the units are levels or steps, in exact refinement rounds over the
    /// changed faces.
    Refining,
    /// Vertices are being moved to the limit surface; the units are vertices.
    Limits,
    /// Control points are being solved for; the units are vertices.
    Interpolating,
    /// A mesh is being put together; the units are its triangles.
    Assembling,
    /// Edges are being collapsed; the units are removed triangles; their total is estimated where a
    /// tolerance decides it.
    Simplifying,
    /// A hierarchy for closest points or rays is being built; the units are triangles.
    Indexing,
    /// Distances are being measured at points; the units are points.
    Sampling,
    /// A distance is being bounded from above; the units are triangles, and then pieces of them,
    /// whose number is not known in advance.
    Bounding,
    /// Edges are being matched and counted; the units are triangles.
    Matching,
    /// Rays are being followed to a surface; the units are rays.
    Casting,
    /// The directions in which faces face are being found; the units are faces.
    Looking,
    /// Weights of control points are being found; the units are kinds of faces.
    Weighing,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Refining => "refining",
            Self::Limits => "moving vertices to the limit surface",
            Self::Interpolating => "solving for control points",
            Self::Assembling => "putting the mesh together",
            Self::Simplifying => "simplifying",
            Self::Indexing => "indexing triangles",
            Self::Sampling => "measuring at samples",
            Self::Bounding => "bounding the distance",
            Self::Matching => "matching edges",
            Self::Casting => "following rays",
            Self::Looking => "finding which way faces look",
            Self::Weighing => "weighing control points",
        })
    }
}

/// A callback that receives progress and decides whether to go on.
pub type Observer<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + 'a;

/// The observer that does nothing.
#[doc(hidden)]
pub fn unobserved(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The result of `work` without an observer: nothing cancels it.
#[doc(hidden)]
pub fn uncancelled<T>(work: impl FnOnce(&mut Observer<'_>) -> Result<T, Cancelled>) -> T {
    work(&mut unobserved).unwrap_or_else(|Cancelled| unreachable!("cancelled without an observer"))
}

/// An observer and its last progress, which long functions pass on to their loops.
#[doc(hidden)]
pub struct Watch<'a> {
    observer: &'a mut Observer<'a>,
    progress: Progress,
}

impl<'a> Watch<'a> {
    /// Begins with `stage`, with no unit done.
    #[doc(hidden)]
    pub fn new(observer: &'a mut Observer<'a>, stage: Stage) -> Self {
        Self {
            observer,
            progress: Progress {
                stage,
                done: 0,
                total: None,
                triangles: 0,
            },
        }
    }

    /// Another stage begins; the triangles stay.
    #[doc(hidden)]
    pub fn stage(&mut self, stage: Stage, total: Option<usize>) -> Result<(), Cancelled> {
        self.progress = Progress {
            stage,
            done: 0,
            total,
            ..self.progress
        };
        self.poll()
    }

    /// Sets the number of triangles, reported with the next call.
    #[doc(hidden)]
    pub fn triangles(&mut self, triangles: usize) {
        self.progress.triangles = triangles;
    }

    /// Reports the units of the stage that are done.
    #[doc(hidden)]
    pub fn done(&mut self, done: usize) -> Result<(), Cancelled> {
        self.progress.done = done;
        self.poll()
    }

    /// Reports the units of the stage that are done, and their expected total.
    pub(crate) fn done_of(&mut self, done: usize, total: usize) -> Result<(), Cancelled> {
        self.progress.total = Some(total);
        self.done(done)
    }

    /// Calls the observer with its last progress.
    #[doc(hidden)]
    pub fn poll(&mut self) -> Result<(), Cancelled> {
        match (self.observer)(&self.progress) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Cancelled),
        }
    }

    /// An observer for functions that take one: it does not pass on their progress, but whether to
    /// go on.
    #[doc(hidden)]
    pub fn observer(&mut self) -> impl FnMut(&Progress) -> ControlFlow<()> + '_ {
        |_| flow(self.poll())
    }
}

/// The outcome of a poll as an observer's answer.
fn flow(polled: Result<(), Cancelled>) -> ControlFlow<()> {
    match polled {
        Ok(()) => ControlFlow::Continue(()),
        Err(Cancelled) => ControlFlow::Break(()),
    }
}

/// A watch of functions that know each other by `&` alone. It stays on the calling thread: other threads cannot hold it.
#[doc(hidden)]
pub struct SharedWatch<'a> {
    watch: RefCell<Watch<'a>>,
    rounds: Cell<usize>,
}

/// Steps of a serial loop between two calls of the observer: some milliseconds at most.
const STEPS: usize = 1 << 12;

impl<'a> SharedWatch<'a> {
    #[doc(hidden)]
    pub fn new(observer: &'a mut Observer<'a>, stage: Stage) -> Self {
        Self {
            watch: RefCell::new(Watch::new(observer, stage)),
            rounds: Cell::new(0),
        }
    }

    /// [`Watch::stage`].
    #[doc(hidden)]
    pub fn stage(&self, stage: Stage, total: Option<usize>) -> Result<(), Cancelled> {
        self.watch.borrow_mut().stage(stage, total)
    }

    /// [`Watch::triangles`].
    #[doc(hidden)]
    pub fn triangles(&self, triangles: usize) {
        self.watch.borrow_mut().triangles(triangles);
    }

    /// [`Watch::done`].
    #[doc(hidden)]
    pub fn done(&self, done: usize) -> Result<(), Cancelled> {
        self.watch.borrow_mut().done(done)
    }

    /// Reports the end of a round of refinement and the number of triangles.
    #[doc(hidden)]
    pub fn round(&self, triangles: usize) -> Result<(), Cancelled> {
        self.rounds.set(self.rounds.get() + 1);
        self.triangles(triangles);
        self.stage(Stage::Refining, None)?;
        self.done(self.rounds.get())
    }

    /// [`Watch::poll`].
    #[doc(hidden)]
    pub fn poll(&self) -> Result<(), Cancelled> {
        self.watch.borrow_mut().poll()
    }

    /// [`Watch::observer`].
    #[doc(hidden)]
    pub fn observer(&self) -> impl FnMut(&Progress) -> ControlFlow<()> + '_ {
        |_| flow(self.poll())
    }

    /// Goes through items one after the other, polling now and then.
    #[doc(hidden)]
    pub fn each<I: IntoIterator>(
        &self,
        items: I,
        mut step: impl FnMut(I::Item),
    ) -> Result<(), Cancelled> {
        let mut items = items.into_iter();
        loop {
            let mut left = STEPS;
            for item in items.by_ref().take(STEPS) {
                step(item);
                left -= 1;
            }
            if left > 0 {
                return Ok(());
            }
            self.poll()?;
        }
    }

    /// [`parallel::pieces_polled`].
    #[doc(hidden)]
    pub fn pieces<T: Send, F: Fn(Range<usize>) -> T + Sync>(
        &self,
        n: usize,
        length: usize,
        f: F,
    ) -> Result<Vec<T>, Cancelled> {
        self.long_pieces(n, length, |piece, _| f(piece))
    }

    /// `[f(0), f(1), …, f(n−1)]`, each written where it belongs, `length` of them by one call.
    #[doc(hidden)]
    pub fn map<T: Send + Clone + Default, F: Fn(usize) -> T + Sync>(
        &self,
        n: usize,
        length: usize,
        f: F,
    ) -> Result<Vec<T>, Cancelled> {
        parallel::map_chunks_polled(n, length, &mut |_| self.poll(), f)
    }

    /// [`parallel::long_pieces_polled`].
    #[doc(hidden)]
    pub fn long_pieces<T: Send, F: Fn(Range<usize>, &IsStopped<'_>) -> T + Sync>(
        &self,
        n: usize,
        length: usize,
        f: F,
    ) -> Result<Vec<T>, Cancelled> {
        parallel::long_pieces_polled(n, length, &mut |_| self.poll(), f)
    }

    /// [`Self::long_pieces`] of as many elements as [`parallel::share`] says.
    #[doc(hidden)]
    pub fn long_shares<T: Send, F: Fn(Range<usize>, &IsStopped<'_>) -> T + Sync>(
        &self,
        n: usize,
        f: F,
    ) -> Result<Vec<T>, Cancelled> {
        self.long_pieces(n, parallel::share(n), f)
    }
}
