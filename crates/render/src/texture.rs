//! Textures: pictures that lie on a surface, read where its texture coordinates say.
//!
//! Kept with all their halvings (Williams 1983), so that what is far away is read from a picture whose pixels are about as large as
//! those that are drawn. Along the longer side of a slanted pixel several readings are averaged. Everything is mixed in linear light.

use crate::RenderError;
use crate::check::MAX_SIDE;
use crate::colour::{self, Linear};
use crate::image::Image;

/// A picture to be laid on surfaces; it repeats beyond its sides. Opacity is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The picture and its halvings, the last of one pixel.
    levels: Vec<Level>,
}

/// Rows of 8-bit sRGB pixels, from above.
#[derive(Clone, Debug, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

/// Readings at most along the longer side of a slanted pixel.
const READINGS: f64 = 8.0;

/// Fields along a side of the checker pattern, and pixels along a side of a field.
const FIELDS: usize = 16;
const FIELD: usize = 32;

impl Texture {
    /// A PNG or JPEG file's picture.
    ///
    /// # Errors
    /// The bytes are neither, or the picture has a longer side than [`MAX_SIDE`].
    pub fn decode(bytes: &[u8]) -> Result<Self, RenderError> {
        let failed = |why: image::ImageError| RenderError::Decode {
            reason: why.to_string(),
        };
        let mut reader = image::ImageReader::new(std::io::Cursor::new(bytes))
            .with_guessed_format()
            .map_err(|why| RenderError::Decode {
                reason: why.to_string(),
            })?;
        let mut limits = image::Limits::default();
        limits.max_image_width = Some(MAX_SIDE);
        limits.max_image_height = Some(MAX_SIDE);
        reader.limits(limits);
        let picture = reader.decode().map_err(failed)?.into_rgb8();
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        Ok(Self::new(
            width,
            height,
            picture.pixels().map(|pixel| pixel.0).collect(),
        ))
    }

    /// A picture that was drawn before.
    pub fn from_image(image: &Image) -> Self {
        let pixels = image
            .rgba()
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&[r, g, b, _]| [r, g, b])
            .collect();
        Self::new(image.width() as usize, image.height() as usize, pixels)
    }

    /// Sixteen fields by sixteen, light and dark by turns: stretching, seams and mirrored parts show. Colours go from blue to red
    /// to the right and get lighter upwards.
    pub fn checker() -> Self {
        let side = FIELDS * FIELD;
        let pixel = |at: usize| {
            let (x, y) = (at % side / FIELD, at / side / FIELD);
            let (right, up) = (x as f32 / FIELDS as f32, 1.0 - y as f32 / FIELDS as f32);
            let tint = colour::mix([0.10, 0.25, 0.75], [0.80, 0.20, 0.12], right);
            let light = if (x + y) % 2 == 0 {
                0.55 + 0.3 * up
            } else {
                0.05 + 0.3 * up
            };
            colour::encode(colour::mix(tint, [1.0; 3], light))
        };
        Self::new(side, side, (0..side * side).map(pixel).collect())
    }

    fn new(width: usize, height: usize, pixels: Vec<[u8; 3]>) -> Self {
        let mut levels = vec![Level {
            width,
            height,
            pixels,
        }];
        while let Some(last) = levels
            .last()
            .filter(|last| last.width > 1 || last.height > 1)
        {
            let half = last.half();
            levels.push(half);
        }
        Self { levels }
    }

    /// The mean colour of what a pixel of the picture sees: around `at`, from half a step back to half a step on along both `steps`,
    /// which are how texture coordinates change from one pixel to the next.
    pub(crate) fn mean(&self, at: [f64; 2], steps: [[f64; 2]; 2]) -> Linear {
        let first = &self.levels[0];
        let size = [first.width as f64, first.height as f64];
        let length = |step: [f64; 2]| (step[0] * size[0]).hypot(step[1] * size[1]);
        let lengths = steps.map(length);
        let long = usize::from(lengths[1] > lengths[0]);
        let short = lengths[1 - long].max(lengths[long] / READINGS).max(1.0);
        if !short.is_finite() {
            return self.levels[self.levels.len() - 1].pixel(0, 0);
        }
        let count = (lengths[long] / short).ceil().clamp(1.0, READINGS) as usize;
        let mut sum = [0.0; 3];
        for i in 0..count {
            let along = (i as f64 + 0.5) / count as f64 - 0.5;
            let place = [0, 1].map(|axis| at[axis] + along * steps[long][axis]);
            let colour = self.at(place, short.log2());
            (0..3).for_each(|channel| sum[channel] += colour[channel] / count as f32);
        }
        sum
    }

    /// The colour at texture coordinates, mixed of the two nearest levels.
    fn at(&self, place: [f64; 2], level: f64) -> Linear {
        let last = self.levels.len() - 1;
        let level = level.clamp(0.0, last as f64);
        let below = level as usize;
        let colour = self.levels[below].at(place);
        let share = level - below as f64;
        if share == 0.0 {
            return colour;
        }
        colour::mix(
            colour,
            self.levels[(below + 1).min(last)].at(place),
            share as f32,
        )
    }
}

impl Level {
    /// Half as many pixels along each side, at least one: means of two by two.
    fn half(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0.0; 3];
                for [dx, dy] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                    let own = self.pixel(
                        (2 * x + dx).min(self.width - 1),
                        (2 * y + dy).min(self.height - 1),
                    );
                    (0..3).for_each(|channel| sum[channel] += own[channel] / 4.0);
                }
                pixels.push(colour::encode(sum));
            }
        }
        Self {
            width,
            height,
            pixels,
        }
    }

    fn pixel(&self, x: usize, y: usize) -> Linear {
        colour::linear(self.pixels[y * self.width + x])
    }

    /// Mixed of the four pixels around.
    fn at(&self, [u, v]: [f64; 2]) -> Linear {
        // Rows run from above, texture coordinates from below.
        let (left, across) = around(u, self.width);
        let (top, down) = around(1.0 - v, self.height);
        let (right, bottom) = ((left + 1) % self.width, (top + 1) % self.height);
        let upper = colour::mix(self.pixel(left, top), self.pixel(right, top), across);
        let lower = colour::mix(self.pixel(left, bottom), self.pixel(right, bottom), across);
        colour::mix(upper, lower, down)
    }
}

/// The pixel whose middle is next before a coordinate of a row that repeats, and how far it is on the way to the next one's.
fn around(place: f64, count: usize) -> (usize, f32) {
    let x = (place - place.floor()) * count as f64 - 0.5;
    let before = x.floor();
    (
        (before.max(-1.0) as i64).rem_euclid(count as i64) as usize,
        (x - before) as f32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Linear, b: Linear) -> bool {
        (0..3).all(|i| (a[i] - b[i]).abs() < 0.005)
    }

    fn quarters() -> Texture {
        // Red, green; blue, white.
        Texture::new(2, 2, vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]])
    }

    #[test]
    fn coordinates_run_to_the_right_and_upwards_and_repeat() {
        let texture = quarters();
        for turn in [0.0, 1.0, -3.0] {
            let at = |u: f64, v: f64| texture.at([u + turn, v + turn], 0.0);
            assert!(close(at(0.25, 0.75), [1.0, 0.0, 0.0]));
            assert!(close(at(0.75, 0.75), [0.0, 1.0, 0.0]));
            assert!(close(at(0.25, 0.25), [0.0, 0.0, 1.0]));
            assert!(close(at(0.75, 0.25), [1.0, 1.0, 1.0]));
            assert!(close(at(0.5, 0.75), [0.5, 0.5, 0.0]));
        }
    }

    #[test]
    fn wide_pixels_see_the_mean() {
        let mean = quarters().mean([0.3, 0.1], [[1.0, 0.0], [0.0, 1.0]]);
        assert!(close(mean, [0.5; 3]), "{mean:?}");
        // Slanted ones along a row, not of the other one.
        let mean = quarters().mean([0.5, 0.25], [[1.0, 0.0], [0.0, 0.0]]);
        assert!(close(mean, [0.5, 0.5, 1.0]), "{mean:?}");
    }

    #[test]
    fn pictures_come_back_from_their_files() {
        let image =
            Image::from_rgba(2, 1, vec![10, 20, 30, 255, 200, 100, 0, 255]).expect("a picture");
        let file = image.encode_png().expect("a file");
        assert_eq!(Texture::decode(&file), Ok(Texture::from_image(&image)));
        let why = Texture::decode(b"no picture").expect_err("no picture");
        assert!(matches!(why, RenderError::Decode { .. }), "{why}");
    }

    #[test]
    fn steps_that_are_not_finite_see_the_whole() {
        let mean = quarters().mean([0.0, 0.0], [[f64::INFINITY, 0.0], [0.0, f64::NAN]]);
        assert!(mean.iter().all(|channel| channel.is_finite()));
    }
}
