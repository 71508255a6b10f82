//! Limit positions and normals of the vertices of a mesh of quads.

use core::f64::consts::PI;
use std::borrow::Cow;
use std::sync::OnceLock;

use smallvec::SmallVec;

use super::sides::{SidedNormals, area_weighted_normal};
use crate::catmull_clark::quads::{Connected, MeshQuads, in_half, next, of_half, previous, spoke};
use crate::catmull_clark::ring::{RingLimits, RingSide};
use crate::catmull_clark::step::slot;
use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::{self, Poll};
use crate::progress::Cancelled;
use crate::ring::{SharpRing, VertexRule};
use crate::row::{Row, summed};
use crate::vector::{DVec3, unit_or_zero, vector};

/// Vertices between two calls of an observer, in each thread.
const POLLED: usize = 1 << 10;

/// Two tangents whose lengths and sine are above this part of what they are sums of span a plane whatever rounding does.
const CLEAR: f64 = 1e-12;

/// Limits of smooth vertices with fewer edges are kept.
const KEPT: usize = 16;

/// The limits of a mesh of quads.
pub(crate) struct QuadLimits<'m> {
    quads: MeshQuads<'m>,
    /// By the number of edges.
    smooth: [OnceLock<RingLimits>; KEPT],
}

/// The ring of a vertex, with its limits and its points.
struct Ring<'a> {
    limits: Cow<'a, RingLimits>,
    /// Half-edges that leave the vertex, one a quad.
    spokes: Vec<u32>,
    edges: usize,
    /// Whether nothing at it is sharp.
    is_smooth: bool,
    points: Points,
}

type Points = SmallVec<[DVec3; 17]>;

impl<'m> QuadLimits<'m> {
    pub(crate) fn of(mesh: &'m Mesh, sharpness: &'m Sharpness<'m>) -> Self {
        Self {
            quads: MeshQuads { mesh, sharpness },
            smooth: [const { OnceLock::new() }; KEPT],
        }
    }

    fn ring(&self, vertex: VertexId) -> Ring<'_> {
        let first = self.quads.outgoing(vertex);
        self.smooth_ring(vertex, first)
            .unwrap_or_else(|| self.ring_at(first))
    }

    /// The ring of a vertex where nothing is sharp, as almost everywhere, without its spokes.
    fn smooth_ring(&self, vertex: VertexId, first: u32) -> Option<Ring<'_>> {
        let MeshQuads { mesh, sharpness } = self.quads;
        if sharpness.is_tagged(vertex) || mesh.topology().is_boundary(vertex) {
            return None;
        }
        let at = |h: u32| vector(mesh.positions()[self.quads.origin(h) as usize]);
        let mut points = Points::from_elem(at(first), 1);
        let mut opposite = Points::new();
        for h in self.quads.around(first) {
            points.push(at(next(h)));
            opposite.push(at(next(next(h))));
        }
        let edges = opposite.len();
        points.append(&mut opposite);
        let of_edges = || {
            RingLimits::of(&SharpRing {
                open: false,
                vertex: 0.0,
                spokes: vec![0.0; edges],
            })
        };
        Some(Ring {
            limits: Cow::Borrowed(self.smooth.get(edges)?.get_or_init(of_edges)),
            spokes: Vec::new(),
            edges,
            is_smooth: true,
            points,
        })
    }

    /// The ring of the vertex that a half-edge leaves. A closed one begins with it.
    fn ring_at(&self, first: u32) -> Ring<'_> {
        let (ring, points) = self.quads.ring(first);
        let at = |v: u32| vector(self.quads.mesh.positions()[v as usize]);
        Ring {
            limits: Cow::Owned(RingLimits::of(&ring)),
            spokes: self.quads.around(self.quads.first(first)).collect(),
            edges: ring.spokes.len(),
            is_smooth: ring.rule() == VertexRule::Smooth,
            points: points.into_iter().map(at).collect(),
        }
    }

    /// The weights of a vertex's limit position.
    pub(crate) fn row(&self, vertex: VertexId) -> Row {
        let (ring, points) = self.quads.ring(self.quads.outgoing(vertex));
        let weights = RingLimits::of(&ring).position;
        summed(points.into_iter().zip(weights).collect())
    }

    /// The limit position of a vertex.
    pub(crate) fn position(&self, vertex: VertexId) -> [f64; 3] {
        let ring = self.ring(vertex);
        ring.sum(&ring.limits.position).to_array()
    }

    /// Those of all.
    pub(crate) fn positions(&self, poll: &mut Poll<'_>) -> Result<Vec<[f64; 3]>, Cancelled> {
        let count = self.quads.mesh.vertex_count();
        let found = parallel::pieces_polled(count, POLLED, poll, |block| {
            let positions = block.map(|v| self.position(VertexId(v as u32)));
            positions.collect::<Vec<_>>()
        })?;
        Ok(found.concat())
    }

    /// The limit normal at the vertex that a half-edge of a half leaves, on that face's side.
    pub(crate) fn normal_at(&self, corner: HalfEdgeId) -> [f64; 3] {
        let spoke = spoke(corner);
        let ring = self.ring_at(spoke);
        let side = ring.limits.side_of(slot(&self.quads, spoke), ring.edges);
        ring.normal(side, true).to_array()
    }

    /// Two unit vectors that span the tangent plane at the vertex that a half-edge leaves, on its side, the second to the left of the
    /// first. Away from boundaries and sharp edges the first is the direction in which the surface leaves along the half-edge. `None`
    /// without a tangent plane.
    pub(crate) fn tangents_at(&self, corner: HalfEdgeId) -> Option<[[f64; 3]; 2]> {
        let spoke = spoke(corner);
        let ring = self.ring_at(spoke);
        let side = ring.limits.side_of(slot(&self.quads, spoke), ring.edges);
        let [first, second] = ring.tangents(side)?;
        plane_normal([first, second])?;
        // Those of a smooth ring are along its first edge and across it. A diagonal leaves in the middle between two edges.
        let turned = match ring.is_smooth && of_half(corner).is_none() {
            true => {
                let (sine, cosine) = math::sin_cos(PI / ring.edges as f64);
                [
                    cosine * first + sine * second,
                    cosine * second - sine * first,
                ]
            }
            false => [first, second],
        };
        Some(turned.map(|tangent| unit_or_zero(tangent).to_array()))
    }

    /// The normal of one vertex, the mean of its sides'.
    pub(crate) fn normal(&self, vertex: VertexId) -> [f64; 3] {
        self.normals_of(vertex, true).0.to_array()
    }

    /// The normals of all vertices by side, zero where the surface has no tangent plane.
    pub(crate) fn plane_normals(&self, poll: &mut Poll<'_>) -> Result<SidedNormals, Cancelled> {
        self.all_normals(false, poll)
    }

    /// The normals of all vertices, by side.
    pub(crate) fn sided_normals(&self, poll: &mut Poll<'_>) -> Result<SidedNormals, Cancelled> {
        self.all_normals(true, poll)
    }

    fn all_normals(&self, has_means: bool, poll: &mut Poll<'_>) -> Result<SidedNormals, Cancelled> {
        let count = self.quads.mesh.vertex_count();
        let found = parallel::pieces_polled(count, POLLED, poll, |block| {
            let normals = block.map(|v| self.normals_of(VertexId(v as u32), has_means));
            normals.collect::<Vec<_>>()
        })?;
        let found = found.concat();
        let by_vertex = found.iter().map(|(normal, _)| normal.to_array()).collect();
        let mut normals = SidedNormals::new(by_vertex);
        for (vertex, (_, sides)) in (0..).map(VertexId).zip(found) {
            for (corners, normal) in sides {
                normals.add_side(vertex, corners.into_iter(), normal.to_array());
            }
        }
        Ok(normals.finished())
    }

    /// The mean normal of a vertex, and those of its sides by the corners of halves there, if there are several.
    fn normals_of(
        &self,
        vertex: VertexId,
        has_means: bool,
    ) -> (DVec3, Vec<(Vec<HalfEdgeId>, DVec3)>) {
        let ring = self.ring(vertex);
        if let [side] = &ring.limits.sides[..] {
            return (ring.normal(side, has_means), Vec::new());
        }
        let mut sum = DVec3::ZERO;
        let sides = ring.limits.sides.iter().map(|side| {
            let normal = ring.normal(side, has_means);
            sum += normal;
            let quads = (0..side.quads).map(|i| ring.spokes[(side.first + i) % ring.spokes.len()]);
            let corners = quads.flat_map(|h| self.corners_at(h));
            (corners.collect(), normal)
        });
        let sides = sides.collect();
        (unit_or_zero(sum), sides)
    }

    /// The corners of halves at the vertex that a quad's half-edge leaves: two where the diagonal ends there.
    fn corners_at(&self, h: u32) -> impl Iterator<Item = HalfEdgeId> {
        let own = in_half(h);
        // The half on the other side has the edge before.
        let other = in_half(previous(h)).next();
        let differs = own.face() != other.face();
        core::iter::once(own).chain(differs.then_some(other))
    }
}

impl Ring<'_> {
    fn sum(&self, weights: &[f64]) -> DVec3 {
        weights.iter().zip(&self.points).map(|(&w, &p)| w * p).sum()
    }

    /// The tangents of a side, where rounding leaves them.
    fn tangents(&self, side: &RingSide) -> Option<[DVec3; 2]> {
        let [first, second] = side.tangents.as_ref()?.each_ref().map(|row| {
            let terms = row.iter().zip(&self.points);
            let terms = terms.map(|(&w, p)| w * (p - self.points[0]));
            let sizes = terms.clone().map(|term| term.abs().max_element());
            let (greatest, tangent) = (sizes.fold(0.0, f64::max), terms.sum::<DVec3>());
            (tangent.abs().max_element() > CLEAR * greatest).then_some(tangent)
        });
        Some([first?, second?])
    }

    /// The unit normal of a side. Where the surface has no tangent plane, the mean of its quads' if that is asked for, and zero where
    /// that vanishes.
    fn normal(&self, side: &RingSide, has_means: bool) -> DVec3 {
        let plane = self.tangents(side).and_then(plane_normal);
        if !has_means {
            return plane.unwrap_or(DVec3::ZERO);
        }
        plane.unwrap_or_else(|| {
            let quads = self.points.len() - 1 - self.edges;
            let edge = |slot: usize| self.points[1 + slot % self.edges] - self.points[0];
            let faces = (0..side.quads).map(|i| {
                let slot = (side.first + i) % quads.max(1);
                [edge(slot), edge(slot + 1)]
            });
            area_weighted_normal(&faces.collect::<Vec<_>>())
        })
    }
}

/// The unit normal of the plane that two tangents span, where rounding leaves it.
fn plane_normal(tangents: [DVec3; 2]) -> Option<DVec3> {
    let [first, second] = tangents.map(unit_or_zero);
    let normal = first.cross(second);
    (normal.length() > CLEAR).then(|| unit_or_zero(normal))
}
