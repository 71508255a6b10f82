//! The surface over the control faces in pieces, each with a box that holds it.
//!
//! Coordinates are those of a [`SurfaceFrame`], in which the control mesh is about as large as 1.

use crate::geometry::SurfaceFrame;
use crate::geometry::box_tree::{Bounds, NO_BOUNDS, grown};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::patch::bicubic::Bicubic;
use crate::patch::polynomial::{Net, RegularPiece};
use crate::patch::{ParamTriangle, Patch, Points, Rules};
use crate::vector::DVec3;

/// Refinements of a face towards irregular corners before its pieces are kept.
const KEPT_LEVELS: u32 = 3;

/// Control faces up to which that is done: each takes some kilobytes. Beyond, pieces are refined
/// when visited.
const MOST_DIVIDED: usize = 40_000;

/// The rounding error of a box, as a part of the surface's size.
const ROUNDING: f64 = 1e-13;

/// A piece of the surface.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) face: u32,
    pub(super) domain: ParamTriangle,
    pub(super) form: Form,
}

/// The form of a piece.
#[derive(Clone, Debug)]
pub(super) enum Form {
    /// The points of a quartic, scaled.
    Quartic(Box<Points>),
    /// Half of a bicubic piece, scaled.
    Bicubic(Bicubic),
    /// A piece that is still to be refined, as in the control mesh.
    Irregular(Box<Patch>),
}

/// The weights of a part's second and third corner at the one that is a corner of the face, as in
/// pieces that stay irregular.
pub(super) fn control_corner(domain: ParamTriangle) -> Option<[f64; 2]> {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let is_control = |at: &[f64; 2]| domain.weights(*at).contains(&1.0);
    corners.into_iter().find(is_control)
}

/// The pieces over a face of a mesh with `faces` faces, and their boxes.
pub(crate) fn pieces(
    surface: &LimitSurface<'_>,
    frame: &SurfaceFrame,
    face: FaceId,
    faces: usize,
) -> Vec<(Bounds, Piece)> {
    let levels = if faces > MOST_DIVIDED { 0 } else { KEPT_LEVELS };
    let mut found = Vec::new();
    append(
        &mut found,
        (frame, surface.rules()),
        (face.0, ParamTriangle::WHOLE),
        surface.patch(face),
        levels,
    );
    found
}

fn append(
    found: &mut Vec<(Bounds, Piece)>,
    (frame, rules): (&SurfaceFrame, &Rules<'_>),
    (face, domain): (u32, ParamTriangle),
    patch: Patch,
    levels: u32,
) {
    let piece = |form| Piece { face, domain, form };
    let inside = |point: DVec3| frame.inside(point);
    match patch {
        Patch::Regular(points) => {
            let points = points.moved(inside);
            found.push((around(&points), piece(Form::Quartic(Box::new(points)))));
        }
        Patch::Bicubic(own) => {
            let own = own.moved(inside);
            found.push((around(&own), piece(Form::Bicubic(own))));
        }
        patch if levels == 0 => {
            let mut bounds = NO_BOUNDS;
            patch.for_each_hull_point(|point| bounds = grown(bounds, inside(point)));
            found.push((with_margin(bounds), piece(Form::Irregular(Box::new(patch)))));
        }
        patch => {
            let refined = patch.refined(rules);
            for own in 0..4 {
                append(
                    found,
                    (frame, rules),
                    (face, domain.child(own)),
                    refined.part(own),
                    levels - 1,
                );
            }
        }
    }
}

/// A box around a piece.
fn around(piece: &impl RegularPiece) -> Bounds {
    let net = piece.net();
    with_margin(net.points().iter().copied().fold(NO_BOUNDS, grown))
}

fn with_margin([low, high]: Bounds) -> Bounds {
    let margin = DVec3::splat(ROUNDING);
    [low - margin, high + margin]
}
