//! What looks away from a viewer for certain, so that it may stay coarse: a triangle, those beside it, and its piece of the surface.
//!
//! Takes a triangle, its piece, and criteria with viewers; gives who sees nothing but backs. Nothing is asked of such a triangle for
//! their sake.
//!
//! **Why that is enough**, for a camera before a closed surface. What the surface shows is its front: x with `(e − x)·N > 0`. If x belongs to the
//! piece of a triangle that was left coarse, then to the part around a corner of which nothing is known; the corner is a vertex of the
//! mesh, and what its distance comes to is counted. Any other x belongs to a triangle T that was looked at, and its bound is about the
//! *triangles* beside T, as sets of points: how far these stand for their own pieces does not matter. What the mesh shows is
//! triangles that face the eye. Their bounds count on the pieces of the triangles beside them, too ([`crate::certificate`]: a point
//! of T may be covered by a neighbour's piece), so that must not be as far off as it pleases. It is not: none beside a triangle that is left
//! coarse faces the eye, but across edges that nothing counts on anyway, sharp ones. So all that is seen of one has a point of the other
//! within the limit. That goes for outlines: the front's rim is where they are, and a ray that meets a closed surface, from outside, meets its
//! front; so pictures of both fronts are pictures of all there is.
//!
//! **Views** make angles depend on triangles (equation 11). One that looks away is not divided, and no part of the outline is missed, if all of
//! its piece does.

use super::surface::{Ground, Spot};
use crate::certificate::SubTriangle;
use crate::criterion::{Backs, Criteria, Region, Viewpoint};
use crate::facing::{is_back, is_back_but_for};
use crate::patch::{LimitPoint, Patch, Rules};
use crate::vector::{DVec3, unit_or_zero, vector};

/// What rounding may do to the side of a triangle's plane that a place is on, as a part of the product of the lengths.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The surface behind a triangle: all over the leaf that it covers, or a part of which.
pub(super) enum Behind<'a> {
    /// A node of a regular piece.
    Regular(&'a Ground, Spot),
    /// Any other.
    General(&'a Patch, &'a Rules<'a>),
}

impl Behind<'_> {
    /// How far from one of the triangle's corners what is not known to show its back is; `None` if that is more than `rest`.
    pub(super) fn is_back(&self, corners: &[LimitPoint; 3], viewpoint: &Viewpoint, rest: f64) -> Option<f64> {
        let sees_front = |corner: &LimitPoint| towards(viewpoint, corner.position).dot(corner.normal) > 0.0;
        if corners.iter().any(sees_front) {
            return None;
        }
        match self {
            Self::Regular(ground, spot) => {
                is_back(ground.net(*spot, SubTriangle::Whole).net(), viewpoint).then_some(0.0)
            }
            // Nothing of these is certain, distances neither.
            Self::General(Patch::Mesh(_), _) => Some(0.0),
            Self::General(patch, rules) => {
                let corners = corners.map(|corner| corner.position);
                is_back_but_for(patch, rules, viewpoint, (&corners, rest)).then_some(rest)
            }
        }
    }
}

/// Who sees nothing but the back of some triangles and of the first one's piece, of which [`Behind::is_back`] tells. That triangle's corners may
/// be moved by so much.
pub(super) fn looks_away(
    criteria: &Criteria,
    region: &Region,
    (triangles, moved): (&[[DVec3; 3]], f64),
    piece: impl Fn(&Viewpoint, f64) -> Option<f64>,
) -> Backs {
    if !criteria.has_backs() {
        return Backs::nobodys();
    }
    criteria.backs(region, |viewpoint, rest| {
        if !triangles.iter().all(|triangle| shows_back(triangle, viewpoint)) {
            return None;
        }
        let rest = piece(viewpoint, rest)?;
        Some(if rest > 0.0 { rest + moved } else { 0.0 })
    })
}

/// Whether a viewer is behind the plane of a triangle.
pub(super) fn shows_back(&[a, b, c]: &[DVec3; 3], viewpoint: &Viewpoint) -> bool {
    let (along, across) = (b - a, c - a);
    let sight = -towards(viewpoint, a);
    sight.dot(along.cross(across)) > ROUNDING * along.length() * across.length() * sight.length()
}

/// A vector from a point towards the viewer.
fn towards(viewpoint: &Viewpoint, point: DVec3) -> DVec3 {
    match *viewpoint {
        Viewpoint::Direction(sight) => -unit_or_zero(vector(sight)),
        Viewpoint::Eye(eye) => vector(eye) - point,
    }
}
