//! Images: 8-bit sRGB pixels with opacity, and how they are put into PNG files.

use crate::RenderError;
use crate::check::check_size;

/// A picture of `width` × `height` pixels: red, green, blue (sRGB) and opacity of each, row by row from the upper
/// left. Colours are not premultiplied by the opacity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    rgba: Vec<u8>,
}

impl Image {
    /// A picture of one colour.
    ///
    /// # Errors
    /// A side is zero or longer than [`MAX_SIDE`](crate::MAX_SIDE).
    pub fn new(width: u32, height: u32, colour: [u8; 4]) -> Result<Self, RenderError> {
        check_size(width.into(), height.into())?;
        Ok(Self {
            width,
            height,
            rgba: colour.repeat(width as usize * height as usize),
        })
    }

    /// A picture from its bytes, four a pixel.
    ///
    /// # Errors
    /// The size is not possible or the number of bytes does not fit it.
    pub fn from_rgba(width: u32, height: u32, rgba: Vec<u8>) -> Result<Self, RenderError> {
        check_size(width.into(), height.into())?;
        let expected = width as usize * height as usize * 4;
        if rgba.len() != expected {
            return Err(RenderError::BadOption {
                name: "the number of bytes",
                value: rgba.len() as f64,
                expected: "4 for each pixel",
            });
        }
        Ok(Self {
            width,
            height,
            rgba,
        })
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The bytes: red, green, blue and opacity of each pixel, row by row.
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }

    /// The pixel `x` from the left and `y` from above; `None` outside of the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = (y as usize * self.width as usize + x as usize) * 4;
        self.rgba.get(at..at + 4)?.try_into().ok()
    }

    /// The four bytes of each pixel of row `y` from `x` on.
    pub(crate) fn row_mut(&mut self, x: u32, y: u32) -> &mut [u8] {
        let row = self.width as usize * 4;
        &mut self.rgba[y as usize * row..][x as usize * 4..row]
    }

    /// The picture as a PNG file: 8-bit sRGB, with an opacity channel only where a pixel is not opaque.
    ///
    /// # Errors
    /// The encoder's own; none is expected, since it writes to memory.
    pub fn encode_png(&self) -> Result<Vec<u8>, RenderError> {
        let failed = |error: png::EncodingError| RenderError::Encode {
            reason: error.to_string(),
        };
        let opaque = self.rgba.chunks_exact(4).all(|pixel| pixel[3] == 255);
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width, self.height);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_color(if opaque {
            png::ColorType::Rgb
        } else {
            png::ColorType::Rgba
        });
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        encoder.set_compression(png::Compression::Balanced);
        let mut writer = encoder.write_header().map_err(failed)?;
        if opaque {
            let rgb: Vec<u8> = self
                .rgba
                .chunks_exact(4)
                .flat_map(|p| [p[0], p[1], p[2]])
                .collect();
            writer.write_image_data(&rgb).map_err(failed)?;
        } else {
            writer.write_image_data(&self.rgba).map_err(failed)?;
        }
        writer.finish().map_err(failed)?;
        Ok(file)
    }
}
