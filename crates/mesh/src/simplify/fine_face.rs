//! The distance of a fine face to the triangles below it, bounded from above.
//!
//! The distance to a triangle is a convex function, so that a piece of the face is within a distance of it if the piece's
//! corners are. A piece whose corners are near to different triangles is cut: where a side crosses the edge between
//! two of them, or in the middle of a side if there is no such edge. As only distances of points to points of triangles
//! are taken, the bound holds whatever the choices are; these only decide how fast it is found, and whether at all.

use crate::geometry::{NONE, closest_to_origin};
use crate::vector::DVec3;

/// Cuts of a face at most. One over an edge takes two, and most of those over a corner's fan less than ten.
const MOST_CUTS: u32 = 40;

/// Triangles at most; their sets are bits.
const MOST: usize = u64::BITS as usize;

/// A triangle of the mesh.
struct Candidate {
    face: u32,
    corners: [u32; 3],
    positions: [DVec3; 3],
    /// The triangles with which it shares an edge, as bits.
    adjacent: u64,
}

/// A corner of a piece.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    at: DVec3,
    /// The triangles that it is known to be near enough to.
    near: u64,
    /// One of them, or a number too large, and a bound of the distance to it.
    known: (usize, f64),
    /// The vertex of the mesh that it is, or [`NONE`].
    vertex: u32,
    /// Whether all triangles have been measured.
    complete: bool,
}

impl Corner {
    /// A point within `distance` of a triangle.
    #[inline]
    pub(super) fn near(at: DVec3, triangle: usize, distance: f64) -> Self {
        let near = if triangle < MOST { 1 << triangle } else { 0 };
        Self {
            at,
            near,
            known: (triangle, distance),
            vertex: NONE,
            complete: false,
        }
    }

    /// A vertex of the mesh, near to the triangles at it.
    #[inline]
    pub(super) fn vertex(at: DVec3, vertex: u32) -> Self {
        Self {
            at,
            near: 0,
            known: (MOST, 0.0),
            vertex,
            complete: false,
        }
    }
}

/// The triangles that a face may be near to, and a face on its way.
#[derive(Default)]
pub(super) struct Candidates {
    triangles: Vec<Candidate>,
    goal: f64,
    cuts: u32,
    used: u64,
}

impl Candidates {
    /// Forgets all triangles.
    pub(super) fn clear(&mut self) {
        self.triangles.clear();
    }

    /// Number of triangles.
    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The number in the mesh of the triangle at `place`.
    pub(super) fn face(&self, place: usize) -> u32 {
        self.triangles[place].face
    }

    /// Adds a triangle, if it is not there and there is room, and gives its place.
    pub(super) fn add(&mut self, face: u32, corners: [u32; 3], positions: [DVec3; 3]) -> usize {
        if let Some(place) = self
            .triangles
            .iter()
            .position(|candidate| candidate.face == face)
        {
            return place;
        }
        let place = self.triangles.len();
        if place < MOST {
            let mut adjacent = 0;
            for (other, triangle) in self.triangles.iter_mut().enumerate() {
                let shared = corners
                    .iter()
                    .filter(|corner| triangle.corners.contains(corner))
                    .count();
                if shared == 2 {
                    adjacent |= 1 << other;
                    triangle.adjacent |= 1 << place;
                }
            }
            self.triangles.push(Candidate {
                face,
                corners,
                positions,
                adjacent,
            });
        }
        place
    }

    /// The triangles at a vertex of the mesh.
    fn around(&self, vertex: u32) -> u64 {
        let at = |(place, triangle): (usize, &Candidate)| {
            u64::from(triangle.corners.contains(&vertex)) << place
        };
        self.triangles
            .iter()
            .enumerate()
            .map(at)
            .fold(0, |near, bit| near | bit)
    }

    /// The corner at a sample near the triangle at a place.
    pub(super) fn sample(&self, at: DVec3, place: usize) -> Corner {
        let distance = self
            .triangles
            .get(place)
            .map_or(f64::INFINITY, |t| distance(at, t.positions));
        Corner::near(at, place, distance)
    }

    /// A bound of the distance of the face with these corners from the triangles, and the triangles
    /// used, as bits; `None` if it is not found to be within `goal`.
    pub(super) fn bound(&mut self, mut corners: [Corner; 3], goal: f64) -> Option<(f64, u64)> {
        (self.goal, self.cuts, self.used) = (goal, MOST_CUTS, 0);
        for corner in &mut corners {
            if corner.vertex != NONE {
                corner.near = self.around(corner.vertex);
            } else if !is_within(corner.known.1, goal) {
                corner.near = 0;
            }
        }
        let bound = self.piece(corners)?;
        Some((bound, self.used))
    }

    /// The distance of a corner from one of the triangles.
    #[inline]
    fn distance(&self, corner: &Corner, place: usize) -> f64 {
        let triangle = &self.triangles[place];
        if corner.known.0 == place {
            corner.known.1
        } else if corner.vertex != NONE && triangle.corners.contains(&corner.vertex) {
            0.0
        } else {
            distance(corner.at, triangle.positions)
        }
    }

    fn piece(&mut self, mut corners: [Corner; 3]) -> Option<f64> {
        loop {
            let common = corners[0].near & corners[1].near & corners[2].near;
            if common != 0 {
                let place = common.trailing_zeros() as usize;
                self.used |= 1 << place;
                return Some(
                    corners
                        .iter()
                        .map(|c| self.distance(c, place))
                        .fold(0.0, f64::max),
                );
            }
            // Around a vertex, small pieces may be cut over and over, each corner known to be near to two triangles only.
            if self.cuts <= MOST_CUTS / 2 && !corners.iter().all(|corner| corner.complete) {
                for corner in &mut corners {
                    self.complete(corner);
                }
                continue;
            }
            self.cuts = self.cuts.checked_sub(1)?;
            let (i, apart) = self.side_to_cut(&corners);
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let crossing = if apart {
                self.crossing(&mut corners, i, j)
                    .or_else(|| self.crossing(&mut corners, j, i))
            } else {
                None
            };
            let cut = match crossing {
                Some(Crossing::At(cut)) => cut,
                Some(Crossing::Corner) => continue,
                None if corners.iter().all(|corner| corner.complete) => {
                    self.middle(&corners[i], &corners[j])?
                }
                None => {
                    for corner in &mut corners {
                        self.complete(corner);
                    }
                    continue;
                }
            };
            let [p, q, r] = [corners[i], corners[j], corners[k]];
            let first = self.piece([p, cut, r])?;
            return Some(first.max(self.piece([cut, q, r])?));
        }
    }

    /// The side to cut, by the corner that it begins at: the longest of those whose ends are near no common triangle, or of
    /// all; and whether there is one.
    fn side_to_cut(&self, corners: &[Corner; 3]) -> (usize, bool) {
        let mut best = (0, false, -1.0);
        for i in 0..3 {
            let (p, q) = (&corners[i], &corners[(i + 1) % 3]);
            let (apart, length) = (p.near & q.near == 0, p.at.distance_squared(q.at));
            if (apart, length) > (best.1, best.2) {
                best = (i, apart, length);
            }
        }
        (best.0, best.1)
    }

    /// Where the side between two corners crosses an edge of a triangle near the first: if possible the edge to a triangle
    /// near the second.
    fn crossing(&self, corners: &mut [Corner; 3], i: usize, j: usize) -> Option<Crossing> {
        let (p, q) = (corners[i], corners[j]);
        for (wanted, all) in [(q.near, false), (!p.near, true)] {
            for a in bits(p.near) {
                for b in bits(self.triangles[a].adjacent & wanted) {
                    let Some([from, to]) = self.edge_between(a, b) else {
                        continue;
                    };
                    let (s, at, nearest) = nearest_points([p.at, q.at], [from, to]);
                    let distance = at.distance(nearest);
                    if !is_within(distance, self.goal) || (all && (s <= 0.0 || s >= 1.0)) {
                        continue;
                    }
                    let near = 1 << a | 1 << b;
                    // At an end that end is near both.
                    if s <= 0.0 || s >= 1.0 {
                        let end = &mut corners[if s <= 0.0 { i } else { j }];
                        end.near |= near;
                        return Some(Crossing::Corner);
                    }
                    let cut = Corner {
                        at,
                        near,
                        known: (a, distance),
                        vertex: NONE,
                        complete: false,
                    };
                    return Some(Crossing::At(cut));
                }
            }
        }
        None
    }

    /// The middle of a side, if it is near any triangle.
    fn middle(&self, p: &Corner, q: &Corner) -> Option<Corner> {
        let mut middle = Corner::near(p.at.midpoint(q.at), MOST, f64::INFINITY);
        self.complete(&mut middle);
        (middle.near != 0).then_some(middle)
    }

    /// Measures all triangles.
    fn complete(&self, corner: &mut Corner) {
        for (place, triangle) in self.triangles.iter().enumerate() {
            if corner.near >> place & 1 == 0 && distance(corner.at, triangle.positions) <= self.goal
            {
                corner.near |= 1 << place;
            }
        }
        corner.complete = true;
    }

    /// The ends of the edge that two triangles share.
    fn edge_between(&self, a: usize, b: usize) -> Option<[DVec3; 2]> {
        let (a, b) = (&self.triangles[a], &self.triangles[b]);
        let other = (0..3).find(|&i| !b.corners.contains(&a.corners[i]))?;
        let [i, j] = [(other + 1) % 3, (other + 2) % 3];
        let shared = b.corners.contains(&a.corners[i]) && b.corners.contains(&a.corners[j]);
        shared.then(|| [a.positions[i], a.positions[j]])
    }
}

/// Where a side was to be cut.
enum Crossing {
    At(Corner),
    /// At one of its ends, which is now known to be near more triangles.
    Corner,
}

/// Whether a distance is at most `goal`; false for NaN.
#[inline]
pub(super) fn is_within(distance: f64, goal: f64) -> bool {
    distance <= goal
}

/// The places of the bits that are set.
fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let place = (set != 0).then(|| set.trailing_zeros() as usize)?;
        set &= set - 1;
        Some(place)
    })
}

/// The distance of a point from a point of a triangle, the nearest within rounding.
#[inline]
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let [u, v, w] = closest_to_origin(a - p, b - p, c - p).weights;
    (a * u + b * v + c * w).distance(p)
}

/// Points of two segments that are nearest to each other, within rounding, and where the first lies
/// on its segment, from 0 to 1 (Ericson, Real-Time Collision Detection, section 5.1.9).
fn nearest_points([p, q]: [DVec3; 2], [a, b]: [DVec3; 2]) -> (f64, DVec3, DVec3) {
    let (along, edge, from) = (q - p, b - a, p - a);
    let (pp, ee, pe) = (
        along.length_squared(),
        edge.length_squared(),
        along.dot(edge),
    );
    let (pf, ef) = (along.dot(from), edge.dot(from));
    let share = |x: f64, y: f64| {
        if y > 0.0 {
            (x / y).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let determinant = pp * ee - pe * pe;
    let t = share(pe * share(pe * ef - pf * ee, determinant) + ef, ee);
    let s = share(pe * t - pf, pp);
    (s, p + along * s, a + edge * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::Random;
    use proptest::prelude::*;

    /// A fan of triangles around a point, its rim at the given heights.
    fn fan(heights: &[f64]) -> Vec<([u32; 3], [DVec3; 3])> {
        let n = heights.len();
        let rim = |i: usize| {
            let angle = core::f64::consts::TAU * i as f64 / n as f64;
            DVec3::new(angle.cos(), angle.sin(), heights[i % n])
        };
        let number = |i: usize| 1 + (i % n) as u32;
        (0..n)
            .map(|i| {
                (
                    [0, number(i), number(i + 1)],
                    [DVec3::ZERO, rim(i), rim(i + 1)],
                )
            })
            .collect()
    }

    /// The greatest distance of dense points of a face from a fan, each against all triangles one
    /// by one, and the bound reported for the face.
    fn looked_at(
        heights: &[f64],
        corners: [(f64, f64, f64); 3],
        goal: f64,
    ) -> (f64, Option<(f64, u64)>) {
        let fan = fan(heights);
        let mut candidates = Candidates::default();
        for (i, &(corners, positions)) in fan.iter().enumerate() {
            candidates.add(i as u32, corners, positions);
        }
        let nearest = |p: DVec3| {
            fan.iter()
                .map(|t| distance(p, t.1))
                .fold(f64::INFINITY, f64::min)
        };
        let positions = corners.map(|(x, y, z)| DVec3::new(x, y, z));
        let greatest = (0..=24)
            .flat_map(|i| (0..=24 - i).map(move |j| (f64::from(i) / 24.0, f64::from(j) / 24.0)))
            .map(|(u, v)| {
                nearest(positions[0] * (1.0 - u - v) + positions[1] * u + positions[2] * v)
            })
            .fold(0.0, f64::max);
        let ends = positions.map(|p| {
            let near = |&(a, b): &(usize, usize)| distance(p, fan[a].1) < distance(p, fan[b].1);
            let best = (1..fan.len()).fold(0, |best, i| if near(&(i, best)) { i } else { best });
            candidates.sample(p, best)
        });
        (greatest, candidates.bound(ends, goal))
    }

    proptest! {
        #[test]
        fn no_point_of_a_face_is_farther_than_its_bound(
            heights in proptest::collection::vec(-0.3f64..0.3, 3..12),
            corners in proptest::array::uniform3((-0.6f64..0.6, -0.6f64..0.6, -0.2f64..0.2)),
            goal in 0.01f64..0.4,
        ) {
            if let (greatest, Some((bound, used))) = looked_at(&heights, corners, goal) {
                prop_assert!(greatest <= bound + 1e-12 && bound <= goal, "{greatest} {bound} {goal}");
                prop_assert!(used != 0 && used < 1 << heights.len());
            }
        }
    }

    /// Cuts run out over some crumpled fans, not over more than one in a hundred.
    #[test]
    fn what_is_well_within_is_found_to_be_so() {
        let mut random = Random::new(7);
        let mut next = |low: f64, high: f64| low + (high - low) * random.unit();
        let (mut within, mut missed) = (0, 0);
        for round in 0..4_000 {
            let heights: Vec<f64> = (0..3 + round % 9).map(|_| next(-0.3, 0.3)).collect();
            let corners = [(); 3].map(|()| (next(-0.6, 0.6), next(-0.6, 0.6), next(-0.2, 0.2)));
            let goal = next(0.01, 0.4);
            let (greatest, found) = looked_at(&heights, corners, goal);
            if greatest < 0.9 * goal {
                within += 1;
                missed += usize::from(found.is_none());
            }
        }
        assert!(
            within > 1_000 && 100 * missed <= within,
            "{missed} of {within}"
        );
    }
}
