//! Pictures of triangle meshes without a GPU: a camera, a rasteriser with anti-aliasing, smooth and flat
//! shading, wireframes, heat maps, text, PNG; and plots and drawings as SVG.
//!
//! [`render`], [`render_scalar`] and [`render_textured`] take [`limitmesh::Triangles`] and give an [`Image`], [`render_exact`] does so from
//! rays to a limit surface; [`grid`] and
//! [`ColourBar`] compose images into figures; [`plot`] and [`svg`] write vector graphics. Everything is computed on the CPU in the same order
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
mod check;
mod colour;
mod colour_map;
mod compose;
mod covering;
mod dice;
mod error;
mod exact;
mod heat_map;
mod image;
mod parallel;
mod picture;
pub mod plot;
mod project;
mod raster;
mod scale;
mod shade;
mod style;
pub mod svg;
mod text;
mod texture;
mod textured;
mod ticks;
mod wire;

pub use camera::{Camera, ViewDirection};
pub use check::MAX_SIDE;
pub use colour_map::ColourMap;
pub use compose::{GridStyle, Panel, grid};
pub use covering::{Covering, Material};
pub use dice::dice;
pub use error::RenderError;
pub use exact::{render_exact, render_exact_observed};
pub use heat_map::{ColourBar, render_scalar};
pub use image::Image;
pub use picture::render;
pub use scale::Scale;
pub use style::{Lighting, Shading, Style};
pub use text::{Align, TextStyle, text_width};
pub use texture::Texture;
pub use textured::render_textured;
