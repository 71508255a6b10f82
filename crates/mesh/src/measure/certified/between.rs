//! The bound for a piece that lies between two triangles of the other surface: over a gap or a slot, between ribs.
//!
//! Let t be a piece, k and l two triangles. A line that meets two sides of t divides it into two convex parts. The
//! distance to a convex set is convex, so no point of the one part is farther from k than its corners are, and no point
//! of the other part farther from l. Here the parts' corners are those of t, each with the nearer of k and l, and the
//! points on two sides of t that are as far from k as from l. Where no third triangle is nearer to them these corners
//! are as far from the surface as the bound says: it is attained, however large t is. So a greatest distance that is
//! taken on a whole line takes no pieces as small as the gap.
//!
//! *Rounding.* The points on the sides are off them by less than one split of t would move them, for which
//! [`super::scale::Scale`] has room.

use super::piece::Worker;
use crate::vector::DVec3;

/// Steps towards the point of a side that is as far from the one triangle as from the other: by
/// false position, each leaves about a tenth of the interval.
const STEPS: usize = 40;

/// A point, and its distances to both triangles.
#[derive(Clone, Copy)]
struct Point {
    at: DVec3,
    distances: [f64; 2],
}

impl Point {
    /// How much farther the first triangle is than the second.
    fn difference(&self) -> f64 {
        self.distances[0] - self.distances[1]
    }

    fn nearer(&self) -> f64 {
        self.distances[0].min(self.distances[1])
    }

    fn farther(&self) -> f64 {
        self.distances[0].max(self.distances[1])
    }
}

impl Worker<'_, '_, '_> {
    /// The least bound of a piece by any two of some triangles, or the first that is at most `goal`; infinite where there is
    /// none near it. Where that is more than `goal`, the points on its sides count as samples.
    pub(super) fn between(&mut self, t: [DVec3; 3], faces: &[u32], goal: f64) -> f64 {
        let is_new = |i: usize| !faces[..i].contains(&faces[i]);
        let pairs = (0..faces.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
        let mut best = f64::INFINITY;
        for pair in pairs.filter(|pair| pair.iter().all(|&i| is_new(i))) {
            if best > goal {
                best = best.min(self.between_two(t, pair.map(|i| faces[i]), goal));
            }
        }
        best
    }

    fn between_two(&mut self, t: [DVec3; 3], faces: [u32; 2], goal: f64) -> f64 {
        let corners = t.map(|at| self.near_both(at, faces));
        let at_corners = corners.iter().map(Point::nearer).fold(0.0, f64::max);
        let is_first = corners.map(|corner| corner.difference() <= 0.0);
        let alone = (0..3).find(|&i| is_first[(i + 1) % 3] == is_first[(i + 2) % 3]);
        let Some(alone) = alone.filter(|&i| is_first[i] != is_first[(i + 1) % 3]) else {
            return f64::INFINITY;
        };
        if at_corners > goal {
            return f64::INFINITY;
        }
        let [one, two] =
            [1, 2].map(|step| self.even([corners[alone], corners[(alone + step) % 3]], faces));
        let bound = at_corners.max(one.farther()).max(two.farther());
        if bound > goal {
            self.sample(one.at, faces[0]);
            self.sample(two.at, faces[0]);
        }
        bound
    }

    fn near_both(&mut self, at: DVec3, faces: [u32; 2]) -> Point {
        self.steps += 2;
        Point {
            at,
            distances: faces.map(|face| self.target.distance_to(at, face)),
        }
    }

    /// The point between two, of which one is nearer to each triangle, that is as far from both.
    fn even(&mut self, [from, to]: [Point; 2], faces: [u32; 2]) -> Point {
        let (mut low, mut high) = (0.0, 1.0);
        let (mut at_low, mut at_high) = (from.difference(), to.difference());
        let mut best = if from.farther() <= to.farther() {
            from
        } else {
            to
        };
        for _ in 0..STEPS {
            if best.difference().abs() <= self.target.scale.slack {
                break;
            }
            let guess = low - at_low * (high - low) / (at_high - at_low);
            let share = if guess > low && guess < high {
                guess
            } else {
                0.5 * (low + high)
            };
            let point = self.near_both(from.at.lerp(to.at, share), faces);
            if point.farther() < best.farther() {
                best = point;
            }
            let difference = point.difference();
            // The end that stays counts half from then on (the Illinois rule), or it would never
            // move.
            if (difference > 0.0) == (at_low > 0.0) {
                (low, at_low, at_high) = (share, difference, 0.5 * at_high);
            } else {
                (high, at_high, at_low) = (share, difference, 0.5 * at_low);
            }
        }
        best
    }
}
