//! Coordinates in which a surface is about as large as 1, so that squares of lengths neither vanish nor overflow.

use super::box_tree::Bounds;
use crate::vector::{DVec3, diagonal};

/// The middle of a surface, and its size.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceFrame {
    pub middle: DVec3,
    /// Above 0 and finite.
    pub size: f64,
}

impl SurfaceFrame {
    /// The frame around a box.
    pub fn of([low, high]: Bounds) -> Self {
        let size = diagonal(0.5 * low, 0.5 * high);
        Self {
            middle: 0.5 * low + 0.5 * high,
            size: if size > 0.0 && size.is_finite() {
                size
            } else {
                1.0
            },
        }
    }

    /// A point in the frame.
    pub fn inside(&self, point: DVec3) -> DVec3 {
        (point - self.middle) / self.size
    }

    /// A length in the frame.
    pub fn length_inside(&self, length: f64) -> f64 {
        length / self.size
    }

    /// A point of the frame, outside.
    pub fn outside(&self, point: DVec3) -> DVec3 {
        self.size * point + self.middle
    }

    /// A length of the frame, outside.
    pub fn length_outside(&self, length: f64) -> f64 {
        self.size * length
    }
}
