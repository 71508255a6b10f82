//! A front: triangles that approximate a limit surface, refined and coarsened from one demand to
//! the next.
//!
//! Müller and Jaeschke ("Adaptive subdivision curves and surfaces", 1998) refine and coarsen by
//! local operations, so that every other adaptive mesh is reached from any given one. Here the
//! result does not depend on the previous mesh: the mesh for a demand is a function of the demand,
//! to the byte, and an update computes only the differences.
//!
//! Takes a control mesh and a scheme, and [`Demand`]s one after another: a distance, pixels in the
//! pictures of cameras, a number of triangles. Gives a conforming mesh ([`Front::mesh`]), its
//! buffers, whose changes an update reports ([`Front::positions`], [`Front::triangles`],
//! [`Changes`]), and a proven bound of its distance from the limit surface ([`Front::bound`]).
//!
//! A front may measure by other criteria of the literature instead of distances ([`Measure`]), to
//! compare them.
//!
//! Data flows from `pieces` (the surface over a node, its *value*: its distance from the node's
//! triangle, whatever the neighbours are, or another `measure`) to `forest` (nodes, neighbours,
//! vertices), which `least` brings from one least set of divided nodes to the next, with the proof;
//! `demand` decides which nodes want to be divided and for how long that is certain while cameras
//! move, `agenda` keeps nodes by the time of their next test, `asking` tests new ones; `buffers`
//! has the triangles, `snapshot` the mesh with its origins.
//!
//! ```
//! use limitmesh::front::{Demand, Front};
//! use limitmesh::{Mesh, scheme::Loop};
//!
//! let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! let (control, _) = Mesh::from_soup(&soup, &Default::default())?;
//! let mut front = Front::new(&control, &Loop)?;
//! let tolerance = 0.002 * control.diagonal();
//! front.update(&Demand::tolerance(tolerance))?;
//! assert!(front.bound() <= tolerance);
//!
//! // Coarser, and back again: the same bytes.
//! let before = front.mesh()?;
//! front.update(&Demand::tolerance(3.0 * tolerance))?;
//! assert!(front.triangles().len() < before.face_count());
//! let changes = front.update(&Demand::tolerance(tolerance))?;
//! assert!(changes.divided > 0);
//! assert_eq!(front.mesh()?, before);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod agenda;
mod asking;
mod buffers;
mod demand;
mod forest;
mod halt;
mod least;
mod measure;
mod pieces;
mod snapshot;

use agenda::Agenda;
use asking::Asking;
use buffers::Buffers;
pub use buffers::Changes;
pub use demand::{Demand, MOST_LEVELS};
use demand::{Goal, Question};
use forest::Forest;
use halt::Halt;
use least::{Watch as _, extend, loosen};
pub use measure::Measure;
pub use snapshot::Snapshot;

use crate::criterion::CriterionError;
use crate::error_messages;
use crate::limit::LimitError;
use crate::limit_surface::LimitSurface;
use crate::mesh::{Mesh, MeshError, check_size};
use crate::progress::{Cancelled, Observer, unobserved};
use crate::scheme::Scheme;

/// An error of a front.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum FrontError {
    /// The scheme has no limit at the shape of some ring.
    Limit(LimitError),
    /// The demand is out of range.
    Demand(CriterionError),
    /// The result is no mesh.
    Mesh(MeshError),
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    FrontError {}
    from { Limit(LimitError), Demand(CriterionError), Mesh(MeshError), Cancelled(Cancelled) }
}

/// Triangles that approximate the limit surface of a control mesh, updated to the current demand.
pub struct Front<'a> {
    forest: Forest<'a>,
    buffers: Buffers,
    changes: Changes,
    /// The last demand.
    demand: Option<Demand>,
    question: Question,
    /// Nodes by their measure, or by the movement of cameras until their next test.
    agenda: Agenda,
    /// Nodes by when cameras have moved and turned so far.
    turning: Agenda,
    /// Clocks of cameras that move, without turns and with them, and the length in which turns count.
    clocks: [f64; 2],
    length: f64,
    /// Nodes that want, and were not divided since there would be too many triangles.
    waiting: Vec<u32>,
    /// Nodes that have no reason to be divided any more, and still are since an update was cancelled.
    leaving: Vec<u32>,
}

/// Steps towards a limit that fits: the first, and the greatest.
const FIRST_STEP: f64 = 1.05;
const GREATEST_STEP: f64 = 2.0;

/// The number of outdated entries, beyond that of others, at which they are removed.
const STALE: usize = 1 << 16;

/// A ring's buckets are this part of the scene's length.
const RING_PART: f64 = 1.0 / 1024.0;

/// The clock starts anew at this many lengths: its digits are needed.
const LAST_HOUR: f64 = 1e4;

/// The divisions of an update.
#[derive(Default)]
struct Counts {
    divided: usize,
    merged: usize,
}

impl<'a> Front<'a> {
    /// A front of the control mesh's own triangles, with their corners on the limit surface.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring, or the mesh's diagonal is not within 1e-70 to 1e70.
    pub fn new(control: &'a Mesh, scheme: &'a dyn Scheme) -> Result<Self, FrontError> {
        Self::measured_by(control, scheme, Measure::Distance)
    }

    /// A front with another measure than distances: [`Demand::tolerance`] is then in that measure's
    /// unit. Cameras need distances.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn measured_by(
        control: &'a Mesh,
        scheme: &'a dyn Scheme,
        measure: Measure,
    ) -> Result<Self, FrontError> {
        Self::measured_by_observed(control, scheme, measure, &mut unobserved)
    }

    /// [`Self::measured_by`] with an observer.
    ///
    /// # Errors
    /// Those of [`Self::new`], and [`FrontError::Cancelled`].
    pub fn measured_by_observed(
        control: &'a Mesh,
        scheme: &'a dyn Scheme,
        measure: Measure,
        observer: &mut Observer<'_>,
    ) -> Result<Self, FrontError> {
        check_size(control)?;
        let mut halt = Halt::new(observer);
        let surface = match measure {
            Measure::PlanarityAngle => LimitSurface::new(control, scheme)?,
            _ => LimitSurface::without_normals(control, scheme)?,
        };
        let length = match measure {
            Measure::PlanarityAngle => core::f64::consts::PI,
            _ => control.diagonal(),
        };
        let forest = Forest::of(surface, measure, &mut halt)?;
        if let Some(why) = forest.surface().failure() {
            return Err(why.clone().into());
        }
        let question = Question {
            eyes: None,
            limit: f64::INFINITY,
            max_levels: demand::MOST_LEVELS,
        };
        let agenda = Agenda::ladder(length);
        let (changes, waiting, leaving) = (Changes::default(), Vec::new(), Vec::new());
        let buffers = Buffers::default();
        let mut front = Self {
            forest,
            buffers,
            changes,
            demand: None,
            question,
            agenda,
            turning: Agenda::ring(length),
            clocks: [0.0; 2],
            length,
            waiting,
            leaving,
        };
        front.ask_all(front.question.clone(), &mut halt);
        front.finish(Counts::default());
        Ok(front)
    }

    /// Brings the front to another demand. The front depends on the last demand alone. Only the
    /// difference is computed, and the changes are reported.
    ///
    /// All nodes are tested once where a demand is of another kind than the one before: cameras
    /// after a tolerance, other pictures or another limit in pixels, other levels, and a number of
    /// triangles that cameras' limit does not fit.
    ///
    /// # Errors
    /// The demand is out of range, or has cameras where the front does not measure distances, or a
    /// stencil failed.
    pub fn update(&mut self, demand: &Demand) -> Result<&Changes, FrontError> {
        self.update_observed(demand, &mut unobserved)
    }

    /// [`Self::update`] with an observer. When that breaks, the front is one between both demands,
    /// [`Self::changes`] reports its changes, and the next demand continues from there.
    ///
    /// # Errors
    /// Those of [`Self::update`], and [`FrontError::Cancelled`].
    pub fn update_observed(
        &mut self,
        demand: &Demand,
        observer: &mut Observer<'_>,
    ) -> Result<&Changes, FrontError> {
        demand.check()?;
        if let Goal::Pixels(value, _) = demand.goal
            && self.forest.measure() != Measure::Distance
        {
            let (name, expected) = (
                "limit in pixels",
                "none, for a front that does not go by distances",
            );
            return Err(CriterionError::BadParameter {
                name,
                value,
                expected,
            }
            .into());
        }
        if self.demand.as_ref() == Some(demand) {
            self.changes = Changes::default();
            return Ok(&self.changes);
        }
        let question = Question::of(demand)?;
        self.demand = Some(demand.clone());
        let (mut counts, mut halt) = (Counts::default(), Halt::new(observer));
        let most = demand.most.unwrap_or(demand::MOST_TRIANGLES);
        // A demand is mostly close to the last one; the first demand begins with the coarsest mesh.
        if demand.most.is_some() || !self.ask(question.clone(), most, &mut counts, &mut halt) {
            let greatest = self.forest.greatest(|extent| question.measure(extent));
            let is_near =
                demand.most.is_some() && self.question.eyes.is_some() == question.eyes.is_some();
            let start = if is_near {
                self.question.limit.min(greatest)
            } else {
                greatest
            };
            self.fit(question, start, most, &mut counts, &mut halt);
        }
        self.finish(counts);
        if halt.is_asked() {
            self.demand = None;
            return Err(Cancelled.into());
        }
        match self.forest.surface().failure() {
            Some(why) => Err(why.clone().into()),
            None => Ok(&self.changes),
        }
    }

    /// The least limit from the question's on whose triangles are no more than `most`, in growing steps from `start` and then by
    /// halving the numbers between one that does not fit and one that does: a greater limit never takes more.
    fn fit(
        &mut self,
        question: Question,
        start: f64,
        most: usize,
        counts: &mut Counts,
        halt: &mut Halt<'_>,
    ) {
        let is_over = core::cell::Cell::new(false);
        let mut fits = |limit: f64| {
            let fits = self.ask_kept(
                Question {
                    limit,
                    ..question.clone()
                },
                most,
                counts,
                halt,
            );
            is_over.set(halt.is_asked());
            fits
        };
        let least = question.limit;
        let (mut next, mut factor) = (start.min(f64::MAX).max(least), FIRST_STEP);
        let (low, high);
        if fits(next) {
            loop {
                let fitting = next;
                if fitting <= least || is_over.get() {
                    return;
                }
                next = (next / factor).max(least);
                if !fits(next) {
                    (low, high) = (next, fitting);
                    break;
                }
                factor = (factor * factor).min(GREATEST_STEP);
            }
        } else {
            loop {
                let unfit = next;
                next = if next > 0.0 {
                    next * factor
                } else {
                    f64::INFINITY
                };
                if is_over.get() {
                    return;
                }
                // Nothing is divided where any distance will do.
                if fits(next) || next.is_infinite() {
                    (low, high) = (unfit, next);
                    break;
                }
                factor = (factor * factor).min(GREATEST_STEP);
            }
        }
        let [mut low, mut high] = [low, high].map(f64::to_bits);
        while high - low > 1 && !is_over.get() {
            let middle = low + (high - low) / 2;
            if fits(f64::from_bits(middle)) {
                high = middle
            } else {
                low = middle
            }
        }
        fits(f64::from_bits(high));
    }

    /// Answers a question: `false` if that would take more triangles than `most`, whose front is then one of some greater limit.
    fn ask(
        &mut self,
        question: Question,
        most: usize,
        counts: &mut Counts,
        halt: &mut Halt<'_>,
    ) -> bool {
        if question == self.question && self.waiting.is_empty() && self.leaving.is_empty() {
            return self.forest.triangles <= most;
        }
        if question.eyes.is_none() {
            return self.ask_kept(question, most, counts, halt);
        }
        let moved = question.moved(&self.question, self.length);
        let is_known = self.agenda.is_ring() && question.max_levels == self.question.max_levels;
        if !(is_known && self.clocks[1] + moved[1] < LAST_HOUR * self.length) {
            self.agenda = Agenda::ring(RING_PART * self.length);
            self.turning = Agenda::ring(RING_PART * self.length);
            self.clocks = [0.0; 2];
            let (lost, gained) = self.ask_all(question, halt);
            return self.settle(lost, gained, most, counts, halt);
        }
        self.question = question;
        let mut due = Vec::new();
        let extents = &self.forest.extents;
        let is_current = |node: u32, stamp| extents[node as usize].stamp == stamp;
        for (clock, moved) in self.clocks.iter_mut().zip(moved) {
            *clock += moved;
        }
        self.agenda.turn_to(self.clocks[0], is_current, &mut due);
        self.turning.turn_to(self.clocks[1], is_current, &mut due);
        let (mut lost, mut gained) = (Vec::new(), Vec::new());
        for node in due {
            let wants = self.asked(node);
            self.note(node, wants, &mut lost, &mut gained);
        }
        self.settle(lost, gained, most, counts, halt)
    }

    /// The test by measures that are kept for all nodes: for distances, and while a limit is
    /// searched for.
    fn ask_kept(
        &mut self,
        question: Question,
        most: usize,
        counts: &mut Counts,
        halt: &mut Halt<'_>,
    ) -> bool {
        let is_known = !self.agenda.is_ring()
            && question.max_levels == self.question.max_levels
            && question.eyes == self.question.eyes;
        if !is_known {
            self.agenda = Agenda::ladder(
                self.forest
                    .greatest(|extent| question.measure(extent))
                    .min(f64::MAX),
            );
            self.turning = Agenda::ring(self.length);
            let (lost, gained) = self.ask_all(question, halt);
            return self.settle(lost, gained, most, counts, halt);
        }
        let (low, high) = (
            question.limit.min(self.question.limit),
            question.limit.max(self.question.limit),
        );
        self.question = question;
        let mut asked = Vec::new();
        let extents = &self.forest.extents;
        let is_current = |node: u32, stamp| extents[node as usize].stamp == stamp;
        self.agenda
            .visit_between(low, high, is_current, |node| asked.push(node));
        let (mut lost, mut gained) = (Vec::new(), Vec::new());
        for node in asked {
            let wants =
                self.question.measure(&self.forest.extents[node as usize]) > self.question.limit;
            self.note(node, wants, &mut lost, &mut gained);
        }
        self.settle(lost, gained, most, counts, halt)
    }

    fn note(&mut self, node: u32, wants: bool, lost: &mut Vec<u32>, gained: &mut Vec<u32>) {
        let before = core::mem::replace(&mut self.forest.extents[node as usize].wants, wants);
        if before != wants {
            if wants {
                gained.push(node)
            } else {
                lost.push(node)
            }
        }
    }

    /// Tests all nodes against another question.
    fn ask_all(&mut self, question: Question, halt: &mut Halt<'_>) -> (Vec<u32>, Vec<u32>) {
        self.question = question;
        let (mut lost, mut gained) = (Vec::new(), Vec::new());
        for node in 0..self.forest.nodes.len() as u32 {
            halt.goes_on(self.forest.triangles);
            if self.forest.exists(node) {
                let wants = self.asked(node);
                self.note(node, wants, &mut lost, &mut gained);
            }
        }
        (lost, gained)
    }

    /// Whether a node wants; it is kept until its next test.
    fn asked(&mut self, node: u32) -> bool {
        let mut asking = Asking {
            question: &self.question,
            agendas: [&mut self.agenda, &mut self.turning],
            clocks: self.clocks,
            length: self.length,
            most: usize::MAX,
            halt: None,
        };
        asking.arrived(&self.forest, node)
    }

    fn settle(
        &mut self,
        mut lost: Vec<u32>,
        mut gained: Vec<u32>,
        most: usize,
        counts: &mut Counts,
        halt: &mut Halt<'_>,
    ) -> bool {
        lost.append(&mut self.leaving);
        // Nodes that leave come first, so that their triangles are not counted.
        let mut loosened = loosen(&mut self.forest, lost, halt);
        self.leaving = core::mem::take(&mut loosened.leaving);
        gained.append(&mut self.waiting);
        gained.append(&mut loosened.waiting);
        gained.retain(|&node| self.forest.exists(node) && self.forest.wants(node));
        let mut asking = Asking {
            question: &self.question,
            agendas: [&mut self.agenda, &mut self.turning],
            clocks: self.clocks,
            length: self.length,
            most,
            halt: Some(&mut *halt),
        };
        let mut extended = extend(&mut self.forest, &gained, &mut asking);
        counts.divided += extended.divided;
        counts.merged += loosened.merged;
        self.waiting.append(&mut extended.waiting);
        let extents = &self.forest.extents;
        if self.agenda.len() + self.turning.len() > 2 * extents.len() + STALE {
            let is_current = |node: u32, stamp| extents[node as usize].stamp == stamp;
            self.agenda.sweep(is_current);
            self.turning.sweep(is_current);
        }
        self.waiting.is_empty() && self.forest.triangles <= most && !halt.is_asked()
    }

    fn finish(&mut self, Counts { divided, merged }: Counts) {
        let triangles = self.buffers.update(&mut self.forest);
        let mut vertices = core::mem::take(&mut self.forest.vertices.written);
        vertices.sort_unstable();
        vertices.dedup();
        self.changes = Changes {
            vertices,
            triangles,
            divided,
            merged,
        };
    }

    /// The vertices' positions, on the limit surface: those of the control mesh, then others in
    /// slots that are theirs as long as they are needed. Some may be in no triangle.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.forest.vertices.positions
    }

    /// The triangles' corners; the triangles have no order.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.buffers.triangles
    }

    /// The changes of the last update.
    pub fn changes(&self) -> &Changes {
        &self.changes
    }

    /// The mesh, in an order of its own: the control mesh's vertices, then the others in the order
    /// of a walk over the control faces.
    ///
    /// # Errors
    /// A coordinate is not finite.
    pub fn mesh(&self) -> Result<Mesh, FrontError> {
        let numbered = snapshot::numbered(&self.forest);
        Ok(Mesh::from_triangles(
            numbered.positions,
            numbered.triangles,
        )?)
    }

    /// The mesh with its infinitely sharp tags and its origins.
    ///
    /// # Errors
    /// A coordinate is not finite.
    pub fn snapshot(&self) -> Result<Snapshot, FrontError> {
        Ok(Snapshot::of(&self.forest)?)
    }

    /// The greatest distance between mesh and limit surface, both ways and by place, in the control
    /// mesh's units: proven for schemes of a known family, an estimate from samples for others.
    /// Infinite where a front does not measure distances.
    pub fn bound(&self) -> f64 {
        match self.forest.measure() {
            Measure::Distance => self.worst(),
            _ => f64::INFINITY,
        }
    }

    /// The greatest value of a triangle's node, in the unit of the front's measure: above the
    /// demand only where levels or triangles are limited.
    pub fn worst(&self) -> f64 {
        self.forest.worst(|extent| extent.value)
    }

    /// The greatest number of pixels of [`Self::worst`] in the pictures of the demand's cameras;
    /// `None` where there are none.
    pub fn pixels(&self) -> Option<f64> {
        self.question.eyes.as_ref()?;
        Some(self.forest.worst(|extent| self.question.measure(extent)))
    }

    /// Levels of the finest triangle below its control face.
    pub fn depth(&self) -> u32 {
        self.forest.worst(|extent| f64::from(extent.level)) as u32
    }

    /// The distance, or number of pixels, that all triangles meet as far as levels allow: the
    /// demanded one, or the one that the number of triangles allows.
    pub fn limit(&self) -> f64 {
        self.question.limit
    }

    /// Whether the distance is proven.
    pub fn is_certified(&self) -> bool {
        self.forest.measure() == Measure::Distance
            && self.forest.surface().rules().scheme().family().is_some()
    }
}
