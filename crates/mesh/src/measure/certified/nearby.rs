//! Bounds of single triangles' distances to a mesh, with a given starting point on it.

use super::piece::{Piece, Sample, Worker};
use super::scale::Scale;
use super::target::Target;
use super::{GREATEST, MeasureError};
use crate::measure::bvh::Bvh;
use crate::mesh::Topology;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Pieces that a triangle is cut into at most: one that lies within the distance rarely takes more than a few.
const MOST_PIECES: usize = 48;

impl<'s, 'a> Target<'s, 'a> {
    /// The surface of a mesh, whose hierarchy and topology are at hand, for triangles no larger than itself.
    ///
    /// # Errors
    /// A coordinate that is too large.
    pub(crate) fn of_mesh(bvh: &'s Bvh<'a>, topology: &Topology) -> Result<Self, MeasureError> {
        let bounds = bvh.bounding_box();
        let value = bounds
            .as_flattened()
            .iter()
            .fold(0.0f64, |greatest, x| greatest.max(x.abs()));
        if value > GREATEST {
            return Err(MeasureError::TooLarge {
                which: "reference",
                value,
                greatest: GREATEST,
            });
        }
        let [low, high] = bounds.map(vector);
        let scale = Scale::new(value, (high - low).max_element());
        Ok(Self {
            bvh,
            twins: topology.raw_twins().to_vec(),
            scale,
        })
    }

    /// The rounding error of measured distances of points of triangles no larger than the surface,
    /// in its unit.
    pub(crate) fn slack(&self) -> f64 {
        self.scale.length_back(self.scale.slack)
    }
}

impl<'t, 's, 'a> Worker<'t, 's, 'a> {
    /// For single triangles, by sheets of at most `limit` triangles.
    pub(crate) fn of(target: &'t Target<'s, 'a>, limit: usize) -> Self {
        Self::new(target, limit, false)
    }

    /// An upper bound of the distance of triangle `t` to the surface, infinite where none near `goal` was found with little
    /// work. `start` is a triangle of the surface below the inside of `t`, `near` are some near its corners.
    pub(crate) fn within(&mut self, t: [DVec3; 3], start: u32, near: [u32; 3], goal: f64) -> f64 {
        let scale = self.target.scale;
        let (corners, goal) = (t.map(|p| scale.point(p)), scale.length(goal));
        let normal = unit_or_zero((corners[1] - corners[0]).cross(corners[2] - corners[0]));
        if normal == DVec3::ZERO {
            return f64::INFINITY;
        }
        let covered = self
            .cover
            .bound(self.target, corners, start, normal, goal, self.limit);
        // Where the whole of it is covered there is hardly a better bound.
        if covered <= goal || (covered.is_finite() && !self.cover.is_inset()) {
            return scale.length_back(covered);
        }
        self.farthest = Sample {
            point: DVec3::ZERO,
            distance: f64::NEG_INFINITY,
        };
        let whole = Piece {
            upper: f64::INFINITY,
            corners,
            faces: near,
            depth: 0,
        };
        let (mut waiting, mut greatest) = (vec![whole], 0.0f64);
        for _ in 0..MOST_PIECES {
            let Some(piece) = waiting.pop() else {
                return scale.length_back(greatest);
            };
            greatest = greatest.max(self.split(&piece, goal, &mut waiting));
            if self.farthest.distance > goal {
                break;
            }
        }
        f64::INFINITY
    }
}
