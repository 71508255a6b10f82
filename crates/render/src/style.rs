//! How a surface looks: shading, wireframe, colours, light, anti-aliasing.

use crate::RenderError;

/// Whether faces look flat or round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// One normal a face: shows the triangles.
    Flat,
    /// Normals interpolated between vertices: shows the surface they stand for.
    #[default]
    Smooth,
}

/// How strong the lights are, in linear light: a surface of reflectance 1 that gets 1 is white.
///
/// The lights stand still relative to the viewer, so that every view is lit alike: the key from the upper left,
/// a fill from the right, light from the sky and the ground all round, and a rim that catches the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lighting {
    /// The main light, from the upper left in front.
    pub key: f32,
    /// A weaker light from the right, which keeps the shadow side readable.
    pub fill: f32,
    /// Light from all round, brighter from above than from below.
    pub ambient: f32,
    /// Light from behind that shows on steep parts near the outline.
    pub rim: f32,
    /// The key light's soft highlight.
    pub gloss: f32,
}

impl Lighting {
    /// The default: reads shape well on a surface of one colour.
    pub fn studio() -> Self {
        Self {
            key: 1.0,
            fill: 0.18,
            ambient: 0.19,
            rim: 0.25,
            gloss: 0.08,
        }
    }

    /// Weak contrast and no highlight, so that colours that carry data stay comparable to their legend.
    pub fn even() -> Self {
        Self {
            key: 0.48,
            fill: 0.16,
            ambient: 0.64,
            rim: 0.0,
            gloss: 0.0,
        }
    }
}

impl Default for Lighting {
    fn default() -> Self {
        Self::studio()
    }
}

/// How a picture of a surface is drawn. Colours are 8-bit sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Style {
    /// Flat or smooth faces (default: smooth).
    pub shading: Shading,
    /// Whether triangle edges are drawn (default: no).
    pub wireframe: bool,
    /// The edges' colour (default: a blue black).
    pub wire_colour: [u8; 3],
    /// The edges' width in pixels (default: 0.9).
    pub wire_width: f32,
    /// Red, green, blue and opacity behind the surface (default: opaque white).
    pub background: [u8; 4],
    /// The colour of faces seen from outside (default: a light grey blue).
    pub surface_colour: [u8; 3],
    /// The colour of faces seen from inside (default: a light ochre).
    pub back_colour: [u8; 3],
    /// The lights' strengths.
    pub lighting: Lighting,
    /// Samples along each side of a pixel: 1, 2, 4 or 8 (default: 4, that is 16 a pixel).
    pub samples: u32,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            shading: Shading::default(),
            wireframe: false,
            wire_colour: [26, 34, 48],
            wire_width: 0.9,
            background: [255; 4],
            surface_colour: [188, 205, 226],
            back_colour: [222, 184, 138],
            lighting: Lighting::default(),
            samples: 4,
        }
    }
}

impl Style {
    /// Flat or smooth faces.
    pub fn shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }

    /// Whether triangle edges are drawn.
    pub fn wireframe(self, wireframe: bool) -> Self {
        Self { wireframe, ..self }
    }

    /// The edges' colour.
    pub fn wire_colour(self, wire_colour: [u8; 3]) -> Self {
        Self {
            wire_colour,
            ..self
        }
    }

    /// The edges' width in pixels, above 0 and at most 64.
    pub fn wire_width(self, wire_width: f32) -> Self {
        Self { wire_width, ..self }
    }

    /// Red, green, blue and opacity behind the surface; an opacity of 0 gives a transparent picture.
    pub fn background(self, background: [u8; 4]) -> Self {
        Self { background, ..self }
    }

    /// The colour of faces seen from outside.
    pub fn surface_colour(self, surface_colour: [u8; 3]) -> Self {
        Self {
            surface_colour,
            ..self
        }
    }

    /// The colour of faces seen from inside.
    pub fn back_colour(self, back_colour: [u8; 3]) -> Self {
        Self {
            back_colour,
            ..self
        }
    }

    /// The lights' strengths.
    pub fn lighting(self, lighting: Lighting) -> Self {
        Self { lighting, ..self }
    }

    /// Samples along each side of a pixel: 1, 2, 4 or 8.
    pub fn samples(self, samples: u32) -> Self {
        Self { samples, ..self }
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if !matches!(self.samples, 1 | 2 | 4 | 8) {
            let value = f64::from(self.samples);
            return Err(RenderError::BadOption {
                name: "samples",
                value,
                expected: "1, 2, 4 or 8",
            });
        }
        let width = f64::from(self.wire_width);
        RenderError::check_range("wire width", width, 0.01..=64.0, "from 0.01 to 64 pixels")?;
        let Lighting {
            key,
            fill,
            ambient,
            rim,
            gloss,
        } = self.lighting;
        for (name, value) in [
            ("key", key),
            ("fill", fill),
            ("ambient", ambient),
            ("rim", rim),
            ("gloss", gloss),
        ] {
            RenderError::check_range(name, value.into(), 0.0..=100.0, "a strength from 0 to 100")?;
        }
        Ok(())
    }
}
