//! The measure of a front: a number for each node, of the node alone, that is compared with a
//! limit.
//!
//! Two criteria of the literature can be chosen instead of the proven distance, for comparison.
//! Both use samples, so they prove nothing:
//!
//! * **Planarity** (Zorin, Schröder and Sweldens, "Interactive multiresolution mesh editing",
//!   1997): a node is divided where it is not flat enough at six points of the surface, its corners
//!   and the middles of its edges, which are the vertices of the next level. The comparison is made
//!   here by angles between limit normals and the triangle's normal, or as heights over its plane.
//!   By angles it divides wherever the cone around limit normals of corners does, and detects
//!   edges, too, whose ends happen to agree.
//! * **Vertex error** (Müller and Jaeschke, "Adaptive subdivision curves and surfaces", 1998): a node is divided where a corner's control
//!   point on the node's level is too far from its limit. Inside a smooth surface of the Loop family that distance is multiplied by
//!   5/8 − nβ with each level, n being the valence, along creases by 1/4.

use crate::math;
use crate::patch::{LimitPoint, Patch, Rules, child_corners};
use crate::vector::{DVec3, unit_or_zero};

/// The measure of a [`Front`](super::Front).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Measure {
    /// The greatest distance between a node's triangle and the surface over it, by place, in the
    /// control mesh's units; proven for schemes of a known family ([`crate::scheme::Scheme::family`]).
    #[default]
    Distance,
    /// The greatest angle between the node's triangle and the limit surface at its corners and the middles of its edges, in radians.
    PlanarityAngle,
    /// The greatest height of the limit surface over the plane of the node's triangle in the middles of its edges, in the control mesh's units.
    PlanarityDistance,
    /// The greatest distance of a corner's control point, on the node's level, from its limit, in the control mesh's units.
    VertexError,
}

/// A node's piece of the surface with the samples of a criterion.
#[derive(Debug)]
pub(super) struct Sampled {
    patch: Patch,
    corners: [LimitPoint; 3],
    middles: [LimitPoint; 3],
}

impl Sampled {
    pub(super) fn of(patch: Patch, corners: [LimitPoint; 3], rules: &Rules<'_>) -> Self {
        let refined = patch.refined(rules);
        let middles = [0, 1, 2].map(|edge| refined.middle(edge));
        drop(refined);
        Self {
            patch,
            corners,
            middles,
        }
    }

    /// The values of the four parts.
    pub(super) fn children(&self, rules: &Rules<'_>) -> [Self; 4] {
        let refined = self.patch.refined(rules);
        [0, 1, 2, 3].map(|child| {
            let corners = child_corners(self.corners, self.middles, child);
            Self::of(refined.part(child), corners, rules)
        })
    }

    pub(super) fn middle(&self, edge: usize) -> DVec3 {
        self.middles[edge].position
    }

    /// The node's number; for distances another form of pieces is used.
    pub(super) fn value(&self, measure: Measure) -> f64 {
        let greatest = match measure {
            Measure::Distance => f64::INFINITY,
            Measure::PlanarityAngle => self.angle(),
            Measure::PlanarityDistance => self.height(),
            Measure::VertexError => self.vertex_error(),
        };
        // NaN is never good enough.
        if greatest.is_nan() {
            f64::INFINITY
        } else {
            greatest
        }
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(|corner| corner.position);
        unit_or_zero((b - a).cross(c - a))
    }

    /// Triangles without area and points without a normal have no say.
    fn angle(&self) -> f64 {
        let own = self.normal();
        let all = self.corners.iter().chain(&self.middles);
        let angles =
            all.map(|point| math::atan2(own.cross(point.normal).length(), own.dot(point.normal)));
        greatest(angles)
    }

    /// Over a triangle without area it is how far the middles are from those of straight edges.
    fn height(&self) -> f64 {
        let (own, corners) = (self.normal(), self.corners.map(|corner| corner.position));
        greatest((0..3).map(|edge| {
            let straight = 0.5 * (corners[edge] + corners[(edge + 1) % 3]);
            let off = self.middles[edge].position - straight;
            if own == DVec3::ZERO {
                off.length()
            } else {
                off.dot(own).abs()
            }
        }))
    }

    fn vertex_error(&self) -> f64 {
        let corners = self.corners.iter().enumerate();
        greatest(
            corners
                .map(|(corner, limit)| self.patch.control_point(corner).distance(limit.position)),
        )
    }
}

/// The greatest of some numbers from 0 on; none if one of them is none.
pub(super) fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most: f64, own| {
        if own > most || own.is_nan() {
            own
        } else {
            most
        }
    })
}
