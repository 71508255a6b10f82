//! The distance in the report of `limitmesh measure --certified`.

use limitmesh::measure::{Bounds, CertifiedHausdorff};
use serde::Serialize;

use super::whole::Whole;

/// Both directions, and the symmetric distance. Lengths are in the meshes' units.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct CertifiedReport {
    /// `certified interval`.
    pub(crate) kind: &'static str,
    /// The symmetric distance is at least this.
    pub(crate) lower: f64,
    /// The symmetric distance is at most this.
    pub(crate) upper: f64,
    /// In per cent of `diagonal`; null where that is 0.
    pub(crate) lower_percent: Option<f64>,
    /// In per cent of `diagonal`; null where that is 0.
    pub(crate) upper_percent: Option<f64>,
    /// Whether both intervals are as narrow as was asked for.
    pub(crate) converged: bool,
    /// Triangles and pieces of them looked at.
    pub(crate) work: u64,
    /// The length that is 100 per cent.
    pub(crate) diagonal: f64,
    /// Whose diagonal that is: `control mesh` or `second mesh`.
    pub(crate) diagonal_of: &'static str,
    /// From the surface to the reference.
    #[cfg_attr(test, schemars(with = "crate::tests::pages::schema::Bounds"))]
    pub(crate) forward: Bounds,
    /// From the reference to the surface.
    #[cfg_attr(test, schemars(with = "crate::tests::pages::schema::Bounds"))]
    pub(crate) backward: Bounds,
}

impl CertifiedReport {
    pub(crate) fn new(h: &CertifiedHausdorff, whole: Whole) -> Self {
        Self {
            kind: "certified interval",
            lower: h.lower(),
            upper: h.upper(),
            lower_percent: whole.percent(h.lower()),
            upper_percent: whole.percent(h.upper()),
            converged: h.converged(),
            work: h.work,
            diagonal: whole.diagonal,
            diagonal_of: whole.of,
            forward: h.forward,
            backward: h.backward,
        }
    }
}
