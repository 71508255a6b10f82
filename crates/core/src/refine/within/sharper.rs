//! Edges that are made sharp where no smooth surface stays near.
//!
//! A surface that is smooth across an edge leaves the faces there by some part of their size times
//! the angle. So the edges around a fault that bend most become sharp first: those of a part, with
//! round faces left round between them. Faces that are still too far off, or turned over, are those
//! on which a surface folds, such as slivers: all their edges become sharp and their vertices
//! corners, which makes each the flat triangle that it was; at last this is done to the faces
//! around them, too.

use crate::geometry::DisjointSets;
use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::mesh::{CornerTag, CreaseTag, Mesh, MeshError, Sharpness};
use crate::ring::INFINITELY_SHARP;
use crate::vector::DVec3;
use std::collections::HashMap;

/// How often edges are made sharp by their angles.
const BY_ANGLE: usize = 3;

/// How many rings of faces around faults are kept flat with them, from one time to the next; then all faces of their component are.
const RINGS: [usize; 3] = [0, 2, 8];

/// Edges that bend by more than this part of the greatest angle around a fault become sharp with that.
const OF_GREATEST: f64 = 0.25;

/// Angles (radians) that are rounding.
const FLAT: f64 = 1e-6;

/// The angle between two normals; not a number where one is zero.
fn angle_between(one: DVec3, other: DVec3) -> f64 {
    let lengths = (one.length_squared() * other.length_squared()).sqrt();
    math::acos((one.dot(other) / lengths).clamp(-1.0, 1.0))
}

/// The mesh that was given, sharper from one time to the next.
pub(super) struct Sharper {
    pub(super) mesh: Mesh,
    /// Which faces are kept flat.
    is_flat: Vec<bool>,
    times: usize,
    /// Edges that became sharp.
    pub(super) edges: usize,
}

impl Sharper {
    pub(super) fn new(mesh: &Mesh) -> Self {
        Self {
            mesh: mesh.clone(),
            is_flat: vec![false; mesh.face_count()],
            times: 0,
            edges: 0,
        }
    }

    /// Makes the mesh sharper around faults; says whether there was anything to make sharper. Where the surface is not too far off, but folds,
    /// only flat faces help.
    pub(super) fn sharpen(&mut self, is_faulty: &[bool], is_far: bool) -> Result<bool, MeshError> {
        while is_far && self.times < BY_ANGLE {
            self.times += 1;
            let edges = self.bent_edges(is_faulty);
            if !edges.is_empty() {
                self.edges += edges.len();
                self.mesh = self.mesh.clone().with_creases(&edges);
                return Ok(true);
            }
        }
        self.times = self.times.max(BY_ANGLE) + 1;
        let count = |is_flat: &[bool]| is_flat.iter().filter(|&&is_flat| is_flat).count();
        let before = count(&self.is_flat);
        let added = self.around(is_faulty, RINGS.get(self.times - BY_ANGLE - 1).copied());
        self.is_flat
            .iter_mut()
            .zip(added)
            .for_each(|(flat, is_added)| *flat |= is_added);
        self.keep_flat()?;
        Ok(count(&self.is_flat) > before)
    }

    /// The edges at the vertices of faulty faces that bend most, each once, and are not sharp yet.
    fn bent_edges(&self, is_faulty: &[bool]) -> Vec<HalfEdgeId> {
        let (topology, sharpness) = (self.mesh.topology(), Sharpness::of(&self.mesh));
        let angle = |h: HalfEdgeId| {
            let twin = topology
                .twin(h)
                .filter(|_| sharpness.edge(h) < INFINITELY_SHARP)?;
            let [one, other] = [h, twin].map(|h| self.mesh.unit_face_normal(h.face().index()));
            Some(angle_between(one, other)).filter(|&angle| angle > FLAT)
        };
        let mut bent = Vec::new();
        for triangle in corners_of(&self.mesh, is_faulty) {
            let rings = triangle
                .iter()
                .flat_map(|&v| topology.outgoing_ring(VertexId(v)));
            let around: Vec<_> = rings.filter_map(|h| Some((h, angle(h)?))).collect();
            let greatest = around.iter().map(|&(_, angle)| angle).fold(0.0, f64::max);
            bent.extend(
                around
                    .iter()
                    .filter(|(_, angle)| *angle >= OF_GREATEST * greatest)
                    .map(|&(h, _)| h),
            );
        }
        bent.iter_mut()
            .for_each(|h| *h = topology.twin(*h).map_or(*h, |twin| twin.min(*h)));
        bent.sort_unstable();
        bent.dedup();
        self.without_ends(bent, &sharpness)
    }

    /// Edges without those that lead nowhere: where a single sharp edge ends, the system for control points is not symmetric.
    fn without_ends(
        &self,
        mut edges: Vec<HalfEdgeId>,
        sharpness: &Sharpness<'_>,
    ) -> Vec<HalfEdgeId> {
        let topology = self.mesh.topology();
        let others = |v: VertexId| {
            sharpness
                .spokes(v)
                .filter(|&sharpness| sharpness > 0.0)
                .count()
        };
        loop {
            let mut counts: HashMap<VertexId, usize> = HashMap::new();
            edges
                .iter()
                .flat_map(|&h| topology.ends(h))
                .for_each(|v| *counts.entry(v).or_default() += 1);
            let before = edges.len();
            edges.retain(|&h| topology.ends(h).iter().all(|&v| counts[&v] + others(v) > 1));
            if edges.len() == before {
                return edges;
            }
        }
    }

    /// Faulty faces and `rings` rings of faces around them, or all faces of their components.
    fn around(&self, is_faulty: &[bool], rings: Option<usize>) -> Vec<bool> {
        let triangles = self.mesh.triangles();
        let Some(rings) = rings else {
            let mut sets = DisjointSets::new(self.mesh.vertex_count());
            for &[a, b, c] in triangles {
                sets.unite(a, b);
                sets.unite(a, c);
            }
            let roots = sets.into_roots();
            let mut is_own = vec![false; roots.len()];
            corners_of(&self.mesh, is_faulty)
                .for_each(|[a, ..]| is_own[roots[a as usize] as usize] = true);
            return triangles
                .iter()
                .map(|&[a, ..]| is_own[roots[a as usize] as usize])
                .collect();
        };
        let mut all = is_faulty.to_vec();
        for _ in 0..rings {
            let mut is_near = vec![false; self.mesh.vertex_count()];
            corners_of(&self.mesh, &all)
                .flatten()
                .for_each(|v| is_near[v as usize] = true);
            all = triangles
                .iter()
                .map(|corners| corners.iter().any(|&v| is_near[v as usize]))
                .collect();
        }
        all
    }

    /// Makes the vertices of flat faces corners, and all edges there sharp: between edges that are not, a surface folds over where these are
    /// 180° apart and more.
    fn keep_flat(&mut self) -> Result<(), MeshError> {
        let (topology, sharpness) = (self.mesh.topology(), Sharpness::of(&self.mesh));
        let mut is_corner = vec![false; self.mesh.vertex_count()];
        corners_of(&self.mesh, &self.is_flat)
            .flatten()
            .for_each(|v| is_corner[v as usize] = true);
        // Boundaries are sharp already.
        let is_new = |&h: &HalfEdgeId| {
            let is_first = topology.twin(h).is_some_and(|twin| h < twin);
            let ends = topology.ends(h);
            is_first
                && sharpness.edge(h) < INFINITELY_SHARP
                && ends.iter().any(|v| is_corner[v.index()])
        };
        let ends: Vec<[u32; 2]> = topology
            .half_edges()
            .filter(is_new)
            .map(|h| topology.ends(h).map(|v| v.0))
            .collect();
        self.edges += ends.len();
        let mut tags = self.mesh.tags().clone();
        tags.creases
            .extend(ends.into_iter().map(|vertices| CreaseTag {
                vertices,
                sharpness: f64::INFINITY,
            }));
        let corners = (0..).zip(&is_corner).filter(|&(_, &is_corner)| is_corner);
        tags.add_corners(corners.map(|(vertex, _)| CornerTag {
            vertex,
            sharpness: f64::INFINITY,
        }));
        self.mesh = self.mesh.clone().with_tags(tags)?;
        Ok(())
    }
}

/// The vertices of the faces that are marked.
fn corners_of<'a>(
    mesh: &'a Mesh,
    is_marked: &'a [bool],
) -> impl Iterator<Item = [u32; 3]> + use<'a> {
    mesh.triangles()
        .iter()
        .zip(is_marked)
        .filter(|&(_, &is_marked)| is_marked)
        .map(|(&corners, _)| corners)
}
