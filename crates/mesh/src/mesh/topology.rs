//! Half-edge connectivity of a manifold, oriented triangle mesh; it knows no positions.
//!
//! Half-edge `h = 3·face + corner` runs from that corner to the next one, so that next, previous and face are
//! arithmetic; only the twins and one outgoing half-edge a vertex are stored. Invariants (see
//! [`Topology::validate`]): twins are mutual and run the opposite way; the faces at a vertex form one fan; the
//! outgoing half-edge stored for a boundary vertex is the one without a twin, so that turning counter-clockwise
//! from it meets every face.

use core::ops::Range;

use super::MeshError;
use crate::geometry::{EdgeSide, NONE, every_edge};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::parallel::{self, Poll};
use crate::progress::{Cancelled, uncancelled};

/// Faces that half-edge indices can number: 3·faces − 1 must stay below [`NONE`].
#[doc(hidden)]
pub const MAX_FACES: usize = (u32::MAX as usize) / 3 - 1;

/// Connectivity of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Topology {
    triangles: Vec<[u32; 3]>,
    twins: Vec<u32>,
    outgoing: Vec<u32>,
    /// Whether faces 2q and 2q + 1 are the halves of a quad.
    has_quads: bool,
}

impl Topology {
    /// Connects triangles over `vertex_count` vertices.
    ///
    /// # Errors
    /// Those of [`super::Mesh::from_triangles`], except for positions.
    pub fn from_triangles(
        triangles: Vec<[u32; 3]>,
        vertex_count: usize,
    ) -> Result<Self, MeshError> {
        check_indices(&triangles, vertex_count)?;
        let twins = match_twins(&triangles, vertex_count)?;
        let outgoing = outgoing_half_edges(&triangles, &twins, vertex_count);
        let topology = Self {
            triangles,
            twins,
            outgoing,
            has_quads: false,
        };
        topology.check_fans()?;
        Ok(topology)
    }

    /// Takes the parts unchecked; the caller guarantees the invariants.
    #[doc(hidden)]
    pub fn from_parts(triangles: Vec<[u32; 3]>, twins: Vec<u32>, outgoing: Vec<u32>) -> Self {
        Self {
            triangles,
            twins,
            outgoing,
            has_quads: false,
        }
    }

    /// The same triangles as halves of quads: faces 2q and 2q + 1 share a diagonal, which is the second edge of both.
    ///
    /// # Errors
    /// Two such faces share no diagonal.
    pub fn with_quads(mut self) -> Result<Self, MeshError> {
        self.has_quads = true;
        self.check_quads()?;
        Ok(self)
    }

    fn check_quads(&self) -> Result<(), MeshError> {
        let is_half = |&face: &usize| {
            let (own, other) = (face as u32, face as u32 ^ 1);
            self.twins[3 * face + 1] == 3 * other + 1 && own != other
        };
        let wrong = (0..self.face_count()).find(|face| !is_half(face));
        wrong.map_or(Ok(()), |face| {
            Err(MeshError::Broken {
                place: format!("face {face}"),
                what: "the second edges of faces 2q and 2q + 1 are one diagonal",
            })
        })
    }

    /// Whether the faces are halves of quads: 2q and 2q + 1 those of quad q, whose diagonal is the second edge of both.
    #[inline]
    pub fn has_quads(&self) -> bool {
        self.has_quads
    }

    /// The half-edges on both sides of each quad's diagonal; none without quads.
    pub fn quads(&self) -> impl Iterator<Item = [HalfEdgeId; 2]> {
        let quads = if self.has_quads {
            self.face_count() as u32 / 2
        } else {
            0
        };
        (0..quads).map(|quad| [6 * quad + 1, 6 * quad + 4].map(HalfEdgeId))
    }

    /// Whether a half-edge runs along the diagonal of a quad.
    #[inline]
    pub fn is_diagonal(&self, h: HalfEdgeId) -> bool {
        self.has_quads && h.corner() == 1
    }

    /// Number of vertices.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.outgoing.len()
    }

    /// Number of faces.
    #[inline]
    pub fn face_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of half-edges: three a face.
    #[inline]
    pub fn half_edge_count(&self) -> usize {
        self.twins.len()
    }

    /// Number of edges: a pair of twins counts once.
    pub fn edge_count(&self) -> usize {
        self.half_edges()
            .filter(|&h| self.twin(h).is_none_or(|twin| h < twin))
            .count()
    }

    /// All half-edges, in order.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> + use<> {
        (0..self.twins.len() as u32).map(HalfEdgeId)
    }

    /// All vertices, in order.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + use<> {
        (0..self.outgoing.len() as u32).map(VertexId)
    }

    /// The triangles without the connections.
    pub(crate) fn into_triangles(self) -> Vec<[u32; 3]> {
        self.triangles
    }

    /// Vertex indices of each face.
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The position of a half-edge among those at its origin, in the order of [`Self::outgoing_ring`].
    #[doc(hidden)]
    pub fn slot(&self, h: HalfEdgeId) -> usize {
        self.outgoing_ring(self.origin(h))
            .take_while(|&other| other != h)
            .count()
    }

    /// The half-edge along this edge in the neighbouring face; `None` on a boundary.
    #[inline]
    pub fn twin(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let twin = self.twins[h.index()];
        (twin != NONE).then_some(HalfEdgeId(twin))
    }

    /// Twins of all half-edges, [`NONE`] on boundaries.
    #[inline]
    #[doc(hidden)]
    pub fn raw_twins(&self) -> &[u32] {
        &self.twins
    }

    /// The vertex that `h` leaves.
    #[inline]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        VertexId(self.triangles.as_flattened()[h.index()])
    }

    /// The vertex that `h` reaches.
    #[inline]
    pub fn target(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.next())
    }

    /// The vertex of the face of `h` that is not on `h`.
    #[inline]
    pub fn opposite(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.previous())
    }

    /// Origin and target of `h`.
    #[inline]
    pub fn ends(&self, h: HalfEdgeId) -> [VertexId; 2] {
        [self.origin(h), self.target(h)]
    }

    /// A half-edge that leaves `vertex`; for a boundary vertex the one that lies on the boundary.
    #[inline]
    pub fn outgoing(&self, vertex: VertexId) -> HalfEdgeId {
        HalfEdgeId(self.outgoing[vertex.index()])
    }

    /// Whether `vertex` lies on a boundary.
    #[inline]
    pub fn is_boundary(&self, vertex: VertexId) -> bool {
        self.twins[self.outgoing[vertex.index()] as usize] == NONE
    }

    /// The neighbours of `vertex`, counter-clockwise; at a boundary from one boundary neighbour to the other.
    #[inline]
    pub fn ring(&self, vertex: VertexId) -> RingNeighbours<'_> {
        let first = self.outgoing(vertex);
        RingNeighbours {
            topology: self,
            first: first.0,
            next: first.0,
            last: NONE,
        }
    }

    /// The outgoing half-edges of `vertex`, counter-clockwise: one for each face.
    #[inline]
    pub fn outgoing_ring(
        &self,
        vertex: VertexId,
    ) -> impl Iterator<Item = HalfEdgeId> + Clone + use<'_> {
        self.outgoing_from(self.outgoing(vertex))
    }

    /// `first` and the outgoing half-edges that follow it counter-clockwise at its origin, as far as the faces reach.
    #[inline]
    #[doc(hidden)]
    pub fn outgoing_from(
        &self,
        first: HalfEdgeId,
    ) -> impl Iterator<Item = HalfEdgeId> + Clone + use<'_> {
        core::iter::successors(Some(first), move |h| {
            self.twin(h.previous()).filter(|&next| next != first)
        })
    }

    /// The number of edges at `vertex` and whether its ring is open.
    #[inline]
    pub fn valence_and_openness(&self, vertex: VertexId) -> (u32, bool) {
        let faces = self.outgoing_ring(vertex).count() as u32;
        let open = self.is_boundary(vertex);
        (faces + u32::from(open), open)
    }

    /// A half-edge along the edge between `a` and `b`, whichever way it runs.
    pub fn edge_between(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        let along = |h: HalfEdgeId, to: VertexId| {
            if self.target(h) == to {
                Some(h)
            } else if self.opposite(h) == to {
                Some(h.previous())
            } else {
                None
            }
        };
        // Round both ends together, so that the lower valence decides the time.
        let mut around_both = self.outgoing_ring(a).zip(self.outgoing_ring(b));
        around_both.find_map(|(from_a, from_b)| along(from_a, b).or_else(|| along(from_b, a)))
    }

    /// Vertices − edges + faces.
    pub fn euler_characteristic(&self) -> i64 {
        self.vertex_count() as i64 - self.edge_count() as i64 + self.face_count() as i64
    }

    /// Number of half-edges without a twin.
    pub fn boundary_edge_count(&self) -> usize {
        let open = |half_edges: Range<usize>| {
            self.twins[half_edges]
                .iter()
                .map(|&twin| usize::from(twin == NONE))
                .sum::<usize>()
        };
        parallel::pieces(self.twins.len(), open).into_iter().sum()
    }

    /// Checks every invariant.
    ///
    /// # Errors
    /// The first element that breaks one.
    pub fn validate(&self) -> Result<(), MeshError> {
        check_indices(&self.triangles, self.vertex_count())?;
        if self.has_quads {
            self.check_quads()?;
        }
        let broken = |place: String, what| Err(MeshError::Broken { place, what });
        if self.twins.len() != 3 * self.triangles.len() {
            return broken(
                format!("{} twins", self.twins.len()),
                "each face has three half-edges",
            );
        }
        for h in self.half_edges() {
            let twin = self.twins[h.index()];
            if twin == NONE {
                continue;
            }
            if twin as usize >= self.twins.len() {
                return broken(h.to_string(), "a twin is a half-edge of the mesh");
            }
            let twin = HalfEdgeId(twin);
            if self.twin(twin) != Some(h) || twin == h {
                return broken(h.to_string(), "twins are mutual");
            }
            if self.origin(h) != self.target(twin) || self.target(h) != self.origin(twin) {
                return broken(
                    h.to_string(),
                    "twins run along one edge in opposite directions",
                );
            }
        }
        for v in self.vertices() {
            let h = self.outgoing[v.index()];
            if h == NONE {
                return Err(MeshError::Isolated { vertex: v.index() });
            }
            if h as usize >= self.twins.len() || self.origin(HalfEdgeId(h)) != v {
                return broken(v.to_string(), "its outgoing half-edge leaves it");
            }
        }
        let twins = match_twins(&self.triangles, self.vertex_count())?;
        if let Some(h) = (0..twins.len()).find(|&h| twins[h] != self.twins[h]) {
            return broken(
                HalfEdgeId(h as u32).to_string(),
                "half-edges between the same vertices are twins",
            );
        }
        self.check_fans()
    }

    /// Checks that turning round each vertex meets all its faces.
    fn check_fans(&self) -> Result<(), MeshError> {
        let mut faces = vec![0u32; self.vertex_count()];
        for &v in self.triangles.as_flattened() {
            faces[v as usize] += 1;
        }
        for v in self.vertices() {
            if self.outgoing[v.index()] == NONE {
                return Err(MeshError::Isolated { vertex: v.index() });
            }
            // A ring that never came back would be longer than the vertex has faces.
            let limit = faces[v.index()] as usize + 1;
            let met = self.outgoing_ring(v).take(limit).count();
            if met != faces[v.index()] as usize {
                return Err(MeshError::BowTie {
                    vertex: v.index(),
                    fans: self.count_fans(v),
                });
            }
        }
        Ok(())
    }

    /// Number of separate fans of faces at `vertex`.
    fn count_fans(&self, vertex: VertexId) -> usize {
        let at_vertex: Vec<HalfEdgeId> = self
            .half_edges()
            .filter(|&h| self.origin(h) == vertex)
            .collect();
        let mut met = vec![false; at_vertex.len()];
        let mut fans = 0;
        for i in 0..at_vertex.len() {
            fans += usize::from(!met[i]);
            let mut pending = vec![i];
            while let Some(j) = pending.pop() {
                if core::mem::replace(&mut met[j], true) {
                    continue;
                }
                let h = at_vertex[j];
                let neighbours = [self.twin(h.previous()), self.twin(h).map(HalfEdgeId::next)];
                // The half-edges were collected in ascending order.
                let places = neighbours
                    .into_iter()
                    .flatten()
                    .map(|n| at_vertex.binary_search(&n));
                pending.extend(places.flatten());
            }
        }
        fans
    }
}

/// The neighbours of a vertex in counter-clockwise order.
#[derive(Clone, Debug)]
pub struct RingNeighbours<'a> {
    topology: &'a Topology,
    first: u32,
    next: u32,
    /// The last neighbour of an open ring, once its half-edges are used up.
    last: u32,
}

impl Iterator for RingNeighbours<'_> {
    type Item = VertexId;

    #[inline]
    fn next(&mut self) -> Option<VertexId> {
        if self.next == NONE {
            let last = core::mem::replace(&mut self.last, NONE);
            return (last != NONE).then_some(VertexId(last));
        }
        let h = HalfEdgeId(self.next);
        let before = h.previous();
        let turned = self.topology.twins[before.index()];
        if turned == NONE {
            self.last = self.topology.origin(before).0;
        }
        self.next = if turned == self.first { NONE } else { turned };
        Some(self.topology.target(h))
    }
}

fn check_indices(triangles: &[[u32; 3]], vertex_count: usize) -> Result<(), MeshError> {
    if triangles.len() > MAX_FACES {
        return Err(MeshError::TooMany {
            what: "faces",
            count: triangles.len(),
            limit: MAX_FACES,
        });
    }
    if vertex_count > NONE as usize {
        let limit = NONE as usize;
        return Err(MeshError::TooMany {
            what: "vertices",
            count: vertex_count,
            limit,
        });
    }
    for (face, &[a, b, c]) in triangles.iter().enumerate() {
        for v in [a, b, c] {
            if v as usize >= vertex_count {
                return Err(MeshError::VertexOutOfRange {
                    face,
                    vertex: u64::from(v),
                    count: vertex_count,
                });
            }
        }
        if a == b || a == c {
            return Err(MeshError::RepeatedCorner {
                face,
                vertex: a as usize,
            });
        }
        if b == c {
            return Err(MeshError::RepeatedCorner {
                face,
                vertex: b as usize,
            });
        }
    }
    Ok(())
}

/// Finds the twin of every half-edge.
fn match_twins(triangles: &[[u32; 3]], vertex_count: usize) -> Result<Vec<u32>, MeshError> {
    let origins = triangles.as_flattened();
    let mut twins = limitmesh_pages::filled(NONE, origins.len());
    let mut twice = None;
    every_edge(triangles, vertex_count, |_, edge| {
        let from = |side: &EdgeSide| origins[side.side as usize];
        match edge {
            [_] => {}
            [a, b] if from(a) != from(b) => {
                (twins[a.side as usize], twins[b.side as usize]) = (b.side, a.side);
            }
            // Of two half-edges in one direction, or of three or more, two have equal origins.
            _ if twice.is_none() => {
                twice = (1..edge.len())
                    .find(|&i| edge[..i].iter().any(|e| from(e) == from(&edge[i])))
                    .map(|i| edge[i].side);
            }
            _ => {}
        }
    });
    match twice.map(HalfEdgeId) {
        None => Ok(twins),
        Some(h) => Err(MeshError::EdgeUsedTwice {
            from: origins[h.index()] as usize,
            to: origins[h.next().index()] as usize,
            face: h.face().index(),
        }),
    }
}

/// One outgoing half-edge a vertex, the boundary one where there is one; [`NONE`] for isolated vertices.
#[doc(hidden)]
pub fn outgoing_half_edges(triangles: &[[u32; 3]], twins: &[u32], vertex_count: usize) -> Vec<u32> {
    uncancelled(|_| outgoing_half_edges_polled(triangles, twins, vertex_count, &mut |_| Ok(())))
}

/// [`outgoing_half_edges`] that can be cancelled.
#[doc(hidden)]
pub fn outgoing_half_edges_polled(
    triangles: &[[u32; 3]],
    twins: &[u32],
    vertex_count: usize,
    poll: &mut Poll<'_>,
) -> Result<Vec<u32>, Cancelled> {
    let origins = triangles.as_flattened();
    let mut outgoing = limitmesh_pages::filled(NONE, vertex_count);
    // From the last to the first: which of a vertex's half-edges comes first no branch has to guess.
    for (piece, origins) in origins.chunks(POLLED).enumerate().rev() {
        let first = piece * POLLED;
        poll((triangles.len() - first / 3) / 2)?;
        let numbered = origins.iter().enumerate().rev();
        numbered.for_each(|(at, &vertex)| outgoing[vertex as usize] = (first + at) as u32);
    }
    for (piece, twins) in twins.chunks(POLLED).enumerate() {
        let first = piece * POLLED;
        poll((triangles.len() + first / 3) / 2)?;
        if twins.contains(&NONE) {
            let numbered = (first..).zip(twins).filter(|&(_, &twin)| twin == NONE);
            numbered.for_each(|(h, _)| outgoing[origins[h] as usize] = h as u32);
        }
    }
    Ok(outgoing)
}

/// Half-edges between two calls of an observer.
const POLLED: usize = 1 << 18;

/// The triangle's faces as ids, for callers that walk them.
impl Topology {
    /// All faces, in order.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + use<> {
        (0..self.triangles.len() as u32).map(FaceId)
    }
}

#[cfg(test)]
mod tests;
