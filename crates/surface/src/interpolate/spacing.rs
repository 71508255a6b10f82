//! Lines of creases and boundaries whose edges are of very different lengths.
//!
//! A limit curve through points that are spaced unevenly overshoots those at a long edge and comes
//! back: it ignores lengths. Where a long straight edge of a part meets the short ones of a
//! rounding, or a vertex is near the end of an edge, it leaves the part by more than the rounding
//! is large, and the adjacent flat faces fold. So a vertex of an edge more than [`MOST_UNEVEN`]
//! times as long as the edges at its ends gets another condition: its limit would be at the vertex
//! if that edge were that much shorter. With v the vertex, u the one at the other end and w < 1 the
//! part that is left of the edge, v + w(u − v) replaces u in v's row: the weights of the row still
//! sum to 1, and v has more of it. The limit then lies beyond v along the long edge, and the curve
//! passes v by less than it turns there: not at all where it is straight.

use std::collections::HashSet;

use super::POLLED;
use super::sparse::Sparse;
use crate::index::VertexId;
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::Poll;
use crate::progress::Cancelled;
use crate::vector::{diagonal, vector};

/// How many times as long as the shorter edges at its ends an edge may be for a line to be led through these.
pub(super) const MOST_UNEVEN: f64 = 3.0;

/// Makes edges shorter where lines are uneven; gives the vertices whose rows that changes.
pub(super) fn even(
    matrix: &mut Sparse,
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    poll: &mut Poll<'_>,
) -> Result<HashSet<u32>, Cancelled> {
    let mut changed = Vec::new();
    for v in 0..matrix.rows() as u32 {
        if v.is_multiple_of(POLLED) {
            poll(v as usize)?;
        }
        let left = |&u: &u32| part_left(matrix, mesh, sharpness, [v, u]);
        if is_on_line(matrix, mesh, sharpness, v)
            && matrix.columns(v as usize).iter().any(|u| left(u) < 1.0)
        {
            changed.push((
                v,
                matrix
                    .columns(v as usize)
                    .iter()
                    .map(left)
                    .collect::<Vec<f64>>(),
            ));
        }
    }
    for (v, left) in &changed {
        let mut taken = 0.0;
        for (weight, left) in matrix.weights_mut(*v as usize).iter_mut().zip(left) {
            taken += *weight * (1.0 - left);
            *weight *= left;
        }
        let own = matrix.columns(*v as usize).iter().position(|u| u == v);
        own.into_iter()
            .for_each(|own| matrix.weights_mut(*v as usize)[own] += taken);
    }
    Ok(changed.into_iter().map(|(v, _)| v).collect())
}

/// Whether the limit of a vertex depends on those before and after it along a line alone.
fn is_on_line(matrix: &Sparse, mesh: &Mesh, sharpness: &Sharpness<'_>, v: u32) -> bool {
    let vertex = VertexId(v);
    matrix.columns(v as usize).len() == 3
        && (mesh.topology().is_boundary(vertex) || sharpness.is_tagged(vertex))
}

/// The part that is left of the edge between two vertices on a line, or of one of these and the line's end; all of it where they are the same.
fn part_left(matrix: &Sparse, mesh: &Mesh, sharpness: &Sharpness<'_>, ends: [u32; 2]) -> f64 {
    let length = length(mesh, ends);
    // At the end of a line there is no edge to compare with.
    let on_line = ends
        .into_iter()
        .filter(|&end| is_on_line(matrix, mesh, sharpness, end));
    let most = MOST_UNEVEN
        * on_line
            .map(|end| shortest(matrix, mesh, end))
            .fold(f64::INFINITY, f64::min);
    if length > most { most / length } else { 1.0 }
}

/// The length of the shortest edge from a vertex to those that its limit depends on.
fn shortest(matrix: &Sparse, mesh: &Mesh, v: u32) -> f64 {
    let others = matrix.columns(v as usize).iter().filter(|&&u| u != v);
    others
        .map(|&u| length(mesh, [v, u]))
        .fold(f64::INFINITY, f64::min)
}

/// Whether the edges from a vertex to those that its limit depends on are of very different lengths.
pub(super) fn is_uneven(matrix: &Sparse, mesh: &Mesh, v: u32) -> bool {
    let most = MOST_UNEVEN * shortest(matrix, mesh, v);
    matrix
        .columns(v as usize)
        .iter()
        .any(|&u| length(mesh, [v, u]) > most)
}

fn length(mesh: &Mesh, ends: [u32; 2]) -> f64 {
    let [a, b] = ends.map(|end| vector(mesh.positions()[end as usize]));
    diagonal(a.min(b), a.max(b))
}
