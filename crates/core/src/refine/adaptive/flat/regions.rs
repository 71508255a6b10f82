//! The flat regions of a control mesh, and what is known of each.

use super::super::demands::Demands;
use crate::mesh::NONE;
use crate::vector::DVec3;

/// A plane through a point.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Plane {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

impl Plane {
    pub(super) fn height(&self, point: DVec3) -> f64 {
        (point - self.point).dot(self.normal)
    }
}

/// The flat regions of a control mesh.
#[derive(Default)]
pub(in super::super) struct FlatRegions {
    /// By control face, its region; [`NONE`] where it is not flat. Empty without regions.
    pub(super) of_face: Vec<u32>,
    /// By region, its faces, ascending, and its plane.
    pub(super) regions: Vec<(Vec<u32>, Plane)>,
    /// The control faces over which there may be strips.
    pub(super) straight: Vec<u32>,
    /// How far the surface and its triangles are off the planes at most.
    pub(super) off_planes: f64,
    /// Whether regions are what their rims enclose, also where the surface folds.
    pub(super) unfolds: bool,
    /// By region, whether its triangles are judged by the rim alone.
    pub(super) by_rim: Vec<bool>,
    /// By region, whether what its limit curves enclose is its surface, or approximates it where that folds; none unless that is asked for.
    pub(super) is_enclosed: Vec<bool>,
    /// By region, the first of those with which it is judged together.
    pub(super) joined: Vec<u32>,
    /// How far beyond its rim the surface over such a region may reach for all that was proven.
    pub(super) beyond_rims: f64,
    /// By control face, whether it is part of a region or there may be strips over it; empty where there are neither.
    pub(super) is_merged: Vec<bool>,
    /// So many leaves of such a face count as one while faces are divided.
    pub(super) weight: usize,
}

impl FlatRegions {
    /// Whether a face is part of a region that is judged by its rim alone.
    pub(in super::super) fn is_its_rim(&self, face: u32) -> bool {
        self.region(face)
            .is_some_and(|region| self.by_rim[region as usize])
    }

    /// Whether nothing but its rim is certainly part of the surface over a face: its region is judged by that alone, or what the rim encloses
    /// approximates it wherever that can be triangulated.
    pub(in super::super) fn is_within_rim(&self, face: u32) -> bool {
        self.is_its_rim(face)
            || self
                .region(face)
                .is_some_and(|region| self.is_enclosed[region as usize])
    }

    /// The first control faces of regions for whose surface what their rims enclose is taken, ascending.
    pub(in super::super) fn within_rims(&self, demands: &Demands) -> Vec<u32> {
        let is_taken = |&region: &u32| {
            self.is_enclosed[region as usize] && !demands.judges_by_triangles(region)
        };
        let taken = (0..self.regions.len() as u32).filter(is_taken);
        let mut first: Vec<u32> = taken
            .map(|region| self.regions[region as usize].0[0])
            .collect();
        first.sort_unstable();
        first
    }

    /// How far what is handed out may be from what was judged, at most: triangles of a region, and vertices of a straight line, are as
    /// far off as those in whose place they come, on either side.
    pub(in super::super) fn allowance(&self) -> f64 {
        3.0 * self.off_planes + self.beyond_rims
    }

    /// How far the surface and its triangles may be off the planes at most.
    pub(in super::super) fn off_planes(&self) -> f64 {
        self.off_planes
    }

    /// Whether there are neither regions nor places for strips.
    pub(in super::super) fn are_none(&self) -> bool {
        self.regions.is_empty() && self.straight.is_empty()
    }

    /// Whether there may be strips, so that only the emitted triangles show how many stay.
    pub(in super::super) fn has_strips(&self) -> bool {
        !self.straight.is_empty()
    }

    /// Whether strips may be put together over a face.
    pub(in super::super) fn is_straight(&self, face: u32) -> bool {
        self.straight.binary_search(&face).is_ok()
    }

    /// Control faces that are part of regions, or over which there may be strips.
    pub(in super::super) fn merged_faces(&self) -> usize {
        self.is_merged
            .iter()
            .filter(|&&is_merged| is_merged)
            .count()
    }

    /// How many leaves of a face count as one triangle while faces are divided: of those of flat faces, and of strips, most are not going
    /// to stay.
    pub(in super::super) fn weight(&self, face: u32) -> usize {
        if self.is_merged.get(face as usize).copied().unwrap_or(false) {
            self.weight
        } else {
            1
        }
    }

    /// The region of a face.
    pub(in super::super) fn region(&self, face: u32) -> Option<u32> {
        self.of_face
            .get(face as usize)
            .copied()
            .filter(|&region| region != NONE)
    }
}
