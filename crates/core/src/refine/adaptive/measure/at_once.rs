//! The triangles of a control face by what was kept of their parts of the surface when these were looked at ([`super::super::bulges`]), four at a
//! time and without the surface: what passes or fails so needs no closer look.

use super::super::bulges::Bulge;
use super::super::measured::FoundLast;
use super::Measuring;
use crate::certificate::{FOUR, MovedFour};
use crate::mesh::NONE;

impl Measuring<'_> {
    /// Measures what it can; gives by triangle whether it is left to be looked at by itself.
    pub(super) fn at_once(&mut self, face: u32, bulge: &Bulge) -> Vec<bool> {
        let triangles = self.emission.triangles_of(face);
        let mut is_left = vec![false; triangles.len()];
        let mut four = MovedFour::default();
        for (number, (parts, is_left)) in triangles
            .clone()
            .step_by(FOUR)
            .zip(bulge.parts.iter().zip(is_left.chunks_mut(FOUR)))
        {
            let is_wanted = |at: usize| {
                let triangle = (number + at) as u32;
                self.changes
                    .is_none_or(|changes| changes.concern(self.emission, triangle))
            };
            let mut wanted = [false; FOUR];
            wanted
                .iter_mut()
                .take(is_left.len())
                .enumerate()
                .for_each(|(at, wanted)| *wanted = is_wanted(at));
            if wanted == [false; FOUR] {
                continue;
            }
            for (at, (is_left, _)) in is_left
                .iter_mut()
                .zip(wanted)
                .enumerate()
                .filter(|(_, (_, wanted))| *wanted)
            {
                *is_left = !self.gather(number + at, at, &mut four);
            }
            let found = four.bounds(parts, bulge.scale);
            for (at, is_left) in is_left.iter_mut().enumerate().filter(|&(at, _)| wanted[at]) {
                if *is_left {
                    continue;
                }
                let (bound, height, least) = (found.bound[at], found.height[at], found.least[at]);
                if self.fails_for_sure(least) {
                    self.keep(number + at, [f64::INFINITY, least, 0.0]);
                } else if bound <= self.limit && bound <= self.length {
                    self.keep(number + at, [bound, bound, height]);
                } else {
                    *is_left = true;
                }
            }
        }
        is_left
    }

    /// Keeps a triangle's bound, what counts of it, and the height over it.
    #[inline]
    fn keep(&mut self, number: usize, [bound, value, height]: [f64; 3]) {
        let offsets = self.emission.offsets_of(number);
        self.found.each[number - self.first as usize] = FoundLast {
            offsets,
            bound,
            value,
            height,
        };
    }

    /// Puts a triangle and the adjacent ones at a place among four; `false` if it has an edge without a neighbour.
    #[inline]
    pub(super) fn gather(&self, number: usize, at: usize, four: &mut MovedFour) -> bool {
        let emission = self.emission;
        let triangle = emission.triangles[number];
        for (corner, vertex) in triangle.into_iter().enumerate() {
            let h = 3 * number + corner;
            let twin = emission.twins[h];
            if twin == NONE || !self.sharp.is_empty() && self.sharp.contains(&(h as u32)) {
                return false;
            }
            let opposite = emission.triangles[twin as usize / 3][(twin as usize + 2) % 3];
            let (position, opposite) = (
                emission.positions[vertex as usize],
                emission.positions[opposite as usize],
            );
            let step = emission.step(vertex);
            for axis in 0..3 {
                four.corners[corner][axis][at] = position[axis];
                four.steps[corner][axis][at] = step[axis];
                four.opposite[corner][axis][at] = opposite[axis];
            }
        }
        true
    }
}
