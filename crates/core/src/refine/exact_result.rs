//! Results of exact refinement.

use super::Traced;
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{Mesh, SplitSurface};
use crate::parallel;
use crate::vector::vector;

/// The reason why an exact refinement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExactStop {
    /// Every goal on quality is met.
    Met,
    /// The requested number of triangles is used up.
    Triangles,
    /// The next split would have passed the cap on triangles.
    TriangleCap,
    /// The next split would have taken more memory than allowed.
    MemoryCap,
    /// The triangles that still fail have been divided as often as allowed.
    LevelCap,
    /// The tolerance is within rounding.
    Rounding,
    /// Every goal is met, except for [`Statistics::open_cones`]: triangles outside their cones where no
    /// division brings their normals nearer to the limit normals, such as at cusps and where the
    /// surface is not regular.
    Cones,
}

impl ExactStop {
    /// Its name in reports, and in the packages for Python and JavaScript.
    pub fn name(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::Triangles => "triangles",
            Self::TriangleCap => "triangle-cap",
            Self::MemoryCap => "memory-cap",
            Self::LevelCap => "level-cap",
            Self::Rounding => "rounding",
            Self::Cones => "cones",
        }
    }
}

/// An interval for the symmetric Hausdorff distance between a mesh and the limit surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ErrorBounds {
    /// A distance that some point of one has from the other.
    pub lower: f64,
    /// If [`Self::certified`], no distance is greater; infinite where no goal limits distances and
    /// nothing near [`Self::lower`] could be proven. If not, an estimate from points three levels
    /// below the triangles, which the true distance may exceed by some per cent.
    pub upper: f64,
    /// Whether `upper` is proven, as it is for schemes of a known family ([`crate::scheme::Scheme::family`]).
    pub certified: bool,
    /// The point at which `lower` is attained: one of the mesh, or of the limit surface, within an
    /// eighth of `lower`.
    pub at: [f64; 3],
}

impl ErrorBounds {
    /// Upper bounds up to this many times the distance found are tight enough.
    pub(crate) const TIGHT: f64 = 1.25;

    /// Distances below this part of the control mesh's diagonal count as that.
    pub(crate) const LEAST: f64 = 1e-6;
}

/// A point of the control mesh: the origin of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// The control face, the first of those that share the point.
    pub face: u32,
    /// Barycentric coordinates there, multiples of a power of 1/2.
    pub barycentric: [f64; 3],
}

impl Origin {
    /// The point in another face of the control mesh, whose triangles these are; `None` where that
    /// face does not contain it. A point of two faces is on a vertex or an edge of both, so its
    /// coordinates follow the vertices' indices.
    pub fn in_face(&self, triangles: &[[u32; 3]], face: u32) -> Option<Self> {
        if self.face == face {
            return Some(*self);
        }
        let (from, to) = (
            triangles.get(self.face as usize)?,
            triangles.get(face as usize)?,
        );
        let mut barycentric = [0.0; 3];
        for (vertex, &weight) in from
            .iter()
            .zip(&self.barycentric)
            .filter(|&(_, &weight)| weight != 0.0)
        {
            barycentric[to.iter().position(|other| other == vertex)?] = weight;
        }
        Some(Self { face, barycentric })
    }
}

/// A mesh within known bounds of a limit surface.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Exact {
    /// The mesh; all vertices lie on the limit surface, except with
    /// [`Finish::Balanced`](super::Finish::Balanced). Control vertices keep their numbers.
    pub mesh: Mesh,
    /// Unit limit normals of the vertices; zero where the surface has none, an average of the sides
    /// at sharp edges.
    pub normals: Vec<[f64; 3]>,
    /// The limit normals of triangles' corners at sharp edges, each of its own side, by the
    /// half-edge that leaves the corner, ascending; see [`Self::corner_normal`]. Empty without
    /// sharp edges.
    pub sides: Vec<(u32, [f64; 3])>,
    /// The origin of each vertex; empty unless
    /// [`ExactOptions::origins`](super::ExactOptions::origins) is set.
    pub origins: Vec<Origin>,
    /// The control face of each triangle; after collapses, when triangles cover parts of several,
    /// one of these.
    pub parents: Vec<u32>,
    /// Where edges were collapsed, the origins of triangles' corners on sharp and
    /// [kept](super::ExactOptions::kept_edges) edges, each on its own side, by the half-edge that
    /// leaves the corner, ascending; see [`Traced::corner_origin`].
    pub side_origins: Option<Vec<(u32, Origin)>>,
    /// The distance between mesh and limit surface.
    pub error: ErrorBounds,
    /// The greatest distance between mesh and limit surface as the cameras see it, in pixels: each
    /// point of one that is in a picture, and on closed surfaces faces the camera, has a point of
    /// the other within this. `None` without cameras; infinite where it is not bounded.
    pub pixels: Option<f64>,
    /// By goal of [`Goals::attributes`](super::Goals::attributes), the greatest distance of values
    /// or surfaces from those of the triangles: proven where [`ErrorBounds::certified`] says so of
    /// the distance.
    pub attribute_bounds: Vec<f64>,
    /// The reason why the refinement ended.
    pub stop: ExactStop,
    /// What else is known of the result.
    pub statistics: Statistics,
    /// Flat regions, by their first control faces, whose surface is taken to be the plane inside
    /// their rims, whether the rules fold it or not; ascending.
    pub(crate) within_rims: Vec<u32>,
}

/// What is known of an exact refinement besides its mesh and its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Levels of the deepest part of the hierarchy.
    pub levels: usize,
    /// The greatest ratio of a triangle's error to the goals on quality: at most 1 where all are
    /// met; 0 without any.
    pub worst: f64,
    /// Triangles whose normals leave the cone of [`Goals::angle`](super::Goals::angle); 0 without
    /// that goal, or where it is met.
    pub open_cones: usize,
    /// The greatest distance of the limit surface, and of its triangles, from the planes of the
    /// regions that were triangulated from their rims
    /// ([`ExactOptions::flat_regions`](super::ExactOptions::flat_regions)); 0 where there are none.
    pub off_planes: f64,
    /// Flat regions that the scheme's rules fold over, inside or beyond their rims, as they do
    /// where a fan of slivers meets a hole: the plane inside the rim replaces them, and
    /// [`Exact::error`] is the distance from this surface.
    pub unfolded: usize,
    /// After collapses, the number of vertices that stayed only because a proof failed there:
    /// around them the fine triangles were not collapsed any further.
    pub refused: usize,
}

impl Exact {
    /// Whether edges were collapsed ([`Finish::Collapsed`](super::Finish::Collapsed)): triangles
    /// then cover parts of several control faces.
    pub fn is_collapsed(&self) -> bool {
        self.side_origins.is_some()
    }

    /// The unit limit normal at the corner that a half-edge leaves, on the side of its triangle.
    pub fn corner_normal(&self, corner: HalfEdgeId) -> [f64; 3] {
        match self.sides.binary_search_by_key(&corner.0, |&(h, _)| h) {
            Ok(place) => self.sides[place].1,
            Err(_) => self.normals[self.mesh.topology().origin(corner).index()],
        }
    }

    /// The mesh with a vertex for each side of sharp edges, each with its limit normal.
    pub fn split_surface(&self) -> SplitSurface {
        SplitSurface::new(&self.mesh, |corner| self.corner_normal(corner))
    }

    /// The number of triangles that are turned over: their normal is more than 90° from the limit
    /// normal at one of their corners, on their own side of sharp edges. There the surface folds,
    /// or is not regular.
    pub fn inverted_triangles(&self) -> usize {
        self.turned_over().len()
    }

    /// The triangles that are turned over, ascending.
    pub(crate) fn turned_over(&self) -> Vec<u32> {
        let is_inverted = |face: usize| {
            let normal = self.mesh.scaled_face_normal(face);
            (0..3).any(|corner| {
                let h = HalfEdgeId::of(FaceId(face as u32), corner);
                normal.dot(vector(self.corner_normal(h))) < 0.0
            })
        };
        let pieces = parallel::pieces(self.mesh.face_count(), |faces| {
            faces
                .filter(|&f| is_inverted(f))
                .map(|f| f as u32)
                .collect::<Vec<_>>()
        });
        pieces.concat()
    }
}

/// Corners are known in their own control faces, and after collapses in one on the same side of sharp and kept edges; not where a
/// [flat region](super::ExactOptions::flat_regions) was triangulated from its rim.
impl Traced for Exact {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn origins(&self) -> &[Origin] {
        &self.origins
    }

    fn parents(&self) -> &[u32] {
        &self.parents
    }

    fn corner_origin(&self, control: &[[u32; 3]], corner: HalfEdgeId) -> Option<Origin> {
        let origin = self
            .origins
            .get(self.mesh.topology().origin(corner).index())?;
        let Some(corners) = &self.side_origins else {
            return origin.in_face(control, *self.parents.get(corner.face().index())?);
        };
        match corners.binary_search_by_key(&corner.0, |&(h, _)| h) {
            Ok(place) => Some(corners[place].1),
            Err(_) => Some(*origin),
        }
    }
}

/// The expected result of an exact refinement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The number of triangles: counted where there are few, extrapolated where there are many,
    /// from a sample of faces of large meshes.
    pub triangles: usize,
    /// The most bytes that the refinement and its result need, approximately.
    pub memory_bytes: usize,
    /// Whether all triangles were counted.
    pub is_counted: bool,
}
