//! Points of new triangles against the surface around them: the direction from the mesh to the surface.
//!
//! The surface near a sample is its tangent plane there ([`Reference::distance`]); of the samples around, the nearest one
//! speaks for a point.

use glam::{Vec3, Vec4};

use super::reference::Reference;
use crate::vector::DVec3;

/// Points that are searched for together, one in each lane.
const LANES: usize = 4;

/// FineSamples of the surface, and the points to be measured.
#[derive(Default)]
pub(super) struct BackwardProbes {
    origin: DVec3,
    sites: Vec<(u32, DVec3)>,
    /// The positions relative to the first one; single precision is enough to find the nearest.
    near: Vec<Vec3>,
    points: Vec<DVec3>,
}

impl BackwardProbes {
    /// Drops all samples.
    #[inline]
    pub(super) fn forget(&mut self) {
        self.near.clear();
        self.sites.clear();
    }

    /// Whether there are no samples.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.sites.is_empty()
    }

    /// Takes the samples of the surface around: fine vertices and their positions.
    pub(super) fn surround(&mut self, sites: impl Iterator<Item = (u32, DVec3)>) {
        self.sites.extend(sites);
        let origin = self.sites.first().map_or(DVec3::ZERO, |&(_, p)| p);
        self.origin = origin;
        self.near
            .extend(self.sites.iter().map(|&(_, p)| (p - origin).as_vec3()));
    }

    /// Adds a point to be measured.
    #[inline]
    pub(super) fn add(&mut self, point: DVec3) {
        self.points.push(point);
    }

    /// The greatest distance of the points from the surface at their nearest samples; drops the points.
    pub(super) fn measure(&mut self, reference: &Reference<'_>) -> f64 {
        let mut error = 0.0f64;
        for points in self.points.chunks(LANES) {
            let nearest = self.nearest_sites(points);
            for (&point, i) in points.iter().zip(nearest) {
                let (v, p) = self.sites[i];
                error = error.max(reference.distance(point, v, p));
            }
        }
        self.points.clear();
        error
    }

    #[inline]
    fn nearest_sites(&self, points: &[DVec3]) -> [usize; LANES] {
        let lanes: [Vec3; LANES] =
            core::array::from_fn(|i| (points[i.min(points.len() - 1)] - self.origin).as_vec3());
        let [x, y, z] = [0, 1, 2].map(|axis| Vec4::from_array(lanes.map(|p| p[axis])));
        let mut least = Vec4::INFINITY;
        // Places as floating-point numbers, since all lanes are chosen together: exact below 2^24.
        let mut which = Vec4::ZERO;
        for (i, near) in self.near.iter().enumerate() {
            let (dx, dy, dz) = (x - near.x, y - near.y, z - near.z);
            let squared = dx * dx + dy * dy + dz * dz;
            which = Vec4::select(squared.cmplt(least), Vec4::splat(i as f32), which);
            least = least.min(squared);
        }
        which.to_array().map(|i| i as usize)
    }
}
