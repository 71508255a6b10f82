//! The bounds of the leaves among their neighbours as they are emitted.

use super::emit::Emission;
use super::grow::Growth;
use crate::mesh::NONE;
use crate::vector::DVec3;

/// A slope beyond all that can be met.
const STEEP: f64 = f64::MAX;

/// The squared chord and the slope next to a triangle without a plane: they leave only the bound that needs no
/// neighbours.
const UNSETTLED: (f64, f64) = (4.0, 0.0);

impl Growth<'_> {
    /// Takes the bounds of all leaves with the angles between the emitted triangles; sets the values of those that
    /// come out above `limit`, which they were not expected to. Whether there are any.
    pub(super) fn settle(&mut self, emission: &Emission, limit: f64) -> bool {
        let mut fails = false;
        for &leaf in &emission.leaves.order {
            let scale = f64::from(self.scales[leaf as usize]);
            // What holds without neighbours holds with them.
            if self.deviations[leaf as usize].own * scale <= limit {
                continue;
            }
            let value = self.settled(emission, leaf) * scale;
            if value > limit {
                self.values[leaf as usize] = value.max(self.values[leaf as usize]);
                fails = true;
            }
        }
        fails
    }

    /// The bound of a leaf.
    pub(super) fn settled(&self, emission: &Emission, leaf: u32) -> f64 {
        let deviation = self.deviations[leaf as usize];
        // Neighbours can't help.
        if deviation.own <= deviation.height {
            return deviation.own;
        }
        let first = emission.leaves.starts[leaf as usize];
        let count = 1 + self.forest.split_edges(leaf).count_ones();
        // Edges on sharp curves count on their own.
        let open = self.forest.open_edges(leaf);
        let alone = [0, 1, 2].map(|edge| match open[edge] {
            true => self.borders(&emission.leaves, leaf, edge),
            false => [NONE; 2],
        });
        let alone = alone.as_flattened();
        let (mut squared, mut slope) = (0.0f64, STEEP);
        for triangle in first..first + count {
            let (turn, room) = self.around(emission, triangle, alone);
            squared = squared.max(turn);
            slope = slope.min(room);
        }
        deviation.bound(squared.sqrt(), slope)
    }

    /// The greatest squared chord of the angles between the planes of a triangle and its neighbours, and the greatest
    /// slope at which points may drift over them; half-edges in `alone` do not count.
    fn around(&self, emission: &Emission, triangle: u32, alone: &[u32]) -> (f64, f64) {
        let at = |vertex: u32| self.emitted(vertex);
        let own = emission.triangles[triangle as usize].map(at);
        let edges = [own[1] - own[0], own[2] - own[1], own[0] - own[2]];
        let Some((normal, area)) = plane(edges[0], edges[1]) else { return UNSETTLED };
        let lengths = edges.map(DVec3::length);
        // Half of what the angle at a corner leaves of π, at most π/2: its tangent is the cotangent of half the angle.
        let free = [0, 1, 2].map(|corner| {
            let before = (corner + 2) % 3;
            (lengths[corner] * lengths[before] - edges[corner].dot(edges[before])) / area
        });
        let (mut squared, mut slope) = (0.0f64, STEEP);
        for (edge, h) in (3 * triangle..).take(3).enumerate() {
            let twin = emission.twins[h as usize];
            if twin == NONE || alone.contains(&h) {
                continue;
            }
            let opposite = emission.triangles[twin as usize / 3][(twin as usize + 2) % 3];
            let out = at(opposite) - own[edge];
            // The neighbour runs along the edge the other way.
            let Some((other, area)) = plane(out, edges[edge]) else { return UNSETTLED };
            squared = squared.max(normal.distance_squared(other));
            // Tangents of the neighbour's angles at both ends: the lesser is that of the greater product.
            let at_start = out.dot(edges[edge]);
            let product = at_start.max(lengths[edge] * lengths[edge] - at_start);
            slope = slope.min(free[edge]).min(free[(edge + 1) % 3]).min(area / product);
        }
        (squared, slope)
    }
}

/// The unit vector at right angles to two edges, and the area of their parallelogram; `None` if that is nothing, or
/// so small or great that rounding decides it.
fn plane(a: DVec3, b: DVec3) -> Option<(DVec3, f64)> {
    let across = a.cross(b);
    let squared = across.length_squared();
    let area = squared.sqrt();
    (1e-290..1e290).contains(&squared).then(|| (across / area, area))
}
