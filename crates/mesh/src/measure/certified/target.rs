//! The surface that distances are measured to, in the common scale: its triangles, their neighbours, nearest points.

use super::scale::Scale;
use crate::geometry::{NONE, closest_to_origin};
use crate::measure::bvh::Bvh;
use crate::vector::{DVec3, vector};

/// A surface to which distances are measured.
pub(crate) struct Target<'s, 'a> {
    pub(super) bvh: &'s Bvh<'a>,
    /// For each side that exactly two triangles share the other one's side, [`NONE`] for others.
    pub(super) twins: Vec<u32>,
    pub(super) scale: Scale,
}

/// The nearest triangle to a point, as a search gives it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub(super) distance: f64,
    pub(super) face: u32,
    /// Nodes of the hierarchy visited for it.
    pub(super) visited: u32,
}

impl Target<'_, '_> {
    /// The side of the other triangle at this side, if there is exactly one other. Sides are numbered 3 · triangle + corner.
    #[inline]
    pub(super) fn across(&self, side: u32) -> Option<u32> {
        Some(self.twins[side as usize]).filter(|&other| other != NONE)
    }

    #[inline]
    pub(super) fn vertices(&self, face: u32) -> [u32; 3] {
        self.bvh.surface().triangles[face as usize]
    }

    #[inline]
    pub(super) fn vertex(&self, vertex: u32) -> DVec3 {
        self.scale
            .point(vector(self.bvh.surface().positions[vertex as usize]))
    }

    #[inline]
    pub(super) fn triangle(&self, face: u32) -> [DVec3; 3] {
        self.vertices(face).map(|v| self.vertex(v))
    }

    /// The nearest triangle and its distance, within [`Scale::search_slack`] of the truth.
    #[inline]
    pub(super) fn nearest(&self, p: DVec3, guess: u32) -> Near {
        let (found, visited) = self
            .bvh
            .closest_counted(self.scale.back(p).to_array(), Some(guess));
        Near {
            distance: self.scale.length(found.distance),
            face: found.face,
            visited,
        }
    }

    /// The distance of a point to some point of a triangle, the nearest within rounding: within
    /// [`Scale::slack`] never less than the distance to the triangle, whatever its shape.
    #[inline]
    pub(crate) fn distance_to(&self, p: DVec3, face: u32) -> f64 {
        let [a, b, c] = self.triangle(face);
        let [u, v, w] = closest_to_origin(a - p, b - p, c - p).weights;
        (a * u + b * v + c * w).distance(p)
    }
}
