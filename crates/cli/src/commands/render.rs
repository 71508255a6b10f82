//! `limitmesh render`: a picture of a mesh.

use limitmesh_render::{Shading, Style};

use super::picture;
use crate::arguments::RenderArguments;
use crate::failure::Outcome;
use crate::format::counted;
use crate::input;
use crate::progress::Progress;

/// Reads a mesh and draws it.
pub(crate) fn run(arguments: &RenderArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    picture::check_name(&arguments.output)?;
    let mesh = input::load(&arguments.input, &arguments.build, progress)?.mesh;
    progress.stage(format!("drawing {}", counted(mesh.face_count(), "triangle", "triangles")));
    let shading = if arguments.flat { Shading::Flat } else { Shading::Smooth };
    let style = Style::default().shading(shading).wireframe(arguments.wireframe);
    let view = picture::view_direction(arguments.view);
    picture::draw(&arguments.output, mesh.as_triangles(), None, view, &style, arguments.size)?;
    let drawn = counted(mesh.face_count(), "triangle", "triangles");
    progress.note(format!("{}: {drawn} drawn", arguments.output.display()));
    Ok(Outcome::Done)
}
