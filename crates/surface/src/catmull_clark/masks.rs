//! The points of a step over a mesh of quads: of its vertices, of its edges, and of its quads, which stand on the diagonals.

use super::quads::{Connected, MeshQuads, in_half, next, of_half};
use super::ring::vertex_weights;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::vector::{DVec3, vector};

/// The rules for one mesh.
pub(crate) struct QuadMasks<'m> {
    mesh: &'m Mesh,
    sharpness: Sharpness<'m>,
}

impl<'m> QuadMasks<'m> {
    pub(crate) fn of(mesh: &'m Mesh) -> Self {
        Self {
            mesh,
            sharpness: Sharpness::of(mesh),
        }
    }

    fn quads(&self) -> MeshQuads<'_> {
        MeshQuads {
            mesh: self.mesh,
            sharpness: &self.sharpness,
        }
    }

    fn at(&self, vertex: u32) -> DVec3 {
        vector(self.mesh.positions()[vertex as usize])
    }

    /// Where a vertex moves.
    pub(crate) fn vertex_point(&self, vertex: VertexId) -> DVec3 {
        let quads = self.quads();
        let first = quads.outgoing(vertex);
        let is_smooth =
            !self.sharpness.is_tagged(vertex) && !self.mesh.topology().is_boundary(vertex);
        if is_smooth {
            let (mut edges, mut opposite, mut n) = (DVec3::ZERO, DVec3::ZERO, 0.0);
            for h in quads.around(first) {
                edges += self.at(quads.origin(next(h)));
                opposite += self.at(quads.origin(next(next(h))));
                n += 1.0;
            }
            let own = (1.0 - 1.75 / n) * self.at(vertex.0);
            return own + (1.5 * edges + 0.25 * opposite) / (n * n);
        }
        let (ring, points) = quads.ring(first);
        let weights = vertex_weights(&ring);
        let points = weights.iter().zip(points);
        points.map(|(&weight, v)| weight * self.at(v)).sum()
    }

    /// The new point on an edge of a half: in the middle of its quad if that is the diagonal.
    pub(crate) fn edge_point(&self, h: HalfEdgeId) -> DVec3 {
        let topology = self.mesh.topology();
        if topology.is_diagonal(h) {
            return self.centroid(4 * (h.0 / 6));
        }
        let middle = topology.ends(h).map(|v| self.at(v.0));
        let middle = 0.5 * (middle[0] + middle[1]);
        let sharp = self.sharpness.edge(h).min(1.0);
        let sides = [Some(h), topology.twin(h)].map(|h| h.and_then(of_half));
        let [Some(left), Some(right)] = sides else {
            return middle;
        };
        if sharp == 1.0 {
            return middle;
        }
        let faces = 0.5 * (self.centroid(left) + self.centroid(right));
        sharp * middle + (1.0 - sharp) * 0.5 * (middle + faces)
    }

    fn centroid(&self, h: u32) -> DVec3 {
        let quad = h & !3;
        let corner = |i: u32| self.at(self.mesh.topology().origin(in_half(quad + i)).0);
        0.25 * ((corner(0) + corner(1)) + (corner(2) + corner(3)))
    }
}
