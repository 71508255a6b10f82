//! Points and normals of the limit surface at any place of its control faces.
//!
//! A piece is refined towards the place until its part there is a polynomial (Stam, "Evaluation of Loop Subdivision Surfaces",
//! 1998: around an irregular vertex the regular parts shrink by half with each level), which is evaluated; at corners the scheme's
//! limit stencils are. Places that share a piece share its refinement.

use crate::certificate::Sheet;
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::{LimitError, SidedNormals};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::large_rings::LargeRings;
use crate::patch::{LimitPoint, Patch, Quartic, Rules, child_corners, root_patch};
use crate::scheme::Scheme;
use crate::vector::vector;

/// Levels after which a place counts as the nearest corner of its part, which is 2⁻⁴⁰ as large as the face.
const DEEPEST: u32 = 40;

/// Places that are evaluated together.
const LANES: usize = 4;

/// Faces that are evaluated together.
const BLOCK: usize = 64;

/// A point of a limit surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfacePoint {
    /// Where it is, in the control mesh's units.
    pub position: [f64; 3],
    /// The unit normal, on the side of the face that was asked; zero where there is none.
    pub normal: [f64; 3],
}

/// The limit surface of a control mesh.
///
/// ```
/// use limitmesh::{FaceId, LimitSurface, Mesh, scheme::Loop};
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
    /// `None` where nobody asks for normals: they are zero then.
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
    /// As for [`Self::new`].
    pub fn without_normals(mesh: &'a Mesh, scheme: &'a dyn Scheme) -> Result<Self, LimitError> {
        let rules = Rules::of(scheme);
        let positions = rules.table().positions(mesh)?;
        let (sharpness, large) = (Sharpness::of(mesh), LargeRings::of(mesh));
        Ok(Self { mesh, sharpness, large, rules, positions, normals: None })
    }

    /// The point over a place of a control face, given by barycentric coordinates; the second and third count, cut off so that none
    /// is below 0 and their sum not above 1. A face that there is not has its points at zero.
    pub fn at(&self, face: FaceId, barycentric: [f64; 3]) -> SurfacePoint {
        self.over(face, &[barycentric]).pop().unwrap_or(NOWHERE)
    }

    /// The points over several places of a face, as [`Self::at`] gives them.
    pub fn over(&self, face: FaceId, places: &[[f64; 3]]) -> Vec<SurfacePoint> {
        let mut found = vec![NOWHERE; places.len()];
        if face.index() >= self.mesh.face_count() {
            return found;
        }
        let topology = self.mesh.topology();
        let corners = [0, 1, 2].map(|corner| {
            let h = HalfEdgeId::of(face, corner);
            let position = vector(self.positions[topology.origin(h).index()]);
            let normal = self.normals.as_ref().map_or([0.0; 3], |normals| normals.at(topology, h));
            LimitPoint { position, normal: vector(normal) }
        });
        let mut left: Vec<Place> = places
            .iter()
            .enumerate()
            .map(|(at, &weights)| Place { at, weights: on_triangle(weights) })
            .collect();
        take_corners(corners, &mut left, &mut found);
        if !left.is_empty() {
            let patch = root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules);
            self.descend(&patch, corners, left, DEEPEST, &mut found);
        }
        found
    }

    /// The points over places of many faces, in order, on all threads. Places of one face that stand together share its work.
    pub fn at_all(&self, places: &[(FaceId, [f64; 3])]) -> Vec<SurfacePoint> {
        let of_faces: Vec<&[(FaceId, [f64; 3])]> = places.chunk_by(|a, b| a.0 == b.0).collect();
        let blocks = parallel::pieces_of(of_faces.len(), BLOCK, |block| {
            let over = |own: &[(FaceId, [f64; 3])]| {
                let at: Vec<[f64; 3]> = own.iter().map(|&(_, at)| at).collect();
                self.over(own[0].0, &at)
            };
            block.flat_map(|face| over(of_faces[face])).collect::<Vec<_>>()
        });
        blocks.concat()
    }

    /// The first `axes` coordinates of the points over places of faces that there are, one after the other; places are in order, as
    /// [`Self::at`] would bring them. Places of a face share its work wherever they stand.
    pub(crate) fn coordinates(&self, places: &[(FaceId, [f64; 3])], axes: usize) -> Vec<f64> {
        let faces = self.mesh.face_count();
        let mut starts = vec![0; faces + 1];
        places.iter().for_each(|(face, _)| starts[face.index() + 1] += 1);
        (0..faces).for_each(|face| starts[face + 1] += starts[face]);
        let (mut next, mut order) = (starts.clone(), vec![0; places.len()]);
        for (at, (face, _)) in places.iter().enumerate() {
            order[next[face.index()]] = at;
            next[face.index()] += 1;
        }
        let blocks = parallel::pieces_of(faces, BLOCK, |block| {
            let mut found = Vec::with_capacity(axes * (starts[block.end] - starts[block.start]));
            for face in block {
                let own: Vec<[f64; 3]> =
                    order[starts[face]..starts[face + 1]].iter().map(|&at| places[at].1).collect();
                if !own.is_empty() {
                    self.coordinates_of_face(FaceId(face as u32), &own, axes, &mut found);
                }
            }
            found
        });
        let mut all = vec![0.0; axes * places.len()];
        let found = blocks.iter().flat_map(|block| block.chunks_exact(axes.max(1)));
        order.iter().zip(found).for_each(|(&at, own)| all[axes * at..][..axes].copy_from_slice(own));
        all
    }

    fn coordinates_of_face(&self, face: FaceId, places: &[[f64; 3]], axes: usize, found: &mut Vec<f64>) {
        let (sheet, _) = self.sheet(face);
        let Patch::Regular(points) = &sheet.patch else {
            return found.extend(self.over(face, places).iter().flat_map(|point| &point.position[..axes]));
        };
        let piece = Quartic::of(&BezierTriangle::of(points), 0);
        for some in places.chunks(2 * LANES) {
            let [mut u, mut v] = [[0.0; 2 * LANES]; 2];
            for (lane, weights) in some.iter().enumerate() {
                [u[lane], v[lane]] = [weights[1], weights[2]];
            }
            let mut points = piece.points_at(&u, &v, axes);
            for (lane, weights) in some.iter().enumerate() {
                if let Some(corner) = weights.iter().position(|&weight| weight == 1.0) {
                    (0..axes).for_each(|axis| points[axis][lane] = sheet.corners[corner][axis]);
                }
                found.extend(points[..axes].iter().map(|axis| axis[lane]));
            }
        }
    }

    /// The surface over a face, and the rules by which it is refined.
    pub(crate) fn sheet(&self, face: FaceId) -> (Sheet, &Rules<'a>) {
        let corners = self.mesh.triangles()[face.index()].map(|v| vector(self.positions[v as usize]));
        let patch = root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules);
        (Sheet { patch, corners }, &self.rules)
    }

    /// Why what was computed means nothing, if a stencil failed on the way.
    pub fn failure(&self) -> Option<&LimitError> {
        self.rules.failure()
    }

    /// Places on a regular piece.
    fn evaluate(&self, piece: &Quartic, places: &[Place], found: &mut [SurfacePoint]) {
        for some in places.chunks(LANES) {
            let [mut u, mut v] = [[0.0; LANES]; 2];
            for (lane, place) in some.iter().enumerate() {
                [u[lane], v[lane]] = [place.weights[1], place.weights[2]];
            }
            let [points, normals] = match self.normals {
                Some(_) => piece.points_and_normals_at(&u, &v),
                None => [piece.points_at(&u, &v, 3), [[0.0; LANES]; 3]],
            };
            for (lane, place) in some.iter().enumerate() {
                let [position, normal] = [points, normals].map(|by_axis| by_axis.map(|axis| axis[lane]));
                found[place.at] = SurfacePoint { position, normal };
            }
        }
    }

    fn descend(
        &self,
        patch: &Patch,
        corners: [LimitPoint; 3],
        left: Vec<Place>,
        levels: u32,
        found: &mut [SurfacePoint],
    ) {
        if let Patch::Regular(points) = patch {
            return self.evaluate(&Quartic::of(&BezierTriangle::of(points), 0), &left, found);
        }
        if levels == 0 {
            for Place { at, weights } in left {
                let nearest = (0..3).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
                found[at] = corners[nearest].into();
            }
            return;
        }
        let refined = patch.refined(&self.rules);
        let middles = [0, 1, 2].map(|edge| refined.middle(edge));
        let mut parts = [0; 4].map(|_| Vec::with_capacity(left.len() / 3));
        for place in left {
            let child = place.child();
            parts[child].push(place.in_child(child));
        }
        for (child, mut own) in parts.into_iter().enumerate() {
            let corners = child_corners(corners, middles, child);
            take_corners(corners, &mut own, found);
            if !own.is_empty() {
                self.descend(&refined.part(child), corners, own, levels - 1, found);
            }
        }
    }
}

const NOWHERE: SurfacePoint = SurfacePoint { position: [0.0; 3], normal: [0.0; 3] };

impl From<LimitPoint> for SurfacePoint {
    fn from(LimitPoint { position, normal }: LimitPoint) -> Self {
        Self { position: position.to_array(), normal: normal.to_array() }
    }
}

/// A place in a part, and the number of its point.
struct Place {
    at: usize,
    weights: [f64; 3],
}

impl Place {
    /// The part of four that it is in: those at the corners, and the middle one.
    fn child(&self) -> usize {
        self.weights.iter().position(|&weight| weight >= 0.5).unwrap_or(3)
    }

    fn in_child(self, child: usize) -> Self {
        let weights = match child {
            3 => self.weights.map(|weight| 1.0 - 2.0 * weight),
            _ => core::array::from_fn(|i| 2.0 * self.weights[i] - if i == child { 1.0 } else { 0.0 }),
        };
        Self { weights, ..self }
    }
}

/// Barycentric coordinates that are in order.
fn on_triangle(weights: [f64; 3]) -> [f64; 3] {
    let [_, u, v] = weights.map(|weight| if weight > 0.0 { weight.min(1.0) } else { 0.0 });
    let v = v.min(1.0 - u);
    [1.0 - u - v, u, v]
}

/// Answers for the places that are corners.
fn take_corners(corners: [LimitPoint; 3], places: &mut Vec<Place>, found: &mut [SurfacePoint]) {
    places.retain(|place| match place.weights.iter().position(|&weight| weight == 1.0) {
        Some(corner) => {
            found[place.at] = corners[corner].into();
            false
        }
        None => true,
    });
}
