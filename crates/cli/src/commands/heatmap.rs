//! Heat maps of `limitmesh measure`: a surface coloured by its distance to the reference, as a mesh or a picture.

use std::path::Path;

use limitmesh::Triangles;
use limitmesh::measure::distances_to_observed;
use limitmesh_io::{Format, Output, WriteOptions};
use limitmesh_render::{
    Camera, ColourBar, Lighting, Scale, Shading, Style, ViewDirection, dice, render_scalar,
};

use super::picture::{self, SIZE};
use crate::arguments::Size;
use crate::failure::usage;
use crate::output;
use crate::progress::Progress;
use crate::report::Whole;

/// A picture is drawn from about so many triangles: enough that one is a few pixels large.
const PICTURE_TRIANGLES: usize = 300_000;

/// Into at most so many parts is a side cut: beyond, a triangle would fill the picture's pixels many times over.
const MOST_PARTS: usize = 64;

/// Refuses a name that is neither a PLY nor a PNG file's, before any work is done.
pub(super) fn check_name(path: &Path) -> anyhow::Result<()> {
    if picture::is_png(path) || matches!(Format::from_path(path), Ok(Format::Ply)) {
        return output::check_writable(path);
    }
    usage(format!(
        "{}: a heat map is a .ply or a .png file",
        path.display()
    ))
}

/// Writes the surface coloured by its distance to the reference.
pub(super) fn write(
    path: &Path,
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    whole: Whole,
    progress: &Progress,
) -> anyhow::Result<()> {
    if picture::is_png(path) {
        draw(path, surface, reference, whole, progress)
    } else {
        write_mesh(path, surface, reference, progress)
    }
}

/// A mesh with a colour and a distance at each vertex.
fn write_mesh(
    path: &Path,
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    progress: &Progress,
) -> anyhow::Result<()> {
    let distances = distances_to_observed(surface.positions, reference, &mut progress.observer())?;
    let scale = scale(&distances);
    let colours: Vec<[u8; 3]> = distances
        .iter()
        .map(|&distance| scale.colour(distance))
        .collect();
    let output = Output::new(surface).quality(&distances).colours(&colours);
    output::write_mesh(path, Format::Ply, &output, &WriteOptions::default())
}

/// A picture with a colour bar. Distances inside of triangles show too: large ones are cut up, flat as they are.
fn draw(
    path: &Path,
    surface: Triangles<'_>,
    reference: Triangles<'_>,
    whole: Whole,
    progress: &Progress,
) -> anyhow::Result<()> {
    let (positions, triangles) = dice(surface, parts(surface.triangles.len()));
    let cut = Triangles {
        positions: &positions,
        triangles: &triangles,
    };
    let mut distances = distances_to_observed(&positions, reference, &mut progress.observer())?;
    let per_length = whole.percent(1.0);
    if let Some(percent) = per_length {
        distances
            .iter_mut()
            .for_each(|distance| *distance *= percent);
    }
    let unit = per_length.map_or_else(String::new, |_| format!("% of the {}'s diagonal", whole.of));
    draw_values(path, cut, &distances, scale(&distances), "distance", &unit)
}

/// A picture of values at the vertices, with a colour bar that says what they are.
pub(super) fn draw_values(
    path: &Path,
    surface: Triangles<'_>,
    values: &[f64],
    scale: Scale,
    title: &str,
    unit: &str,
) -> anyhow::Result<()> {
    let Size { width, height } = SIZE;
    let style = Style::default()
        .shading(Shading::Flat)
        .lighting(Lighting::even());
    let camera = Camera::fit_tightly(surface, ViewDirection::default(), width, height)?;
    let image = render_scalar(
        surface,
        None,
        values,
        &scale,
        &camera,
        &style,
        (width, height),
    )?;
    let bar = ColourBar::new(scale).title(title).unit(unit);
    output::write_file(path, &bar.beside(&image, style.background)?.encode_png()?)
}

/// From 0 to the greatest distance.
fn scale(distances: &[f64]) -> Scale {
    Scale::new(0.0, distances.iter().copied().fold(0.0, f64::max))
}

/// Into how many parts each side is cut.
fn parts(triangles: usize) -> usize {
    (PICTURE_TRIANGLES / triangles.max(1))
        .isqrt()
        .clamp(1, MOST_PARTS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_triangles_are_not_cut() {
        assert_eq!(parts(1_000_000), 1);
        assert_eq!(parts(300), 31);
        assert_eq!(parts(1), MOST_PARTS);
        assert_eq!(parts(0), MOST_PARTS);
    }
}
