//! Control meshes: manifold, oriented triangle meshes with half-edge topology, and how they are
//! made from any file's content.
//!
//! Takes a [`PolygonSoup`], gives a [`Mesh`] and a [`Diagnosis`] of the repaired defects.

mod build;
mod channel;
mod collinear;
mod concave;
mod diagnosis;
mod face_parts;
mod features;
mod junctions;
mod needles;
mod ring_shapes;
mod sharpness;
mod soup;
mod split_surface;
mod tags;
mod topology;

pub use crate::geometry::NONE;
pub use crate::ring::{INFINITELY_SHARP, SharpRing, VertexRule};
#[doc(hidden)]
pub use build::Fans;
pub use build::{BuildOptions, Weld, weld_within};
pub use channel::{
    Channel, ChannelError, Domain, Interpolation, SeamRule, Semantic, Storage, Trace,
};
pub use collinear::are_on_one_line;
pub use concave::ConcaveCorners;
pub use diagnosis::{Diagnosis, Finding};
pub use face_parts::FaceParts;
pub use features::{BoundaryRule, CreasesAbove};
pub use junctions::{Groups, Junctions};
pub use ring_shapes::RingShapes;
pub use sharpness::{Sector, Sharpness};
pub use soup::{PolygonFaces, PolygonSoup};
pub use split_surface::SplitSurface;
pub use tags::{CornerTag, CreaseTag, Tags};
pub use topology::{MAX_FACES, outgoing_half_edges, outgoing_half_edges_polled};
pub use topology::{RingNeighbours, Topology};

use crate::error_messages;
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::ring::{EdgeShape, RingShape};
use crate::vector::{DVec3, diagonal, normal, unit_or_zero, vector};

/// An error in the data of a mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// More elements than `u32` indices allow.
    TooMany {
        /// The kind of element.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A face names a vertex that does not exist.
    VertexOutOfRange {
        /// The face at fault.
        face: usize,
        /// The index met.
        vertex: u64,
        /// Number of vertices.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    NotFinite {
        /// The vertex at fault.
        vertex: usize,
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// The value met.
        value: f64,
    },
    /// A face names a vertex twice.
    RepeatedCorner {
        /// The face at fault.
        face: usize,
        /// The repeated vertex.
        vertex: usize,
    },
    /// An edge has more than two faces, or two faces run along it in one direction.
    EdgeUsedTwice {
        /// Origin of the directed edge.
        from: usize,
        /// Target of the directed edge.
        to: usize,
        /// The later of the two faces.
        face: usize,
    },
    /// The faces at a vertex do not form one fan.
    BowTie {
        /// The vertex at fault.
        vertex: usize,
        /// How many fans meet there.
        fans: usize,
    },
    /// A vertex is in no face.
    Isolated {
        /// The vertex at fault.
        vertex: usize,
    },
    /// No face is left to refine.
    NoFaces {
        /// The cause.
        reason: String,
    },
    /// A repair is needed and forbidden.
    NeedsRepair {
        /// A summary in words.
        summary: String,
    },
    /// An option is out of range.
    BadOption {
        /// The option's name.
        name: &'static str,
        /// The value met.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// An internal invariant is broken.
    Broken {
        /// The element at fault.
        place: String,
        /// The invariant that does not hold.
        what: &'static str,
    },
}

error_messages! {
    MeshError {
        Self::TooMany { what, count, limit } => ("{count} {what} are too many: at most {limit} can be indexed"),
        Self::VertexOutOfRange { face, vertex, count } => ("face {face} names vertex {vertex}, but there are {count} vertices (0 to {})", count.saturating_sub(1)),
        Self::NotFinite { vertex, axis, value } => ("coordinate {} of vertex {vertex} is {value}, which is no finite number", ["x", "y", "z"][*axis]),
        Self::RepeatedCorner { face, vertex } => ("face {face} names vertex {vertex} twice"),
        Self::EdgeUsedTwice { from, to, face } => ("the edge from vertex {from} to vertex {to} is used by face {face} and by an earlier face in the same direction"),
        Self::BowTie { vertex, fans } => ("the faces at vertex {vertex} form {fans} fans rather than one"),
        Self::Isolated { vertex } => ("vertex {vertex} is in no face"),
        Self::NoFaces { reason } => ("no face is left: {reason}"),
        Self::NeedsRepair { summary } => ("the mesh needs repair, which strict mode refuses: {summary}"),
        Self::BadOption { name, value, expected } => ("{name} must be {expected}, but is {value}"),
        Self::Broken { place, what } => ("{what} (at {place})"),
    }
}

/// A view of triangles over positions, manifold or not: the input of measuring, drawing and
/// writing.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    /// Vertex positions.
    pub positions: &'a [[f64; 3]],
    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
}

impl<'a> Triangles<'a> {
    /// The three corner positions of triangle `face`.
    #[inline]
    pub fn corners(&self, face: usize) -> [[f64; 3]; 3] {
        self.triangles[face].map(|v| self.positions[v as usize])
    }

    /// Least and greatest coordinates over all positions; `None` without positions.
    pub fn bounding_box(&self) -> Option<[[f64; 3]; 2]> {
        let first = vector(*self.positions.first()?);
        let (low, high) = self
            .positions
            .iter()
            .fold((first, first), |(low, high), &p| {
                let p = vector(p);
                (low.min(p), high.max(p))
            });
        Some([low.to_array(), high.to_array()])
    }

    /// Length of the bounding box's diagonal; 0 without positions.
    pub fn diagonal(&self) -> f64 {
        self.bounding_box()
            .map_or(0.0, |[low, high]| diagonal(vector(low), vector(high)))
    }
}

/// A manifold, oriented triangle mesh: topology, positions, tags, and junctions of cut sheets.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    topology: Topology,
    positions: Vec<[f64; 3]>,
    tags: Tags,
    junctions: Junctions,
}

impl Mesh {
    /// A mesh from triangles that are already manifold and consistently oriented; repairs nothing.
    ///
    /// # Errors
    /// The first element that breaks a condition: an index out of range, a coordinate that is not
    /// finite, an edge used twice in one direction, a vertex with several fans or none.
    pub fn from_triangles(
        positions: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        check_finite(&positions)?;
        let topology = Topology::from_triangles(triangles, positions.len())?;
        Ok(Self {
            topology,
            positions,
            tags: Tags::default(),
            junctions: Junctions::default(),
        })
    }

    /// A mesh from the contents of a file: polygons are triangulated, equal positions welded,
    /// defects repaired and counted.
    ///
    /// # Errors
    /// Bad indices, coordinates that are not finite, nothing left to refine, or any repair under
    /// [`BuildOptions::strict`].
    pub fn from_soup(
        soup: &PolygonSoup,
        options: &BuildOptions,
    ) -> Result<(Self, Diagnosis), MeshError> {
        build::build(soup, options).map(|(mesh, diagnosis, _)| (mesh, diagnosis))
    }

    /// [`Self::from_soup`], with the faces and corners of the soup that those of the mesh are from.
    ///
    /// # Errors
    /// Those of [`Self::from_soup`].
    pub fn from_soup_traced(
        soup: &PolygonSoup,
        options: &BuildOptions,
    ) -> Result<(Self, Diagnosis, Trace), MeshError> {
        build::build(soup, options)
    }

    /// [`Self::from_soup`] with each polygon whole, as a fan of triangles around a vertex of its own. Polygons without area stay.
    ///
    /// # Errors
    /// Those of [`Self::from_soup`].
    #[doc(hidden)]
    pub fn fans_from_soup(
        soup: &PolygonSoup,
        options: &BuildOptions,
    ) -> Result<(Fans, Diagnosis), MeshError> {
        build::build_fans(soup, options)
    }

    /// The same mesh as one of quads, whose halves its triangles are ([`Topology::with_quads`]).
    ///
    /// # Errors
    /// They are not.
    pub fn with_quads(mut self) -> Result<Self, MeshError> {
        self.topology = self.topology.with_quads()?;
        Ok(self)
    }

    /// The parts put together; `topology` and `positions` must agree.
    #[doc(hidden)]
    pub fn from_parts(
        topology: Topology,
        positions: Vec<[f64; 3]>,
        tags: Tags,
        junctions: Junctions,
    ) -> Self {
        debug_assert_eq!(topology.vertex_count(), positions.len());
        Self {
            topology,
            positions,
            tags,
            junctions,
        }
    }

    /// Connectivity.
    #[inline]
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Vertex positions.
    #[inline]
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Replaces the positions, for example by limit positions.
    ///
    /// # Errors
    /// The count differs or a coordinate is not finite.
    pub fn with_positions(mut self, positions: Vec<[f64; 3]>) -> Result<Self, MeshError> {
        if positions.len() != self.positions.len() {
            return Err(MeshError::Broken {
                place: format!("{} positions", positions.len()),
                what: "one position for each vertex is needed",
            });
        }
        check_finite(&positions)?;
        self.positions = positions;
        Ok(self)
    }

    /// Moves one vertex, to where coordinates are finite.
    #[doc(hidden)]
    pub fn set_position(&mut self, vertex: VertexId, to: [f64; 3]) {
        self.positions[vertex.index()] = to;
    }

    /// Crease and corner tags.
    pub fn tags(&self) -> &Tags {
        &self.tags
    }

    /// Replaces the tags. Where sheets were cut apart, copies of one vertex become equally sharp, and those that
    /// must be corners for the sheets to stay together remain so.
    ///
    /// # Errors
    /// A tag names a vertex that does not exist or an edge that no face has.
    pub fn with_tags(mut self, mut tags: Tags) -> Result<Self, MeshError> {
        tags.check(&self.topology)?;
        let cut = self.junctions.vertices.iter().flatten().copied();
        let fixed: Vec<u32> = cut.filter(|&v| self.tags.is_corner(VertexId(v))).collect();
        tags.add_corners(fixed.into_iter().map(|vertex| CornerTag {
            vertex,
            sharpness: f64::INFINITY,
        }));
        self.tags = tags.joined(&self.topology, &self.junctions);
        Ok(self)
    }

    /// Vertices and boundary edges of different sheets at one position that must stay together.
    pub fn junctions(&self) -> &Junctions {
        &self.junctions
    }

    /// Number of half-edges without a partner: boundaries, without cuts that are matched by as many
    /// half-edges in either direction. Solids that touch along an edge have none.
    pub fn open_edge_count(&self) -> usize {
        let firsts = self.junctions.first_copies();
        let first = |v: VertexId| firsts.get(&v.0).copied().unwrap_or(v.0);
        let paired = self.junctions.edges.iter().map(|copies| {
            let origins = || {
                copies
                    .iter()
                    .map(|&h| first(self.topology.origin(HalfEdgeId(h))))
            };
            let from = origins().next();
            let along = origins().filter(|&origin| Some(origin) == from).count();
            2 * along.min(copies.len() - along)
        });
        self.topology.boundary_edge_count() - paired.sum::<usize>()
    }

    /// Vertex indices of each face, counter-clockwise seen from outside.
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.topology.triangles()
    }

    /// Number of vertices.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of faces.
    #[inline]
    pub fn face_count(&self) -> usize {
        self.topology.face_count()
    }

    /// Positions and triangles without copying them; everything else is dropped.
    pub fn into_positions_and_triangles(self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        (self.positions, self.topology.into_triangles())
    }

    /// Positions and triangles alone.
    #[inline]
    pub fn as_triangles(&self) -> Triangles<'_> {
        Triangles {
            positions: &self.positions,
            triangles: self.topology.triangles(),
        }
    }

    /// Length of the bounding box's diagonal.
    pub fn diagonal(&self) -> f64 {
        self.as_triangles().diagonal()
    }

    /// The shape of the one-ring of `vertex`, which decides its rules unless there are sharp edges
    /// inside the mesh or semi-sharp corners (see [`Sharpness::sectors`]).
    #[inline]
    pub fn ring_shape(&self, vertex: VertexId) -> RingShape {
        let (valence, open) = self.topology.valence_and_openness(vertex);
        RingShape {
            valence,
            open,
            corner: self.tags.is_corner(vertex),
            dart: false,
        }
    }

    /// The shapes of the rings at both ends of `edge`, and its slots in them.
    pub fn edge_shape(&self, edge: HalfEdgeId) -> EdgeShape {
        let [from, to] = self.topology.ends(edge);
        let (origin, target) = (self.ring_shape(from), self.ring_shape(to));
        let slot = |at: VertexId, shape: RingShape, other: VertexId| {
            if !shape.open {
                return 0;
            }
            self.topology
                .ring(at)
                .position(|u| u == other)
                .map_or(0, |slot| slot as u32)
        };
        EdgeShape {
            origin,
            origin_slot: slot(from, origin, to),
            target,
            target_slot: slot(to, target, from),
        }
    }

    /// Twice the area of `face` times its unit normal.
    #[inline]
    pub fn face_normal(&self, face: FaceId) -> [f64; 3] {
        self.face_normal_vector(face.index()).to_array()
    }

    #[inline]
    #[doc(hidden)]
    pub fn face_normal_vector(&self, face: usize) -> DVec3 {
        let [a, b, c] = self.topology.triangles()[face].map(|v| vector(self.positions[v as usize]));
        (b - a).cross(c - a)
    }

    /// The unit normal of a face of any size; zero where it has no area.
    #[inline]
    #[doc(hidden)]
    pub fn unit_face_normal(&self, face: usize) -> DVec3 {
        unit_or_zero(self.scaled_face_normal(face))
    }

    /// The unit normal of a face, or of the quad of which it is half; zero where it has no area.
    pub(crate) fn unit_polygon_normal(&self, face: usize) -> DVec3 {
        match self.topology.has_quads() {
            true => unit_or_zero(self.face_normal_vector(face) + self.face_normal_vector(face ^ 1)),
            false => self.unit_face_normal(face),
        }
    }

    /// A normal of a face of any size, of any length; zero where it has no area.
    #[inline]
    #[doc(hidden)]
    pub fn scaled_face_normal(&self, face: usize) -> DVec3 {
        normal(self.topology.triangles()[face].map(|v| vector(self.positions[v as usize])))
    }

    /// Checks every invariant of the mesh: topology, finite positions, tags and junctions.
    ///
    /// # Errors
    /// The first element that breaks one.
    pub fn validate(&self) -> Result<(), MeshError> {
        self.topology.validate()?;
        if self.positions.len() != self.topology.vertex_count() {
            return Err(MeshError::Broken {
                place: format!("{} positions", self.positions.len()),
                what: "one position for each vertex is needed",
            });
        }
        check_finite(&self.positions)?;
        self.tags.check(&self.topology)?;
        self.junctions.validate(&self.topology, &self.positions)
    }
}

/// Refuses NaN and infinity.
#[doc(hidden)]
pub fn check_finite(positions: &[[f64; 3]]) -> Result<(), MeshError> {
    let bad_axis = |p: &[f64; 3]| (0..3).find(|&axis| !p[axis].is_finite());
    let first = crate::parallel::first(positions.len(), |v| bad_axis(&positions[v]).is_some());
    match first.and_then(|vertex| Some((vertex, bad_axis(&positions[vertex])?))) {
        None => Ok(()),
        Some((vertex, axis)) => Err(MeshError::NotFinite {
            vertex,
            axis,
            value: positions[vertex][axis],
        }),
    }
}

/// Sizes of control meshes at which squares of areas neither vanish nor overflow, for functions
/// that do not scale their input.
const SAFE_DIAGONALS: core::ops::RangeInclusive<f64> = 1e-70..=1e70;

/// Refuses a mesh that is too large or too small to be computed with at its size.
#[doc(hidden)]
pub fn check_size(mesh: &Mesh) -> Result<(), MeshError> {
    let value = mesh.diagonal();
    if SAFE_DIAGONALS.contains(&value) {
        return Ok(());
    }
    Err(MeshError::BadOption {
        name: "the diagonal of the control mesh",
        value,
        expected: "1e-70 to 1e70",
    })
}
