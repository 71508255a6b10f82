//! Colours: between 8-bit sRGB, in which pictures are stored, and linear light, in which they are computed.
//!
//! The transfer curve is that of IEC 61966-2-1.

/// Red, green and blue in linear light, 0 to 1.
pub(crate) type Linear = [f32; 3];

/// One sRGB channel (0 to 1) to linear light.
pub(crate) fn to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// One channel in linear light to sRGB (0 to 1).
pub(crate) fn to_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// An 8-bit sRGB colour in linear light.
pub(crate) fn linear(colour: [u8; 3]) -> Linear {
    colour.map(|channel| to_linear(f32::from(channel) / 255.0))
}

/// The nearest 8-bit sRGB colour; channels outside 0 to 1 are clamped.
pub(crate) fn encode(colour: Linear) -> [u8; 3] {
    colour.map(|channel| (to_srgb(channel.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8)
}

/// `a` where `t` is 0, `b` where it is 1.
pub(crate) fn mix(a: Linear, b: Linear, t: f32) -> Linear {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_8_bit_colour_survives_the_way_to_linear_light_and_back() {
        for value in 0..=255 {
            assert_eq!(encode(linear([value; 3])), [value; 3]);
        }
    }

    /// The standard's middle grey: 18 % of the light is sRGB 118.
    #[test]
    fn middle_grey() {
        assert_eq!(encode([0.18; 3]), [118; 3]);
    }
}
