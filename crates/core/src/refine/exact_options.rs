//! Goals and caps of exact refinement.

use super::RefineError;
use super::attribute_goal::AttributeGoal;
use super::exact_result::ExactStop;
use crate::criterion::{Camera, View};
use crate::mesh::{Mesh, MeshError};

/// Goals, finish and caps of exact refinement.
///
/// The setters cover what most callers need:
///
/// ```
/// use limitmesh::refine::{ExactOptions, Finish};
///
/// let options = ExactOptions::default().tolerance(0.1).finish(Finish::Balanced);
/// assert_eq!(options.goals.tolerance, Some(0.1));
/// ```
#[derive(Clone)]
#[non_exhaustive]
pub struct ExactOptions {
    /// How good the mesh is to be. Default: no goal, which is refused.
    pub goals: Goals,
    /// What is done to reach the goals with fewer triangles. Default: nothing.
    pub finish: Finish,
    /// Where refinement ends though the goals are not met.
    pub caps: Caps,
    /// Edges of the control mesh, by their ends, along which edges stay when they are collapsed
    /// ([`Finish::Collapsed`]), as they do along creases and boundaries: seams of textures, borders
    /// of materials ([`crate::carry::borders`]). They bound [`Self::flat_regions`], too.
    /// Default: none.
    pub kept_edges: Vec<[u32; 2]>,
    /// Whether to report the origin of each vertex, [`Exact::origins`](super::Exact::origins), a
    /// quarter of the memory of a result. Default: yes.
    pub origins: bool,
    /// Regions of control faces whose limit surface lies in a plane are triangulated from their
    /// rims alone, with no vertices inside but those of the control mesh. Adjacent triangles that
    /// lie in one plane though the surface is curved elsewhere, as on a cylinder's side, are
    /// merged, too. None of these triangles crosses one of [`Self::kept_edges`]. If false, all
    /// triangles follow the hierarchy. With [`Finish::Balanced`] this is done only for regions that
    /// [`Self::unfold`] replaces by the inside of their rims. Default: yes.
    pub flat_regions: bool,
    /// Where the scheme's rules fold the surface over in a flat region, as they do where slivers of
    /// a fan meet a hole, the plane inside the region's rim replaces the surface. This is mostly
    /// the intended shape; [`Statistics::unfolded`](super::Statistics::unfolded) counts these
    /// regions. The scheme's surface is kept where limit curves around it are smooth, or cross so
    /// that nothing can be triangulated, and without this option. Default: no.
    pub unfold: bool,
    /// Whether faces are divided as a whole, rather than edge by edge, so that most triangles of a mesh of quads pair up
    /// ([`quads`](super::quads)): it takes about half more of them. Default: no.
    pub for_quads: bool,
    /// Whether adjacent triangles in one plane are merged; with [`Self::flat_regions`].
    pub(crate) strips: bool,
    /// Whether bounds that are far above the distance found are measured anew.
    pub(crate) tightens: bool,
}

/// How good a mesh is to be.
///
/// Each goal but the number of triangles is met everywhere. That number ends the refinement early, with the worst places refined first.
#[derive(Clone, Debug, Default)]
pub struct Goals {
    /// Greatest distance between mesh and limit surface, either way, as a length.
    pub tolerance: Option<f64>,
    /// Greatest angle between triangles and limit normals.
    pub angle: Option<AngleGoal>,
    /// Greatest distance between mesh and limit surface in pictures.
    pub pixels: Option<PixelGoal>,
    /// The best mesh with at most this many triangles. Up to 20,000 of them the face with the
    /// greatest error is divided next; of more, faces with about equal errors are divided together.
    /// Then a 32nd of the number may stay unused, and more where many faces are alike, as on a
    /// regular sphere: dividing some of those would not reduce the distance.
    pub triangles: Option<usize>,
    /// Goals for what the mesh carries: only together with a tolerance, an angle or pixels, without
    /// a number of triangles and with [`Finish::OnSurface`]; flat regions then follow the hierarchy.
    pub attributes: Vec<AttributeGoal>,
}

/// The greatest angle between a triangle's normal and the limit normals of its corners (the paper's
/// equation 2).
///
/// Control faces are not divided for this goal once triangles are 1/1024 of them and the angle (in
/// radians) smaller. At cusps and where the surface is not regular it may not be met then and
/// cannot be; [`Statistics::open_cones`](super::Statistics::open_cones) counts these triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleGoal {
    /// The angle: above 0, at most π.
    pub radians: f64,
    /// Makes the angle depend on the viewer's position, as in the paper's equation 11, but never
    /// smaller than [`Self::radians`], so that refinement ends at silhouettes and a viewer never
    /// needs more triangles than no viewer: faces that face away have the angle of no viewer, and
    /// with a dilatation above 1 faces towards the viewer have greater angles.
    pub view: Option<View>,
}

/// The greatest distance between mesh and limit surface as cameras see it, from each visible point
/// of one to the other.
///
/// Parts of closed surfaces that face away from a camera are invisible to it; parts that certainly
/// do are not divided for it.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelGoal {
    /// The distance, in pixels: above 0.
    pub pixels: f64,
    /// The cameras, at least one; one mesh serves them all.
    pub cameras: Vec<Camera>,
}

/// What is done to reach the goals with fewer triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Finish {
    /// All vertices lie on the limit surface.
    #[default]
    OnSurface,
    /// Vertices are moved off the limit surface by about half of the local error, so that the
    /// error lies on both sides.
    Balanced,
    /// Edges of a finer mesh are collapsed as long as the goals allow ([`mod@crate::simplify`]):
    /// slower, and fewer triangles for the same distance. For a tolerance, a number of triangles,
    /// or both.
    Collapsed,
}

/// Where refinement ends though the goals are not met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Caps {
    /// The most triangles. Default: 50 million, so that refinement ends at tolerances that cannot
    /// be met.
    pub triangles: Option<usize>,
    /// The most levels below the control faces: up to 30. Default: 24.
    pub levels: usize,
    /// The most bytes for the refinement and its result, approximately. Default: no limit.
    pub memory: Option<usize>,
}

/// Levels that are tried where none are given: edges are divided by more than ten million then.
const USUAL_LEVELS: usize = 24;

/// The most levels: places along the edge of a control face are distinguished by 32 bits.
pub(super) const MOST_LEVELS: usize = 30;

/// Triangles at most where no cap is given.
const USUAL_TRIANGLES: usize = 50_000_000;

/// Memory for a triangle and its data while the mesh grows, the result included: measured, with a
/// margin.
pub(super) const BYTES_PER_TRIANGLE: usize = 320;

impl Default for Caps {
    fn default() -> Self {
        Self {
            triangles: Some(USUAL_TRIANGLES),
            levels: USUAL_LEVELS,
            memory: None,
        }
    }
}

impl Default for ExactOptions {
    fn default() -> Self {
        Self {
            goals: Goals::default(),
            finish: Finish::OnSurface,
            caps: Caps::default(),
            kept_edges: Vec::new(),
            origins: true,
            flat_regions: true,
            unfold: false,
            for_quads: false,
            strips: true,
            tightens: true,
        }
    }
}

impl ExactOptions {
    /// Sets [`Goals::tolerance`].
    pub fn tolerance(mut self, length: f64) -> Self {
        self.goals.tolerance = Some(length);
        self
    }

    /// Sets [`Goals::angle`], without a view.
    pub fn angle(mut self, radians: f64) -> Self {
        self.goals.angle = Some(AngleGoal {
            radians,
            view: None,
        });
        self
    }

    /// Sets [`Goals::angle`] for a viewer.
    pub fn angle_seen(mut self, radians: f64, view: View) -> Self {
        let view = Some(view);
        self.goals.angle = Some(AngleGoal { radians, view });
        self
    }

    /// Sets [`Goals::pixels`].
    pub fn pixels(mut self, pixels: f64, cameras: Vec<Camera>) -> Self {
        self.goals.pixels = Some(PixelGoal { pixels, cameras });
        self
    }

    /// Sets [`Goals::triangles`].
    pub fn triangles(mut self, count: usize) -> Self {
        self.goals.triangles = Some(count);
        self
    }

    /// Sets [`Goals::attributes`].
    pub fn attributes(mut self, goals: Vec<AttributeGoal>) -> Self {
        self.goals.attributes = goals;
        self
    }

    /// Sets [`Self::finish`].
    pub fn finish(mut self, finish: Finish) -> Self {
        self.finish = finish;
        self
    }

    /// Sets [`Caps::triangles`].
    pub fn max_triangles(mut self, cap: Option<usize>) -> Self {
        self.caps.triangles = cap;
        self
    }

    /// Sets [`Caps::levels`].
    pub fn max_levels(mut self, levels: usize) -> Self {
        self.caps.levels = levels;
        self
    }

    /// Sets [`Caps::memory`].
    pub fn max_memory(mut self, bytes: Option<usize>) -> Self {
        self.caps.memory = bytes;
        self
    }

    /// Sets [`Self::kept_edges`].
    pub fn kept_edges(mut self, edges: Vec<[u32; 2]>) -> Self {
        self.kept_edges = edges;
        self
    }

    /// Sets [`Self::origins`].
    pub fn origins(mut self, origins: bool) -> Self {
        self.origins = origins;
        self
    }

    /// Sets [`Self::flat_regions`].
    pub fn flat_regions(mut self, flat_regions: bool) -> Self {
        self.flat_regions = flat_regions;
        self
    }

    /// Sets [`Self::unfold`].
    pub fn unfold(mut self, unfold: bool) -> Self {
        self.unfold = unfold;
        self
    }

    /// Sets [`Self::for_quads`].
    pub fn for_quads(mut self, for_quads: bool) -> Self {
        self.for_quads = for_quads;
        self
    }

    /// Whether vertices are moved off the limit surface.
    pub(super) fn is_balanced(&self) -> bool {
        self.finish == Finish::Balanced
    }

    /// Whether edges are collapsed.
    pub(super) fn is_collapsed(&self) -> bool {
        self.finish == Finish::Collapsed
    }

    /// Triangles for which there is memory, if that is limited.
    pub(super) fn triangles_by_memory(&self) -> Option<usize> {
        self.caps.memory.map(|bytes| bytes / BYTES_PER_TRIANGLE)
    }

    /// Triangles that must not be exceeded, and why.
    pub(super) fn budget(&self) -> (usize, ExactStop) {
        let limits = [
            (self.goals.triangles, ExactStop::Triangles),
            (self.caps.triangles, ExactStop::TriangleCap),
            (self.triangles_by_memory(), ExactStop::MemoryCap),
        ];
        let given = limits
            .into_iter()
            .filter_map(|(limit, stop)| Some((limit?, stop)));
        given
            .min_by_key(|&(limit, _)| limit)
            .unwrap_or((usize::MAX, ExactStop::TriangleCap))
    }

    /// Refuses goals that are no positive numbers, having none, and those that the finish cannot
    /// reach.
    pub(super) fn check(&self, control: &Mesh) -> Result<(), RefineError> {
        let goals = &self.goals;
        goals.check(control)?;
        if self.caps.levels > MOST_LEVELS {
            return bad("number of levels", self.caps.levels as f64, "at most 30");
        }
        if self.is_collapsed() && (goals.angle.is_some() || goals.pixels.is_some()) {
            let expected = "0: edges are collapsed for a tolerance or a number of triangles alone";
            return bad("number of angle and pixel goals", 1.0, expected);
        }
        let is_free = self.finish == Finish::OnSurface && goals.triangles.is_none();
        if !goals.attributes.is_empty() && !is_free {
            let expected = "0 with a number of triangles, balanced or collapsed";
            let count = goals.attributes.len() as f64;
            return bad("number of goals for attributes", count, expected);
        }
        Ok(())
    }
}

impl Goals {
    /// Whether there is a goal that the shape is to meet everywhere.
    pub(super) fn has_quality(&self) -> bool {
        self.tolerance.is_some() || self.angle.is_some() || self.pixels.is_some()
    }

    /// Whether nothing but distances decides how large triangles are.
    pub(super) fn are_distances(&self) -> bool {
        self.angle.is_none() && self.pixels.is_none() && self.attributes.is_empty()
    }

    /// Refuses goals that are no positive numbers, and having none.
    fn check(&self, control: &Mesh) -> Result<(), RefineError> {
        if let Some(tolerance) = self.tolerance
            && !(tolerance > 0.0 && tolerance.is_finite())
        {
            return bad("tolerance", tolerance, "a length above 0");
        }
        if let Some(AngleGoal { radians, view }) = self.angle {
            if !(radians > 0.0 && radians <= core::f64::consts::PI) {
                return bad("angle", radians, "radians above 0, at most π");
            }
            view.map_or(Ok(()), |view| view.check())?;
        }
        if let Some(PixelGoal { pixels, cameras }) = &self.pixels {
            if !(*pixels > 0.0 && pixels.is_finite()) {
                return bad("distance in pixels", *pixels, "a number above 0");
            }
            if cameras.is_empty() {
                let expected = "at least one, for a distance in pixels";
                return bad("number of cameras", 0.0, expected);
            }
        }
        for goal in &self.attributes {
            goal.check(control.face_count())?;
        }
        if !self.has_quality() && self.triangles.is_none() {
            let expected = "at least 1: a tolerance, an angle, pixels or a number of triangles";
            return bad("number of goals", 0.0, expected);
        }
        Ok(())
    }
}

/// The error for an option that is out of range.
fn bad(name: &'static str, value: f64, expected: &'static str) -> Result<(), RefineError> {
    Err(MeshError::BadOption {
        name,
        value,
        expected,
    }
    .into())
}
