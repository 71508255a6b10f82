//! Limit normals of a mesh, one for each side of its sharp edges.

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Topology;
use crate::vector::{DVec3, unit_or_zero};

/// Two tangents closer to parallel than this (the sine of their angle) span no plane: rounding alone gives some
/// 1e-16 for a flat ring, and a few digits are left to coordinates far from the origin.
pub(super) const LEAST_SINE: f64 = 1e-12;

/// Unit limit normals of a mesh's vertices; vertices on sharp edges have one for each side.
#[derive(Clone, Debug, PartialEq)]
pub struct SidedNormals {
    by_vertex: Vec<[f64; 3]>,
    /// One bit a vertex: whether it has several sides. Empty where none has.
    is_sided: Vec<u64>,
    /// The normals at such vertices by the half-edge that leaves them, ascending.
    sides: Vec<(HalfEdgeId, [f64; 3])>,
}

impl SidedNormals {
    #[doc(hidden)]
    pub fn new(by_vertex: Vec<[f64; 3]>) -> Self {
        Self {
            by_vertex,
            is_sided: Vec::new(),
            sides: Vec::new(),
        }
    }

    /// Adds the normal of `vertex` for the faces of the given half-edges, which leave it.
    #[doc(hidden)]
    pub fn add_side(
        &mut self,
        vertex: VertexId,
        faces: impl Iterator<Item = HalfEdgeId>,
        normal: [f64; 3],
    ) {
        self.is_sided.resize(self.by_vertex.len().div_ceil(64), 0);
        self.is_sided[vertex.index() / 64] |= 1u64 << (vertex.index() % 64);
        self.sides.extend(faces.map(|h| (h, normal)));
    }

    /// Sorts for queries.
    #[doc(hidden)]
    pub fn finished(mut self) -> Self {
        self.sides.sort_unstable_by_key(|&(h, _)| h);
        self
    }

    /// The normal at the vertex that `corner` leaves, on the side of its face. `topology` is that of the mesh.
    #[inline]
    pub fn at(&self, topology: &Topology, corner: HalfEdgeId) -> [f64; 3] {
        let v = topology.origin(corner).index();
        let is_sided = self
            .is_sided
            .get(v / 64)
            .is_some_and(|word| word >> (v % 64) & 1 != 0);
        let side = || self.sides.binary_search_by_key(&corner, |&(h, _)| h).ok();
        is_sided
            .then(side)
            .flatten()
            .map_or(self.by_vertex[v], |i| self.sides[i].1)
    }

    /// The normals at vertices with several sides, by the half-edges that leave them.
    #[doc(hidden)]
    pub fn sides(&self) -> &[(HalfEdgeId, [f64; 3])] {
        &self.sides
    }

    /// The normals of vertices, to be changed.
    #[doc(hidden)]
    pub fn by_vertex_mut(&mut self) -> &mut [[f64; 3]] {
        &mut self.by_vertex
    }

    /// Mutable access to the normals of [`Self::sides`].
    #[doc(hidden)]
    pub fn sides_mut(&mut self) -> impl Iterator<Item = (HalfEdgeId, &mut [f64; 3])> {
        self.sides.iter_mut().map(|(h, normal)| (*h, normal))
    }

    /// The normal of each vertex; where it has several sides the average of theirs, of unit length.
    pub fn by_vertex(&self) -> &[[f64; 3]] {
        &self.by_vertex
    }

    /// The normals by vertex, without those of further sides.
    pub fn into_by_vertex(self) -> Vec<[f64; 3]> {
        self.by_vertex
    }
}

/// The area-weighted average of the normals of faces at a vertex, each given by its edges from there, of unit length; zero where
/// it vanishes.
#[doc(hidden)]
pub fn area_weighted_normal(faces: &[[DVec3; 2]]) -> DVec3 {
    // Scaled to the ring's size, so that squares neither vanish nor overflow.
    let greatest = |size: f64, edge: &DVec3| size.max(edge.abs().max_element());
    let size = faces.as_flattened().iter().fold(0.0, greatest);
    if size == 0.0 || !size.is_finite() {
        return DVec3::ZERO;
    }
    let (mut sum, mut areas) = (DVec3::ZERO, 0.0);
    for [a, b] in faces {
        let normal = (a / size).cross(b / size);
        sum += normal;
        areas += normal.length();
    }
    if sum.length() > LEAST_SINE * areas {
        unit_or_zero(sum)
    } else {
        DVec3::ZERO
    }
}
