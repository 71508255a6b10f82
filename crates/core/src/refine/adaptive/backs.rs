//! Triangles that face away from a viewer for certain, with their adjacent triangles and their pieces of the surface. They may stay coarse.
//!
//! Takes a triangle, its piece, and criteria with viewers; gives who sees nothing but backs. Nothing is asked of such a triangle for
//! their sake.
//!
//! **Why that is enough**, for a camera before a closed surface. What the surface shows is its front: x with `(e − x)·N > 0`. If x belongs to the
//! piece of a triangle that was left coarse, then to the part around a corner of which nothing is known; the corner is a vertex of the
//! mesh, and its distance is counted. Any other x belongs to a triangle T that was looked at, and its bound is about the
//! *triangles* adjacent to T, as sets of points: how well these approximate their own pieces does not matter. The mesh shows
//! triangles that face the eye. Their bounds count on the pieces of adjacent triangles, too ([`crate::certificate`]: a point
//! of T may be covered by a neighbour's piece), so that must not be as far off as it pleases. It is not: none adjacent to a triangle that is left
//! coarse faces the eye, but across edges that nothing counts on anyway, sharp ones. So all that is seen of one has a point of the other
//! within the limit. That goes for outlines: the front's rim is where they are, and a ray that meets a closed surface, from outside, meets its
//! front; so pictures of both fronts are pictures of all there is.
//!
//! **Views** make angles depend on triangles (equation 11). One that looks away is not divided, and no part of the outline is missed, if all of
//! its piece does.

use super::back_faces::BackFaces;
use super::control::Control;
use super::emitted::{Emitted, Over};
use super::surface::QuarticPiece;
use crate::certificate::SubTriangle;
use crate::criterion::{Backs, Criteria, Region, Viewpoint};
use crate::facing::{DEEPEST, back_but_for, is_back};
use crate::patch::{LimitPoint, ParamTriangle, Patch, Rules};
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, unit_or_zero, vector};

impl BackFaces {
    /// Where vertices move, only faces that face away all over: it is not known how far a control face's corners move.
    pub(super) fn of(
        control: &Control<'_>,
        is_balanced: bool,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let Some(criteria) = &control.criteria else {
            return Ok(Self::default());
        };
        let viewers = criteria.viewers();
        let faces = control.mesh.face_count();
        // Where there are more control faces times viewers, leaves are looked at one by one.
        if viewers == 0 || faces > (1 << 23) / viewers || !control.rules.is_certified() {
            return Ok(Self::default());
        }
        let nobody = Self::default();
        let blocks = watch.long_shares(faces, |block, is_stopped| {
            let mut rests = vec![f64::NAN; block.len() * viewers];
            for (face, rests) in block.zip(rests.chunks_mut(viewers)) {
                if is_stopped() {
                    break;
                }
                let (corners, mut patch) = (control.corners(face as u32), None);
                let triangle = corners.map(|corner| corner.position);
                let mut look = |(viewer, viewpoint): (usize, &Viewpoint), rest| {
                    let patch = patch.get_or_insert_with(|| control.patch(face as u32));
                    let leaf = Leaf::General(patch, control.rules);
                    let behind = Behind {
                        faces: &nobody,
                        face: face as u32,
                        leaf,
                    };
                    let found = behind.is_back(&corners, (viewer, viewpoint), rest);
                    rests[viewer] = found
                        .filter(|&rest| !is_balanced || rest == 0.0)
                        .unwrap_or(f64::NAN);
                    found
                };
                let region = Region::around(triangle, DVec3::ZERO);
                looks_away(criteria, &region, &[triangle], 0.0, &mut look);
            }
            rests
        })?;
        Ok(Self::new(viewers, blocks.concat()))
    }
}

/// The surface over a leaf, behind a triangle that covers it or a part of it.
pub(super) struct Behind<'a> {
    pub(super) faces: &'a BackFaces,
    /// The control face.
    pub(super) face: u32,
    pub(super) leaf: Leaf<'a>,
}

/// A leaf's piece.
pub(super) enum Leaf<'a> {
    /// A part of a regular piece.
    Regular(&'a QuarticPiece, ParamTriangle),
    /// Any other.
    General(&'a Patch, &'a Rules<'a>),
}

impl<'a> Behind<'a> {
    /// The surface behind an emitted triangle.
    pub(super) fn of(
        faces: &'a BackFaces,
        emitted: &Emitted,
        over: &'a Over<'_, '_>,
        rules: &'a Rules<'a>,
    ) -> Self {
        let leaf = match over {
            Over::Regular(quartic, _, domain) => Leaf::Regular(quartic, *domain),
            Over::General(pieces, ..) => Leaf::General(pieces.patch(), rules),
        };
        Self {
            faces,
            face: emitted.place.face,
            leaf,
        }
    }

    /// How far from a vertex of the mesh what is not known to show a viewer its back is; `None` if that is more than
    /// `rest`, or than it is allowed for its whole control face. The limits at the triangle's corners are given.
    pub(super) fn is_back(
        &self,
        corners: &[LimitPoint; 3],
        (viewer, viewpoint): (usize, &Viewpoint),
        rest: f64,
    ) -> Option<f64> {
        if let Some(rest) = self.faces.rest(self.face, viewer) {
            return Some(rest);
        }
        if shows_front(corners, viewpoint) {
            return None;
        }
        match self.leaf {
            Leaf::Regular(quartic, domain) => {
                is_back(quartic.net(domain, SubTriangle::Whole).net(), viewpoint).then_some(0.0)
            }
            // Nothing of these is certain, distances neither.
            Leaf::General(Patch::Mesh(_), _) => Some(0.0),
            Leaf::General(patch, rules) => {
                let corners = corners.map(|corner| corner.position);
                back_but_for(patch, rules, viewpoint, (&corners, rest), DEEPEST)
            }
        }
    }
}

/// The viewers that see nothing but the back of some triangles and of the first one's piece, by [`Behind::is_back`]. That triangle's corners may
/// be moved by so much.
pub(super) fn looks_away(
    criteria: &Criteria,
    region: &Region,
    triangles: &[[DVec3; 3]],
    moved: f64,
    mut piece: impl FnMut((usize, &Viewpoint), f64) -> Option<f64>,
) -> Backs {
    criteria.backs(region, |viewer, viewpoint, rest| {
        if !triangles
            .iter()
            .all(|triangle| shows_back(triangle, viewpoint))
        {
            return None;
        }
        let rest = piece((viewer, viewpoint), rest)?;
        Some(if rest > 0.0 { rest + moved } else { 0.0 })
    })
}

/// Whether a viewer sees the front at some point.
fn shows_front(points: &[LimitPoint], viewpoint: &Viewpoint) -> bool {
    points
        .iter()
        .any(|point| towards(viewpoint, point.position).dot(point.normal) > 0.0)
}

/// Whether a viewer is behind the plane of a triangle.
pub(super) fn shows_back(&[a, b, c]: &[DVec3; 3], viewpoint: &Viewpoint) -> bool {
    let (along, across) = (b - a, c - a);
    let sight = -towards(viewpoint, a);
    // Rounding changes this by no more than 16 units in the last place of the product of the lengths.
    sight.dot(along.cross(across))
        > 16.0 * f64::EPSILON * along.length() * across.length() * sight.length()
}

/// A vector from a point towards the viewer.
fn towards(viewpoint: &Viewpoint, point: DVec3) -> DVec3 {
    match *viewpoint {
        Viewpoint::Direction(sight) => -unit_or_zero(vector(sight)),
        Viewpoint::Eye(eye) => vector(eye) - point,
    }
}
