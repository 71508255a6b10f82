//! Creases that turn back along the two sides of one triangle.
//!
//! A needle, a triangle that is long and thin, turns by a small movement of its corners; measured
//! and simplified meshes have many. It may then stand across the adjacent faces, and both of its
//! long edges are sharper than any requested angle, though no edge is visible there. A crease along
//! both would be a line that turns back at the tip, which is no curve: the surface next to it folds
//! over. Therefore the faces beyond the two edges are compared. If these differ by more than the
//! angle, there is one edge, the sharper of the two; else there is none.

use super::Topology;
use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::vector::{DVec3, vector};

/// The cosine of the angle of a needle's tip, 45° and less: a curve does not turn back so far within two edges.
const TIP: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// Edges that are sharp by their angle, by half-edge.
pub(super) struct SharpEdges<'a> {
    topology: &'a Topology,
    positions: &'a [[f64; 3]],
    /// Unit normals by face; zero where there is none.
    normals: &'a [DVec3],
    is_sharp: Vec<bool>,
    /// By vertex, its sharp edges, those that are sharp for other reasons among them.
    counts: Vec<u32>,
}

/// The angle between two unit normals; 0 where one is zero.
pub(super) fn turn(a: DVec3, b: DVec3) -> f64 {
    math::atan2(a.cross(b).length(), a.dot(b))
}

impl<'a> SharpEdges<'a> {
    /// Edges that turn by more than an angle; `others` are the ends of edges that are sharp in any case.
    pub(super) fn above(
        angle: f64,
        (topology, positions, normals): (&'a Topology, &'a [[f64; 3]], &'a [DVec3]),
        others: impl Iterator<Item = [u32; 2]>,
    ) -> Self {
        let mut counts = vec![0; positions.len()];
        others
            .flatten()
            .for_each(|vertex| counts[vertex as usize] += 1);
        let is_sharp = vec![false; 3 * topology.face_count()];
        let mut found = Self {
            topology,
            positions,
            normals,
            is_sharp,
            counts,
        };
        for h in topology.half_edges() {
            if let Some(twin) = topology.twin(h).filter(|&twin| h < twin)
                && found.turn(h, twin) > angle
            {
                found.set(h, true);
            }
        }
        found
    }

    /// The creases without those that turn back.
    pub(super) fn without_needles(mut self, angle: f64) -> Self {
        let mut pending: Vec<VertexId> = self.topology.vertices().collect();
        // Taken from the end: in ascending order.
        pending.reverse();
        while let Some(vertex) = pending.pop() {
            let Some([after, before]) = self.needle(vertex) else {
                continue;
            };
            let [Some(beyond), Some(other)] = [after, before].map(|h| self.topology.twin(h)) else {
                continue;
            };
            let turns = [self.turn(after, beyond), self.turn(before, other)];
            let has_edge = self.turn(beyond, other) > angle;
            for (h, is_kept) in [(after, turns[0] >= turns[1]), (before, turns[0] < turns[1])] {
                if !(has_edge && is_kept) {
                    self.set(h, false);
                    pending.extend(self.topology.ends(h));
                }
            }
        }
        self
    }

    /// The edges, once each.
    pub(super) fn edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let is_first = |h: &HalfEdgeId| self.topology.twin(*h).is_some_and(|twin| *h < twin);
        self.topology
            .half_edges()
            .filter(|h| self.is_sharp[h.index()])
            .filter(is_first)
    }

    /// The half-edges of the triangle that leave a vertex and that enter it, if they are all its
    /// sharp edges and it is a needle's tip.
    fn needle(&self, vertex: VertexId) -> Option<[HalfEdgeId; 2]> {
        if self.counts[vertex.index()] != 2 || self.topology.is_boundary(vertex) {
            return None;
        }
        let mut leaving = self.topology.outgoing_ring(vertex);
        let after =
            leaving.find(|h| self.is_sharp[h.index()] && self.is_sharp[h.previous().index()])?;
        let at = |v: VertexId| vector(self.positions[v.index()]);
        let [tip, first] = self.topology.ends(after).map(at);
        let last = at(self.topology.origin(after.previous()));
        let (a, b) = (first - tip, last - tip);
        (a.dot(b) > TIP * a.length() * b.length()).then_some([after, after.previous()])
    }

    fn turn(&self, a: HalfEdgeId, b: HalfEdgeId) -> f64 {
        turn(
            self.normals[a.face().index()],
            self.normals[b.face().index()],
        )
    }

    fn set(&mut self, h: HalfEdgeId, is_sharp: bool) {
        for h in [Some(h), self.topology.twin(h)].into_iter().flatten() {
            self.is_sharp[h.index()] = is_sharp;
        }
        for vertex in self.topology.ends(h) {
            let count = &mut self.counts[vertex.index()];
            *count = if is_sharp {
                *count + 1
            } else {
                count.saturating_sub(1)
            };
        }
    }
}
