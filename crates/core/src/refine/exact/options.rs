//! Goals, caps and results of exact refinement.

use core::ops::ControlFlow;

use crate::mesh::{Mesh, MeshError};

/// What exact refinement is to reach, and what it must not exceed.
///
/// Of the goals on quality (tolerance, angle) each that is given is to be met everywhere; a number of triangles ends
/// the refinement early, with the worst places refined first.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct ExactOptions<'a> {
    /// Greatest distance between mesh and limit surface, either way, as a length. Default: none.
    pub tolerance: Option<f64>,
    /// Greatest angle between a triangle's normal and the limit normals of its corners (the paper's equation 2), in
    /// radians. Default: none.
    pub angle: Option<f64>,
    /// The best mesh with at most so many triangles. Default: none.
    pub triangles: Option<usize>,
    /// Levels at most below the control faces. Default: 24.
    pub max_levels: usize,
    /// Triangles at most, as a cap rather than a goal: reaching it is a failure to meet the others. Default: none.
    pub max_triangles: Option<usize>,
    /// Called after each round; may cancel. Default: none.
    pub observer: Option<ExactObserver<'a>>,
}

/// Levels that are tried where none are given: edges are divided by more than ten million then.
const USUAL_LEVELS: usize = 24;

impl Default for ExactOptions<'_> {
    fn default() -> Self {
        Self {
            tolerance: None,
            angle: None,
            triangles: None,
            max_levels: USUAL_LEVELS,
            max_triangles: None,
            observer: None,
        }
    }
}

impl<'a> ExactOptions<'a> {
    /// Sets [`Self::tolerance`].
    pub fn tolerance(mut self, length: f64) -> Self {
        self.tolerance = Some(length);
        self
    }

    /// Sets [`Self::angle`].
    pub fn angle(mut self, radians: f64) -> Self {
        self.angle = Some(radians);
        self
    }

    /// Sets [`Self::triangles`].
    pub fn triangles(mut self, count: usize) -> Self {
        self.triangles = Some(count);
        self
    }

    /// Sets [`Self::max_levels`].
    pub fn max_levels(mut self, levels: usize) -> Self {
        self.max_levels = levels;
        self
    }

    /// Sets [`Self::max_triangles`].
    pub fn max_triangles(mut self, cap: Option<usize>) -> Self {
        self.max_triangles = cap;
        self
    }

    /// Sets [`Self::observer`].
    pub fn observer(mut self, observer: ExactObserver<'a>) -> Self {
        self.observer = Some(observer);
        self
    }

    /// Triangles that must not be exceeded.
    pub(super) fn budget(&self) -> usize {
        [self.triangles, self.max_triangles].into_iter().flatten().min().unwrap_or(usize::MAX)
    }

    /// What it means that the budget is used up.
    pub(super) fn budget_stop(&self) -> ExactStop {
        match (self.triangles, self.max_triangles) {
            (Some(goal), cap) if cap.is_none_or(|cap| goal <= cap) => ExactStop::Triangles,
            _ => ExactStop::TriangleCap,
        }
    }

    /// Refuses goals that are no positive numbers, and having none.
    pub(super) fn check(&self) -> Result<(), MeshError> {
        let bad = |name, value, expected| Err(MeshError::BadOption { name, value, expected });
        if let Some(tolerance) = self.tolerance
            && !(tolerance > 0.0 && tolerance.is_finite())
        {
            return bad("tolerance", tolerance, "a length above 0");
        }
        if let Some(angle) = self.angle
            && !(angle > 0.0 && angle <= core::f64::consts::PI)
        {
            return bad("angle", angle, "radians above 0, at most π");
        }
        if self.tolerance.is_none() && self.angle.is_none() && self.triangles.is_none() {
            return bad("number of goals", 0.0, "a tolerance, an angle or a number of triangles");
        }
        Ok(())
    }
}

/// What a round did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ExactProgress {
    /// 1 for the first round.
    pub round: usize,
    /// Triangles that would be emitted now.
    pub triangles: usize,
    /// How many times over the worst place evaluated in this round fails the goals.
    pub worst: f64,
}

/// Called after each round; may cancel.
pub type ExactObserver<'a> = &'a (dyn Fn(&ExactProgress) -> ControlFlow<()> + Sync);

/// Why an exact refinement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExactStop {
    /// Every goal on quality is met.
    Met,
    /// The number of triangles asked for is used up.
    Triangles,
    /// The next split would have passed the cap on triangles.
    TriangleCap,
    /// What still fails has been divided as often as allowed.
    LevelCap,
}

/// An interval that holds the symmetric Hausdorff distance between a mesh and the limit surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ErrorBounds {
    /// A distance that was found.
    pub lower: f64,
    /// A distance that is not exceeded.
    pub upper: f64,
    /// A point of the limit surface at the distance `lower` from the mesh.
    pub at: [f64; 3],
}

/// A point of the control mesh: where a vertex came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// The control face, the first of those that share the point.
    pub face: u32,
    /// Barycentric coordinates there, multiples of a power of 1/2.
    pub barycentric: [f64; 3],
}

/// A mesh within known bounds of a limit surface.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Exact {
    /// The mesh; all vertices lie on the limit surface. Control vertices keep their numbers.
    pub mesh: Mesh,
    /// Unit limit normals of the vertices; zero where the surface has none.
    pub normals: Vec<[f64; 3]>,
    /// Where each vertex came from.
    pub origins: Vec<Origin>,
    /// The control face of each triangle.
    pub parents: Vec<u32>,
    /// How far mesh and limit surface can be from each other.
    pub error: ErrorBounds,
    /// Why the refinement ended.
    pub stop: ExactStop,
    /// Levels of the deepest part of the hierarchy.
    pub levels: usize,
}
