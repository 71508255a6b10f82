//! Cutting faces apart into sheets, each of them a manifold, and remembering where they belong together.
//!
//! Takes oriented triangles with twins; each fan of faces at a vertex gets its own copy of it. Gives the
//! copies' groups and the corner tags that keep the copies of a vertex at one place under refinement: along a
//! cut, boundary rules use the cut's own vertices only, so that copies with the same two boundary neighbours
//! move alike; all other copies (ends and branches of a cut, tips of bow-ties) are made corners.

use std::collections::HashMap;

use super::orient::Neighbours;
use super::triangulate::Faces;
use crate::geometry::{DisjointSets, NONE};
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Diagnosis, Groups, Junctions, Topology, outgoing_half_edges};

/// Manifold sheets.
pub(super) struct Sheets {
    pub(super) topology: Topology,
    /// Which input face each face is from.
    pub(super) inputs: Vec<u32>,
    /// The original vertex of each copy.
    pub(super) copied: Vec<u32>,
    /// Ends of cut edges between which a vertex was added in the middle.
    pub(super) middles: Vec<Middle>,
    pub(super) junctions: Junctions,
    /// Vertices that must keep their place, in ascending order.
    pub(super) corners: Vec<u32>,
}

/// Vertices added in the middle of a cut edge.
pub(super) struct Middle {
    /// The edge's ends before cutting.
    pub(super) ends: [u32; 2],
    /// The first of them, which represents all.
    pub(super) vertex: u32,
}

/// Gives each fan of faces its own vertices; `name` gives a vertex's number in the input.
pub(super) fn cut(
    Faces { triangles, inputs }: Faces,
    neighbours: Neighbours,
    vertex_count: usize,
    name: impl Fn(u32) -> u32,
    diagnosis: &mut Diagnosis,
) -> Sheets {
    let Neighbours { twins, cuts } = neighbours;
    let (copied, middles) = (Vec::new(), Vec::new());
    let mut cutting = Cutting {
        triangles,
        inputs,
        twins,
        vertex_count,
        copied,
        middles,
    };
    cutting.separate_fans();
    if !cutting.copied.is_empty() {
        diagnosis
            .bow_tie_vertices
            .add_all(cutting.bow_ties(&cuts).into_iter().map(name).collect());
    }
    let edges = cutting.open_slits(cuts);
    let total = vertex_count + cutting.copied.len();
    let outgoing = outgoing_half_edges(&cutting.triangles, &cutting.twins, total);
    let Cutting {
        triangles,
        inputs,
        twins,
        copied,
        middles,
        ..
    } = cutting;
    let topology = Topology::from_parts(triangles, twins, outgoing);
    let vertices = copy_groups(vertex_count, &copied);
    let corners = fixed_copies(&topology, vertex_count, &copied, &vertices);
    Sheets {
        topology,
        inputs,
        copied,
        middles,
        junctions: Junctions { vertices, edges },
        corners,
    }
}

struct Cutting {
    triangles: Vec<[u32; 3]>,
    inputs: Vec<u32>,
    twins: Vec<u32>,
    /// Vertices before cutting; copies follow.
    vertex_count: usize,
    copied: Vec<u32>,
    middles: Vec<Middle>,
}

impl Cutting {
    fn corner(&self, h: u32) -> u32 {
        self.triangles.as_flattened()[h as usize]
    }

    fn ends(&self, h: u32) -> [u32; 2] {
        [self.corner(h), self.corner(HalfEdgeId(h).next().0)]
    }

    /// The vertex before cutting.
    fn original(&self, v: u32) -> u32 {
        (v as usize)
            .checked_sub(self.vertex_count)
            .map_or(v, |copy| self.copied[copy])
    }

    /// The first fan met keeps the vertex, each further one gets a copy.
    fn separate_fans(&mut self) {
        let mut met = vec![false; self.vertex_count];
        let mut done = vec![false; self.twins.len()];
        for start in 0..self.twins.len() as u32 {
            if done[start as usize] {
                continue;
            }
            let vertex = self.corner(start);
            let own = if core::mem::replace(&mut met[vertex as usize], true) {
                self.copied.push(vertex);
                (self.vertex_count + self.copied.len() - 1) as u32
            } else {
                vertex
            };
            let mut mark = |triangles: &mut [[u32; 3]], h: u32| {
                done[h as usize] = true;
                triangles.as_flattened_mut()[h as usize] = own;
            };
            mark(&mut self.triangles, start);
            let mut h = self.twins[HalfEdgeId(start).previous().index()];
            while h != NONE && h != start {
                mark(&mut self.triangles, h);
                h = self.twins[HalfEdgeId(h).previous().index()];
            }
            if h == start {
                continue;
            }
            // An open fan: the faces on the other side of where it was entered.
            let mut across = self.twins[start as usize];
            while across != NONE {
                let h = HalfEdgeId(across).next().0;
                mark(&mut self.triangles, h);
                across = self.twins[h as usize];
            }
        }
    }

    /// Vertices whose fans are not connected through cut edges.
    fn bow_ties(&self, cuts: &Groups) -> Vec<u32> {
        let mut sets = DisjointSets::new(self.vertex_count + self.copied.len());
        for edge in cuts.iter() {
            let mut first = self.ends(edge[0]);
            first.sort_unstable_by_key(|&v| self.original(v));
            for &h in &edge[1..] {
                let mut ends = self.ends(h);
                ends.sort_unstable_by_key(|&v| self.original(v));
                for (a, b) in first.into_iter().zip(ends) {
                    sets.unite(a, b);
                }
            }
        }
        // The root of a set is its lowest member; one set at each vertex holds the vertex itself.
        let mut found: Vec<u32> = (0..self.copied.len())
            .filter(|&copy| {
                sets.root((self.vertex_count + copy) as u32) as usize >= self.vertex_count
            })
            .map(|copy| self.copied[copy])
            .collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// A cut edge both of whose ends lie inside a sheet leaves a slit there with two lips between
    /// the same two vertices, which indices cannot distinguish from an uncut edge. Such an edge
    /// gets a vertex in its middle, one for each face. Gives the groups of half-edges along cut
    /// edges.
    fn open_slits(&mut self, cuts: Groups) -> Groups {
        let mut moved = HashMap::new();
        let mut edges: Vec<Vec<u32>> = Vec::with_capacity(cuts.len());
        let mut ends = Vec::new();
        for edge in cuts.iter() {
            let edge: Vec<u32> = edge.iter().map(|&h| follow(&moved, h)).collect();
            ends.clear();
            ends.extend(edge.iter().map(|&h| {
                let [a, b] = self.ends(h);
                [a.min(b), a.max(b)]
            }));
            ends.sort_unstable();
            if ends.windows(2).all(|pair| pair[0] != pair[1]) {
                edges.push(edge);
                continue;
            }
            edges.extend(self.split_edge(&edge, &mut moved));
        }
        let mut groups = Groups::default();
        for edge in edges {
            groups.push(edge.into_iter().map(|h| follow(&moved, h)));
        }
        groups
    }

    /// Splits each face along a cut edge in two; gives the two groups of half-edges.
    fn split_edge(&mut self, edge: &[u32], moved: &mut HashMap<u32, u32>) -> [Vec<u32>; 2] {
        let mut halves = [Vec::new(), Vec::new()];
        let ends = self.ends(edge[0]).map(|v| self.original(v));
        let first = (self.vertex_count + self.copied.len()) as u32;
        for &h in edge {
            let h = follow(moved, h);
            let runs_along = self.original(self.corner(h)) == ends[0];
            let second = self.split_half_edge(h, first, moved);
            let [near, far] = if runs_along { [h, second] } else { [second, h] };
            halves[0].push(near);
            halves[1].push(far);
        }
        self.middles.push(Middle {
            ends,
            vertex: first,
        });
        halves
    }

    /// Inserts a vertex in the middle of `h`: its face keeps the first half, a new one gets the second, which is
    /// returned.
    fn split_half_edge(&mut self, h: u32, original: u32, moved: &mut HashMap<u32, u32>) -> u32 {
        let (next, previous) = (HalfEdgeId(h).next(), HalfEdgeId(h).previous());
        let (to, apex) = (self.corner(next.0), self.corner(previous.0));
        let middle = (self.vertex_count + self.copied.len()) as u32;
        self.copied.push(original);
        let second = 3 * self.triangles.len() as u32;
        self.triangles.push([middle, to, apex]);
        self.inputs.push(self.inputs[h as usize / 3]);
        self.triangles.as_flattened_mut()[next.index()] = middle;
        let across = self.twins[next.index()];
        self.twins.extend([NONE, across, next.0]);
        if across != NONE {
            self.twins[across as usize] = second + 1;
        }
        self.twins[next.index()] = second + 2;
        moved.insert(next.0, second + 1);
        second
    }
}

/// Where a half-edge went when its face was split.
fn follow(moved: &HashMap<u32, u32>, mut h: u32) -> u32 {
    while let Some(&to) = moved.get(&h) {
        h = to;
    }
    h
}

/// The copies of each vertex that has several.
fn copy_groups(vertex_count: usize, copied: &[u32]) -> Groups {
    let mut pairs: Vec<(u32, u32)> = copied
        .iter()
        .enumerate()
        .map(|(i, &original)| (original, (vertex_count + i) as u32))
        .collect();
    pairs.sort_unstable();
    let mut groups = Groups::default();
    for run in pairs.chunk_by(|a, b| a.0 == b.0) {
        let (original, first) = run[0];
        // A vertex in the middle of a split edge has copies only, the first of which names them all.
        let whole = (original != first).then_some(original);
        groups.push(whole.into_iter().chain(run.iter().map(|&(_, copy)| copy)));
    }
    groups
}

/// Members of the groups that would not move alike, in ascending order.
fn fixed_copies(
    topology: &Topology,
    vertex_count: usize,
    copied: &[u32],
    groups: &Groups,
) -> Vec<u32> {
    let original = |v: VertexId| {
        v.index()
            .checked_sub(vertex_count)
            .map_or(v.0, |copy| copied[copy])
    };
    let boundary_neighbours = |v: u32| {
        let v = VertexId(v);
        let ring = topology.is_boundary(v).then(|| topology.ring(v))?;
        let first = original(topology.target(topology.outgoing(v)));
        let last = original(ring.last()?);
        Some([first.min(last), first.max(last)])
    };
    let mut fixed = Vec::new();
    for group in groups.iter() {
        let along = boundary_neighbours(group[0]);
        let is_end = along.is_none_or(|[first, last]| first == last);
        if is_end || group[1..].iter().any(|&v| boundary_neighbours(v) != along) {
            fixed.extend_from_slice(group);
        }
    }
    fixed.sort_unstable();
    fixed
}
