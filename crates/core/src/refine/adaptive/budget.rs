//! The finest mesh that a number of triangles allows: the least value whose result fits.
//!
//! Each value has a result of its own, the same that a tolerance would have, so that a number of
//! triangles proves what a tolerance proves with as many. The first is found by guesses, of which nothing is verified; the
//! search then narrows what is left between one that fits and one that does not. A small budget is then spent to the last face.

use super::Engine;
use super::judge::Goal;
use super::rounds::Verified;
use super::state::State;
use crate::mesh::MeshError;
use crate::refine::RefineError;
use crate::refine::exact_result::ExactStop;

const LEFT_AT_LEAST: usize = 12;

/// Budgets below this are spent to the last face.
const EXACT: usize = 20_000;

/// A value, and how many triangles it takes.
#[derive(Clone, Copy)]
struct Tried {
    value: f64,
    triangles: f64,
}

/// The finest mesh within values down to `floor` that has at most `most` triangles, and why it is not finer: at last because of `cap`.
pub(super) fn search(
    engine: &Engine<'_>,
    floor: f64,
    most: usize,
    cap: ExactStop,
) -> Result<(Verified, ExactStop), RefineError> {
    if floor > 0.0
        && let Some(found) = engine.refined(Goal::Within(floor), most)?
    {
        return Ok((found, ExactStop::Met));
    }
    let mut search = Search::new(engine, floor, most)?;
    search.narrow()?;
    let Between { high, low, .. } = search.between;
    let best = if most < EXACT && low > 0.0 {
        // A value that is less by a tenth takes more triangles.
        let less = low.min(high / 1.1).max(floor);
        fill(engine, search.best, high, less, most)?
    } else {
        search.best
    };
    Ok((best, cap))
}

/// All faces divided evenly, as often as a budget allows, if that takes nearly all of it.
pub(super) fn even(engine: &Engine<'_>, most: usize) -> Result<Option<Verified>, RefineError> {
    let faces = engine.control.mesh.face_count();
    let levels = ((most / faces.max(1)).max(1).ilog2() / 2).min(engine.max_levels);
    if levels == 0 || faces << (2 * levels) < most - most / 16 {
        return Ok(None);
    }
    let goal = Goal::Within(f64::INFINITY);
    engine.verified(State::even(goal, faces, levels)?, most)
}

/// The values between which a number of triangles is looked for.
#[derive(Clone)]
struct Between {
    /// The triangles of undivided faces.
    undivided: f64,
    /// The least value with few enough triangles; the greatest with too many, 0 where there is none.
    high: f64,
    low: f64,
    last: Tried,
}

impl Between {
    /// The value that is tried next for so many triangles: triangles grow like the reciprocal of the value, about.
    fn next(&self, aim: f64) -> f64 {
        let divided = |triangles: f64| (triangles - self.undivided).max(1.0);
        let times = divided(aim) / divided(self.last.triangles);
        // From one value to the next they change by 16 times at most.
        let value = self.last.value / times.clamp(1.0 / 16.0, 16.0);
        if self.holds(value) {
            value
        } else {
            (self.high * self.low).sqrt()
        }
    }

    fn holds(&self, value: f64) -> bool {
        self.low < value && value < self.high
    }

    /// Takes what a value gives.
    fn take(&mut self, tried: Tried, fits: bool) {
        self.last = tried;
        match fits {
            true => self.high = tried.value,
            false => self.low = tried.value,
        }
    }
}

/// The narrowing of values to the least one that fits.
struct Search<'e, 'a> {
    engine: &'e Engine<'a>,
    most: usize,
    between: Between,
    /// The result at the least value that fits.
    best: Verified,
    /// Below this no value makes a difference.
    least: f64,
}

impl<'e, 'a> Search<'e, 'a> {
    /// Begins with undivided faces, which fit any budget.
    fn new(engine: &'e Engine<'a>, floor: f64, most: usize) -> Result<Self, RefineError> {
        let has_criteria = engine.control.criteria.is_some();
        let broken = || MeshError::Broken {
            place: format!("{} control faces", engine.control.mesh.face_count()),
            what: "undivided faces fit any budget",
        };
        let best = engine
            .refined(Goal::Within(f64::INFINITY), usize::MAX)?
            .ok_or_else(broken)?;
        // Criteria may have no answer to undivided faces but that they are as bad as can be.
        let worst = best.state.worst();
        let value = if worst.is_finite() || !has_criteria {
            worst
        } else {
            // A triangle without a number counts as one that fails so many times over.
            1e12
        };
        let triangles = best.state.triangles as f64;
        let rounding = if has_criteria { 0.0 } else { engine.rounding };
        let between = Between {
            undivided: triangles,
            high: value,
            low: floor,
            last: Tried { value, triangles },
        };
        Ok(Self {
            engine,
            most,
            between,
            best,
            least: rounding.max(f64::MIN_POSITIVE),
        })
    }

    fn narrow(&mut self) -> Result<(), RefineError> {
        let undivided = self.between.undivided;
        let most = self.most as f64;
        // Aims a little below the budget, or below what undivided faces leave of it.
        let aim = (0.985 * most).max(undivided + 0.9 * (most - undivided));
        // Results beyond the budget are counted up to half as many again.
        let counted = self.most.saturating_add(self.most / 2);
        // Verifying adds some five per cent.
        let mut first = self.guess(aim / 1.05)?;
        // Values that are verified at most.
        for _ in 0..16 {
            let is_full = self.is_full();
            // Bounds are within some per cent of the truth: values that differ by 1 % are as good as each other, by 4 % where hardly anything is left.
            let near = if is_full { 1.04 } else { 1.01 };
            let is_near = self.between.high <= (near * self.between.low).max(self.least);
            if is_near || is_full && self.most >= EXACT {
                return Ok(());
            }
            let aim = if is_full { most } else { aim };
            let (value, found) = match first.take() {
                Some((value, state)) => (value, self.engine.verified(state, counted)?),
                None => {
                    let value = self.between.next(aim);
                    if !self.between.holds(value) {
                        return Ok(());
                    }
                    (value, self.engine.refined(Goal::Within(value), counted)?)
                }
            };
            let triangles = found.as_ref().map(|found| found.state.triangles as f64);
            // A mesh with too many triangles to count has about twice the budget.
            let triangles = triangles.unwrap_or(2.0 * most);
            let tried = Tried { value, triangles };
            let found = found.filter(|found| found.state.triangles <= self.most);
            self.between.take(tried, found.is_some());
            if let Some(found) = found {
                self.best = found;
            }
        }
        Ok(())
    }

    /// Whether hardly anything is left of the budget.
    fn is_full(&self) -> bool {
        let room = self.most.saturating_sub(self.between.undivided as usize);
        // A 32nd of the budget may be left, or an eighth of what undivided faces leave of it.
        let left = (self.most / 32).min(room / 8);
        self.best.state.triangles + left.max(LEFT_AT_LEAST) >= self.most
    }

    /// The division for about the number of triangles that is aimed at, and its value; `None` where there are none between.
    fn guess(&self, aim: f64) -> Result<Option<(f64, State)>, RefineError> {
        // Guesses are counted up to four times the budget.
        let counted = self.most.saturating_mul(4);
        let (mut between, mut last) = (self.between.clone(), None);
        for _ in 0..8 {
            let value = between.next(aim);
            if !between.holds(value) {
                break;
            }
            let found = self.engine.guessed(Goal::Within(value), counted)?;
            let triangles = found.as_ref().map_or(counted, |state| state.triangles) as f64;
            let tried = Tried { value, triangles };
            last = found.map(|state| (value, state));
            // Two per cent off is good enough for a guess.
            if (triangles / aim - 1.0).abs() < 0.02 || value <= self.least {
                break;
            }
            between.take(tried, triangles <= aim);
        }
        Ok(last)
    }
}

/// Spends what is left of a budget on the worst faces, as many as fit: they come within the lesser of two values, the
/// others within the greater.
fn fill(
    engine: &Engine<'_>,
    best: Verified,
    value: f64,
    less: f64,
    most: usize,
) -> Result<Verified, RefineError> {
    let mut order: Vec<(f64, u32)> = (0..best.state.faces())
        .map(|face| (best.state.worst_of(face), face))
        .collect();
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let (mut best, mut fits, mut fails) = (best, 0, order.len() + 1);
    // The range of faces is halved each time.
    for _ in 0..6 {
        let left = most - best.state.triangles;
        // A face takes three triangles at most, on the average.
        let next = (fits + left / 3).min(fits.midpoint(fails));
        if left < (most / 64).max(LEFT_AT_LEAST) || next == fits {
            break;
        }
        let mut is_marked = vec![false; order.len()];
        order
            .iter()
            .take(next)
            .for_each(|&(_, face)| is_marked[face as usize] = true);
        match engine.refined(Goal::Partly(value, less, is_marked), most)? {
            Some(found) => (best, fits) = (found, next),
            None => fails = next,
        }
    }
    Ok(best)
}
