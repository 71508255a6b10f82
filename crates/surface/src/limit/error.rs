//! Why a scheme has no limit stencil at a ring.

use crate::error_messages;
use crate::mesh::Mesh;
use crate::ring::RingShape;
use crate::scheme::{Family, Scheme};

/// Why a scheme has no limit stencil at a ring.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum LimitError {
    /// The scheme's masks do not have the property that the analysis rests on.
    Unsuitable {
        /// The scheme's name.
        scheme: String,
        /// The ring at fault.
        shape: RingShape,
        /// The expected and the actual property of the masks.
        what: String,
    },
    /// A scheme for quads and a mesh of triangles, or the other way round, or a function that is for triangles alone.
    Cells {
        /// The scheme or the function.
        what: String,
        /// The faces that it is for.
        expected: &'static str,
    },
}

error_messages! {
    LimitError {
        Self::Unsuitable { scheme, shape, what } => ("scheme {scheme} at {shape:?}: {what}"),
        Self::Cells { what, expected } => ("{what} needs a mesh of {expected}, which this one is not"),
    }
}

/// Refuses a scheme for quads on a mesh of triangles, and others on a mesh of quads.
///
/// # Errors
/// The scheme is for other faces.
#[doc(hidden)]
pub fn suits(scheme: &dyn Scheme, mesh: &Mesh) -> Result<(), LimitError> {
    let is_for_quads = scheme.family() == Some(Family::CatmullClark);
    let what = || format!("the scheme {}", scheme.name());
    match (is_for_quads, mesh.topology().has_quads()) {
        (true, false) => Err(LimitError::Cells {
            what: what(),
            expected: "quads (QuadControl makes them of polygons)",
        }),
        (false, true) => Err(LimitError::Cells {
            what: what(),
            expected: "triangles",
        }),
        _ => Ok(()),
    }
}

impl LimitError {
    /// The masks of `scheme` at `shape` break a condition.
    pub(super) fn unsuitable(
        scheme: &dyn Scheme,
        shape: RingShape,
        what: impl Into<String>,
    ) -> Self {
        Self::Unsuitable {
            scheme: scheme.name().to_owned(),
            shape,
            what: what.into(),
        }
    }
}
