//! The JSON contract: what reports and `--json` output hold. Names of fields stay as they are once released;
//! all numbers are finite, angles in degrees, times in seconds.

pub(crate) mod certified;
mod channel;
mod comparison;
pub(crate) mod diagnosis;
mod evaluation;
mod frames;
pub(crate) mod information;
mod interpolation;
mod lod;
pub(crate) mod measurement;
pub(crate) mod projection;
pub(crate) mod refinement;
mod whole;

pub(crate) use certified::CertifiedReport;
pub(crate) use channel::ChannelReport;
pub(crate) use comparison::{CertifiedErrorReport, ComparedMethod};
pub(crate) use evaluation::EvaluationReport;
pub(crate) use frames::{FrameReport, FramesReport, FramesSeconds};
pub(crate) use information::{
    AssetInformation, InformationReport, MeshInformation, PackageInformation,
};
pub(crate) use interpolation::InterpolationReport;
pub(crate) use lod::{LevelReport, LodReport, MorphReport, PictureReport};
pub(crate) use measurement::{DistanceReport, LimitReport, MeasureReport, SurfaceReport};
pub(crate) use refinement::{
    AssetMeshReport, AssetReport, AttributeReport, CameraReport, ErrorReport, EstimateReport,
    ExactParametersReport, InputDistanceReport, MeshReport, MethodReport, OutputReport,
    ParametersReport, PredictionReport, RefineReport, RoundEntry, SecondsReport, SizeReport,
    StepEntry, ViewReport,
};
pub(crate) use whole::{Whole, percent};

use serde::Serialize;

use crate::arguments::ChannelArguments;
use crate::input::Input;

/// The program's version, in every report.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What was read.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct InputReport {
    /// As given on the command line.
    pub(crate) path: String,
    /// `obj`, `ply`, `stl`, `off`, `gltf`, `glb`, `3mf` or `builtin`.
    pub(crate) format: &'static str,
    /// Positions in the file.
    pub(crate) vertices: usize,
    /// Polygons in the file.
    pub(crate) faces: usize,
    /// What else the file held and was left out, in words.
    pub(crate) left_out: Vec<String>,
    /// What vertices, corners and faces carry.
    pub(crate) channels: Vec<ChannelReport>,
}

impl InputReport {
    /// Of what was read, with channels that are carried as options say.
    pub(crate) fn of(input: &Input, arguments: &ChannelArguments) -> Self {
        Self {
            path: input.name.clone(),
            format: input.format,
            vertices: input.diagnosis.input_vertices,
            faces: input.diagnosis.input_faces,
            left_out: input.left_out.clone(),
            channels: input
                .channels
                .iter()
                .map(|own| ChannelReport::chosen(own, arguments))
                .collect(),
        }
    }
}
