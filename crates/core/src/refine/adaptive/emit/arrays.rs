//! The arrays that an emission is written into: fresh ones, or those of the emission before, in which what is kept of it is moved to
//! where it belongs now, so that there is no second copy of them.

use core::ops::Range;

use super::emission::{Emission, Moves, NOWHERE};
use super::kept::COPIED;
use crate::parallel::{self, IsStopped};
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::exact_result::Origin;

/// Origins that are written together: some milliseconds.
const FILLED: usize = 1 << 17;

/// The arrays that are written, by vertex, half-edge and triangle.
#[derive(Default)]
pub(super) struct Arrays {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    pub(super) origins: Vec<Origin>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) twins: Vec<u32>,
    pub(super) parents: Vec<u32>,
    /// Empty where nothing was moved.
    pub(super) moves: Moves,
}

/// How many vertices and triangles there are.
#[derive(Clone, Copy)]
pub(super) struct Lengths {
    pub(super) vertices: usize,
    pub(super) triangles: usize,
}

/// Elements that are kept, and where they begin now.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shift {
    pub(super) before: Range<usize>,
    pub(super) now: usize,
}

/// Shifts in the order of the elements, which is the same before and now.
#[derive(Default)]
pub(super) struct Shifts(Vec<Shift>);

impl Shifts {
    /// Adds elements that come after all others.
    pub(super) fn push(&mut self, before: Range<usize>, now: usize) {
        if before.is_empty() {
            return;
        }
        match self.0.last_mut() {
            // Together with those that they follow.
            Some(last)
                if last.before.end == before.start && last.now + last.before.len() == now =>
            {
                last.before.end = before.end;
            }
            _ => self.0.push(Shift { before, now }),
        }
    }

    /// Multiplies all numbers, for elements of which there are `times` as many.
    fn times(&self, times: usize) -> Self {
        let multiplied = |one: &Shift| Shift {
            before: times * one.before.start..times * one.before.end,
            now: times * one.now,
        };
        Self(self.0.iter().map(multiplied).collect())
    }
}

impl Arrays {
    /// Fresh ones, one in `spare` of which is kept free.
    pub(super) fn fresh(
        length: Lengths,
        spare: usize,
        has_origins: bool,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let room = |count: usize| count + count / spare;
        let [vertices, triangles] = [length.vertices, length.triangles];
        let mut origins =
            limitmesh_pages::with_capacity(if has_origins { room(vertices) } else { 0 });
        if has_origins {
            extend_origins(&mut origins, vertices, watch)?;
        }
        Ok(Self {
            positions: parallel::defaults_with_room(vertices, room(vertices)),
            normals: parallel::defaults_with_room(vertices, room(vertices)),
            origins,
            triangles: parallel::defaults_with_room(triangles, room(triangles)),
            twins: parallel::defaults_with_room(3 * triangles, 3 * room(triangles)),
            parents: parallel::defaults_with_room(triangles, room(triangles)),
            moves: Moves::default(),
        })
    }

    /// Those of an emission, which keeps none of them.
    pub(super) fn taken(emission: &mut Emission) -> Self {
        let take = core::mem::take::<Vec<[f64; 3]>>;
        let (mut positions, bases) = (take(&mut emission.positions), take(&mut emission.bases));
        let mut moves = Moves::default();
        if !bases.is_empty() {
            moves.offsets = core::mem::take(&mut emission.offsets);
            // Where the vertices lay before they were moved.
            moves.positions = core::mem::replace(&mut positions, bases);
        }
        Self {
            positions,
            moves,
            normals: take(&mut emission.normals),
            origins: core::mem::take(&mut emission.origins),
            triangles: core::mem::take(&mut emission.triangles),
            twins: core::mem::take(&mut emission.twins),
            parents: core::mem::take(&mut emission.parents),
        }
    }

    /// Moves what is kept to where it belongs; what lies between is left as it may be.
    pub(super) fn rearrange(
        &mut self,
        length: Lengths,
        vertices: &Shifts,
        triangles: &Shifts,
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        let twins = triangles.times(3);
        let Self {
            positions,
            normals,
            origins,
            triangles: corners,
            twins: beyond,
            parents,
            moves,
        } = self;
        type Task<'a> = Box<dyn FnOnce(&IsStopped<'_>) + Send + 'a>;
        // Origins, which take longest, first, so that threads end together.
        let mut tasks: Vec<Task<'_>> = vec![
            Box::new(|is_stopped| {
                // Nobody may have asked for them.
                if !origins.is_empty() {
                    rearrange(origins, NOWHERE, length.vertices, vertices, is_stopped);
                }
            }),
            Box::new(|is_stopped| {
                rearrange(positions, [0.0; 3], length.vertices, vertices, is_stopped)
            }),
            Box::new(|is_stopped| {
                rearrange(normals, [0.0; 3], length.vertices, vertices, is_stopped)
            }),
            Box::new(|is_stopped| {
                rearrange(corners, [0; 3], length.triangles, triangles, is_stopped)
            }),
            Box::new(|is_stopped| rearrange(beyond, 0, 3 * length.triangles, &twins, is_stopped)),
            // These are written anew.
            Box::new(|is_stopped| {
                rearrange(parents, 0, length.triangles, &Shifts::default(), is_stopped)
            }),
        ];
        if !moves.offsets.is_empty() {
            let Moves { offsets, positions } = moves;
            tasks.push(Box::new(|is_stopped| {
                rearrange(offsets, 0.0, length.vertices, vertices, is_stopped);
            }));
            tasks.push(Box::new(|is_stopped| {
                rearrange(positions, [0.0; 3], length.vertices, vertices, is_stopped);
            }));
        }
        parallel::each_long_polled(tasks, &mut |_| watch.poll(), |task, is_stopped| {
            task(is_stopped)
        })?;
        Ok(())
    }
}

/// Adds origins of vertices that are not known yet: piece by piece, since they are no zeros, which cost nothing.
fn extend_origins(
    origins: &mut Vec<Origin>,
    count: usize,
    watch: &SharedWatch<'_>,
) -> Result<(), Cancelled> {
    while origins.len() < count {
        origins.resize(count.min(origins.len() + FILLED), NOWHERE);
        watch.poll()?;
    }
    Ok(())
}

/// Makes an array so long, its elements moved; what is of no use any more is left unfinished.
fn rearrange<T: Copy>(
    array: &mut Vec<T>,
    filling: T,
    length: usize,
    moves: &Shifts,
    is_stopped: &IsStopped<'_>,
) {
    limitmesh_pages::reserve(array, length.saturating_sub(array.len()));
    while array.len() < length {
        array.resize(length.min(array.len() + FILLED), filling);
        if is_stopped() {
            return;
        }
    }
    // The order stays: what moves up, the last first, does not meet what moves down, and that, the first first, finds its place free.
    let (up, down) = (
        |one: &&Shift| one.now > one.before.start,
        |one: &&Shift| one.now < one.before.start,
    );
    for one in moves.0.iter().rev().filter(up) {
        for end in (0..one.before.len())
            .rev()
            .step_by(COPIED)
            .map(|last| last + 1)
        {
            let start = end.saturating_sub(COPIED);
            array.copy_within(
                one.before.start + start..one.before.start + end,
                one.now + start,
            );
            if is_stopped() {
                return;
            }
        }
    }
    for one in moves.0.iter().filter(down) {
        for start in (0..one.before.len()).step_by(COPIED) {
            let end = (start + COPIED).min(one.before.len());
            array.copy_within(
                one.before.start + start..one.before.start + end,
                one.now + start,
            );
            if is_stopped() {
                return;
            }
        }
    }
    array.truncate(length);
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::Random;

    /// Against a copy.
    #[test]
    fn elements_are_moved_to_where_they_belong() {
        let mut random = Random::new(9);
        let (mut up, mut down) = (0, 0);
        for _ in 0..200 {
            let (mut moves, mut all) = (Shifts::default(), Vec::new());
            let (mut before, mut now) = (0, 0);
            for _ in 0..random.below(8) {
                (before, now) = (before + random.below(3000), now + random.below(3000));
                let count = [random.below(50), random.below(3 * COPIED)][random.below(2)];
                moves.push(before..before + count, now);
                all.push((before, now, count));
                (before, now) = (before + count, now + count);
                up += usize::from(now > before);
                down += usize::from(now < before);
            }
            let array: Vec<u32> = (0..(before + random.below(100)) as u32).collect();
            let mut moved = array.clone();
            let length = now + random.below(100);
            rearrange(&mut moved, u32::MAX, length, &moves, &|| false);
            assert_eq!(moved.len(), length);
            for (before, now, count) in all {
                assert_eq!(moved[now..now + count], array[before..before + count]);
            }
        }
        assert!(up > 100 && down > 100, "{up}, {down}");
    }
}
