//! Control faces as they were emitted before: everything lies where it belongs by now ([`super::arrays`]), and is numbered anew.

use super::super::chains::{Chains, first_of};
use super::super::control::Control;
use super::super::cover::Cover;
use super::emission::Emission;
use super::job::{Job, split_off};
use crate::mesh::NONE;
use crate::parallel::IsStopped;

/// Vertices and triangles that are moved between two questions whether that is still of use.
pub(super) const COPIED: usize = 1 << 16;

/// The last emission, of which unchanged faces are kept.
pub(super) struct Kept<'a> {
    pub(super) before: &'a Emission,
    pub(super) control: &'a Control<'a>,
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
    /// Numbers the faces of a job anew.
    pub(super) fn renumber(&self, covers: &[Cover], mut job: Job<'_>, is_stopped: &IsStopped<'_>) {
        let mut first_triangle = job.first_triangle;
        let mut inside = job.inside.first;
        for face in job.faces.clone() {
            let count = covers[face as usize].vertices;
            let within = Run {
                before: self.before.numbers.inside[face as usize],
                count,
                now: inside,
            };
            inside += count;
            let [a, b, c] = [0, 1, 2].map(|edge| self.on_edge(3 * face + edge));
            first_triangle += self.triangles(face, &[within, a, b, c], first_triangle, &mut job);
            if is_stopped() {
                return;
            }
        }
    }

    /// The vertices on the edge of a half-edge.
    fn on_edge(&self, h: u32) -> Run {
        let owner = first_of(&self.control.edges, h);
        let (now, places) = self.chains.own(owner);
        Run {
            before: self.before.numbers.on_edges[owner as usize],
            count: places.len() as u32,
            now,
        }
    }

    /// Numbers the triangles of a face anew, the number of its first one being given, and what belongs to them; gives how many there are.
    fn triangles(&self, face: u32, runs: &[Run; 4], first: u32, job: &mut Job<'_>) -> u32 {
        let corners = self.control.mesh.vertex_count() as u32;
        let before = self.before.triangles_of(face);
        let at = (first - job.first_triangle) as usize;
        let own = at..at + before.len();
        // Those of other faces are joined later.
        let start = 3 * before.start as u32;
        let half_edges = 3 * before.len() as u32;
        let moved = |h: u32| {
            if h.wrapping_sub(start) < half_edges {
                h - start + 3 * first
            } else {
                NONE
            }
        };
        let renumbered = |vertex: u32| {
            let run = || runs.iter().find_map(|run| run.renumbered(vertex));
            debug_assert!(
                vertex < corners || run().is_some(),
                "a vertex of a face that is kept is gone"
            );
            if vertex < corners {
                vertex
            } else {
                run().unwrap_or(NONE)
            }
        };
        if before.start as u32 != first || !runs.iter().all(Run::is_same) {
            let triangles = &mut job.triangles[own.clone()];
            triangles
                .iter_mut()
                .for_each(|triangle| *triangle = triangle.map(renumbered));
        }
        let twins = &mut job.twins[3 * own.start..3 * own.end];
        twins.iter_mut().for_each(|twin| *twin = moved(*twin));
        job.parents[own.clone()].fill(face);
        for h in 3 * face..3 * face + 3 {
            let along = self.before.borders.along(h);
            let borders = split_off(&mut job.borders, along.len());
            borders
                .iter_mut()
                .zip(along)
                .for_each(|(now, &h)| *now = moved(h));
        }
        own.len() as u32
    }
}
