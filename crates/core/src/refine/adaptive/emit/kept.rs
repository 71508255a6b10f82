//! Control faces as they were emitted before: what is on their edges and inside them has only other numbers.
//!
//! Where the arrays are those of the emission before ([`super::arrays`]) everything lies where it belongs by now, and is numbered
//! anew; into others it is copied.

use super::super::chains::{Chains, first_of};
use super::super::close::Closed;
use super::super::judge::Condition;
use super::super::quadtree::Edges;
use super::Emission;
use super::jobs::Job;
use super::leaf_writer::{Vertices, split_off};
use crate::mesh::{Mesh, NONE};
use crate::parallel::IsStopped;

/// Vertices and triangles that are copied between two questions whether that is still of use.
pub(super) const COPIED: usize = 1 << 16;

/// What was emitted before.
pub(super) struct Kept<'a> {
    pub(super) before: &'a Emission,
    pub(super) mesh: &'a Mesh,
    pub(super) edges: &'a Edges<'a>,
    pub(super) chains: &'a Chains,
    /// Whether the arrays are its own.
    pub(super) is_in_place: bool,
}

/// Some vertices with consecutive numbers, and the first of their numbers now.
#[derive(Clone, Copy)]
struct Run {
    before: u32,
    count: u32,
    now: u32,
}

impl Run {
    #[inline]
    fn renumbered(self, vertex: u32) -> Option<u32> {
        let at = vertex.wrapping_sub(self.before);
        (at < self.count).then(|| self.now + at)
    }

    fn is_same(&self) -> bool {
        self.count == 0 || self.before == self.now
    }
}

impl Kept<'_> {
    /// Writes the faces of a job; gives their leaves that pass on conditions.
    pub(super) fn take_over(
        &self,
        closed: &[Closed],
        mut job: Job<'_>,
        is_stopped: &IsStopped<'_>,
    ) -> Vec<(Condition, u32, u32)> {
        let mut first_triangle = job.first_triangle;
        let mut conditions = Vec::new();
        let mut inside = job.inside.first;
        for face in job.faces.clone() {
            let (own, shared) = self.on_edges(face);
            own.into_iter()
                .for_each(|run| self.vertices(run, &mut job.on_edges, is_stopped));
            let within = Run {
                before: self.before.numbers.inside[face as usize],
                count: closed[face as usize].vertices,
                now: inside,
            };
            self.vertices(within, &mut job.inside, is_stopped);
            inside += within.count;
            let runs = [within, shared[0], shared[1], shared[2]];
            conditions.extend(self.conditions(face, first_triangle));
            first_triangle += self.triangles(face, &runs, first_triangle, (&mut job, is_stopped));
        }
        conditions
    }

    /// The leaves of a face that pass on conditions, its first triangle now being given.
    fn conditions(&self, face: u32, now: u32) -> impl Iterator<Item = (Condition, u32, u32)> {
        let conditions = &self.before.conditions;
        let start = conditions.partition_point(|(condition, ..)| condition.place.face < face);
        let own = conditions[start..]
            .iter()
            .take_while(move |(condition, ..)| condition.place.face == face);
        let before = self.before.triangles_of(face).start as u32;
        own.map(move |&(condition, first, last)| {
            (condition, first - before + now, last - before + now)
        })
    }

    /// The vertices on a face's edges: its own, and all.
    fn on_edges(&self, face: u32) -> ([Run; 3], [Run; 3]) {
        let run = |h: u32| {
            let (now, places) = self.chains.own(h);
            Run {
                before: self.before.numbers.on_edges[h as usize],
                count: places.len() as u32,
                now,
            }
        };
        let edges = [0, 1, 2].map(|edge| 3 * face + edge);
        (edges.map(run), edges.map(|h| run(first_of(self.edges, h))))
    }

    /// Copies vertices that are not there yet.
    fn vertices(&self, run: Run, to: &mut Vertices<'_>, is_stopped: &IsStopped<'_>) {
        if self.is_in_place {
            return;
        }
        let Emission {
            positions,
            feet,
            normals,
            origins,
            ..
        } = self.before;
        let positions = if feet.is_empty() { positions } else { feet };
        let first = (run.now - to.first) as usize;
        for start in (0..run.count as usize).step_by(COPIED) {
            if start > 0 && is_stopped() {
                return;
            }
            let count = COPIED.min(run.count as usize - start);
            let (from, at) = (run.before as usize + start, first + start);
            let (from, at) = (from..from + count, at..at + count);
            to.positions[at.clone()].copy_from_slice(&positions[from.clone()]);
            to.normals[at.clone()].copy_from_slice(&normals[from.clone()]);
            // Looks do without.
            if !origins.is_empty() && !to.origins.is_empty() {
                to.origins[at].copy_from_slice(&origins[from]);
            }
        }
    }

    /// Numbers the triangles of a face anew, their first one now being given, and what hangs on them; gives how many there are.
    fn triangles(
        &self,
        face: u32,
        runs: &[Run; 4],
        first: u32,
        (job, is_stopped): (&mut Job<'_>, &IsStopped<'_>),
    ) -> u32 {
        let corners = self.mesh.vertex_count() as u32;
        let before = self.before.triangles_of(face);
        let at = (first - job.first_triangle) as usize;
        let count = before.len();
        let renumbered = |vertex: u32| {
            let run = || runs.iter().find_map(|run| run.renumbered(vertex));
            if vertex < corners {
                vertex
            } else {
                run().unwrap_or(NONE)
            }
        };
        let own = 3 * count as u32;
        let start = 3 * before.start as u32;
        // Those of other faces are joined later.
        let moved = |h: u32| {
            if h.wrapping_sub(start) < own {
                h - start + 3 * first
            } else {
                NONE
            }
        };
        let is_same =
            self.is_in_place && before.start as u32 == first && runs.iter().all(Run::is_same);
        for start in (0..count).step_by(COPIED) {
            if start > 0 && is_stopped() {
                return count as u32;
            }
            let copied = COPIED.min(count - start);
            let (from, at) = (before.start + start, at + start);
            let triangles = &mut job.triangles[at..at + copied];
            let twins = &mut job.twins[3 * at..3 * (at + copied)];
            if !self.is_in_place {
                triangles.copy_from_slice(&self.before.triangles[from..from + copied]);
                twins.copy_from_slice(&self.before.twins[3 * from..3 * (from + copied)]);
            }
            if !is_same {
                triangles
                    .iter_mut()
                    .for_each(|triangle| *triangle = triangle.map(renumbered));
            }
            twins.iter_mut().for_each(|twin| *twin = moved(*twin));
        }
        job.parents[at..at + count].fill(face);
        for h in 3 * face..3 * face + 3 {
            let along = self.before.borders.along(h);
            let own = split_off(&mut job.borders, along.len());
            own.iter_mut()
                .zip(along)
                .for_each(|(now, &h)| *now = moved(h));
        }
        count as u32
    }
}
