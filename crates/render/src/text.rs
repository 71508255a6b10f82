//! Text on images, set in Noto Sans (by Google, SIL Open Font License 1.1), which is built in.
//!
//! Takes a line of text and a place, gives its width or draws it. Raised digits and minus signs (², ⁻³) are drawn
//! from the ordinary ones, since most fonts have only some of them.

use ab_glyph::{Font, FontRef, ScaleFont, point};

use crate::{Image, RenderError};

/// On which side of its anchor a text lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// It starts at the anchor.
    #[default]
    Left,
    /// Its middle is at the anchor.
    Centre,
    /// It ends at the anchor.
    Right,
}

/// How a text is set.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TextStyle {
    /// Height of an em in pixels (default: 16); a capital is about 0.71 of it.
    pub size: f32,
    /// Bold rather than regular (default: no).
    pub bold: bool,
    /// 8-bit sRGB (default: a blue black).
    pub colour: [u8; 3],
    /// On which side of the anchor it lies (default: left-aligned).
    pub align: Align,
}

impl Default for TextStyle {
    fn default() -> Self {
        Self {
            size: 16.0,
            bold: false,
            colour: [26, 30, 38],
            align: Align::Left,
        }
    }
}

impl TextStyle {
    /// Height of an em in pixels, from 1 to 1000.
    pub fn size(self, size: f32) -> Self {
        Self { size, ..self }
    }

    /// Bold rather than regular.
    pub fn bold(self, bold: bool) -> Self {
        Self { bold, ..self }
    }

    /// 8-bit sRGB.
    pub fn colour(self, colour: [u8; 3]) -> Self {
        Self { colour, ..self }
    }

    /// On which side of the anchor it lies.
    pub fn align(self, align: Align) -> Self {
        Self { align, ..self }
    }
}

/// Size of raised characters relative to ordinary ones, and how far they are raised in ems.
const RAISED_SIZE: f32 = 0.66;
const RAISED_BY: f32 = 0.36;

/// The ordinary character that a raised one is drawn from.
fn lowered(character: char) -> Option<char> {
    Some(match character {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴'..='⁹' => char::from(b'4' + (character as u32 - '⁴' as u32) as u8),
        '⁻' => '−',
        '⁺' => '+',
        _ => return None,
    })
}

fn font(bold: bool) -> Result<FontRef<'static>, RenderError> {
    let bytes = if bold {
        notosans::BOLD_TTF
    } else {
        notosans::REGULAR_TTF
    };
    FontRef::try_from_slice(bytes).map_err(|error| RenderError::Encode {
        reason: error.to_string(),
    })
}

/// A glyph of a line: which, how large, and where its origin is relative to the line's start.
struct Placed {
    character: char,
    size: f32,
    x: f32,
    raised: f32,
}

/// The glyphs of a line and its width.
fn layout(font: &FontRef<'_>, text: &str, size: f32) -> (Vec<Placed>, f32) {
    let mut x = 0.0;
    let mut previous = None;
    let mut line = Vec::new();
    for original in text.chars().filter(|c| !c.is_control()) {
        let (character, size, raised) = match lowered(original) {
            Some(base) => (base, size * RAISED_SIZE, size * RAISED_BY),
            None => (original, size, 0.0),
        };
        let scaled = font.as_scaled(em_scale(font, size));
        let glyph = font.glyph_id(character);
        if let Some((before, before_size)) = previous
            && before_size == size
        {
            x += scaled.kern(before, glyph);
        }
        line.push(Placed {
            character,
            size,
            x,
            raised,
        });
        x += scaled.h_advance(glyph);
        previous = Some((glyph, size));
    }
    (line, x)
}

/// ab_glyph measures sizes from ascender to descender; this turns ems into them.
fn em_scale(font: &FontRef<'_>, size: f32) -> f32 {
    size * font.height_unscaled() / font.units_per_em().unwrap_or(1000.0)
}

/// Width of a line of text in pixels.
///
/// # Errors
/// The built-in font cannot be read, which is not expected.
pub fn text_width(text: &str, style: &TextStyle) -> Result<f32, RenderError> {
    Ok(layout(&font(style.bold)?, text, style.size).1)
}

impl Image {
    /// Draws a line of text with its baseline at `y` and its anchor at `x`, in pixels from the upper left. What
    /// falls outside of the picture is left out; control characters are passed over.
    ///
    /// # Errors
    /// The size is out of range or the anchor is not finite.
    pub fn draw_text(
        &mut self,
        x: f32,
        y: f32,
        text: &str,
        style: &TextStyle,
    ) -> Result<(), RenderError> {
        RenderError::check_range(
            "text size",
            style.size.into(),
            1.0..=1000.0,
            "from 1 to 1000 pixels",
        )?;
        for value in [x, y] {
            RenderError::check_range(
                "text anchor",
                value.into(),
                -1e6..=1e6,
                "a place near the picture",
            )?;
        }
        let font = font(style.bold)?;
        let (line, width) = layout(&font, text, style.size);
        let start = x - match style.align {
            Align::Left => 0.0,
            Align::Centre => 0.5 * width,
            Align::Right => width,
        };
        for placed in line {
            let origin = point(start + placed.x, y - placed.raised);
            let glyph = font
                .glyph_id(placed.character)
                .with_scale_and_position(em_scale(&font, placed.size), origin);
            let Some(outline) = font.outline_glyph(glyph) else {
                continue;
            };
            let corner = outline.px_bounds().min;
            let (left, top) = (corner.x as i64, corner.y as i64);
            outline.draw(|dx, dy, coverage| {
                self.blend(
                    left + i64::from(dx),
                    top + i64::from(dy),
                    style.colour,
                    coverage,
                );
            });
        }
        Ok(())
    }

    /// Lays a colour over a pixel. Mixed in sRGB rather than in linear light: dark glyphs on white keep the
    /// weight that they were drawn for.
    pub(crate) fn blend(&mut self, x: i64, y: i64, colour: [u8; 3], opacity: f32) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
            return;
        };
        if x >= self.width() || y >= self.height() {
            return;
        }
        let opacity = opacity.clamp(0.0, 1.0);
        let pixel = &mut self.row_mut(x, y)[..4];
        let under = f32::from(pixel[3]) / 255.0 * (1.0 - opacity);
        let whole = opacity + under;
        if whole <= 0.0 {
            return;
        }
        for (channel, value) in pixel.iter_mut().zip(colour) {
            let mixed = (f32::from(value) * opacity + f32::from(*channel) * under) / whole;
            *channel = (mixed + 0.5) as u8;
        }
        pixel[3] = (whole * 255.0 + 0.5) as u8;
    }

    /// Fills a rectangle, given by its corners in pixels, with borders anti-aliased.
    pub(crate) fn fill_rectangle(&mut self, from: [f32; 2], to: [f32; 2], colour: [u8; 3]) {
        let covered = |low: f32, high: f32, pixel: i64| {
            (high.min(pixel as f32 + 1.0) - low.max(pixel as f32)).clamp(0.0, 1.0)
        };
        for y in from[1].floor() as i64..to[1].ceil() as i64 {
            for x in from[0].floor() as i64..to[0].ceil() as i64 {
                let share = covered(from[0], to[0], x) * covered(from[1], to[1], y);
                self.blend(x, y, colour, share);
            }
        }
    }
}
