//! The report of `limitmesh refine --shared-topology`.

use serde::Serialize;

use super::refinement::{ErrorReport, ParametersReport};

/// All of it.
#[derive(Debug, Serialize)]
pub(crate) struct FramesReport {
    pub(crate) version: &'static str,
    /// In the order of the command line.
    pub(crate) frames: Vec<FrameReport>,
    pub(crate) parameters: ParametersReport,
    /// Of each frame.
    pub(crate) triangles: usize,
    pub(crate) vertices: usize,
    /// Times that the most divided part of a control face was divided.
    pub(crate) levels: usize,
    /// `met` if the goals are met for all frames.
    pub(crate) stop: &'static str,
    /// The greatest distance that any camera sees in any frame, at most.
    pub(crate) pixels: Option<f64>,
    /// Triangles outside the angle, as many as there are in the worst frame.
    pub(crate) open_cones: Option<usize>,
    /// Bytes of the table that all frames were made with.
    pub(crate) table_bytes: usize,
    pub(crate) seconds: FramesSeconds,
}

/// What became of a frame.
#[derive(Debug, Serialize)]
pub(crate) struct FrameReport {
    pub(crate) input: String,
    pub(crate) output: String,
    /// How far the file and the limit surface of this frame are from each other.
    pub(crate) error: ErrorReport,
}

/// Seconds by the clock.
#[derive(Debug, Serialize)]
pub(crate) struct FramesSeconds {
    pub(crate) refine: f64,
    pub(crate) write: f64,
}
