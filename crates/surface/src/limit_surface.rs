//! The limit surface as an object: points, normals, derivatives, curvature and weights of control points at any place of its control
//! faces, area and volume.
//!
//! A piece is refined towards the place until its part there is a polynomial (Stam, "Evaluation of
//! Loop Subdivision Surfaces", 1998: around an irregular vertex the regular parts shrink by half
//! with each level), which is evaluated; corners use the scheme's limit stencils. Places that share
//! a piece share its refinement.

mod barycentric;
mod derivatives;
mod looks;
mod places;
mod size;
mod weights;

pub use barycentric::{BarycentricError, barycentric};
pub use derivatives::{Curvature, Derivatives};

use std::borrow::Cow;

use crate::index::{FaceId, HalfEdgeId};
use crate::limit::{LimitError, SidedNormals};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::extraordinary::{ExtraordinaryPatch, RefinedExtraordinary};
use crate::patch::large_rings::LargeRings;
use crate::patch::{
    self, Limit, LimitPoint, Patch, Quartic, RefinedPatch, Rules, child_corners, root_patch,
};
use crate::scheme::Scheme;
use crate::vector::{DVec3, vector};
use places::{Answers, Coordinates, Place, Points, parted, take_corners, take_nearest};

/// Levels after which a place counts as the nearest corner of its part, which is 2⁻⁴⁰ as large as the face.
const DEEPEST: u32 = 40;

/// Faces that are evaluated together.
const BLOCK: usize = 64;

/// A point of a limit surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfacePoint {
    /// The position, in the control mesh's units.
    pub position: [f64; 3],
    /// The unit normal, on the side of the given face; zero where there is none.
    pub normal: [f64; 3],
}

/// The limit surface of a control mesh.
///
/// ```
/// use limitmesh_surface::{FaceId, LimitSurface, Mesh, scheme::Loop};
///
/// let mesh = Mesh::from_triangles(
///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
/// )?;
/// let surface = LimitSurface::new(&mesh, &Loop)?;
/// let middle = surface.at(FaceId(0), [1.0 / 3.0; 3]);
/// // The face looks along (1, 1, −1), and so does the surface over its middle.
/// assert!((middle.normal[0] - 3f64.sqrt().recip()).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct LimitSurface<'a> {
    mesh: &'a Mesh,
    sharpness: Sharpness<'a>,
    large: LargeRings,
    rules: Rules<'a>,
    positions: Vec<[f64; 3]>,
    /// `None` if no normals are requested: they are zero then.
    normals: Option<SidedNormals>,
}

impl<'a> LimitSurface<'a> {
    /// Prepares the evaluation.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn new(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Result<Self, LimitError> {
        let mut surface = Self::without_normals(mesh, scheme)?;
        surface.normals = Some(surface.rules.table().sided_normals(mesh)?);
        Ok(surface)
    }

    /// [`Self::new`] for positions alone; normals are zero.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn without_normals(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Result<Self, LimitError> {
        Self::by_rules(mesh, Rules::of(scheme))
    }

    /// [`Self::without_normals`] by rules that may share stencils with those of other surfaces.
    fn by_rules(mesh: &'a Mesh, rules: Rules<'a>) -> Result<Self, LimitError> {
        let positions = rules.table().positions(mesh)?;
        let sharpness = Sharpness::of(mesh);
        let large = LargeRings::with_tags(mesh, &sharpness, &rules);
        Ok(Self {
            mesh,
            sharpness,
            large,
            rules,
            positions,
            normals: None,
        })
    }

    /// The point over a place of a control face, given by barycentric coordinates; the second and
    /// third are used, clamped so that none is below 0 and their sum not above 1; [`barycentric`]
    /// computes them from weights written with few digits. The points of a face that does not exist
    /// are zero.
    pub fn at(&self, face: FaceId, barycentric: [f64; 3]) -> SurfacePoint {
        self.over(face, &[barycentric]).pop().unwrap_or(NOWHERE)
    }

    /// The points over several places of a face, each as by [`Self::at`].
    pub fn over(&self, face: FaceId, places: &[[f64; 3]]) -> Vec<SurfacePoint> {
        let mut points = vec![NOWHERE; places.len()];
        if face.index() < self.mesh.face_count() {
            let mut places = places
                .iter()
                .enumerate()
                .map(|(at, &weights)| Place::of(at, weights))
                .collect();
            let with_normals = self.normals.is_some();
            let mut found = Points {
                with_normals,
                points: &mut points,
            };
            self.find(face, &mut places, &mut Vec::new(), &mut found);
        }
        points
    }

    /// The points over places of many faces, in order, on all threads. Consecutive places of one
    /// face share its work.
    pub fn at_all(&self, places: &[(FaceId, [f64; 3])]) -> Vec<SurfacePoint> {
        let of_faces: Vec<&[(FaceId, [f64; 3])]> = places.chunk_by(|a, b| a.0 == b.0).collect();
        let blocks = parallel::pieces_of(of_faces.len(), BLOCK, |block| {
            let over = |own: &[(FaceId, [f64; 3])]| {
                let at: Vec<[f64; 3]> = own.iter().map(|&(_, at)| at).collect();
                self.over(own[0].0, &at)
            };
            block
                .flat_map(|face| over(of_faces[face]))
                .collect::<Vec<_>>()
        });
        blocks.concat()
    }

    /// The first coordinates of points over places of faces, face by face, in blocks; `places`
    /// calls its argument with each place of a face.
    #[doc(hidden)]
    pub fn coordinates<const AXES: usize>(
        &self,
        places: impl Fn(usize, &mut dyn FnMut([f64; 3])) + Sync + Send,
    ) -> Vec<Vec<[f64; AXES]>> {
        parallel::pieces_of(self.mesh.face_count(), BLOCK, |block| {
            let (mut coordinates, mut own, mut spare) = (Vec::new(), Vec::new(), Vec::new());
            for face in block {
                own.clear();
                places(face, &mut |place| own.push(Place::of(own.len(), place)));
                let first = coordinates.len();
                coordinates.resize(first + own.len(), [0.0; AXES]);
                let mut found = Coordinates(&mut coordinates[first..]);
                self.find(FaceId(face as u32), &mut own, &mut spare, &mut found);
            }
            coordinates
        })
    }

    /// Answers for places over a face that there is. `spare` is scratch space.
    fn find<A: Answers>(
        &self,
        face: FaceId,
        places: &mut Vec<Place>,
        spare: &mut Vec<Place>,
        found: &mut A,
    ) {
        let corners = self
            .corner_points(face)
            .map(|point| A::Limit::of(point.position, || point.normal));
        self.find_on(|| self.patch(face), corners, places, spare, found);
    }

    /// Answers for places over a piece, given its corners.
    fn find_on<A: Answers>(
        &self,
        patch: impl FnOnce() -> Patch,
        corners: [A::Limit; 3],
        places: &mut Vec<Place>,
        spare: &mut Vec<Place>,
        found: &mut A,
    ) {
        take_corners(corners, places, found);
        if !places.is_empty() {
            spare.resize(places.len(), Place::default());
            self.descend(&patch(), corners, [places, spare], DEEPEST, found);
        }
    }

    /// The piece over a face.
    #[doc(hidden)]
    pub fn patch(&self, face: FaceId) -> Patch {
        root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules)
    }

    /// The rules by which its pieces are refined.
    #[doc(hidden)]
    pub fn rules(&self) -> &Rules<'a> {
        &self.rules
    }

    /// The control mesh.
    #[doc(hidden)]
    pub fn control(&self) -> &'a Mesh {
        self.mesh
    }

    /// The scheme.
    pub(crate) fn scheme(&self) -> &'a dyn Scheme {
        self.rules.scheme()
    }

    /// Whether its pieces have hulls, so that closest points and rays are known for it.
    pub(crate) fn is_certified(&self) -> bool {
        self.rules.is_certified()
    }

    /// The limits of the control vertices.
    pub(crate) fn corner_limits(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// The limits of a control face's corners, with normals on its side.
    #[doc(hidden)]
    pub fn corner_points(&self, face: FaceId) -> [LimitPoint; 3] {
        let topology = self.mesh.topology();
        [0, 1, 2].map(|corner| {
            let h = HalfEdgeId::of(face, corner);
            let position = vector(self.positions[topology.origin(h).index()]);
            let normal = self
                .normals
                .as_ref()
                .map_or([0.0; 3], |normals| normals.at(topology, h));
            LimitPoint {
                position,
                normal: vector(normal),
            }
        })
    }

    /// The limit positions of a control face's corners.
    #[doc(hidden)]
    pub fn corner_positions(&self, face: FaceId) -> [DVec3; 3] {
        self.mesh.triangles()[face.index()].map(|v| vector(self.positions[v as usize]))
    }

    /// The reason why results are invalid, if a stencil failed on the way.
    pub fn failure(&self) -> Option<&LimitError> {
        self.rules.failure()
    }

    /// Answers for the places over a piece, given its corners; the other slice, as long, is scratch space.
    fn descend<A: Answers>(
        &self,
        patch: &Patch,
        corners: [A::Limit; 3],
        slices: [&mut [Place]; 2],
        levels: u32,
        found: &mut A,
    ) {
        match patch {
            Patch::Regular(points) => found.are_on(points, slices[0]),
            Patch::Bicubic(piece) => found.are_on_bicubic(piece, slices[0]),
            _ if levels == 0 => take_nearest(corners, slices[0], found),
            Patch::Extraordinary(patch) => {
                self.descend_to_vertex(patch, corners, slices, levels, found)
            }
            _ => self.descend_to_parts(&patch.refined(&self.rules), corners, slices, levels, found),
        }
    }

    /// [`Self::descend`] for a piece with one irregular corner; nearly all are such after one refinement.
    fn descend_to_vertex<A: Answers>(
        &self,
        patch: &ExtraordinaryPatch,
        corners: [A::Limit; 3],
        slices: [&mut [Place]; 2],
        levels: u32,
        found: &mut A,
    ) {
        match levels {
            0 => take_nearest(corners, slices[0], found),
            _ => {
                let refined = patch.refined(self.rules.beta(patch.ring.len()));
                self.descend_to_parts(&refined, corners, slices, levels, found);
            }
        }
    }

    fn descend_to_parts<A: Answers>(
        &self,
        refined: &impl Parts,
        corners: [A::Limit; 3],
        [places, spare]: [&mut [Place]; 2],
        levels: u32,
        found: &mut A,
    ) {
        let middles = [0, 1, 2].map(|edge| refined.middle(edge));
        let ranges = parted(places, spare, corners, middles, found);
        for (part, own) in ranges
            .into_iter()
            .enumerate()
            .filter(|(_, own)| !own.is_empty())
        {
            let slices = [&mut spare[own.clone()], &mut places[own]];
            let corners = child_corners(corners, middles, part);
            if let Some(points) = refined.points(part) {
                found.are_on(&points, slices[0]);
            } else if let Some(patch) = refined.extraordinary(part) {
                self.descend_to_vertex(&patch, corners, slices, levels - 1, found);
            } else {
                self.descend(&refined.part(part), corners, slices, levels - 1, found);
            }
        }
    }
}

/// The parts of a refined piece, as [`RefinedPatch`] has them.
trait Parts {
    fn middle<L: Limit>(&self, edge: usize) -> L;
    fn points(&self, part: usize) -> Option<patch::Points>;
    fn extraordinary(&self, part: usize) -> Option<Cow<'_, ExtraordinaryPatch>>;
    fn part(&self, part: usize) -> Patch;
}

impl Parts for RefinedPatch<'_> {
    fn middle<L: Limit>(&self, edge: usize) -> L {
        self.middle_as(edge)
    }

    fn points(&self, part: usize) -> Option<patch::Points> {
        self.points(part)
    }

    fn extraordinary(&self, part: usize) -> Option<Cow<'_, ExtraordinaryPatch>> {
        self.extraordinary(part)
    }

    fn part(&self, part: usize) -> Patch {
        self.part(part)
    }
}

// Without the wrapping, which would be copied along at each level.
impl Parts for RefinedExtraordinary {
    fn middle<L: Limit>(&self, edge: usize) -> L {
        let (at, ring) = self.middle(edge);
        L::regular(at, &ring)
    }

    fn points(&self, part: usize) -> Option<patch::Points> {
        self.points(part)
    }

    fn extraordinary(&self, part: usize) -> Option<Cow<'_, ExtraordinaryPatch>> {
        (!self.is_regular(part)).then(|| Cow::Borrowed(self.own()))
    }

    fn part(&self, part: usize) -> Patch {
        self.part(part)
    }
}

/// A regular piece as a polynomial.
fn regular(points: &patch::Points) -> Quartic {
    Quartic::of(&BezierTriangle::of(points), 0)
}

const NOWHERE: SurfacePoint = SurfacePoint {
    position: [0.0; 3],
    normal: [0.0; 3],
};
