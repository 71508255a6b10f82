//! The limit positions of a mesh as a linear map: each is a weighted sum of control vertices.
//!
//! Takes a mesh and a table of stencils; gives the weights, vertex by vertex. For a scheme with one-ring support they are the
//! stencil's; for one with two-ring support the stencil's after one refinement, by the weights of that refinement.

use super::evaluate::{Stencils, for_each_of_two_ring, stays};
use super::quads::QuadLimits;
use super::refined::{Refined, RefinedWeights};
use super::{LimitError, LimitTable};
use crate::index::{HalfEdgeId, VertexId};
use crate::masks::Masks;
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::{self, Poll};
use crate::progress::Cancelled;
use crate::row::{Row, summed};
use crate::scheme::Support;

/// Vertices whose weights are found together.
const PIECE: usize = 1 << 10;

/// The weights of all limit positions, those that are zero left out.
pub(crate) struct LimitRows {
    /// Where each vertex's weights start, and their end as a last entry.
    pub(crate) starts: Vec<usize>,
    /// The control vertices; each once in a row.
    pub(crate) vertices: Vec<u32>,
    /// Their weights, which sum to 1 in each row.
    pub(crate) weights: Vec<f64>,
}

impl LimitTable<'_> {
    /// The weights that the limit position of each vertex of `mesh` has on the mesh's vertices.
    pub(crate) fn position_rows(
        &self,
        mesh: &Mesh,
        poll: &mut Poll<'_>,
    ) -> Result<Result<LimitRows, LimitError>, Cancelled> {
        let stencils = match Stencils::of(self, mesh, poll)? {
            Ok(stencils) => stencils,
            Err(error) => return Ok(Err(error)),
        };
        let sharpness = Sharpness::of(mesh);
        let quads = mesh.topology().has_quads();
        let quads = quads.then(|| QuadLimits::of(mesh, &sharpness));
        let row = |v: usize| match &quads {
            Some(quads) => quads.row(VertexId(v as u32)),
            None => self.row(mesh, VertexId(v as u32), stencils.at(v).position()),
        };
        let nowhere = &mut |_| poll(0);
        let pieces = parallel::pieces_polled(mesh.vertex_count(), PIECE, nowhere, |piece| {
            let (mut lengths, mut entries) = (Vec::with_capacity(piece.len()), Vec::new());
            for row in piece.map(row) {
                lengths.push(row.len());
                entries.extend(row);
            }
            (lengths, entries)
        })?;
        let mut rows = LimitRows {
            starts: vec![0],
            vertices: Vec::new(),
            weights: Vec::new(),
        };
        for (lengths, entries) in pieces {
            let mut end = rows.vertices.len();
            rows.starts.extend(lengths.into_iter().map(|length| {
                end += length;
                end
            }));
            rows.vertices.extend(entries.iter().map(|&(v, _)| v));
            rows.weights
                .extend(entries.iter().map(|&(_, weight)| weight));
        }
        Ok(Ok(rows))
    }

    /// The weights that the limit position of one vertex has on the mesh's vertices.
    pub(crate) fn position_row(&self, mesh: &Mesh, vertex: VertexId) -> Result<Row, LimitError> {
        let stencil = self.stencil_at(mesh, &Sharpness::of(mesh), vertex)?;
        Ok(self.row(mesh, vertex, stencil.position()))
    }

    /// The weights that two tangents have on the mesh's vertices at the vertex that `corner`
    /// leaves, on the side of its face: [`Self::normal_at`] is perpendicular to these where they
    /// span a plane.
    pub(crate) fn tangent_rows(
        &self,
        mesh: &Mesh,
        corner: HalfEdgeId,
    ) -> Result<[Row; 2], LimitError> {
        let vertex = mesh.topology().origin(corner);
        let stencil = self.stencil_at(mesh, &Sharpness::of(mesh), vertex)?;
        let Some(side) = stencil.side_of(mesh, corner) else {
            return Ok(Default::default());
        };
        let tangents = side.tangents;
        if tangents.is_empty() {
            return Ok(Default::default());
        }
        Ok([0, 1].map(|axis| {
            let weights = || tangents.iter().map(|weights| weights[axis]);
            // Tangents are sums of differences to the vertex.
            let all: Vec<f64> = core::iter::once(-weights().sum::<f64>())
                .chain(weights())
                .collect();
            self.row(mesh, vertex, &all)
        }))
    }

    fn row(&self, mesh: &Mesh, vertex: VertexId, weights: &[f64]) -> Row {
        match self.scheme().support() {
            _ if stays(weights) => vec![(vertex.0, 1.0)],
            Support::OneRing => one_ring_row(mesh, vertex, weights),
            Support::TwoRing => {
                let refined = RefinedWeights(Masks::on_demand(mesh, self.scheme()));
                two_ring_row(mesh, vertex, weights, &refined)
            }
        }
    }
}

fn one_ring_row(mesh: &Mesh, vertex: VertexId, weights: &[f64]) -> Row {
    let ring = mesh
        .topology()
        .ring(vertex)
        .map(|v| v.0)
        .zip(weights[1..].iter().copied());
    let all = core::iter::once((vertex.0, weights[0])).chain(ring);
    all.filter(|&(_, weight)| weight != 0.0).collect()
}

fn two_ring_row(
    mesh: &Mesh,
    vertex: VertexId,
    weights: &[f64],
    refined: &RefinedWeights<'_>,
) -> Row {
    let mut row: Row = Vec::new();
    let mut add = |weight: f64, point: Vec<(VertexId, f64)>| {
        row.extend(point.into_iter().map(|(v, share)| (v.0, weight * share)));
    };
    add(weights[0], refined.moved(vertex));
    for_each_of_two_ring(mesh.topology(), vertex, refined, |i, point| {
        add(weights[i + 1], point)
    });
    summed(row)
}
