//! The input's values apart from its shape, on their way to the output: texture coordinates, colours, materials, groups.

use limitmesh::carry::carried;
use limitmesh::mesh::{Channel, FaceParts};
use limitmesh::refine::Traced;
use limitmesh::scheme::Scheme;
use limitmesh::{Mesh, Triangles};
use limitmesh_io::{
    Format, MaterialLibraries, Output, WriteOptions, holds, splits_vertices, values_lost,
};

use super::named_files::{self, Destination};
use crate::format::counted;
use crate::progress::Progress;

fn names(channels: &[Channel]) -> String {
    let names: Vec<&str> = channels
        .iter()
        .map(|channel| channel.name.as_str())
        .collect();
    names.join("; ")
}

/// The channels of a mesh, and the files that they lead to.
#[derive(Clone, Default)]
pub(super) struct Channels {
    channels: Vec<Channel>,
    /// That describe materials.
    material_libraries: Vec<String>,
    /// Pictures.
    texture_files: Vec<String>,
    /// The contents of these, and the files that they name.
    found: MaterialLibraries,
}

impl Channels {
    /// Those that reach the output; notes say which do not, and why.
    pub(super) fn of_input(
        channels: Vec<Channel>,
        [material_libraries, texture_files]: [Vec<String>; 2],
        to: &Destination<'_>,
        progress: &Progress,
    ) -> Self {
        let Some(format) = to.format else {
            return Self::default();
        };
        let is_dropped = |channel: &Channel| to.chosen.drops_channel(channel);
        let (dropped, channels): (Vec<Channel>, Vec<Channel>) =
            channels.into_iter().partition(is_dropped);
        if !dropped.is_empty() {
            progress.note(format!("left out: {} (by --channel)", names(&dropped)));
        }
        let options = WriteOptions::default().ascii(to.ascii);
        let reaches = |channel: &Channel| holds(format, &options, channel);
        let (kept, lost): (Vec<Channel>, Vec<Channel>) = channels.into_iter().partition(reaches);
        if !lost.is_empty() {
            progress.note(format!(
                "left out: {} (the output's format has no place for them)",
                names(&lost)
            ));
        }
        let found = named_files::find(&material_libraries, &texture_files, &kept, to, progress);
        if kept.is_empty() {
            return Self::default();
        }
        Self {
            channels: kept,
            material_libraries,
            texture_files,
            found,
        }
    }

    /// Those of a mesh of an asset.
    pub(super) fn of_asset(channels: Vec<Channel>) -> Self {
        Self {
            channels,
            ..Self::default()
        }
    }

    /// All of them.
    pub(super) fn all(&self) -> &[Channel] {
        &self.channels
    }

    /// Those of a mesh some of whose faces were divided.
    pub(super) fn on_parts(&mut self, parts: &FaceParts, mesh: &Mesh) {
        if !parts.is_empty() {
            self.channels
                .iter_mut()
                .for_each(|channel| *channel = channel.on_parts(parts, mesh));
        }
    }

    /// Whether one has other values in another place of a face.
    pub(super) fn vary_within_faces(&self) -> bool {
        self.channels.iter().any(Channel::varies_within_faces)
    }

    /// Those of the refined mesh.
    ///
    /// # Errors
    /// A channel has no limit.
    pub(super) fn refined(
        &self,
        control: &Mesh,
        found: &dyn Traced,
        scheme: &dyn Scheme,
    ) -> anyhow::Result<Self> {
        if self.channels.is_empty() {
            return Ok(Self::default());
        }
        let channels = carried(&self.channels, control, scheme, found)?;
        let Self {
            material_libraries,
            texture_files,
            found,
            ..
        } = self;
        Ok(Self {
            channels,
            material_libraries: material_libraries.clone(),
            texture_files: texture_files.clone(),
            found: found.clone(),
        })
    }

    /// Whether the output has vertices several times, for texture coordinates that differ there.
    pub(super) fn split_vertices(&self, format: Format, surface: Triangles<'_>) -> bool {
        let Triangles {
            positions,
            triangles,
        } = surface;
        format == Format::Ply && splits_vertices(&self.channels, triangles, positions.len())
    }

    /// A note on vertices with several values: that they are written several times, if [`Self::split_vertices`] says so, or of which
    /// channels one value is, and for how many.
    pub(super) fn note(
        &self,
        format: Format,
        surface: Triangles<'_>,
        splits: bool,
    ) -> Option<String> {
        if splits {
            let note = "vertices on seams of texture coordinates are written once for each side, as the input has them";
            return Some(note.to_owned());
        }
        let lost = |channel: &Channel| {
            let vertices = values_lost(format, channel, surface.triangles, surface.positions.len());
            (vertices > 0).then(|| {
                format!(
                    "{} at {}",
                    channel.name,
                    counted(vertices, "vertex", "vertices")
                )
            })
        };
        let lost: Vec<String> = self.channels.iter().filter_map(lost).collect();
        (!lost.is_empty()).then(|| format!("one of several values is written: {}", lost.join("; ")))
    }

    /// Adds them to what is written.
    pub(super) fn add_to<'a>(&'a self, output: Output<'a>) -> Output<'a> {
        let output = output
            .channels(&self.channels)
            .material_libraries(&self.material_libraries);
        output
            .texture_files(&self.texture_files)
            .materials(&self.found)
    }
}
