//! A piece of the surface, by its samples, and triangles that would stand for it: how far they are from each other.
//!
//! The error is looked for in both directions: samples of the surface against the nearest triangle, and points of the
//! triangles against the surface ([`super::backward_error`]).

use super::backward_error::BackwardProbes;
use super::fine_samples::FineSamples;
use super::reference::Reference;
use super::triangle_plane::{Plane, nearest};
use crate::vector::DVec3;

/// FineSamples, triangles, and the face that each triangle would be; filled anew for each piece.
#[derive(Default)]
pub(super) struct StarRegion {
    /// Fine vertices that the faces care for.
    samples: Vec<u32>,
    points: Vec<DVec3>,
    /// Corners of the faces, which are samples of the surface too, but have no distance.
    rim: Vec<(u32, DVec3)>,
    planes: Vec<Plane>,
    faces: Vec<u32>,
    probes: BackwardProbes,
    reserve: f64,
}

impl StarRegion {
    /// Starts anew.
    pub(super) fn clear(&mut self) {
        self.samples.clear();
        self.points.clear();
        self.rim.clear();
        self.probes.forget();
        self.reserve = 0.0;
    }

    /// Adds a sample.
    #[inline]
    pub(super) fn add_sample(&mut self, sample: u32, samples: &FineSamples) {
        self.samples.push(sample);
        self.points.push(samples.position(sample));
        self.reserve = self.reserve.max(samples.reserve_at(sample));
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
        self.reserve = self.reserve.max(samples.reserve_at(vertex));
    }

    /// What is to be added to estimates here: the greatest reserve of the samples and corners.
    #[inline]
    pub(super) fn reserve(&self) -> f64 {
        self.reserve
    }

    /// Number of samples.
    #[inline]
    pub(super) fn sample_count(&self) -> usize {
        self.points.len()
    }

    /// Forgets the triangles.
    #[inline]
    pub(super) fn clear_triangles(&mut self) {
        self.planes.clear();
        self.faces.clear();
    }

    /// Adds a triangle and the face that it would be.
    #[inline]
    pub(super) fn add_triangle(&mut self, plane: Plane, face: u32) {
        self.planes.push(plane);
        self.faces.push(face);
    }

    /// The triangles.
    #[inline]
    pub(super) fn planes(&self) -> &[Plane] {
        &self.planes
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

    /// Has [`Self::backward_error`] look at an edge of the triangles too, at its quarters.
    #[inline]
    pub(super) fn probe_edge(&mut self, a: DVec3, b: DVec3) {
        for t in [0.25, 0.5, 0.75] {
            self.probes.add(a + (b - a) * t);
        }
    }

    /// The greatest distance from the surface of the triangles' centroids and of the edges given to [`Self::probe_edge`],
    /// which are forgotten.
    pub(super) fn backward_error(&mut self, ground: &Reference<'_>) -> f64 {
        if self.probes.is_empty() {
            let samples = self.samples.iter().copied().zip(self.points.iter().copied());
            self.probes.surround(samples.chain(self.rim.iter().copied()));
        }
        for plane in &self.planes {
            self.probes.add(plane.centroid());
        }
        self.probes.measure(ground)
    }

    /// Gives the samples to the triangles nearest to them, which are there now; `cleared` are the faces that had them.
    pub(super) fn hand_over(&self, samples: &mut FineSamples, cleared: impl Iterator<Item = u32>) {
        cleared.for_each(|face| samples.clear(face));
        for (&sample, &point) in self.samples.iter().zip(&self.points) {
            let (distance, i) = nearest(&self.planes, point);
            samples.give(self.faces[i], sample, distance);
        }
    }
}
