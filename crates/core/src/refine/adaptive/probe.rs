//! The certified interval for the whole mesh.
//!
//! Above stand the bounds of what was let pass. Below stand distances that were found: from points of the surface over the
//! worst leaves to the nearest triangle of the mesh, which is looked for in all control faces whose points come near.

mod farthest;
mod nearest_triangle;

use core::cmp::Ordering;
use std::collections::{HashMap, HashSet};

use super::Engine;
use super::emit::Emission;
use super::emitted::Sources;
use super::judge::Goal;
use super::measure::{Look, measure};
use super::measured::Measured;
use super::quadtree::NodeAddress;
use super::state::State;
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

/// A lower bound beyond this part of the upper one is good enough.
const NARROW: f64 = 0.99;

/// Upper bounds so many times the lower one are taken again.
const WIDE: f64 = 1.2;

/// Control faces that are looked at together for tighter bounds at first, then twice as many each time.
const TIGHTENED: usize = 64;

/// A control face, a bound of the distance over it, and the leaf that has it, where that is known.
#[derive(Clone, Copy)]
struct Bound {
    value: f64,
    face: u32,
    leaf: Option<NodeAddress>,
}

/// The leaves that were looked at for lower bounds.
struct Probed {
    /// Control faces, and which known leaf of theirs.
    leaves: HashSet<(u32, Option<NodeAddress>)>,
    /// A lower bound beyond this part of the upper one is good enough.
    enough: f64,
}

/// The certified interval. It is less tight where a tolerance is met.
pub(super) fn probe(
    engine: &Engine<'_>,
    state: &State,
    emission: &Emission,
    is_met: bool,
) -> Result<ErrorBounds, RefineError> {
    let watch = engine.watch;
    let certified = engine.control.rules.is_certified();
    let mut best = ErrorBounds {
        lower: 0.0,
        upper: 0.0,
        at: [0.0; 3],
        certified,
    };
    let sources = engine.sources(state, emission);
    let mesh = Nearest::of(sources, watch)?;
    let (enough, wide) = if is_met { (0.9, 1.12) } else { (NARROW, WIDE) };
    let mut probed = Probed {
        leaves: HashSet::new(),
        enough,
    };
    // Bounds may be large for lack of room for tangential displacement; heights are right elsewhere.
    let highest = state.measured.iter().map(Measured::highest_leaf);
    let highest = greatest(highest, PROBED, watch)?;
    lower(&sources, watch, &mesh, &highest, &mut probed, &mut best)?;
    let mut bounds = Vec::with_capacity(state.covers.len());
    watch.each(0..state.faces(), |face| bounds.push(bound_of(state, face)))?;
    let again = |length: f64, faces: &[u32]| {
        let nothing = Goal::Within(f64::INFINITY);
        let look = Look {
            goal: &nothing,
            divided_above: 0,
            length,
            changes: None,
            bulges: None,
            trusted: &[],
        };
        measure(&sources, watch, faces, &look)
    };
    // Triangles that failed for sure have no bound yet.
    let unbounded: Vec<u32> = bounds
        .iter()
        .filter(|bound| bound.value.is_infinite())
        .map(|bound| bound.face)
        .collect();
    for (&face, found) in unbounded.iter().zip(again(f64::MAX, &unbounded)?) {
        bounds[face as usize] = found.worst_leaf();
    }
    // A tolerance that is met is proven already: what else there is to know must not take longer than to meet it.
    let mut room = if is_met {
        emission.triangles.len() / 64 + 6_000
    } else {
        usize::MAX
    };
    let mut tightened: HashMap<u32, f64> = HashMap::new();
    for round in 0.. {
        let order = greatest(
            bounds.iter().copied(),
            PROBED.max(TIGHTENED << (round + 1)),
            watch,
        )?;
        best.upper = order.first().map_or(0.0, |bound| bound.value);
        lower(&sources, watch, &mesh, &order, &mut probed, &mut best)?;
        if !certified || best.upper <= wide * best.lower || round >= 6 {
            break;
        }
        let is_loose = |bound: &&Bound| {
            let is_new = |&known: &f64| wide * known < best.lower;
            bound.value > best.lower && tightened.get(&bound.face).is_none_or(is_new)
        };
        let (mut loose, mut stays) = (Vec::new(), 0.0);
        for bound in order.iter().filter(is_loose).take(TIGHTENED << round) {
            let count = emission.triangles_of(bound.face).len();
            if count > room {
                (room, stays) = (0, bound.value);
                break;
            }
            room -= count;
            loose.push(bound.face);
        }
        // Where one stays as it is the others are of no use.
        // Bounds are taken again only if that lowers the upper bound by five per cent.
        if loose.is_empty() || stays > 0.95 * best.upper {
            break;
        }
        let found = again(NARROW * best.lower, &loose)?;
        let heights = greatest(found.iter().map(Measured::highest_leaf), PROBED, watch)?;
        for (&face, found) in loose.iter().zip(&found) {
            tightened.insert(face, best.lower);
            let known = &mut bounds[face as usize];
            if found.worst.0 < known.value {
                *known = found.worst_leaf();
            }
        }
        lower(&sources, watch, &mesh, &heights, &mut probed, &mut best)?;
    }
    if !certified {
        best.upper = estimated(engine, state, emission, &bounds, &mut best)?;
    }
    best.upper = best.upper.max(best.lower) + engine.rounding;
    best.lower = (best.lower - engine.rounding).max(0.0);
    Ok(best)
}

/// The greatest bound over a control face.
fn bound_of(state: &State, face: u32) -> Bound {
    let measured = state.measured[face as usize].worst_leaf();
    let proven = state.proven_bound(face);
    // Leaves that were proven may have been split since.
    if proven > measured.value {
        Bound {
            value: proven,
            face,
            leaf: None,
        }
    } else {
        measured
    }
}

impl Measured {
    fn worst_leaf(&self) -> Bound {
        let (value, leaf) = self.worst;
        Bound {
            value,
            face: leaf.face,
            leaf: Some(leaf),
        }
    }

    fn highest_leaf(&self) -> Bound {
        let (value, leaf) = self.highest;
        Bound {
            value,
            face: leaf.face,
            leaf: Some(leaf),
        }
    }
}

/// The order of bounds, the greatest first.
fn by_bound(a: &Bound, b: &Bound) -> Ordering {
    b.value.total_cmp(&a.value).then(a.face.cmp(&b.face))
}

/// So many of the greatest bounds, the greatest first.
fn greatest(
    bounds: impl Iterator<Item = Bound>,
    most: usize,
    watch: &SharedWatch<'_>,
) -> Result<Vec<Bound>, Cancelled> {
    let mut found = Vec::new();
    // So many are at least as great as this.
    let mut least: Option<Bound> = None;
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
    found.sort_unstable_by(by_bound);
    found.truncate(most);
    Ok(found)
}

/// Raises the lower bound by points over the first leaves of a list that promise more, but for those that were looked at. Where a
/// leaf is not known, its control face is looked at.
fn lower(
    sources: &Sources<'_>,
    watch: &SharedWatch<'_>,
    mesh: &Nearest<'_>,
    order: &[Bound],
    probed: &mut Probed,
    best: &mut ErrorBounds,
) -> Result<(), Cancelled> {
    let most = order.first().map_or(0.0, |bound| bound.value);
    // Eight leaves are looked at in any case, and more where that takes few boxes of control faces.
    let most_probed = PROBED.min(8 + 2_000_000 / sources.covers.len().max(1));
    let mut left = order
        .iter()
        .take(most_probed)
        .map(|bound| (bound.value, (bound.face, bound.leaf)))
        .peekable();
    let enough = probed.enough * most;
    let is_enough = |best: &ErrorBounds| best.lower > enough;
    // Some are looked at together, by all threads, so many that these need not be woken for each; what is not needed any more is forgotten.
    let most_at_once = if parallel::threads() > 1 {
        4 * parallel::threads()
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
        let poll = &mut |_| watch.poll();
        let found = parallel::each_long_polled(some, poll, |(promise, leaf), is_stopped| {
            let points = farthest(sources, leaf.0, leaf.1, is_stopped).into_iter();
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

/// Where nothing is certain: the greatest distance of samples over the faces that may be worse than what was found; after
/// many of them the next estimate.
fn estimated(
    engine: &Engine<'_>,
    state: &State,
    emission: &Emission,
    bounds: &[Bound],
    best: &mut ErrorBounds,
) -> Result<f64, RefineError> {
    let control = engine.control;
    let triangles = Triangles {
        positions: &emission.positions,
        triangles: &emission.triangles,
    };
    let tree = Bvh::new_observed(triangles, &mut engine.watch.observer())?;
    let mut count = 0;
    let mut order = bounds.to_vec();
    order.sort_unstable_by(by_bound);
    for Bound { value, face, .. } in order {
        // That takes some seconds.
        if value <= best.lower || count >= 1_000_000 {
            return Ok(value.max(best.lower));
        }
        let levels = state.trees.depth(state.trees.root(face)) as usize + SAMPLED_LEVELS;
        let mut points = Vec::new();
        sample(
            control.piece(face).surface(control.rules),
            levels.min(6),
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

/// The greatest rounding error of a distance: positions are convex combinations of convex combinations, one for
/// each level, and each adds a few units in the last place of the coordinates' size; those of a control vertex add one for
/// each neighbour. Points near an edge of a triangle count as on it ([`TriangleFrame::on_edge`]), on either side.
pub(in crate::refine) fn rounding(
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
    let most = watch.pieces(control.vertex_count(), 1 << 14, |piece| {
        piece.map(valence).max()
    });
    let most = most?.into_iter().flatten().max().unwrap_or(0);
    // Edges have no length left below 64 levels.
    let units = 32.0 + 8.0 * max_levels.min(64) as f64 + f64::from(most);
    Ok((units * f64::EPSILON + 4.0 * TriangleFrame::ROUNDING) * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::{Stage, unobserved};
    use limitmesh_testing::Random;

    /// The result is that of sorting all of them, equal ones by their places.
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
            let mut all: Vec<(f64, u32)> = (0..count as u32)
                .map(|face| (random.below(count / 3 + 1) as f64, face))
                .collect();
            let bounds = all.iter().map(|&(value, face)| Bound {
                value,
                face,
                leaf: None,
            });
            let found = greatest(bounds, most, &watch).unwrap();
            let found: Vec<_> = found
                .iter()
                .map(|bound| (bound.value, bound.face))
                .collect();
            all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            all.truncate(most);
            assert_eq!(found, all, "{count}, {most}");
        }
    }
}
