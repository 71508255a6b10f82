//! Uniform refinement: every triangle is split in four at each level.

use super::driver::Driver;
use super::{Observer, RefineError, Refinement};
use crate::mesh::Mesh;
use crate::scheme::Scheme;

/// How to refine uniformly.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct UniformOptions<'a> {
    /// Number of levels.
    pub levels: usize,
    /// Move the vertices to the limit surface at the end.
    pub limit: bool,
    /// Stop before the level that would have more triangles.
    pub max_triangles: Option<usize>,
    /// Called after each level.
    pub observer: Option<Observer<'a>>,
}

impl Default for UniformOptions<'_> {
    fn default() -> Self {
        Self { levels: 3, limit: false, max_triangles: None, observer: None }
    }
}

impl<'a> UniformOptions<'a> {
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

    /// Sets [`Self::observer`].
    pub fn observer(mut self, observer: Observer<'a>) -> Self {
        self.observer = Some(observer);
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
    options: &UniformOptions<'_>,
) -> Result<Refinement, RefineError> {
    let all = |mesh: &Mesh| Ok(vec![true; mesh.face_count()]);
    let driver = Driver {
        scheme,
        levels: options.levels,
        limit: options.limit,
        max_triangles: options.max_triangles,
        observer: options.observer,
    };
    driver.run(mesh, all, |_, _| None)
}
