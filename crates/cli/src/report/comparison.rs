//! The report of `limitmesh compare`: a list with one of these for each method.

use serde::Serialize;

use super::measurement::LimitReport;

/// One method at its triangle count.
#[derive(Debug, Serialize)]
pub(crate) struct ComparedMethod {
    /// `limit-normal`, `amresh`, `uniform` or `uniform-limit`.
    pub(crate) method: &'static str,
    /// The angle used; null for uniform refinement.
    pub(crate) angle_degrees: Option<f64>,
    /// Steps done.
    pub(crate) levels: usize,
    pub(crate) triangles: usize,
    /// Symmetric Hausdorff distance to the limit surface, sampled: a lower bound, in the mesh's units.
    pub(crate) symmetric: f64,
    /// In per cent of the diagonal of the limit surface's bounding box.
    pub(crate) symmetric_percent: f64,
    /// Mean distance of the method's mesh to the limit surface, in the same per cent.
    pub(crate) mean_percent: f64,
    /// Root mean square of that distance, in the same per cent.
    pub(crate) rms_percent: f64,
    /// Samples of both directions together.
    pub(crate) samples: usize,
    pub(crate) min_angle_degrees: f64,
    pub(crate) mean_min_angle_degrees: f64,
    /// Wall-clock seconds of the refinement alone.
    pub(crate) seconds: f64,
    /// What stands for the limit surface.
    pub(crate) reference: LimitReport,
    pub(crate) reference_triangles: usize,
}
