//! The distance in the report of `limitmesh measure --certified`.

use limitmesh::measure::{Bounds, CertifiedHausdorff};
use serde::Serialize;

/// Both directions, and the symmetric distance. Lengths are in the meshes' units.
#[derive(Debug, Serialize)]
pub(crate) struct CertifiedReport {
    pub(crate) kind: &'static str,
    /// The symmetric distance is at least this.
    pub(crate) lower: f64,
    /// The symmetric distance is at most this.
    pub(crate) upper: f64,
    /// In per cent of `reference_diagonal`; null where that is 0.
    pub(crate) lower_percent: Option<f64>,
    pub(crate) upper_percent: Option<f64>,
    /// Whether both intervals are as narrow as was asked for.
    pub(crate) converged: bool,
    /// Triangles and pieces of them looked at.
    pub(crate) work: u64,
    pub(crate) reference_diagonal: f64,
    pub(crate) forward: BoundsReport,
    pub(crate) backward: BoundsReport,
}

/// One direction.
#[derive(Debug, Serialize)]
pub(crate) struct BoundsReport {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    pub(crate) converged: bool,
    /// The farthest point found.
    pub(crate) at: [f64; 3],
    /// The closest point of the other surface.
    pub(crate) to: [f64; 3],
}

impl From<&CertifiedHausdorff> for CertifiedReport {
    fn from(h: &CertifiedHausdorff) -> Self {
        let percent = |length: f64| {
            let percent = 100.0 * length / h.reference_diagonal;
            percent.is_finite().then_some(percent)
        };
        Self {
            kind: "certified interval",
            lower: h.lower(),
            upper: h.upper(),
            lower_percent: percent(h.lower()),
            upper_percent: percent(h.upper()),
            converged: h.converged(),
            work: h.work,
            reference_diagonal: h.reference_diagonal,
            forward: (&h.forward).into(),
            backward: (&h.backward).into(),
        }
    }
}

impl From<&Bounds> for BoundsReport {
    fn from(b: &Bounds) -> Self {
        Self { lower: b.lower, upper: b.upper, converged: b.converged, at: b.at, to: b.to }
    }
}
