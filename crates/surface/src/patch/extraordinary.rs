//! Pieces at an irregular vertex inside the surface: a face with one such corner, whose other two are regular. After
//! one refinement nearly all irregular pieces are like that.
//!
//! The points are the vertex v, its ring r₀, r₁, … (the face is v r₀ r₁) and the five beyond the ring that complete the
//! rings of r₀ and r₁. One refinement gives the same again, smaller, and three regular pieces.

use super::{Neighbours, Patch};
use crate::vector::{Blend, DVec3};

/// The points around a face with one irregular corner, or what is blended the same way. What is said of corners and edges counts from that one.
#[derive(Clone, Debug, PartialEq)]
pub struct ExtraordinaryPatch<V = DVec3> {
    /// Which of the face's corners is the irregular one.
    pub corner: usize,
    /// The irregular vertex.
    pub at: V,
    /// Its neighbours, counter-clockwise from the face's next corner.
    pub ring: Neighbours<V>,
    /// The points that complete the rings of the other corners: opposite to the vertex beyond the edge r₋₁r₀, beyond r₀, beyond
    /// r₀r₁, beyond r₁, beyond r₁r₂.
    pub outer: [V; 5],
}

/// The points around the four parts of an [`ExtraordinaryPatch`].
pub struct RefinedExtraordinary<V = DVec3> {
    own: ExtraordinaryPatch<V>,
    /// Those near the face, by their numbers in [`near`].
    near: [V; 16],
}

impl<V: Blend> ExtraordinaryPatch<V> {
    /// All points.
    pub fn points(&self) -> impl Iterator<Item = V> + '_ {
        core::iter::once(self.at)
            .chain(self.ring.iter().copied())
            .chain(self.outer)
    }

    /// Maps each point by itself.
    pub fn map<W: Blend>(&self, each: impl Fn(V) -> W) -> ExtraordinaryPatch<W> {
        ExtraordinaryPatch {
            corner: self.corner,
            at: each(self.at),
            ring: self.ring.iter().map(|&point| each(point)).collect(),
            outer: self.outer.map(&each),
        }
    }

    /// The points after one refinement; `beta` is the weight of each neighbour of the irregular vertex.
    pub fn refined(&self, beta: f64) -> RefinedExtraordinary<V> {
        let sum = self
            .ring
            .iter()
            .fold(V::default(), |sum, &point| sum + point);
        self.refined_to(self.at * (1.0 - self.ring.len() as f64 * beta) + sum * beta)
    }

    /// The points after one refinement that takes the irregular vertex to `moved`.
    pub(super) fn refined_to(&self, moved: V) -> RefinedExtraordinary<V> {
        let edge = |a: V, b: V, c: V, d: V| (a + b) * 0.375 + (c + d) * 0.125;
        let Self {
            corner,
            at,
            ref ring,
            outer: [before, past_first, between, past_second, after],
        } = *self;
        let valence = ring.len();
        let (last, first, second, third) = (ring[valence - 1], ring[0], ring[1], ring[2 % valence]);
        let mut edges = Neighbours::from_elem(V::default(), valence);
        let mut previous = last;
        for slot in 0..valence {
            let next = ring[if slot + 1 == valence { 0 } else { slot + 1 }];
            edges[slot] = edge(at, ring[slot], previous, next);
            previous = ring[slot];
        }
        let vertex = |at: V, [a, b, c, d, e, f]: [V; 6]| {
            at * 0.625 + (V::default() + a + b + c + d + e + f) * 0.0625
        };
        let outer = [
            edge(last, first, at, before),
            vertex(first, [at, last, before, past_first, between, second]),
            edge(first, second, at, between),
            vertex(second, [at, first, between, past_second, after, third]),
            edge(second, third, at, after),
        ];
        let near = [
            moved,
            edges[valence - 1],
            edges[0],
            edges[1],
            edges[2 % valence],
            outer[0],
            outer[1],
            outer[2],
            outer[3],
            outer[4],
            edge(first, before, last, past_first),
            edge(first, past_first, before, between),
            edge(first, between, past_first, second),
            edge(second, between, first, past_second),
            edge(second, past_second, between, after),
            edge(second, after, past_second, third),
        ];
        RefinedExtraordinary {
            own: Self {
                corner,
                at: moved,
                ring: edges,
                outer,
            },
            near,
        }
    }
}

impl ExtraordinaryPatch {
    /// The point of a corner of the face.
    pub(super) fn control_point(&self, corner: usize) -> DVec3 {
        match (corner + 3 - self.corner) % 3 {
            0 => self.at,
            local => self.ring[local - 1],
        }
    }

    /// Moves all so that the irregular vertex is at the origin, and gives where it was.
    pub(crate) fn moved_to_origin(&mut self) -> DVec3 {
        let from = core::mem::take(&mut self.at);
        self.ring
            .iter_mut()
            .chain(&mut self.outer)
            .for_each(|point| *point -= from);
        from
    }
}

impl RefinedExtraordinary {
    /// One of the four parts, numbered like the face's corners; 3 is the middle one.
    pub fn part(&self, part: usize) -> Patch {
        match self.local(part) {
            0 => Patch::Extraordinary(Box::new(self.own.clone())),
            local => Patch::Regular(self.regular(local)),
        }
    }
}

impl<V: Blend> RefinedExtraordinary<V> {
    /// Whether a part is regular: all but that at the irregular corner.
    pub fn is_regular(&self, part: usize) -> bool {
        self.local(part) != 0
    }

    /// The piece at the irregular corner.
    pub fn own(&self) -> &ExtraordinaryPatch<V> {
        &self.own
    }

    /// The number of a part as it counts from the irregular corner.
    #[inline]
    fn local(&self, part: usize) -> usize {
        if part == 3 {
            3
        } else {
            (part + 3 - self.own.corner) % 3
        }
    }

    /// The points of one of the parts, if it is regular.
    #[inline]
    pub(crate) fn points(&self, part: usize) -> Option<[V; 12]> {
        self.is_regular(part).then(|| self.regular_part(part))
    }

    /// The points of one of the parts, which is regular.
    #[inline]
    pub fn regular_part(&self, part: usize) -> [V; 12] {
        self.regular(self.local(part))
    }

    /// The points of a regular part, numbered from the irregular corner, as it stands in the face.
    #[inline]
    pub(crate) fn regular(&self, local: usize) -> [V; 12] {
        let mut points = [V::default(); 12];
        let list = &near::PARTS[self.own.corner % 3][(local - 1) % 3];
        points
            .iter_mut()
            .zip(list)
            .for_each(|(point, &at)| *point = self.near(at));
        points
    }

    /// Which of the points near the face are those of one of the parts, if it is regular.
    #[inline]
    pub fn places(&self, part: usize) -> Option<&'static [u8; 12]> {
        let local = self.local(part);
        (local != 0).then(|| &near::PARTS[self.own.corner % 3][(local - 1) % 3])
    }

    /// One of the points near the face.
    #[inline]
    pub fn near(&self, at: u8) -> V {
        self.near[usize::from(at) % 16]
    }

    /// The new vertex on the edge from corner `edge` of the face, with its ring.
    pub fn middle(&self, edge: usize) -> (V, [V; 6]) {
        let (at, ring) = &near::MIDDLES[(edge + 3 - self.own.corner) % 3];
        let mut around = [V::default(); 6];
        around
            .iter_mut()
            .zip(ring)
            .for_each(|(point, &at)| *point = self.near[usize::from(at) % 16]);
        (self.near[usize::from(*at) % 16], around)
    }
}

/// The new points near a face, by their numbers, and which of them its parts take.
mod near {
    use super::super::box_spline::{CORNERS, RINGS};

    /// The irregular vertex, and the new points on the edges to the last, the first, the second and the third of its ring.
    const AT: u8 = 0;
    const LAST: u8 = 1;
    const ON_FIRST: u8 = 2;
    const ON_SECOND: u8 = 3;
    const ON_THIRD: u8 = 4;
    /// The five outer points.
    const BEFORE: u8 = 5;
    const FIRST: u8 = 6;
    const BETWEEN: u8 = 7;
    const SECOND: u8 = 8;
    const AFTER: u8 = 9;
    /// Those between r₀ and the first three outer points that were, and between r₁ and the last three.
    const BEYOND: [u8; 6] = [10, 11, 12, 13, 14, 15];

    /// The rings of the new points on the edges to r₀ and r₁ and between these, and of r₀ and r₁.
    const AROUND_FIRST: [u8; 6] = [BEFORE, FIRST, BETWEEN, ON_SECOND, AT, LAST];
    const AROUND_SECOND: [u8; 6] = [ON_FIRST, BETWEEN, SECOND, AFTER, ON_THIRD, AT];
    const AROUND_BETWEEN: [u8; 6] = [FIRST, BEYOND[2], BEYOND[3], SECOND, ON_SECOND, ON_FIRST];
    const OF_FIRST: [u8; 6] = [BETWEEN, ON_FIRST, BEFORE, BEYOND[0], BEYOND[1], BEYOND[2]];
    const OF_SECOND: [u8; 6] = [ON_SECOND, BETWEEN, BEYOND[3], BEYOND[4], BEYOND[5], AFTER];

    /// The new vertices on the edges, numbered from the irregular corner, and their rings.
    pub(super) const MIDDLES: [(u8, [u8; 6]); 3] = [
        (ON_FIRST, AROUND_FIRST),
        (BETWEEN, AROUND_BETWEEN),
        (ON_SECOND, AROUND_SECOND),
    ];

    /// The twelve points of the regular parts: by the face's irregular corner, and the part as it is numbered from there.
    pub(super) const PARTS: [[[u8; 12]; 3]; 3] = {
        let mut parts = [[[0; 12]; 3]; 3];
        let mut corner = 0;
        while corner < 3 {
            parts[corner] = [
                assembled(
                    [ON_FIRST, FIRST, BETWEEN],
                    [turned(AROUND_FIRST, 1), OF_FIRST, turned(AROUND_BETWEEN, 5)],
                    corner,
                ),
                assembled(
                    [ON_SECOND, BETWEEN, SECOND],
                    [
                        turned(AROUND_SECOND, 1),
                        turned(AROUND_BETWEEN, 3),
                        OF_SECOND,
                    ],
                    corner,
                ),
                assembled(
                    [BETWEEN, ON_SECOND, ON_FIRST],
                    [
                        turned(AROUND_BETWEEN, 4),
                        AROUND_SECOND,
                        turned(AROUND_FIRST, 2),
                    ],
                    corner,
                ),
            ];
            corner += 1;
        }
        parts
    };

    /// A ring from another of its points on.
    const fn turned(ring: [u8; 6], from: usize) -> [u8; 6] {
        let mut turned = [0; 6];
        let mut slot = 0;
        while slot < 6 {
            turned[slot] = ring[(slot + from) % 6];
            slot += 1;
        }
        turned
    }

    /// The twelve points of a face with these corners and rings, the first of which stands at corner `first`.
    const fn assembled(corners: [u8; 3], rings: [[u8; 6]; 3], first: usize) -> [u8; 12] {
        let mut points = [0; 12];
        let mut corner = 0;
        while corner < 3 {
            let place = (corner + first) % 3;
            let mut slot = 0;
            while slot < 6 {
                points[RINGS[place][slot] as usize] = rings[corner][slot];
                slot += 1;
            }
            points[CORNERS[place]] = corners[corner];
            corner += 1;
        }
        points
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

    /// A face by its three sectors.
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
            smooth(
                ring[0],
                smallvec![ring[1], at, ring[k - 1], before, past_first, between],
            ),
            smooth(
                ring[1],
                smallvec![at, ring[0], between, past_second, after, ring[2]],
            ),
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
                    let (expected, found) =
                        (sectors.refined(&rules), patch.refined(rules.beta(valence)));
                    let near = |a: DVec3, b: DVec3| {
                        assert!(
                            a.distance(b) < 1e-14,
                            "valence {valence}, corner {corner}, level {level}"
                        )
                    };
                    for part in 0..4 {
                        match (Patch::of(expected.part(part)), found.part(part)) {
                            (Patch::Regular(a), Patch::Regular(b)) => {
                                (0..12).for_each(|i| near(a[i], b[i]))
                            }
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
                    let Patch::Extraordinary(next) = found.part(corner) else {
                        panic!()
                    };
                    patch = *next;
                }
            }
        }
    }
}
