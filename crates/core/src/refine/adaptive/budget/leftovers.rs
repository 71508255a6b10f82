//! What a budget leaves, spent on the worst faces: once all are within a distance, or once all are divided evenly.

use super::super::judge::Goal;
use super::super::{Engine, Plan};
use super::expected::heights;
use crate::refine::RefineError;

/// Plans that are made to spend what is left.
const MOST_FILLS: usize = 9;

/// Triangles that a division brings about at least, about.
const LEAST_GAIN: f64 = 2.0;

/// Budgets below this are spent to the last face.
pub(super) const EXACT: usize = 20_000;

/// Greater ones are divided evenly only where that takes all of them but for so many (one in so many).
const NEARLY_ALL: usize = 16;

/// A plan for a goal that asks more of these faces than another: from that, where it knows what its triangles come to.
pub(super) fn finer(
    engine: &Engine<'_>,
    coarser: &Plan,
    goal: Goal,
    wanting: &[u32],
    most: usize,
) -> Result<Option<Plan>, RefineError> {
    if engine.is_settled_later() {
        return engine.plan(goal, most);
    }
    let Some(mut finer) = engine.finer(coarser, goal, wanting, most)? else {
        return Ok(None);
    };
    Ok(engine.settle(&mut finer, most)?.then_some(finer))
}

/// Spends what is left of a budget on the worst faces, as many as fit: they come within the lesser of two distances, the
/// others within the greater.
pub(super) fn fill(
    engine: &Engine<'_>,
    plan: Plan,
    (high, low): (f64, f64),
    most: usize,
) -> Result<Plan, RefineError> {
    // Triangles grow with the reciprocal of the distance.
    filled(engine, plan, most, high / low - 1.0, |is_finer| {
        Goal::Partly(high, low, is_finer)
    })
}

/// The finest plan whose worst faces, as many as fit, are marked in the goal. A marked face has so many times its triangles more,
/// about.
fn filled(
    engine: &Engine<'_>,
    coarsest: Plan,
    most: usize,
    gain: f64,
    goal: impl Fn(Vec<bool>) -> Goal,
) -> Result<Plan, RefineError> {
    // Undivided faces are kept also where they are more.
    let Some(left) = most.checked_sub(coarsest.triangles) else {
        return Ok(coarsest);
    };
    let mut left = left as f64;
    let order = coarsest.faces_by_bound();
    let costs = order.iter().map(|&(_, face)| {
        (gain * f64::from(coarsest.closed[face as usize].triangles)).max(LEAST_GAIN)
    });
    let guess = costs.take_while(|cost| {
        left -= cost;
        left >= 0.0
    });
    let mut next = guess.count();
    let (mut best, mut fits, mut fails) = (coarsest, 0, order.len() + 1);
    for _ in 0..MOST_FILLS {
        if fits + 1 >= fails {
            break;
        }
        let middle = next.clamp(fits + 1, fails - 1);
        let mut is_finer = vec![false; best.closed.len()];
        order[..middle]
            .iter()
            .for_each(|&(_, face)| is_finer[face as usize] = true);
        let wanting: Vec<u32> = order[fits..middle].iter().map(|&(_, face)| face).collect();
        match finer(engine, &best, goal(is_finer), &wanting, most)? {
            Some(plan) => {
                (best, fits) = (plan, middle);
                next = if fails > order.len() {
                    2 * middle
                } else {
                    fits.midpoint(fails)
                };
            }
            None => {
                fails = middle;
                next = fits.midpoint(fails);
            }
        }
    }
    Ok(best)
}

/// All faces divided evenly, as often as a budget allows, if that is any division and may come within a distance; below [`EXACT`]
/// triangles what is left is spent on the worst faces.
pub(in super::super) fn even(
    engine: &Engine<'_>,
    distance: f64,
    most: usize,
) -> Result<Option<Plan>, RefineError> {
    let faces = engine.control.mesh.face_count();
    let levels = levels(engine, most);
    let triangles = faces << (2 * levels);
    // With twice the triangles the worst places come first in any case; and what is tried has to be looked at all over.
    let least = if most < EXACT {
        most / 2
    } else {
        most - most / NEARLY_ALL
    };
    if levels == 0 || triangles < least {
        return Ok(None);
    }
    // Heights fall with the square of the size.
    let highest = heights(engine)?.into_iter().fold(0.0, f64::max);
    if highest > distance * 4f64.powi(levels as i32) {
        return Ok(None);
    }
    let Some(even) = engine.plan(Goal::Even(levels, vec![false; faces]), most)? else {
        return Ok(None);
    };
    // What is left of great budgets is too little to matter.
    if levels >= engine.max_levels || most >= EXACT {
        return Ok(Some(even));
    }
    // Four for one, and what closes the gaps.
    filled(engine, even, most, 3.5, |is_finer| {
        Goal::Even(levels, is_finer)
    })
    .map(Some)
}

/// How often all faces can be divided.
fn levels(engine: &Engine<'_>, most: usize) -> u32 {
    let faces = engine.control.mesh.face_count().max(1);
    ((most / faces).max(1).ilog2() / 2).min(engine.max_levels)
}
