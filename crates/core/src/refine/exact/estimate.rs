//! Predicts the size of an exact refinement from the growth of coarser ones.

use super::scale;
use crate::index::{FaceId, HalfEdgeId};
use crate::math;
use crate::mesh::{Mesh, Sharpness};
use crate::patch::submesh::submesh;
use crate::progress::{Observer, unobserved};
use crate::refine::exact_options::{BYTES_PER_TRIANGLE, Caps, ExactOptions, Finish, Goals};
use crate::refine::exact_result::Estimate;
use crate::refine::simplified::simplified;
use crate::refine::{RefineError, adaptive};
use crate::scheme::{Scheme, Support};

/// Goals are approached by halves from this many times too coarse, or more where they are far finer than [`COARSE_SHARE`] and the
/// like.
const COARSEST: f64 = 64.0;

/// A part of the diagonal, an angle in radians and a number of pixels as tolerances that take few triangles.
const COARSE_SHARE: f64 = 0.01;
const COARSE_ANGLE: f64 = 0.5;
const COARSE_PIXELS: f64 = 64.0;

/// The greatest power of two that goals are multiplied with.
const MOST_HALVINGS: f64 = 1000.0;

/// Triangles that are counted before the rest is extrapolated.
const COUNTED: usize = 60_000;

/// Of meshes with more faces than this about this many are sampled, at even steps through their
/// order: they are cut out with the faces around them.
const SAMPLED_FROM: usize = 20_000;
const SAMPLES: usize = 1000;

/// Triangles of a refinement, without collapses, that measures the share left by collapses: some
/// tenths of a second.
const COLLAPSED: usize = 15_000;

/// Halving a distance at most doubles the triangles in the long run, halving an angle makes them four times as many.
const MOST_GROWTH: f64 = 4.0;

/// Estimates the triangles and the memory of [`super::exact`] with these options.
///
/// Numbers of triangles follow a power of the tolerance once the triangles are small against the
/// surface's features; they are extrapolated from the last two halvings that could be counted
/// quickly. The share that collapses leave is measured at a tolerance that needs few; it hardly
/// depends on the tolerance. Of large meshes a sample of faces is used.
///
/// # Errors
/// Those of [`super::exact`].
pub fn exact_estimate(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
) -> Result<Estimate, RefineError> {
    exact_estimate_observed(control, scheme, options, &mut unobserved)
}

/// [`exact_estimate`], with an observer.
///
/// # Errors
/// Those of [`exact_estimate`], or the observer asked to stop.
pub fn exact_estimate_observed(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Estimate, RefineError> {
    options.check(control)?;
    if let Some((scaled, options, _)) = scale::scaled(control, options)? {
        return exact_estimate_observed(&scaled, scheme, &options, observer);
    }
    if let Some(tolerance) = options.goals.tolerance.filter(|_| options.is_collapsed()) {
        return optimised(control, scheme, options, tolerance, observer);
    }
    let of = |triangles: usize, is_counted| {
        let triangles = triangles.min(options.budget().0).max(control.face_count());
        Estimate {
            triangles,
            memory_bytes: triangles.saturating_mul(BYTES_PER_TRIANGLE),
            is_counted,
        }
    };
    if !options.goals.has_quality() {
        return Ok(of(options.budget().0, false));
    }
    let (faces, coarsest) = (control.face_count(), coarsest(control, options));
    if let Some(tolerance) = options
        .goals
        .tolerance
        .filter(|_| faces >= SAMPLED_FROM && is_distance_alone(options))
    {
        let step = faces / SAMPLES;
        let seeds: Vec<HalfEdgeId> = (step / 2..faces)
            .step_by(step)
            .map(|face| HalfEdgeId::of(FaceId(face as u32), 0))
            .collect();
        let rings = if scheme.support() == Support::OneRing {
            2
        } else {
            4
        };
        let around = submesh(control, &Sharpness::of(control), &seeds, rings);
        let weight = faces as f64 / seeds.len() as f64;
        let counted = (weight * COUNTED as f64) as usize;
        let found = approached(faces, coarsest, counted, of, |times| {
            let over = adaptive::count_over_first(
                &around,
                scheme,
                options,
                times * tolerance,
                seeds.len(),
                observer,
            )?;
            Ok((weight * over as f64) as usize)
        })?;
        return Ok(Estimate {
            is_counted: false,
            ..found
        });
    }
    approached(faces, coarsest, COUNTED, of, |times| {
        adaptive::count(control, scheme, options, times, observer)
    })
}

/// Whether each face takes triangles by how far they are from its surface and by nothing else.
fn is_distance_alone(options: &ExactOptions) -> bool {
    options.goals.are_distances() && !options.is_balanced() && options.kept_edges.is_empty()
}

/// The power of two that makes goals coarse enough to take few triangles.
fn coarsest(control: &Mesh, options: &ExactOptions) -> f64 {
    let goals = &options.goals;
    let goals = [
        (goals.tolerance, COARSE_SHARE * control.diagonal()),
        (goals.angle.map(|goal| goal.radians), COARSE_ANGLE),
        (goals.pixels.as_ref().map(|goal| goal.pixels), COARSE_PIXELS),
    ];
    let times = goals
        .into_iter()
        .filter_map(|(goal, coarse)| Some(coarse / goal?))
        .fold(COARSEST, f64::max);
    math::exp2(math::log2(times).ceil().min(MOST_HALVINGS))
}

/// The estimate where edges are collapsed.
fn optimised(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    tolerance: f64,
    observer: &mut Observer<'_>,
) -> Result<Estimate, RefineError> {
    let free = ExactOptions {
        goals: Goals {
            triangles: None,
            ..options.goals.clone()
        },
        caps: Caps {
            triangles: None,
            ..options.caps
        },
        ..options.clone()
    };
    let plain = ExactOptions {
        finish: Finish::OnSurface,
        ..free.clone()
    };
    let mut times = coarsest(control, options);
    let mut before = adaptive::count(control, scheme, &plain, times, observer)?;
    while times > 1.0 && 2 * before <= COLLAPSED {
        times /= 2.0;
        before = adaptive::count(control, scheme, &plain, times, observer)?;
    }
    let left = simplified(
        control,
        scheme,
        &free.tolerance(times * tolerance),
        observer,
    )?
    .mesh
    .face_count();
    let is_counted = times == 1.0;
    let whole = match is_counted {
        true => before,
        false => exact_estimate_observed(control, scheme, &plain, observer)?.triangles,
    };
    let triangles = (whole as f64 * left as f64 / before.max(1) as f64).round() as usize;
    let triangles = triangles.min(options.budget().0);
    Ok(Estimate {
        triangles,
        memory_bytes: triangles.saturating_mul(BYTES_PER_TRIANGLE),
        is_counted,
    })
}

/// Counts triangles for goals that are too coarse by a factor until they are many or the goals the
/// right ones.
fn approached(
    faces: usize,
    coarsest: f64,
    counted: usize,
    of: impl Fn(usize, bool) -> Estimate,
    mut count: impl FnMut(f64) -> Result<usize, RefineError>,
) -> Result<Estimate, RefineError> {
    let (mut times, mut before, mut halvings) = (coarsest, faces, 1.0);
    loop {
        let triangles = count(times)?;
        if times == 1.0 {
            return Ok(of(triangles, true));
        }
        if triangles > counted && triangles > before {
            let growth =
                math::powf(triangles as f64 / before as f64, 1.0 / halvings).min(MOST_GROWTH);
            return Ok(of(
                (triangles as f64 * math::powf(growth, math::log2(times))) as usize,
                false,
            ));
        }
        // As many as surely leave few enough, so that hardly anything is counted twice.
        let most = math::log(counted as f64 / triangles.max(1) as f64, MOST_GROWTH).floor();
        halvings = most.clamp(1.0, math::log2(times));
        (times, before) = (times / math::exp2(halvings), triangles);
    }
}
