//! The report of `limitmesh compare`: a list with one of these for each method.

use serde::Serialize;

use super::measurement::LimitReport;
use super::whole::IntervalReport;

/// One method at its triangle count.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ComparedMethod {
    /// `limit-normal`, `amresh`, `uniform`, `uniform-limit`, `exact`, `exact-balance`, `exact-optimize`, `planarity`, `planarity-distance`,
    /// `vertex-error` or `sqrt3`.
    pub(crate) method: &'static str,
    /// The angle used; null for methods that have none.
    pub(crate) angle_degrees: Option<f64>,
    /// Steps done, or levels of the most divided part.
    pub(crate) levels: usize,
    /// Triangles of the method's mesh.
    pub(crate) triangles: usize,
    /// Symmetric Hausdorff distance to the limit surface, sampled: a lower bound, in the mesh's units.
    pub(crate) symmetric: f64,
    /// In per cent of the diagonal of the control mesh's bounding box.
    pub(crate) symmetric_percent: f64,
    /// Mean distance of the method's mesh to the limit surface, in the same per cent.
    pub(crate) mean_percent: f64,
    /// Root mean square of that distance, in the same per cent.
    pub(crate) rms_percent: f64,
    /// Bounds of the distance that are proven; null for methods that have none.
    pub(crate) certified: Option<IntervalReport>,
    /// Samples of both directions together.
    pub(crate) samples: usize,
    /// The least angle of a triangle.
    pub(crate) min_angle_degrees: f64,
    /// The mean of the triangles' least angles.
    pub(crate) mean_min_angle_degrees: f64,
    /// Wall-clock seconds of the refinement alone.
    pub(crate) seconds: f64,
    /// The mesh that approximates the limit surface; sqrt3 has its own.
    pub(crate) reference: LimitReport,
    /// Triangles of that mesh.
    pub(crate) reference_triangles: usize,
}
