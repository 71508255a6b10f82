//! Pieces at an irregular vertex inside the surface: a face with one such corner, whose other two are regular. After
//! one refinement nearly all irregular pieces are like that.
//!
//! The points are the vertex v, its ring r₀, r₁, … (the face is v r₀ r₁) and the five beyond the ring that complete the
//! rings of r₀ and r₁. One refinement gives the same again, smaller, and three regular pieces.

use super::box_spline::{self, Points};
use super::{Neighbours, Patch};
use crate::vector::DVec3;

/// The points around a face with one irregular corner. What is said of corners and edges counts from that one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ExtraordinaryPatch {
    /// Which of the face's corners is the irregular one.
    pub(crate) corner: usize,
    /// The irregular vertex.
    pub(crate) at: DVec3,
    /// Its neighbours, counter-clockwise from the face's next corner.
    pub(crate) ring: Neighbours,
    /// What completes the rings of the other corners: opposite to the vertex beyond the edge r₋₁r₀, beyond r₀, beyond
    /// r₀r₁, beyond r₁, beyond r₁r₂.
    pub(crate) outer: [DVec3; 5],
}

/// The points around the four parts of an [`ExtraordinaryPatch`].
pub(crate) struct RefinedExtraordinary {
    own: ExtraordinaryPatch,
    /// What the regular parts need besides: the new points between r₀ and the first three outer points, and
    /// between r₁ and the last three.
    beyond: [DVec3; 6],
}

impl ExtraordinaryPatch {
    /// All points.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        core::iter::once(self.at).chain(self.ring.iter().copied()).chain(self.outer)
    }

    /// The points after one refinement; `beta` is the weight of each neighbour of the irregular vertex.
    pub(crate) fn refined(&self, beta: f64) -> RefinedExtraordinary {
        let valence = self.ring.len();
        self.refined_to((1.0 - valence as f64 * beta) * self.at + beta * self.ring.iter().sum::<DVec3>())
    }

    /// The points after one refinement that takes the irregular vertex to `moved`.
    pub(super) fn refined_to(&self, moved: DVec3) -> RefinedExtraordinary {
        let edge = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| 0.375 * (a + b) + 0.125 * (c + d);
        let Self { corner, at, ref ring, outer: [before, past_first, between, past_second, after] } = *self;
        let valence = ring.len();
        let (last, first, second, third) = (ring[valence - 1], ring[0], ring[1], ring[2 % valence]);
        let edges = (0..valence).map(|slot| {
            let previous = ring[if slot == 0 { valence - 1 } else { slot - 1 }];
            let next = ring[if slot + 1 == valence { 0 } else { slot + 1 }];
            edge(at, ring[slot], previous, next)
        });
        let vertex = |at: DVec3, ring: [DVec3; 6]| 0.625 * at + 0.0625 * ring.into_iter().sum::<DVec3>();
        let own = Self {
            corner,
            at: moved,
            ring: edges.collect(),
            outer: [
                edge(last, first, at, before),
                vertex(first, [at, last, before, past_first, between, second]),
                edge(first, second, at, between),
                vertex(second, [at, first, between, past_second, after, third]),
                edge(second, third, at, after),
            ],
        };
        let beyond = [
            edge(first, before, last, past_first),
            edge(first, past_first, before, between),
            edge(first, between, past_first, second),
            edge(second, between, first, past_second),
            edge(second, past_second, between, after),
            edge(second, after, past_second, third),
        ];
        RefinedExtraordinary { own, beyond }
    }
}

impl RefinedExtraordinary {
    /// One of the four parts, numbered like the face's corners; 3 is the middle one.
    pub(crate) fn part(&self, part: usize) -> Patch {
        match self.local(part) {
            0 => Patch::Extraordinary(Box::new(self.own.clone())),
            local => Patch::Regular(self.regular(local)),
        }
    }

    /// Whether a part is regular: all but that at the irregular corner.
    pub(crate) fn is_regular(&self, part: usize) -> bool {
        self.local(part) != 0
    }

    /// The number of a part as it counts from the irregular corner.
    fn local(&self, part: usize) -> usize {
        if part == 3 { 3 } else { (part + 3 - self.own.corner) % 3 }
    }

    /// The points of a regular part, numbered from the irregular corner, as it stands in the face.
    pub(crate) fn regular(&self, local: usize) -> Points {
        let [on_first, on_second] = [self.own.ring[0], self.own.ring[1]];
        let [_, first, between, second, _] = self.own.outer;
        let (mut corners, mut rings) = match local {
            1 => ([on_first, first, between], [self.around_first(1), self.first(), self.between(5)]),
            2 => ([on_second, between, second], [self.around_second(1), self.between(3), self.second()]),
            _ => (
                [between, on_second, on_first],
                [self.between(4), self.around_second(0), self.around_first(2)],
            ),
        };
        corners.rotate_right(self.own.corner);
        rings.rotate_right(self.own.corner);
        box_spline::assemble(corners, &rings)
    }

    /// The new vertex on the edge from corner `edge` of the face, with its ring.
    pub(crate) fn middle(&self, edge: usize) -> (DVec3, [DVec3; 6]) {
        match (edge + 3 - self.own.corner) % 3 {
            0 => (self.own.ring[0], self.around_first(0)),
            1 => (self.own.outer[2], self.between(0)),
            _ => (self.own.ring[1], self.around_second(0)),
        }
    }

    /// The ring of the point on the edge to r₀, counter-clockwise from the given place on.
    fn around_first(&self, from: usize) -> [DVec3; 6] {
        let ExtraordinaryPatch { at, ref ring, outer: [before, first, between, ..], .. } = self.own;
        let mut around = [before, first, between, ring[1], at, ring[ring.len() - 1]];
        around.rotate_left(from);
        around
    }

    /// The ring of the point on the edge to r₁.
    fn around_second(&self, from: usize) -> [DVec3; 6] {
        let ExtraordinaryPatch { at, ref ring, outer: [_, _, between, second, after], .. } = self.own;
        let mut around = [ring[0], between, second, after, ring[2 % ring.len()], at];
        around.rotate_left(from);
        around
    }

    /// The ring of the point on r₀r₁.
    fn between(&self, from: usize) -> [DVec3; 6] {
        let ExtraordinaryPatch { ref ring, outer: [_, first, _, second, _], .. } = self.own;
        let mut around = [first, self.beyond[2], self.beyond[3], second, ring[1], ring[0]];
        around.rotate_left(from);
        around
    }

    /// The ring of r₀.
    fn first(&self) -> [DVec3; 6] {
        let ExtraordinaryPatch { ref ring, outer: [before, _, between, ..], .. } = self.own;
        [between, ring[0], before, self.beyond[0], self.beyond[1], self.beyond[2]]
    }

    /// The ring of r₁.
    fn second(&self) -> [DVec3; 6] {
        let ExtraordinaryPatch { ref ring, outer: [.., between, _, after], .. } = self.own;
        [ring[1], between, self.beyond[3], self.beyond[4], self.beyond[5], after]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Rules;
    use crate::patch::sector::{Centre, Far, SectorPatch, VertexSector};
    use crate::scheme::Loop;
    use smallvec::smallvec;

    fn arbitrary(count: usize, seed: f64) -> Vec<DVec3> {
        (0..count)
            .map(|i| {
                let t = i as f64 + seed;
                DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
            })
            .collect()
    }

    /// The same face by its three sectors.
    fn sectors(patch: &ExtraordinaryPatch) -> SectorPatch {
        let ExtraordinaryPatch {
            corner,
            at,
            ref ring,
            outer: [before, past_first, between, past_second, after],
        } = *patch;
        let k = ring.len();
        let smooth = |at, neighbours| VertexSector {
            at,
            neighbours,
            centre: Centre::Smooth { sharp: None },
            slot: 0,
            far: Far::Kept,
        };
        let mut sectors = [
            smooth(at, ring.clone()),
            smooth(ring[0], smallvec![ring[1], at, ring[k - 1], before, past_first, between]),
            smooth(ring[1], smallvec![at, ring[0], between, past_second, after, ring[2]]),
        ];
        sectors.rotate_right(corner);
        SectorPatch(sectors)
    }

    #[test]
    fn refinement_is_that_of_the_sectors() {
        let rules = Rules::of(&Loop);
        for valence in (3..12).filter(|&k| k != 6) {
            for corner in 0..3 {
                let points = arbitrary(valence + 6, valence as f64);
                let outer = core::array::from_fn(|i| points[valence + 1 + i]);
                let mut patch = ExtraordinaryPatch {
                    corner,
                    at: points[0],
                    ring: points[1..=valence].iter().copied().collect(),
                    outer,
                };
                for level in 0..3 {
                    let sectors = sectors(&patch);
                    assert!(
                        matches!(Patch::of(sectors.clone()), Patch::Extraordinary(found) if *found == patch)
                    );
                    let (expected, found) = (sectors.refined(&rules), patch.refined(rules.beta(valence)));
                    let near = |a: DVec3, b: DVec3| {
                        assert!(a.distance(b) < 1e-14, "valence {valence}, corner {corner}, level {level}")
                    };
                    for part in 0..4 {
                        match (Patch::of(expected.part(part)), found.part(part)) {
                            (Patch::Regular(a), Patch::Regular(b)) => (0..12).for_each(|i| near(a[i], b[i])),
                            (Patch::Extraordinary(a), Patch::Extraordinary(b)) => {
                                assert_eq!((part, a.corner), (corner, corner));
                                a.points().zip(b.points()).for_each(|(a, b)| near(a, b));
                            }
                            other => panic!("{other:?}"),
                        }
                    }
                    for edge in 0..3 {
                        let ((at, mut ring), (other, around)) =
                            (expected.regular_middle(edge), found.middle(edge));
                        near(at, other);
                        let first = |p: &DVec3| p.distance(around[0]) < 1e-14;
                        let start = ring.iter().position(first).unwrap();
                        ring.rotate_left(start);
                        (0..6).for_each(|i| near(ring[i], around[i]));
                    }
                    let Patch::Extraordinary(next) = found.part(corner) else { panic!() };
                    patch = *next;
                }
            }
        }
    }
}
