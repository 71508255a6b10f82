//! Sides of sharp edges after a collapse: the corner of the fine mesh for each corner of the coarse
//! one.
//!
//! Takes a fine mesh, edges of it that were kept, and its collapsed mesh; gives, for corners at
//! vertices on sharp edges, a corner of the fine mesh at the same vertex between the same two
//! edges. Vertices go along lines of sharp edges only from their insides, so an edge of the coarse
//! mesh on such a line leads to the first vertex of the fine line that still exists; from edge to
//! edge the corners around a vertex have the same order in both.

use crate::index::VertexId;
use crate::mesh::{Mesh, NONE, Topology};
use crate::simplify::Features;

/// Edges of a mesh along which its sides are distinct: its tags' and some others.
pub(super) struct SharpLines {
    /// Both ways, ascending.
    edges: Vec<[u32; 2]>,
}

impl SharpLines {
    /// The tags of a mesh and `kept` edges, by their ends.
    pub(super) fn new(mesh: &Mesh, kept: &[[u32; 2]]) -> Self {
        let tagged = mesh.tags().creases.iter().map(|crease| crease.vertices);
        let all = tagged.chain(kept.iter().copied());
        let mut edges: Vec<[u32; 2]> = all.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        edges.sort_unstable();
        edges.dedup();
        Self { edges }
    }

    /// The ends of the sharp edges from a vertex.
    fn ends(&self, vertex: u32) -> &[[u32; 2]] {
        let first = self.edges.partition_point(|edge| edge[0] < vertex);
        let count = self.edges[first..].partition_point(|edge| edge[0] == vertex);
        &self.edges[first..first + count]
    }

    /// The first vertex with a number on the way from a vertex over its neighbour and on.
    fn next(&self, from: u32, over: u32, numbers: &[u32]) -> Option<u32> {
        let (mut before, mut at) = (from, over);
        while numbers[at as usize] == NONE {
            let [one, other] = self.ends(at) else {
                return None;
            };
            let onward = if one[1] == before { other[1] } else { one[1] };
            (before, at) = (at, onward);
            if at == from {
                return None;
            }
        }
        Some(at)
    }
}

/// The features that keep the requested edges: these, and the vertices where their lines end or
/// meet.
pub(super) fn features(kept: Vec<[u32; 2]>) -> Features {
    let mut ends: Vec<u32> = kept.iter().flatten().copied().collect();
    ends.sort_unstable();
    let vertices = ends
        .chunk_by(|a, b| a == b)
        .filter(|own| own.len() != 2)
        .map(|own| own[0])
        .collect();
    Features {
        edges: kept,
        vertices,
    }
}

/// Pairs of corners, by the half-edges that leave them: of the coarse mesh, ascending, and of the fine one. `vertices` are the fine
/// mesh's vertices that those of the coarse one are.
pub(super) fn corner_sources(
    fine: &Mesh,
    lines: &SharpLines,
    coarse: &Mesh,
    vertices: &[u32],
) -> Vec<(u32, u32)> {
    let mut numbers = vec![NONE; fine.vertex_count()];
    for (number, &vertex) in vertices.iter().enumerate() {
        numbers[vertex as usize] = number as u32;
    }
    let mut sources = Vec::new();
    for (number, &vertex) in vertices.iter().enumerate() {
        let number = VertexId(number as u32);
        // By half-edge of the coarse mesh along a line, that of the fine one.
        let mut along: Vec<(u32, u32)> = Vec::new();
        for &[_, over] in lines.ends(vertex) {
            let own = half_edge(fine.topology(), VertexId(vertex), over);
            let next = lines.next(vertex, over, &numbers);
            let left =
                next.and_then(|next| half_edge(coarse.topology(), number, numbers[next as usize]));
            along.extend(left.zip(own));
        }
        if along.is_empty() {
            continue;
        }
        if coarse.topology().is_boundary(number) {
            let (left, own) = (
                coarse.topology().outgoing(number),
                fine.topology().outgoing(VertexId(vertex)),
            );
            along.push((left.0, own.0));
        }
        let on_line = |h: u32| {
            along
                .iter()
                .find(|&&(left, _)| left == h)
                .map(|&(_, own)| own)
        };
        let ring: Vec<u32> = coarse
            .topology()
            .outgoing_ring(number)
            .map(|h| h.0)
            .collect();
        let Some(first) = ring.iter().position(|&h| on_line(h).is_some()) else {
            continue;
        };
        let mut own = 0;
        for at in 0..ring.len() {
            let h = ring[(first + at) % ring.len()];
            own = on_line(h).unwrap_or(own);
            sources.push((h, own));
        }
    }
    sources.sort_unstable();
    sources
}

/// The half-edge from a vertex to another, if it has a face.
fn half_edge(topology: &Topology, from: VertexId, to: u32) -> Option<u32> {
    topology
        .outgoing_ring(from)
        .find(|&h| topology.target(h).0 == to)
        .map(|h| h.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simplify::{SimplifyOptions, simplify};

    /// A flat sheet of n × n squares with a line of kept edges along row `at`, from the left to column `end`.
    fn sheet(n: u32, at: u32, end: u32) -> (Mesh, Vec<[u32; 2]>) {
        let vertex = |x: u32, y: u32| y * (n + 1) + x;
        let positions = (0..=n)
            .flat_map(|y| (0..=n).map(move |x| [f64::from(x), f64::from(y), 0.0]))
            .collect();
        let squares = (0..n).flat_map(|y| (0..n).map(move |x| [x, y]));
        let triangles = squares.flat_map(|[x, y]| {
            let [a, b, c, d] =
                [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|[x, y]| vertex(x, y));
            [[a, b, c], [a, c, d]]
        });
        let kept = (0..end)
            .map(|x| [vertex(x, at), vertex(x + 1, at)])
            .collect();
        (
            Mesh::from_triangles(positions, triangles.collect()).expect("a sheet"),
            kept,
        )
    }

    #[test]
    fn corners_stay_on_their_side_of_kept_lines() {
        for end in [8, 5] {
            let (fine, kept) = sheet(8, 3, end);
            let lines = SharpLines::new(&fine, &kept);
            let goals = SimplifyOptions::default().tolerance(Some(1e-6));
            let coarse = simplify(&fine, &features(kept.clone()), &goals).expect("a coarser sheet");
            assert!(
                coarse.mesh.face_count() < 20,
                "{}",
                coarse.mesh.face_count()
            );
            let sources = corner_sources(&fine, &lines, &coarse.mesh, &coarse.vertices);
            assert!(!sources.is_empty() && sources.is_sorted());
            let middle = |mesh: &Mesh, h: u32| {
                mesh.as_triangles()
                    .corners(h as usize / 3)
                    .iter()
                    .map(|corner| corner[1] / 3.0)
                    .sum::<f64>()
            };
            let mut sides = [0; 2];
            for (left, own) in sources {
                let [left_vertex, own_vertex] = [(&coarse.mesh, left), (&fine, own)]
                    .map(|(mesh, h)| mesh.triangles().as_flattened()[h as usize]);
                assert_eq!(coarse.vertices[left_vertex as usize], own_vertex);
                let x = fine.positions()[own_vertex as usize][0];
                // Beyond the line's end its sides are one.
                if x < f64::from(end) || end == 8 {
                    let above = [middle(&coarse.mesh, left), middle(&fine, own)].map(|y| y > 3.0);
                    assert_eq!(above[0], above[1], "vertex {own_vertex}");
                    sides[usize::from(above[0])] += 1;
                }
            }
            assert!(sides[0] > 0 && sides[1] > 0);
        }
    }
}
