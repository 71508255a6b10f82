//! Pieces of any limit surface: a face with as much of the mesh around it as decides the surface over it.
//!
//! For schemes outside the Loop family. One refinement is a step of uniform refinement of the piece's surroundings, which
//! honours all tags; limits of vertices come from the scheme's stencils. It takes two rings of faces: the points within
//! distance 2 of a part depend on points within distance 2 of the face, by masks on whole rings of points within distance
//! 1.

use std::sync::Arc;

use super::rules::Rules;
use super::submesh::{refined_submesh, submesh};
use super::{LimitPoint, Patch};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::vector::{DVec3, vector};

/// A face of a small mesh that holds all that the surface over the face depends on.
#[derive(Clone, Debug)]
pub(crate) struct MeshPatch {
    mesh: Arc<Mesh>,
    /// The half-edge from the piece's first corner to its second.
    first: HalfEdgeId,
}

/// The corners of a face as half-edges, from `first` on.
pub(crate) fn corners(first: HalfEdgeId) -> [HalfEdgeId; 3] {
    [first, first.next(), first.previous()]
}

/// The rings of faces around a face that decide the surface over it.
const RINGS: usize = 2;

/// Refines the surroundings of faces, given as half-edges, once. The parts of seed `i` are the faces from `4i` on.
pub(crate) fn refined_around(mesh: &Mesh, seeds: &[HalfEdgeId], rules: &Rules<'_>) -> Mesh {
    refined_submesh(&submesh(mesh, &Sharpness::of(mesh), seeds, RINGS), rules.scheme())
}

/// The limit position of a vertex; its own place after a failure, which the rules keep.
pub(crate) fn limit_position(mesh: &Mesh, vertex: VertexId, rules: &Rules<'_>) -> DVec3 {
    let found = rules.table().position(mesh, vertex).map_err(|why| rules.fail(why));
    vector(found.unwrap_or(mesh.positions()[vertex.index()]))
}

/// The part `part` of the face that became faces 0 to 3: which half-edge leaves its first corner. Steps start the parts
/// at the old corner, and the middle one at the first new vertex.
fn first_of_part(part: usize) -> HalfEdgeId {
    HalfEdgeId::of(FaceId(part as u32), [0, 2, 1, 1][part])
}

impl MeshPatch {
    /// The piece over a face of a mesh.
    pub(crate) fn of(mesh: &Mesh, sharpness: &Sharpness<'_>, face: FaceId) -> Self {
        let small = submesh(mesh, sharpness, &[HalfEdgeId::of(face, 0)], RINGS);
        Self { mesh: Arc::new(small), first: HalfEdgeId(0) }
    }

    pub(crate) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub(crate) fn first(&self) -> HalfEdgeId {
        self.first
    }

    /// The point of a corner of the face.
    pub(super) fn control_point(&self, corner: usize) -> DVec3 {
        vector(self.mesh.positions()[self.mesh.topology().origin(corners(self.first)[corner]).index()])
    }

    /// The corners and their neighbours; some more than once.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let topology = self.mesh.topology();
        let around = corners(self.first).into_iter().flat_map(|h| {
            let vertex = topology.origin(h);
            core::iter::once(vertex).chain(topology.ring(vertex))
        });
        around.map(|v| vector(self.mesh.positions()[v.index()]))
    }

    /// The piece refined once.
    pub(crate) fn refined<'a>(&self, rules: &'a Rules<'a>) -> RefinedMeshPatch<'a> {
        RefinedMeshPatch { refined: Arc::new(refined_around(&self.mesh, &[self.first], rules)), rules }
    }
}

/// A piece refined once: its parts are the first four faces of a mesh.
pub(crate) struct RefinedMeshPatch<'a> {
    refined: Arc<Mesh>,
    rules: &'a Rules<'a>,
}

impl RefinedMeshPatch<'_> {
    /// A part; numbered as [`super::box_spline::Refined::part`] does.
    pub(crate) fn part(&self, part: usize) -> Patch {
        Patch::Mesh(MeshPatch { mesh: Arc::clone(&self.refined), first: first_of_part(part) })
    }

    /// The limit of the new vertex on the edge from corner `edge`, on the face's side.
    pub(crate) fn middle(&self, edge: usize) -> LimitPoint {
        // The part at the edge's start goes from there to the new vertex.
        let corner = HalfEdgeId::of(FaceId(edge as u32), 1);
        let position = limit_position(&self.refined, self.refined.topology().origin(corner), self.rules);
        let normal = self.rules.table().normal_at(&self.refined, corner).map_err(|why| self.rules.fail(why));
        LimitPoint { position, normal: vector(normal.unwrap_or_default()) }
    }
}
