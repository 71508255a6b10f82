//! The Hausdorff distance between two triangle meshes, bounded from both sides.
//!
//! Takes any two sets of triangles; gives for each direction a proven interval of the greatest
//! distance, and the place where its lower end is attained. Branch and bound: [`search`] keeps the
//! farthest point found and splits triangles until none of their pieces can be farther away by more
//! than the gap; [`piece`] and [`cover`] bound the distance of a piece from above.
//!
//! *Rounding.* Lower ends are distances of points by the hierarchy, less the errors of the search
//! and the points; upper ends never rest on a search, only on points that lie on the other surface,
//! and are increased by the errors of those. [`scale`] gives the errors: about 1.5e-11 of the
//! surface's size below, 4e-14 of the greatest coordinate above.
//!
//! *Rejected.* Steps and single triangles alone (Tang, Lee and Kim 2009; CGAL): where surfaces
//! nearly coincide a triangle must be split until its pieces are as small as the distance. Clipping
//! each triangle along the triangles of the other surface, piece by piece: as tight as the cover,
//! but a nearest point and a clip for every piece, where the cover needs one nearest point and
//! three scalar products a triangle.

mod between;
mod cover;
mod nearby;
mod piece;
mod scale;
mod search;
mod seen;
mod target;

use super::MeasureError;
use super::bvh::Bvh;
use crate::geometry::{NONE, for_each_edge};
use crate::mesh::Triangles;
use crate::options;
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::vector::vector;
pub(crate) use piece::Worker;
use scale::Scale;
use search::Search;
pub(crate) use target::Target;

options! {
    /// The requested width of the interval, and the most work.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct CertifiedOptions {
        /// An interval no wider than this is narrow enough, in the surfaces' unit. `None`, the
        /// default: a millionth of the diagonal of the reference's bounding box. Negative numbers
        /// and NaN count as 0, and values below the rounding error (about 1e-10 of the surfaces'
        /// size) as that.
        pub gap: Option<f64> = None,
        /// An interval is narrow enough if no wider than this share of the lower bound; 0.01 by
        /// default. Negative numbers and NaN count as 0.
        pub relative_gap: f64 = 0.01,
        /// Work after which the search ends in each direction, with the interval reached by then,
        /// which is wider than requested but as certain. A unit is a piece bounded, or a triangle
        /// or box of triangles tested for that; the default, 10⁹, is about half a minute on one
        /// thread. A first bound of every triangle is always made, and the search also ends where
        /// more than four million pieces wait to be split.
        pub max_work: u64 = 1_000_000_000,
    }
}

/// The greatest distance from one surface to the other lies in [`lower`, `upper`].
///
/// [`lower`]: Self::lower
/// [`upper`]: Self::upper
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Bounds {
    /// Some point, [`Self::at`], is at least this far away.
    pub lower: f64,
    /// No point is farther away.
    pub upper: f64,
    /// The farthest point found.
    pub at: [f64; 3],
    /// The other surface's closest point to it.
    pub to: [f64; 3],
    /// Whether the interval is as narrow as requested.
    pub converged: bool,
}

impl Bounds {
    /// The interval for a surface that approximates another within `error` in both directions:
    /// wider by `error` on both sides.
    ///
    /// The distances of two surfaces to a third differ by at most their own symmetric distance. Rounded outwards.
    pub fn widened(self, error: f64) -> Self {
        let lower = (self.lower - error).next_down().max(0.0);
        Self {
            lower,
            upper: (self.upper + error).next_up(),
            ..self
        }
    }
}

/// Both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CertifiedHausdorff {
    /// From the first surface to the second.
    pub forward: Bounds,
    /// From the second surface to the first.
    pub backward: Bounds,
    /// Diagonal of the bounding box of the triangles of the second surface, the reference.
    pub reference_diagonal: f64,
    /// Work done, in the units of [`CertifiedOptions::max_work`].
    pub work: u64,
}

impl CertifiedHausdorff {
    /// The symmetric distance is at least this.
    pub fn lower(&self) -> f64 {
        self.forward.lower.max(self.backward.lower)
    }

    /// The symmetric distance is at most this.
    pub fn upper(&self) -> f64 {
        self.forward.upper.max(self.backward.upper)
    }

    /// [`Bounds::widened`] in both directions.
    pub fn widened(self, error: f64) -> Self {
        Self {
            forward: self.forward.widened(error),
            backward: self.backward.widened(error),
            ..self
        }
    }

    /// Whether both intervals are as narrow as requested.
    pub fn converged(&self) -> bool {
        self.forward.converged && self.backward.converged
    }
}

/// Bounds the distance between two surfaces, in both directions and from both sides.
///
/// Any triangles will do: open, non-manifold, intersecting, without area. The search is fast where
/// the surfaces are near each other and the triangles of the one measured to are connected, as by
/// [`Mesh::from_soup`](crate::Mesh::from_soup). The bytes of the result do not depend on the number
/// of threads.
///
/// ```
/// use limitmesh_mesh::Triangles;
/// use limitmesh_mesh::measure::{CertifiedOptions, certified_hausdorff};
///
/// let square = |z| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let (below, above) = (square(0.0), square(0.25));
/// let triangles = [[0, 1, 2], [0, 2, 3]];
/// let distance = certified_hausdorff(
///     Triangles { positions: &below, triangles: &triangles },
///     Triangles { positions: &above, triangles: &triangles },
///     &CertifiedOptions::default(),
/// )?;
/// assert!(distance.lower() <= 0.25 && 0.25 <= distance.upper() && distance.upper() <= 0.2525);
/// # Ok::<(), limitmesh_mesh::measure::MeasureError>(())
/// ```
///
/// # Errors
/// A surface without triangles or with more than 2^32 / 3, an index out of range, a coordinate that is not finite or
/// beyond 1e300.
pub fn certified_hausdorff(
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    options: &CertifiedOptions,
) -> Result<CertifiedHausdorff, MeasureError> {
    certified_hausdorff_observed(surface, reference, options, &mut unobserved)
}

/// [`certified_hausdorff`] with an observer.
///
/// # Errors
/// Those of [`certified_hausdorff`], or the observer asked to stop.
pub fn certified_hausdorff_observed(
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    options: &CertifiedOptions,
    observer: &mut Observer<'_>,
) -> Result<CertifiedHausdorff, MeasureError> {
    let surface = Bvh::named(surface, "measured", observer)?;
    let reference = Bvh::named(reference, "reference", observer)?;
    certified_hausdorff_between_observed(&surface, &reference, options, observer)
}

/// [`certified_hausdorff`] between surfaces with given hierarchies, for measuring several against
/// one.
///
/// # Errors
/// A surface with more than 2^32 / 3 triangles or with a coordinate beyond 1e300.
pub fn certified_hausdorff_between(
    surface: &Bvh<'_>,
    reference: &Bvh<'_>,
    options: &CertifiedOptions,
) -> Result<CertifiedHausdorff, MeasureError> {
    certified_hausdorff_between_observed(surface, reference, options, &mut unobserved)
}

/// [`certified_hausdorff_between`] with an observer.
///
/// # Errors
/// Those of [`certified_hausdorff_between`], or the observer asked to stop.
pub fn certified_hausdorff_between_observed(
    surface: &Bvh<'_>,
    reference: &Bvh<'_>,
    options: &CertifiedOptions,
    observer: &mut Observer<'_>,
) -> Result<CertifiedHausdorff, MeasureError> {
    between([surface, reference], None, options, observer)
}

/// Bounds a symmetric distance with a known lower bound, to within `gap`: little time is spent
/// below it. Points are given where a greater distance was found.
#[doc(hidden)]
pub fn certified_known(
    trees: [&Bvh<'_>; 2],
    known: f64,
    gap: f64,
    observer: &mut Observer<'_>,
) -> Result<Bounds, MeasureError> {
    let measured = between(
        trees,
        Some(known.max(0.0)),
        &where_known(trees, gap),
        observer,
    )?;
    let CertifiedHausdorff {
        forward, backward, ..
    } = measured;
    let greater = if backward.lower > forward.lower {
        backward
    } else {
        forward
    };
    Ok(Bounds {
        upper: measured.upper(),
        converged: measured.converged(),
        ..greater
    })
}

/// Work of a search with something known, for each triangle of both surfaces: it usually ends after
/// some five.
const KNOWN_WORK: u64 = 20;

fn where_known(trees: [&Bvh<'_>; 2], gap: f64) -> CertifiedOptions {
    let count: usize = trees
        .iter()
        .map(|tree| tree.surface().triangles.len())
        .sum();
    CertifiedOptions {
        gap: Some(gap),
        relative_gap: 0.0,
        max_work: KNOWN_WORK * count as u64,
    }
}

/// Both directions; the known lower bound of the greater one counts for each.
fn between(
    [surface, reference]: [&Bvh<'_>; 2],
    known: Option<f64>,
    options: &CertifiedOptions,
    observer: &mut Observer<'_>,
) -> Result<CertifiedHausdorff, MeasureError> {
    let reference_diagonal = reference.diagonal();
    let gap = options.gap.unwrap_or(DEFAULT_GAP * reference_diagonal);
    let watch = &mut Watch::new(observer, Stage::Bounding);
    let (forward, forward_work) = one_way(
        [surface, reference],
        "reference",
        (gap, known),
        options,
        watch,
    )?;
    let known = known.map(|known| known.max(forward.lower));
    let (backward, backward_work) = one_way(
        [reference, surface],
        "measured",
        (gap, known),
        options,
        watch,
    )?;
    Ok(CertifiedHausdorff {
        forward,
        backward,
        reference_diagonal,
        work: forward_work + backward_work,
    })
}

/// One direction, to the surface that is called `which` in errors, and the work that it took.
fn one_way(
    [from, to]: [&Bvh<'_>; 2],
    which: &'static str,
    (gap, known): (f64, Option<f64>),
    options: &CertifiedOptions,
    watch: &mut Watch<'_>,
) -> Result<(Bounds, u64), MeasureError> {
    Ok(Search::run(
        from,
        &target(from, to, which, watch)?,
        (gap, known),
        options,
        watch,
    )?)
}

/// Share of the diagonal that a gap is by default.
const DEFAULT_GAP: f64 = 1e-6;

/// Coordinates up to here leave room for the length of a diagonal.
const GREATEST: f64 = 1e300;

/// The surface `to`, called `which` in errors, made ready for distances from `from`.
fn target<'s, 'a>(
    from: &Bvh<'_>,
    to: &'s Bvh<'a>,
    which: &'static str,
    watch: &mut Watch<'_>,
) -> Result<Target<'s, 'a>, MeasureError> {
    let magnitude = |bvh: &Bvh<'_>| {
        bvh.bounding_box()
            .as_flattened()
            .iter()
            .fold(0.0f64, |greatest, x| greatest.max(x.abs()))
    };
    let value = magnitude(to);
    if value > GREATEST {
        return Err(MeasureError::TooLarge {
            which,
            value,
            greatest: GREATEST,
        });
    }
    let [low, high] = to.bounding_box().map(vector);
    let scale = Scale::new(value.max(magnitude(from)), (high - low).max_element());
    let surface = to.surface();
    watch.stage(Stage::Matching, Some(surface.triangles.len()))?;
    if surface.triangles.len() > NONE as usize / 3 {
        return Err(MeasureError::TooMany {
            which,
            count: surface.triangles.len(),
        });
    }
    let mut twins = limitmesh_pages::filled(NONE, 3 * surface.triangles.len());
    for_each_edge(
        surface.triangles,
        surface.positions.len(),
        &mut |done| watch.done(done),
        |_, edge| {
            if let [a, b] = edge {
                (twins[a.side as usize], twins[b.side as usize]) = (b.side, a.side);
            }
        },
    )?;
    Ok(Target {
        bvh: to,
        twins,
        scale,
    })
}

#[cfg(test)]
mod tests;
