//! The error of a triangle of the forest against the √3 limit surface: the paper's cone, and a
//! distance that is estimated.
//!
//! The surface has no pieces that are polynomials, so distances are not proven: they are those of the limits of some vertices of
//! later levels on and in a triangle, up to seven, from its plane part.

use super::Sqrt3Options;
use super::forest::{Forest, Triangle};
use crate::criterion::cone_ratio;
use crate::geometry::closest_to_origin;
use crate::vector::{DVec3, unit_normal};

/// The goals of triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goals {
    angle: Option<f64>,
    tolerance: Option<f64>,
    /// Whether distances decide which triangles are divided first, though there is no goal for
    /// them.
    by_distance: bool,
}

/// The measured errors of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// How many times over it fails: at most 1 is good enough. Without a goal on quality, its distance.
    pub(super) ratio: f64,
    /// Zero without a goal for distances.
    pub(super) distance: f64,
}

impl Goals {
    pub(super) fn of(options: &Sqrt3Options) -> Self {
        let by_distance = options.angle.is_none() && options.tolerance.is_none();
        Self {
            angle: options.angle,
            tolerance: options.tolerance,
            by_distance,
        }
    }

    /// Whether a triangle is not good enough.
    pub(super) fn fails(&self, found: &Found) -> bool {
        if self.by_distance {
            found.ratio > 0.0
        } else {
            found.ratio > 1.0
        }
    }

    /// Whether distances are estimated.
    pub(super) fn has_distances(&self) -> bool {
        self.by_distance || self.tolerance.is_some()
    }

    /// Measures a triangle.
    pub(super) fn look(&self, forest: &mut Forest<'_>, triangle: Triangle) -> Found {
        let vertices = forest.corners(triangle);
        let corners = vertices.map(|v| forest.limit(v));
        let mut found = Found {
            ratio: 0.0,
            distance: 0.0,
        };
        if let Some(angle) = self.angle {
            let normals = vertices.map(|v| forest.normal(v));
            found.ratio = cone_ratio(unit_normal(corners), normals, angle);
        }
        if self.has_distances() {
            found.distance = distance(forest, triangle, corners);
            found.ratio = found
                .ratio
                .max(found.distance / self.tolerance.unwrap_or(1.0));
        }
        found
    }
}

/// The greatest distance of the samples from the triangle.
fn distance(forest: &mut Forest<'_>, triangle: Triangle, corners: [DVec3; 3]) -> f64 {
    let mut samples = Vec::with_capacity(9);
    forest.samples(triangle, &mut samples);
    let squared = samples.into_iter().map(|v| {
        let from = forest.limit(v);
        let [a, b, c] = corners.map(|corner| corner - from);
        closest_to_origin(a, b, c).squared
    });
    squared.fold(0.0, f64::max).sqrt()
}
