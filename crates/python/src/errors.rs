//! What can go wrong, as Python's exceptions.

use limitmesh::criterion::CriterionError;
use limitmesh::front::FrontError;
use limitmesh::interpolate::InterpolateError;
use limitmesh::limit::LimitError;
use limitmesh::measure::MeasureError;
use limitmesh::mesh::{ChannelError, MeshError as CoreMeshError};
use limitmesh::part::UnfoldedError;
use limitmesh::progress::Cancelled;
use limitmesh::refine::{RefineError, ReplayError};
use limitmesh::simplify::SimplifyError;
use limitmesh::{ProximityError, RayError};
use limitmesh_io::{ReadError as CoreReadError, WriteError};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(
    limitmesh,
    Error,
    PyValueError,
    "What limitmesh cannot do with its arguments."
);
create_exception!(
    limitmesh,
    MeshError,
    Error,
    "A mesh that is none; the message names the row."
);
create_exception!(
    limitmesh,
    OptionError,
    Error,
    "An option that has no meaning, or not with the others."
);
create_exception!(
    limitmesh,
    ReadError,
    Error,
    "A file that cannot be read or written; the message names the place."
);

/// Why a job gave nothing.
pub(crate) enum Failure {
    /// The mesh is at fault.
    Mesh(String),
    /// An option is.
    Option(String),
    /// A file is.
    File(String),
    /// The observer said stop.
    Cancelled,
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Mesh(what) => MeshError::new_err(what),
            Failure::Option(what) => OptionError::new_err(what),
            Failure::File(what) => ReadError::new_err(what),
            Failure::Cancelled => Error::new_err("cancelled"),
        }
    }
}

impl From<CoreMeshError> for Failure {
    fn from(error: CoreMeshError) -> Self {
        match error {
            CoreMeshError::BadOption { .. } => Self::Option(error.to_string()),
            // Rows of the arrays, by the arrays' names.
            CoreMeshError::NotFinite {
                vertex,
                axis,
                value,
            } => Self::Mesh(format!(
                "vertices[{vertex}, {axis}] is {value}, expected a finite number"
            )),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<CriterionError> for Failure {
    fn from(error: CriterionError) -> Self {
        match error {
            CriterionError::BadParameter { .. } => Self::Option(error.to_string()),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<LimitError> for Failure {
    fn from(error: LimitError) -> Self {
        Self::Mesh(error.to_string())
    }
}

impl From<ProximityError> for Failure {
    fn from(error: ProximityError) -> Self {
        match error {
            ProximityError::Cancelled(_) => Self::Cancelled,
            ProximityError::Limit(error) => error.into(),
            ProximityError::Scheme { .. } | ProximityError::Tolerance { .. } => {
                Self::Option(error.to_string())
            }
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<RayError> for Failure {
    fn from(error: RayError) -> Self {
        match error {
            RayError::Limit(error) => error.into(),
            RayError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Option(error.to_string()),
        }
    }
}

impl From<Cancelled> for Failure {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<FrontError> for Failure {
    fn from(error: FrontError) -> Self {
        match error {
            FrontError::Cancelled(_) => Self::Cancelled,
            FrontError::Limit(error) => error.into(),
            FrontError::Demand(error) => error.into(),
            FrontError::Mesh(error) => error.into(),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<MeasureError> for Failure {
    fn from(error: MeasureError) -> Self {
        match error {
            MeasureError::Cancelled(_) => Self::Cancelled,
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<ChannelError> for Failure {
    fn from(error: ChannelError) -> Self {
        Self::Option(error.to_string())
    }
}

impl From<SimplifyError> for Failure {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::Cancelled(_) => Self::Cancelled,
            SimplifyError::Mesh(error) => error.into(),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<RefineError> for Failure {
    fn from(error: RefineError) -> Self {
        match error {
            RefineError::Cancelled(_) => Self::Cancelled,
            RefineError::Criterion(error) => error.into(),
            RefineError::Mesh(error) => error.into(),
            RefineError::Replay(error) => error.into(),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<ReplayError> for Failure {
    fn from(error: ReplayError) -> Self {
        match error {
            ReplayError::Mesh(error) => error.into(),
            ReplayError::Limit(error) => error.into(),
            ReplayError::Cancelled(error) => error.into(),
            ReplayError::Scheme { .. } | ReplayError::TooMany { .. } => {
                Self::Option(error.to_string())
            }
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<InterpolateError> for Failure {
    fn from(error: InterpolateError) -> Self {
        match error {
            InterpolateError::Cancelled(_) => Self::Cancelled,
            InterpolateError::Mesh(error) => error.into(),
            InterpolateError::TooFar { .. } => Self::Option(error.to_string()),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<UnfoldedError> for Failure {
    fn from(error: UnfoldedError) -> Self {
        match error {
            UnfoldedError::Interpolate(error) => error.into(),
            UnfoldedError::Refine(error) => error.into(),
            error => Self::Mesh(error.to_string()),
        }
    }
}

impl From<CoreReadError> for Failure {
    fn from(error: CoreReadError) -> Self {
        Self::File(error.to_string())
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::File(error.to_string())
    }
}
