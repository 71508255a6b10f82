//! What is wrong with a glTF document, and where: places are named as JavaScript would, such as
//! `meshes[0].primitives[1].attributes.POSITION`.

use std::fmt;

use crate::error::expected_but_found;

/// Something that breaks the rules of glTF, or that is not supported.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct GltfFlaw {
    /// Where, such as `accessors[3].count`.
    pub place: String,
    /// What is wrong, in words.
    pub problem: String,
}

impl GltfFlaw {
    /// Something was found where glTF asks for something else.
    pub(super) fn new(
        place: impl Into<String>,
        found: impl AsRef<str>,
        expected: impl AsRef<str>,
    ) -> Self {
        Self::saying(place, expected_but_found(expected.as_ref(), found.as_ref()))
    }

    /// A problem in words.
    pub(super) fn saying(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            problem: problem.into(),
        }
    }
}

impl fmt::Display for GltfFlaw {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: {}", self.place, self.problem)
    }
}

impl std::error::Error for GltfFlaw {}

/// What the parts of this module give.
pub(super) type Result<T> = std::result::Result<T, GltfFlaw>;
