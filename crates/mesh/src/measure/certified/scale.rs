//! One scale for both surfaces, and how far rounding may lead astray.
//!
//! Coordinates are multiplied by a power of two so that the greatest is near 1: squares and
//! products then neither overflow nor vanish, and rounding can be stated in units of that size.
//! Scaling is exact except for numbers that become subnormal, for which [`Scale::new`] allows.

use crate::measure::frame::{exponent_above, power_of_two};
use crate::vector::DVec3;

/// Unit roundoff of double precision.
pub(super) const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Splits after which a piece is not split further. Each moves the piece by at most one rounding of its corners, and
/// long before that many it is no larger than the rounding.
pub(super) const DEEPEST: u32 = 64;

/// The allowance in an upper bound, in roundings of the greatest coordinate: the corners of a piece
/// (√3 for each of [`DEEPEST`] splits), a point of a triangle as a weighted sum (at most 11), the
/// difference and length of two points (at most 16), and as much again.
const POINT_ROUNDINGS: f64 = 320.0;

/// Relative to the size of the surface searched, how far the distance that a search returns may be
/// from the truth. The worst are points above the inside of a sliver: with the least sine that
/// [`closest_to_origin`](crate::geometry::closest_to_origin) trusts, 3e-4, the direction of its
/// normal is known to 8 / 3e-4 roundings, and its plane at the projection of the point to that
/// share of its size, 3e-12; 2^-36 is five times that.
const SEARCH: f64 = 1.0 / (1u64 << 36) as f64;

/// The common scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// From the surfaces' unit to the common one.
    up: f64,
    /// And back.
    down: f64,
    /// Greatest coordinate, scaled.
    pub(super) magnitude: f64,
    /// How far points and the distances of two points may be off.
    pub(super) slack: f64,
    /// How far the distance that a search returns may be off.
    pub(super) search_slack: f64,
}

impl Scale {
    /// The scale of surfaces whose coordinates are at most `magnitude`; the surfaces' longest box side is `extent`.
    pub(crate) fn new(magnitude: f64, extent: f64) -> Self {
        // Both powers of two must be normal numbers; the rest to the ends of the range does no
        // harm.
        let exponent = if magnitude > 0.0 {
            exponent_above(magnitude).clamp(-1000, 1000)
        } else {
            0
        };
        let (up, down) = (power_of_two(-exponent), power_of_two(exponent));
        let magnitude = magnitude * up;
        // Two subnormal roundings a coordinate, there and back, in the common unit.
        let vanishing = 8.0 * power_of_two(-1074) * up.max(1.0);
        let slack = POINT_ROUNDINGS * ROUNDOFF * magnitude + vanishing;
        // A box of the largest numbers is not longer than four times their magnitude, whatever its length overflowed to.
        let extent = (extent * up).min(4.0 * magnitude);
        Self {
            up,
            down,
            magnitude,
            slack,
            search_slack: slack + SEARCH * extent,
        }
    }

    /// A point in the common unit.
    #[inline]
    pub(super) fn point(&self, p: DVec3) -> DVec3 {
        p * self.up
    }

    /// A point in the surfaces' unit.
    #[inline]
    pub(super) fn back(&self, p: DVec3) -> DVec3 {
        p * self.down
    }

    /// A length in the common unit.
    #[inline]
    pub(super) fn length(&self, length: f64) -> f64 {
        length * self.up
    }

    /// A length in the surfaces' unit.
    #[inline]
    pub(super) fn length_back(&self, length: f64) -> f64 {
        length * self.down
    }
}
