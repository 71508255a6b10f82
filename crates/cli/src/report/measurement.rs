//! The report of `limitmesh measure`.

use limitmesh::measure::{Hausdorff, OneSided};
use serde::Serialize;

use super::certified::CertifiedReport;
use super::diagnosis::DiagnosisReport;
use crate::arguments::{Boundary, SchemeName};

/// What a sampled distance is, in every report of one.
pub(crate) const KIND: &str = "sampled lower bound";

/// All of it.
#[derive(Debug, Serialize)]
pub(crate) struct MeasureReport {
    pub(crate) version: &'static str,
    pub(crate) surface: SurfaceReport,
    pub(crate) reference: SurfaceReport,
    pub(crate) hausdorff: DistanceReport,
    pub(crate) seconds: MeasureSeconds,
}

/// The distance, by its kind.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum DistanceReport {
    Sampled(HausdorffReport),
    Certified(CertifiedReport),
}

/// One of the two surfaces.
#[derive(Debug, Serialize)]
pub(crate) struct SurfaceReport {
    /// As given on the command line.
    pub(crate) path: String,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    pub(crate) diagnosis: DiagnosisReport,
    /// How the surface stands for a limit surface; null where it is measured as it is.
    pub(crate) limit: Option<LimitReport>,
}

/// How a limit surface is represented.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct LimitReport {
    pub(crate) scheme: SchemeName,
    /// Levels of uniform refinement, all vertices moved to the limit; for certified distances, of the most divided part
    /// of exact refinement.
    pub(crate) levels: usize,
    /// Whether the program chose the number of levels.
    pub(crate) chosen: bool,
    /// How far the mesh that stands for the limit surface is from it at most; null where that is not proven.
    pub(crate) error: Option<f64>,
    pub(crate) boundary: Boundary,
    pub(crate) crease_angle_degrees: Option<f64>,
}

/// The distances. Lengths are in the meshes' units.
#[derive(Debug, Serialize)]
pub(crate) struct HausdorffReport {
    pub(crate) kind: &'static str,
    /// The greater of `forward` and `backward`.
    pub(crate) symmetric: f64,
    /// In per cent of `reference_diagonal`; null where that is 0.
    pub(crate) symmetric_percent: Option<f64>,
    /// Greatest distance found from the surface to the reference.
    pub(crate) forward: f64,
    /// Greatest distance found from the reference to the surface.
    pub(crate) backward: f64,
    /// Samples of both directions together.
    pub(crate) samples: usize,
    pub(crate) reference_diagonal: f64,
    pub(crate) forward_detail: OneSidedReport,
    pub(crate) backward_detail: OneSidedReport,
}

impl From<&Hausdorff> for HausdorffReport {
    fn from(h: &Hausdorff) -> Self {
        Self {
            kind: KIND,
            symmetric: h.symmetric(),
            symmetric_percent: (h.reference_diagonal > 0.0).then(|| h.symmetric_percent()),
            forward: h.forward.max,
            backward: h.backward.max,
            samples: h.forward.samples + h.backward.samples,
            reference_diagonal: h.reference_diagonal,
            forward_detail: (&h.forward).into(),
            backward_detail: (&h.backward).into(),
        }
    }
}

/// One direction.
#[derive(Debug, Serialize)]
pub(crate) struct OneSidedReport {
    pub(crate) max: f64,
    pub(crate) mean: f64,
    pub(crate) rms: f64,
    pub(crate) samples: usize,
    /// The sample farthest away.
    pub(crate) at: [f64; 3],
    /// The closest point of the other surface.
    pub(crate) to: [f64; 3],
}

impl From<&OneSided> for OneSidedReport {
    fn from(o: &OneSided) -> Self {
        Self { max: o.max, mean: o.mean, rms: o.rms, samples: o.samples, at: o.at, to: o.to }
    }
}

/// Wall-clock seconds by phase.
#[derive(Debug, Serialize)]
pub(crate) struct MeasureSeconds {
    /// Reading and preparing both surfaces, the limit surface's refinement included.
    pub(crate) prepare: f64,
    pub(crate) measure: f64,
}
