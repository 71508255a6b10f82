//! A local frame for a surface: centred on its box and scaled by a power of two to about unit size.
//!
//! Squared distances of very large or very small coordinates overflow or vanish, and single-precision boxes of
//! a small surface far from the origin are useless. Both go away when coordinates are first scaled (exactly,
//! by a power of two) and boxes are held relative to the centre.

use crate::vector::DVec3;

/// Beyond this distance (in units of the frame) a query is pulled in along its ray: 2^60 is so far away that
/// the differences between the surface's points are lost in the rounding of the distance, and its square still
/// fits single precision.
const FAR: f64 = (1u64 << 60) as f64;

/// Centre and power-of-two scale of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    centre: DVec3,
    scale: f64,
    scaled_centre: DVec3,
}

/// A point in the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Located {
    /// The point scaled but not centred: the origin for differences to vertices scaled alike.
    pub(super) scaled: DVec3,
    /// The point relative to the centre.
    pub(super) local: DVec3,
    /// Whether it had to be pulled in, so that its distance is not the true one.
    pub(super) pulled_in: bool,
}

/// The least power of two above a finite `x ≥ 0`, as an exponent.
pub(super) fn exponent_above(x: f64) -> i64 {
    ((x.to_bits() >> 52) & 0x7ff) as i64 - 1022
}

/// 2^`exponent`, subnormal below -1022 (the greatest numbers have no normal reciprocal).
pub(super) fn power_of_two(exponent: i64) -> f64 {
    let exponent = exponent.clamp(-1074, 1023);
    f64::from_bits(if exponent < -1022 {
        1 << (exponent + 1074)
    } else {
        ((exponent + 1023) as u64) << 52
    })
}

impl Frame {
    /// The frame of a box.
    pub(crate) fn new(low: DVec3, high: DVec3) -> Self {
        let centre = low * 0.5 + high * 0.5;
        let half = (high * 0.5 - low * 0.5).max_element();
        // A box smaller than the rounding of its own place (a single point, above all) must not be blown up
        // until that place overflows.
        let size = half.max(centre.abs().max_element() * power_of_two(-56));
        let scale = if size > 0.0 {
            power_of_two(-exponent_above(size))
        } else {
            1.0
        };
        Self {
            centre,
            scale,
            scaled_centre: centre * scale,
        }
    }

    /// A point of the surface, scaled.
    #[inline]
    pub(super) fn scale_point(&self, p: DVec3) -> DVec3 {
        p * self.scale
    }

    /// A point of the surface, relative to the centre: coordinates within about ±1.
    #[inline]
    pub(super) fn centre_point(&self, p: DVec3) -> DVec3 {
        p * self.scale - self.scaled_centre
    }

    /// A length of the frame in the units of the surface.
    #[inline]
    pub(super) fn length(&self, length: f64) -> f64 {
        length / self.scale
    }

    /// Any finite point in the frame.
    #[inline]
    pub(super) fn locate(&self, p: DVec3) -> Located {
        let scaled = p * self.scale;
        let local = scaled - self.scaled_centre;
        if local.abs().max_element() <= FAR {
            return Located {
                scaled,
                local,
                pulled_in: false,
            };
        }
        let half = p * 0.5 - self.centre * 0.5;
        let local = half / half.abs().max_element() * FAR;
        Located {
            scaled: local + self.scaled_centre,
            local,
            pulled_in: true,
        }
    }
}

/// The distance of two points however large their coordinates; infinite only if it cannot be represented.
pub(super) fn distance(a: DVec3, b: DVec3) -> f64 {
    let half = a * 0.5 - b * 0.5;
    let largest = half.abs().max_element();
    if largest > 0.0 {
        (half / largest).length() * largest * 2.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_end_up_within_one() {
        for (low, high) in [
            (0.0, 1.0),
            (1e300, 1.5e300),
            (-1e308, 1e308),
            (1e-310, 3e-310),
            (5.0, 5.0),
            (0.0, 0.0),
        ] {
            let frame = Frame::new(DVec3::splat(low), DVec3::splat(high));
            for end in [low, high] {
                let local = frame.centre_point(DVec3::splat(end));
                assert!(
                    local.is_finite() && local.abs().max_element() <= 1.0,
                    "{low} {high}: {local}"
                );
            }
        }
    }

    #[test]
    fn far_points_keep_their_direction() {
        let frame = Frame::new(DVec3::ZERO, DVec3::splat(1e-300));
        let located = frame.locate(DVec3::new(1e300, -2e300, 0.0));
        assert!(located.pulled_in && located.local.is_finite());
        assert!((located.local.y / located.local.x + 2.0).abs() < 1e-12);
    }

    #[test]
    fn distance_neither_overflows_nor_vanishes() {
        for scale in [1e-200, 1.0, 1e200] {
            let d = distance(
                DVec3::new(3.0, 0.0, 1.0) * scale,
                DVec3::new(0.0, 4.0, 1.0) * scale,
            );
            assert!((d / scale - 5.0).abs() < 1e-14);
        }
    }
}
