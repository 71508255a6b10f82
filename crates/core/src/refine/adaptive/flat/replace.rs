//! Replaces the triangles of regions by those of their triangulations: all that belongs to triangles, half-edges and vertices is
//! numbered anew.

use super::strips::{Net, Region};
use crate::mesh::{Junctions, NONE, Tags};
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::exact_result::Origin;
use crate::refine::kept_faces::KeptFaces;
use std::collections::{HashMap, HashSet};

/// Triangles and half-edges that are numbered anew together: less than a millisecond.
const RENAMED: usize = 1 << 14;

/// The arrays of an emitted mesh.
pub(in super::super) struct Assembled {
    pub(in super::super) positions: Vec<[f64; 3]>,
    pub(in super::super) normals: Vec<[f64; 3]>,
    /// Empty where they are not wanted.
    pub(in super::super) origins: Vec<Origin>,
    pub(in super::super) triangles: Vec<[u32; 3]>,
    pub(in super::super) twins: Vec<u32>,
    pub(in super::super) parents: Vec<u32>,
    pub(in super::super) tags: Tags,
    /// Normals of corners at sharp edges, by half-edge, ascending.
    pub(in super::super) sides: Vec<(u32, [f64; 3])>,
    pub(in super::super) junctions: Junctions,
}

impl Assembled {
    pub(super) fn net<'a>(
        &'a self,
        starts: &'a [u32],
        sharp: &'a HashSet<u32>,
        kept: &'a KeptFaces,
        corners: usize,
    ) -> Net<'a> {
        let Self {
            positions,
            triangles,
            twins,
            parents,
            ..
        } = self;
        Net {
            positions,
            triangles,
            twins,
            parents,
            starts,
            sharp,
            kept,
            corners,
        }
    }
}

/// A region's new triangles.
pub(super) struct Covering {
    /// Triangles with their control faces, by control face.
    pub(super) triangles: Vec<([u32; 3], u32)>,
    /// The edges of its rim that are new: straight lines, in the place of several edges each.
    pub(super) lines: Vec<[u32; 2]>,
    /// Whether some of the triangles in whose place these come are turned over.
    pub(super) was_folded: bool,
}

/// Regions with what comes in the place of their triangles.
pub(super) struct Merged<'a> {
    pub(super) list: &'a [Region],
    /// By triangle, its region.
    pub(super) of_triangle: &'a [u32],
    pub(super) coverings: &'a [Option<Covering>],
}

impl Merged<'_> {
    /// The region of a triangle that gives way, and what comes in its place.
    fn covering(&self, triangle: u32) -> Option<(u32, &Covering)> {
        let region = self.of_triangle[triangle as usize];
        self.coverings
            .get(region as usize)?
            .as_ref()
            .map(|covering| (region, covering))
    }

    /// The mesh with the coverings that there are. Arrays by triangle are changed where they stand: fresh ones as large take longer than all
    /// that is done here.
    pub(super) fn replaced(
        &self,
        mut whole: Assembled,
        starts: &[u32],
        corners: usize,
        watch: &SharedWatch<'_>,
    ) -> Result<Assembled, Cancelled> {
        self.unfold_normals(&mut whole);
        let exchange = self.exchange(&whole, starts, watch)?;
        let mut new = HashMap::with_capacity(3 * exchange.fresh.len());
        watch.each(exchange.half_edges(), |(ends, h)| {
            new.insert(ends, h);
        })?;
        let mut twins = core::mem::take(&mut whole.twins);
        let mut junctions = core::mem::take(&mut whole.junctions);
        let numbers = Numbers {
            exchange: &exchange,
            whole: &whole,
            starts,
            new: &new,
        };
        let rims = self.rims(&numbers, &twins, watch)?;
        let sides = self.sides(&numbers, watch)?;
        let renamed = self.renamed(&whole, corners, watch)?;
        let name = |vertex: u32| renamed[vertex as usize];
        numbers.renumber(&mut twins, watch)?;
        let borders = core::mem::take(&mut junctions.edges);
        borders
            .iter()
            .for_each(|group| junctions.edges.push(group.iter().map(|&h| numbers.of(h))));
        junctions.vertices.rename(name);
        let Assembled {
            mut triangles,
            mut parents,
            mut tags,
            mut positions,
            mut normals,
            mut origins,
            ..
        } = whole;
        let fresh = &exchange.fresh;
        type Task<'a> = Box<dyn FnOnce() + Send + 'a>;
        // Origins, which take longest, first, so that threads end together.
        let tasks: Vec<Task<'_>> = vec![
            Box::new(|| keep(&mut origins, &renamed)),
            Box::new(|| keep(&mut positions, &renamed)),
            Box::new(|| keep(&mut normals, &renamed)),
            Box::new(|| exchange.carry_out(&mut twins, 3, fresh.iter().flat_map(|_| [NONE; 3]))),
            Box::new(|| {
                exchange.carry_out(&mut triangles, 1, fresh.iter().map(|fresh| fresh.triangle))
            }),
            Box::new(|| exchange.carry_out(&mut parents, 1, fresh.iter().map(|fresh| fresh.face))),
        ];
        parallel::each_long_polled(tasks, &mut |_| watch.poll(), |task, _| task())?;
        watch.each(rims, |(h, beyond)| twins[h as usize] = beyond)?;
        watch.each(exchange.half_edges(), |([from, to], h)| {
            if let Some(&twin) = new.get(&[to, from]) {
                twins[h as usize] = twin;
            }
        })?;
        let poll = &mut |_| watch.poll();
        parallel::for_each_chunk_polled(&mut triangles, RENAMED, poll, |_, triangles| {
            triangles
                .iter_mut()
                .for_each(|triangle| *triangle = triangle.map(name));
        })?;
        tags.creases
            .iter_mut()
            .for_each(|tag| tag.vertices = tag.vertices.map(name));
        tags.corners
            .iter_mut()
            .for_each(|tag| tag.vertex = name(tag.vertex));
        Ok(Assembled {
            positions,
            normals,
            origins,
            triangles,
            twins,
            parents,
            tags,
            sides,
            junctions,
        })
    }

    /// The triangles with those that come in the place of others, by control face and region, in that order.
    fn exchange(
        &self,
        whole: &Assembled,
        starts: &[u32],
        watch: &SharedWatch<'_>,
    ) -> Result<Exchange, Cancelled> {
        let mut others: Vec<(u32, u32, [u32; 3])> = Vec::new();
        let mut is_changed = vec![false; starts.len() - 1];
        let covered = || (0u32..).zip(self.list.iter().zip(self.coverings));
        let covered = || {
            covered().filter_map(|(number, (region, own))| Some((number, region, own.as_ref()?)))
        };
        let fresh = covered()
            .flat_map(|(number, _, own)| own.triangles.iter().map(move |&own| (number, own)));
        watch.each(fresh, |(number, (triangle, face))| {
            others.push((face, number, triangle))
        })?;
        watch.each(
            covered().flat_map(|(_, region, _)| &region.triangles),
            |&triangle| {
                is_changed[whole.parents[triangle as usize] as usize] = true;
            },
        )?;
        parallel::sort_polled(&mut others, &mut |_| watch.poll(), Ord::cmp)?;
        others
            .iter()
            .for_each(|&(face, ..)| is_changed[face as usize] = true);
        let mut others = others.into_iter().peekable();
        let mut found = Exchange::default();
        watch.each((0u32..).zip(is_changed), |(face, is_changed)| {
            let before = starts[face as usize]..starts[face as usize + 1];
            found
                .starts
                .push(if is_changed { NONE } else { found.count });
            if !is_changed {
                found.keep(before);
                return;
            }
            for triangle in before.filter(|&triangle| self.covering(triangle).is_none()) {
                found.kept.insert(triangle, found.count);
                found.keep(triangle..triangle + 1);
            }
            while let Some((_, region, triangle)) = others.next_if(|&(parent, ..)| parent == face) {
                found.add(Fresh {
                    number: found.count,
                    triangle,
                    face,
                    region,
                });
            }
        })?;
        Ok(found)
    }

    /// New half-edges along rims, each with its twin where it has one.
    fn rims(
        &self,
        numbers: &Numbers<'_>,
        twins: &[u32],
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<(u32, u32)>, Cancelled> {
        let mut rims = Vec::new();
        let covered = self
            .list
            .iter()
            .zip(self.coverings)
            .filter(|(_, covering)| covering.is_some());
        let triangles = covered.flat_map(|(region, _)| &region.triangles);
        watch.each(
            triangles.flat_map(|&triangle| 3 * triangle..3 * triangle + 3),
            |h| {
                let (now, twin) = (numbers.of(h), twins[h as usize]);
                if now != NONE && twin != NONE {
                    rims.push((now, numbers.of(twin)));
                }
            },
        )?;
        Ok(rims)
    }

    /// The numbers of the vertices once those that only triangles have that give way are gone; [`NONE`] for these.
    fn renamed(
        &self,
        whole: &Assembled,
        corners: usize,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<u32>, Cancelled> {
        let mut is_gone = vec![false; whole.positions.len()];
        let covered = || {
            self.list
                .iter()
                .zip(self.coverings)
                .filter_map(|(region, covering)| Some((region, covering.as_ref()?)))
        };
        watch.each(
            covered().flat_map(|(region, _)| &region.triangles),
            |&triangle| {
                whole.triangles[triangle as usize]
                    .iter()
                    .for_each(|&vertex| is_gone[vertex as usize] = true);
            },
        )?;
        is_gone[..corners].fill(false);
        watch.each(
            covered().flat_map(|(_, covering)| &covering.triangles),
            |(triangle, _)| {
                triangle
                    .iter()
                    .for_each(|&vertex| is_gone[vertex as usize] = false);
            },
        )?;
        let mut next = 0;
        let mut renamed = Vec::with_capacity(is_gone.len());
        watch.each(is_gone, |is_gone| {
            renamed.push(if is_gone { NONE } else { next });
            next += u32::from(!is_gone);
        })?;
        Ok(renamed)
    }

    /// Where a region was folded, gives its vertices that are not on sharp edges the normal of its plane: limit normals are turned
    /// over where the surface is.
    fn unfold_normals(&self, whole: &mut Assembled) {
        let folded = self
            .list
            .iter()
            .zip(self.coverings)
            .filter_map(|(region, covering)| {
                covering
                    .as_ref()
                    .filter(|covering| covering.was_folded)
                    .map(|covering| (&region.plane, covering))
            });
        let mut folded = folded.peekable();
        if folded.peek().is_none() {
            return;
        }
        let corner = |&(h, _): &(u32, [f64; 3])| whole.triangles[h as usize / 3][h as usize % 3];
        let is_sided: HashSet<u32> = whole.sides.iter().map(corner).collect();
        for (plane, covering) in folded {
            for &vertex in covering.triangles.iter().flat_map(|(triangle, _)| triangle) {
                if !is_sided.contains(&vertex) {
                    whole.normals[vertex as usize] = plane.normal.to_array();
                }
            }
        }
    }

    /// The normals of corners at sharp edges: a region has one for each of its vertices that is on one.
    fn sides(
        &self,
        numbers: &Numbers<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<(u32, [f64; 3])>, Cancelled> {
        let Numbers {
            whole, exchange, ..
        } = numbers;
        let was_folded = |region: u32| {
            self.coverings[region as usize]
                .as_ref()
                .is_some_and(|covering| covering.was_folded)
        };
        let (mut sides, mut at_rims) = (Vec::with_capacity(whole.sides.len()), HashMap::new());
        watch.each(&whole.sides, |&(h, normal)| {
            match numbers.of_triangle(h / 3) {
                None => {
                    let vertex = whole.triangles[h as usize / 3][h as usize % 3];
                    at_rims.insert((self.of_triangle[h as usize / 3], vertex), normal);
                }
                Some(now) => sides.push((3 * now + h % 3, normal)),
            }
        })?;
        if at_rims.is_empty() {
            return Ok(sides);
        }
        watch.each(
            &exchange.fresh,
            |&Fresh {
                 number,
                 triangle,
                 region,
                 ..
             }| {
                for (corner, vertex) in (0u32..).zip(triangle) {
                    let normal =
                        at_rims
                            .get(&(region, vertex))
                            .map(|&normal| match was_folded(region) {
                                true => self.list[region as usize].plane.normal.to_array(),
                                false => normal,
                            });
                    sides.extend(normal.map(|normal| (3 * number + corner, normal)));
                }
            },
        )?;
        sides.sort_unstable_by_key(|&(h, _)| h);
        Ok(sides)
    }
}

/// A triangle that has come in the place of others.
struct Fresh {
    number: u32,
    triangle: [u32; 3],
    /// Its control face and its region.
    face: u32,
    region: u32,
}

/// A step that writes an array.
enum Step {
    /// Copies these elements of the old array.
    Keep(core::ops::Range<u32>),
    /// Adds so many new elements.
    Add(u32),
}

/// Triangles some of which come in the place of others.
#[derive(Default)]
struct Exchange {
    steps: Vec<Step>,
    /// By control face whose triangles all stay, the first of them; [`NONE`] for others.
    starts: Vec<u32>,
    /// By the number that it had, the number of a triangle that stays in another control face.
    kept: HashMap<u32, u32>,
    fresh: Vec<Fresh>,
    /// All triangles.
    count: u32,
}

impl Exchange {
    /// Some triangles stay.
    fn keep(&mut self, before: core::ops::Range<u32>) {
        self.count += before.len() as u32;
        match self.steps.last_mut() {
            Some(Step::Keep(last)) if last.end == before.start => last.end = before.end,
            _ => self.steps.push(Step::Keep(before)),
        }
    }

    /// A new one comes.
    fn add(&mut self, fresh: Fresh) {
        self.count += 1;
        self.fresh.push(fresh);
        match self.steps.last_mut() {
            Some(Step::Add(count)) => *count += 1,
            _ => self.steps.push(Step::Add(1)),
        }
    }

    /// The half-edges of the new triangles by their ends.
    fn half_edges(&self) -> impl Iterator<Item = ([u32; 2], u32)> + '_ {
        self.fresh
            .iter()
            .flat_map(|fresh| edges(fresh.triangle).into_iter().zip(3 * fresh.number..))
    }

    /// Brings an array with so many items by triangle to what it is in the end.
    fn carry_out<T: Copy + Default>(
        &self,
        items: &mut Vec<T>,
        by_triangle: usize,
        added: impl Iterator<Item = T>,
    ) {
        // How far what is to stay has to make room first, where more comes than goes.
        let (mut at, mut room) = (0u32, 0);
        for step in &self.steps {
            match step {
                Step::Keep(before) => {
                    room = room.max(at.saturating_sub(before.start));
                    at += before.len() as u32;
                }
                Step::Add(count) => at += count,
            }
        }
        let [room, count] = [room, self.count].map(|triangles| triangles as usize * by_triangle);
        let length = items.len();
        items.resize((length + room).max(count), T::default());
        if room > 0 {
            items.copy_within(..length, room);
        }
        let (mut at, mut added) = (0, added);
        for step in &self.steps {
            match step {
                Step::Keep(before) => {
                    let from = before.start as usize * by_triangle + room;
                    let length = before.len() * by_triangle;
                    if from != at {
                        items.copy_within(from..from + length, at);
                    }
                    at += length;
                }
                Step::Add(count) => {
                    let new = &mut items[at..at + *count as usize * by_triangle];
                    new.iter_mut()
                        .zip(&mut added)
                        .for_each(|(item, new)| *item = new);
                    at += new.len();
                }
            }
        }
        items.truncate(count);
    }
}

/// The numbers that half-edges have in the end.
struct Numbers<'a> {
    exchange: &'a Exchange,
    whole: &'a Assembled,
    /// By control face, its first triangle before.
    starts: &'a [u32],
    /// Of new triangles, by their ends.
    new: &'a HashMap<[u32; 2], u32>,
}

impl Numbers<'_> {
    /// The number of a triangle that stays.
    #[inline]
    fn of_triangle(&self, triangle: u32) -> Option<u32> {
        let face = self.whole.parents[triangle as usize] as usize;
        match self.exchange.starts[face] {
            NONE => self.exchange.kept.get(&triangle).copied(),
            start => Some(start + (triangle - self.starts[face])),
        }
    }

    /// Gives the half-edges in a list by half-edge their numbers. Most are of the same control face as where they stand.
    fn renumber(&self, mut twins: &mut [u32], watch: &SharedWatch<'_>) -> Result<(), Cancelled> {
        let faces = self.exchange.starts.len();
        let share = parallel::share(faces);
        let shares = (0..faces).step_by(share).map(|first| {
            let faces = first..(first + share).min(faces);
            let count = 3 * (self.starts[faces.end] - self.starts[faces.start]) as usize;
            let (own, rest) = core::mem::take(&mut twins).split_at_mut(count);
            twins = rest;
            (faces, own)
        });
        let shares: Vec<_> = shares.collect();
        parallel::each_long_polled(
            shares,
            &mut |_| watch.poll(),
            |(faces, mut twins), is_stopped| {
                for face in faces {
                    let own = 3 * self.starts[face]..3 * self.starts[face + 1];
                    let now = self.exchange.starts[face];
                    let moved = (now != NONE).then(|| (3 * now).wrapping_sub(own.start));
                    let (of_face, rest) = core::mem::take(&mut twins).split_at_mut(own.len());
                    twins = rest;
                    for twins in of_face.chunks_mut(RENAMED) {
                        twins.iter_mut().for_each(|twin| match moved {
                            Some(by) if own.contains(twin) => *twin = twin.wrapping_add(by),
                            _ if *twin != NONE => *twin = self.of(*twin),
                            _ => {}
                        });
                        if is_stopped() {
                            return;
                        }
                    }
                }
            },
        )?;
        Ok(())
    }

    /// The number of a half-edge; [`NONE`] for one that was inside a region.
    #[inline]
    fn of(&self, h: u32) -> u32 {
        if let Some(now) = self.of_triangle(h / 3) {
            return 3 * now + h % 3;
        }
        let triangle = self.whole.triangles[h as usize / 3];
        let ends = [0, 1].map(|i| triangle[(h as usize + i) % 3]);
        self.new.get(&ends).copied().unwrap_or(NONE)
    }
}

/// The edges of a triangle by their ends.
pub(super) fn edges(triangle: [u32; 3]) -> [[u32; 2]; 3] {
    [0, 1, 2].map(|edge| [triangle[edge], triangle[(edge + 1) % 3]])
}

/// Keeps what belongs to the vertices that are kept.
fn keep<T>(of_vertices: &mut Vec<T>, renamed: &[u32]) {
    let mut is_kept = renamed.iter().map(|&name| name != NONE);
    of_vertices.retain(|_| is_kept.next().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::Random;

    /// Where more comes than goes, too.
    #[test]
    fn arrays_become_what_was_kept_and_added() {
        let mut random = Random::new(5);
        let mut grown = 0;
        for _ in 0..500 {
            let before = 1 + random.below(40) as u32;
            let (mut exchange, mut expected, mut added) =
                (Exchange::default(), Vec::new(), Vec::new());
            let mut at = 0;
            while at < before {
                let end = (at + random.below(6) as u32).min(before);
                exchange.keep(at..end);
                expected.extend((2 * at..2 * end).map(f64::from));
                for _ in 0..random.below(7) {
                    exchange.add(Fresh {
                        number: exchange.count,
                        triangle: [0; 3],
                        face: 0,
                        region: 0,
                    });
                    let new = [-1.0 - added.len() as f64, 0.5];
                    expected.extend(new);
                    added.extend(new);
                }
                at = end + random.below(4) as u32;
            }
            let mut items: Vec<f64> = (0..2 * before).map(f64::from).collect();
            grown += usize::from(expected.len() > items.len());
            exchange.carry_out(&mut items, 2, added.into_iter());
            assert_eq!(items, expected);
        }
        assert!(grown > 100, "{grown}");
    }
}
