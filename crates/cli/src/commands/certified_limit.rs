//! `limitmesh measure --limit-of --certified`: the distance between a mesh and a true limit surface, bounded from both
//! sides.

use limitmesh::measure::CertifiedHausdorff;
use limitmesh::refine::{LimitDistanceOptions, is_certified, limit_distance_observed};
use limitmesh::{Mesh, Triangles};

use crate::arguments::MeasureArguments;
use crate::failure::usage;
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

/// Measures with finer and finer meshes until the interval is as narrow as asked for; folded flat regions are what their rims enclose if the
/// surface unfolds.
///
/// # Errors
/// Exact refinement proves nothing for the scheme, or a surface cannot be measured.
pub(super) fn measure(
    surface: Triangles<'_>,
    (control, unfolds): (&Mesh, bool),
    arguments: &MeasureArguments,
    progress: &Progress,
) -> anyhow::Result<Certified> {
    let scheme = arguments.limit.scheme().scheme();
    if !is_certified(scheme) {
        return usage(format!(
            "nothing is certain about limit surfaces of the scheme {}; without --certified any can be measured against",
            scheme.name()
        ));
    }
    let gap = arguments
        .gap
        .map(|gap| gap.length(control.diagonal(), arguments.limit.build.unit))
        .transpose()?;
    let mut options = LimitDistanceOptions::default().gap(gap).unfold(unfolds);
    if let Some(work) = arguments.max_work {
        options = options.max_work(work);
    }
    let found =
        limit_distance_observed(surface, control, scheme, &options, &mut progress.observer())?;
    let capped = found.is_capped.then_some(found.reference.face_count());
    let (measured, reference) = (found.distance, found.reference);
    Ok(Certified {
        measured,
        reference,
        error: found.error,
        levels: found.levels,
        capped,
    })
}
