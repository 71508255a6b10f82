//! The report of `limitmesh measure`.

use limitmesh::measure::{Hausdorff, OneSided};
use serde::Serialize;

use super::certified::CertifiedReport;
use super::diagnosis::DiagnosisReport;
use super::features::FeaturesReport;
use super::whole::Whole;
use crate::arguments::{LimitArguments, RefiningScheme};

/// The kind of a sampled distance, in every report of one.
pub(crate) const KIND: &str = "sampled lower bound";

/// How far two surfaces are from each other.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MeasureReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// The surface that is measured.
    pub(crate) surface: SurfaceReport,
    /// The surface that it is measured against.
    pub(crate) reference: SurfaceReport,
    /// The distance.
    pub(crate) hausdorff: DistanceReport,
    /// How long it took.
    pub(crate) seconds: MeasureSeconds,
}

/// The distance, by its kind.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub(crate) enum DistanceReport {
    Sampled(HausdorffReport),
    Certified(CertifiedReport),
}

/// One of the two surfaces.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SurfaceReport {
    /// As given on the command line.
    pub(crate) path: String,
    /// Its vertices.
    pub(crate) vertices: usize,
    /// Its triangles.
    pub(crate) triangles: usize,
    /// In squares of the mesh's unit; null where it is not known, as for limit surfaces of the butterfly scheme.
    pub(crate) area: Option<f64>,
    /// In cubes of the mesh's unit, above 0 where normals point outwards; null for open surfaces, and where it is not known.
    pub(crate) volume: Option<f64>,
    /// Findings and repairs.
    pub(crate) diagnosis: DiagnosisReport,
    /// How the surface approximates a limit surface; null where it is measured as it is.
    pub(crate) limit: Option<LimitReport>,
}

/// How a limit surface is represented.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LimitReport {
    /// The subdivision scheme.
    pub(crate) scheme: RefiningScheme,
    /// Levels of uniform refinement, all vertices moved to the limit; for certified distances, of the most divided part
    /// of exact refinement.
    pub(crate) levels: usize,
    /// Whether the program chose the number of levels.
    pub(crate) chosen: bool,
    /// How far the mesh that approximates the limit surface is from it at most; null where that is not proven.
    pub(crate) error: Option<f64>,
    #[serde(flatten)]
    pub(crate) features: FeaturesReport,
    /// How near it passes to the vertices of the control mesh; null where these are its control points.
    pub(crate) interpolate_within: Option<f64>,
}

impl LimitReport {
    /// Of the scheme that was asked for, and so many levels that the program chose, where lengths in per cent are of `diagonal`.
    ///
    /// # Errors
    /// A length has a unit, and the mesh's is not known.
    pub(crate) fn new(
        arguments: &LimitArguments,
        diagonal: f64,
        levels: usize,
    ) -> anyhow::Result<Self> {
        Ok(Self {
            scheme: arguments.scheme().into(),
            levels,
            chosen: true,
            error: None,
            features: (&arguments.features).into(),
            interpolate_within: arguments.within(diagonal)?,
        })
    }
}

/// The distances. Lengths are in the meshes' units.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct HausdorffReport {
    /// `sampled lower bound`.
    pub(crate) kind: &'static str,
    /// The greater of `forward` and `backward`.
    pub(crate) symmetric: f64,
    /// In per cent of `diagonal`; null where that is 0.
    pub(crate) symmetric_percent: Option<f64>,
    /// Greatest distance found from the surface to the reference.
    pub(crate) forward: f64,
    /// Greatest distance found from the reference to the surface.
    pub(crate) backward: f64,
    /// Samples of both directions together.
    pub(crate) samples: usize,
    /// The length that is 100 per cent.
    pub(crate) diagonal: f64,
    /// Whose diagonal that is: `control mesh` or `second mesh`.
    pub(crate) diagonal_of: &'static str,
    /// From the surface to the reference.
    #[cfg_attr(test, schemars(with = "crate::tests::pages::schema::OneSided"))]
    pub(crate) forward_detail: OneSided,
    /// From the reference to the surface.
    #[cfg_attr(test, schemars(with = "crate::tests::pages::schema::OneSided"))]
    pub(crate) backward_detail: OneSided,
}

impl HausdorffReport {
    pub(crate) fn new(h: &Hausdorff, whole: Whole) -> Self {
        Self {
            kind: KIND,
            symmetric: h.symmetric(),
            symmetric_percent: whole.percent(h.symmetric()),
            forward: h.forward.max,
            backward: h.backward.max,
            samples: h.forward.samples + h.backward.samples,
            diagonal: whole.diagonal,
            diagonal_of: whole.of,
            forward_detail: h.forward,
            backward_detail: h.backward,
        }
    }
}

/// Wall-clock seconds by phase.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MeasureSeconds {
    /// Reading and preparing both surfaces, the limit surface's refinement included.
    pub(crate) prepare: f64,
    /// Measuring.
    pub(crate) measure: f64,
}
