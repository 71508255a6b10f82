//! `limitmesh render`: a picture of a mesh.

use limitmesh::mesh::SplitSurface;
use limitmesh_render::{Shading, Style};

use super::covering::Cover;
use super::picture;
use crate::arguments::RenderArguments;
use crate::failure::Outcome;
use crate::format::counted;
use crate::input;
use crate::progress::Progress;

/// What pictures do without, or have by other ways.
const UNSEEN: [&str; 3] = ["normals", "tangents", "materials but for their names"];

/// Reads a mesh and draws it.
pub(crate) fn run(arguments: &RenderArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    picture::check_name(&arguments.output)?;
    let input = input::load_keeping(&arguments.input, &arguments.build, &UNSEEN, progress)?;
    let cover = Cover::of(&input, arguments.texture.as_deref())?;
    let mut mesh = input.mesh;
    if let Some(angle) = arguments.crease_angle {
        mesh = mesh.with_creases_above(angle.to_radians())?;
    }
    progress.stage(format!("drawing {}", counted(mesh.face_count(), "triangle", "triangles")));
    let shading = if arguments.flat { Shading::Flat } else { Shading::Smooth };
    let style = Style::default().shading(shading).wireframe(arguments.wireframe);
    let view = picture::view_direction(arguments.view);
    let split = (!arguments.flat).then(|| SplitSurface::by_faces(&mesh));
    let (surface, normals) = match &split {
        Some(split) => (split.as_triangles(), Some(&split.normals[..])),
        None => (mesh.as_triangles(), None),
    };
    match &cover {
        Some(cover) => {
            let covered = (surface, normals, &cover.covering());
            picture::draw_covered(&arguments.output, covered, view, &style, arguments.size)?;
        }
        None => picture::draw(&arguments.output, surface, normals, view, &style, arguments.size)?,
    }
    let drawn = counted(mesh.face_count(), "triangle", "triangles");
    progress.note(format!("{}: {drawn} drawn", arguments.output.display()));
    Ok(Outcome::Done)
}
