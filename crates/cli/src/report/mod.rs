//! The JSON contract: what reports and `--json` output hold. Names of fields stay as they are once released;
//! all numbers are finite, angles in degrees, times in seconds.

pub(crate) mod certified;
mod channel;
mod comparison;
pub(crate) mod diagnosis;
mod evaluation;
mod features;
mod frames;
pub(crate) mod information;
mod input;
mod interpolation;
mod lod;
pub(crate) mod measurement;
pub(crate) mod projection;
mod quality;
pub(crate) mod refinement;
mod whole;

pub(crate) use certified::CertifiedReport;
pub(crate) use channel::ChannelReport;
pub(crate) use comparison::ComparedMethod;
pub(crate) use evaluation::EvaluationReport;
pub(crate) use frames::{FrameReport, FramesReport, FramesSeconds};
pub(crate) use information::{InformationReport, MeshInformation, PackageInformation};
pub(crate) use input::InputReport;
pub(crate) use interpolation::InterpolationReport;
pub(crate) use lod::{LevelReport, LodReport, MorphReport, PictureReport};
pub(crate) use measurement::{DistanceReport, LimitReport, MeasureReport, SurfaceReport};
pub(crate) use quality::QualityReport;
pub(crate) use refinement::{
    AssetMeshReport, AssetReport, AttributeReport, CameraReport, ErrorReport, EstimateReport,
    ExactParametersReport, MeshReport, MethodReport, OutputReport, ParametersReport,
    PredictionReport, RefineReport, RoundEntry, SecondsReport, SizeReport, StepEntry, ViewReport,
};
pub(crate) use whole::{IntervalReport, Whole, percent};

/// The program's version, in every report.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");
