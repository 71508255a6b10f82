//! The data that stay constant while edges collapse: the kind of each fine vertex, the surface's
//! normals there, and the conditions on a triangle that follow from them.

use super::kept_features::Kind;
use super::triangle_plane::Plane;
use crate::index::VertexId;
use crate::mesh::Mesh;
use crate::vector::{DVec3, vector};

/// The least cosine between a triangle's normal and the surface's normal at its corners: 0.2 is 78°. A triangle that
/// stands steeper is about to fold over.
pub(super) const LEAST_TURN: f64 = 0.2;

/// The least shape of a triangle (see [`Plane::shape`]). Long triangles along directions of low
/// curvature are wanted; thinner ones than this gain nothing more, and are a burden to users of the
/// mesh.
const LEAST_SHAPE: f64 = 0.01;

/// The least cosine between the normal of a vertex and those of the fine faces around for it to be
/// the surface's normal there: beyond 18° there is an untagged edge, or the fine mesh is too
/// coarse.
pub(super) const LEAST_AGREEMENT: f64 = 0.95;

/// Kinds and normals of the fine mesh's vertices.
#[derive(Clone, Copy)]
pub(super) struct Reference<'a> {
    pub(super) kinds: &'a [Kind],
    /// Unit normals; not used at creases and boundaries, where one is not enough.
    pub(super) normals: &'a [DVec3],
    /// Whether the faces around a vertex agree with its normal.
    pub(super) agreed: &'a [bool],
    pub(super) fine: &'a Mesh,
}

/// The worst among the existing triangles: those that replace them need not be better.
#[derive(Clone, Copy)]
pub(super) struct Worst {
    pub(super) shape: f64,
    pub(super) turn: f64,
}

impl Worst {
    /// No triangle yet.
    pub(crate) const NONE: Self = Self {
        shape: 1.0,
        turn: 1.0,
    };

    /// Takes account of a triangle, `None` where it spans no plane.
    pub(super) fn add(
        &mut self,
        plane: Option<&Plane>,
        corners: [u32; 3],
        reference: &Reference<'_>,
    ) {
        let (shape, turn) = plane.map_or((0.0, -1.0), |plane| {
            (plane.shape, reference.turn(plane, corners))
        });
        self.shape = self.shape.min(shape);
        self.turn = self.turn.min(turn);
    }
}

impl Reference<'_> {
    #[inline]
    pub(super) fn kind(&self, vertex: u32) -> Kind {
        self.kinds[vertex as usize]
    }

    /// The normal of the surface where it has one.
    #[inline]
    pub(super) fn normal(&self, vertex: u32) -> Option<DVec3> {
        (self.kind(vertex) == Kind::Smooth).then(|| self.normals[vertex as usize])
    }

    /// The normal of the surface's tangent plane, where the fine mesh is near it.
    #[inline]
    pub(super) fn tangent_plane(&self, vertex: u32) -> Option<DVec3> {
        self.normal(vertex).filter(|_| self.agreed[vertex as usize])
    }

    /// About the distance of a point from the surface, where `vertex` is the fine vertex nearest to it: that from the tangent
    /// plane, or, where there is none, from the fine faces around the vertex.
    #[inline]
    pub(super) fn distance(&self, point: DVec3, vertex: u32, position: DVec3) -> f64 {
        match self.tangent_plane(vertex) {
            Some(normal) => (point - position).dot(normal).abs(),
            None => self.distance_to_faces(point, vertex),
        }
    }

    #[cold]
    fn distance_to_faces(&self, point: DVec3, vertex: u32) -> f64 {
        let around = self
            .fine
            .topology()
            .outgoing_ring(VertexId(vertex))
            .map(|h| h.face().index());
        let distances = around.map(|face| {
            let corners = self.fine.as_triangles().corners(face).map(vector);
            let Some(plane) = Plane::new(corners) else {
                return point.distance(corners[0]);
            };
            plane
                .height(point)
                .unwrap_or_else(|| plane.squared_to_sides(point).sqrt())
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Whether a triangle is neither too thin nor too steep over the surface at its corners.
    #[inline]
    pub(super) fn fits(&self, plane: &Plane, corners: [u32; 3], worst: Worst) -> bool {
        plane.shape >= LEAST_SHAPE.min(worst.shape)
            && self.turn(plane, corners) >= LEAST_TURN.min(worst.turn)
    }

    /// The least cosine between a triangle's normal and the surface's normals at its corners.
    #[inline]
    pub(super) fn turn(&self, plane: &Plane, corners: [u32; 3]) -> f64 {
        let turns = corners
            .iter()
            .filter_map(|&v| self.normal(v))
            .map(|normal| plane.normal.dot(normal));
        turns.fold(1.0, f64::min)
    }

    /// How far the surface bulges over the chord between two points of it, from its normals there: exact for a
    /// paraboloid, positive where it lies above.
    #[inline]
    pub(super) fn sagitta(&self, [a, b]: [u32; 2], [p, q]: [DVec3; 2]) -> f64 {
        match (self.tangent_plane(a), self.tangent_plane(b)) {
            (Some(at_a), Some(at_b)) => 0.125 * (q - p).dot(at_b - at_a),
            _ => 0.0,
        }
    }
}

/// The greatest distance of a paraboloid from a triangle inscribed in it, at the middles of the sides or at the centroid,
/// by the sagittas of its sides: over the centroid a quadratic form rises by a ninth of half its values on the sides.
#[inline]
pub(super) fn bulge([a, b, c]: [f64; 3]) -> f64 {
    a.abs()
        .max(b.abs())
        .max(c.abs())
        .max((4.0 / 9.0) * (a + b + c).abs())
}
