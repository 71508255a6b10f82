//! The report on the file that was read.

use serde::Serialize;

use super::channel::ChannelReport;
use crate::arguments::ChannelArguments;
use crate::input::Input;

/// The input.
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
    /// The contents of the file that were left out, in words.
    pub(crate) left_out: Vec<String>,
    /// Values of vertices, corners and faces.
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
