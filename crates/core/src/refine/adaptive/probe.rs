//! The certified interval for the whole mesh.
//!
//! Above stand the bounds of what was let pass. Below stand distances that were found: from points of the surface over the
//! worst leaves to the nearest triangle of the mesh, which is looked for in all control faces whose points come near.

mod farthest;

use std::collections::HashSet;

use super::emit::Emission;
use super::judge::Goal;
use super::measure::{Measured, measure};
use super::quadtree::Place;
use super::{Engine, Plan, block};
use crate::certificate::TriangleFrame;
use crate::geometry::box_tree::{Bounds, NO_BOUNDS, distance_squared_to, grown};
use crate::geometry::nearer;
use crate::index::VertexId;
use crate::mesh::Mesh;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::exact_result::ErrorBounds;
use crate::vector::{DVec3, vector};
use farthest::{SAMPLED_LEVELS, farthest, sample};

/// Leaves with the greatest bounds that are looked at for a lower bound.
const PROBED: usize = 64;

/// Leaves that are looked at however many control faces there are, and the boxes of control faces that may be looked at for others.
const FEWEST_PROBED: usize = 8;
const MOST_BOXES: usize = 2_000_000;

/// Levels below which edges have no length left.
const MOST_LEVELS: usize = 64;

/// Control faces whose samples are measured where nothing is certain.
const MOST_MEASURED: usize = 2_000;

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

/// The share of the triangles (one in so many) that are looked at again where the tolerance is met.
const MET_SHARE: usize = 64;

/// How many of them may be in any case.
const MET_AT_LEAST: usize = 6_000;

/// Bounds are taken again only if the greatest that there is no room for is below this part of the upper bound.
const WORTH_WHILE: f64 = 0.95;

/// Boxes that are looked at together: control faces with consecutive numbers are often near each other.
const GROUP: usize = 64;

/// Boxes and triangles that are looked at between two calls of the observer.
const LOOKED_AT: u32 = 1 << 14;

/// How often that is done.
const MOST_TIGHTENINGS: usize = 6;

/// What was looked at for lower bounds.
struct Probed {
    /// Control faces, and which known leaf of theirs.
    leaves: HashSet<(u32, Option<Place>)>,
    /// A lower bound beyond this part of the upper one is good enough.
    enough: f64,
}

/// The certified interval; `measured` by control face where all triangles were looked at among their neighbours, `is_met` if a
/// tolerance is: then nobody waits for a tighter bound.
pub(super) fn probe(
    engine: &Engine<'_>,
    plan: &Plan,
    emission: &Emission,
    (measured, is_met): (Option<&[Measured]>, bool),
) -> Result<ErrorBounds, Cancelled> {
    let watch = engine.watch;
    let mut worst = match measured {
        Some(measured) => measured.iter().map(|face| face.worst).collect(),
        None => plan.worst_by_face(watch)?,
    };
    let mut best =
        ErrorBounds { lower: 0.0, upper: 0.0, at: [0.0; 3], certified: engine.control.rules.is_certified() };
    let mesh = Nearest::of(engine, plan, emission)?;
    // Bounds may be large for lack of room to drift; heights tell the truth about the rest.
    let heights = measured.iter().flat_map(|all| all.iter().map(|face| face.highest));
    let highest = greatest(heights, PROBED, watch)?;
    let (enough, wide) = if is_met { (MET_NARROW, MET_WIDE) } else { (NARROW, WIDE) };
    let mut probed = Probed { leaves: HashSet::new(), enough };
    let mut is_known = vec![measured.is_some(); worst.len()];
    lower(engine, (plan, emission), &mesh, (&highest, |_| true, &mut probed), &mut best)?;
    // By control face, the lower bound for which it was looked at.
    let mut tightened: Vec<Option<f64>> = limitmesh_pages::filled(None, worst.len());
    let again = |length: f64, faces: &[u32], worst: &mut [(f64, Place)], is_known: &mut [bool]| {
        let nothing = Goal::Within(f64::INFINITY);
        let found = measure(&engine.sources(plan, emission), watch, (&nothing, length), (faces, None, None))?;
        for (&face, found) in faces.iter().zip(found) {
            let known = &mut worst[face as usize];
            if found.worst.0 < known.0 {
                *known = found.worst;
                is_known[face as usize] = true;
            }
        }
        Ok(())
    };
    // What failed for sure has no bound yet.
    let unbounded = worst.iter().filter(|(bound, _)| bound.is_infinite()).map(|(_, place)| place.face);
    again(f64::MAX, &unbounded.collect::<Vec<u32>>(), &mut worst, &mut is_known)?;
    // A tolerance that is met is proven already: what else there is to know must not take longer than to meet it.
    let mut room = if is_met { emission.triangles.len() / MET_SHARE + MET_AT_LEAST } else { usize::MAX };
    for round in 0.. {
        // Before this round fewer than half as many were tightened.
        let most = PROBED.max(TIGHTENED << (round + 1));
        let order = greatest(worst.iter().copied(), most, watch)?;
        best.upper = order.first().map_or(0.0, |&(bound, _)| bound);
        let is_leaf = |place: Place| is_known[place.face as usize];
        lower(engine, (plan, emission), &mesh, (&order, is_leaf, &mut probed), &mut best)?;
        if !best.certified || best.upper <= wide * best.lower || round >= MOST_TIGHTENINGS {
            break;
        }
        // Bounds that are good enough for the goals need not be tight.
        let is_loose = |&(bound, place): &(f64, Place)| {
            let known = tightened[place.face as usize];
            bound > best.lower && known.is_none_or(|known| wide * known < best.lower)
        };
        let (mut loose, mut stays) = (Vec::new(), 0.0);
        for &(bound, place) in order.iter().filter(|known| is_loose(known)).take(TIGHTENED << round) {
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
        again(NARROW * best.lower, &loose, &mut worst, &mut is_known)?;
        loose.iter().for_each(|&face| tightened[face as usize] = Some(best.lower));
    }
    if !best.certified {
        best.upper = estimated(engine, plan, &worst, &mesh, &mut best)?;
    }
    best.upper = best.upper.max(best.lower) + engine.rounding;
    best.lower = (best.lower - engine.rounding).max(0.0);
    Ok(best)
}

/// So many of the greatest bounds, the greatest first.
fn greatest(
    bounds: impl Iterator<Item = (f64, Place)>,
    most: usize,
    watch: &SharedWatch<'_>,
) -> Result<Vec<(f64, Place)>, Cancelled> {
    let by_place = |a: &Place, b: &Place| (a.face, a.path).cmp(&(b.face, b.path));
    let order = |a: &(f64, Place), b: &(f64, Place)| b.0.total_cmp(&a.0).then_with(|| by_place(&a.1, &b.1));
    let mut found = Vec::with_capacity(2 * most);
    // So many are at least as great as this.
    let mut least: Option<(f64, Place)> = None;
    watch.each(bounds, |bound| {
        if least.is_some_and(|least| order(&least, &bound).is_le()) {
            return;
        }
        found.push(bound);
        if found.len() == 2 * most {
            least = Some(*found.select_nth_unstable_by(most - 1, order).1);
            found.truncate(most);
        }
    })?;
    found.sort_unstable_by(order);
    found.truncate(most);
    Ok(found)
}

/// Raises the lower bound by points over the first leaves of a list that promise more, but for those that were looked at. Where a
/// place is not known to be that of a leaf with this bound, its control face is looked at.
fn lower(
    engine: &Engine<'_>,
    (plan, emission): (&Plan, &Emission),
    mesh: &Nearest<'_, '_>,
    (order, is_leaf, probed): (&[(f64, Place)], impl Fn(Place) -> bool, &mut Probed),
    best: &mut ErrorBounds,
) -> Result<(), Cancelled> {
    let most = order.first().map_or(0.0, |&(promise, _)| promise);
    let most_probed = PROBED.min(FEWEST_PROBED + MOST_BOXES / mesh.boxes.len().max(1));
    for &(promise, place) in order.iter().take(most_probed) {
        if promise <= best.lower || best.lower > probed.enough * most {
            break;
        }
        let leaf = is_leaf(place).then_some(place);
        if !probed.leaves.insert((place.face, leaf)) {
            continue;
        }
        for point in farthest(engine, plan, emission, place.face, leaf)? {
            let distance = mesh.distance(point, place.face)?;
            if distance > best.lower {
                (best.lower, best.at) = (distance, point.to_array());
            }
        }
    }
    Ok(())
}

/// Where nothing is certain: the greatest distance of samples over the faces that may be worse than what was found; after
/// many of them the next estimate.
fn estimated(
    engine: &Engine<'_>,
    plan: &Plan,
    worst: &[(f64, Place)],
    mesh: &Nearest<'_, '_>,
    best: &mut ErrorBounds,
) -> Result<f64, Cancelled> {
    let control = engine.control;
    let bounds = worst.iter().map(|&(bound, _)| bound);
    let mut order: Vec<(f64, u32)> = bounds.zip(0..).collect();
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (count, &(bound, face)) in order.iter().enumerate() {
        if bound <= best.lower || count >= MOST_MEASURED {
            return Ok(bound.max(best.lower));
        }
        let trees = &plan.decision.trees;
        let levels = trees.depth(trees.root(face)) as usize + SAMPLED_LEVELS;
        let mut points = Vec::new();
        sample(control.piece(face).surface(control.rules), levels.min(MOST_SAMPLED_LEVELS), &mut points);
        for point in points {
            let distance = mesh.distance(point, face)?;
            if distance > best.lower {
                (best.lower, best.at) = (distance, point.to_array());
            }
        }
    }
    Ok(best.lower)
}

impl Plan {
    /// The worst leaves of the control faces, with their bounds.
    fn worst_by_face(&self, watch: &SharedWatch<'_>) -> Result<Vec<(f64, Place)>, Cancelled> {
        let mut worst: Vec<(f64, Place)> =
            (0..self.closed.len() as u32).map(|face| (0.0, Place::root(face))).collect();
        let closed = self.closed.iter().filter_map(|face| face.extent());
        let extents = self.decision.extents().chain(closed);
        let judged = extents.filter_map(|extent| Some((extent.bound, extent.worst?)));
        watch.each(judged.chain(self.settled.iter().flatten().copied()), |(bound, place)| {
            let known = &mut worst[place.face as usize];
            if bound > known.0 {
                *known = (bound, place);
            }
        })?;
        Ok(worst)
    }
}

/// The nearest points of the emitted triangles.
struct Nearest<'a, 'w> {
    watch: &'a SharedWatch<'w>,
    emission: &'a Emission,
    /// Boxes that hold the surface over each control face, and so the corners of its triangles.
    boxes: Vec<Bounds>,
    /// Those of [`GROUP`] boxes together.
    groups: Vec<Bounds>,
}

impl<'a, 'w> Nearest<'a, 'w> {
    fn of(engine: &'a Engine<'w>, plan: &Plan, emission: &'a Emission) -> Result<Self, Cancelled> {
        let (control, edges) = (engine.control.mesh, &engine.edges);
        let bounds = |face: usize| {
            let corners = control.triangles()[face].map(|vertex| vector(emission.positions[vertex as usize]));
            let mut bounds = corners.into_iter().fold(NO_BOUNDS, grown);
            let edges = (3 * face as u32..3 * face as u32 + 3).map(|h| plan.chains.vertices(edges, h));
            for run in edges.chain([emission.vertices_inside(face as u32)]) {
                bounds = emission.positions[run].iter().map(|&point| vector(point)).fold(bounds, grown);
            }
            bounds
        };
        let faces = control.face_count();
        let boxes = engine.watch.map(faces, block(faces), bounds)?;
        let joined = |a: Bounds, &[low, high]: &Bounds| grown(grown(a, low), high);
        let groups = boxes.chunks(GROUP).map(|group| group.iter().fold(NO_BOUNDS, joined)).collect();
        Ok(Self { watch: engine.watch, emission, boxes, groups })
    }

    /// The distance of a point to the mesh; `face` is likely to be nearest.
    fn distance(&self, point: DVec3, face: u32) -> Result<f64, Cancelled> {
        let mut least = f64::INFINITY;
        self.within(face, point, &mut least)?;
        for (group, bounds) in self.groups.iter().enumerate() {
            if group.is_multiple_of(LOOKED_AT as usize / GROUP) {
                self.watch.poll()?;
            }
            if distance_squared_to(bounds, point) < least {
                let first = GROUP * group;
                for (other, bounds) in (first..).zip(&self.boxes[first..]).take(GROUP) {
                    if distance_squared_to(bounds, point) < least && other != face as usize {
                        self.within(other as u32, point, &mut least)?;
                    }
                }
            }
        }
        Ok(least.sqrt())
    }

    fn within(&self, face: u32, point: DVec3, least: &mut f64) -> Result<(), Cancelled> {
        for (i, triangle) in (1u32..).zip(&self.emission.triangles[self.emission.triangles_of(face)]) {
            if i.is_multiple_of(LOOKED_AT) {
                self.watch.poll()?;
            }
            let corners = triangle.map(|vertex| vector(self.emission.positions[vertex as usize]) - point);
            *least = nearer(*least, corners);
        }
        Ok(())
    }
}

/// What rounding can have done to a distance: positions are convex combinations of convex combinations, one for
/// each level, and each adds a few units in the last place of the coordinates' size; those of a control vertex add one for
/// each neighbour. Points near an edge of a triangle count as on it ([`TriangleFrame::on_edge`]), on either side.
pub(super) fn rounding(control: &Mesh, max_levels: usize, watch: &SharedWatch<'_>) -> Result<f64, Cancelled> {
    let size = control.positions().as_flattened().iter().fold(0.0f64, |size, x| size.max(x.abs()));
    let topology = control.topology();
    let valence = |v: usize| topology.valence_and_openness(VertexId(v as u32)).0;
    let most = watch.pieces(control.vertex_count(), LOOKED_AT as usize, |piece| piece.map(valence).max());
    let most = most?.into_iter().flatten().max().unwrap_or(0);
    let units = 32.0 + 8.0 * max_levels.min(MOST_LEVELS) as f64 + f64::from(most);
    Ok((units * f64::EPSILON + 4.0 * TriangleFrame::ROUNDING) * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::{Stage, unobserved};

    /// As sorting all of them tells, equal ones by their places.
    #[test]
    fn the_greatest_are_those_of_the_sorted_list() {
        let mut unobserved = unobserved;
        let watch = SharedWatch::new(&mut unobserved, Stage::Assembling);
        let mut state = 5u64;
        for (count, most) in [(0, 3), (2, 3), (5, 1), (300, 7), (5000, 64), (5000, 2500), (5000, 5000)] {
            let mut number = |below: u64| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 33) % below
            };
            let mut all: Vec<(f64, Place)> = (0..count)
                .map(|face| {
                    (number(count / 3 + 1) as f64, Place { path: number(4), ..Place::root(face as u32) })
                })
                .collect();
            let found = greatest(all.iter().copied(), most, &watch).unwrap();
            all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.face.cmp(&b.1.face)));
            all.truncate(most);
            assert_eq!(found, all, "{count}, {most}");
        }
    }
}
