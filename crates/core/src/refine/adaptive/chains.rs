//! The vertices on the edges of control faces, and their numbers.
//!
//! Along a control edge stand the vertices that the nodes on any side of it have put there. Both faces of an edge share
//! them; the copies of a cut edge have the same ones, each its own.

use core::ops::Range;

use super::quadtree::{Edges, FULL, Trees};
use super::walk::{EdgeVertex, Side, merged, merged_all};
use crate::mesh::Mesh;
use crate::progress::{Cancelled, SharedWatch};

/// Control faces that one call takes together.
const BLOCK: usize = 1024;

/// The vertices on all control edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Chains {
    /// By half-edge, where its vertices start; those of a half-edge whose twin comes first are the twin's.
    starts: Vec<u32>,
    /// Places along the half-edge.
    at: Vec<u32>,
    /// The number of the first.
    base: u32,
}

impl Chains {
    /// Those of some trees.
    pub(super) fn of(
        mesh: &Mesh,
        edges: &Edges<'_>,
        trees: &Trees,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let mut groups = Vec::with_capacity(edges.group_count());
        watch.each(0..edges.group_count(), |group| {
            groups.push(group_places(edges, trees, group))
        })?;
        let blocks = watch.pieces(mesh.face_count(), BLOCK, |block| {
            let (mut counts, mut at) = (Vec::with_capacity(3 * block.len()), Vec::new());
            for h in 3 * block.start as u32..3 * block.end as u32 {
                let start = at.len();
                places(edges, trees, &groups, h, &mut at);
                counts.push((at.len() - start) as u32);
            }
            (counts, at)
        })?;
        Self::joined(mesh, blocks, watch)
    }

    /// These with others inserted: half-edges that keep vertices, ascending, and places on these.
    pub(super) fn with_inserted(
        &self,
        mesh: &Mesh,
        inserted: &[(u32, u32)],
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let blocks = watch.pieces(mesh.face_count(), BLOCK, |block| {
            let (mut counts, mut at) = (Vec::with_capacity(3 * block.len()), Vec::new());
            let [mut kept, end] = [block.start, block.end].map(|face| 3 * face as u32);
            let first = inserted.partition_point(|&(h, _)| h < kept);
            let last = inserted.partition_point(|&(h, _)| h < end);
            for new in inserted[first..last].chunk_by(|a, b| a.0 == b.0) {
                let h = new[0].0;
                self.copy(kept..h, &mut counts, &mut at);
                let start = at.len();
                merge(self.own(h).1, new, &mut at);
                counts.push((at.len() - start) as u32);
                kept = h + 1;
            }
            self.copy(kept..end, &mut counts, &mut at);
            (counts, at)
        })?;
        Self::joined(mesh, blocks, watch)
    }

    /// The vertices of consecutive control faces: how many each half-edge keeps, and their places.
    fn joined(
        mesh: &Mesh,
        blocks: Vec<(Vec<u32>, Vec<u32>)>,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let mut chains = Self {
            starts: Vec::with_capacity(3 * mesh.face_count() + 1),
            at: Vec::new(),
            base: mesh.vertex_count() as u32,
        };
        let mut start = 0;
        for (counts, mut at) in blocks {
            for count in counts {
                chains.starts.push(start);
                start += count;
            }
            chains.at.append(&mut at);
            watch.poll()?;
        }
        chains.starts.push(start);
        Ok(chains)
    }

    /// Appends how many vertices half-edges keep, and their places.
    fn copy(&self, half_edges: Range<u32>, counts: &mut Vec<u32>, at: &mut Vec<u32>) {
        if half_edges.is_empty() {
            return;
        }
        let starts = &self.starts[half_edges.start as usize..=half_edges.end as usize];
        counts.extend(starts.windows(2).map(|pair| pair[1] - pair[0]));
        at.extend_from_slice(&self.at[starts[0] as usize..starts[starts.len() - 1] as usize]);
    }

    /// Vertices on edges.
    pub(super) fn count(&self) -> usize {
        self.at.len()
    }

    /// The vertices along a half-edge that has its own: the number of the first, and the places.
    pub(super) fn own(&self, h: u32) -> (u32, &[u32]) {
        let (start, end) = (self.starts[h as usize], self.starts[h as usize + 1]);
        (self.base + start, &self.at[start as usize..end as usize])
    }

    /// How many vertices are inside an edge, from any side of it.
    pub(super) fn along(&self, edges: &Edges<'_>, h: u32) -> usize {
        self.own(first_of(edges, h)).1.len()
    }

    /// Whether there are none on the edges of a control face.
    pub(super) fn are_none(&self, edges: &Edges<'_>, face: u32) -> bool {
        (3 * face..3 * face + 3).all(|h| self.along(edges, h) == 0)
    }

    /// The numbers of those.
    pub(super) fn vertices(&self, edges: &Edges<'_>, h: u32) -> Range<usize> {
        let (first, places) = self.own(first_of(edges, h));
        first as usize..first as usize + places.len()
    }

    /// Appends the edge vertices of a face's edges, and says where they are.
    pub(super) fn sides(
        &self,
        mesh: &Mesh,
        edges: &Edges<'_>,
        face: u32,
        edge_vertices: &mut Vec<EdgeVertex>,
    ) -> [Side; 3] {
        let corners = mesh.triangles()[face as usize];
        [0, 1, 2].map(|edge| {
            let h = 3 * face + edge as u32;
            let first = edge_vertices.len();
            let owner = first_of(edges, h);
            let (number, at) = self.own(owner);
            edge_vertices.push(EdgeVertex::new(0, corners[edge]));
            if owner == h {
                edge_vertices.extend(
                    (number..)
                        .zip(at)
                        .map(|(vertex, &at)| EdgeVertex::new(at, vertex)),
                );
            } else {
                let numbers = (number..number + at.len() as u32).rev();
                edge_vertices.extend(
                    numbers
                        .zip(at.iter().rev())
                        .map(|(vertex, &at)| EdgeVertex::new(FULL - at, vertex)),
                );
            }
            edge_vertices.push(EdgeVertex::new(FULL, corners[(edge + 1) % 3]));
            Side {
                first,
                last: edge_vertices.len() - 1,
                reversed: false,
            }
        })
    }
}

/// Places along a half-edge with others between them, which may be the same.
fn merge(known: &[u32], new: &[(u32, u32)], at: &mut Vec<u32>) {
    let mut new = new.iter().map(|&(_, place)| place).peekable();
    for &known in known {
        at.extend(core::iter::from_fn(|| new.next_if(|&place| place < known)));
        new.next_if_eq(&known);
        at.push(known);
    }
    at.extend(new);
}

/// The half-edge that keeps the vertices of an edge.
pub(super) fn first_of(edges: &Edges<'_>, h: u32) -> u32 {
    edges.twin(h).map_or(h, |twin| twin.min(h))
}

/// The places along a half-edge, if it keeps them.
fn places(edges: &Edges<'_>, trees: &Trees, groups: &[Vec<u32>], h: u32, at: &mut Vec<u32>) {
    let own = (trees.root(h / 3), (h % 3) as usize, false);
    if let Some(twin) = edges.twin(h) {
        if h < twin {
            let other = (trees.root(twin / 3), (twin % 3) as usize, true);
            merged(trees, &[own, other], 0, FULL, &mut |place| at.push(place));
        }
    } else if let Some(group) = edges.group(h) {
        let turned = edges
            .members(group)
            .iter()
            .any(|&(member, turned)| member == h && turned);
        if turned {
            at.extend(groups[group].iter().rev().map(|&place| FULL - place));
        } else {
            at.extend(&groups[group]);
        }
    } else {
        merged(trees, &[own], 0, FULL, &mut |place| at.push(place));
    }
}

/// The places along all copies of an edge, as its first copy counts.
fn group_places(edges: &Edges<'_>, trees: &Trees, group: usize) -> Vec<u32> {
    let members = edges.members(group).iter();
    let members: Vec<_> = members
        .map(|&(h, turned)| (trees.root(h / 3), (h % 3) as usize, turned))
        .collect();
    let mut at = Vec::new();
    merged_all(trees, &members, 0, FULL, &mut |place| at.push(place));
    at
}
