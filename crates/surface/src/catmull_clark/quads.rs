//! Quads and how they are connected, with the sharpness of edges and vertices; it knows no positions.
//!
//! Half-edge 4q + i runs from corner i of quad q to the next. A step cuts each quad in four, numbered by its corners. Where each of
//! them begins follows from the diagonals: the halves of quads that the second and the fourth corner are joined by are cut by the
//! middles of their edges into halves of such quads again ([`crate::mesh::Topology::has_quads`]).

use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, NONE, Sharpness};
use crate::ring::{SharpRing, decremented};

/// The half-edges of the triangles that are halves of a quad, by the quad's half-edge.
const IN_HALVES: [u32; 4] = [0, 5, 3, 2];

/// The quad's half-edges by those of its halves; [`NONE`] on the diagonal.
const OF_HALVES: [u32; 6] = [0, NONE, 3, 2, NONE, 1];

/// Connected quads.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Quads {
    pub(crate) corners: Vec<[u32; 4]>,
    /// By half-edge, the other one along its edge, or [`NONE`].
    twins: Vec<u32>,
    /// The sharpness of edges by half-edge and of vertices, as bits; empty where all are smooth. Boundaries need none.
    sharp_edges: Vec<u64>,
    sharp_vertices: Vec<u64>,
}

/// The next half-edge of the same quad.
#[inline]
pub(crate) fn next(h: u32) -> u32 {
    h & !3 | (h + 1) & 3
}

/// The previous half-edge of the same quad.
#[inline]
pub(crate) fn previous(h: u32) -> u32 {
    h & !3 | (h + 3) & 3
}

/// The half-edge of a quad that runs along one of its halves, not on the diagonal.
#[inline]
pub(crate) fn of_half(h: HalfEdgeId) -> Option<u32> {
    let place = OF_HALVES[h.0 as usize % 6];
    (place != NONE).then(|| 4 * (h.0 / 6) + place)
}

/// The half-edge of the quad that begins at the right angle of a half.
pub(crate) fn of_face(face: FaceId) -> u32 {
    4 * (face.0 / 2) + 2 * (face.0 % 2)
}

/// The half-edge of the quad that begins at the vertex that a half-edge of one of its halves leaves.
pub(crate) fn spoke(h: HalfEdgeId) -> u32 {
    4 * (h.0 / 6) + [0, 1, 3, 2, 3, 1][h.0 as usize % 6]
}

/// The half-edge of a quad's half that runs along an edge of the quad.
#[inline]
pub(crate) fn in_half(h: u32) -> HalfEdgeId {
    HalfEdgeId(6 * (h / 4) + IN_HALVES[h as usize % 4])
}

/// The corners of quads as the pairs of triangles that are their halves.
pub(crate) fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, d], [c, d, b]]
}

/// Connected quads, wherever they are kept.
pub(crate) trait Connected {
    /// The vertex that a half-edge leaves.
    fn origin(&self, h: u32) -> u32;

    /// The other half-edge along an edge; `None` on a boundary.
    fn twin(&self, h: u32) -> Option<u32>;

    /// The sharpness of an edge; infinite on a boundary.
    fn edge(&self, h: u32) -> f64;

    /// The sharpness of a vertex by its tag.
    fn vertex(&self, vertex: u32) -> f64;

    /// The half-edges that leave the origin of one, counter-clockwise, from it on.
    fn around(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        core::iter::successors(Some(first), move |&h| {
            self.twin(previous(h)).filter(|&next| next != first)
        })
    }

    /// The ring of the vertex that a half-edge leaves, and its points as [`super::ring`] numbers them. A closed ring begins with that
    /// half-edge.
    fn ring(&self, h: u32) -> (SharpRing, Vec<u32>) {
        let vertex = self.origin(h);
        let first = self.first(h);
        let spokes: Vec<u32> = self.around(first).collect();
        let last = spokes[spokes.len() - 1];
        let open = self.twin(previous(last)).is_none();
        let mut points = vec![vertex];
        points.extend(spokes.iter().map(|&h| self.origin(next(h))));
        let mut sharpness: Vec<f64> = spokes.iter().map(|&h| self.edge(h)).collect();
        if open {
            points.push(self.origin(previous(last)));
            sharpness.push(f64::INFINITY);
        }
        points.extend(spokes.iter().map(|&h| self.origin(next(next(h)))));
        let ring = SharpRing {
            open,
            vertex: self.vertex(vertex),
            spokes: sharpness,
        };
        (ring, points)
    }

    /// The half-edge with which the ring at the origin of one begins: the first of an open ring.
    fn first(&self, h: u32) -> u32 {
        let mut first = h;
        while let Some(twin) = self.twin(first) {
            first = next(twin);
            if first == h {
                break;
            }
        }
        first
    }

    /// The quad that a half-edge begins, and those at its corners, with their own vertices and the vertex that each of them is. What
    /// is sharp counts at its corners alone, as nothing else decides the surface over it.
    fn surroundings(&self, first: u32) -> (Quads, Vec<u32>) {
        let own = [first, next(first), next(next(first)), previous(first)];
        let mut quads = vec![first];
        for h in own {
            for spoke in self.around(self.first(h)) {
                if quads.iter().all(|&known| known / 4 != spoke / 4) {
                    quads.push(spoke);
                }
            }
        }
        let source = |h: u32| quads[h as usize / 4] & !3 | (quads[h as usize / 4] + h) & 3;
        let place = |h: u32| {
            let quad = quads.iter().position(|&known| known / 4 == h / 4)?;
            Some(4 * quad as u32 + ((h + 4 - quads[quad] % 4) & 3))
        };
        let half_edges = 0..4 * quads.len() as u32;
        let mut sources: Vec<u32> = Vec::new();
        let mut number = |vertex: u32| match sources.iter().position(|&known| known == vertex) {
            Some(number) => number as u32,
            None => {
                sources.push(vertex);
                sources.len() as u32 - 1
            }
        };
        let vertices: Vec<u32> = half_edges
            .clone()
            .map(|h| number(self.origin(source(h))))
            .collect();
        let twins: Vec<u32> = half_edges
            .clone()
            .map(|h| self.twin(source(h)).and_then(place).unwrap_or(NONE))
            .collect();
        let is_corner = |vertex: u32| own.iter().any(|&h| self.origin(h) == vertex);
        let edge = |h: u32| {
            let ends = [source(h), next(source(h))].map(|h| self.origin(h));
            let counts = self.twin(source(h)).is_some() && ends.into_iter().any(is_corner);
            if counts { self.edge(source(h)) } else { 0.0 }
        };
        let sharp_edges: Vec<u64> = half_edges.map(|h| edge(h).to_bits()).collect();
        let vertex = |&v: &u32| if is_corner(v) { self.vertex(v) } else { 0.0 };
        let sharp_vertices: Vec<u64> = sources.iter().map(|v| vertex(v).to_bits()).collect();
        let unless_smooth = |all: Vec<u64>| {
            if all.iter().all(|&bits| bits == 0) {
                Vec::new()
            } else {
                all
            }
        };
        let surroundings = Quads {
            corners: vertices.as_chunks::<4>().0.to_vec(),
            twins,
            sharp_edges: unless_smooth(sharp_edges),
            sharp_vertices: unless_smooth(sharp_vertices),
        };
        (surroundings, sources)
    }
}

/// The quads of a mesh that has them.
#[derive(Clone, Copy)]
pub(crate) struct MeshQuads<'m> {
    pub(crate) mesh: &'m Mesh,
    pub(crate) sharpness: &'m Sharpness<'m>,
}

impl MeshQuads<'_> {
    /// A half-edge that leaves a vertex.
    pub(crate) fn outgoing(&self, vertex: VertexId) -> u32 {
        let mut ring = self.mesh.topology().outgoing_ring(vertex);
        ring.find_map(of_half).unwrap_or(NONE)
    }
}

impl Connected for MeshQuads<'_> {
    fn origin(&self, h: u32) -> u32 {
        self.mesh.topology().origin(in_half(h)).0
    }

    fn twin(&self, h: u32) -> Option<u32> {
        self.mesh.topology().twin(in_half(h)).and_then(of_half)
    }

    fn edge(&self, h: u32) -> f64 {
        self.sharpness.edge(in_half(h))
    }

    fn vertex(&self, vertex: u32) -> f64 {
        self.sharpness.vertex(VertexId(vertex))
    }
}

impl Connected for Quads {
    #[inline]
    fn origin(&self, h: u32) -> u32 {
        self.corners.as_flattened()[h as usize]
    }

    #[inline]
    fn twin(&self, h: u32) -> Option<u32> {
        Some(self.twins[h as usize]).filter(|&twin| twin != NONE)
    }

    fn edge(&self, h: u32) -> f64 {
        match self.twin(h) {
            None => f64::INFINITY,
            Some(_) => self
                .sharp_edges
                .get(h as usize)
                .map_or(0.0, |&bits| f64::from_bits(bits)),
        }
    }

    fn vertex(&self, vertex: u32) -> f64 {
        let bits = self.sharp_vertices.get(vertex as usize);
        bits.map_or(0.0, |&bits| f64::from_bits(bits))
    }
}

impl Quads {
    /// All of it in words, which no other quads have.
    pub(crate) fn words(&self) -> Vec<u32> {
        let own = self.corners.as_flattened().iter().chain(&self.twins);
        let sharp = self.sharp_edges.iter().chain(&self.sharp_vertices);
        let sharp = sharp.flat_map(|&bits| [bits as u32, (bits >> 32) as u32]);
        let lengths = [self.corners.len(), self.sharp_edges.len()].map(|length| length as u32);
        lengths
            .into_iter()
            .chain(own.copied())
            .chain(sharp)
            .collect()
    }

    pub(crate) fn vertex_count(&self) -> usize {
        let greatest = self.corners.as_flattened().iter().max();
        greatest.map_or(0, |&vertex| vertex as usize + 1)
    }

    /// A half-edge that leaves a vertex.
    pub(crate) fn outgoing(&self, vertex: u32) -> Option<u32> {
        let mut corners = self.corners.as_flattened().iter();
        Some(corners.position(|&corner| corner == vertex)? as u32)
    }

    /// The connectivity after a step, and the half-edges on whose edges its new vertices stand. After the old vertices come those on
    /// edges, then those in quads.
    pub(crate) fn refined(&self) -> (Self, Vec<u32>) {
        let quads = self.corners.len() as u32;
        let is_first = |&h: &u32| self.twin(h).is_none_or(|twin| h < twin);
        let edges: Vec<u32> = (0..4 * quads).filter(is_first).collect();
        let mut on_edges = vec![NONE; 4 * quads as usize];
        let before = self.vertex_count() as u32;
        for (vertex, &h) in (before..).zip(&edges) {
            on_edges[h as usize] = vertex;
            self.twin(h)
                .into_iter()
                .for_each(|twin| on_edges[twin as usize] = vertex);
        }
        let first_inside = before + edges.len() as u32;
        let (mut corners, mut twins) = (Vec::new(), vec![NONE; 16 * quads as usize]);
        for (quad, &[a, b, c, d]) in (0..).zip(&self.corners) {
            let [k, l, m, n] = [0, 1, 2, 3].map(|i| on_edges[4 * quad as usize + i]);
            let f = first_inside + quad;
            corners.extend([[a, k, f, n], [k, b, l, f], [c, m, f, l], [n, f, m, d]]);
            for [own, other] in [[1, 7], [2, 12], [6, 10], [9, 13]] {
                let [own, other] = [own, other].map(|h| 16 * quad + h);
                (twins[own as usize], twins[other as usize]) = (other, own);
            }
        }
        for h in 0..4 * quads {
            if let Some(twin) = self.twin(h) {
                let ([first, second], [other_first, other_second]) = (parts(h), parts(twin));
                (twins[first as usize], twins[second as usize]) = (other_second, other_first);
            }
        }
        let less = |bits: u64| decremented(f64::from_bits(bits)).to_bits();
        let mut sharp_edges = Vec::new();
        if !self.sharp_edges.is_empty() {
            sharp_edges.resize(twins.len(), 0);
        }
        for (h, &bits) in (0..).zip(&self.sharp_edges) {
            parts(h)
                .into_iter()
                .for_each(|part| sharp_edges[part as usize] = less(bits));
        }
        let mut sharp_vertices: Vec<u64> =
            self.sharp_vertices.iter().map(|&bits| less(bits)).collect();
        if !sharp_vertices.is_empty() {
            sharp_vertices.resize((first_inside + quads) as usize, 0);
        }
        let refined = Self {
            corners,
            twins,
            sharp_edges,
            sharp_vertices,
        };
        (refined, edges)
    }
}

/// The halves of a half-edge after a step, in its order.
fn parts(h: u32) -> [u32; 2] {
    const PARTS: [[u32; 2]; 4] = [[0, 4], [5, 11], [8, 14], [15, 3]];
    PARTS[h as usize % 4].map(|part| 16 * (h / 4) + part)
}
