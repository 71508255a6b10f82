//! Pieces of the limit surface: the part over one face of some level, with the points that decide it.

use super::fan::{Fans, RefinedFans};
use super::lattice::{Points, Refined};
use super::local::{Local, RefinedLocal};
use super::rules::Rules;
use super::spoke::{RefinedSpoke, Spoke};
use crate::vector::{DVec3, unit_or_zero};

/// The limit surface over one face.
// Almost all are regular: boxing them would cost an allocation for each face.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
pub(crate) enum Patch {
    /// All corners have six edges, or mirror images beyond a crease make it so.
    Regular(Points),
    /// One corner inside the surface has another number of edges, the others are regular.
    Spoke(Box<Spoke>),
    /// Any other without tags that fade, of Loop's family.
    Irregular(Box<Fans>),
    /// Anything else.
    Local(Local),
}

/// A point of the limit surface with its unit normal on the side it was asked for; zero without one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LimitPoint {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
}

impl LimitPoint {
    /// The limit of a regular vertex: weights 1/2 and 1/12, tangents by cosines and sines.
    fn regular(at: DVec3, ring: &[DVec3; 6]) -> Self {
        const SINE: f64 = 0.866_025_403_784_438_6;
        let [a, b, c, d, e, f] = *ring;
        let position = (6.0 * at + (a + d) + (b + e) + (c + f)) / 12.0;
        let along = (a - d) + 0.5 * ((b - e) + (f - c));
        let across = SINE * ((b - e) + (c - f));
        Self { position, normal: unit_or_zero(along.cross(across)) }
    }
}

/// A patch refined once: its parts and the limits of its new vertices.
// Almost all are regular: boxing them would cost an allocation for each.
#[allow(clippy::large_enum_variant)]
pub(crate) enum RefinedPatch<'a> {
    /// Of a regular patch.
    Regular(Refined),
    /// Of one with an irregular corner.
    Spoke(RefinedSpoke),
    /// Of another irregular one.
    Irregular(RefinedFans<'a>),
    /// Of one without a form of its own.
    Local(RefinedLocal<'a>),
}

impl Patch {
    /// The simplest form of a piece.
    pub(crate) fn of(fans: Fans) -> Self {
        if let Some(points) = fans.regular() {
            return Self::Regular(points);
        }
        match fans.spoke() {
            Some(spoke) => Self::Spoke(Box::new(spoke)),
            None => Self::Irregular(Box::new(fans)),
        }
    }

    /// The patch refined once.
    #[inline]
    pub(crate) fn refined<'a>(&'a self, rules: &'a Rules<'a>) -> RefinedPatch<'a> {
        match self {
            Self::Regular(points) => RefinedPatch::Regular(Refined::of(points)),
            Self::Spoke(spoke) => RefinedPatch::Spoke(spoke.refined(rules.beta(spoke.ring.len()))),
            Self::Irregular(fans) => RefinedPatch::Irregular(fans.refined(rules)),
            Self::Local(local) => RefinedPatch::Local(local.refined(rules)),
        }
    }

    /// Calls `visit` for points whose hull holds the piece.
    pub(crate) fn for_each_hull_point(&self, mut visit: impl FnMut(DVec3)) {
        match self {
            Self::Regular(points) => points.iter().for_each(|&point| visit(point)),
            Self::Spoke(spoke) => spoke.points().for_each(visit),
            Self::Irregular(fans) => fans.points().for_each(visit),
            Self::Local(local) => local.points().for_each(visit),
        }
    }
}

impl RefinedPatch<'_> {
    /// Whether a part is regular.
    pub(crate) fn is_regular(&self, part: usize) -> bool {
        match self {
            Self::Regular(_) => true,
            Self::Spoke(refined) => refined.is_regular(part),
            Self::Irregular(refined) => refined.is_regular(part),
            Self::Local(refined) => matches!(refined.part(part), Patch::Regular(_)),
        }
    }

    /// One of the four parts: 0 to 2 keep the corner of their number, at its place; corner `i` of part 3, the middle
    /// one, is the new vertex opposite corner `i`.
    #[inline]
    pub(crate) fn part(&self, part: usize) -> Patch {
        match self {
            Self::Regular(refined) => Patch::Regular(refined.part(part)),
            Self::Spoke(refined) => refined.part(part),
            Self::Irregular(refined) => Patch::of(refined.part(part)),
            Self::Local(refined) => refined.part(part),
        }
    }

    /// The limit of the new vertex on the edge from corner `edge`, seen from this face.
    #[inline]
    pub(crate) fn middle(&self, edge: usize) -> LimitPoint {
        match self {
            Self::Regular(refined) => {
                let (at, ring) = refined.middle(edge);
                LimitPoint::regular(at, &ring)
            }
            Self::Spoke(refined) => {
                let (at, ring) = refined.middle(edge);
                LimitPoint::regular(at, &ring)
            }
            Self::Irregular(refined) => {
                let (at, ring) = refined.regular_middle(edge);
                LimitPoint::regular(at, &ring)
            }
            Self::Local(refined) => refined.middle(edge),
        }
    }
}
