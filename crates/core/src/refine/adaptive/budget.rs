//! The greatest number of triangles that a budget allows: the least distance whose plan fits.
//!
//! Each distance has a plan of its own, the same that a tolerance would have, so that what is proven at a number of
//! triangles is what a tolerance proves with as many. The first distance is what some divided faces let expect ([`Profile`]); counts follow
//! that or a power of the distance ([`Growth`]), and the search narrows what is left. What a budget below [`EXACT`] leaves even then is spent
//! on the worst faces. Beside that stands the even division of all faces, which is nearer where these are curved alike.

mod expected;
mod leftovers;

use super::judge::Goal;
use super::{Engine, Plan};
use crate::certificate::exceeds;
use crate::mesh::MeshError;
use crate::refine::RefineError;
use crate::refine::exact_result::ExactStop;
use expected::Profile;
pub(super) use leftovers::even;
use leftovers::{EXACT, fill, finer};

/// From one plan to the next the triangles grow by this much at most while none has passed the budget.
const STEP: f64 = 6.0;

/// The part of the budget that may be left (one in so many).
const LEFT: usize = 32;

/// Fewer triangles than this may be left in any case.
const LEFT_AT_LEAST: usize = 12;

/// Distances nearer to each other than this, relative, are as good as each other: bounds are within some per cent of the truth.
const NEAR: f64 = 0.01;

/// Between distances nearer than that, as a logarithm, counts jump: the middle is as good as any guess.
const CLOSE: f64 = 0.03;

/// What fails so many times over is as bad as any that has no number.
const COARSEST: f64 = 1e12;

/// What is found is at most so many times a distance that does not fit.
const PROMISED: f64 = 1.1;

/// Distances this far from what was found, as ratios, tell how triangles grow there, ...
const TELLING: (f64, f64) = (1.02, 1.5);

/// ... and where they grow with this power at least, they do so a step of [`PROMISED`] further.
const STEADY: f64 = 0.5;

/// The part of the budget that a guess aims at: what is left then is enough.
const AIM: f64 = 0.993;

/// The part of the budget that the first plan aims at: it has a tenth less or some hundredths more.
const FIRST_AIM: f64 = 0.95;

/// From one guess to the next distances fall by this much at most.
const MOST_APART: f64 = 3.0;

/// Powers with which triangles grow, where two plans tell of one.
const POWERS: (f64, f64) = (0.4, 3.0);

/// After more plans in a row than these that brought nothing, distances fall ever faster.
const MOST_IDLE: u32 = 2;

/// Plans beyond the budget are counted to the end up to so many more triangles (one in so many): then the next guess is better.
const COUNTED_BEYOND: usize = 3;

/// After so many plans that did not halve what lies between the ends, as a logarithm, its middle is tried.
const MOST_STALLED: u32 = 2;

/// Of the ends between which is looked further, a guess keeps away by this much, as a logarithm, or by a twentieth of what lies between.
const LEAST_MOVED: f64 = 0.005;

/// What has more triangles than could be counted has about so many times the budget.
const UNCOUNTED: usize = 2;

/// Below so many triangles a face plans are looked at among their neighbours each time: there that adds most, and takes little.
const FEW: usize = 2;

/// After so many plans in a row that did not fit, while none has, undivided faces are looked at.
const MOST_BLIND: i32 = 3;

/// Distances that are tried below what was found where finer divisions may take fewer triangles: how many, and the ratio of one to the next.
const MOST_EVENER: usize = 10;
const EVENER: f64 = 0.93;

/// What flat regions and strips save is looked at where so many faces (one in so many) are part of them.
const WORTH_MERGING: usize = 16;

/// Faces on which that is spent come within a distance that is less by this at least: a difference that takes triangles.
const FILLED_APART: f64 = 1.03;

/// How many times as many triangles there are, about, once a plan was looked at among its neighbours, as long as none was: measured 1.00 to
/// 1.017, but up to 1.2 where few faces are divided.
const SETTLING: f64 = 1.006;

/// How triangles grow: those beyond the undivided faces with a power of the reciprocal of the distance.
struct Growth {
    undivided: f64,
}

impl Growth {
    fn divided(&self, triangles: f64) -> f64 {
        (triangles - self.undivided).max(0.02 * self.undivided)
    }

    /// The distance at which so many are wanted, where there are some at another.
    fn distance(&self, (from, triangles): (f64, usize), wanted: f64, power: f64) -> f64 {
        let times = self.divided(wanted) / self.divided(triangles as f64);
        from / times.powf(1.0 / power).clamp(1.0 / MOST_APART, MOST_APART)
    }

    /// The power between two distances with their triangles.
    fn power(&self, (coarse, few): (f64, usize), (fine, many): (f64, usize)) -> f64 {
        let times = self.divided(many as f64) / self.divided(few as f64);
        times.ln() / (coarse / fine).ln()
    }
}

/// The geometric mean, also where the product is too great for a number.
fn middle(low: f64, high: f64) -> f64 {
    let squared = low * high;
    if squared.is_finite() {
        squared.sqrt()
    } else {
        low.sqrt() * high.sqrt()
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
        && let Some(plan) = engine
            .without_counting_strips()
            .plan(Goal::Within(floor), most)?
    {
        return Ok((plan, ExactStop::Met));
    }
    let mut search = Search::new(engine, floor, most)?;
    search.narrow()?;
    let Search {
        mut high,
        mut low,
        best,
        least,
        ..
    } = search;
    let mut best = match best {
        Some(best) => best,
        None => coarsest(engine)?,
    };
    let over_strips = engine
        .control
        .flat
        .over_strips(|face| best.closed[face as usize].triangles as usize);
    if WORTH_MERGING * over_strips >= most {
        // A finer division that is more even may leave fewer triangles once strips are put together.
        let mut next = high;
        for _ in 0..MOST_EVENER {
            next *= EVENER;
            if next < floor.max(least) {
                break;
            }
            if let Some(plan) = finer(
                engine,
                &best,
                Goal::Within(next),
                &wanting(&best, next),
                most,
            )? {
                (best, high, low) = (plan, next, floor);
            }
        }
    }
    if most < EXACT && high > least && best.worst() > 0.0 {
        let less = if low > 0.0 {
            low.min(high / FILLED_APART)
        } else {
            high / PROMISED
        };
        best = fill(engine, best, (high, less.max(floor)), most)?;
    }
    Ok((best, cap))
}

/// The faces of a plan that come to more than a distance.
fn wanting(plan: &Plan, distance: f64) -> Vec<u32> {
    let faces = 0..plan.closed.len() as u32;
    faces
        .filter(|&face| exceeds(plan.expected(face), distance))
        .collect()
}

/// Undivided faces, which fit any budget.
fn coarsest(engine: &Engine<'_>) -> Result<Plan, RefineError> {
    let everything = engine.plan(Goal::Within(f64::INFINITY), usize::MAX)?;
    let broken = || MeshError::Broken {
        place: format!("{} control faces", engine.control.mesh.face_count()),
        what: "undivided faces fit any budget",
    };
    everything.ok_or_else(|| broken().into())
}

/// The narrowing of distances to the least one that fits.
struct Search<'e, 'a> {
    engine: &'e Engine<'a>,
    most: usize,
    /// So many triangles are enough.
    enough: usize,
    growth: Growth,
    /// What faces are expected to take; `None` where more than distances counts.
    profile: Option<Profile>,
    /// The least distance whose plan fits, as far as known, and that plan; `None` for undivided faces of which no plan was made.
    high: f64,
    best: Option<Plan>,
    /// Whether that was looked at among its neighbours.
    is_settled: bool,
    /// Whether all plans are: what that would add turned out to be too much to be looked at in the end.
    settles_all: bool,
    /// The greatest distance that does not fit; 0 where none is known.
    low: f64,
    /// Of distances below this nobody is any nearer.
    least: f64,
    /// What the last plans came to, before they were looked at among their neighbours: at [`Self::high`], and at [`Self::low`].
    fitting: usize,
    beyond: Option<usize>,
    /// The distances that fitted, with their triangles.
    before: Vec<(f64, usize)>,
    /// How many times as many triangles there are once they were looked at among their neighbours.
    settling: f64,
    /// Whether the last plan fitted, and how often in a row that was the same.
    fitted: bool,
    moved: i32,
    /// What lay between the ends, as a logarithm, when it was last halved, and the plans since then.
    span: f64,
    stalled: u32,
    /// Plans in a row that brought nothing: where levels end the division, no distance does.
    idle: u32,
}

impl<'e, 'a> Search<'e, 'a> {
    fn new(engine: &'e Engine<'a>, floor: f64, most: usize) -> Result<Self, RefineError> {
        let has_criteria = engine.control.criteria.is_some();
        // Of distances below what is added to all of them nobody is any nearer.
        let least = if has_criteria {
            f64::MIN_POSITIVE
        } else {
            engine.rounding.max(f64::MIN_POSITIVE)
        };
        Ok(Self {
            engine,
            most,
            enough: most - (most / LEFT).max(LEFT_AT_LEAST).min(most),
            growth: Growth {
                undivided: engine.control.mesh.face_count() as f64,
            },
            profile: if engine.is_settled_later() {
                None
            } else {
                Some(Profile::of(engine)?)
            },
            high: f64::INFINITY,
            is_settled: true,
            settles_all: most < FEW * engine.control.mesh.face_count(),
            low: floor,
            least,
            fitting: engine.control.mesh.face_count(),
            best: None,
            beyond: None,
            before: Vec::new(),
            settling: SETTLING,
            fitted: true,
            moved: 0,
            span: f64::INFINITY,
            stalled: 0,
            idle: 0,
        })
    }

    /// Undivided faces fit.
    fn begin_undivided(&mut self) -> Result<(), RefineError> {
        let plan = coarsest(self.engine)?;
        // Criteria may have no answer to undivided faces but that they are as bad as can be.
        let worst = plan.worst();
        let has_number = worst.is_finite() || self.engine.control.criteria.is_none();
        self.high = if has_number { worst } else { COARSEST };
        (self.fitting, self.growth.undivided) = (plan.triangles, plan.triangles as f64);
        (self.best, self.is_settled) = (Some(plan), true);
        Ok(())
    }

    /// What was thought to fit does not.
    fn give_up_best(&mut self) {
        (self.low, self.beyond) = (self.high, Some(self.fitting));
        // It has more than the budget once it is looked at among its neighbours.
        self.settling = self
            .settling
            .max(1.01 * self.most as f64 / self.fitting as f64);
        (self.high, self.best, self.is_settled) = (f64::INFINITY, None, true);
        (self.span, self.stalled, self.moved, self.fitted) = (f64::INFINITY, 0, 1, false);
        self.settles_all = true;
        self.before.clear();
    }

    /// Narrows until what fits is as fine as it may be.
    fn narrow(&mut self) -> Result<(), RefineError> {
        let engine = self.engine;
        let first = match (engine.guess, &mut self.profile) {
            (Some(guess), _) => Some(guess),
            (None, Some(profile)) => profile.expected(engine, FIRST_AIM * self.most as f64)?,
            (None, None) => None,
        };
        // What flat regions and strips come to only plans tell.
        let is_merged =
            WORTH_MERGING * engine.control.flat.merged_faces() >= engine.control.mesh.face_count();
        if first.is_none() || is_merged {
            self.begin_undivided()?;
        }
        if let Some(expected) =
            first.filter(|&expected| self.low < expected && expected < self.high)
        {
            self.try_within(expected)?;
        }
        loop {
            while !self.is_near() && self.high > self.least {
                if self.best.is_none() && self.moved > MOST_BLIND {
                    self.begin_undivided()?;
                    continue;
                }
                let next = self.next();
                if !(next < self.high && next > self.low) {
                    break;
                }
                self.try_within(next)?;
            }
            let Some(best) = self.best.as_mut().filter(|_| !self.is_settled) else {
                return Ok(());
            };
            if engine.settle(best, self.most)? {
                return Ok(());
            }
            self.give_up_best();
        }
    }

    /// The triangles of what was found.
    fn triangles(&self) -> usize {
        self.best.as_ref().map_or(0, |best| best.triangles)
    }

    /// Whether what was found is as fine as it may be.
    fn is_near(&self) -> bool {
        if self.triangles() < self.enough {
            return self.high <= self.low * (1.0 + NEAR);
        }
        self.high <= self.low * PROMISED || self.is_steady()
    }

    /// Whether triangles grow steadily around what was found, so that a distance [`PROMISED`] times as small has too many.
    fn is_steady(&self) -> bool {
        let known = (self.high, self.fitting);
        let beyond = self.beyond.map(|beyond| (self.low, beyond));
        self.before.iter().copied().chain(beyond).any(|tried| {
            let ratio = (tried.0 / self.high).max(self.high / tried.0);
            (TELLING.0..TELLING.1).contains(&ratio) && self.growth.power(known, tried) >= STEADY
        })
    }

    /// The distance that is tried next.
    fn next(&self) -> f64 {
        let (high, low) = (self.high, self.low);
        let has_enough = self.triangles() >= self.enough;
        if self.idle > MOST_IDLE && (low == 0.0 || has_enough) {
            return if low > 0.0 {
                middle(low, high)
            } else {
                high / MOST_APART.powi(1 << self.idle)
            };
        }
        if has_enough {
            // Where many triangles pass at once much less may take hardly more.
            return (high / PROMISED).max(low);
        }
        let aim = AIM * self.most as f64 / self.settling;
        if self.best.is_none() {
            let beyond = self.beyond.unwrap_or(self.most.saturating_mul(UNCOUNTED));
            let guess = self.guess((low, beyond), aim, None);
            return low * (guess / low).powi(self.moved.max(1)).max(1.0 + NEAR);
        }
        let known = (high, self.fitting);
        // Where faces are not divided yet nothing tells how triangles grow.
        let is_divided = |before: &&(f64, usize)| before.1 as f64 > self.growth.undivided;
        let before = self.before.last().filter(is_divided);
        let power = before
            .map(|&before| self.growth.power(before, known))
            .filter(|&power| power > 0.0);
        let power = power.map(|power| power.clamp(POWERS.0, POWERS.1));
        if low == 0.0 {
            let wanted = aim.min(STEP * self.triangles() as f64);
            return self.guess(known, wanted, power).min(high / (1.0 + NEAR));
        }
        let span = (high / low).ln();
        let Some(beyond) = self.beyond.filter(|_| span > CLOSE) else {
            return middle(low, high);
        };
        // Between two counts a power; but counts come in steps, so the middle where the same end was moved twice, or, where the ends are far
        // apart, further from what was moved each time.
        let is_apart = span > 2.0 * TELLING.1.ln();
        if self.stalled >= MOST_STALLED || !is_apart && self.moved > 2 {
            return middle(low, high);
        }
        let divided = |triangles: f64| self.growth.divided(triangles);
        let is_beyond_nearer =
            divided(beyond as f64) * divided(self.fitting as f64) < divided(aim).powi(2);
        let near = if is_beyond_nearer {
            (low, beyond)
        } else {
            known
        };
        let between = || {
            self.growth
                .power(known, (low, beyond))
                .clamp(POWERS.0, POWERS.1)
        };
        let guess = self.guess(near, aim, if is_apart { power } else { Some(between()) });
        let farther = if is_apart {
            (self.moved - 1).clamp(0, 3)
        } else {
            0
        };
        let guess = near.0 * (guess / near.0).powi(1 << farther);
        let edge = (0.05 * span).min(LEAST_MOVED).exp();
        guess.clamp(low * edge, high / edge)
    }

    /// The distance at which so many triangles are wanted, where there are some at another: by the power with which they grow, or by what faces
    /// are expected to take.
    fn guess(&self, known: (f64, usize), wanted: f64, power: Option<f64>) -> f64 {
        let told = || self.profile.as_ref()?.from(known, wanted);
        match power.map_or_else(told, |_| None) {
            Some(distance) => distance.clamp(known.0 / MOST_APART, known.0 * MOST_APART),
            None => self.growth.distance(known, wanted, power.unwrap_or(1.0)),
        }
    }

    /// Makes the plan of a distance, which becomes either end.
    fn try_within(&mut self, next: f64) -> Result<(), RefineError> {
        let (engine, most) = (self.engine, self.most);
        let counted = most.saturating_add(most / COUNTED_BEYOND);
        let goal = Goal::Within(next);
        let mut found = match &self.best {
            _ if engine.is_settled_later() => engine.plan(goal, counted)?,
            None => engine.divided(goal, counted)?,
            Some(best) => engine.finer(best, goal, &wanting(best, next), counted)?,
        };
        let count = found.as_ref().map(|plan| plan.triangles);
        let mut is_settled = engine.is_settled_later();
        let mut fits = count.is_some_and(|count| count <= most);
        let settled = self.settling * count.unwrap_or(most) as f64;
        // Those that leave more are not the last.
        let is_last = self.settles_all || settled >= self.enough as f64;
        if let Some(plan) = found.as_mut().filter(|_| fits && !is_settled && is_last) {
            fits = engine.settle(plan, counted)? && plan.triangles <= most;
            is_settled = true;
            self.settling = (plan.triangles as f64 / count.unwrap_or(most) as f64).max(1.0);
        }
        self.moved = if fits == self.fitted {
            self.moved + 1
        } else {
            1
        };
        self.fitted = fits;
        match (found, count) {
            (Some(plan), Some(count)) if fits => {
                self.idle = if plan.triangles > self.triangles() {
                    0
                } else {
                    self.idle + 1
                };
                self.before.push((self.high, self.fitting));
                (self.high, self.fitting, self.best, self.is_settled) =
                    (next, count, Some(plan), is_settled);
            }
            _ => {
                let count = count.unwrap_or(most.saturating_mul(UNCOUNTED));
                // All at once are more than the budget: whatever is near by will not do.
                self.moved += i32::from(self.beyond == Some(count));
                (self.low, self.beyond) = (next, Some(count));
            }
        }
        let span = (self.high / self.low).ln();
        let is_halved = span <= 0.5 * self.span || self.span.is_infinite();
        (self.span, self.stalled) = if is_halved {
            (span, 0)
        } else {
            (self.span, self.stalled + 1)
        };
        // What was found counts on adding less among its neighbours than this plan did.
        if let Some(best) = self
            .best
            .as_mut()
            .filter(|_| !fits && is_settled && !self.is_settled)
            && self.settling * best.triangles as f64 > most as f64
        {
            self.is_settled = engine.settle(best, most)?;
            if !self.is_settled {
                self.give_up_best();
            }
        }
        Ok(())
    }
}
