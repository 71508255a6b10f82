//! Lines of creases and boundaries whose edges are of very different lengths.
//!
//! A limit curve through points that are spaced unevenly runs past those beside a long edge and comes back: it knows no lengths. Where a long
//! straight edge of a part meets the short ones of a rounding, or a vertex stands near the end of an edge, it leaves the part by more than
//! the rounding is large, and the flat faces beside it fold. So for a vertex beside an edge that is more than [`MOST_UNEVEN`] times as
//! long as the edges at its ends are, what is asked is not that its limit be at it, but that it would be if that edge were so much
//! shorter. With v the vertex, u the one at the other end and w < 1 the part that is left of the edge, v + w(u − v) takes u's place in
//! v's row: the weights of the row still sum to 1, and v has more of it. The limit then lies beyond v along the long edge, and the curve
//! passes v by less than it turns there: not at all where it is straight.

use super::sparse::Sparse;
use crate::index::VertexId;
use crate::mesh::{Mesh, Sharpness};
use crate::vector::{diagonal, vector};

/// How many times as long as the shorter edges at its ends an edge may be for a line to be led through these.
pub(super) const MOST_UNEVEN: f64 = 3.0;

/// The system with shorter edges where lines are uneven, and by row whether that changed it.
pub(super) fn evened(matrix: &Sparse, mesh: &Mesh) -> (Sparse, Vec<bool>) {
    let sharpness = Sharpness::of(mesh);
    let is_on_line = |v: usize| {
        let vertex = VertexId(v as u32);
        matrix.columns(v).len() == 3 && (mesh.topology().is_boundary(vertex) || sharpness.is_tagged(vertex))
    };
    let at = |v: u32| vector(mesh.positions()[v as usize]);
    let length = |v: u32, u: u32| diagonal(at(v).min(at(u)), at(v).max(at(u)));
    let others = |v: u32| matrix.columns(v as usize).iter().copied().filter(move |&u| u != v);
    // Of a vertex that is not on a line nobody knows how long edges should be.
    let shortest = |v: u32| match is_on_line(v as usize) {
        true => others(v).map(|u| length(v, u)).fold(f64::INFINITY, f64::min),
        false => f64::INFINITY,
    };
    let mut evened = Sparse::empty();
    let mut is_relaxed = vec![false; matrix.rows()];
    for v in 0..matrix.rows() as u32 {
        let row = matrix.row(v as usize);
        if !is_on_line(v as usize) {
            evened.push(row);
            continue;
        }
        let own_shortest = shortest(v);
        let left = |u: u32| {
            let most = MOST_UNEVEN * own_shortest.min(shortest(u));
            let length = length(v, u);
            if length > most { most / length } else { 1.0 }
        };
        let shortened: Vec<(u32, f64)> =
            row.map(|(u, weight)| (u, if u == v { weight } else { weight * left(u) })).collect();
        let missing = 1.0 - shortened.iter().map(|&(_, weight)| weight).sum::<f64>();
        is_relaxed[v as usize] = others(v).any(|u| left(u) < 1.0);
        let own = if is_relaxed[v as usize] { missing } else { 0.0 };
        evened.push(shortened.into_iter().map(|(u, weight)| (u, if u == v { weight + own } else { weight })));
    }
    (evened, is_relaxed)
}
