//! The report of `limitmesh refine --shared-topology`.

use serde::Serialize;

use super::refinement::{ErrorReport, ParametersReport};

/// The report of frames that have the same triangles.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FramesReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// In the order of the command line.
    pub(crate) frames: Vec<FrameReport>,
    /// The options.
    pub(crate) parameters: ParametersReport,
    /// Triangles of each frame.
    pub(crate) triangles: usize,
    /// Vertices of each frame.
    pub(crate) vertices: usize,
    /// Times that the most divided part of a control face was divided.
    pub(crate) levels: usize,
    /// `met` if the goals are met for all frames; else as `stop` of one mesh.
    pub(crate) stop: &'static str,
    /// The greatest distance that any camera sees in any frame, at most.
    pub(crate) pixels: Option<f64>,
    /// Triangles outside the angle, as many as there are in the worst frame.
    pub(crate) open_cones: Option<usize>,
    /// Bytes of the table that all frames were made with.
    pub(crate) table_bytes: usize,
    /// How long it took.
    pub(crate) seconds: FramesSeconds,
}

/// A refined frame.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FrameReport {
    /// The file that was read.
    pub(crate) input: String,
    /// The file that was written.
    pub(crate) output: String,
    /// How far the file and the limit surface of this frame are from each other.
    pub(crate) error: ErrorReport,
}

/// Seconds by the clock.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FramesSeconds {
    /// To refine all frames.
    pub(crate) refine: f64,
    /// To write all files.
    pub(crate) write: f64,
}
