//! `limitmesh measure --limit-of --certified`: the distance between a mesh and a true limit surface, bounded from both
//! sides.
//!
//! Exact refinement of the control mesh stands for its limit surface. The distance to that mesh is certified, and as no
//! point of the one is farther from the other than exact refinement proves, the interval widened by that much holds the
//! distance to the limit surface (the triangle inequality, in either direction).

use limitmesh::measure::{Bvh, CertifiedHausdorff, CertifiedOptions, certified_hausdorff_between_observed};
use limitmesh::refine::{ExactOptions, ExactStop, exact_observed, is_certified};
use limitmesh::{Mesh, Triangles};

use crate::arguments::{ConcaveCorners, MeasureArguments};
use crate::failure::usage;
use crate::format::{counted, number};
use crate::progress::Progress;

/// What was found, and the mesh that stands for the limit surface.
pub(super) struct Certified {
    pub(super) measured: CertifiedHausdorff,
    pub(super) reference: Mesh,
    /// How far it is from the limit surface at most.
    pub(super) error: f64,
    /// Levels of its most divided part.
    pub(super) levels: usize,
    /// Its triangles, if there were to be more of them for the interval asked for.
    pub(super) capped: Option<usize>,
}

/// Share of the control mesh's diagonal that the first mesh may be off by: fine enough for most, and quickly there.
const FIRST_ERROR: f64 = 1e-3;

/// Without a gap, the interval is to be this share of the distance.
const USUAL_SHARE: f64 = 0.1;

/// Without a gap, an interval of this share of the diagonal is narrow enough.
const LEAST_SHARE: f64 = 1e-6;

/// As long as no distance is found that could not be the mesh's own error, that is divided by this: an eighth takes about
/// eight times the triangles, as many as all before together.
const STEP: f64 = 8.0;

/// Triangles of the mesh that stands for the limit surface: with its search tree, about two gigabytes.
const MOST_TRIANGLES: usize = 6_000_000;

/// Measures with finer and finer meshes until the interval is as narrow as asked for.
///
/// # Errors
/// Exact refinement proves nothing for the scheme, or a surface cannot be measured.
pub(super) fn measure(
    surface: Triangles<'_>,
    control: &Mesh,
    arguments: &MeasureArguments,
    progress: &Progress,
) -> anyhow::Result<Certified> {
    let scheme = arguments.scheme.unwrap_or_default().scheme();
    if !is_certified(scheme) {
        return usage(format!(
            "nothing is certain about limit surfaces of the scheme {}; without --certified any can be measured against",
            scheme.name()
        ));
    }
    let diagonal = control.diagonal();
    let asked = arguments.gap.map(|gap| gap.length(diagonal, arguments.build.unit)).transpose()?;
    let surface = Bvh::new(surface)?;
    let mut tolerance = asked.map_or(FIRST_ERROR * diagonal, |gap| (0.25 * gap).max(f64::MIN_POSITIVE));
    loop {
        progress.stage(format!("refining to within {} of the limit surface", number(tolerance)));
        let unfolds = arguments.features.concave_corners() == ConcaveCorners::Divided;
        let goals =
            ExactOptions::default().tolerance(tolerance).max_triangles(Some(MOST_TRIANGLES)).unfold(unfolds);
        let stands = exact_observed(control, scheme, &goals, &mut progress.observer())?;
        let triangles = stands.mesh.face_count();
        progress.stage(format!("measuring against {}", counted(triangles, "triangle", "triangles")));
        let mut observer = progress.observer();
        let tree = Bvh::new_observed(stands.mesh.as_triangles(), &mut observer)?;
        let options = search(asked, tolerance, arguments);
        let between = certified_hausdorff_between_observed(&surface, &tree, &options, &mut observer)?;
        let error = stands.error.upper;
        let mut measured = between.widened(error);
        let narrow = asked.unwrap_or_else(|| (USUAL_SHARE * measured.lower()).max(LEAST_SHARE * diagonal));
        for bounds in [&mut measured.forward, &mut measured.backward] {
            bounds.converged = bounds.upper - bounds.lower <= narrow;
        }
        let is_capped = stands.stop != ExactStop::Met;
        // A given gap has its one mesh; a search that was cut short would only take longer with a finer one.
        if measured.converged() || is_capped || asked.is_some() || !between.converged() {
            let capped = (is_capped && between.converged()).then_some(triangles);
            let (reference, levels) = (stands.mesh, stands.levels);
            return Ok(Certified { measured, reference, error, levels, capped });
        }
        tolerance =
            if measured.lower() > 0.0 { (0.2 * narrow).min(0.5 * tolerance) } else { tolerance / STEP };
    }
}

/// How narrow the search's own interval is to be: half of what is asked for, as the mesh's error of a quarter counts on
/// both sides.
fn search(asked: Option<f64>, tolerance: f64, arguments: &MeasureArguments) -> CertifiedOptions {
    let options = match asked {
        Some(gap) => CertifiedOptions::default().gap(Some(0.5 * gap)).relative_gap(0.0),
        None => CertifiedOptions::default().gap(Some(0.5 * tolerance)).relative_gap(0.25 * USUAL_SHARE),
    };
    match arguments.max_work {
        Some(work) => options.max_work(work),
        None => options,
    }
}
