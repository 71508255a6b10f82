//! Heat maps: numbers at the vertices shown as colours, and the colour bar that tells what they mean.
//!
//! The numbers, not the colours, are interpolated across triangles, and each pixel looks its own up in the map:
//! mixed colours would show values that the map does not hold.

use limitmesh::Triangles;

use crate::camera::Camera;
use crate::colour;
use crate::colour_map::{ColourMap, look_up};
use crate::image::Image;
use crate::picture::{self, Paint};
use crate::style::Style;
use crate::text::{Align, TextStyle, text_width};
use crate::{RenderError, ticks};

/// How numbers become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The value at the map's lower end.
    pub low: f64,
    /// The value at its upper end; values outside get the nearest end's colour.
    pub high: f64,
    /// The colours.
    pub map: ColourMap,
    /// Equal ratios rather than equal differences get equal steps of the map; both ends are above 0 then.
    pub is_logarithmic: bool,
    /// The colour of values above the upper end, where they are marked (8-bit sRGB).
    pub above: Option<[u8; 3]>,
}

impl Scale {
    /// From `low` to `high` in the default colours.
    pub fn new(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            map: ColourMap::default(),
            is_logarithmic: false,
            above: None,
        }
    }

    /// From `low` to `high`, both above 0, by their ratio.
    pub fn logarithmic(low: f64, high: f64) -> Self {
        Self {
            is_logarithmic: true,
            ..Self::new(low, high)
        }
    }

    /// The same with a colour of its own for values above the upper end.
    pub fn marking_above(self, colour: [u8; 3]) -> Self {
        Self {
            above: Some(colour),
            ..self
        }
    }

    /// From the least to the greatest of the values that are finite (0 to 1 without any).
    pub fn of(values: &[f64]) -> Self {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let ends = finite.fold((f64::MAX, f64::MIN), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        if ends.0 <= ends.1 {
            Self::new(ends.0, ends.1)
        } else {
            Self::new(0.0, 1.0)
        }
    }

    /// The same range in other colours.
    pub fn with_map(self, map: ColourMap) -> Self {
        Self { map, ..self }
    }

    /// The colour of a value (8-bit sRGB): where both ends are one, that of the map's middle.
    pub fn colour(&self, value: f64) -> [u8; 3] {
        match self.above {
            Some(above) if value > self.high => above,
            _ => self.map.at(self.place(value)),
        }
    }

    /// Where a value stands between low (0) and high (1).
    pub(crate) fn place(&self, value: f64) -> f64 {
        if self.is_logarithmic {
            let span = (self.high / self.low).ln();
            // Values from 0 down have no logarithm: they stand below all.
            return if span > 0.0 {
                (value.max(f64::MIN_POSITIVE) / self.low).ln() / span
            } else {
                0.5
            };
        }
        let span = self.high - self.low;
        if span > 0.0 {
            (value - self.low) / span
        } else {
            0.5
        }
    }

    fn check(&self) -> Result<(), RenderError> {
        let half = f64::MAX / 2.0;
        if self.is_logarithmic {
            let range = f64::MIN_POSITIVE..=half;
            RenderError::check_range(
                "the logarithmic scale's lower end",
                self.low,
                range,
                "a number above 0",
            )?;
        }
        RenderError::check_range(
            "the scale's lower end",
            self.low,
            -half..=half,
            "a finite number",
        )?;
        RenderError::check_range(
            "the scale's upper end",
            self.high,
            self.low..=half,
            "at least the lower end",
        )
    }
}

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
    picture::check_count("values", values.len(), surface)?;
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
