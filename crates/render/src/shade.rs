//! Light: how bright a point of the surface is, from its normal and the lights that move with the viewer.
//!
//! All in linear light: a wrapped diffuse term for key and fill (soft terminators), light from above and below
//! by the normal's tilt, a rim light by the angle to the viewer, and Blinn's highlight.

use glam::DVec3;

use crate::colour::Linear;
use crate::style::Lighting;

/// Where the lights stand, as unit vectors of the viewer's frame (right, up, towards the viewer).
const KEY: [f64; 3] = [-0.492, 0.615, 0.616];
const FILL: [f64; 3] = [0.831, 0.104, 0.546];
const RIM: [f64; 3] = [0.371, 0.557, -0.743];

/// How far the lights reach past the terminator: 0 is a point light, 1 reaches everywhere.
const KEY_WRAP: f64 = 0.22;
const FILL_WRAP: f64 = 0.5;
/// What the ground sends back of the light from above.
const GROUND: f64 = 0.42;
/// Sharpness of the highlight.
const GLOSS_EXPONENT: i32 = 36;

/// The colour that a surface of reflectance `albedo` shows. `normal` and `viewer` are unit vectors in the
/// viewer's frame.
pub(crate) fn shade(lighting: &Lighting, albedo: Linear, normal: DVec3, viewer: DVec3) -> Linear {
    let diffuse = f64::from(lighting.key) * wrapped(normal.dot(KEY.into()), KEY_WRAP)
        + f64::from(lighting.fill) * wrapped(normal.dot(FILL.into()), FILL_WRAP);
    let sky = GROUND + (1.0 - GROUND) * (0.5 + 0.5 * normal.y);
    let light = diffuse + f64::from(lighting.ambient) * sky;
    let facing = normal.dot(viewer).clamp(0.0, 1.0);
    let grazing = (1.0 - facing).powi(3);
    let rim = f64::from(lighting.rim) * grazing * (normal.dot(RIM.into()) + 0.5).clamp(0.0, 1.0);
    let half = (DVec3::from(KEY) + viewer).normalize_or_zero();
    let gloss = f64::from(lighting.gloss) * normal.dot(half).max(0.0).powi(GLOSS_EXPONENT);
    let white = (rim + gloss) as f32;
    albedo.map(|channel| shoulder(channel * light as f32 + white))
}

/// Lambert's cosine, softened so that it reaches zero only beyond the terminator.
fn wrapped(cosine: f64, wrap: f64) -> f64 {
    let t = ((cosine + wrap) / (1.0 + wrap)).max(0.0);
    t * (t * wrap + (1.0 - wrap))
}

/// Brings what is brighter than white back softly: the identity up to 0.8, never above 1.
fn shoulder(value: f32) -> f32 {
    const FROM: f32 = 0.8;
    if value <= FROM {
        value
    } else {
        1.0 - (1.0 - FROM) * (-(value - FROM) / (1.0 - FROM)).exp()
    }
}
