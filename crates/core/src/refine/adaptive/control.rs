//! The control mesh as all passes see it: limits at its vertices, the surface over its faces, what is sharp or flat, and what is asked.

use super::back_faces::BackFaces;
use super::demands::Demands;
use super::flat::regions::FlatRegions;
use super::quadtree::Edges;
use super::surface::SurfacePiece;
use crate::criterion::Criteria;
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::SidedNormals;
use crate::mesh::{Mesh, Sharpness};
use crate::patch::large_rings::LargeRings;
use crate::patch::{LimitPoint, Patch, Rules, root_patch};
use crate::refine::kept_faces::KeptFaces;
use crate::vector::{DVec3, vector};

/// The control mesh with its limits, and the goal.
pub(super) struct Control<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) edges: Edges<'a>,
    pub(super) sharpness: &'a Sharpness<'a>,
    pub(super) large: LargeRings,
    /// The infinitely sharp tags.
    pub(super) infinitely_sharp: &'a Sharpness<'a>,
    pub(super) positions: Vec<[f64; 3]>,
    /// Limit normals by side.
    pub(super) sided: SidedNormals,
    pub(super) rules: &'a Rules<'a>,
    /// The faces whose surface is a part of a plane.
    pub(super) flat: FlatRegions,
    /// The criteria; `None` where nothing but distances and numbers of triangles count.
    pub(super) criteria: Option<Criteria>,
    /// The faces that face away from the viewers.
    pub(super) back_faces: BackFaces,
    /// The faces that no triangle reaches over together.
    pub(super) kept: &'a KeptFaces,
    /// The nodes that are divided in any case.
    pub(super) demands: &'a Demands,
    /// Whether leaves may ask for middles of their edges.
    pub(super) leaves_ask: bool,
}

impl Control<'_> {
    pub(super) fn patch(&self, face: u32) -> Patch {
        root_patch(
            self.mesh,
            self.sharpness,
            &self.large,
            FaceId(face),
            self.rules,
        )
    }

    /// The surface over a face.
    pub(super) fn piece(&self, face: u32) -> SurfacePiece {
        SurfacePiece::of(self.patch(face), self.corners(face))
    }

    /// The limits of a face's corners, normals on its side.
    pub(super) fn corners(&self, face: u32) -> [LimitPoint; 3] {
        [0, 1, 2].map(|corner| {
            let h = HalfEdgeId::of(FaceId(face), corner);
            let topology = self.mesh.topology();
            let position = vector(self.positions[topology.origin(h).index()]);
            LimitPoint {
                position,
                normal: vector(self.sided.at(topology, h)),
            }
        })
    }

    /// The control vertex opposite a half-edge in its face.
    pub(super) fn opposite(&self, h: u32) -> DVec3 {
        let face = self.mesh.triangles()[h as usize / 3];
        vector(self.mesh.positions()[face[(h as usize + 2) % 3] as usize])
    }

    /// Which edges of a face lie on the boundary or on a sharp edge.
    pub(super) fn open(&self, face: u32) -> [bool; 3] {
        [0, 1, 2].map(|edge| {
            self.infinitely_sharp
                .edge(HalfEdgeId::of(FaceId(face), edge))
                > 0.0
        })
    }

    /// The faces beyond the edges of a face that are not sharp.
    pub(super) fn adjacent(&self, face: u32) -> impl Iterator<Item = u32> + '_ {
        let open = self.open(face);
        let inner = (0..3u32).filter(move |&edge| !open[edge as usize]);
        inner
            .filter_map(move |edge| self.edges.twin(3 * face + edge))
            .map(|h| h / 3)
    }
}
