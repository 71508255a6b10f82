//! Symmetric Hausdorff distance by sampling (the paper's equations 14 to 16; Metro's sampling).
//!
//! Takes two surfaces; gives, for each direction, the greatest, mean and root-mean-square distance
//! of samples of one to the other, measured exactly, and the point of the greatest.

use core::ops::Range;

use super::bvh::Bvh;
use super::climb::climb;
use super::samples::Samples;
use super::{MeasureError, check_finite};
use crate::mesh::Triangles;
use crate::options;
use crate::parallel;
use crate::progress::{Cancelled, Observer, Stage, Watch, uncancelled, unobserved};
use crate::vector::{DVec3, vector};

options! {
    /// The density of samples.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct SamplingOptions {
        /// Number of samples on each surface, spread over vertices, sides and insides of triangles.
        /// All vertices are always taken and count; where they are nearly as many or more, a
        /// quarter of this number is still spread over the rest of the surface. At most
        /// [`Self::MOST_SAMPLES`] are used.
        pub samples: usize = 100_000,
    }
}

impl SamplingOptions {
    /// The most samples: each takes 8 bytes while it is measured, so that these take 2 gigabytes.
    pub const MOST_SAMPLES: usize = 1 << 28;
}

/// Sampled distance from one surface to another: a lower bound of the true maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct OneSided {
    /// Greatest distance found, at the samples and in a search around the farthest of them.
    pub max: f64,
    /// Mean over the surface: that of the samples inside triangles, each of which represents an
    /// equal area.
    pub mean: f64,
    /// Root mean square over the samples of [`Self::mean`].
    pub rms: f64,
    /// The distance that 95 % of the samples of [`Self::mean`] do not exceed.
    pub percentile_95: f64,
    /// Samples taken, vertices included. Points measured only in the search for the maximum do not count.
    pub samples: usize,
    /// The point at which the maximum was found.
    pub at: [f64; 3],
    /// The other surface's closest point to it.
    pub to: [f64; 3],
}

/// Both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hausdorff {
    /// From the first surface to the second.
    pub forward: OneSided,
    /// From the second surface to the first.
    pub backward: OneSided,
    /// Diagonal of the bounding box of the triangles of the second surface, the reference.
    pub reference_diagonal: f64,
}

impl Hausdorff {
    /// The symmetric distance, equation (16): the greater of both maxima.
    pub fn symmetric(&self) -> f64 {
        self.forward.max.max(self.backward.max)
    }

    /// The symmetric distance in per cent of the reference's bounding-box diagonal.
    pub fn symmetric_percent(&self) -> f64 {
        if self.reference_diagonal > 0.0 {
            100.0 * (self.symmetric() / self.reference_diagonal)
        } else {
            0.0
        }
    }
}

/// Samples that are measured one after the other on one thread, and summed together.
const RUN: usize = 1024;

/// Samples both surfaces and measures each against the other (equations 14 to 16).
///
/// The greatest distances are lower bounds: the surfaces are measured at samples, not everywhere.
/// The bytes of the result do not depend on the number of threads.
///
/// ```
/// use limitmesh_mesh::Triangles;
/// use limitmesh_mesh::measure::{SamplingOptions, hausdorff};
///
/// let square = |z| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let (below, above) = (square(0.0), square(0.25));
/// let triangles = [[0, 1, 2], [0, 2, 3]];
/// let distance = hausdorff(
///     Triangles { positions: &below, triangles: &triangles },
///     Triangles { positions: &above, triangles: &triangles },
///     &SamplingOptions::default().samples(1000),
/// )?;
/// assert!((distance.symmetric() - 0.25).abs() < 1e-12);
/// # Ok::<(), limitmesh_mesh::measure::MeasureError>(())
/// ```
///
/// # Errors
/// A surface without triangles, an index out of range, a coordinate that is not finite.
pub fn hausdorff(
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    options: &SamplingOptions,
) -> Result<Hausdorff, MeasureError> {
    hausdorff_observed(surface, reference, options, &mut unobserved)
}

/// [`hausdorff`] with an observer.
///
/// # Errors
/// Those of [`hausdorff`], or the observer asked to stop.
pub fn hausdorff_observed(
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    options: &SamplingOptions,
    observer: &mut Observer<'_>,
) -> Result<Hausdorff, MeasureError> {
    let surface = Bvh::named(surface, "measured", observer)?;
    let reference = Bvh::named(reference, "reference", observer)?;
    Ok(hausdorff_between_observed(
        &surface, &reference, options, observer,
    )?)
}

/// [`hausdorff`] between surfaces with given hierarchies, for measuring several against one.
pub fn hausdorff_between(
    surface: &Bvh<'_>,
    reference: &Bvh<'_>,
    options: &SamplingOptions,
) -> Hausdorff {
    uncancelled(|observer| hausdorff_between_observed(surface, reference, options, observer))
}

/// [`hausdorff_between`] with an observer.
///
/// # Errors
/// The observer asked to stop.
pub fn hausdorff_between_observed(
    surface: &Bvh<'_>,
    reference: &Bvh<'_>,
    options: &SamplingOptions,
    observer: &mut Observer<'_>,
) -> Result<Hausdorff, Cancelled> {
    let mut watch = Watch::new(observer, Stage::Sampling);
    Ok(Hausdorff {
        forward: one_sided(surface, reference, options, &mut watch)?,
        backward: one_sided(reference, surface, options, &mut watch)?,
        reference_diagonal: reference.diagonal(),
    })
}

/// Distances from samples of one surface to another.
fn one_sided(
    from: &Bvh<'_>,
    to: &Bvh<'_>,
    options: &SamplingOptions,
    watch: &mut Watch<'_>,
) -> Result<OneSided, Cancelled> {
    let samples = Samples::new(from, options.samples.min(SamplingOptions::MOST_SAMPLES));
    watch.triangles(from.surface().triangles.len());
    let collect = |range, run: &mut Vec<DVec3>| samples.visit(range, |point| run.push(point));
    let mut distances = measure_points(to, samples.len(), collect, watch)?;
    let (mut farthest, mut max) = (0, 0.0);
    for (index, &distance) in distances.iter().enumerate() {
        if distance > max {
            (farthest, max) = (index, distance);
        }
    }
    // A surface without area has no samples inside; its vertices and sides are then measured
    // instead.
    let insides = samples.insides();
    let over_the_surface = if insides.is_empty() {
        0..distances.len()
    } else {
        insides
    };
    let (mean, rms) = means(&distances[over_the_surface.clone()], max);
    let mut at = samples.point(farthest);
    let climbed = climb(&samples, &distances, from, to, watch)?;
    if let Some((point, distance)) = climbed.filter(|found| found.1 > max) {
        (at, max) = (point, distance);
    }
    let (at, samples) = (at.to_array(), distances.len());
    let percentile_95 = percentile_95(&mut distances[over_the_surface]);
    Ok(OneSided {
        max,
        mean,
        rms,
        percentile_95,
        samples,
        at,
        to: to.closest(at).point,
    })
}

/// The distances of `count` points to a surface; `collect` adds those of a range to a list. Consecutive ones should be
/// near each other.
fn measure_points(
    to: &Bvh<'_>,
    count: usize,
    collect: impl Fn(Range<usize>, &mut Vec<DVec3>) + Sync + Send,
    watch: &mut Watch<'_>,
) -> Result<Vec<f64>, Cancelled> {
    watch.stage(Stage::Sampling, Some(count))?;
    let mut distances = vec![0.0; count];
    let poll = &mut |done| watch.done(done);
    parallel::for_each_chunk_polled(&mut distances, RUN, poll, |run, distances| {
        let mut points = Vec::with_capacity(distances.len());
        collect(run * RUN..run * RUN + distances.len(), &mut points);
        to.distances(&points, distances);
    })?;
    Ok(distances)
}

/// Mean and root mean square of distances none of which exceeds `max`; divided by it first, so that no square
/// overflows or vanishes.
fn means(distances: &[f64], max: f64) -> (f64, f64) {
    if max == 0.0 || distances.is_empty() {
        return (0.0, 0.0);
    }
    let (mut sum, mut squares) = (0.0, 0.0);
    for run in distances.chunks(RUN) {
        let (mut run_sum, mut run_squares) = (0.0, 0.0);
        for &distance in run {
            let share = distance / max;
            run_sum += share;
            run_squares += share * share;
        }
        sum += run_sum;
        squares += run_squares;
    }
    let count = distances.len() as f64;
    (max * (sum / count), max * (squares / count).sqrt())
}

/// The least of some distances that 95 % of them do not exceed; 0 of none. Changes their order.
fn percentile_95(distances: &mut [f64]) -> f64 {
    let Some(last) = (95 * distances.len()).div_ceil(100).checked_sub(1) else {
        return 0.0;
    };
    *distances.select_nth_unstable_by(last, f64::total_cmp).1
}

/// The distance of each point to a surface, for heat maps.
///
/// # Errors
/// A reference without triangles, an index out of range, a coordinate that is not finite, the points' included.
pub fn distances_to(
    points: &[[f64; 3]],
    reference: Triangles<'_>,
) -> Result<Vec<f64>, MeasureError> {
    distances_to_observed(points, reference, &mut unobserved)
}

/// [`distances_to`] with an observer.
///
/// # Errors
/// Those of [`distances_to`], or the observer asked to stop.
pub fn distances_to_observed(
    points: &[[f64; 3]],
    reference: Triangles<'_>,
    observer: &mut Observer<'_>,
) -> Result<Vec<f64>, MeasureError> {
    let reference = Bvh::new_observed(reference, observer)?;
    check_finite(points, "measured")?;
    let collect = |range: Range<usize>, run: &mut Vec<DVec3>| {
        run.extend(points[range].iter().copied().map(vector))
    };
    let mut watch = Watch::new(observer, Stage::Sampling);
    watch.triangles(reference.surface().triangles.len());
    Ok(measure_points(
        &reference,
        points.len(),
        collect,
        &mut watch,
    )?)
}

#[cfg(test)]
mod tests;
