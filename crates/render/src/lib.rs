//! Pictures of triangle meshes without a GPU: a camera, a rasteriser with anti-aliasing, smooth and flat
//! shading, wireframes, and PNG.
//!
//! Takes [`limitmesh::Triangles`] and gives an [`Image`]. Everything is computed on the CPU in the same order
//! whatever the number of threads, so a picture is the same bytes on every run.
//!
//! ```
//! use limitmesh::Triangles;
//! use limitmesh_render::{Camera, Style, ViewDirection, render};
//!
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
//! let surface = Triangles { positions: &positions, triangles: &triangles };
//! let camera = Camera::fit(surface, ViewDirection::default(), 160, 120)?;
//! let style = Style::default().wireframe(true);
//! let image = render(surface, None, None, &camera, &style, 160, 120)?;
//! let png: Vec<u8> = image.encode_png()?;
//! # Ok::<(), limitmesh_render::RenderError>(())
//! ```

mod camera;
mod colour;
mod error;
mod image;
mod parallel;
mod picture;
mod project;
mod raster;
mod shade;
mod style;
mod wire;

pub use camera::{Camera, ViewDirection};
pub use error::RenderError;
pub use image::Image;
pub use picture::{MAX_SIDE, render};
pub use style::{Lighting, Shading, Style};
