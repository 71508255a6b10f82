//! Uniform refinement: every triangle is split in four at each level.

use super::driver::Driver;
use super::{RefineError, Refinement};
use crate::mesh::Mesh;
use crate::progress::{Observer, unobserved};
use crate::scheme::Scheme;

/// How to refine uniformly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UniformOptions {
    /// Number of levels.
    pub levels: usize,
    /// Move the vertices to the limit surface at the end.
    pub limit: bool,
    /// Stop before the level that would have more triangles.
    pub max_triangles: Option<usize>,
}

impl Default for UniformOptions {
    fn default() -> Self {
        Self { levels: 3, limit: false, max_triangles: None }
    }
}

impl UniformOptions {
    /// Sets [`Self::levels`].
    pub fn levels(mut self, levels: usize) -> Self {
        self.levels = levels;
        self
    }

    /// Sets [`Self::limit`].
    pub fn limit(mut self, limit: bool) -> Self {
        self.limit = limit;
        self
    }

    /// Sets [`Self::max_triangles`].
    pub fn max_triangles(mut self, max_triangles: Option<usize>) -> Self {
        self.max_triangles = max_triangles;
        self
    }
}

/// Refines `mesh` uniformly.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
) -> Result<Refinement, RefineError> {
    uniform_observed(mesh, scheme, options, &mut unobserved)
}

/// [`uniform`], telling an observer how it goes on.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let all = |mesh: &Mesh| Ok(vec![true; mesh.face_count()]);
    let driver =
        Driver { scheme, levels: options.levels, limit: options.limit, max_triangles: options.max_triangles };
    driver.run(mesh, observer, all, |_, _| None)
}
