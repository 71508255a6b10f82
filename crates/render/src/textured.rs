//! Surfaces with materials: a colour for each part, and perhaps a texture that lies on it.

use limitmesh::Triangles;

use crate::RenderError;
use crate::camera::Camera;
use crate::colour;
use crate::covering::Covering;
use crate::image::Image;
use crate::picture::{self, Paint};
use crate::style::Style;

/// Draws a surface with its materials; see [`render`](crate::render) for the rest.
///
/// ```
/// use limitmesh::Triangles;
/// use limitmesh_render::{Camera, Covering, Material, Style, Texture, ViewDirection, render_textured};
///
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 1, 2], [0, 2, 3]];
/// let surface = Triangles { positions: &positions, triangles: &triangles };
/// let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let checker = Material { colour: [1.0; 3], texture: Some(Texture::checker()) };
/// let covering = Covering { materials: &[checker], of_triangle: &[0, 0], corners: &corners };
/// let camera = Camera::fit(surface, ViewDirection::default(), 160, 120)?;
/// let image = render_textured(surface, None, &covering, &camera, &Style::default(), (160, 120))?;
/// assert_eq!(image.width(), 160);
/// # Ok::<(), limitmesh_render::RenderError>(())
/// ```
///
/// # Errors
/// As for [`render`](crate::render); counts that do not fit the surface, or texture coordinates that are not finite.
pub fn render_textured(
    surface: Triangles<'_>,
    normals: Option<&[[f64; 3]]>,
    covering: &Covering<'_>,
    camera: &Camera,
    style: &Style,
    (width, height): (u32, u32),
) -> Result<Image, RenderError> {
    covering.check(surface)?;
    let [outside, inside] = [style.surface_colour, style.back_colour].map(colour::linear);
    let paint = Paint::Materials {
        covering,
        outside,
        inside,
    };
    picture::draw(surface, normals, &paint, camera, style, width, height)
}
