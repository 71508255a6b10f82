//! Why a scheme has no limit stencil at a ring.

use crate::ring::RingShape;
use crate::scheme::Scheme;

/// Why a scheme has no limit stencil at a ring.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LimitError {
    /// The scheme's masks do not have the property that the analysis rests on.
    #[error("scheme {scheme} at {shape:?}: {what}")]
    Unsuitable {
        /// The scheme's name.
        scheme: String,
        /// The ring at fault.
        shape: RingShape,
        /// The expected and the actual property of the masks.
        what: String,
    },
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
