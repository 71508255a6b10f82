//! Pieces of any limit surface: a face with as much of the mesh around it as decides the surface over it.
//!
//! For what has no form of its own: tags that still fade, and schemes outside Loop's family. One refinement is a step
//! of uniform refinement of the piece's surroundings, which honours all tags; limits of vertices come from the scheme's
//! stencils. As soon as nothing fades any more, pieces of Loop's family take their usual form.
//!
//! For Loop's family the faces that touch the face's corners suffice: after a step, the same holds for the four parts.
//! For other schemes it takes two rings: the points within distance 2 of a part depend on points within distance 2 of
//! the face, by masks on whole rings of points within distance 1.

use std::sync::Arc;

use super::box_spline::Points;
use super::from_mesh::patch_of;
use super::rules::Rules;
use super::submesh::submesh;
use super::{LimitPoint, Patch};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::refine::{UniformOptions, uniform};
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

/// Whether a tag that fades decides the surface over a face, given its corners.
pub(crate) fn fades(mesh: &Mesh, sharpness: &Sharpness<'_>, corners: [HalfEdgeId; 3]) -> bool {
    let vertices = corners.map(|h| mesh.topology().origin(h));
    vertices.into_iter().any(|v| sharpness.is_tagged(v) && sharpness.ring(v).fading() > 0.0)
}

/// Refines the surroundings of faces, given as half-edges, once. The parts of seed `i` are the faces from `4i` on.
/// `None` after a failure, which the rules keep.
pub(crate) fn refined_around(mesh: &Mesh, seeds: &[HalfEdgeId], rules: &Rules<'_>) -> Option<Mesh> {
    let small = submesh(mesh, &Sharpness::of(mesh), seeds, rules.rings());
    let refined = uniform(&small, rules.scheme(), &UniformOptions::default().levels(1));
    refined.map_err(|why| rules.fail(why)).ok().map(|refined| refined.mesh)
}

/// The limit position of a vertex; its own place after a failure, which the rules keep.
pub(crate) fn limit_position(mesh: &Mesh, vertex: VertexId, rules: &Rules<'_>) -> DVec3 {
    let found = rules.table().position(mesh, vertex).map_err(|why| rules.fail(why.into()));
    vector(found.unwrap_or(mesh.positions()[vertex.index()]))
}

/// The part `part` of the face that became faces 0 to 3: which half-edge leaves its first corner. Steps start the parts
/// at the old corner, and the middle one at the first new vertex.
pub(crate) fn first_of_part(part: usize) -> HalfEdgeId {
    HalfEdgeId::of(FaceId(part as u32), [0, 2, 1, 1][part])
}

impl MeshPatch {
    /// The piece over a face of a mesh.
    pub(crate) fn of(mesh: &Mesh, sharpness: &Sharpness<'_>, face: FaceId, rules: &Rules<'_>) -> Self {
        let small = submesh(mesh, sharpness, &[HalfEdgeId::of(face, 0)], rules.rings());
        Self { mesh: Arc::new(small), first: HalfEdgeId(0) }
    }

    pub(crate) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub(crate) fn first(&self) -> HalfEdgeId {
        self.first
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
        let refined = refined_around(&self.mesh, &[self.first], rules).map(Arc::new);
        let at = vector(self.mesh.positions()[self.mesh.topology().origin(self.first).index()]);
        RefinedMeshPatch { refined, at, rules }
    }
}

/// A piece refined once: its parts are the first four faces of a mesh.
pub(crate) struct RefinedMeshPatch<'a> {
    refined: Option<Arc<Mesh>>,
    /// Stands for everything after a failure, so that nothing more is done.
    at: DVec3,
    rules: &'a Rules<'a>,
}

impl RefinedMeshPatch<'_> {
    /// A part; numbered as [`super::box_spline::Refined::part`] does.
    pub(crate) fn part(&self, part: usize) -> Patch {
        let Some(mesh) = &self.refined else {
            let points: Points = [self.at; 12];
            return Patch::Regular(points);
        };
        let first = first_of_part(part);
        if self.rules.is_certified() {
            let sharpness = Sharpness::of(mesh);
            if !fades(mesh, &sharpness, corners(first)) {
                return patch_of(mesh, &sharpness, corners(first));
            }
        }
        Patch::Mesh(MeshPatch { mesh: Arc::clone(mesh), first })
    }

    /// The limit of the new vertex on the edge from corner `edge`, on the face's side.
    pub(crate) fn middle(&self, edge: usize) -> LimitPoint {
        let Some(mesh) = &self.refined else {
            return LimitPoint { position: self.at, normal: DVec3::ZERO };
        };
        // The part at the edge's start goes from there to the new vertex.
        let corner = HalfEdgeId::of(FaceId(edge as u32), 1);
        let position = limit_position(mesh, mesh.topology().origin(corner), self.rules);
        let normal = self.rules.table().normal_at(mesh, corner).map_err(|why| self.rules.fail(why.into()));
        LimitPoint { position, normal: vector(normal.unwrap_or_default()) }
    }
}
