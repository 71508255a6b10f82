//! Several pictures on one: pasted, side by side, in a grid with captions.

use crate::text::{Align, TextStyle, text_width};
use crate::{Image, RenderError};

/// A picture and what stands below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panel {
    /// The picture.
    pub image: Image,
    /// The line below it; may be empty. Longer ones than the picture is wide are set smaller.
    pub caption: String,
}

impl Panel {
    /// A picture with a caption.
    pub fn new(image: Image, caption: impl Into<String>) -> Self {
        Self {
            image,
            caption: caption.into(),
        }
    }
}

/// How panels are put together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GridStyle {
    /// Panels in a row (default: 3).
    pub columns: usize,
    /// Space between panels and around them, in pixels (default: 16).
    pub gap: u32,
    /// Behind everything (default: white).
    pub background: [u8; 4],
    /// How captions are set (default: 18 pixels).
    pub caption: TextStyle,
}

impl Default for GridStyle {
    fn default() -> Self {
        let caption = TextStyle::default().size(18.0);
        Self {
            columns: 3,
            gap: 16,
            background: [255; 4],
            caption,
        }
    }
}

impl GridStyle {
    /// Panels in a row, at least 1.
    pub fn columns(self, columns: usize) -> Self {
        Self { columns, ..self }
    }

    /// Space between panels and around them, in pixels.
    pub fn gap(self, gap: u32) -> Self {
        Self { gap, ..self }
    }

    /// Behind everything.
    pub fn background(self, background: [u8; 4]) -> Self {
        Self { background, ..self }
    }

    /// How captions are set; they are always centred.
    pub fn caption(self, caption: TextStyle) -> Self {
        Self { caption, ..self }
    }
}

impl Image {
    /// Lays `other` over this picture with its upper left corner at (x, y); what falls outside is left out.
    pub fn paste(&mut self, other: &Image, x: i64, y: i64) {
        for row in 0..other.height() {
            for column in 0..other.width() {
                let Some([r, g, b, opacity]) = other.pixel(column, row) else {
                    continue;
                };
                let (to_x, to_y) = (x + i64::from(column), y + i64::from(row));
                self.blend(to_x, to_y, [r, g, b], f32::from(opacity) / 255.0);
            }
        }
    }
}

/// Puts panels into a grid, row by row; every column is as wide and every row as high as its largest picture.
///
/// # Errors
/// No panels or no columns, or the result would be larger than a picture may be.
pub fn grid(panels: &[Panel], style: &GridStyle) -> Result<Image, RenderError> {
    if panels.is_empty() || style.columns == 0 {
        let (name, value) = if panels.is_empty() {
            ("panels", panels.len())
        } else {
            ("columns", 0)
        };
        return Err(RenderError::BadOption {
            name,
            value: value as f64,
            expected: "at least 1",
        });
    }
    let columns = style.columns.min(panels.len());
    let has_caption = panels.iter().any(|panel| !panel.caption.is_empty());
    let caption = if has_caption {
        (2.0 * style.caption.size.clamp(1.0, 1000.0)).ceil() as u64
    } else {
        0
    };
    let mut widths = vec![0u64; columns];
    let mut heights = vec![0u64; panels.len().div_ceil(columns)];
    for (i, panel) in panels.iter().enumerate() {
        let (width, height) = (&mut widths[i % columns], &mut heights[i / columns]);
        *width = (*width).max(panel.image.width().into());
        *height = (*height).max(panel.image.height().into());
    }
    let gap = u64::from(style.gap);
    let width = widths.iter().sum::<u64>() + gap * (columns as u64 + 1);
    let height = heights.iter().map(|h| h + caption + gap).sum::<u64>() + gap;
    crate::check::check_size(width, height)?;
    let mut image = Image::new(width as u32, height as u32, style.background)?;
    let mut y = gap;
    for (row, panels) in panels.chunks(columns).enumerate() {
        let mut x = gap;
        for (column, panel) in panels.iter().enumerate() {
            let centre = x as f32 + 0.5 * widths[column] as f32;
            let left = x + (widths[column] - u64::from(panel.image.width())) / 2;
            let top = y + (heights[row] - u64::from(panel.image.height())) / 2;
            image.paste(&panel.image, left as i64, top as i64);
            let text = fitted(&style.caption, &panel.caption, widths[column] as f32)?;
            let baseline = (y + heights[row]) as f32 + 1.35 * style.caption.size;
            image.draw_text(centre, baseline, &panel.caption, &text)?;
            x += widths[column] + gap;
        }
        y += heights[row] + caption + gap;
    }
    Ok(image)
}

/// The caption's style, smaller where the text would not fit.
fn fitted(style: &TextStyle, text: &str, room: f32) -> Result<TextStyle, RenderError> {
    let width = text_width(text, style)?;
    let scale = if width > room { room / width } else { 1.0 };
    Ok(style
        .size((style.size * scale).max(1.0))
        .align(Align::Centre))
}
