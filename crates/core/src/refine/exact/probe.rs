//! The bounds of the leaves among their neighbours as they are emitted, and the interval for the whole mesh.

use super::emit::Emission;
use super::grow::Growth;
use super::options::ErrorBounds;
use crate::mesh::NONE;
use crate::vector::{DVec3, unit_or_zero};

impl Growth<'_> {
    /// Takes the bounds of all leaves with the angles between the emitted triangles; sets the values of those that
    /// come out greater than they were expected.
    pub(super) fn settle(&mut self, emission: &Emission) {
        let Some(scale) = self.demand.tolerance.map(|tolerance| 1.0 / tolerance) else { return };
        for &leaf in &emission.leaves.order {
            let bound = self.settled(emission, leaf) * scale;
            let value = &mut self.values[leaf as usize];
            *value = value.max(bound);
        }
    }

    /// The bound of a leaf.
    fn settled(&self, emission: &Emission, leaf: u32) -> f64 {
        let deviation = self.deviations[leaf as usize];
        if deviation.drift == 0.0 && deviation.slope == 0.0 {
            return deviation.bound(0.0, 0.0);
        }
        let first = emission.leaves.starts[leaf as usize];
        let count = 1 + self.forest.split_edges(leaf).count_ones();
        let (mut chord, mut slope) = (0.0f64, f64::INFINITY);
        for triangle in first..first + count {
            for edge in 0..3 {
                let twin = emission.twins[(3 * triangle + edge) as usize];
                if twin != NONE {
                    let (turn, room) = self.across(emission, 3 * triangle + edge, twin);
                    chord = chord.max(turn);
                    slope = slope.min(room);
                }
            }
        }
        deviation.bound(chord, slope)
    }

    /// The chord of the angle between the planes of the triangles at an edge, and the greatest slope at which points
    /// may drift from the first over the second.
    fn across(&self, emission: &Emission, h: u32, twin: u32) -> (f64, f64) {
        let own = self.turned(emission, h);
        let other = self.turned(emission, twin);
        let normal = |[a, b, c]: [DVec3; 3]| unit_or_zero(unit_or_zero(b - a).cross(unit_or_zero(c - a)));
        let chord = normal(own).distance(normal(other));
        // Angles at both ends: the neighbour's, and half of what the triangle's own leave of π.
        let cosine = |[a, b, c]: [DVec3; 3]| unit_or_zero(b - a).dot(unit_or_zero(c - a)).clamp(-1.0, 1.0);
        let at_start = |[a, b, c]: [DVec3; 3]| cosine([a, b, c]).acos();
        let at_end = |[a, b, c]: [DVec3; 3]| cosine([b, c, a]).acos();
        let free = |angle: f64| 0.5 * (core::f64::consts::PI - angle);
        let least = [at_start(other), at_end(other), free(at_start(own)), free(at_end(own))]
            .into_iter()
            .fold(core::f64::consts::FRAC_PI_2, f64::min);
        (chord, least.tan())
    }

    /// The corners of a triangle, starting at the origin of a half-edge.
    fn turned(&self, emission: &Emission, h: u32) -> [DVec3; 3] {
        let triangle = emission.triangles[(h / 3) as usize];
        [0, 1, 2].map(|i| self.points[triangle[((h % 3 + i) % 3) as usize] as usize].position)
    }

    /// The certified interval.
    pub(super) fn probe(&self, emission: &Emission) -> ErrorBounds {
        let upper =
            emission.leaves.order.iter().map(|&leaf| self.settled(emission, leaf)).fold(0.0, f64::max);
        ErrorBounds { lower: 0.0, upper, at: [0.0; 3] }
    }
}
