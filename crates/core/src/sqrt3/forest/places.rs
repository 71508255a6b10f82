//! Positions of the forest's vertices at any level, their limits and normals: in closed form where
//! there is one, else from the neighbourhood at the level of a vertex's creation, which is grown
//! for this.
//!
//! Inside, `v` and the mean of its ring form a system of their own, so that m steps on it is at `v∞ + (2/3 − α)^m (v − v∞)`
//! (Kobbelt); on curves two steps shrink the distance from the limit to 1/9.

use core::f64::consts::FRAC_PI_3;

use super::{Forest, Kind, Side, Vertex, edge_of, node_of, side};
use crate::math;
use crate::refine::Origin;
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::Scheme;
use crate::sqrt3::masks::{DoubleStep, alpha, centre, crease_point, shrinking, smoothed};
use crate::sqrt3::origins::third;
use crate::vector::{DVec3, unit_or_zero};

/// A sine below which two tangents span no plane, as in [`crate::limit`].
const LEAST_SINE: f64 = 1e-12;

/// A vertex at which a crease ends, with its ring from the crease on, at each requested level.
#[derive(Clone, Debug)]
pub(super) struct Dart {
    /// Of each even level: the vertex, and its ring.
    pub(super) rings: Vec<(DVec3, Vec<DVec3>)>,
}

impl Dart {
    fn ring(&mut self, double_step: usize) -> &(DVec3, Vec<DVec3>) {
        while self.rings.len() <= double_step {
            let next = match self.rings.last() {
                Some((vertex, ring)) => Self::refined(*vertex, ring),
                None => (DVec3::ZERO, Vec::new()),
            };
            self.rings.push(next);
        }
        &self.rings[double_step]
    }

    /// The vertex and its ring two steps on.
    fn refined(vertex: DVec3, ring: &[DVec3]) -> (DVec3, Vec<DVec3>) {
        let shape = RingShape::interior(ring.len() as u32);
        let mask = DoubleStep.vertex_mask(shape);
        let moved = ring
            .iter()
            .zip(&mask.ring)
            .fold(mask.centre * vertex, |sum, (&p, &weight)| sum + weight * p);
        let edge = DoubleStep.edge_mask(EdgeShape::between(shape, RingShape::interior(6)));
        let point = |j: usize| match j {
            0 => crease_point(2.0 * vertex - ring[0], vertex, ring[0]),
            _ => (0..ring.len()).fold(edge.origin * vertex + edge.target * ring[j], |sum, slot| {
                sum + edge.origin_ring[slot] * ring[(j + slot) % ring.len()]
            }),
        };
        (moved, (0..ring.len()).map(point).collect())
    }

    /// Its position at a level.
    fn at(&mut self, level: u8) -> DVec3 {
        let &(vertex, ref ring) = self.ring(usize::from(level / 2));
        if level.is_multiple_of(2) {
            vertex
        } else {
            smoothed(vertex, ring.iter().copied())
        }
    }
}

impl Forest<'_> {
    /// Position of a vertex at a level not below its own.
    pub(super) fn at(&mut self, vertex: u32, level: u8) -> DVec3 {
        let Vertex {
            kind,
            level: first,
            at,
            ..
        } = self.vertices[vertex as usize];
        if level == first {
            return at;
        }
        match kind {
            Kind::Corner => at,
            Kind::Dart(dart) => self.darts[dart as usize].at(level),
            Kind::Smooth(ratio) => self.tending(vertex, at, ratio, level - first),
            Kind::Curve => self.tending(vertex, at, 1.0 / 9.0, level / 2 - first / 2),
            Kind::BesideSharp => {
                let second = self.second_position(vertex);
                self.tending(vertex, second, shrinking(6), level - first - 1)
            }
        }
    }

    /// A position on its way to the limit.
    fn tending(&mut self, vertex: u32, from: DVec3, ratio: f64, steps: u8) -> DVec3 {
        if steps == 0 {
            return from;
        }
        let limit = self.limit(vertex);
        limit + math::powi(ratio, steps.into()) * (from - limit)
    }

    /// A curve's vertex at an even level: of a dart, whose odd levels are smoothed ones, that before.
    fn at_even(&mut self, vertex: u32, level: u8) -> DVec3 {
        self.at(vertex, level - level % 2)
    }

    /// Makes the centre of a node.
    pub(super) fn make_centre(&mut self, t: usize) -> u32 {
        let node = &self.nodes[t];
        let (corners, level) = (node.corners, node.level);
        let kind = if node.sharp != 0 {
            Kind::BesideSharp
        } else {
            Kind::Smooth(shrinking(6))
        };
        let at = centre(corners.map(|v| self.at(v, level)));
        if self.origins.is_some() {
            let barycentric = self.centre_origin(t);
            self.add_origin(t, barycentric);
        }
        self.push_vertex(kind, level + 1, at, side(t, 0))
    }

    /// Makes the points on a sharp edge of an odd level that is cut.
    pub(super) fn make_points(&mut self, on: Side, [a, b]: [u32; 2]) -> [u32; 2] {
        let (t, level) = (node_of(on), self.node(on).level);
        let places = [a, b].map(|v| self.at_even(v, level));
        let new = [
            self.crease_point(a, places),
            self.crease_point(b, [places[1], places[0]]),
        ];
        let after = [a, b].map(|v| self.at_even(v, level + 1));
        [0, 1].map(|end| {
            // Both neighbours on the curve two steps on.
            let limit = (after[end] + new[1 - end] + 4.0 * new[end]) / 6.0;
            if self.origins.is_some() {
                let ends = if end == 0 { [a, b] } else { [b, a] };
                let barycentric = third(ends.map(|v| self.origin_in(v, t)));
                self.add_origin(t, barycentric);
            }
            let made = self.push_vertex(Kind::Curve, level + 1, new[end], on);
            self.vertices[made as usize].limit = Some(limit);
            made
        })
    }

    /// The new point of a curve near a vertex, from the places of both ends.
    fn crease_point(&mut self, near: u32, [here, there]: [DVec3; 2]) -> DVec3 {
        let beyond = match (
            self.vertices[near as usize].kind,
            self.vertices[near as usize].limit,
        ) {
            // The limit is (before + 4 here + after) / 6 at every even level.
            (Kind::Curve, Some(limit)) => 6.0 * limit - 4.0 * here - there,
            _ => 2.0 * here - there,
        };
        crease_point(beyond, here, there)
    }

    fn push_vertex(&mut self, kind: Kind, level: u8, at: DVec3, maker: Side) -> u32 {
        let first = self.vertices.len() as u32;
        self.vertices.push(Vertex {
            kind,
            level,
            at,
            maker,
            limit: None,
            normal: None,
            first,
        });
        first
    }

    /// Limit position of a vertex.
    pub(in crate::sqrt3) fn limit(&mut self, vertex: u32) -> DVec3 {
        let Vertex {
            kind, limit, maker, ..
        } = self.vertices[vertex as usize];
        if let Some(limit) = limit {
            return limit;
        }
        let at = if kind == Kind::BesideSharp {
            self.second_position(vertex)
        } else {
            self.vertices[vertex as usize].at
        };
        let ring = self.regular_ring(maker, kind);
        let moves = 3.0 * alpha(6);
        let limit = (at + moves / 6.0 * ring.iter().sum::<DVec3>()) / (1.0 + moves);
        self.vertices[vertex as usize].limit = Some(limit);
        limit
    }

    /// The six points around the centre of a node, where it is regular.
    fn regular_ring(&mut self, maker: Side, kind: Kind) -> [DVec3; 6] {
        let t = node_of(maker);
        if kind == Kind::BesideSharp {
            self.second_ring(t)
        } else {
            self.first_ring(t)
        }
    }

    /// The points around the centre of a node without sharp edges, at the level of its creation:
    /// corners and, between them, apexes across.
    fn first_ring(&mut self, t: usize) -> [DVec3; 6] {
        let (corners, level) = (self.nodes[t].corners, self.nodes[t].level + 1);
        let mut ring = [DVec3::ZERO; 6];
        for edge in 0..3 {
            ring[2 * edge] = self.at(corners[edge], level);
            if let Some(apex) = self.apex_across(side(t, edge)) {
                ring[2 * edge + 1] = self.vertices[apex as usize].at;
            }
        }
        ring
    }

    /// The apex of the node across a half-edge.
    fn apex_across(&mut self, at: Side) -> Option<u32> {
        let across = self.require(at)?;
        self.grow(node_of(across));
        Some(self.node(across).apex(edge_of(across)))
    }

    /// The points around the centre of a node with sharp edges, one step after its creation.
    fn second_ring(&mut self, t: usize) -> [DVec3; 6] {
        let mut ring = [DVec3::ZERO; 6];
        self.grow(t);
        for edge in 0..3 {
            let own = side(t, edge);
            let apexes = if self.nodes[t].is_sharp(edge) {
                self.child(own).map(|child| {
                    self.grow(child);
                    self.nodes[child].apexes
                })
            } else {
                self.require(own).and_then(|other| {
                    self.grow(node_of(other));
                    let children = [self.child(own)?, self.child(other)?];
                    Some(children.map(|child| {
                        self.grow(child);
                        self.nodes[child].apexes[0]
                    }))
                })
            };
            for (place, apex) in apexes.into_iter().flatten().enumerate() {
                ring[2 * edge + place] = self.vertices[apex as usize].at;
            }
        }
        ring
    }

    /// The centre of a face with sharp edges one step on: smoothed by the ring of fewer than six that it has at first.
    fn second_position(&mut self, vertex: u32) -> DVec3 {
        if let Some(&known) = self.smoothed.get(&vertex) {
            return known;
        }
        let Vertex { at, maker, .. } = self.vertices[vertex as usize];
        let t = node_of(maker);
        let (corners, level) = (self.nodes[t].corners, self.nodes[t].level + 1);
        let mut ring = Vec::with_capacity(5);
        for (edge, corner) in corners.into_iter().enumerate() {
            ring.push(self.at(corner, level));
            if !self.nodes[t].is_sharp(edge) {
                let apex = self.apex_across(side(t, edge));
                ring.extend(apex.map(|apex| self.vertices[apex as usize].at));
            }
        }
        let second = smoothed(at, ring.into_iter());
        self.smoothed.insert(vertex, second);
        second
    }

    /// Unit limit normal of a vertex; zero where it has none.
    pub(in crate::sqrt3) fn normal(&mut self, vertex: u32) -> DVec3 {
        let Vertex {
            kind,
            normal,
            maker,
            ..
        } = self.vertices[vertex as usize];
        if let Some(normal) = normal {
            return normal;
        }
        let normal = match kind {
            Kind::Curve => self.rim_normal(vertex, maker),
            _ => {
                let turn = |j: usize| math::sin_cos(FRAC_PI_3 * j as f64);
                let ring = self.regular_ring(maker, kind).into_iter().enumerate();
                let [along, across] = ring.fold([DVec3::ZERO; 2], |[along, across], (j, p)| {
                    [along + turn(j).1 * p, across + turn(j).0 * p]
                });
                spanned(along, across)
            }
        };
        self.vertices[vertex as usize].normal = Some(normal);
        normal
    }

    /// The normal of a point on a sharp edge, which has four edges on its side: along the curve, and across it by the left
    /// eigenvector for 1/3, whose inner weights are equal.
    fn rim_normal(&mut self, vertex: u32, on: Side) -> DVec3 {
        let (t, edge) = (node_of(on), edge_of(on));
        let [a, b] = self.ends(on);
        let third = self.nodes[t].corners[(edge + 2) % 3];
        let level = self.nodes[t].level + 1;
        let [l, r] = self.nodes[t].apexes;
        let is_first = vertex == l;
        let beyond = self.apex_across(side(t, if is_first { edge + 2 } else { edge + 1 }));
        let Some(beyond) = beyond else {
            return DVec3::ZERO;
        };
        let (beyond, third) = (self.vertices[beyond as usize].at, self.at(third, level));
        let ring = match is_first {
            true => [
                self.vertices[r as usize].at,
                third,
                beyond,
                self.at_even(a, level),
            ],
            false => [
                self.at_even(b, level),
                beyond,
                third,
                self.vertices[l as usize].at,
            ],
        };
        // √3/2 on inner neighbours, −5√3/12 on those of the curve, −√3/6 on the vertex.
        let here = self.vertices[vertex as usize].at;
        let inner = ring[1] - here + (ring[2] - here);
        let across = 6.0 * inner - 5.0 * (ring[0] - here + (ring[3] - here));
        spanned(ring[0] - ring[3], across)
    }

    /// Where the centre of a node is in its control face.
    fn centre_origin(&self, t: usize) -> [f64; 3] {
        let node = &self.nodes[t];
        if !node.is_odd() || node.cut_edge().is_some() {
            let corners = node.corners.map(|v| self.origin_in(v, t));
            return [0, 1, 2].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
        }
        // (A, apex, apex) across the former edge from A to B.
        third(self.ends(node.parent).map(|v| self.origin_in(v, t)))
    }

    /// The place of a vertex in the control face of a node.
    fn origin_in(&self, vertex: u32, t: usize) -> [f64; 3] {
        let own = self
            .origins
            .as_ref()
            .and_then(|all| all.get(vertex as usize));
        let here = own.and_then(|own| own.in_face(self.control.triangles(), self.nodes[t].root));
        here.map_or([0.0; 3], |origin| origin.barycentric)
    }

    fn add_origin(&mut self, t: usize, barycentric: [f64; 3]) {
        let face = self.nodes[t].root;
        if let Some(all) = &mut self.origins {
            all.push(Origin { face, barycentric });
        }
    }
}

/// The unit normal of two tangents, if they span a plane.
fn spanned(along: DVec3, across: DVec3) -> DVec3 {
    let [along, across] = [unit_or_zero(along), unit_or_zero(across)];
    let normal = along.cross(across);
    if normal.length() > LEAST_SINE {
        unit_or_zero(normal)
    } else {
        DVec3::ZERO
    }
}
