//! The certified interval for the whole mesh.
//!
//! Above stand the bounds of what was let pass. Below stand distances that were found: from points of the surface over the
//! worst leaves to the nearest triangle of the mesh, which is looked for in all control faces whose points come near.

mod farthest;
mod nearer_mesh;
mod nearest_triangle;

use core::cmp::Ordering;
use std::collections::{HashMap, HashSet};

use super::emit::Emission;
use super::judge::Goal;
use super::measure::measure;
use super::measured::Measured;
use super::quadtree::Place;
use super::{Engine, Plan};
use crate::certificate::TriangleFrame;
use crate::index::VertexId;
use crate::measure::Bvh;
use crate::mesh::{Mesh, Triangles};
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;
use crate::refine::exact_result::ErrorBounds;
use crate::vector::DVec3;
use farthest::{SAMPLED_LEVELS, farthest, sample};
use nearest_triangle::Nearest;

/// Leaves with the greatest bounds that are looked at for a lower bound.
const PROBED: usize = 64;

/// Leaves that are looked at however many control faces there are, and the boxes of control faces that may be looked at for others.
const FEWEST_PROBED: usize = 8;
const MOST_BOXES: usize = 2_000_000;

/// Leaves that each of several threads looks at before it is known which are of use.
const AT_ONCE: usize = 4;

/// Levels below which edges have no length left.
const MOST_LEVELS: usize = 64;

/// Points that are measured where nothing is certain, give or take those of a control face: some seconds.
const MOST_MEASURED: usize = 1_000_000;

/// Levels that are sampled there.
const MOST_SAMPLED_LEVELS: usize = 6;

/// A lower bound beyond this part of the upper one is good enough.
const NARROW: f64 = 0.99;

/// The same where a tolerance is met.
const MET_NARROW: f64 = 0.9;

/// Upper bounds so many times the lower one are taken again.
const WIDE: f64 = 1.2;

/// The same where a tolerance is met, and few may be.
const MET_WIDE: f64 = 1.12;

/// Control faces that are looked at together for tighter bounds at first, then twice as many each time.
const TIGHTENED: usize = 64;

/// So many bounds may matter in the last round, with as many as were taken again before it.
const MOST_CANDIDATES: usize = (3 * TIGHTENED) << MOST_TIGHTENINGS;

/// The share of the triangles (one in so many) that are looked at again where the tolerance is met.
const MET_SHARE: usize = 64;

/// How many of them may be in any case.
const MET_AT_LEAST: usize = 6_000;

/// Bounds are taken again only if the greatest that there is no room for is below this part of the upper bound.
const WORTH_WHILE: f64 = 0.95;

/// How often that is done.
const MOST_TIGHTENINGS: usize = 6;

/// Vertices that are looked at between two calls of the observer.
const LOOKED_AT: usize = 1 << 14;

/// What was looked at for lower bounds.
struct Probed {
    /// Control faces, and which known leaf of theirs.
    leaves: HashSet<(u32, Option<Place>)>,
    /// A lower bound beyond this part of the upper one is good enough.
    enough: f64,
}

/// The certified interval; `measured` by control face where all triangles were looked at among their neighbours, `is_met` if a
/// tolerance is: then nobody waits for a tighter bound. What is loose all the same is measured anew where that is asked for.
pub(super) fn probe(
    engine: &Engine<'_>,
    plan: &Plan,
    emission: &Emission,
    (measured, is_met, tightens): (Option<&[Measured]>, bool, bool),
) -> Result<ErrorBounds, RefineError> {
    let watch = engine.watch;
    let mut best = ErrorBounds {
        lower: 0.0,
        upper: 0.0,
        at: [0.0; 3],
        certified: engine.control.rules.is_certified(),
    };
    let mesh = Nearest::of(engine.sources(plan, emission), watch)?;
    // Bounds may be large for lack of room to drift; heights tell the truth about the rest.
    let heights = measured
        .iter()
        .flat_map(|all| all.iter().map(|face| face.highest));
    let highest = greatest(heights, PROBED, watch)?;
    let (enough, wide) = if is_met {
        (MET_NARROW, MET_WIDE)
    } else {
        (NARROW, WIDE)
    };
    let mut probed = Probed {
        leaves: HashSet::new(),
        enough,
    };
    lower(
        engine,
        (plan, emission),
        &mesh,
        (&highest, |_| true, &mut probed),
        &mut best,
    )?;
    let again = |length: f64, faces: &[u32]| {
        let nothing = Goal::Within(f64::INFINITY);
        measure(
            &engine.sources(plan, emission),
            watch,
            (&nothing, length),
            (faces, None, None),
        )
    };
    let mut worst = Worst {
        plan,
        measured,
        bounded: HashMap::new(),
    };
    // In no round another one comes among the greatest.
    let mut candidates = greatest_unsorted(worst.of_all(), MOST_CANDIDATES, watch)?;
    // What failed for sure has no bound yet.
    if candidates.iter().any(|(bound, _)| bound.is_infinite()) {
        let unbounded = worst
            .of_all()
            .filter(|(bound, _)| bound.is_infinite())
            .map(|(_, place)| place.face);
        let unbounded: Vec<u32> = unbounded.collect();
        let found = again(f64::MAX, &unbounded)?;
        let found = unbounded
            .into_iter()
            .zip(found.into_iter().map(|found| found.worst));
        worst.bounded = found.filter(|(_, (bound, _))| bound.is_finite()).collect();
        candidates = greatest_unsorted(worst.of_all(), MOST_CANDIDATES, watch)?;
    }
    // Which of them were looked at again, the lower bound for which they were, and whether that told which leaf is the worst.
    let mut tightened: HashMap<u32, (f64, bool)> = HashMap::new();
    // A tolerance that is met is proven already: what else there is to know must not take longer than to meet it.
    let mut room = if is_met {
        emission.triangles.len() / MET_SHARE + MET_AT_LEAST
    } else {
        usize::MAX
    };
    for round in 0.. {
        // Before this round fewer than half as many were tightened.
        let most = PROBED.max(TIGHTENED << (round + 1));
        let order = greatest(candidates.iter().copied(), most, watch)?;
        best.upper = order.first().map_or(0.0, |&(bound, _)| bound);
        let is_leaf = |place: Place| {
            let is_tighter = tightened
                .get(&place.face)
                .is_some_and(|&(_, is_tighter)| is_tighter);
            is_tighter || worst.is_leaf(place.face)
        };
        lower(
            engine,
            (plan, emission),
            &mesh,
            (&order, is_leaf, &mut probed),
            &mut best,
        )?;
        if !best.certified || best.upper <= wide * best.lower || round >= MOST_TIGHTENINGS {
            break;
        }
        // Bounds that are good enough for the goals need not be tight.
        let is_loose = |&(bound, place): &(f64, Place)| {
            bound > best.lower
                && tightened
                    .get(&place.face)
                    .is_none_or(|&(known, _)| wide * known < best.lower)
        };
        let (mut loose, mut stays) = (Vec::new(), 0.0);
        for &(bound, place) in order
            .iter()
            .filter(|known| is_loose(known))
            .take(TIGHTENED << round)
        {
            let count = emission.triangles_of(place.face).len();
            if count > room {
                (room, stays) = (0, bound);
                break;
            }
            room -= count;
            loose.push(place.face);
        }
        // Beside one that stays as it is the others are of no use.
        if loose.is_empty() || stays > WORTH_WHILE * best.upper {
            break;
        }
        let found = again(NARROW * best.lower, &loose)?;
        let heights = greatest(found.iter().map(|face| face.highest), PROBED, watch)?;
        lower(
            engine,
            (plan, emission),
            &mesh,
            (&heights, |_| true, &mut probed),
            &mut best,
        )?;
        let found: HashMap<u32, (f64, Place)> = loose
            .into_iter()
            .zip(found.into_iter().map(|found| found.worst))
            .collect();
        for known in &mut candidates {
            let Some(found) = found.get(&known.1.face) else {
                continue;
            };
            let was_tighter = tightened
                .get(&known.1.face)
                .is_some_and(|&(_, is_tighter)| is_tighter);
            let is_tighter = found.0 < known.0;
            tightened.insert(known.1.face, (best.lower, is_tighter || was_tighter));
            if is_tighter {
                *known = *found;
            }
        }
    }
    if best.certified && tightens {
        best = loose_anew(engine, (plan, emission, &mesh), &candidates, best)?;
    }
    if !best.certified {
        best.upper = estimated(engine, &worst, emission, &mut best)?;
    }
    best.upper = best.upper.max(best.lower) + engine.rounding;
    best.lower = (best.lower - engine.rounding).max(0.0);
    Ok(best)
}

/// The greatest bounds of the control faces, and the leaves that have them.
struct Worst<'a> {
    plan: &'a Plan,
    measured: Option<&'a [Measured]>,
    /// What faces came to that had failed for sure.
    bounded: HashMap<u32, (f64, Place)>,
}

impl Worst<'_> {
    fn of(&self, face: u32) -> (f64, Place) {
        let known = match self.measured {
            Some(measured) => measured[face as usize].worst,
            None => self.plan.worst_of(face),
        };
        if known.0.is_infinite() {
            self.bounded.get(&face).copied().unwrap_or(known)
        } else {
            known
        }
    }

    fn of_all(&self) -> impl Iterator<Item = (f64, Place)> {
        (0..self.plan.closed.len() as u32).map(|face| self.of(face))
    }

    /// Whether the leaf of a face is one of those that were emitted: others may have been split since.
    fn is_leaf(&self, face: u32) -> bool {
        self.measured.is_some() || self.bounded.contains_key(&face)
    }
}

/// The order of bounds, the greatest first.
fn by_bound(a: &(f64, Place), b: &(f64, Place)) -> Ordering {
    b.0.total_cmp(&a.0)
        .then_with(|| (a.1.face, a.1.path).cmp(&(b.1.face, b.1.path)))
}

/// So many of the greatest bounds, the greatest first.
fn greatest(
    bounds: impl Iterator<Item = (f64, Place)>,
    most: usize,
    watch: &SharedWatch<'_>,
) -> Result<Vec<(f64, Place)>, Cancelled> {
    let mut found = greatest_unsorted(bounds, most, watch)?;
    found.sort_unstable_by(by_bound);
    Ok(found)
}

/// The same in any order.
fn greatest_unsorted(
    bounds: impl Iterator<Item = (f64, Place)>,
    most: usize,
    watch: &SharedWatch<'_>,
) -> Result<Vec<(f64, Place)>, Cancelled> {
    let mut found = Vec::new();
    // So many are at least as great as this.
    let mut least: Option<(f64, Place)> = None;
    watch.each(bounds, |bound| {
        if least.is_some_and(|least| by_bound(&least, &bound).is_le()) {
            return;
        }
        found.push(bound);
        if found.len() == 2 * most {
            least = Some(*found.select_nth_unstable_by(most - 1, by_bound).1);
            found.truncate(most);
        }
    })?;
    if found.len() > most {
        found.select_nth_unstable_by(most - 1, by_bound);
        found.truncate(most);
    }
    Ok(found)
}

/// Raises the lower bound by points over the first leaves of a list that promise more, but for those that were looked at. Where a
/// place is not known to be that of a leaf with this bound, its control face is looked at.
fn lower(
    engine: &Engine<'_>,
    (plan, emission): (&Plan, &Emission),
    mesh: &Nearest<'_>,
    (order, is_leaf, probed): (&[(f64, Place)], impl Fn(Place) -> bool, &mut Probed),
    best: &mut ErrorBounds,
) -> Result<(), Cancelled> {
    let most = order.first().map_or(0.0, |&(promise, _)| promise);
    let most_probed = PROBED.min(FEWEST_PROBED + MOST_BOXES / plan.closed.len().max(1));
    let leaf = |place: Place| (place.face, is_leaf(place).then_some(place));
    let sources = engine.sources(plan, emission);
    let mut left = order
        .iter()
        .take(most_probed)
        .map(|&(promise, place)| (promise, leaf(place)))
        .peekable();
    let enough = probed.enough * most;
    let is_enough = |best: &ErrorBounds| best.lower > enough;
    // Some are looked at together, by all threads, so many that these need not be woken for each; what is not needed any more is forgotten.
    let most_at_once = if parallel::threads() > 1 {
        AT_ONCE * parallel::threads()
    } else {
        1
    };
    let mut at_once = 1;
    loop {
        let mut some = Vec::with_capacity(at_once);
        while some.len() < at_once
            && let Some((promise, leaf)) = left.next_if(|&(promise, _)| promise > best.lower)
        {
            if !probed.leaves.contains(&leaf) {
                some.push((promise, leaf));
            }
        }
        if some.is_empty() || is_enough(best) {
            return Ok(());
        }
        let poll = &mut |_| engine.watch.poll();
        let found = parallel::each_long_polled(some, poll, |(promise, leaf), is_stopped| {
            let points = farthest(&sources, leaf, is_stopped).into_iter();
            let distances = points.map(|point| (mesh.distance(point, leaf.0, is_stopped), point));
            (promise, leaf, distances.collect::<Vec<_>>())
        })?;
        for (promise, leaf, distances) in found {
            if promise <= best.lower || is_enough(best) {
                return Ok(());
            }
            if !probed.leaves.insert(leaf) {
                continue;
            }
            distances
                .into_iter()
                .for_each(|(distance, point)| best.raise(distance, point));
        }
        at_once = most_at_once.min(2 * at_once);
    }
}

/// The same interval, made narrower where few control faces have bounds that are far above what was found; `greatest` are the greatest
/// bounds, and all that may be.
fn loose_anew(
    engine: &Engine<'_>,
    sources: (&Plan, &Emission, &Nearest<'_>),
    greatest: &[(f64, Place)],
    known: ErrorBounds,
) -> Result<ErrorBounds, RefineError> {
    let lower = known
        .lower
        .max(ErrorBounds::LEAST * engine.control.mesh.diagonal());
    if known.upper <= ErrorBounds::TIGHT * lower {
        return Ok(known);
    }
    let (loose, others): (Vec<_>, Vec<_>) = greatest
        .iter()
        .copied()
        .partition(|&(bound, _)| bound > WIDE * lower);
    let mut faces: Vec<u32> = loose.into_iter().map(|(_, place)| place.face).collect();
    faces.sort_unstable();
    let Some(found) = nearer_mesh::anew(engine, sources, &faces, (&known, lower))? else {
        return Ok(known);
    };
    let rest = others
        .into_iter()
        .map(|(bound, _)| bound)
        .fold(0.0, f64::max);
    Ok(ErrorBounds {
        upper: known.upper.min(found.upper.max(rest)),
        ..found
    })
}

/// Where nothing is certain: the greatest distance of samples over the faces that may be worse than what was found; after
/// many of them the next estimate.
fn estimated(
    engine: &Engine<'_>,
    worst: &Worst<'_>,
    emission: &Emission,
    best: &mut ErrorBounds,
) -> Result<f64, RefineError> {
    let control = engine.control;
    let triangles = Triangles {
        positions: &emission.positions,
        triangles: &emission.triangles,
    };
    let tree = Bvh::new_observed(triangles, &mut engine.watch.observer())?;
    let mut count = 0;
    let mut order: Vec<(f64, u32)> = worst.of_all().map(|(bound, _)| bound).zip(0..).collect();
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for &(bound, face) in &order {
        if bound <= best.lower || count >= MOST_MEASURED {
            return Ok(bound.max(best.lower));
        }
        let trees = &worst.plan.decision.trees;
        let levels = trees.depth(trees.root(face)) as usize + SAMPLED_LEVELS;
        let mut points = Vec::new();
        sample(
            control.piece(face).surface(control.rules),
            levels.min(MOST_SAMPLED_LEVELS),
            &mut points,
        );
        count += points.len();
        let first = emission.triangles_of(face).start as u32;
        let distances =
            engine
                .watch
                .pieces(points.len(), parallel::share(points.len()), |some| {
                    let distance =
                        |point: &DVec3| tree.closest_from(point.to_array(), first).distance;
                    points[some].iter().map(distance).collect::<Vec<_>>()
                })?;
        let distances = distances.into_iter().flatten();
        distances
            .zip(points)
            .for_each(|(distance, point)| best.raise(distance, point));
    }
    Ok(best.lower)
}

impl ErrorBounds {
    /// Takes a distance that a point has.
    fn raise(&mut self, distance: f64, at: DVec3) {
        if distance > self.lower {
            (self.lower, self.at) = (distance, at.to_array());
        }
    }
}

impl Plan {
    /// The greatest bound of a control face, and the leaf that has it.
    fn worst_of(&self, face: u32) -> (f64, Place) {
        let closing = self.closed[face as usize].extent().copied();
        let extents = [Some(self.decision.extent(face)), closing]
            .into_iter()
            .flatten();
        let judged = extents.filter_map(|extent| Some((extent.bound, extent.worst?)));
        let greater = |known: (f64, Place), other: (f64, Place)| {
            if other.0 > known.0 { other } else { known }
        };
        judged
            .chain(self.settled.worst(face))
            .fold((0.0, Place::root(face)), greater)
    }
}

/// What rounding can have done to a distance: positions are convex combinations of convex combinations, one for
/// each level, and each adds a few units in the last place of the coordinates' size; those of a control vertex add one for
/// each neighbour. Points near an edge of a triangle count as on it ([`TriangleFrame::on_edge`]), on either side.
pub(super) fn rounding(
    control: &Mesh,
    max_levels: usize,
    watch: &SharedWatch<'_>,
) -> Result<f64, Cancelled> {
    let size = control
        .positions()
        .as_flattened()
        .iter()
        .fold(0.0f64, |size, x| size.max(x.abs()));
    let topology = control.topology();
    let valence = |v: usize| topology.valence_and_openness(VertexId(v as u32)).0;
    let most = watch.pieces(control.vertex_count(), LOOKED_AT, |piece| {
        piece.map(valence).max()
    });
    let most = most?.into_iter().flatten().max().unwrap_or(0);
    let units = 32.0 + 8.0 * max_levels.min(MOST_LEVELS) as f64 + f64::from(most);
    Ok((units * f64::EPSILON + 4.0 * TriangleFrame::ROUNDING) * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::{Stage, unobserved};
    use crate::random::Random;

    /// As sorting all of them tells, equal ones by their places.
    #[test]
    fn the_greatest_are_those_of_the_sorted_list() {
        let mut unobserved = unobserved;
        let watch = SharedWatch::new(&mut unobserved, Stage::Assembling);
        let mut random = Random::new(5);
        for (count, most) in [
            (0, 3),
            (2, 3),
            (5, 1),
            (300, 7),
            (5000, 64),
            (5000, 2500),
            (5000, 5000),
        ] {
            let mut all: Vec<(f64, Place)> = (0..count)
                .map(|face| {
                    let value = random.below(count / 3 + 1) as f64;
                    let path = random.below(4) as u64;
                    (
                        value,
                        Place {
                            path,
                            ..Place::root(face as u32)
                        },
                    )
                })
                .collect();
            let found = greatest(all.iter().copied(), most, &watch).unwrap();
            all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.face.cmp(&b.1.face)));
            all.truncate(most);
            assert_eq!(found, all, "{count}, {most}");
        }
    }
}
