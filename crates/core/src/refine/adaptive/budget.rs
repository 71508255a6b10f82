//! The greatest number of triangles that a budget allows: the least distance whose plan fits.
//!
//! Each distance has a plan of its own, the same that a tolerance would have, so that what is proven at a number of
//! triangles is what a tolerance proves with as many. Counts follow a power of the distance ([`Growth`]); the search goes
//! down from coarse ones, which cost little, and narrows what is left. What a budget below [`EXACT`] leaves even then is spent
//! on the worst faces. Beside that stands the even division of all faces, which is nearer where these are curved alike.

use super::judge::Goal;
use super::{Engine, Plan, block};
use crate::certificate::{TriangleFrame, exceeds};
use crate::mesh::MeshError;
use crate::parallel;
use crate::progress::Cancelled;
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

/// What fails so many times over is as bad as any that has no number.
const COARSEST: f64 = 1e12;

/// What is found is at most so many times a distance that is known not to fit.
const PROMISED: f64 = 1.1;

/// The part of the budget that a guess aims at: what is left then is enough.
const AIM: f64 = 0.996;

/// The part of the budget that the first plan aims at, so that it fits.
const FIRST_AIM: f64 = 0.8;

/// Triangles that a face takes for each time that it is too high, about: some are less high than need be, others close gaps.
const FOR_ONE: f64 = 2.9;

/// From one guess to the next distances fall by this much at most.
const MOST_APART: f64 = 8.0;

/// After more plans in a row than these that brought nothing, distances fall ever faster.
const MOST_IDLE: u32 = 2;

/// Plans beyond the budget are counted to the end up to so many more triangles (one in so many): then the next guess is better.
const COUNTED_BEYOND: usize = 4;

/// Distances that are tried below what was found where finer divisions may take fewer triangles: how many, and the ratio of one to the next.
const MOST_EVENER: usize = 10;
const EVENER: f64 = 0.93;

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

/// The geometric mean, also where the product is too great for a number.
fn middle(low: f64, high: f64) -> f64 {
    let squared = low * high;
    if squared.is_finite() { squared.sqrt() } else { low.sqrt() * high.sqrt() }
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
    let worst = best.worst();
    let is_known = worst.is_finite() || engine.control.criteria.is_none();
    let (mut high, mut low) = (if is_known { worst } else { COARSEST }, floor);
    let growth = Growth { undivided: best.triangles as f64 };
    // Triangles at the lesser distance, where they were counted to the end.
    let mut beyond = None;
    let mut power = 1.0f64;
    let enough = most - (most / LEFT).max(LEFT_AT_LEAST).min(most);
    let aim = AIM * most as f64;
    // How often the same end was moved, up to twice.
    let (mut fitted, mut moved) = (true, 0);
    // Plans in a row that brought nothing: where levels end the division, no distance does.
    let mut idle = 0u32;
    let is_near = |high: f64, low: f64, triangles: usize| {
        high <= low * if triangles < enough { 1.0 + NEAR } else { PROMISED }
    };
    let mut first = if engine.is_settled_later() { None } else { expected(engine, FIRST_AIM * most as f64)? };
    // Of distances below what is added to all of them nobody is any nearer.
    let least = if engine.control.criteria.is_some() { f64::MIN_POSITIVE } else { engine.rounding };
    while !is_near(high, low, best.triangles) && high > least.max(f64::MIN_POSITIVE) {
        let mut next = growth.distance(high, best.triangles, aim.min(STEP * best.triangles as f64), power);
        if let Some(expected) = first.take().filter(|&expected| low < expected && expected < high) {
            next = expected;
        } else if low > 0.0 {
            // Between two counts a power; but counts come in steps, so the middle where the same end was moved twice.
            let span = (high / low).ln();
            let is_apart = span > CLOSE && moved < 2;
            let guess = beyond.filter(|_| is_apart).map(|beyond| {
                let power = growth.power((high, best.triangles), (low, beyond));
                growth.distance(high, best.triangles, aim, power)
            });
            let edge = (0.05 * span).exp();
            next = guess.map_or(middle(low, high), |guess| guess.clamp(low * edge, high / edge));
        }
        if best.triangles >= enough {
            // Where many triangles pass at once much less may take hardly more.
            next = (high / PROMISED).max(low);
        }
        if idle > MOST_IDLE && (low == 0.0 || best.triangles >= enough) {
            next = if low > 0.0 { middle(low, high) } else { high / MOST_APART.powi(1 << idle) };
        }
        if !(next < high && next > low) {
            break;
        }
        let counted = most.saturating_add(most / COUNTED_BEYOND);
        let faces = 0..best.closed.len() as u32;
        let wanting: Vec<u32> = faces.filter(|&face| exceeds(best.bound(face), next)).collect();
        let found = plan(engine, &best, Goal::Within(next), &wanting, counted)?;
        let fits = found.as_ref().is_some_and(|plan| plan.triangles <= most);
        moved = if fits == fitted && moved < 2 { moved + 1 } else { 1 };
        fitted = fits;
        match found {
            Some(plan) if fits => {
                idle = if plan.triangles > best.triangles { 0 } else { idle + 1 };
                power = growth.power((high, best.triangles), (next, plan.triangles));
                (high, best) = (next, plan);
            }
            found => (low, beyond) = (next, found.map(|plan| plan.triangles)),
        }
    }
    if engine.control.flat.has_strips() {
        // A finer division that is more even may leave fewer triangles once strips are put together.
        let mut next = high;
        for _ in 0..MOST_EVENER {
            next *= EVENER;
            if next < floor.max(least) {
                break;
            }
            if let Some(plan) = engine.plan(Goal::Within(next), most)? {
                (best, high, low) = (plan, next, floor);
            }
        }
    }
    if most < EXACT && low > 0.0 {
        best = fill(engine, best, (high, low), most)?;
    }
    Ok((best, cap))
}

/// A plan for a goal that asks more of these faces than another: from that, where it knows what its triangles come to.
fn plan(
    engine: &Engine<'_>,
    coarser: &Plan,
    goal: Goal,
    wanting: &[u32],
    most: usize,
) -> Result<Option<Plan>, RefineError> {
    if engine.is_settled_later() {
        engine.plan(goal, most)
    } else {
        engine.finer(coarser, goal, wanting, most)
    }
}

/// The distance within which so many triangles are expected, by [`heights`]; `None` where all is flat.
///
/// Triangles' heights fall with the square of their size, so a face of height h takes about h/d triangles within d, and at least one:
/// with the k highest faces divided d = Σh/(wanted − others).
fn expected(engine: &Engine<'_>, wanted: f64) -> Result<Option<f64>, RefineError> {
    let mut heights = heights(engine)?;
    parallel::sort_polled(&mut heights, &mut |_| engine.watch.poll(), |a, b| b.total_cmp(a))?;
    let (mut sum, mut others) = (0.0, heights.len() as f64);
    for (at, &height) in heights.iter().enumerate() {
        (sum, others) = (sum + FOR_ONE * height, others - 1.0);
        let distance = sum / (wanted - others);
        let next = heights.get(at + 1).map_or(0.0, |next| FOR_ONE * next);
        if wanted > others && distance >= next {
            return Ok(Some(distance).filter(|distance| *distance > 0.0 && distance.is_finite()));
        }
    }
    Ok(None)
}

/// How high the surface stands over the triangles of the control faces' corners, in the middles of their edges.
fn heights(engine: &Engine<'_>) -> Result<Vec<f64>, Cancelled> {
    let control = engine.control;
    let faces = control.mesh.face_count();
    let height = |face: usize| {
        let piece = control.piece(face as u32);
        let frame = TriangleFrame::new(control.corners(face as u32).map(|corner| corner.position));
        let middles = piece.surface(control.rules).middles();
        middles.iter().map(|middle| frame.height(middle.position).abs()).fold(0.0, f64::max)
    };
    engine.watch.map(faces, block(faces), height)
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
    coarsest: Plan,
    most: usize,
    gain: f64,
    goal: impl Fn(Vec<bool>) -> Goal,
) -> Result<Plan, RefineError> {
    // Undivided faces are kept also where they are more.
    let Some(left) = most.checked_sub(coarsest.triangles) else { return Ok(coarsest) };
    let mut left = left as f64;
    let order = coarsest.faces_by_bound();
    let costs = order.iter().map(|&(_, face)| gain * f64::from(coarsest.closed[face as usize].triangles));
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
        order[..middle].iter().for_each(|&(_, face)| is_finer[face as usize] = true);
        let wanting: Vec<u32> = order[fits..middle].iter().map(|&(_, face)| face).collect();
        match plan(engine, &best, goal(is_finer), &wanting, most)? {
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

/// All faces divided evenly, as often as a budget allows, if that is any division and may come within a distance; below [`EXACT`]
/// triangles what is left is spent on the worst faces.
pub(super) fn even(engine: &Engine<'_>, distance: f64, most: usize) -> Result<Option<Plan>, RefineError> {
    let faces = engine.control.mesh.face_count();
    let levels = levels(engine, most);
    let triangles = faces << (2 * levels);
    // With twice the triangles the worst places come first in any case; and what is tried has to be looked at all over.
    let least = if most < EXACT { most / 2 } else { most - most / NEARLY_ALL };
    if levels == 0 || triangles < least {
        return Ok(None);
    }
    // Heights fall with the square of the size.
    let highest = heights(engine)?.into_iter().fold(0.0, f64::max);
    if highest > distance * 4f64.powi(levels as i32) {
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

#[cfg(test)]
mod tests {
    use super::super::demands::Demands;
    use super::super::with_engine;
    use super::*;
    use crate::mesh::Mesh;
    use crate::models;
    use crate::progress::unobserved;
    use crate::refine::ExactOptions;
    use crate::scheme::Loop;

    fn model(name: &str) -> Mesh {
        Mesh::from_soup(&models::find(name).unwrap().soup(), &Default::default()).unwrap().0
    }

    /// Counts that are expected are near those that come about.
    #[test]
    fn what_is_expected_is_of_the_right_size() {
        for name in ["torus", "sphere", "cup", "bunny", "teddy", "shoe"] {
            let mesh = model(name);
            let options = (&ExactOptions::default().triangles(1), &Demands::default());
            with_engine(&mesh, &Loop, options, &mut unobserved, |engine| {
                for wanted in [10_000.0, 40_000.0] {
                    let distance = expected(engine, wanted)?.unwrap();
                    let triangles =
                        engine.plan(Goal::Within(distance), usize::MAX)?.unwrap().triangles as f64;
                    assert!((0.5..1.6).contains(&(triangles / wanted)), "{name}, {wanted}: {triangles}");
                }
                Ok(())
            })
            .unwrap();
        }
    }
}
