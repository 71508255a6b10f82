//! The position and the normals of a part of the surface: the arguments of criteria that depend on
//! a viewer.
//!
//! Angles are stored as sines of half angles from 0 to 90°; 1 also means every greater angle, that
//! is every direction. Sums saturate there, so that a cone of 1 means "anything".

use crate::vector::DVec3;

/// A ball of points and a cone of unit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Region {
    /// Middle of the ball.
    pub(crate) centre: DVec3,
    /// Radius of the ball.
    pub(crate) radius: f64,
    /// Middle of the cone, of unit length and pointing outside; zero where the normals are unknown.
    pub(crate) axis: DVec3,
    /// Sine of the greatest angle between a normal and the axis.
    pub(crate) sine: f64,
}

impl Region {
    /// The ball around a triangle's centroid that holds it, and a normal of it without a cone.
    pub(crate) fn around(corners: [DVec3; 3], normal: DVec3) -> Self {
        let centre = corners
            .into_iter()
            .map(|corner| corner / 3.0)
            .sum::<DVec3>();
        let radius = corners
            .iter()
            .map(|corner| corner.distance_squared(centre))
            .fold(0.0, f64::max)
            .sqrt();
        Self {
            centre,
            radius,
            axis: normal,
            sine: if normal == DVec3::ZERO { 1.0 } else { 0.0 },
        }
    }

    /// The region grown to all points within `distance` of the ball.
    pub(crate) fn grown(self, distance: f64) -> Self {
        Self {
            radius: self.radius + distance,
            ..self
        }
    }

    /// The region with normals that differ by an angle with this chord (2 sin(θ/2)) from those in
    /// the cone.
    pub(crate) fn turned(self, chord: f64) -> Self {
        Self {
            sine: sum_of_angles(self.sine, sine_of_chord(chord)),
            ..self
        }
    }
}

/// The sine of the angle whose chord is given; 1 for angles from 90° on.
pub(crate) fn sine_of_chord(chord: f64) -> f64 {
    let squared = chord * chord;
    if squared < 2.0 {
        chord * (1.0 - 0.25 * squared).sqrt()
    } else {
        1.0
    }
}

/// The cosine of an angle up to 90° by its sine.
pub(super) fn cosine_of(sine: f64) -> f64 {
    (1.0 - sine * sine).max(0.0).sqrt()
}

/// The sine of the sum of two angles up to 90°, given by their sines; 1 where the sum is beyond 90°.
pub(super) fn sum_of_angles(a: f64, b: f64) -> f64 {
    let (cosine_a, cosine_b) = (cosine_of(a), cosine_of(b));
    let is_acute = cosine_a * cosine_b > a * b;
    if is_acute {
        (a * cosine_b + b * cosine_a).min(1.0)
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::FRAC_PI_2;

    #[test]
    fn angles_add_up_and_saturate() {
        for i in 0..=18 {
            for j in 0..=18 {
                let (a, b) = (
                    FRAC_PI_2 * f64::from(i) / 18.0,
                    FRAC_PI_2 * f64::from(j) / 18.0,
                );
                let sine = if a + b < FRAC_PI_2 {
                    (a + b).sin()
                } else {
                    1.0
                };
                assert!(
                    (sum_of_angles(a.sin(), b.sin()) - sine).abs() < 1e-8,
                    "{i} {j}"
                );
            }
            let angle = FRAC_PI_2 * f64::from(i) / 18.0;
            assert!((sine_of_chord(2.0 * (0.5 * angle).sin()) - angle.sin()).abs() < 1e-12);
        }
        assert_eq!(
            (
                sine_of_chord(1.5),
                sine_of_chord(2.0),
                sum_of_angles(1.0, 0.0)
            ),
            (1.0, 1.0, 1.0)
        );
    }
}
