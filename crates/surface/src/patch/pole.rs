//! Pieces at an irregular vertex of very many edges, each in a size that does not depend on their number.
//!
//! The surface over a face v r₀ r₁ knows the far part of the ring only by its mean: with m the mean of all k neighbours, one
//! refinement takes v to (1 − kβ) v + kβ m and m to 3/8 v + 5/8 m, and each neighbour to a combination of v, itself and
//! the two adjacent to it. So the neighbours near the face, the mean and what else an [`ExtraordinaryPatch`] has suffice. All of that
//! are convex combinations: the piece lies in the hull of those points.
//!
//! Where the part of the ring that is kept ends, refinements take the neighbour at its other end for the one that is left out. Let eⱼ be how far neighbour j is
//! from where it ought to be: a refinement makes 3/8 eⱼ + 1/8 (eⱼ₋₁ + eⱼ₊₁) of it at most (half of eⱼ on a sharp edge, and between both on one that
//! decays). For x = (5 − √21)/2 = 0.209, which solves 3/8 + 1/8 (x + 1/x) = 1, that keeps eⱼ ≤ D (xᵃ + xᵇ), where neighbour j is a and b
//! steps away from the first ones left out at either side, and D is the diameter of the hull, in which all stays that is taken for them: with [`BEYOND`] of 40,
//! 1e-27 D at any level for those that the face needs. Seen by the size of the level, which is 5/8 of the one before, none of it arrives in the first
//! 40 levels, and 3e-11 after 84, when all of the ring is within 1e-17 of D.

use super::Patch;
use super::box_spline::Points;
use super::extraordinary::{ExtraordinaryPatch, RefinedExtraordinary};
use crate::vector::DVec3;

/// Neighbours that are kept on either side of those that the face needs.
pub(super) const BEYOND: usize = 40;

/// Neighbours that are kept of the others' rings: the four that a refinement of the face needs, and those beyond.
pub(super) const KEPT: usize = 4 + 2 * BEYOND;

/// Rings up to this size are kept whole: it would save little time, and faces of which some have all of their neighbours and some
/// have not may take more triangles side by side.
pub(super) const LARGEST_RING: usize = 172;

/// The points around a face with one irregular corner of more than [`LARGEST_RING`] edges.
#[derive(Clone, Debug)]
pub struct PolePatch {
    /// The face with as much of the ring as is kept: r₀, r₁, … and … r₋₂, r₋₁, one after the other.
    near: ExtraordinaryPatch,
    valence: usize,
    /// The mean of the whole ring.
    mean: DVec3,
}

impl PolePatch {
    /// The piece `whole`, without the far part of its ring.
    pub fn of(mut whole: ExtraordinaryPatch) -> Self {
        let valence = whole.ring.len();
        let mean = whole.ring.iter().sum::<DVec3>() / valence as f64;
        let half = KEPT / 2;
        // One more follows the face than goes before it.
        whole.ring.drain(half + 1..valence - (half - 1));
        Self {
            near: whole,
            valence,
            mean,
        }
    }

    /// The piece of which only as much of the ring is there as is kept, given the number of all neighbours and their mean.
    pub(super) fn near(near: ExtraordinaryPatch, valence: usize, mean: DVec3) -> Self {
        Self {
            near,
            valence,
            mean,
        }
    }

    pub(crate) fn valence(&self) -> usize {
        self.valence
    }

    /// Which of the face's corners is the irregular one.
    pub(crate) fn corner(&self) -> usize {
        self.near.corner
    }

    /// The point of a corner of the face.
    pub(super) fn control_point(&self, corner: usize) -> DVec3 {
        self.near.control_point(corner)
    }

    /// Moves all so that the irregular vertex is at the origin, and gives where it was.
    pub(crate) fn moved_to_origin(&mut self) -> DVec3 {
        let from = self.near.moved_to_origin();
        self.mean -= from;
        from
    }

    /// Points whose hull holds the piece.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.near.points().chain([self.mean])
    }

    /// The points after one refinement; `beta` is the weight of each neighbour of the irregular vertex.
    pub(crate) fn refined(&self, beta: f64) -> RefinedPole {
        let shares = self.valence as f64 * beta;
        let at = (1.0 - shares) * self.near.at + shares * self.mean;
        let mean = 0.375 * self.near.at + 0.625 * self.mean;
        RefinedPole {
            near: self.near.refined_to(at),
            valence: self.valence,
            mean,
        }
    }
}

/// The points around the four parts of a [`PolePatch`].
pub struct RefinedPole {
    near: RefinedExtraordinary,
    valence: usize,
    mean: DVec3,
}

impl RefinedPole {
    /// One of the four parts, numbered like the face's corners; 3 is the middle one.
    pub(crate) fn part(&self, part: usize) -> Patch {
        match self.near.part(part) {
            Patch::Extraordinary(near) => Patch::Pole(Box::new(PolePatch {
                near: *near,
                valence: self.valence,
                mean: self.mean,
            })),
            regular => regular,
        }
    }

    /// Whether a part is regular: all but that at the irregular corner.
    pub(crate) fn is_regular(&self, part: usize) -> bool {
        self.near.is_regular(part)
    }

    /// The points of one of the parts, if it is regular.
    pub(crate) fn points(&self, part: usize) -> Option<Points> {
        self.near.points(part)
    }

    /// The new vertex on the edge from corner `edge` of the face, with its ring.
    pub(crate) fn middle(&self, edge: usize) -> (DVec3, [DVec3; 6]) {
        self.near.middle(edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Rules;
    use crate::scheme::Loop;

    fn arbitrary(count: usize) -> Vec<DVec3> {
        let point =
            |t: f64| DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin());
        (0..count).map(|i| point(i as f64)).collect()
    }

    fn near(a: DVec3, b: DVec3, what: &str) {
        // Sums of hundreds of points, level after level.
        assert!(a.distance(b) < 1e-12, "{what}: {a} {b}");
    }

    /// With and without the far part of the ring, refinement is the same, for many more levels than neighbours are kept.
    #[test]
    fn the_far_part_of_a_ring_counts_by_its_mean() {
        let rules = Rules::of(&Loop);
        for valence in [LARGEST_RING + 1, LARGEST_RING + 2, 700] {
            let points = arbitrary(valence + 6);
            let outer = core::array::from_fn(|i| points[valence + 1 + i]);
            let ring = points[1..=valence].to_vec();
            let mut whole = ExtraordinaryPatch {
                corner: valence % 3,
                at: points[0],
                ring: ring.into(),
                outer,
            };
            let mut pole = PolePatch::of(whole.clone());
            assert_eq!(pole.near.ring.len(), KEPT);
            for level in 0..4 * BEYOND {
                let beta = rules.beta(valence);
                let (expected, found) = (whole.refined(beta), pole.refined(beta));
                let what = format!("valence {valence}, level {level}");
                for edge in 0..3 {
                    let ((at, ring), (other, around)) = (expected.middle(edge), found.middle(edge));
                    near(at, other, &what);
                    (0..6).for_each(|i| near(ring[i], around[i], &what));
                }
                for part in (0..4).filter(|&part| part != whole.corner) {
                    let (Patch::Regular(a), Patch::Regular(b)) =
                        (expected.part(part), found.part(part))
                    else {
                        panic!("{what}");
                    };
                    (0..12).for_each(|i| near(a[i], b[i], &what));
                }
                let Patch::Extraordinary(next) = expected.part(whole.corner) else {
                    panic!("{what}")
                };
                let Patch::Pole(next_pole) = found.part(pole.near.corner) else {
                    panic!("{what}")
                };
                (whole, pole) = (*next, *next_pole);
                let mean = whole.ring.iter().sum::<DVec3>() / valence as f64;
                near(mean, pole.mean, &what);
                near(whole.at, pole.near.at, &what);
            }
        }
    }
}
