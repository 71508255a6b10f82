//! Refinement: uniform, and the paper's stepwise adaptive method.
//!
//! Takes a control mesh, a scheme and a rule (levels, a criterion); gives a finer mesh and a
//! report.

mod adaptive;
mod attribute_goal;
mod corner_sources;
mod driver;
mod exact;
mod exact_options;
mod exact_result;
mod input_distance;
mod junctions;
mod kept_faces;
mod level;
mod levels_of_detail;
mod limit_distance;
mod limit_reference;
mod lineage;
mod quad_order;
mod replay;
mod rounding;
mod simplified;
mod split;
mod step;
mod stepwise;
mod tags;
mod uniform;
mod within;

pub use attribute_goal::AttributeGoal;
pub use exact::{
    Frames, exact, exact_estimate, exact_estimate_observed, exact_frames, exact_frames_observed,
    exact_observed, is_certified, quads, quads_observed,
};
pub use exact_options::{AngleGoal, Caps, ExactOptions, Finish, Goals, PixelGoal};
pub use exact_result::{ErrorBounds, Estimate, Exact, ExactStop, Origin, Statistics};
pub use input_distance::InputDistance;
pub use level::{Geomorph, Level, switching_distance};
pub use levels_of_detail::{LodOptions, levels_of_detail, levels_of_detail_observed};
pub use limit_distance::{
    LimitDistance, LimitDistanceOptions, limit_distance, limit_distance_observed,
};
pub use limit_reference::{limit_reference, reference_levels};
pub use lineage::Traced;
pub use replay::{Frame, Replay, ReplayError};
pub use rounding::{most_rounding_to_single, with_room};
pub use stepwise::{SeamRule, StepwiseOptions, stepwise, stepwise_observed};
pub use uniform::{
    UniformOptions, UniformTriangles, uniform, uniform_observed, uniform_triangles,
    uniform_triangles_observed,
};
pub use within::{Within, WithinOptions, turned_over_triangles, within, within_observed};

use core::time::Duration;

use crate::criterion::CriterionError;
use crate::error_messages;
use crate::interpolate::InterpolateError;
use crate::limit::{LimitError, SidedNormals};
use crate::measure::MeasureError;
use crate::mesh::{Mesh, MeshError};
use crate::progress::Cancelled;
use crate::ring::INFINITELY_SHARP;
use crate::simplify::SimplifyError;

/// The reason why a refinement gave no mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum RefineError {
    /// The criterion has no answer.
    Criterion(CriterionError),
    /// A limit position does not exist.
    Limit(LimitError),
    /// The result would not be a mesh, or an option is out of range.
    Mesh(MeshError),
    /// A semi-sharp tag, for a method that supports only smooth and infinitely sharp ones.
    FadingTag {
        /// The edge or vertex that is tagged.
        tag: String,
        /// Its sharpness.
        sharpness: f64,
    },
    /// A distance could not be measured.
    Measure(MeasureError),
    /// Edges could not be collapsed.
    Simplify(SimplifyError),
    /// There are no control points for the requested limits.
    Interpolate(InterpolateError),
    /// A scheme that passes through its control points, for a method that smooths by moving
    /// vertices.
    NotSmoothing {
        /// Its name.
        scheme: String,
    },
    /// A frame cannot be replayed.
    Replay(ReplayError),
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    RefineError {
        Self::FadingTag { tag, sharpness } => ("{tag} has the sharpness {sharpness}, which is semi-sharp: √3-subdivision supports smooth (0) \
         and infinitely sharp ({INFINITELY_SHARP} and more) edges and vertices only; use a scheme that splits triangles in four"),
        Self::Measure(error) => ("{error}"),
        Self::Simplify(error) => ("{error}"),
        Self::Interpolate(error) => ("{error}"),
        Self::NotSmoothing { scheme } => ("the scheme {scheme} passes through its control points, so that it smooths nothing; Loop's and Warren's do"),
        Self::Replay(error) => ("{error}"),
    }
    from { Criterion(CriterionError), Limit(LimitError), Mesh(MeshError), Cancelled(Cancelled) }
}

impl From<MeasureError> for RefineError {
    fn from(error: MeasureError) -> Self {
        match error {
            MeasureError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Measure(error),
        }
    }
}

impl From<InterpolateError> for RefineError {
    fn from(error: InterpolateError) -> Self {
        match error {
            InterpolateError::Limit(error) => Self::Limit(error),
            InterpolateError::Mesh(error) => Self::Mesh(error),
            InterpolateError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Interpolate(error),
        }
    }
}

impl From<SimplifyError> for RefineError {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::Cancelled(_) => Self::Cancelled(Cancelled),
            error => Self::Simplify(error),
        }
    }
}

impl From<ReplayError> for RefineError {
    fn from(error: ReplayError) -> Self {
        match error {
            ReplayError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Replay(error),
        }
    }
}

/// The result of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// 1 for the first step.
    pub step: usize,
    /// Faces before the step.
    pub faces_before: usize,
    /// Faces that fail by the criterion.
    pub divisible: usize,
    /// Indivisible faces with 0, 1, 2 and 3 split edges: the cases (a) to (d) of the paper's Figure 5.
    pub closure: [usize; 4],
    /// Faces after the step.
    pub faces_after: usize,
    /// Time taken.
    pub duration: Duration,
}

/// The reason why a refinement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stop {
    /// All requested levels were done.
    Levels,
    /// No face was divisible any more.
    Satisfied,
    /// The next step would have passed the triangle cap.
    TriangleCap {
        /// Triangles that the step would have given.
        needed: usize,
    },
}

/// A refined mesh and a report.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Refinement {
    /// The refined mesh.
    pub mesh: Mesh,
    /// Unit limit normals, if requested.
    pub normals: Option<SidedNormals>,
    /// The origin of each vertex, in the control face of one of its triangles; empty unless
    /// requested.
    pub origins: Vec<Origin>,
    /// The control face of each triangle; empty unless requested.
    pub parents: Vec<u32>,
    /// The reports of all steps.
    pub steps: Vec<StepReport>,
    /// The reason why there were no more steps.
    pub stop: Stop,
}

impl Traced for Refinement {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn origins(&self) -> &[Origin] {
        &self.origins
    }

    fn parents(&self) -> &[u32] {
        &self.parents
    }
}
