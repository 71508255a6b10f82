//! Measures bounds anew that are far above the distance found.
//!
//! The proven bound of refinement adds up from bounds of each triangle against its own part of the
//! surface, as far as the neighbours leave room. Where triangles are small for another reason than
//! their distance, edges were collapsed or the surface is folded, the mesh can be much nearer to
//! the whole surface than that. Then it is measured against a mesh that is nearer still, within e
//! of the surface: a distance to that mesh and one to the surface differ by e at most (the triangle
//! inequality, in either direction).

use crate::math;
use crate::measure::{Bvh, certified_known};
use crate::mesh::{Mesh, Triangles};
use crate::progress::Observer;
use crate::refine::RefineError;
use crate::refine::adaptive::within;
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::{ErrorBounds, Exact};
use crate::scheme::Scheme;

/// The part of the distance that the nearer mesh may be off by: with less of it, that mesh has more triangles, with more the search has
/// less to end with.
const SHARE: f64 = 0.06;

/// The first nearer mesh has an error of this part of the existing bound, the next ones have errors
/// smaller by a constant factor: meshes that would be far too fine are not begun.
const FIRST: f64 = 1.0 / 32.0;
const FINER: f64 = 8.0;

/// Where that is too fine, this part is tried.
const COARSE: f64 = 1.0 / 8.0;

/// It is of use if the proven bound may get smaller than this part of itself.
const WORTH_WHILE: f64 = 0.8;

/// Points of found distances count where the distances are at least this many times the error.
const PLACED: f64 = 8.0;

/// The most triangles of the nearer mesh: this many in any case, and for each of the other one.
const IN_ANY_CASE: usize = 200_000;
const FOR_EACH: usize = 3;

/// If the only goal is a tolerance, which is proven already, at most this many triangles are
/// measured, against meshes so small that it takes about as long as the refinement.
const MET_MOST: usize = 20_000;
const MET_IN_ANY_CASE: usize = 5_000;
const MET_FOR_EACH: usize = 3;

/// Meshes that are [`FINER`] times nearer have at least this many times the triangles: the square
/// root of that where only rims are curved.
const GROWTH: f64 = 2.0;

/// Whether there may be tighter bounds for triangles that approximate the limit surface of
/// `control`.
pub(super) fn is_loose(error: &ErrorBounds, control: &Mesh) -> bool {
    let known = Known::new(*error, control);
    error.certified && known.distance().is_normal() && !known.is_tight()
}

/// The bounds of a surface of which some [regions](Exact::within_rims) are the planes inside their
/// rims, as tight as is worth the time.
pub(super) fn tighter(
    error: ErrorBounds,
    (surface, within_rims): (Triangles<'_>, &[u32]),
    (control, scheme): (&Mesh, &dyn Scheme),
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<ErrorBounds, RefineError> {
    if !is_loose(&error, control) {
        return Ok(error);
    }
    let mut known = Known::new(error, control);
    let count = surface.triangles.len();
    let is_proven = options
        .goals
        .tolerance
        .is_some_and(|most| error.upper <= most);
    let is_met = is_proven && options.goals.are_distances() && !options.is_collapsed();
    if is_met && count > MET_MOST {
        return Ok(error);
    }
    let room = options
        .triangles_by_memory()
        .map_or(usize::MAX, |most| most.saturating_sub(count));
    let most = if is_met {
        MET_IN_ANY_CASE + MET_FOR_EACH * count
    } else {
        IN_ANY_CASE + FOR_EACH * count
    };
    let most = most.min(room);
    // Bounds that are much too great, as on needles, would take a mesh that is far too fine.
    if error.upper.is_finite() && triangles_at(known.finest(), count, error.upper) > most as f64 {
        return Ok(error);
    }
    let tree = Bvh::new_observed(surface, observer)?;
    // Where there is no bound yet, one that is not tight is of no use.
    let is_bounded = error.upper.is_finite();
    let nearer = |near: f64, observer: &mut Observer<'_>| -> Result<Option<Exact>, RefineError> {
        let goals = ExactOptions::default()
            .unfold(!within_rims.is_empty())
            .origins(false)
            .tolerance(near);
        // Of use are few triangles to be made, not few to be left, and bounds that are met, not tight ones.
        let goals = ExactOptions {
            strips: false,
            tightens: false,
            ..goals
        };
        let found = within(control, scheme, &goals, most, observer)?;
        Ok(found.filter(|found| found.within_rims == within_rims && found.error.upper.is_finite()))
    };
    let coarse = if is_bounded {
        COARSE * error.upper
    } else {
        0.0
    };
    let mut near = (FIRST / COARSE * coarse).max(known.finest());
    let mut found = nearer(near, observer)?;
    let is_too_fine = found.is_none();
    // The distance to that mesh is off by as much, and it from the surface.
    let may_be_tighter = known.distance() + 2.0 * coarse < WORTH_WHILE * error.upper;
    if is_too_fine && near < coarse && may_be_tighter {
        near = coarse;
        found = nearer(near, observer)?;
    }
    while let Some(mesh) = found {
        let (count, off) = (mesh.mesh.face_count(), mesh.error.upper);
        let trees = [
            &tree,
            &Bvh::new_observed(mesh.mesh.as_triangles(), observer)?,
        ];
        // A search that is cut short would take longer with a finer mesh.
        let is_cut_short = !known.measure(trees, off, observer)?;
        if is_cut_short || is_too_fine || near <= known.finest() || known.is_tight() {
            break;
        }
        near = (near / FINER).max(known.finest());
        if triangles_at(near, count, off) > most as f64 {
            break;
        }
        found = nearer(near, observer)?;
    }
    Ok(if is_bounded || known.is_tight() {
        known.bounds
    } else {
        error
    })
}

/// The triangles that a mesh has at least to be so near, by those of one that is farther away.
fn triangles_at(near: f64, count: usize, far: f64) -> f64 {
    count as f64 * math::powf(GROWTH, math::log(far / near, FINER))
}

/// The known interval of a distance.
struct Known {
    bounds: ErrorBounds,
    /// Distances below count as that.
    least: f64,
}

impl Known {
    fn new(bounds: ErrorBounds, control: &Mesh) -> Self {
        Self {
            bounds,
            least: ErrorBounds::LEAST * control.diagonal(),
        }
    }

    /// The distance that was found.
    fn distance(&self) -> f64 {
        self.bounds.lower.max(self.least)
    }

    fn is_tight(&self) -> bool {
        self.bounds.upper <= ErrorBounds::TIGHT * self.distance()
    }

    /// The least useful error of a nearer mesh.
    fn finest(&self) -> f64 {
        SHARE * self.distance()
    }

    /// Measures the surface against one that is off by so much; `false` where that was cut short.
    fn measure(
        &mut self,
        trees: [&Bvh<'_>; 2],
        off: f64,
        observer: &mut Observer<'_>,
    ) -> Result<bool, RefineError> {
        let lower = self.bounds.lower;
        // The result is at most that much above the known bound, or above the distance.
        let gap = (ErrorBounds::TIGHT * self.distance() - lower - 2.0 * off).max(2.0 * off);
        let found = certified_known(trees, lower - off, gap, observer)?.widened(off);
        self.bounds.upper = self.bounds.upper.min(found.upper);
        if found.lower > lower.max(PLACED * off) {
            (self.bounds.lower, self.bounds.at) = (found.lower, found.at);
        }
        Ok(found.converged)
    }
}
