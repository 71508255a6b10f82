//! Limit positions and normals on a mesh.
//!
//! Takes a mesh and a table of stencils; gives a position or a unit normal for each vertex. A
//! scheme with one-ring support is evaluated on the ring itself. For one with two-ring support the
//! neighbours of the ring may be irregular, where no stencil is tabulated: the neighbourhood is
//! refined once by the scheme's own masks, after which it is regular, and its stencil is exact.

use std::sync::Arc;

use super::quads::QuadLimits;
use super::refined::{Refined, RefinedMesh};
use super::sharp::SharpStencil;
use super::sides::{LEAST_SINE, SidedNormals, area_weighted_normal};
use super::stencil::LimitStencil;
use super::{LimitError, LimitTable, suits};
use crate::index::{HalfEdgeId, VertexId};
use crate::masks::Masks;
use crate::math;
use crate::mesh::{Mesh, RingShapes, Sharpness, Topology};
use crate::parallel::{self, Poll};
use crate::progress::{Cancelled, uncancelled};
use crate::scheme::Support;
use crate::vector::{DVec3, unit_or_zero, vector};

/// A tangent shorter than this fraction of the longest difference that entered it is zero within
/// rounding.
const LEAST_LENGTH: f64 = 1e-14;

/// The most vertices adjacent to sharp edges that are evaluated together.
const TAGGED: usize = 256;

/// Squared lengths whose product, even times [`LEAST_SINE`] twice, neither vanishes nor overflows.
const SAFE_SQUARES: core::ops::Range<f64> = 1e-130..1e150;

impl LimitTable<'_> {
    /// Limit position of every vertex of `mesh`.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn positions(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>, LimitError> {
        uncancelled(|_| self.positions_polled(mesh, &mut |_| Ok(())))
    }

    /// [`Self::positions`] that can be cancelled.
    #[doc(hidden)]
    pub fn positions_polled(
        &self,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Result<Vec<[f64; 3]>, LimitError>, Cancelled> {
        match Stencils::of(self, mesh, poll)? {
            Ok(stencils) => Ok(Ok(self.positions_by(&stencils, mesh, poll)?)),
            Err(error) => Ok(Err(error)),
        }
    }

    /// [`Self::positions_polled`] where the stencils are known.
    #[doc(hidden)]
    pub fn positions_by(
        &self,
        stencils: &Stencils,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Vec<[f64; 3]>, Cancelled> {
        if mesh.topology().has_quads() {
            return QuadLimits::of(mesh, &Sharpness::of(mesh)).positions(poll);
        }
        let refined = self.refined_for(mesh, stencils.any_moves(), poll)?;
        parallel::map_polled(mesh.vertex_count(), poll, |v| {
            let (vertex, weights) = (VertexId(v as u32), stencils.at(v).position());
            match &refined {
                Some(refined) => two_ring_position(mesh, vertex, weights, refined),
                None => one_ring_position(mesh, vertex, weights),
            }
        })
    }

    /// Unit limit normal of every vertex of `mesh`, pointing outside; where the limit surface has no tangent
    /// plane, the area-weighted average of the face normals, and zero where that vanishes too.
    ///
    /// A vertex on a sharp edge has one normal on each side of it (see [`Self::sided_normals`]); here it has their
    /// average, of unit length.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn normals(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>, LimitError> {
        Ok(self.sided_normals(mesh)?.into_by_vertex())
    }

    /// Unit limit normals as in [`Self::normals`], and for vertices on sharp edges one for each side.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn sided_normals(&self, mesh: &Mesh) -> Result<SidedNormals, LimitError> {
        uncancelled(|_| self.sided_normals_polled(mesh, &mut |_| Ok(())))
    }

    /// [`Self::sided_normals`] that can be cancelled.
    #[doc(hidden)]
    pub fn sided_normals_polled(
        &self,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Result<SidedNormals, LimitError>, Cancelled> {
        match Stencils::of(self, mesh, poll)? {
            Ok(stencils) => Ok(Ok(self.sided_normals_by(&stencils, mesh, poll)?)),
            Err(error) => Ok(Err(error)),
        }
    }

    /// [`Self::sided_normals_polled`] where the stencils are known.
    #[doc(hidden)]
    pub fn sided_normals_by(
        &self,
        stencils: &Stencils,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<SidedNormals, Cancelled> {
        if mesh.topology().has_quads() {
            return QuadLimits::of(mesh, &Sharpness::of(mesh)).sided_normals(poll);
        }
        self.normals_or(stencils, mesh, poll, |vertex, side| {
            face_average(mesh, vertex, side)
        })
    }

    /// Unit limit normals as in [`Self::sided_normals`], but zero where the limit surface has no tangent plane.
    #[doc(hidden)]
    pub fn plane_normals(
        &self,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Result<SidedNormals, LimitError>, Cancelled> {
        if mesh.topology().has_quads() {
            let sharpness = Sharpness::of(mesh);
            return Ok(Ok(QuadLimits::of(mesh, &sharpness).plane_normals(poll)?));
        }
        match Stencils::of(self, mesh, poll)? {
            Ok(stencils) => Ok(Ok(
                self.normals_or(&stencils, mesh, poll, |_, _| DVec3::ZERO)?
            )),
            Err(error) => Ok(Err(error)),
        }
    }

    /// Unit limit normals; `without_plane` is used where the limit surface has no tangent plane.
    fn normals_or(
        &self,
        stencils: &Stencils,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
        without_plane: impl Fn(VertexId, &Side<'_>) -> DVec3 + Sync + Send,
    ) -> Result<SidedNormals, Cancelled> {
        let refined = self.refined_for(mesh, true, poll)?;
        let normal = |vertex: VertexId, side: &Side<'_>| {
            let normal = match &refined {
                Some(refined) => two_ring_normal(mesh, vertex, side, refined),
                None => one_ring_normal(mesh, vertex, side),
            };
            normal.unwrap_or_else(|| without_plane(vertex, side))
        };
        let by_vertex = parallel::map_polled(mesh.vertex_count(), poll, |v| {
            let vertex = VertexId(v as u32);
            stencils
                .at(v)
                .average(|side| normal(vertex, side))
                .to_array()
        });
        let mut normals = SidedNormals::new(by_vertex?);
        for (i, &vertex) in stencils.tagged.iter().enumerate() {
            if i.is_multiple_of(TAGGED) {
                poll(mesh.vertex_count())?;
            }
            let stencil = stencils.at(vertex.index());
            if stencil.side_count() > 1 {
                let outgoing: Vec<HalfEdgeId> = mesh.topology().outgoing_ring(vertex).collect();
                for side in stencil.sides() {
                    let faces =
                        (0..side.faces).map(|face| outgoing[(side.first + face) % outgoing.len()]);
                    normals.add_side(vertex, faces, normal(vertex, &side).to_array());
                }
            }
        }
        Ok(normals.finished())
    }

    /// Limit normal at the vertex that `corner` leaves, on the side of its face, one of
    /// [`Self::sided_normals`].
    ///
    /// # Errors
    /// The scheme has no limit at the shape of its ring.
    pub fn normal_at(&self, mesh: &Mesh, corner: HalfEdgeId) -> Result<[f64; 3], LimitError> {
        if mesh.topology().has_quads() {
            return Ok(QuadLimits::of(mesh, &Sharpness::of(mesh)).normal_at(corner));
        }
        let vertex = mesh.topology().origin(corner);
        let stencil = self.stencil_at(mesh, &Sharpness::of(mesh), vertex)?;
        let side = stencil.side_of(mesh, corner);
        Ok(side
            .map_or(DVec3::ZERO, |side| self.side_normal(mesh, vertex, &side))
            .to_array())
    }

    /// Two unit vectors that span the limit tangent plane at the vertex that `corner` leaves, on the side of its face, the
    /// second to the left of the first as seen from outside. Away from boundaries and sharp edges the first runs along the edge
    /// of `corner`. `None` without a tangent plane.
    #[doc(hidden)]
    pub fn tangents_at(
        &self,
        mesh: &Mesh,
        sharpness: &Sharpness<'_>,
        corner: HalfEdgeId,
    ) -> Result<Option<[[f64; 3]; 2]>, LimitError> {
        if mesh.topology().has_quads() {
            return Ok(QuadLimits::of(mesh, sharpness).tangents_at(corner));
        }
        let vertex = mesh.topology().origin(corner);
        let stencil = self.stencil_at(mesh, sharpness, vertex)?;
        let Some(side) = stencil.side_of(mesh, corner) else {
            return Ok(None);
        };
        let tangents = match self.scheme().support() {
            Support::TwoRing => {
                two_ring_tangents(mesh, vertex, &side, &Masks::on_demand(mesh, self.scheme()))
            }
            Support::OneRing => one_ring_tangents(mesh, vertex, &side),
        };
        // The weights of a closed ring count from its first edge.
        let turned = match &stencil {
            Stencil::Plain(plain) if !plain.shape.open => {
                let slot = mesh.topology().slot(corner) as f64;
                tangents.turned(core::f64::consts::TAU * slot / f64::from(plain.shape.valence))
            }
            _ => tangents,
        };
        let units =
            || [turned.first, turned.second].map(|tangent| unit_or_zero(tangent).to_array());
        Ok(turned.normal().map(|_| units()))
    }

    /// Limit position of one vertex.
    ///
    /// # Errors
    /// The scheme has no limit at the shape of its ring.
    pub fn position(&self, mesh: &Mesh, vertex: VertexId) -> Result<[f64; 3], LimitError> {
        if mesh.topology().has_quads() {
            return Ok(QuadLimits::of(mesh, &Sharpness::of(mesh)).position(vertex));
        }
        let stencil = self.stencil_at(mesh, &Sharpness::of(mesh), vertex)?;
        Ok(match self.scheme().support() {
            Support::TwoRing if !stays(stencil.position()) => {
                let masks = Masks::on_demand(mesh, self.scheme());
                two_ring_position(mesh, vertex, stencil.position(), &masks)
            }
            _ => one_ring_position(mesh, vertex, stencil.position()),
        })
    }

    /// Limit normal of one vertex, one of [`Self::normals`].
    ///
    /// # Errors
    /// The scheme has no limit at the shape of its ring.
    pub fn normal(&self, mesh: &Mesh, vertex: VertexId) -> Result<[f64; 3], LimitError> {
        if mesh.topology().has_quads() {
            return Ok(QuadLimits::of(mesh, &Sharpness::of(mesh)).normal(vertex));
        }
        let stencil = self.stencil_at(mesh, &Sharpness::of(mesh), vertex)?;
        Ok(stencil
            .average(|side| self.side_normal(mesh, vertex, side))
            .to_array())
    }

    fn side_normal(&self, mesh: &Mesh, vertex: VertexId, side: &Side<'_>) -> DVec3 {
        let normal = match self.scheme().support() {
            Support::TwoRing => {
                two_ring_normal(mesh, vertex, side, &Masks::on_demand(mesh, self.scheme()))
            }
            Support::OneRing => one_ring_normal(mesh, vertex, side),
        };
        normal.unwrap_or_else(|| face_average(mesh, vertex, side))
    }

    /// The stencil of one vertex.
    pub(super) fn stencil_at(
        &self,
        mesh: &Mesh,
        sharpness: &Sharpness<'_>,
        vertex: VertexId,
    ) -> Result<Stencil, LimitError> {
        if !sharpness.is_tagged(vertex) {
            return Ok(Stencil::Plain(self.stencil(mesh.ring_shape(vertex))?));
        }
        let ring = sharpness.ring(vertex);
        // Two-ring stencils are for the neighbourhood after one refinement.
        let ring = if self.scheme().support() == Support::TwoRing {
            ring.refined()
        } else {
            ring
        };
        Ok(Stencil::Sharp(self.sharp_stencil(&ring)?))
    }

    /// The mesh refined once where the scheme's stencils are for that.
    fn refined_for(
        &self,
        mesh: &Mesh,
        needed: bool,
        poll: &mut Poll<'_>,
    ) -> Result<Option<RefinedMesh>, Cancelled> {
        let is_needed = needed && self.scheme().support() == Support::TwoRing;
        is_needed
            .then(|| RefinedMesh::new(self.scheme(), mesh, poll))
            .transpose()
    }
}

/// The weights of one vertex.
pub(super) enum Stencil {
    /// The stencil by the shape of its ring.
    Plain(Arc<LimitStencil>),
    /// The stencil by the sharpness of its edges.
    Sharp(Arc<SharpStencil>),
}

/// One side of a vertex's ring: its first slot and number of faces, and the tangents' weights.
pub(super) struct Side<'s> {
    pub(super) first: usize,
    pub(super) faces: usize,
    pub(super) tangents: &'s [[f64; 2]],
}

impl Stencil {
    #[inline]
    pub(super) fn position(&self) -> &[f64] {
        match self {
            Self::Plain(stencil) => &stencil.position,
            Self::Sharp(stencil) => &stencil.position,
        }
    }

    #[inline]
    fn side_count(&self) -> usize {
        if let Self::Sharp(stencil) = self {
            stencil.sides.len()
        } else {
            1
        }
    }

    #[inline]
    fn side(&self, i: usize) -> Side<'_> {
        match self {
            Self::Plain(stencil) => Side {
                first: 0,
                faces: stencil.shape.faces() as usize,
                tangents: &stencil.tangents,
            },
            Self::Sharp(stencil) => {
                let side = &stencil.sides[i];
                Side {
                    first: side.first(),
                    faces: side.faces(),
                    tangents: &side.tangents,
                }
            }
        }
    }

    /// The side that the face of `corner` is on, at the vertex that it leaves.
    pub(crate) fn side_of(&self, mesh: &Mesh, corner: HalfEdgeId) -> Option<Side<'_>> {
        let (slot, topology) = (mesh.topology().slot(corner), mesh.topology());
        let faces = topology.outgoing_ring(topology.origin(corner)).count();
        self.sides()
            .find(|side| (slot + faces - side.first) % faces < side.faces)
    }

    pub(super) fn sides(&self) -> impl Iterator<Item = Side<'_>> {
        (0..self.side_count()).map(|i| self.side(i))
    }

    /// The normal of the only side, or the average over all, of unit length.
    #[inline]
    fn average(&self, normal: impl Fn(&Side<'_>) -> DVec3) -> DVec3 {
        if self.side_count() == 1 {
            return normal(&self.side(0));
        }
        unit_or_zero(self.sides().map(|side| normal(&side)).sum())
    }
}

/// The stencils of a mesh's vertices, looked up once for each shape that occurs.
#[doc(hidden)]
#[derive(Default)]
pub struct Stencils {
    list: Vec<Stencil>,
    by_vertex: Vec<u32>,
    /// The vertices that are sharp or have sharp edges inside the mesh.
    tagged: Vec<VertexId>,
}

impl Stencils {
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    #[doc(hidden)]
    pub fn of(
        table: &LimitTable<'_>,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Result<Self, LimitError>, Cancelled> {
        if let Err(error) = suits(table.scheme(), mesh) {
            return Ok(Err(error));
        }
        if mesh.topology().has_quads() {
            // Their limits follow from the rings of quads.
            return Ok(Ok(Self::default()));
        }
        let nowhere = &mut |_| poll(0);
        let shapes = RingShapes::polled(mesh, nowhere)?;
        let sharpness = Sharpness::of(mesh);
        let tagged: Vec<VertexId> = sharpness.tagged_vertices().collect();
        let sharp = parallel::pieces_polled(tagged.len(), TAGGED, nowhere, |piece| {
            tagged[piece]
                .iter()
                .map(|&v| table.stencil_at(mesh, &sharpness, v))
                .collect::<Vec<_>>()
        });
        let sharp = sharp?.into_iter().flatten().collect::<Result<_, _>>();
        Ok(sharp.and_then(|sharp| Self::with_sharp(table, shapes, (tagged, sharp))))
    }

    fn with_sharp(
        table: &LimitTable<'_>,
        RingShapes {
            distinct,
            mut by_vertex,
        }: RingShapes,
        (tagged, sharp): (Vec<VertexId>, Vec<Stencil>),
    ) -> Result<Self, LimitError> {
        let plain = distinct
            .into_iter()
            .map(|shape| Ok(Stencil::Plain(table.stencil(shape)?)));
        let mut list = plain.collect::<Result<Vec<_>, LimitError>>()?;
        for (&vertex, stencil) in tagged.iter().zip(sharp) {
            by_vertex[vertex.index()] = list.len() as u32;
            list.push(stencil);
        }
        Ok(Self {
            list,
            by_vertex,
            tagged,
        })
    }

    #[inline]
    pub(super) fn at(&self, vertex: usize) -> &Stencil {
        &self.list[self.by_vertex[vertex] as usize]
    }

    /// Whether any vertex has another limit position than its own.
    fn any_moves(&self) -> bool {
        self.list.iter().any(|stencil| !stays(stencil.position()))
    }
}

/// Whether the limit position is the vertex itself.
pub(super) fn stays(weights: &[f64]) -> bool {
    weights[0] == 1.0 && weights[1..].iter().all(|&weight| weight == 0.0)
}

/// Sums of two tangents and the size of their terms.
#[derive(Clone, Copy, Default)]
struct Tangents {
    first: DVec3,
    second: DVec3,
    greatest: f64,
}

impl Tangents {
    #[inline]
    fn add(&mut self, weights: [f64; 2], difference: DVec3) {
        // Points of another side of a sharp edge.
        if weights == [0.0; 2] {
            return;
        }
        self.first += weights[0] * difference;
        self.second += weights[1] * difference;
        self.greatest = self.greatest.max(difference.abs().max_element());
    }

    /// The tangents of a closed ring counted from another edge, at this angle on the regular ring.
    fn turned(&self, angle: f64) -> Self {
        let (sine, cosine) = math::sin_cos(angle);
        let first = cosine * self.first + sine * self.second;
        Self {
            first,
            second: cosine * self.second - sine * self.first,
            ..*self
        }
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

    /// The normal of tangents whose squares would vanish or overflow.
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

fn one_ring_position(mesh: &Mesh, vertex: VertexId, weights: &[f64]) -> [f64; 3] {
    let ring = mesh.topology().ring(vertex).zip(&weights[1..]);
    let start = weights[0] * point(mesh, vertex);
    ring.fold(start, |sum, (neighbour, &weight)| {
        sum + weight * point(mesh, neighbour)
    })
    .to_array()
}

fn one_ring_normal(mesh: &Mesh, vertex: VertexId, side: &Side<'_>) -> Option<DVec3> {
    one_ring_tangents(mesh, vertex, side).normal()
}

fn one_ring_tangents(mesh: &Mesh, vertex: VertexId, side: &Side<'_>) -> Tangents {
    let centre = point(mesh, vertex);
    let mut tangents = Tangents::default();
    for (neighbour, &weights) in mesh.topology().ring(vertex).zip(side.tangents) {
        tangents.add(weights, point(mesh, neighbour) - centre);
    }
    tangents
}

fn two_ring_position(
    mesh: &Mesh,
    vertex: VertexId,
    weights: &[f64],
    refined: &impl Refined<Point = DVec3>,
) -> [f64; 3] {
    let mut sum = weights[0] * refined.moved(vertex);
    for_each_of_two_ring(mesh.topology(), vertex, refined, |i, point| {
        sum += weights[i + 1] * point
    });
    sum.to_array()
}

fn two_ring_normal(
    mesh: &Mesh,
    vertex: VertexId,
    side: &Side<'_>,
    refined: &impl Refined<Point = DVec3>,
) -> Option<DVec3> {
    two_ring_tangents(mesh, vertex, side, refined).normal()
}

fn two_ring_tangents(
    mesh: &Mesh,
    vertex: VertexId,
    side: &Side<'_>,
    refined: &impl Refined<Point = DVec3>,
) -> Tangents {
    let mut tangents = Tangents::default();
    if !side.tangents.is_empty() {
        let centre = refined.moved(vertex);
        for_each_of_two_ring(mesh.topology(), vertex, refined, |i, point| {
            tangents.add(side.tangents[i], point - centre);
        });
    }
    tangents
}

/// Calls `visit` for the points around `vertex` after one refinement, numbered as in the stencil's tangents.
pub(super) fn for_each_of_two_ring<R: Refined>(
    topology: &Topology,
    vertex: VertexId,
    refined: &R,
    mut visit: impl FnMut(usize, R::Point),
) {
    let (valence, open) = topology.valence_and_openness(vertex);
    let k = valence as usize;
    for (j, h) in topology.outgoing_ring(vertex).enumerate() {
        visit(j, refined.on_edge(h));
        visit(k + j, refined.moved(topology.target(h)));
        visit(2 * k + j, refined.on_edge(h.next()));
        if open && j + 2 == k {
            visit(k - 1, refined.on_edge(h.previous()));
            visit(2 * k - 1, refined.moved(topology.opposite(h)));
        }
    }
}

/// The area-weighted average of the normals of a side's faces at `vertex`, of unit length; zero where it vanishes.
fn face_average(mesh: &Mesh, vertex: VertexId, side: &Side<'_>) -> DVec3 {
    let (topology, centre) = (mesh.topology(), point(mesh, vertex));
    let twice = topology
        .outgoing_ring(vertex)
        .chain(topology.outgoing_ring(vertex));
    let from = |v: VertexId| point(mesh, v) - centre;
    let ends = |h: HalfEdgeId| [from(topology.target(h)), from(topology.opposite(h))];
    let faces: Vec<[DVec3; 2]> = twice.skip(side.first).take(side.faces).map(ends).collect();
    area_weighted_normal(&faces)
}
