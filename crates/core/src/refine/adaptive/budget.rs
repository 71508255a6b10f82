//! The finest mesh that a number of triangles allows: the least value whose result fits.
//!
//! Each value has a result of its own, the same that a tolerance would have, so that a number of
//! triangles proves what a tolerance proves with as many. Counts follow a power of the value; the search narrows what is left between one
//! that fits and one that does not. A small budget is then spent to the last face.

mod heights;

use super::Engine;
use super::judge::Goal;
use super::rounds::Verified;
use super::state::State;
use crate::mesh::MeshError;
use crate::refine::RefineError;
use crate::refine::exact_result::ExactStop;

/// Values that are tried.
const MOST_TRIES: usize = 16;

/// The part of the budget that may be left (one in so many), that of what undivided faces leave of it, and fewer triangles than this in any case.
const LEFT: usize = 32;
const LEFT_OF_ROOM: usize = 8;
const LEFT_AT_LEAST: usize = 12;

/// Values nearer to each other than this, as a ratio, are as good as each other: bounds are within some per cent of the truth.
const NEAR: f64 = 1.01;

/// Once hardly anything is left of the budget, the value is at most so many times one that does not fit.
const PROMISED: f64 = 1.04;

/// The part of the budget that is aimed at, or of what undivided faces leave of it.
const AIM: f64 = 0.99;
const AIM_OF_ROOM: f64 = 0.9;

/// Results beyond the budget are counted up to so many more triangles (one in so many): then the next guess is better.
const COUNTED_BEYOND: usize = 2;

/// What has more triangles than could be counted has about so many times the budget.
const UNCOUNTED: f64 = 2.0;

/// Powers of the reciprocal of the value with which triangles grow.
const POWERS: (f64, f64) = (0.4, 3.0);

/// From one value to the next they fall by so many times at least, and at most.
const LEAST_APART: f64 = 1.1;
const MOST_APART: f64 = 16.0;

/// Of the ends between which is looked further a guess keeps away by this part of what lies between, as a logarithm.
const AWAY: f64 = 0.1;

/// What fails so many times over is as bad as any that has no number.
const COARSEST: f64 = 1e12;

/// Faces are divided evenly only where that takes all of the budget but for so many triangles (one in so many).
const NEARLY_ALL: usize = 16;

/// Values below what fits, as ratios, that are tried for small budgets.
const EVENER: [f64; 2] = [1.16, 1.08];

/// Budgets below this are spent to the last face.
const EXACT: usize = 20_000;

/// Results that are made to spend what is left.
const MOST_FILLS: usize = 6;

/// Faces on which that is spent come within a value that is less by this at least: a difference that takes triangles.
const FILLED_APART: f64 = 1.1;

/// A value, and how many triangles its result has.
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
    search.even_out()?;
    let Search {
        best, high, low, ..
    } = search;
    let less = low
        .map_or(0.0, |low| low.value)
        .min(high.value / FILLED_APART)
        .max(floor);
    let best = if most < EXACT && less > 0.0 {
        fill(engine, best, high.value, less, most)?
    } else {
        best
    };
    Ok((best, cap))
}

/// All faces divided evenly, as often as a budget allows, if that takes nearly all of it.
pub(super) fn even(engine: &Engine<'_>, most: usize) -> Result<Option<Verified>, RefineError> {
    let faces = engine.control.mesh.face_count();
    let levels = ((most / faces.max(1)).max(1).ilog2() / 2).min(engine.max_levels);
    if levels == 0 || faces << (2 * levels) < most - most / NEARLY_ALL {
        return Ok(None);
    }
    let goal = Goal::Within(f64::INFINITY);
    engine.verified(State::even(goal, faces, levels)?, most)
}

/// The narrowing of values to the least one that fits.
struct Search<'e, 'a> {
    engine: &'e Engine<'a>,
    most: usize,
    undivided: f64,
    floor: f64,
    /// The least value whose result fits, and that.
    high: Tried,
    best: Verified,
    /// The greatest value whose result does not.
    low: Option<Tried>,
    /// Below this no value makes a difference.
    least: f64,
    power: f64,
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
            COARSEST
        };
        let triangles = best.state.triangles as f64;
        let low = (floor > 0.0).then_some(Tried {
            value: floor,
            triangles: UNCOUNTED * most as f64,
        });
        let rounding = if has_criteria { 0.0 } else { engine.rounding };
        Ok(Self {
            engine,
            most,
            undivided: triangles,
            floor,
            high: Tried { value, triangles },
            best,
            low,
            least: rounding.max(f64::MIN_POSITIVE),
            power: 1.0,
        })
    }

    fn narrow(&mut self) -> Result<(), RefineError> {
        let room = self.most.saturating_sub(self.undivided as usize);
        let left = (self.most / LEFT)
            .min(room / LEFT_OF_ROOM)
            .max(LEFT_AT_LEAST);
        let enough = self.most.saturating_sub(left);
        let mut first = self.first()?;
        for _ in 0..MOST_TRIES {
            let is_full = self.best.state.triangles >= enough;
            let near = if is_full { PROMISED } else { NEAR };
            let is_near = self
                .low
                .is_some_and(|low| self.high.value <= low.value * near);
            if is_near || self.high.value <= self.least {
                return Ok(());
            }
            let value = first.take().unwrap_or_else(|| self.next());
            if !(value < self.high.value && self.low.is_none_or(|low| value > low.value)) {
                return Ok(());
            }
            let counted = self.most.saturating_add(self.most / COUNTED_BEYOND);
            let found = self.engine.refined(Goal::Within(value), counted)?;
            let known = found
                .as_ref()
                .map_or(UNCOUNTED * self.most as f64, |found| {
                    found.state.triangles as f64
                });
            let tried = Tried {
                value,
                triangles: known,
            };
            match found.filter(|found| found.state.triangles <= self.most) {
                Some(found) => (self.best, self.high) = (found, tried),
                None => self.low = Some(tried),
            }
        }
        Ok(())
    }

    /// Tries a little less than what does not fit: a finer division that is more even may have fewer triangles.
    fn even_out(&mut self) -> Result<(), RefineError> {
        for times in EVENER {
            let value = self.high.value / times;
            if self.most < EXACT
                && value > self.floor.max(self.least)
                && let Some(found) = self.engine.refined(Goal::Within(value), self.most)?
            {
                self.high = Tried {
                    value,
                    triangles: found.state.triangles as f64,
                };
                (self.best, self.low) = (found, self.low.filter(|low| low.value < value));
                return Ok(());
            }
        }
        Ok(())
    }

    /// The value that the heights of undivided faces let expect.
    fn first(&self) -> Result<Option<f64>, RefineError> {
        if self.engine.control.criteria.is_some() {
            return Ok(None);
        }
        let expected = heights::expected(self.engine, self.aim())?;
        Ok(expected.filter(|&value| {
            value < self.high.value && self.low.is_none_or(|low| value > low.value)
        }))
    }

    /// The value that is tried next.
    fn next(&mut self) -> f64 {
        let wanted = self.divided(self.aim());
        let high = self.high;
        let Some(low) = self.low else {
            let times = (wanted / self.divided(high.triangles)).powf(1.0 / self.power);
            return high.value / times.clamp(LEAST_APART, MOST_APART);
        };
        let (few, many) = (self.divided(high.triangles), self.divided(low.triangles));
        let span = (high.value / low.value).ln();
        self.power = ((many / few).ln() / span).clamp(POWERS.0, POWERS.1);
        let down = (wanted / few).ln() / (many / few).ln();
        let down = if down.is_finite() {
            down.clamp(AWAY, 1.0 - AWAY)
        } else {
            0.5
        };
        high.value * (-span * down).exp()
    }

    /// The number of triangles that is aimed at.
    fn aim(&self) -> f64 {
        let most = self.most as f64;
        (AIM * most).max(self.undivided + AIM_OF_ROOM * (most - self.undivided))
    }

    /// Triangles beyond those of undivided faces.
    fn divided(&self, triangles: f64) -> f64 {
        (triangles - self.undivided).max(1.0)
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
    for _ in 0..MOST_FILLS {
        if fits + 1 >= fails {
            break;
        }
        let middle = fits.midpoint(fails).max(fits + 1);
        let mut is_marked = vec![false; order.len()];
        order
            .iter()
            .take(middle)
            .for_each(|&(_, face)| is_marked[face as usize] = true);
        match engine.refined(Goal::Partly(value, less, is_marked), most)? {
            Some(found) => (best, fits) = (found, middle),
            None => fails = middle,
        }
    }
    Ok(best)
}
