//! Which triangles meet at each edge.
//!
//! Takes triangles by their indices, of any kind: non-manifold, of either orientation, naming a
//! vertex twice. Linear in their number, except for sorting the few sides at each vertex.

use crate::parallel::Poll;
use crate::progress::Cancelled;

/// A side of a triangle, as seen from the lower of its vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeSide {
    /// The higher vertex.
    pub(crate) higher: u32,
    /// `3 · triangle + corner`, running from that corner to the next.
    pub(crate) side: u32,
}

/// Vertices and triangles between two calls of the poll.
const BETWEEN_POLLS: usize = 1 << 16;

/// Calls `visit` with the lower vertex of each edge and the sides along it, in ascending order of
/// their numbers; the edges come by their lower, then by their higher vertex. Triangles that name a
/// vertex twice have no edges. Vertices are below `vertex_count` and triangles few enough for their
/// sides to be numbered. `poll` receives the number of triangles done.
pub(crate) fn for_each_edge(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    poll: &mut Poll<'_>,
    mut visit: impl FnMut(u32, &[EdgeSide]),
) -> Result<(), Cancelled> {
    let mut starts = vec![0u32; vertex_count + 1];
    for_each_side(triangles, 0, poll, |_, lower, _| {
        starts[lower as usize + 1] += 1
    })?;
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut sides = vec![EdgeSide { higher: 0, side: 0 }; starts[vertex_count] as usize];
    for_each_side(
        triangles,
        triangles.len() / 3,
        poll,
        |side, lower, higher| {
            // Filling moves each vertex's start to its end, which is the next one's start.
            let place = &mut starts[lower as usize];
            sides[*place as usize] = EdgeSide { higher, side };
            *place += 1;
        },
    )?;
    let mut start = 0;
    for (v, &end) in starts[..vertex_count].iter().enumerate() {
        let own = &mut sides[start..end as usize];
        own.sort_unstable();
        own.chunk_by(|a, b| a.higher == b.higher)
            .for_each(|edge| visit(v as u32, edge));
        start = end as usize;
        if v % BETWEEN_POLLS == 0 {
            poll(triangles.len() * 2 / 3 + start / 9)?;
        }
    }
    poll(triangles.len())
}

/// [`for_each_edge`] without polling.
pub(crate) fn every_edge(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    visit: impl FnMut(u32, &[EdgeSide]),
) {
    let done = for_each_edge(triangles, vertex_count, &mut |_| Ok(()), visit);
    debug_assert_eq!(done, Ok(()));
}

/// Calls `f(side, lower vertex, higher vertex)` for the sides of all triangles with three different vertices. A third of
/// the triangles counts as done by the end, after those that are `done` before.
fn for_each_side(
    triangles: &[[u32; 3]],
    done: usize,
    poll: &mut Poll<'_>,
    mut f: impl FnMut(u32, u32, u32),
) -> Result<(), Cancelled> {
    for (run, part) in triangles.chunks(BETWEEN_POLLS).enumerate() {
        for (i, &[a, b, c]) in part.iter().enumerate() {
            if a == b || b == c || c == a {
                continue;
            }
            let first = 3 * (run * BETWEEN_POLLS + i) as u32;
            for (side, from, to) in [(first, a, b), (first + 1, b, c), (first + 2, c, a)] {
                f(side, from.min(to), from.max(to));
            }
        }
        poll(done + run * BETWEEN_POLLS / 3)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn edges_are_those_of_a_map_and_come_in_its_order() {
        // A closed tetrahedron, one of its faces turned round; a fin on one edge; a triangle naming a vertex twice; two
        // apart that share vertex 7 alone.
        let triangles: [[u32; 3]; 8] = [
            [0, 1, 2],
            [0, 3, 1],
            [1, 3, 2],
            [0, 3, 2],
            [0, 1, 4],
            [2, 2, 3],
            [7, 5, 6],
            [9, 8, 7],
        ];
        let mut expected = BTreeMap::<(u32, u32), Vec<u32>>::new();
        for (face, t) in triangles.iter().enumerate().filter(|(face, _)| *face != 5) {
            for corner in 0..3 {
                let (a, b) = (t[corner], t[(corner + 1) % 3]);
                expected
                    .entry((a.min(b), a.max(b)))
                    .or_default()
                    .push((3 * face + corner) as u32);
            }
        }
        let mut found = Vec::new();
        every_edge(&triangles, 10, |lower, edge| {
            found.push((
                (lower, edge[0].higher),
                edge.iter().map(|use_| use_.side).collect::<Vec<u32>>(),
            ));
        });
        assert_eq!(found, expected.into_iter().collect::<Vec<_>>());
    }
}
