//! Proof that a coarse mesh is within the tolerance, and what to do where it is not.
//!
//! Collapsing looks at samples. What counts in the end is the bound of [`certified_hausdorff`]: where it exceeds the
//! tolerance, the places at fault are looked for, and what the estimates there were short of is held in reserve around
//! the fine vertices in the next attempt.
//!
//! [`certified_hausdorff`]: crate::measure::certified_hausdorff

use super::edge_collapse::Collapser;
use crate::measure::{Bvh, CertifiedHausdorff, CertifiedOptions, MeasureError, certified_hausdorff_between};
use crate::mesh::{Mesh, Triangles};
use crate::parallel;
use crate::vector::vector;

/// Width of the certified interval as a share of the distance: what is lost to it costs as many more triangles.
const GAP: f64 = 0.01;

/// Places from this share of the tolerance on are held to be at fault too: points do not meet the farthest one.
const SUSPECT: f64 = 0.98;

/// What is reserved at a place at fault beyond what its error exceeds the tolerance by, as a share of the tolerance. It
/// doubles with every other attempt, until nothing goes any more where nothing can.
const MARGIN: f64 = 0.1;

/// Points of a triangle that are measured, by barycentric coordinates: the centroid, quarters of the sides, and what is
/// halfway between the centroid and the corners.
const POINTS: [[f64; 3]; 13] = [
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
    [0.75, 0.25, 0.0],
    [0.25, 0.75, 0.0],
    [0.0, 0.75, 0.25],
    [0.0, 0.25, 0.75],
    [0.25, 0.0, 0.75],
    [0.75, 0.0, 0.25],
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
];

/// The fine mesh, ready to be measured against.
pub(super) struct Certifier<'a> {
    fine: Bvh<'a>,
    rounding: f64,
}

impl<'a> Certifier<'a> {
    /// `rounding` is what two surfaces may be apart at least without anybody caring.
    pub(super) fn new(fine: &'a Mesh, rounding: f64) -> Result<Self, MeasureError> {
        Ok(Self { fine: Bvh::new(fine.as_triangles())?, rounding })
    }

    /// Bounds the distance of a mesh to the fine one.
    pub(super) fn certify(&self, coarse: &Bvh<'_>) -> Result<CertifiedHausdorff, MeasureError> {
        let options = CertifiedOptions::default().gap(Some(self.rounding)).relative_gap(GAP);
        certified_hausdorff_between(coarse, &self.fine, &options)
    }

    /// Raises the reserves of the fine vertices around the places of the collapser's mesh that are too far away.
    pub(super) fn raise_reserves(
        &self,
        coarse: &Bvh<'_>,
        proof: &CertifiedHausdorff,
        (attempt, tolerance): (u32, f64),
        collapser: &Collapser<'_>,
        reserves: &mut [f64],
    ) {
        let mut errors = self.errors(coarse.surface());
        for (place, distance) in
            [(proof.forward.at, proof.forward.upper), (proof.backward.to, proof.backward.upper)]
        {
            let error = &mut errors[coarse.closest(place).face as usize];
            *error = error.max(distance);
        }
        let before = reserves.to_vec();
        for (face, error) in collapser.surface.faces().zip(errors) {
            if error <= SUSPECT * tolerance {
                continue;
            }
            let more = (error - tolerance).max(0.0) + MARGIN * f64::from(1u32 << (attempt / 2)) * tolerance;
            for v in collapser.surface.corners(face).into_iter().chain(collapser.samples.of(face)) {
                let reserve = &mut reserves[v as usize];
                *reserve = reserve.max(before[v as usize] + more);
            }
        }
    }

    /// For each triangle the greatest distance of some of its points from the fine mesh.
    fn errors(&self, coarse: Triangles<'_>) -> Vec<f64> {
        parallel::map(coarse.triangles.len(), |face| {
            let [a, b, c] = coarse.corners(face).map(vector);
            let mut guess = u32::MAX;
            let distances = POINTS.map(|[u, v, w]| {
                let closest = self.fine.closest_from((a * u + b * v + c * w).to_array(), guess);
                guess = closest.face;
                closest.distance
            });
            distances.into_iter().fold(0.0, f64::max)
        })
    }
}
