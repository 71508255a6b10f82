//! The greatest number of triangles that a budget allows: the least distance whose plan fits.
//!
//! Each distance has a plan of its own, the same that a tolerance would have, so that what is proven at a number of
//! triangles is what a tolerance proves with as many. Counts follow a power of the distance ([`Growth`]); the search goes
//! down from coarse ones, which cost little, and narrows what is left. What a budget below [`EXACT`] leaves even then is spent
//! on the worst faces. Beside that stands the even division of all faces, which is nearer where these are curved alike.

use super::judge::Goal;
use super::{Engine, Plan};
use crate::mesh::MeshError;
use crate::refine::RefineError;
use crate::refine::exact_result::ExactStop;

/// From one plan to the next the triangles grow by this much at most while none has passed the budget.
const STEP: f64 = 6.0;

/// The part of the budget that may be left (one in so many).
const LEFT: usize = 100;

/// Fewer triangles than this may be left in any case.
const LEFT_AT_LEAST: usize = 12;

/// Distances nearer to each other than this tell nothing any more.
const NEAR: f64 = 1e-3;

/// Between distances nearer than that, as a logarithm, counts jump: the middle is as good as any guess.
const CLOSE: f64 = 0.03;

/// What fails so many times over is as bad as any.
const COARSEST: f64 = 1e12;

/// What is found is at most so many times a distance that is known not to fit.
const PROMISED: f64 = 1.1;

/// The part of the budget that a guess aims at: what is left then is enough.
const AIM: f64 = 0.996;

/// From one guess to the next distances fall by this much at most.
const MOST_APART: f64 = 8.0;

/// Plans beyond the budget are counted to the end up to so many more triangles (one in so many): then the next guess is better.
const COUNTED_BEYOND: usize = 4;

/// Plans that are made to spend what is left.
const MOST_FILLS: usize = 9;

/// Budgets below this are spent to the last face.
const EXACT: usize = 20_000;

/// Greater ones are divided evenly only where that takes all of them but for so many (one in so many).
const NEARLY_ALL: usize = 16;

/// How triangles grow: those beyond the undivided faces with a power of the reciprocal of the distance.
struct Growth {
    undivided: f64,
}

impl Growth {
    fn divided(&self, triangles: f64) -> f64 {
        (triangles - self.undivided).max(0.02 * self.undivided)
    }

    /// The distance at which so many are wanted, where there are some at another.
    fn distance(&self, from: f64, triangles: usize, wanted: f64, power: f64) -> f64 {
        let times = self.divided(wanted) / self.divided(triangles as f64);
        from / times.max(1.0 + NEAR).powf(1.0 / power).min(MOST_APART)
    }

    /// The power between two distances with their triangles.
    fn power(&self, (coarse, few): (f64, usize), (fine, many): (f64, usize)) -> f64 {
        let times = self.divided(many as f64) / self.divided(few as f64);
        let power = times.ln() / (coarse / fine).ln();
        if power > 0.0 { power.clamp(0.4, 3.0) } else { 1.0 }
    }
}

/// The finest plan within distances down to `floor` that has at most `most` triangles, and why it is not finer.
pub(super) fn search(
    engine: &Engine<'_>,
    floor: f64,
    most: usize,
    cap: ExactStop,
) -> Result<(Plan, ExactStop), RefineError> {
    if floor > 0.0
        && let Some(plan) = engine.plan(Goal::Within(floor), most)?
    {
        return Ok((plan, ExactStop::Met));
    }
    let everything = engine.plan(Goal::Within(f64::INFINITY), usize::MAX)?;
    let mut best = everything.ok_or_else(|| MeshError::Broken {
        place: format!("{} control faces", engine.control.mesh.face_count()),
        what: "undivided faces fit any budget",
    })?;
    // Criteria may have no answer to undivided faces but that they are as bad as can be.
    let most_value = if engine.control.criteria.is_some() { COARSEST } else { f64::INFINITY };
    let (mut high, mut low) = (best.worst().min(most_value), floor);
    let growth = Growth { undivided: best.triangles as f64 };
    // Triangles at the lesser distance, where they were counted to the end.
    let mut beyond = None;
    let mut power = 1.0f64;
    let enough = most - (most / LEFT).max(LEFT_AT_LEAST).min(most);
    let aim = AIM * most as f64;
    // How often the same end was moved, up to twice.
    let (mut fitted, mut moved) = (true, 0);
    let is_near = |high: f64, low: f64, triangles: usize| {
        high <= low * if triangles < enough { 1.0 + NEAR } else { PROMISED }
    };
    while !is_near(high, low, best.triangles) && high > f64::MIN_POSITIVE {
        let mut next = growth.distance(high, best.triangles, aim.min(STEP * best.triangles as f64), power);
        if low > 0.0 {
            // Between two counts a power; but counts come in steps, so the middle where the same end was moved twice.
            let span = (high / low).ln();
            let is_apart = span > CLOSE && moved < 2;
            let guess = beyond.filter(|_| is_apart).map(|beyond| {
                let power = growth.power((high, best.triangles), (low, beyond));
                growth.distance(high, best.triangles, aim, power)
            });
            let edge = (0.05 * span).exp();
            next = guess.map_or((high * low).sqrt(), |guess| guess.clamp(low * edge, high / edge));
        }
        if best.triangles >= enough {
            // Where many triangles pass at once much less may take hardly more.
            next = (high / PROMISED).max(low);
        }
        if !(next < high && next > low) {
            break;
        }
        let plan = engine.plan(Goal::Within(next), most.saturating_add(most / COUNTED_BEYOND))?;
        let fits = plan.as_ref().is_some_and(|plan| plan.triangles <= most);
        moved = if fits == fitted && moved < 2 { moved + 1 } else { 1 };
        fitted = fits;
        match plan {
            Some(plan) if fits => {
                power = growth.power((high, best.triangles), (next, plan.triangles));
                (high, best) = (next, plan);
            }
            plan => (low, beyond) = (next, plan.map(|plan| plan.triangles)),
        }
    }
    if most < EXACT && low > 0.0 {
        best = fill(engine, best, (high, low), most)?;
    }
    Ok((best, cap))
}

/// Spends what is left of a budget on the worst faces, as many as fit: they come within the lesser of two distances, the
/// others within the greater.
fn fill(engine: &Engine<'_>, plan: Plan, (high, low): (f64, f64), most: usize) -> Result<Plan, RefineError> {
    // Triangles grow with the reciprocal of the distance.
    filled(engine, plan, most, high / low - 1.0, |is_finer| Goal::Partly(high, low, is_finer))
}

/// The finest plan whose worst faces, as many as fit, are marked in the goal. A marked face has so many times its triangles more,
/// about.
fn filled(
    engine: &Engine<'_>,
    plan: Plan,
    most: usize,
    gain: f64,
    goal: impl Fn(Vec<bool>) -> Goal,
) -> Result<Plan, RefineError> {
    // Undivided faces are kept also where they are more.
    let Some(left) = most.checked_sub(plan.triangles) else { return Ok(plan) };
    let mut left = left as f64;
    let order = plan.faces_by_bound();
    let costs = order.iter().map(|&(_, face)| gain * f64::from(plan.closed[face as usize].triangles));
    let guess = costs.take_while(|cost| {
        left -= cost;
        left >= 0.0
    });
    let mut next = guess.count();
    let (mut best, mut fits, mut fails) = (plan, 0, order.len() + 1);
    for _ in 0..MOST_FILLS {
        if fits + 1 >= fails {
            break;
        }
        let middle = next.clamp(fits + 1, fails - 1);
        let mut is_finer = vec![false; best.closed.len()];
        order[..middle].iter().for_each(|&(_, face)| is_finer[face as usize] = true);
        match engine.plan(goal(is_finer), most)? {
            Some(plan) => {
                (best, fits) = (plan, middle);
                next = if fails > order.len() { 2 * middle } else { fits.midpoint(fails) };
            }
            None => {
                fails = middle;
                next = fits.midpoint(fails);
            }
        }
    }
    Ok(best)
}

/// All faces divided evenly, as often as a budget allows, if that is any division; below [`EXACT`] triangles what is left is spent
/// on the worst faces.
pub(super) fn even(engine: &Engine<'_>, most: usize) -> Result<Option<Plan>, RefineError> {
    let faces = engine.control.mesh.face_count();
    let levels = levels(engine, most);
    let triangles = faces << (2 * levels);
    // With twice the triangles the worst places come first in any case; and what is tried has to be looked at all over.
    let least = if most < EXACT { most / 2 } else { most - most / NEARLY_ALL };
    if levels == 0 || triangles < least {
        return Ok(None);
    }
    let Some(even) = engine.plan(Goal::Even(levels, vec![false; faces]), most)? else { return Ok(None) };
    // What is left of great budgets is too little to matter.
    if levels >= engine.max_levels || most >= EXACT {
        return Ok(Some(even));
    }
    // Four for one, and what closes the gaps.
    filled(engine, even, most, 3.5, |is_finer| Goal::Even(levels, is_finer)).map(Some)
}

/// How often all faces can be divided.
fn levels(engine: &Engine<'_>, most: usize) -> u32 {
    let faces = engine.control.mesh.face_count().max(1);
    ((most / faces).max(1).ilog2() / 2).min(engine.max_levels)
}
