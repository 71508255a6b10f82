//! How much the reproduction refines and measures: the whole, and a quick version for a first look.

use serde::Serialize;

/// Angles, steps and sample counts.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Settings {
    /// Cone angles of Table 1, in degrees.
    pub(super) angles_degrees: &'static [f64],
    /// Steps of the adaptive methods in Table 1.
    pub(super) steps: usize,
    /// Angle of the tables on drift and seams, in degrees.
    pub(super) extra_angle_degrees: f64,
    /// Greatest number of steps in the table on drift.
    pub(super) drift_steps: usize,
    /// Samples on each surface, besides its vertices.
    pub(super) samples: usize,
    /// A limit surface is represented by the finest uniform level that has at most so many triangles.
    pub(super) reference_triangles: usize,
    /// Side of the pictures, in pixels.
    pub(super) picture_side: u32,
}

impl Settings {
    /// The paper's table needs a threshold and a number of steps that it does not print: three angles and
    /// three steps, where the methods differ. References of up to a million triangles keep all of it under
    /// two minutes on two cores.
    const FULL: Self = Self {
        angles_degrees: &[5.0, 10.0, 20.0],
        steps: 3,
        extra_angle_degrees: 10.0,
        drift_steps: 4,
        samples: 200_000,
        reference_triangles: 1_100_000,
        picture_side: 840,
    };

    /// The same models and figures, coarser numbers.
    const QUICK: Self = Self {
        angles_degrees: &[10.0],
        steps: 3,
        extra_angle_degrees: 10.0,
        drift_steps: 3,
        samples: 20_000,
        reference_triangles: 200_000,
        picture_side: 320,
    };

    pub(super) fn new(quick: bool) -> Self {
        if quick { Self::QUICK } else { Self::FULL }
    }

    /// The uniform level that stands for the limit surface of a control mesh with that many faces: one more
    /// than the deepest surface that Table 1 measures, and more while the triangles allow.
    pub(super) fn reference_level(&self, faces: usize) -> usize {
        let mut level = self.steps + 1;
        while faces << (2 * (level + 1)) <= self.reference_triangles {
            level += 1;
        }
        level
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_keep_to_their_budget_and_are_finer_than_what_is_measured() {
        for faces in [4, 142, 480, 1000, 3192, 5000] {
            let level = Settings::FULL.reference_level(faces);
            let triangles = faces << (2 * level);
            assert!(level > Settings::FULL.steps);
            assert!(
                level == Settings::FULL.steps + 1
                    || triangles <= Settings::FULL.reference_triangles
            );
            assert!(4 * triangles > Settings::FULL.reference_triangles);
        }
    }
}
