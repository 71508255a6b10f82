//! The report on control points for a limit surface through the vertices.

use limitmesh::interpolate::{Interpolated, InterpolationMethod};
use serde::Serialize;

use super::whole::percent;

/// How control points came about.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct InterpolationReport {
    /// How near limits were to be to their vertices, in the mesh's unit.
    pub(crate) within: f64,
    /// `unchanged`, `conjugate-gradients`, `normal-equations` or `least-squares`.
    pub(crate) method: &'static str,
    /// Steps of conjugate gradients.
    pub(crate) iterations: usize,
    /// The greatest distance of a limit from its vertex, but for relaxed ones, which `relaxed` counts.
    pub(crate) residual: f64,
    /// Vertices that the surface misses: those next to much longer edges of sharp lines and boundaries, and those in regions that would fold.
    pub(crate) relaxed: usize,
    /// Regions of a part that would fold if the surface passed through all vertices.
    pub(crate) folded_regions: usize,
    /// The greatest distance of a control point from its vertex.
    pub(crate) displacement: f64,
    /// In per cent of the diagonal of the input's bounding box.
    pub(crate) displacement_percent: f64,
    /// The vertex whose control point that is.
    pub(crate) most_displaced: usize,
    /// The thin-plate energy, as a share of that of the surface through the vertices; null where limits are to be at their vertices.
    pub(crate) energy: Option<f64>,
    /// The least energy that is possible; null as `energy`.
    pub(crate) least_energy: Option<f64>,
}

impl InterpolationReport {
    pub(crate) fn new(
        found: &Interpolated,
        within: f64,
        diagonal: f64,
        folded_regions: usize,
    ) -> Self {
        Self {
            within,
            method: match found.method {
                InterpolationMethod::Unchanged => "unchanged",
                InterpolationMethod::ConjugateGradients => "conjugate-gradients",
                InterpolationMethod::NormalEquations => "normal-equations",
                InterpolationMethod::LeastSquares => "least-squares",
                _ => "other",
            },
            iterations: found.iterations,
            residual: found.residual,
            relaxed: found.relaxed.len(),
            folded_regions,
            displacement: found.displacement,
            displacement_percent: percent(found.displacement, diagonal.max(f64::MIN_POSITIVE)),
            most_displaced: found.most_displaced.index(),
            energy: found.fairness.map(|fairness| fairness.energy),
            least_energy: found.fairness.map(|fairness| fairness.least_energy),
        }
    }
}
