//! Goals and caps of exact refinement.

use super::RefineError;
use super::attribute_goal::AttributeGoal;
use super::exact_result::ExactStop;
use crate::criterion::{Camera, View};
use crate::mesh::{Mesh, MeshError};

/// The goals of exact refinement, and its caps.
///
/// Each given goal on quality (tolerance, angle) is met everywhere; a number of triangles ends the
/// refinement early, with the worst places refined first.
#[derive(Clone)]
#[non_exhaustive]
pub struct ExactOptions {
    /// Greatest distance between mesh and limit surface, either way, as a length. Default: none.
    pub tolerance: Option<f64>,
    /// Greatest angle between a triangle's normal and the limit normals of its corners (the paper's
    /// equation 2), in radians. Control faces are not divided for this goal once triangles are
    /// 1/1024 of them and the angle (in radians) smaller. At cusps and where the surface is not
    /// regular it may not be met then and cannot be;
    /// [`Exact::open_cones`](super::Exact::open_cones) counts these triangles. Default: none.
    pub angle: Option<f64>,
    /// Makes the angle depend on the viewer's position, as in the paper's equation 11, but never
    /// smaller than [`Self::angle`], so that refinement ends at silhouettes and a viewer never
    /// needs more triangles than no viewer: faces that face away have the angle of no viewer, and
    /// with a dilatation above 1 faces towards the viewer have greater angles. Default: none.
    pub view: Option<View>,
    /// Greatest distance between mesh and limit surface as the cameras see it, in pixels: from each
    /// visible point of one to the other. Parts of closed surfaces that face away from a camera are
    /// invisible to it; parts that certainly do are not divided for it. Default: none.
    pub pixels: Option<f64>,
    /// The cameras that the distance in pixels is for; one mesh serves them all. Default: none.
    pub cameras: Vec<Camera>,
    /// The best mesh with at most this many triangles. Up to 20,000 of them the face with the
    /// greatest error is divided next; of more, faces with about equal errors are divided together.
    /// Then a 32nd of the number may stay unused, and more where many faces are alike, as on a
    /// regular sphere: dividing some of those would not reduce the distance. Default: none.
    pub triangles: Option<usize>,
    /// Moves vertices off the limit surface by about half the local error, so that the error lies on both sides and
    /// fewer triangles are needed. Default: no.
    pub balance: bool,
    /// Collapses edges of a finer mesh as long as the goals allow ([`mod@crate::simplify`]): slower, and fewer triangles for
    /// the same distance. For a tolerance, a number of triangles, or both; not with [`Self::balance`]. Default: no.
    pub optimize: bool,
    /// Edges of the control mesh, by their ends, along which edges stay when they are collapsed ([`Self::optimize`]), as they do along
    /// creases and boundaries: seams of textures, borders of materials ([`crate::carry::borders`]). They bound [`Self::flat_regions`], too.
    /// Default: none.
    pub kept_edges: Vec<[u32; 2]>,
    /// Whether to report the origin of each vertex, [`Exact::origins`](super::Exact::origins), a
    /// quarter of the memory of a result. Default: yes.
    pub origins: bool,
    /// Regions of control faces whose limit surface lies in a plane are triangulated from their
    /// rims alone, with no vertices inside but those of the control mesh. Triangles that lie in one
    /// plane side by side though the surface is curved elsewhere, as on a cylinder's side, are
    /// merged, too. None of these triangles crosses one of [`Self::kept_edges`]. If false, all
    /// triangles follow the hierarchy. With [`Self::balance`] this is done only for regions that
    /// [`Self::unfold`] replaces by the inside of their rims. Default: yes.
    pub flat_regions: bool,
    /// Where the scheme's rules fold the surface over in a flat region, as they do where slivers of
    /// a fan meet a hole, the plane inside the region's rim replaces the surface. This is mostly
    /// the intended shape; [`Exact::unfolded`](super::Exact::unfolded) counts these regions. The
    /// scheme's surface is kept where limit curves around it are smooth, or cross so that nothing
    /// can be triangulated, and without this option. Default: no.
    pub unfold: bool,
    /// Whether triangles side by side in one plane are put together; with [`Self::flat_regions`].
    pub(crate) strips: bool,
    /// Whether bounds that are far above the distance found are measured anew.
    pub(crate) tightens: bool,
    /// Goals in addition to the shape ([`AttributeGoal`]): with goals on quality, without a number
    /// of triangles, [`Self::balance`] and [`Self::optimize`]; flat regions then follow the
    /// hierarchy. Default: none.
    pub attributes: Vec<AttributeGoal>,
    /// The most levels below the control faces: up to 30. Default: 24.
    pub max_levels: usize,
    /// The most triangles, as a cap rather than a goal: reaching it is a failure to meet the goals.
    /// Default: 50 million, so that refinement ends at tolerances that cannot be met.
    pub max_triangles: Option<usize>,
    /// The most bytes for the refinement and its result, approximately. Default: no limit.
    pub max_memory: Option<usize>,
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

impl Default for ExactOptions {
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
            kept_edges: Vec::new(),
            origins: true,
            flat_regions: true,
            unfold: false,
            strips: true,
            tightens: true,
            attributes: Vec::new(),
            max_levels: USUAL_LEVELS,
            max_triangles: Some(USUAL_TRIANGLES),
            max_memory: None,
        }
    }
}

impl ExactOptions {
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

    /// Sets [`Self::unfold`].
    pub fn unfold(mut self, unfold: bool) -> Self {
        self.unfold = unfold;
        self
    }

    /// Sets [`Self::flat_regions`].
    pub fn flat_regions(mut self, flat_regions: bool) -> Self {
        self.flat_regions = flat_regions;
        self
    }

    /// Sets [`Self::attributes`].
    pub fn attributes(mut self, goals: Vec<AttributeGoal>) -> Self {
        self.attributes = goals;
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

    /// Whether there is a goal that the shape is to meet everywhere.
    pub(super) fn has_quality_goal(&self) -> bool {
        self.tolerance.is_some() || self.angle.is_some() || self.pixels.is_some()
    }

    /// Whether nothing but distances decides how large triangles are.
    pub(super) fn asks_for_distances_alone(&self) -> bool {
        self.angle.is_none() && self.pixels.is_none() && self.attributes.is_empty()
    }

    /// Triangles for which there is memory, if that is limited.
    pub(super) fn triangles_by_memory(&self) -> Option<usize> {
        self.max_memory.map(|bytes| bytes / BYTES_PER_TRIANGLE)
    }

    /// Triangles that must not be exceeded, and why.
    pub(super) fn budget(&self) -> (usize, ExactStop) {
        let by_memory = self.triangles_by_memory();
        let limits = [
            (self.triangles, ExactStop::Triangles),
            (self.max_triangles, ExactStop::TriangleCap),
            (by_memory, ExactStop::MemoryCap),
        ];
        let given = limits
            .into_iter()
            .filter_map(|(limit, stop)| Some((limit?, stop)));
        given
            .min_by_key(|&(limit, _)| limit)
            .unwrap_or((usize::MAX, ExactStop::TriangleCap))
    }

    /// Refuses goals that are no positive numbers, and having none.
    pub(super) fn check(&self, control: &Mesh) -> Result<(), RefineError> {
        let bad = |name, value, expected| {
            Err(MeshError::BadOption {
                name,
                value,
                expected,
            }
            .into())
        };
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
            return bad(
                "number of cameras",
                0.0,
                "at least one, for a distance in pixels",
            );
        }
        if let Some(view) = self.view {
            view.check()?;
        }
        if self.optimize && (self.angle.is_some() || self.pixels.is_some() || self.balance) {
            let expected = "goals that are a tolerance or a number of triangles, and no balance";
            return bad("optimisation", 1.0, expected);
        }
        self.attributes
            .iter()
            .try_for_each(|goal| goal.check(control.face_count()))?;
        if !self.attributes.is_empty()
            && (self.optimize || self.balance || self.triangles.is_some())
        {
            let expected = "none with a number of triangles, balance or optimisation";
            return bad(
                "number of goals for attributes",
                self.attributes.len() as f64,
                expected,
            );
        }
        if !self.has_quality_goal() && self.triangles.is_none() {
            return bad(
                "number of goals",
                0.0,
                "a tolerance, an angle, pixels or a number of triangles",
            );
        }
        Ok(())
    }
}
