//! Goals, caps and results of exact refinement.

use core::ops::ControlFlow;

use crate::criterion::{Camera, View};
use crate::index::HalfEdgeId;
use crate::mesh::{Mesh, MeshError};
use crate::refine::RefineError;

/// What exact refinement is to reach, and what it must not exceed.
///
/// Of the goals on quality (tolerance, angle) each that is given is to be met everywhere; a number of triangles ends
/// the refinement early, with the worst places refined first.
#[derive(Clone)]
#[non_exhaustive]
pub struct ExactOptions<'a> {
    /// Greatest distance between mesh and limit surface, either way, as a length. Default: none.
    pub tolerance: Option<f64>,
    /// Greatest angle between a triangle's normal and the limit normals of its corners (the paper's equation 2), in
    /// radians. Control faces are not divided for its sake once triangles are 1/1024 of them and the angle (in radians)
    /// smaller: where it is not met by then, at cusps and where the surface is not regular, it cannot be, and
    /// [`Exact::open_cones`] says so. Default: none.
    pub angle: Option<f64>,
    /// Makes the angle depend on where the viewer stands, as in the paper's equation 11, but never smaller than
    /// [`Self::angle`], so that silhouettes come to an end and a viewer asks for no more than none: what looks away is not
    /// divided, and with a dilatation above 1 what looks at the viewer has greater angles. Default: none.
    pub view: Option<View>,
    /// Greatest distance between mesh and limit surface as the cameras see it, in pixels: of each point of one that is in a
    /// picture from the other. Of closed surfaces what looks away from a camera is not seen. Default: none.
    pub pixels: Option<f64>,
    /// The cameras that the distance in pixels is for; one mesh serves them all. Default: none.
    pub cameras: Vec<Camera>,
    /// The best mesh with at most so many triangles. Default: none.
    pub triangles: Option<usize>,
    /// Moves vertices off the limit surface by about half the local error, so that the error lies on both sides and
    /// fewer triangles are needed. Default: no.
    pub balance: bool,
    /// Collapses edges of a finer mesh as long as the goals allow ([`mod@crate::simplify`]): slower, and fewer triangles for
    /// the same distance. For a tolerance, a number of triangles, or both; not with [`Self::balance`]. Default: no.
    pub optimize: bool,
    /// Levels at most below the control faces: up to 30. Default: 24.
    pub max_levels: usize,
    /// Triangles at most, as a cap rather than a goal: reaching it is a failure to meet the others. Default: 50
    /// million, so that tolerances that nothing meets come to an end.
    pub max_triangles: Option<usize>,
    /// Bytes that the refinement and its result may take, about. Default: no limit.
    pub max_memory: Option<usize>,
    /// Called after each round; may cancel. Default: none.
    pub observer: Option<ExactObserver<'a>>,
}

/// Levels that are tried where none are given: edges are divided by more than ten million then.
const USUAL_LEVELS: usize = 24;

/// Levels at most: places along the edge of a control face are told apart by 32 bits.
pub(in crate::refine) const MOST_LEVELS: usize = 30;

/// Triangles at most where no cap is given.
const USUAL_TRIANGLES: usize = 50_000_000;

/// Memory for a triangle and what belongs to it while the mesh grows, the result included: measured, with a margin.
pub(super) const BYTES_PER_TRIANGLE: usize = 320;

impl Default for ExactOptions<'_> {
    fn default() -> Self {
        Self {
            tolerance: None,
            angle: None,
            view: None,
            pixels: None,
            cameras: Vec::new(),
            triangles: None,
            balance: false,
            optimize: false,
            max_levels: USUAL_LEVELS,
            max_triangles: Some(USUAL_TRIANGLES),
            max_memory: None,
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

    /// Sets [`Self::view`].
    pub fn view(mut self, view: View) -> Self {
        self.view = Some(view);
        self
    }

    /// Sets [`Self::pixels`] and [`Self::cameras`].
    pub fn pixels(mut self, pixels: f64, cameras: Vec<Camera>) -> Self {
        (self.pixels, self.cameras) = (Some(pixels), cameras);
        self
    }

    /// Sets [`Self::triangles`].
    pub fn triangles(mut self, count: usize) -> Self {
        self.triangles = Some(count);
        self
    }

    /// Sets [`Self::balance`].
    pub fn balance(mut self, balance: bool) -> Self {
        self.balance = balance;
        self
    }

    /// Sets [`Self::optimize`].
    pub fn optimize(mut self, optimize: bool) -> Self {
        self.optimize = optimize;
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

    /// Sets [`Self::max_memory`].
    pub fn max_memory(mut self, bytes: Option<usize>) -> Self {
        self.max_memory = bytes;
        self
    }

    /// Sets [`Self::observer`].
    pub fn observer(mut self, observer: ExactObserver<'a>) -> Self {
        self.observer = Some(observer);
        self
    }

    /// Whether nothing but distances and numbers of triangles count, with vertices on the limit surface.
    pub(in crate::refine) fn is_of_distance(&self) -> bool {
        self.angle.is_none() && self.pixels.is_none() && !self.balance
    }

    /// Triangles that must not be exceeded, and why.
    pub(in crate::refine) fn budget(&self) -> (usize, ExactStop) {
        let by_memory = self.max_memory.map(|bytes| bytes / BYTES_PER_TRIANGLE);
        let limits = [
            (self.triangles, ExactStop::Triangles),
            (self.max_triangles, ExactStop::TriangleCap),
            (by_memory, ExactStop::MemoryCap),
        ];
        let given = limits.into_iter().filter_map(|(limit, stop)| Some((limit?, stop)));
        given.min_by_key(|&(limit, _)| limit).unwrap_or((usize::MAX, ExactStop::TriangleCap))
    }

    /// Levels by which all of a control mesh can be divided where only the number of triangles counts.
    pub(super) fn uniform_levels(&self, control_faces: usize) -> usize {
        if self.tolerance.is_some() || self.angle.is_some() || self.pixels.is_some() {
            return 0;
        }
        let fits = |&levels: &usize| control_faces.saturating_mul(1 << (2 * levels)) <= self.budget().0;
        (1..=self.max_levels.min(20)).take_while(fits).last().unwrap_or(0)
    }

    /// Refuses goals that are no positive numbers, and having none.
    pub(super) fn check(&self) -> Result<(), RefineError> {
        let bad = |name, value, expected| Err(MeshError::BadOption { name, value, expected }.into());
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
        if let Some(pixels) = self.pixels
            && !(pixels > 0.0 && pixels.is_finite())
        {
            return bad("distance in pixels", pixels, "a number above 0");
        }
        if self.max_levels > MOST_LEVELS {
            return bad("number of levels", self.max_levels as f64, "at most 30");
        }
        if self.pixels.is_some() && self.cameras.is_empty() {
            return bad("number of cameras", 0.0, "at least one, for a distance in pixels");
        }
        if let Some(view) = self.view {
            view.check()?;
        }
        if self.optimize && (self.angle.is_some() || self.pixels.is_some() || self.balance) {
            let expected = "goals that are a tolerance or a number of triangles, and no balance";
            return bad("optimisation", 1.0, expected);
        }
        let quality = self.tolerance.is_some() || self.angle.is_some() || self.pixels.is_some();
        if !quality && self.triangles.is_none() {
            return bad("number of goals", 0.0, "a tolerance, an angle, pixels or a number of triangles");
        }
        Ok(())
    }
}

/// What a round did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ExactProgress {
    /// 1 for the first round; 0 while edges are collapsed, which goes without rounds.
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
    /// The next split would have taken more memory than allowed.
    MemoryCap,
    /// What still fails has been divided as often as allowed.
    LevelCap,
    /// The tolerance is below what rounding leaves certain.
    Rounding,
    /// Every goal is met, but for [`Exact::open_cones`]: triangles outside their cones where no division brings their
    /// normals nearer to the limit normals, such as at cusps and where the surface is not regular.
    Cones,
}

/// An interval for the symmetric Hausdorff distance between a mesh and the limit surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ErrorBounds {
    /// A distance that was found.
    pub lower: f64,
    /// A distance that is not exceeded where [`Self::certified`] holds. Otherwise an estimate, the greatest distance of
    /// the surface's points three levels below the triangles, which the true one may exceed by some per cent.
    pub upper: f64,
    /// Whether `upper` is proven: so it is for the Loop family ([`crate::scheme::LoopFamily`]), whose masks are convex
    /// combinations.
    pub certified: bool,
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
    /// Unit limit normals of the vertices; zero where the surface has none, an average of the sides at sharp edges.
    pub normals: Vec<[f64; 3]>,
    /// The limit normals of triangles' corners at sharp edges, each of its own side, by the half-edge that leaves the corner,
    /// ascending; see [`Self::corner_normal`]. Empty without sharp edges, and after optimisation.
    pub sides: Vec<(u32, [f64; 3])>,
    /// Where each vertex came from.
    pub origins: Vec<Origin>,
    /// The control face of each triangle; empty after optimisation, whose triangles reach over several.
    pub parents: Vec<u32>,
    /// How far mesh and limit surface can be from each other.
    pub error: ErrorBounds,
    /// The greatest distance between mesh and limit surface as the cameras see it, in pixels at most: each point of one
    /// that is in a picture has a point of the other that near. `None` without cameras; infinite where it is not bounded.
    pub pixels: Option<f64>,
    /// Triangles whose normals leave the cone of [`ExactOptions::angle`]; 0 without that goal, or where it is met.
    pub open_cones: usize,
    /// How many times over the worst triangle fails the goals on quality: at most 1 where all are met; 0 without any.
    pub worst: f64,
    /// Why the refinement ended.
    pub stop: ExactStop,
    /// Levels of the deepest part of the hierarchy.
    pub levels: usize,
    /// After optimisation, how many vertices stayed only because the proof failed where they are: around them the fine
    /// triangles were not collapsed any further.
    pub refused: usize,
}

impl Exact {
    /// The unit limit normal at the corner that a half-edge leaves, on the side of its triangle.
    pub fn corner_normal(&self, corner: HalfEdgeId) -> [f64; 3] {
        match self.sides.binary_search_by_key(&corner.0, |&(h, _)| h) {
            Ok(place) => self.sides[place].1,
            Err(_) => self.normals[self.mesh.topology().origin(corner).index()],
        }
    }
}

/// What an exact refinement would give.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Triangles, exactly where there are few, extrapolated where there are many.
    pub triangles: usize,
    /// Bytes that the refinement and its result would take at most, about.
    pub memory_bytes: usize,
    /// Whether the triangles were counted rather than extrapolated.
    pub is_counted: bool,
}
