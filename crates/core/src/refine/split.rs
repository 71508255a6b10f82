//! One step of refinement on the topology: which edges are split, the numbers of the new elements,
//! and their connections. Knows no positions.

use crate::closure::{Diagonal, Pattern, closure};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{MAX_FACES, Mesh, MeshError, NONE, Topology};
use crate::parallel;
use crate::progress::{Cancelled, Watch};
use crate::refine::RefineError;

/// All three edges of a face are split.
pub(super) const ALL_EDGES: u8 = 0b111;
/// Set in addition to the edge bits where the diagonal starts at the unsplit edge's end.
const DIAGONAL_BIT: u8 = 0b1000;

/// Which edges of each face are split: bit `c` for the edge from corner `c`.
#[derive(Clone, Debug)]
pub(super) struct SplitEdges {
    faces: Vec<u8>,
}

/// The elements of a split mesh, numbered: old vertices keep their numbers, new ones follow in the
/// order of their edges' first half-edges; the triangles of a face are consecutive, in the order of
/// the faces.
pub(super) struct SplitTopology {
    /// The half-edge on which each new vertex stands (the lower of two twins).
    pub(super) edges: Vec<HalfEdgeId>,
    /// The new vertex on each half-edge; meaningless where it is not split.
    vertex_on: Vec<u32>,
    /// Start of each face's triangles, and their end.
    pub(super) starts: Vec<u32>,
}

impl SplitEdges {
    /// The edges of divisible faces, and with each edge all its copies in other sheets.
    pub(super) fn of_divisible(mesh: &Mesh, divisible: &[bool]) -> Self {
        let topology = mesh.topology();
        let faces = parallel::map(mesh.face_count(), |face| {
            if divisible[face] {
                return ALL_EDGES;
            }
            (0..3).fold(0, |bits, corner| {
                let twin = topology.twin(HalfEdgeId::of(FaceId(face as u32), corner));
                bits | u8::from(twin.is_some_and(|t| divisible[t.face().index()])) << corner
            })
        });
        let mut split = Self { faces };
        for group in mesh.junctions().edges.iter() {
            if group.iter().any(|&h| split.contains(HalfEdgeId(h))) {
                for h in group.iter().map(|&h| HalfEdgeId(h)) {
                    split.faces[h.face().index()] |= 1 << h.corner();
                }
            }
        }
        split
    }

    /// Whether the edge of `h` is split.
    #[inline]
    pub(super) fn contains(&self, h: HalfEdgeId) -> bool {
        self.faces[h.face().index()] & (1 << h.corner()) != 0
    }

    /// Number of split edges of `face`.
    #[inline]
    pub(super) fn count(&self, face: usize) -> usize {
        (self.faces[face] & ALL_EDGES).count_ones() as usize
    }

    /// Number of triangles after the split.
    pub(super) fn triangle_count(&self) -> usize {
        parallel::pieces(self.faces.len(), |piece| {
            piece.map(|f| 1 + self.count(f)).sum::<usize>()
        })
        .into_iter()
        .sum()
    }

    /// Number of indivisible faces by their split edges: the cases (a) to (d) of Figure 5.
    pub(super) fn closure_cases(&self, divisible: &[bool]) -> [usize; 4] {
        let of_piece = |piece: core::ops::Range<usize>| {
            let mut cases = [0; 4];
            piece
                .filter(|&face| !divisible[face])
                .for_each(|face| cases[self.count(face)] += 1);
            cases
        };
        let mut cases = [0; 4];
        for piece in parallel::pieces(divisible.len(), of_piece) {
            (0..4).for_each(|case| cases[case] += piece[case]);
        }
        cases
    }

    #[inline]
    pub(super) fn pattern(&self, face: usize) -> &'static Pattern {
        let bits = self.faces[face];
        let diagonal = if bits & DIAGONAL_BIT == 0 {
            Diagonal::FromStart
        } else {
            Diagonal::FromEnd
        };
        closure(bits, diagonal)
    }

    /// In every face with two split edges, cuts the quadrilateral by its shorter diagonal, or by the one from
    /// the vertex with the lower number where they are equally long.
    pub(super) fn choose_diagonals(
        &mut self,
        mesh: &Mesh,
        numbered: &SplitTopology,
        positions: &[[f64; 3]],
    ) {
        let between = |a: u32, b: u32| {
            let [a, b] = [a, b].map(|v| crate::vector::vector(positions[v as usize]));
            b - a
        };
        parallel::for_each_chunk(&mut self.faces, 4096, |chunk, faces| {
            for (i, bits) in faces.iter_mut().enumerate() {
                if bits.count_ones() != 2 {
                    continue;
                }
                let face = FaceId((chunk * 4096 + i) as u32);
                let unsplit = (!*bits & ALL_EDGES).trailing_zeros() as usize;
                let h = HalfEdgeId::of(face, unsplit);
                let [start, end] = mesh.topology().ends(h).map(|v| v.0);
                let after = numbered.vertex_on[h.next().index()];
                let before = numbered.vertex_on[h.previous().index()];
                let (from_start, from_end) = (between(start, after), between(end, before));
                // Scaled, so that squares neither vanish nor overflow.
                let size = from_start.abs().max(from_end.abs()).max_element();
                let [from_start, from_end] =
                    [from_start, from_end].map(|d| (d / size).length_squared());
                if from_end < from_start || (from_end == from_start && end < start) {
                    *bits |= DIAGONAL_BIT;
                }
            }
        });
    }
}

impl SplitTopology {
    /// Numbers the new vertices and triangles.
    ///
    /// # Errors
    /// There are more elements than `u32` half-edge indices allow, or the observer asked to stop.
    pub(super) fn number(
        mesh: &Mesh,
        split: &SplitEdges,
        watch: &mut Watch<'_>,
    ) -> Result<Self, RefineError> {
        let topology = mesh.topology();
        let needed = split.triangle_count();
        if needed > MAX_FACES {
            return Err(MeshError::TooMany {
                what: "faces",
                count: needed,
                limit: MAX_FACES,
            }
            .into());
        }
        let too_many = || MeshError::TooMany {
            what: "vertices",
            count: mesh.vertex_count() + topology.half_edge_count(),
            limit: u32::MAX as usize,
        };
        let is_first = |h: usize| {
            let h = HalfEdgeId(h as u32);
            split.contains(h) && topology.twin(h).is_none_or(|twin| h < twin)
        };
        let poll = &mut |_| watch.poll();
        let before =
            parallel::starts(topology.half_edge_count(), poll, |h| u32::from(is_first(h)))?
                .ok_or_else(too_many)?;
        let new_vertices = before.last().copied().unwrap_or(0) as usize;
        let old_vertices = mesh.vertex_count() as u32;
        old_vertices
            .checked_add(new_vertices as u32)
            .ok_or_else(too_many)?;

        let mut edges = limitmesh_pages::filled(HalfEdgeId(0), new_vertices);
        parallel::for_each_run(
            &before,
            &mut edges,
            &mut vec![(); new_vertices],
            poll,
            |h, slot, _| {
                if let [edge] = slot {
                    *edge = HalfEdgeId(h as u32);
                }
            },
        )?;
        let vertex_on = parallel::map_polled(topology.half_edge_count(), poll, |h| {
            let twin = topology.raw_twins()[h] as usize;
            old_vertices + before[h.min(twin)]
        })?;
        drop(before);
        let starts =
            parallel::starts(mesh.face_count(), poll, |face| 1 + split.count(face) as u32)?
                .ok_or_else(too_many)?;
        Ok(Self {
            edges,
            vertex_on,
            starts,
        })
    }

    /// The topology of the split mesh.
    pub(super) fn connect(
        &self,
        mesh: &Mesh,
        split: &SplitEdges,
        watch: &mut Watch<'_>,
    ) -> Result<Topology, Cancelled> {
        let topology = mesh.topology();
        let count = self.starts.last().copied().unwrap_or(0) as usize;
        let poll = &mut |_| watch.poll();
        let mut triangles = limitmesh_pages::defaults::<[u32; 3]>(count);
        let mut twins = limitmesh_pages::defaults::<[u32; 3]>(count);
        parallel::for_each_run(
            &self.starts,
            &mut triangles,
            &mut twins,
            poll,
            |face, triangles, twins| {
                let pattern = split.pattern(face);
                let first = 3 * self.starts[face];
                let labels = self.labels(topology, face);
                for (slot, labelled) in triangles.iter_mut().zip(pattern.triangles()) {
                    *slot = labelled.map(|label| labels[label as usize]);
                }
                let twins = twins.as_flattened_mut();
                for (h, slot) in twins.iter_mut().enumerate() {
                    if let Some(twin) = pattern.twin(h) {
                        *slot = first + twin as u32;
                    }
                }
                for corner in 0..3 {
                    let across = topology.twin(HalfEdgeId::of(FaceId(face as u32), corner));
                    // Seen from the neighbour the halves come in the other order.
                    let [second, first] = across.map_or([NONE; 2], |twin| self.halves(split, twin));
                    let [mine_first, mine_second] = pattern.border(corner);
                    twins[mine_first] = first;
                    twins[mine_second] = second;
                }
            },
        )?;
        let old = topology.vertex_count();
        let outgoing = parallel::map_polled(old + self.edges.len(), poll, |v| {
            if v < old {
                self.halves(split, topology.outgoing(VertexId(v as u32)))[0]
            } else {
                self.halves(split, self.edges[v - old])[1]
            }
        })?;
        Ok(Topology::from_parts(
            triangles,
            twins.into_flattened(),
            outgoing,
        ))
    }

    /// The half-edges of the split mesh along `h`: first and second half, or twice the same.
    #[inline]
    pub(super) fn halves(&self, split: &SplitEdges, h: HalfEdgeId) -> [u32; 2] {
        let face = h.face().index();
        let first = 3 * self.starts[face];
        split
            .pattern(face)
            .border(h.corner())
            .map(|local| first + local as u32)
    }

    /// The new vertex on `h`, which must be split.
    #[inline]
    pub(super) fn vertex_on(&self, h: HalfEdgeId) -> u32 {
        self.vertex_on[h.index()]
    }

    /// The vertices of the pattern's labels 0 to 5 in `face`.
    #[inline]
    fn labels(&self, topology: &Topology, face: usize) -> [u32; 6] {
        let [a, b, c] = topology.triangles()[face];
        let on = &self.vertex_on[3 * face..3 * face + 3];
        [a, b, c, on[0], on[1], on[2]]
    }
}
