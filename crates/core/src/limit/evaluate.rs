//! Limit positions and normals on a mesh.
//!
//! Takes a mesh and a table of stencils; gives a position or a unit normal for each vertex. A scheme with
//! one-ring support is evaluated on the ring as it is. For one with two-ring support the neighbours of the ring
//! may be irregular, where no stencil is tabulated: the neighbourhood is refined once by the scheme's own masks,
//! after which it is regular, and its stencil is exact.

use std::sync::Arc;

use super::refined::{Refined, RefinedMesh};
use super::stencil::LimitStencil;
use super::{LimitError, LimitTable};
use crate::index::VertexId;
use crate::masks::Masks;
use crate::mesh::{Mesh, RingShapes, Topology};
use crate::parallel;
use crate::ring::RingShape;
use crate::scheme::Support;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Two tangents closer to parallel than this (the sine of their angle) span no plane: rounding alone gives some
/// 1e-16 for a flat ring, and a few digits are left to coordinates far from the origin.
const LEAST_SINE: f64 = 1e-12;

/// A tangent shorter than this fraction of the longest difference that entered it is what rounding left of zero.
const LEAST_LENGTH: f64 = 1e-14;

/// Squared lengths whose product, even times [`LEAST_SINE`] twice, neither vanishes nor overflows.
const SAFE_SQUARES: core::ops::Range<f64> = 1e-130..1e150;

impl LimitTable<'_> {
    /// Limit position of every vertex of `mesh`.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn positions(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>, LimitError> {
        let stencils = Stencils::of(self, mesh)?;
        let refined = self.refined_for(mesh, stencils.list.iter().any(|stencil| !interpolates(stencil)));
        Ok(parallel::map(mesh.vertex_count(), |v| {
            let (vertex, stencil) = (VertexId(v as u32), stencils.at(v));
            match &refined {
                Some(refined) => two_ring_position(mesh, vertex, stencil, refined),
                None => one_ring_position(mesh, vertex, stencil),
            }
        }))
    }

    /// Unit limit normal of every vertex of `mesh`, pointing outside; where the limit surface has no tangent
    /// plane, the area-weighted average of the face normals, and zero where that vanishes too.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn normals(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>, LimitError> {
        let stencils = Stencils::of(self, mesh)?;
        let refined = self.refined_for(mesh, true);
        Ok(parallel::map(mesh.vertex_count(), |v| {
            let (vertex, stencil) = (VertexId(v as u32), stencils.at(v));
            match &refined {
                Some(refined) => two_ring_normal(mesh, vertex, stencil, refined),
                None => one_ring_normal(mesh, vertex, stencil),
            }
        }))
    }

    /// Limit position of one vertex.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of its ring.
    pub fn position(&self, mesh: &Mesh, vertex: VertexId) -> Result<[f64; 3], LimitError> {
        let stencil = self.stencil(mesh.ring_shape(vertex))?;
        Ok(match self.scheme().support() {
            Support::TwoRing if !interpolates(&stencil) => {
                two_ring_position(mesh, vertex, &stencil, &Masks::on_demand(mesh, self.scheme()))
            }
            _ => one_ring_position(mesh, vertex, &stencil),
        })
    }

    /// Limit normal of one vertex, as [`Self::normals`] gives it.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of its ring.
    pub fn normal(&self, mesh: &Mesh, vertex: VertexId) -> Result<[f64; 3], LimitError> {
        let stencil = self.stencil(mesh.ring_shape(vertex))?;
        Ok(match self.scheme().support() {
            Support::TwoRing => {
                two_ring_normal(mesh, vertex, &stencil, &Masks::on_demand(mesh, self.scheme()))
            }
            Support::OneRing => one_ring_normal(mesh, vertex, &stencil),
        })
    }

    /// The mesh refined once where the scheme's stencils are for that.
    fn refined_for(&self, mesh: &Mesh, needed: bool) -> Option<RefinedMesh> {
        (needed && self.scheme().support() == Support::TwoRing).then(|| RefinedMesh::new(self.scheme(), mesh))
    }
}

/// The stencils of a mesh's vertices, looked up once for each shape that occurs.
struct Stencils {
    list: Vec<Arc<LimitStencil>>,
    by_vertex: Vec<u32>,
}

impl Stencils {
    fn of(table: &LimitTable<'_>, mesh: &Mesh) -> Result<Self, LimitError> {
        let RingShapes { distinct, by_vertex } = RingShapes::of(mesh);
        let list = distinct.into_iter().map(|shape| table.stencil(shape)).collect::<Result<_, _>>()?;
        Ok(Self { list, by_vertex })
    }

    #[inline]
    fn at(&self, vertex: usize) -> &LimitStencil {
        &self.list[self.by_vertex[vertex] as usize]
    }
}

/// Whether the limit position is the vertex itself.
fn interpolates(stencil: &LimitStencil) -> bool {
    stencil.position[0] == 1.0 && stencil.position[1..].iter().all(|&weight| weight == 0.0)
}

/// Sums of two tangents and the size of what entered them.
#[derive(Default)]
struct Tangents {
    first: DVec3,
    second: DVec3,
    greatest: f64,
}

impl Tangents {
    #[inline]
    fn add(&mut self, weights: [f64; 2], difference: DVec3) {
        self.first += weights[0] * difference;
        self.second += weights[1] * difference;
        self.greatest = self.greatest.max(difference.abs().max_element());
    }

    /// The unit normal of the plane they span, if they do span one.
    #[inline]
    fn normal(&self) -> Option<DVec3> {
        let squares = [self.first.length_squared(), self.second.length_squared()];
        let least = LEAST_LENGTH * self.greatest;
        if squares.iter().any(|square| !SAFE_SQUARES.contains(square)) {
            return self.normal_at_any_size();
        }
        let normal = self.first.cross(self.second);
        let square = normal.length_squared();
        let spans = squares.iter().all(|&square| square > least * least)
            && square > LEAST_SINE * LEAST_SINE * squares[0] * squares[1];
        spans.then(|| normal / square.sqrt())
    }

    /// As [`Self::normal`], for tangents whose squares would vanish or overflow.
    #[cold]
    fn normal_at_any_size(&self) -> Option<DVec3> {
        let long = |tangent: DVec3| tangent.abs().max_element() > LEAST_LENGTH * self.greatest;
        if !long(self.first) || !long(self.second) {
            return None;
        }
        let normal = unit_or_zero(self.first).cross(unit_or_zero(self.second));
        let sine = normal.length();
        (sine > LEAST_SINE).then(|| normal / sine)
    }
}

fn point(mesh: &Mesh, vertex: VertexId) -> DVec3 {
    vector(mesh.positions()[vertex.index()])
}

fn one_ring_position(mesh: &Mesh, vertex: VertexId, stencil: &LimitStencil) -> [f64; 3] {
    let ring = mesh.topology().ring(vertex).zip(&stencil.position[1..]);
    let start = stencil.position[0] * point(mesh, vertex);
    ring.fold(start, |sum, (neighbour, &weight)| sum + weight * point(mesh, neighbour)).to_array()
}

fn one_ring_normal(mesh: &Mesh, vertex: VertexId, stencil: &LimitStencil) -> [f64; 3] {
    let centre = point(mesh, vertex);
    let mut tangents = Tangents::default();
    for (neighbour, &weights) in mesh.topology().ring(vertex).zip(&stencil.tangents) {
        tangents.add(weights, point(mesh, neighbour) - centre);
    }
    tangents.normal().unwrap_or_else(|| face_average(mesh, vertex)).to_array()
}

fn two_ring_position(
    mesh: &Mesh,
    vertex: VertexId,
    stencil: &LimitStencil,
    refined: &impl Refined,
) -> [f64; 3] {
    let mut sum = stencil.position[0] * refined.moved(vertex);
    for_each_of_two_ring(mesh.topology(), vertex, stencil.shape, refined, |i, point| {
        sum += stencil.position[i + 1] * point;
    });
    sum.to_array()
}

fn two_ring_normal(
    mesh: &Mesh,
    vertex: VertexId,
    stencil: &LimitStencil,
    refined: &impl Refined,
) -> [f64; 3] {
    let mut tangents = Tangents::default();
    if !stencil.tangents.is_empty() {
        let centre = refined.moved(vertex);
        for_each_of_two_ring(mesh.topology(), vertex, stencil.shape, refined, |i, point| {
            tangents.add(stencil.tangents[i], point - centre);
        });
    }
    tangents.normal().unwrap_or_else(|| face_average(mesh, vertex)).to_array()
}

/// Calls `visit` for the points around `vertex` after one refinement, numbered as in the stencil's tangents.
fn for_each_of_two_ring(
    topology: &Topology,
    vertex: VertexId,
    shape: RingShape,
    refined: &impl Refined,
    mut visit: impl FnMut(usize, DVec3),
) {
    let k = shape.valence as usize;
    for (j, h) in topology.outgoing_ring(vertex).enumerate() {
        visit(j, refined.on_edge(h));
        visit(k + j, refined.moved(topology.target(h)));
        visit(2 * k + j, refined.on_edge(h.next()));
        if shape.open && j + 2 == k {
            visit(k - 1, refined.on_edge(h.previous()));
            visit(2 * k - 1, refined.moved(topology.opposite(h)));
        }
    }
}

/// The area-weighted average of the normals of the faces at `vertex`, of unit length; zero where it vanishes.
fn face_average(mesh: &Mesh, vertex: VertexId) -> DVec3 {
    let (topology, centre) = (mesh.topology(), point(mesh, vertex));
    let sides = || {
        topology
            .outgoing_ring(vertex)
            .map(|h| (point(mesh, topology.target(h)) - centre, point(mesh, topology.opposite(h)) - centre))
    };
    // Scaled to the ring's size, so that squares neither vanish nor overflow.
    let size = sides().fold(0.0, |size: f64, (a, b)| size.max(a.abs().max(b.abs()).max_element()));
    if size == 0.0 || !size.is_finite() {
        return DVec3::ZERO;
    }
    let (mut sum, mut areas) = (DVec3::ZERO, 0.0);
    for (a, b) in sides() {
        let normal = (a / size).cross(b / size);
        sum += normal;
        areas += normal.length();
    }
    if sum.length() > LEAST_SINE * areas { unit_or_zero(sum) } else { DVec3::ZERO }
}
