//! Control faces as they were emitted before: what is on their edges and inside them has only other numbers.

use super::super::chains::{Chains, first_of};
use super::super::close::Closed;
use super::super::judge::Condition;
use super::super::quadtree::Edges;
use super::leaf_writer::{Vertices, split_off};
use super::{Emission, Job};
use crate::mesh::{Mesh, NONE};

/// What was emitted before.
pub(super) struct Kept<'a> {
    pub(super) before: &'a Emission,
    pub(super) mesh: &'a Mesh,
    pub(super) edges: &'a Edges<'a>,
    pub(super) chains: &'a Chains,
}

/// Some vertices with consecutive numbers, and the first of their numbers now.
#[derive(Clone, Copy)]
struct Run {
    before: u32,
    count: u32,
    now: u32,
}

impl Run {
    fn renumbered(self, vertex: u32) -> Option<u32> {
        let at = vertex.checked_sub(self.before).filter(|&at| at < self.count)?;
        Some(self.now + at)
    }
}

impl Kept<'_> {
    /// Writes the faces of a job; gives their leaves that pass on conditions.
    pub(super) fn take_over(&self, closed: &[Closed], mut job: Job<'_>) -> Vec<(Condition, u32, u32)> {
        let mut first_triangle = job.first_triangle;
        let mut conditions = Vec::new();
        let mut inside = job.inside.first;
        for face in job.faces.clone() {
            let (own, shared) = self.on_edges(face);
            own.into_iter().for_each(|run| self.vertices(run, &mut job.on_edges));
            let within = Run {
                before: self.before.numbers.inside[face as usize],
                count: closed[face as usize].vertices,
                now: inside,
            };
            self.vertices(within, &mut job.inside);
            inside += within.count;
            let runs = [within, shared[0], shared[1], shared[2]];
            conditions.extend(self.conditions(face, first_triangle));
            first_triangle += self.triangles(face, &runs, first_triangle, &mut job);
        }
        conditions
    }

    /// The leaves of a face that pass on conditions, its first triangle now being given.
    fn conditions(&self, face: u32, now: u32) -> impl Iterator<Item = (Condition, u32, u32)> {
        let conditions = &self.before.conditions;
        let start = conditions.partition_point(|(condition, ..)| condition.place.face < face);
        let own = conditions[start..].iter().take_while(move |(condition, ..)| condition.place.face == face);
        let before = self.before.triangles_of(face).start as u32;
        own.map(move |&(condition, first, last)| (condition, first - before + now, last - before + now))
    }

    /// The vertices on a face's edges: its own, and all.
    fn on_edges(&self, face: u32) -> ([Run; 3], [Run; 3]) {
        let run = |h: u32| {
            let (now, places) = self.chains.own(h);
            Run { before: self.before.numbers.on_edges[h as usize], count: places.len() as u32, now }
        };
        let edges = [0, 1, 2].map(|edge| 3 * face + edge);
        (edges.map(run), edges.map(|h| run(first_of(self.edges, h))))
    }

    /// Copies vertices.
    fn vertices(&self, run: Run, to: &mut Vertices<'_>) {
        let from = run.before as usize..(run.before + run.count) as usize;
        let at = (run.now - to.first) as usize;
        let to_range = at..at + run.count as usize;
        let Emission { positions, feet, normals, origins, .. } = self.before;
        let positions = if feet.is_empty() { positions } else { feet };
        to.positions[to_range.clone()].copy_from_slice(&positions[from.clone()]);
        to.normals[to_range.clone()].copy_from_slice(&normals[from.clone()]);
        to.origins[to_range].copy_from_slice(&origins[from]);
    }

    /// Copies the triangles of a face, their first one now being given, and what hangs on them; gives their number.
    fn triangles(&self, face: u32, runs: &[Run; 4], first: u32, job: &mut Job<'_>) -> u32 {
        let corners = self.mesh.vertex_count() as u32;
        let before = self.before.triangles_of(face);
        let at = (first - job.first_triangle) as usize;
        let count = before.len();
        let renumbered = |vertex: u32| {
            let run = || runs.iter().find_map(|run| run.renumbered(vertex));
            if vertex < corners { vertex } else { run().unwrap_or(NONE) }
        };
        for (now, triangle) in
            job.triangles[at..at + count].iter_mut().zip(&self.before.triangles[before.clone()])
        {
            *now = triangle.map(renumbered);
        }
        let half_edges = 3 * before.start as u32..3 * before.end as u32;
        // Those of other faces are joined later.
        let moved = |h: u32| if half_edges.contains(&h) { h - half_edges.start + 3 * first } else { NONE };
        let twins = &self.before.twins[half_edges.start as usize..half_edges.end as usize];
        job.twins[3 * at..3 * (at + count)].iter_mut().zip(twins).for_each(|(now, &twin)| *now = moved(twin));
        job.parents[at..at + count].fill(face);
        for h in 3 * face..3 * face + 3 {
            let along = self.before.borders.along(h);
            let own = split_off(&mut job.borders, along.len());
            own.iter_mut().zip(along).for_each(|(now, &h)| *now = moved(h));
        }
        count as u32
    }
}
