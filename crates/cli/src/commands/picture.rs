//! Drawing a surface to a PNG file, for every command that does.

use std::path::Path;

use limitmesh::Triangles;
use limitmesh_render::{Camera, Covering, Style, ViewDirection, render, render_textured};

use crate::arguments::Size;
use crate::failure::usage;
use crate::format::counted;
use crate::output;
use crate::progress::Progress;

/// Size of pictures that are drawn along with other work.
pub(super) const SIZE: Size = Size {
    width: 1200,
    height: 900,
};

/// Refuses a name that is no PNG file's, before any work is done.
pub(super) fn check_name(path: &Path) -> anyhow::Result<()> {
    if output::is_standard_output(path) {
        return Ok(());
    }
    if is_png(path) {
        return output::check_writable(path);
    }
    usage(format!(
        "{}: pictures are PNG files; give a name that ends with .png",
        path.display()
    ))
}

/// Whether a file is called as PNG files are.
pub(super) fn is_png(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
}

/// The view of a picture: along a direction of sight, or from the front, a little from the side and above.
pub(super) fn view_direction(sight: Option<[f64; 3]>) -> ViewDirection {
    sight.map_or_else(ViewDirection::default, ViewDirection::along)
}

/// Says what a picture shows.
pub(super) fn drawn(path: &Path, triangles: usize) -> String {
    format!(
        "{}: {} drawn",
        path.display(),
        counted(triangles, "triangle", "triangles")
    )
}

/// Draws a surface, with its materials if it has some, and writes the picture.
pub(super) fn draw(
    path: &Path,
    surface: Triangles<'_>,
    normals: Option<&[[f64; 3]]>,
    covering: Option<&Covering<'_>>,
    view: ViewDirection,
    style: &Style,
    Size { width, height }: Size,
) -> anyhow::Result<()> {
    let camera = Camera::fit_tightly(surface, view, width, height)?;
    let image = match covering {
        Some(own) => render_textured(surface, normals, own, &camera, style, (width, height))?,
        None => render(surface, normals, None, &camera, style, width, height)?,
    };
    output::write_file(path, &image.encode_png()?)
}

/// Draws a surface with its edges, at the usual size, and says so.
pub(super) fn draw_edges(
    path: &Path,
    surface: Triangles<'_>,
    normals: &[[f64; 3]],
    sight: Option<[f64; 3]>,
    progress: &Progress,
) -> anyhow::Result<()> {
    progress.stage(format!("drawing {}", path.display()));
    let style = Style::default().wireframe(true);
    draw(
        path,
        surface,
        Some(normals),
        None,
        view_direction(sight),
        &style,
        SIZE,
    )?;
    progress.note(drawn(path, surface.triangles.len()));
    Ok(())
}
