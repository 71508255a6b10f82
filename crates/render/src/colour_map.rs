//! Colour maps for data: from a number between 0 and 1 to a colour whose lightness rises evenly.
//!
//! The maps are drawn in Oklab (Ottosson 2020), a space in which equal steps look equal: lightness is linear in
//! the value, hue and colourfulness follow a few control points. Since lightness alone carries the order, the
//! maps survive greyscale printing and read the same with any colour vision.

use crate::colour::{self, Linear};

/// A colour map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark violet through blue, teal and green to light yellow.
    #[default]
    Lagoon,
    /// Near black through purple, red and orange to pale yellow.
    Ember,
    /// Pale yellow through orange, red and purple to near black: what is small stays light.
    EmberReversed,
    /// Dark to light grey.
    Grey,
    /// Blue through light grey to red, for what has two signs: lightness is greatest in the middle.
    Diverging,
}

/// A control point: lightness (0 to 1), chroma and hue in degrees, in Oklab's cylindrical form.
type Control = [f64; 3];

const LAGOON: [Control; 6] = [
    [0.27, 0.125, 309.0],
    [0.404, 0.125, 281.0],
    [0.538, 0.100, 233.0],
    [0.672, 0.110, 186.0],
    [0.806, 0.175, 138.0],
    [0.94, 0.180, 105.0],
];
const EMBER: [Control; 6] = [
    [0.16, 0.050, 285.0],
    [0.32, 0.150, 305.0],
    [0.48, 0.190, 345.0],
    [0.64, 0.200, 388.0],
    [0.80, 0.145, 424.0],
    [0.96, 0.065, 462.0],
];
/// Each half at once: hues jump in the middle, where there is no chroma.
const BELOW: [Control; 3] = [[0.42, 0.17, 262.0], [0.68, 0.11, 250.0], [0.95, 0.0, 250.0]];
const ABOVE: [Control; 3] = [[0.95, 0.0, 29.0], [0.69, 0.13, 33.0], [0.44, 0.17, 27.0]];
const GREY: [Control; 2] = [[0.25, 0.0, 0.0], [0.93, 0.0, 0.0]];

impl ColourMap {
    /// The 8-bit sRGB colour at `value`; values outside of 0 to 1 get the nearest end, NaN the middle's grey.
    pub fn at(self, value: f64) -> [u8; 3] {
        colour::encode(self.linear_at(value))
    }

    pub(crate) fn linear_at(self, value: f64) -> Linear {
        if value.is_nan() {
            return [0.2; 3];
        }
        let value = value.clamp(0.0, 1.0);
        let (controls, value): (&[Control], f64) = match self {
            Self::Lagoon => (&LAGOON, value),
            Self::Ember => (&EMBER, value),
            Self::EmberReversed => (&EMBER, 1.0 - value),
            Self::Grey => (&GREY, value),
            Self::Diverging if value < 0.5 => (&BELOW, 2.0 * value),
            Self::Diverging => (&ABOVE, 2.0 * value - 1.0),
        };
        displayable(spline(controls, value))
    }

    /// The map as a table of evenly spaced colours, fine enough that steps between them do not show.
    pub(crate) fn table(self) -> Vec<Linear> {
        (0..TABLE)
            .map(|i| self.linear_at(i as f64 / (TABLE - 1) as f64))
            .collect()
    }
}

const TABLE: usize = 1024;

/// The entry of a table for a value from 0 to 1.
pub(crate) fn look_up(table: &[Linear], value: f64) -> Linear {
    let last = table.len().saturating_sub(1);
    table[(value.clamp(0.0, 1.0) * last as f64 + 0.5) as usize]
}

/// Catmull and Rom's spline through evenly spaced control points; linear where they lie on a line.
fn spline(controls: &[Control], value: f64) -> Control {
    let last = controls.len() - 1;
    let at = value * last as f64;
    let i = (at.floor() as usize).min(last - 1);
    let t = at - i as f64;
    let (b, c) = (controls[i], controls[i + 1]);
    let beyond = |p: Control, q: Control| [0, 1, 2].map(|k| 2.0 * p[k] - q[k]);
    let a = if i == 0 {
        beyond(b, c)
    } else {
        controls[i - 1]
    };
    let d = if i + 1 == last {
        beyond(c, b)
    } else {
        controls[i + 2]
    };
    [0, 1, 2].map(|k| {
        let slopes = [0.5 * (c[k] - a[k]), 0.5 * (d[k] - b[k])];
        let (t2, t3) = (t * t, t * t * t);
        b[k] * (2.0 * t3 - 3.0 * t2 + 1.0)
            + slopes[0] * (t3 - 2.0 * t2 + t)
            + c[k] * (3.0 * t2 - 2.0 * t3)
            + slopes[1] * (t3 - t2)
    })
}

/// The colour in linear light, with the chroma reduced until a screen can show it at this lightness.
fn displayable([lightness, chroma, hue]: Control) -> Linear {
    let fits = |rgb: [f64; 3]| rgb.iter().all(|c| (-1e-6..=1.0 + 1e-6).contains(c));
    let (mut low, mut high) = (0.0, chroma);
    if fits(from_oklab(lightness, chroma, hue)) {
        low = chroma;
    }
    // Twenty halvings bring the chroma to 1e-7, below what 8 bits can show.
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if fits(from_oklab(lightness, middle, hue)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    from_oklab(lightness, low, hue).map(|c| c.clamp(0.0, 1.0) as f32)
}

/// Oklab (cylindrical) to linear sRGB, with the matrices of its definition.
fn from_oklab(lightness: f64, chroma: f64, hue: f64) -> [f64; 3] {
    let (sin, cos) = hue.to_radians().sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE 1976 lightness from linear sRGB: independent of Oklab.
    fn cie_lightness(rgb: Linear) -> f64 {
        let luminance =
            0.2126 * f64::from(rgb[0]) + 0.7152 * f64::from(rgb[1]) + 0.0722 * f64::from(rgb[2]);
        if luminance > 0.008_856 {
            116.0 * luminance.cbrt() - 16.0
        } else {
            903.3 * luminance
        }
    }

    #[test]
    fn lightness_rises_everywhere_and_evenly() {
        for map in [ColourMap::Lagoon, ColourMap::Ember, ColourMap::Grey] {
            let lightness: Vec<f64> = (0..=64)
                .map(|i| cie_lightness(map.linear_at(f64::from(i) / 64.0)))
                .collect();
            let mean = (lightness[64] - lightness[0]) / 64.0;
            assert!(mean > 1.0, "{map:?} spans too little");
            for (i, pair) in lightness.windows(2).enumerate() {
                let step = pair[1] - pair[0];
                assert!(
                    step > 0.4 * mean && step < 1.9 * mean,
                    "{map:?} step {i}: {step}, mean {mean}"
                );
            }
        }
    }

    /// With red-blind, green-blind and blue-blind vision (Viénot, Brettel and Mollon 1999 for the first two, as a
    /// projection in linear light), the order is still one of lightness.
    #[test]
    fn order_survives_missing_cones() {
        let project = [
            [
                [0.112_38, 0.887_62, 0.0],
                [0.112_38, 0.887_62, 0.0],
                [0.004_01, -0.004_01, 1.0],
            ],
            [
                [0.292_75, 0.707_25, 0.0],
                [0.292_75, 0.707_25, 0.0],
                [-0.022_34, 0.022_34, 1.0],
            ],
        ];
        for map in [ColourMap::Lagoon, ColourMap::Ember] {
            for matrix in project {
                let lightness = (0..=32).map(|i| {
                    let rgb = map.linear_at(f64::from(i) / 32.0);
                    let seen = matrix
                        .map(|row| (0..3).map(|k| row[k] * f64::from(rgb[k])).sum::<f64>() as f32);
                    cie_lightness(seen)
                });
                let lightness: Vec<f64> = lightness.collect();
                assert!(
                    lightness.windows(2).all(|pair| pair[1] > pair[0]),
                    "{map:?}: {lightness:?}"
                );
            }
        }
    }

    #[test]
    fn values_outside_get_the_ends() {
        assert_eq!(ColourMap::Lagoon.at(-3.0), ColourMap::Lagoon.at(0.0));
        assert_eq!(
            ColourMap::Lagoon.at(f64::INFINITY),
            ColourMap::Lagoon.at(1.0)
        );
        assert_eq!(ColourMap::Ember.at(0.25), ColourMap::EmberReversed.at(0.75));
    }
}
