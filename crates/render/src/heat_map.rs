//! Heat maps: numbers at the vertices shown as colours, and the colour bar that tells what they mean.
//!
//! The numbers, not the colours, are interpolated across triangles, and each pixel looks its own up in the map:
//! mixed colours would show values that the map does not hold.

use limitmesh::Triangles;

use crate::camera::Camera;
use crate::check::check_count;
use crate::colour;
use crate::colour_map::look_up;
use crate::image::Image;
use crate::picture::{self, Paint};
use crate::scale::Scale;
use crate::style::Style;
use crate::text::{Align, TextStyle, text_width};
use crate::{RenderError, ticks};

/// Draws a surface coloured by `values`, one for each vertex.
///
/// The style's own surface colours are not used; [`Lighting::even`](crate::Lighting::even) keeps the colours
/// closest to those of the colour bar.
///
/// # Errors
/// As for [`render`](crate::render); values that are not finite; a scale whose ends are not finite or swapped.
pub fn render_scalar(
    surface: Triangles<'_>,
    normals: Option<&[[f64; 3]]>,
    values: &[f64],
    scale: &Scale,
    camera: &Camera,
    style: &Style,
    (width, height): (u32, u32),
) -> Result<Image, RenderError> {
    scale.check()?;
    check_count("values", values.len(), surface.positions.len())?;
    if let Some((index, &value)) = values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        return Err(RenderError::NotFinite {
            what: "value",
            index,
            value,
        });
    }
    let paint = Paint::Scalar {
        values,
        scale,
        table: scale.map.table(),
    };
    picture::draw(surface, normals, &paint, camera, style, width, height)
}

/// A legend for a [`Scale`]: a vertical bar with ticks at round numbers, and a title.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ColourBar {
    /// The scale it explains.
    pub scale: Scale,
    /// What the numbers are; stands above the bar.
    pub title: String,
    /// Their unit, added to the title in brackets where not empty.
    pub unit: String,
    /// Size of the text in pixels; a fortieth of the picture's height, but at least 11, where `None`.
    pub text_size: Option<f32>,
}

impl ColourBar {
    /// A bar without title.
    pub fn new(scale: Scale) -> Self {
        Self {
            scale,
            title: String::new(),
            unit: String::new(),
            text_size: None,
        }
    }

    /// What the numbers are.
    pub fn title(self, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..self
        }
    }

    /// Their unit.
    pub fn unit(self, unit: impl Into<String>) -> Self {
        Self {
            unit: unit.into(),
            ..self
        }
    }

    /// Size of the text in pixels, from 1 to 1000.
    pub fn text_size(self, size: f32) -> Self {
        Self {
            text_size: Some(size),
            ..self
        }
    }

    /// The ticks' values and labels, from below to above.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let (low, high) = (self.scale.low, self.scale.high);
        let all = if self.scale.is_logarithmic {
            ticks::logarithmic(low, high, 6)
        } else {
            ticks::linear(low, high, 6)
        };
        all.into_iter()
            .filter_map(|tick| Some((tick.value, tick.label?)))
            .collect()
    }

    /// The picture with the bar on its right, on `background`.
    ///
    /// # Errors
    /// The result would be wider than a picture may be, or the scale or text size is out of range.
    pub fn beside(&self, picture: &Image, background: [u8; 4]) -> Result<Image, RenderError> {
        self.scale.check()?;
        let size = self
            .text_size
            .unwrap_or((picture.height() as f32 / 40.0).max(11.0));
        let text = TextStyle::default().size(size);
        let title = if self.unit.is_empty() {
            self.title.clone()
        } else {
            format!("{} ({})", self.title, self.unit)
        };
        let heading = text.bold(true);
        let ticks = self.ticks();
        let mut widest = 0.0f32;
        for (_, label) in &ticks {
            widest = widest.max(text_width(label, &text)?);
        }
        let (bar, gap) = (1.5 * size, 0.4 * size);
        let strip = (bar + 2.0 * gap + widest).max(text_width(&title, &heading)?) + 2.0 * size;
        let width = picture.width() + strip.ceil() as u32;
        let mut image = Image::new(width, picture.height(), background)?;
        image.paste(picture, 0, 0);
        let left = (picture.width() as f32 + size).round();
        let height = picture.height() as f32;
        let (top, bottom) = (
            (0.12 * height + size).min(0.4 * height).round(),
            (0.90 * height).round(),
        );
        let room = if self.scale.above.is_some() {
            1.7 * size
        } else {
            size
        };
        image.draw_text(left, top - room, title.trim(), &heading)?;
        self.draw_bar(&mut image, [left, top], [left + bar, bottom]);
        if let Some(above) = self.scale.above {
            let (from, to) = ([left, top - 0.7 * size], [left + bar, top - 0.1 * size]);
            image.fill_rectangle(from, to, above);
            image.draw_text(
                left + bar + 1.6 * gap,
                to[1],
                "more",
                &text.align(Align::Left),
            )?;
        }
        for (value, label) in &ticks {
            let y = bottom + (top - bottom) * self.scale.place(*value) as f32;
            let mark = (0.07 * size).max(1.0);
            let from = [left + bar, (y - 0.5 * mark).round()];
            image.fill_rectangle(from, [left + bar + gap, from[1] + mark], text.colour);
            image.draw_text(
                left + bar + 1.6 * gap,
                y + 0.36 * size,
                label,
                &text.align(Align::Left),
            )?;
        }
        Ok(image)
    }

    /// The gradient in a thin frame.
    fn draw_bar(&self, image: &mut Image, from: [f32; 2], to: [f32; 2]) {
        let frame = TextStyle::default().colour;
        image.fill_rectangle(
            [from[0] - 1.0, from[1] - 1.0],
            [to[0] + 1.0, to[1] + 1.0],
            frame,
        );
        let table = self.scale.map.table();
        for y in from[1] as i64..to[1] as i64 {
            let value = (f64::from(to[1]) - (y as f64 + 0.5)) / f64::from(to[1] - from[1]);
            let shade = colour::encode(look_up(&table, value));
            image.fill_rectangle([from[0], y as f32], [to[0], y as f32 + 1.0], shade);
        }
    }
}
