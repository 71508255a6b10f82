//! What is wrong with a glTF document, and where: places are named as JavaScript would, such as
//! `meshes[0].primitives[1].attributes.POSITION`.

use std::fmt;

/// Something that breaks the rules of glTF, or that is not supported.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct GltfFlaw {
    /// Where, such as `accessors[3].count`.
    pub place: String,
    /// What was met.
    pub met: String,
    /// What was expected.
    pub expected: String,
}

impl GltfFlaw {
    pub(super) fn new(place: impl Into<String>, met: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { place: place.into(), met: met.into(), expected: expected.into() }
    }
}

impl fmt::Display for GltfFlaw {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: met {}, expected {}", self.place, self.met, self.expected)
    }
}

impl std::error::Error for GltfFlaw {}

/// What the parts of this module give.
pub(super) type Result<T> = std::result::Result<T, GltfFlaw>;
