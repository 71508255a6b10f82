//! A piece of the surface, by its samples, and triangles that would replace it: their distance from
//! each other.
//!
//! The error is looked for in both directions: samples of the surface against the nearest triangle, and points of the
//! triangles against the surface ([`super::backward_error`]).

use super::backward_error::BackwardProbes;
use super::fine_samples::FineSamples;
use super::reference::Reference;
use super::triangle_plane::{Plane, nearest};
use crate::vector::DVec3;

/// A triangle that would be there, and where.
#[derive(Clone, Copy)]
pub(super) struct NewFace {
    /// Fine vertices.
    pub(super) corners: [u32; 3],
    /// Its number in the mesh.
    pub(super) face: u32,
}

/// Samples, triangles, and the face that each triangle would be; filled anew for each piece.
#[derive(Default)]
pub(super) struct StarRegion {
    /// Fine vertices that the faces care for.
    samples: Vec<u32>,
    points: Vec<DVec3>,
    /// Corners of the faces, which are samples of the surface too, but have no distance.
    rim: Vec<(u32, DVec3)>,
    planes: Vec<Plane>,
    faces: Vec<NewFace>,
    /// For each sample the nearest triangle and a distance that it is within of it.
    assigned: Vec<(usize, f64)>,
    probes: BackwardProbes,
}

impl StarRegion {
    /// Starts anew.
    pub(super) fn clear(&mut self) {
        self.samples.clear();
        self.points.clear();
        self.rim.clear();
        self.probes.forget();
    }

    /// Adds a sample.
    #[inline]
    pub(super) fn add_sample(&mut self, sample: u32, samples: &FineSamples) {
        self.samples.push(sample);
        self.points.push(samples.position(sample));
    }

    /// Adds the samples of a face.
    #[inline]
    pub(super) fn add_face(&mut self, face: u32, samples: &FineSamples) {
        for sample in samples.of(face) {
            self.add_sample(sample, samples);
        }
    }

    /// Adds a corner.
    #[inline]
    pub(super) fn add_corner(&mut self, vertex: u32, samples: &FineSamples) {
        self.rim.push((vertex, samples.position(vertex)));
    }

    /// Number of samples.
    #[inline]
    pub(super) fn sample_count(&self) -> usize {
        self.points.len()
    }

    /// The samples.
    #[inline]
    pub(super) fn samples(&self) -> &[u32] {
        &self.samples
    }

    /// Forgets the triangles.
    #[inline]
    pub(super) fn clear_triangles(&mut self) {
        self.planes.clear();
        self.faces.clear();
    }

    /// Adds a triangle and the face that it would be.
    #[inline]
    pub(super) fn add_triangle(&mut self, plane: Plane, corners: [u32; 3], face: u32) {
        self.planes.push(plane);
        self.faces.push(NewFace { corners, face });
    }

    /// The triangles.
    #[inline]
    pub(super) fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Their corners and numbers.
    #[inline]
    pub(super) fn faces(&self) -> &[NewFace] {
        &self.faces
    }

    /// The greatest distance of a sample from the triangles, where it is greater than `error`; `None` if that is not below
    /// `bound`.
    #[inline]
    pub(super) fn forward_error(&self, mut error: f64, bound: f64) -> Option<f64> {
        for &point in &self.points {
            if error >= bound {
                return None;
            }
            error = error.max(nearest(&self.planes, point).0);
        }
        (error < bound).then_some(error)
    }

    /// Lets [`Self::backward_error`] sample an edge of the triangles too, at its quarters.
    #[inline]
    pub(super) fn probe_edge(&mut self, a: DVec3, b: DVec3) {
        for t in [0.25, 0.5, 0.75] {
            self.probes.add(a + (b - a) * t);
        }
    }

    /// The greatest distance from the surface of the triangles' centroids and of the edges given to [`Self::probe_edge`],
    /// which are forgotten.
    pub(super) fn backward_error(&mut self, reference: &Reference<'_>) -> f64 {
        if self.probes.is_empty() {
            let samples = self
                .samples
                .iter()
                .copied()
                .zip(self.points.iter().copied());
            self.probes
                .surround(samples.chain(self.rim.iter().copied()));
        }
        for plane in &self.planes {
            self.probes.add(plane.centroid());
        }
        self.probes.measure(reference)
    }

    /// Finds the nearest triangle of each sample.
    pub(super) fn assign(&mut self) {
        self.assigned.clear();
        let planes = &self.planes;
        self.assigned.extend(self.points.iter().map(|&point| {
            let i = nearest(planes, point).1;
            (i, planes[i].distance(point))
        }));
    }

    /// For each sample the place of the nearest triangle and an upper bound, within rounding, of
    /// its distance, as found by [`Self::assign`].
    #[inline]
    pub(super) fn assigned(&self) -> &[(usize, f64)] {
        &self.assigned
    }

    /// Gives the samples to the triangles that they were assigned to, which are there now; `cleared` are the faces that had
    /// them.
    pub(super) fn hand_over(&self, samples: &mut FineSamples, cleared: impl Iterator<Item = u32>) {
        cleared.for_each(|face| samples.clear(face));
        for (&sample, &(i, distance)) in self.samples.iter().zip(&self.assigned) {
            samples.give(self.faces[i].face, sample, distance);
        }
    }
}
