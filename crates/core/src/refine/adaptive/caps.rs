//! One refinement, within its caps and budgets, also where flat regions keep more triangles than plans count; of balanced vertices and those
//! on the surface, where these may do with fewer triangles, the better.

use std::borrow::Cow;

use super::demands::Demands;
use super::flat::RimGaps;
use super::judge::Goal;
use super::{Engine, Task, budget};
use crate::mesh::Mesh;
use crate::progress::Observer;
use crate::refine::RefineError;
use crate::refine::exact_options::{ExactOptions, Finish};
use crate::refine::exact_result::{Exact, ExactStop};
use crate::scheme::Scheme;

/// Refines with some nodes divided in any case.
pub(super) fn once(task: Task<'_>, observer: &mut Observer<'_>) -> Result<Exact, RefineError> {
    let options = task.options;
    if !options.is_balanced() {
        return within_caps(task, observer);
    }
    let plain_options = options.clone().finish(Finish::OnSurface);
    let plain_task = Task {
        options: &plain_options,
        ..task
    };
    if options.goals.angle.is_some() && options.goals.triangles.is_none() {
        // Angles that vertices off the surface meet late, if at all, must not take more than those on it.
        let plain = within_caps(plain_task, observer)?;
        if matches!(plain.stop, ExactStop::Met | ExactStop::Cones) {
            let most = plain.mesh.face_count().min(options.budget().0);
            let found = balanced_within(task, most, observer)?;
            return Ok(match found {
                Some(found) => better(plain, found),
                None => plain,
            });
        }
        return Ok(better(plain, within_caps(task, observer)?));
    }
    let found = within_caps(task, observer)?;
    let count = found.mesh.face_count();
    if !may_do_with_fewer(plain_task, count, observer)? {
        return Ok(found);
    }
    // Of many triangles only those of meshes that are merged afterwards come so far.
    let is_known = found.stop == ExactStop::Met && is_soon_known(plain_task, count);
    if is_known && needs_more(plain_task, count, observer)? {
        return Ok(found);
    }
    Ok(better(within_caps(plain_task, observer)?, found))
}

/// The one of two meshes that meets the goals with fewer triangles, or comes nearer.
fn better(plain: Exact, balanced: Exact) -> Exact {
    let is_better = match (plain.stop, balanced.stop) {
        (ExactStop::Met, ExactStop::Met) | (ExactStop::Cones, ExactStop::Cones) => {
            plain.mesh.face_count() <= balanced.mesh.face_count()
        }
        (ExactStop::Met, _) => true,
        (_, ExactStop::Met) => false,
        _ => {
            plain.statistics.worst <= balanced.statistics.worst
                && plain.error.upper <= balanced.error.upper
        }
    };
    if is_better { plain } else { balanced }
}

/// Refines with balanced vertices until the goals are met; `None` where that takes more than so many triangles.
fn balanced_within(
    task: Task<'_>,
    most: usize,
    observer: &mut Observer<'_>,
) -> Result<Option<Exact>, RefineError> {
    task.with_engine(observer, |engine| {
        let (options, mut gaps) = (task.options, RimGaps::default());
        let goal = Goal::Balanced(engine.floor(options.goals.tolerance));
        let found = engine.refined(goal, most)?;
        found
            .map(|found| found.finish(engine, ExactStop::Met, options, &mut gaps))
            .transpose()
    })
}

/// Refines until a distance is met, with vertices on the surface; `None` where that takes more triangles than there may be, or where
/// flat regions cannot be triangulated from their rims.
pub(in crate::refine) fn within(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    most: usize,
    observer: &mut Observer<'_>,
) -> Result<Option<Exact>, RefineError> {
    let task = Task {
        mesh,
        scheme,
        options,
        demands: &Demands::default(),
    };
    task.with_engine(observer, |engine| {
        let mut gaps = RimGaps::default();
        let goal = Goal::Within(engine.floor(options.goals.tolerance));
        let found = engine.refined(goal, most)?;
        let found = found
            .map(|found| found.finish(engine, ExactStop::Met, options, &mut gaps))
            .transpose()?;
        Ok(found.filter(|_| gaps.are_none()))
    })
}

/// Whether vertices on the surface may do with fewer triangles than balanced ones: where flat regions are merged, which is done with these alone,
/// where normals decide, which moved vertices bring no nearer, and where guesses do. Of few triangles it takes little time to tell.
pub(super) fn may_do_with_fewer(
    plain: Task<'_>,
    count: usize,
    observer: &mut Observer<'_>,
) -> Result<bool, RefineError> {
    if is_soon_known(plain, count) {
        return Ok(true);
    }
    plain.with_engine(observer, |engine| {
        // Flat regions and strips of a sixteenth of the faces may make the plain mesh the smaller one.
        if 16 * engine.control.flat.merged_faces() >= plain.mesh.face_count() {
            return Ok(true);
        }
        let floor = engine.floor(plain.options.goals.tolerance);
        // Verifying only adds triangles.
        Ok(floor > 0.0 && engine.guessed(Goal::Within(floor), count)?.is_some())
    })
}

/// Whether it takes little to tell, or normals decide.
fn is_soon_known(plain: Task<'_>, count: usize) -> bool {
    // Balanced results of few triangles are compared with those of vertices on the surface.
    plain.options.goals.angle.is_some() || count < (2 * plain.mesh.face_count()).max(5_000)
}

/// Whether it certainly takes more triangles than this to meet a distance, or an angle: nothing is emitted to tell, and where triangles are
/// merged afterwards that is not known before.
fn needs_more(
    task: Task<'_>,
    count: usize,
    observer: &mut Observer<'_>,
) -> Result<bool, RefineError> {
    task.with_engine(observer, |engine| {
        let floor = engine.floor(task.options.goals.tolerance);
        let is_known = floor > 0.0 && engine.control.flat.merged_faces() == 0;
        Ok(is_known && engine.refined(Goal::Within(floor), count)?.is_none())
    })
}

/// Refines within caps and budgets.
fn within_caps(task: Task<'_>, observer: &mut Observer<'_>) -> Result<Exact, RefineError> {
    let (mesh, options) = (task.mesh, task.options);
    let most = options.budget().0.max(mesh.face_count());
    let mut room = most;
    for _ in 0..4 {
        let found = within_room(task, room, observer)?;
        let count = found.mesh.face_count();
        if !options.flat_regions || count <= most {
            return Ok(found);
        }
        // Flat regions whose rims cross, or that share edges, keep more triangles than were counted.
        let over = (1.5 * count.saturating_sub(room) as f64) as usize;
        // A quarter is left of the triangles beyond the control mesh's own that there was room for.
        let least = (0.25 * room.saturating_sub(mesh.face_count()) as f64) as usize;
        room = most.saturating_sub(over).max(mesh.face_count() + least);
    }
    let options = options.clone().flat_regions(false);
    let task = Task {
        options: &options,
        ..task
    };
    within_room(task, most, observer)
}

/// Refines with so many triangles at most, or more where flat regions keep some that were not counted.
fn within_room(
    task: Task<'_>,
    most: usize,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    let options = task.options;
    let (_, cap) = options.budget();
    without_gaps(task, most, observer, |engine, gaps| {
        let floor = engine.floor(options.goals.tolerance);
        if options.is_balanced()
            && floor > 0.0
            && let Some(found) = engine.refined(Goal::Balanced(floor), most)?
        {
            return found.finish(engine, ExactStop::Met, options, gaps);
        }
        let plain = &Engine {
            is_balanced: false,
            ..*engine
        };
        let (found, stop) = budget::search(plain, floor, most, cap)?;
        let mut found = found.finish(plain, stop, options, gaps)?;
        // Evenly curved models are best divided evenly, as long as about as much of that is proven.
        if floor == 0.0
            && let Some(even) = budget::even(plain, most)?
        {
            let even = even.finish(plain, stop, options, gaps)?;
            // An even division that is nearer is taken where its proven distance is at most a quarter greater.
            let is_proven = even.error.upper <= 1.25 * found.error.upper;
            if is_proven && even.error.lower < found.error.lower {
                found = even;
            }
        }
        if !options.is_balanced() {
            return Ok(found);
        }
        engine.least_balanced(found, floor, most, cap, options, gaps)
    })
}

impl Engine<'_> {
    /// The balanced mesh within the least value that has no more triangles than there may be; the plain one where that does
    /// no worse.
    fn least_balanced(
        &self,
        plain: Exact,
        floor: f64,
        most: usize,
        stop: ExactStop,
        options: &ExactOptions,
        gaps: &mut RimGaps,
    ) -> Result<Exact, RefineError> {
        let has_criteria = self.control.criteria.is_some();
        let mut high = if has_criteria {
            plain.statistics.worst
        } else {
            plain.error.upper
        };
        let (mut low, mut best) = (floor, None);
        // Values that are tried under a budget.
        for _ in 0..8 {
            // A balanced mesh has about 0.65 of a plain one's distance, at equal triangles.
            let next = (0.65 * high).max((low * high).sqrt());
            // Values within 2 % make no difference any more: the budget is spent but for some per cent.
            if !(low < next && next < high && low < 0.98 * high) {
                break;
            }
            match self.refined(Goal::Balanced(next), most)? {
                Some(found) => (best, high) = (Some(found), next),
                None => low = next,
            }
        }
        let Some(found) = best else {
            return Ok(plain);
        };
        let balanced = found.finish(self, stop, options, gaps)?;
        Ok(if balanced.error.upper < plain.error.upper {
            balanced
        } else {
            plain
        })
    }
}

/// Runs an engine until all flat regions that are judged by their rims can be triangulated from these: where they cannot, it is run again,
/// with rims that are divided further, or with regions that are judged by their triangles. There may be so many triangles.
pub(super) fn without_gaps<T>(
    task: Task<'_>,
    most: usize,
    observer: &mut Observer<'_>,
    run: impl Fn(&Engine<'_>, &mut RimGaps) -> Result<T, RefineError>,
) -> Result<T, RefineError> {
    let (mut demands, mut attempt) = (Cow::Borrowed(task.demands), 0);
    let room = most.saturating_sub(task.mesh.face_count());
    loop {
        let task = Task {
            demands: &demands,
            ..task
        };
        let (found, gaps) = task.with_engine(observer, |engine| {
            let mut gaps = RimGaps::default();
            let found = run(engine, &mut gaps)?;
            Ok((
                found,
                gaps.at_attempt(attempt, engine.control, engine.watch)?,
            ))
        })?;
        if gaps.are_none() {
            return Ok(found);
        }
        gaps.close(demands.to_mut(), attempt, room);
        attempt += 1;
    }
}
