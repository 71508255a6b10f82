//! The distance between any triangles and a true limit surface, bounded from both sides.
//!
//! Exact refinement of the control mesh approximates its limit surface. The distance to that mesh
//! is certified, and widened by the proven error of the refinement the interval holds the distance
//! to the limit surface (the triangle inequality, in either direction): finer and finer meshes are
//! taken until it is narrow enough.

use super::{ExactOptions, ExactStop, RefineError, exact_observed, is_certified};
use crate::measure::{
    Bvh, CertifiedHausdorff, CertifiedOptions, certified_hausdorff_between_observed,
};
use crate::mesh::{Mesh, MeshError, Triangles};
use crate::options;
use crate::progress::{Observer, unobserved};
use crate::scheme::Scheme;

/// Share of the control mesh's diagonal that the first mesh may be off by: fine enough for most, and quickly there.
const FIRST_ERROR: f64 = 1e-3;

/// Without a gap, the interval is to be this share of the distance.
const USUAL_SHARE: f64 = 0.1;

/// Without a gap, an interval of this share of the diagonal is narrow enough.
const LEAST_SHARE: f64 = 1e-6;

/// As long as no distance is found that could not be the mesh's own error, that is divided by this:
/// an eighth takes about eight times the triangles, more than all before together.
const STEP: f64 = 8.0;

/// Triangles of the mesh that approximates the limit surface: with its search tree, about two
/// gigabytes.
const MOST_TRIANGLES: usize = 6_000_000;

options! {
    /// The requested width of the interval.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LimitDistanceOptions {
        /// An interval no wider than this is narrow enough, in the mesh's unit. `None`, the default: a tenth of the distance, or a
        /// millionth of the control mesh's diagonal.
        pub gap: Option<f64> = None,
        /// The limit [`CertifiedOptions::max_work`] for each mesh that approximates the limit
        /// surface.
        pub max_work: u64 = 1_000_000_000,
        /// See [`ExactOptions::unfold`].
        pub unfold: bool = false,
    }
}

/// A distance to a limit surface, and the mesh that approximates it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LimitDistance {
    /// The distance to the limit surface itself: the interval is widened by [`Self::error`].
    pub distance: CertifiedHausdorff,
    /// The mesh that approximates the limit surface.
    pub reference: Mesh,
    /// Its greatest distance from the limit surface.
    pub error: f64,
    /// The levels of its most divided part.
    pub levels: usize,
    /// Whether the mesh had to be finer, for the requested interval, than the cap on triangles
    /// allows.
    pub is_capped: bool,
}

/// Bounds the distance from a surface to the limit surface of a control mesh, and back.
///
/// ```
/// use limitmesh::Mesh;
/// use limitmesh::refine::{ExactOptions, LimitDistanceOptions, exact, limit_distance};
/// use limitmesh::scheme::Loop;
///
/// let soup = limitmesh_models::find("torus").expect("a built-in model").soup();
/// let (control, _) = Mesh::from_soup(&soup, &Default::default())?;
/// let refined = exact(&control, &Loop, &ExactOptions::default().tolerance(0.01))?;
/// let found = limit_distance(refined.mesh.as_triangles(), &control, &Loop, &LimitDistanceOptions::default())?;
/// assert!(found.distance.lower() <= 0.01 && found.distance.upper() >= refined.error.lower);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A scheme without proofs ([`is_certified`]), a gap that is negative or NaN, or a surface that
/// cannot be measured.
pub fn limit_distance(
    surface: Triangles<'_>,
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &LimitDistanceOptions,
) -> Result<LimitDistance, RefineError> {
    limit_distance_observed(surface, control, scheme, options, &mut unobserved)
}

/// [`limit_distance`], with an observer.
///
/// # Errors
/// Those of [`limit_distance`], or the observer asked to stop.
pub fn limit_distance_observed(
    surface: Triangles<'_>,
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &LimitDistanceOptions,
    observer: &mut Observer<'_>,
) -> Result<LimitDistance, RefineError> {
    if !is_certified(scheme) {
        let place = format!("scheme {}", scheme.name());
        return Err(MeshError::Broken {
            place,
            what: "distances are proven for the Loop family and Catmull–Clark only",
        }
        .into());
    }
    if let Some(value) = options.gap.filter(|gap| !(*gap >= 0.0 && gap.is_finite())) {
        return Err(MeshError::BadOption {
            name: "gap",
            value,
            expected: "a length of at least 0",
        }
        .into());
    }
    let diagonal = control.diagonal();
    let surface = Bvh::new_observed(surface, observer)?;
    let mut tolerance = options.gap.map_or(FIRST_ERROR * diagonal, |gap| {
        (0.25 * gap).max(f64::MIN_POSITIVE)
    });
    loop {
        let goals = ExactOptions::default()
            .tolerance(tolerance)
            .max_triangles(Some(MOST_TRIANGLES))
            .unfold(options.unfold)
            .origins(false);
        let goals = ExactOptions {
            tightens: false,
            ..goals
        };
        let stands = exact_observed(control, scheme, &goals, observer)?;
        let tree = Bvh::new_observed(stands.mesh.as_triangles(), observer)?;
        let search = search(options, tolerance);
        let between = certified_hausdorff_between_observed(&surface, &tree, &search, observer)?;
        let error = stands.error.upper;
        let mut distance = between.widened(error);
        let asked = options.gap;
        let narrow =
            asked.unwrap_or_else(|| (USUAL_SHARE * distance.lower()).max(LEAST_SHARE * diagonal));
        for bounds in [&mut distance.forward, &mut distance.backward] {
            bounds.converged = bounds.upper - bounds.lower <= narrow;
        }
        let was_capped = stands.stop != ExactStop::Met;
        // A given gap has its one mesh; a search that was cut short would only take longer with a finer one.
        if distance.converged() || was_capped || asked.is_some() || !between.converged() {
            let (reference, levels) = (stands.mesh, stands.statistics.levels);
            let is_capped = was_capped && between.converged();
            return Ok(LimitDistance {
                distance,
                reference,
                error,
                levels,
                is_capped,
            });
        }
        tolerance = if distance.lower() > 0.0 {
            (0.2 * narrow).min(0.5 * tolerance)
        } else {
            tolerance / STEP
        };
    }
}

/// How narrow the search's own interval is to be: half of the requested width, as the mesh's error
/// of a quarter counts on both sides.
fn search(options: &LimitDistanceOptions, tolerance: f64) -> CertifiedOptions {
    let search = match options.gap {
        Some(gap) => CertifiedOptions::default()
            .gap(Some(0.5 * gap))
            .relative_gap(0.0),
        None => CertifiedOptions::default()
            .gap(Some(0.5 * tolerance))
            .relative_gap(0.25 * USUAL_SHARE),
    };
    search.max_work(options.max_work)
}
