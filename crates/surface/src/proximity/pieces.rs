//! The surface over a control face in pieces, each in the hull of points that stand about the triangle of its corners.
//!
//! Distance to a triangle is convex: a piece in the hull of points that are within δ of a triangle is within δ of it, too. Coordinates
//! are those of a [`SurfaceFrame`], in which the control mesh is about as large as 1.

use super::convexity::Convexity;
use crate::geometry::box_tree::{Bounds, NO_BOUNDS, grown};
use crate::geometry::{SurfaceFrame, closest_to_origin};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::bicubic::Bicubic;
use crate::patch::polynomial::{Net, Polynomial, RegularPiece as _};
use crate::patch::{self, ParamTriangle, Patch, Quartic, Rules, child_corners};
use crate::vector::DVec3;

/// Refinements of a face towards irregular corners before its pieces are kept.
const KEPT_LEVELS: u32 = 3;

/// Regular pieces are quartered once if they leave their triangle by more than this part of their longest edge.
const FLAT: f64 = 0.02;

/// A piece of the surface.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// A box around its hull.
    pub(super) bounds: Bounds,
    /// The limits of its corners.
    pub(super) corners: [DVec3; 3],
    /// How far it is from the triangle of its corners at most.
    pub(super) height: f64,
    /// How far a point of it is at most from that of the triangle with the same weights.
    pub(super) deviation: f64,
    /// Where it is over the face.
    pub(super) domain: ParamTriangle,
    pub(super) form: Form,
}

/// The form of a piece.
#[derive(Clone, Debug)]
pub(super) enum Form {
    /// A polynomial.
    Regular(Box<RegularPiece>),
    /// A piece that is still to be refined.
    Irregular(Box<Patch>),
}

/// A polynomial, as seen from a point amid it.
#[derive(Clone, Debug)]
pub(super) struct RegularPiece {
    pub(super) origin: DVec3,
    pub(super) polynomial: Polynomial,
    /// `None` where it is not kept.
    pub(super) convexity: Option<Convexity>,
}

impl RegularPiece {
    pub(crate) fn convexity(&self) -> Convexity {
        match &self.polynomial {
            Polynomial::Quartic(quartic) => Convexity::of_quartic(&quartic.net([0.0, 0.0], 1.0)),
            Polynomial::Bicubic(piece) => Convexity::of_sextic(&piece.part_net()),
        }
    }
}

impl Piece {
    /// Of a net in the frame. The last argument gives the polynomial as seen from a point, by the net as seen from there.
    fn of_net<N: Net>(
        net: N,
        domain: ParamTriangle,
        polynomial: impl FnOnce(&N, DVec3) -> Polynomial,
    ) -> Self {
        let corners = net.corners();
        let origin = (corners[0] + corners[1] + corners[2]) / 3.0;
        let net = net.seen_from(origin);
        let own = corners.map(|corner| corner - origin);
        let (bounds, height) = hull(net.points().iter().copied(), own);
        let piece = RegularPiece {
            origin,
            polynomial: polynomial(&net, origin),
            convexity: None,
        };
        Self {
            bounds: bounds.map(|corner| corner + origin),
            corners,
            height,
            deviation: net
                .off_flat()
                .map(DVec3::length_squared)
                .fold(0.0, f64::max)
                .sqrt(),
            domain,
            form: Form::Regular(Box::new(piece)),
        }
    }

    fn of_patch(
        frame: &SurfaceFrame,
        patch: Patch,
        corners: [DVec3; 3],
        domain: ParamTriangle,
    ) -> Self {
        match patch {
            Patch::Regular(points) => return Self::of_points(frame, &points, domain),
            Patch::Bicubic(piece) => {
                return Self::of_bicubic(&piece.moved(|point| frame.inside(point)), domain);
            }
            _ => {}
        }
        let mut points = Vec::new();
        patch.for_each_hull_point(|point| points.push(frame.inside(point)));
        let (bounds, height) = hull(points.iter().copied(), corners);
        let spans = points
            .iter()
            .flat_map(|point| corners.map(|corner| point.distance(corner)));
        let deviation = spans.fold(0.0, f64::max);
        Self {
            bounds,
            corners,
            height,
            deviation,
            domain,
            form: Form::Irregular(Box::new(patch)),
        }
    }

    fn of_points(frame: &SurfaceFrame, points: &patch::Points, domain: ParamTriangle) -> Self {
        Self::of_quartic(points.moved(|point| frame.inside(point)).net(), domain)
    }

    fn of_quartic(net: BezierTriangle, domain: ParamTriangle) -> Self {
        Self::of_net(net, domain, |net, _| {
            Polynomial::Quartic(Quartic::of(net, 0))
        })
    }

    fn of_bicubic(piece: &Bicubic, domain: ParamTriangle) -> Self {
        Self::of_net(piece.part_net(), domain, |_, origin| {
            Polynomial::Bicubic(piece.moved(|point| point - origin))
        })
    }

    /// The pieces over its four parts.
    pub(crate) fn parts(&self, frame: &SurfaceFrame, rules: &Rules<'_>) -> [Self; 4] {
        match &self.form {
            Form::Regular(regular) => [0, 1, 2, 3].map(|part| {
                let (domain, back) = (self.domain.child(part), |point| point + regular.origin);
                match &regular.polynomial {
                    Polynomial::Quartic(quartic) => {
                        let ParamTriangle { u, v, size } = ParamTriangle::WHOLE.child(part);
                        let net = quartic.net([u, v], size);
                        Self::of_quartic(BezierTriangle(net.0.map(back)), domain)
                    }
                    Polynomial::Bicubic(piece) => {
                        Self::of_bicubic(&piece.child(part).moved(back), domain)
                    }
                }
            }),
            Form::Irregular(patch) => {
                let refined = patch.refined(rules);
                let middles = [0, 1, 2].map(|edge| frame.inside(refined.middle_as::<DVec3>(edge)));
                [0, 1, 2, 3].map(|part| match refined.points(part) {
                    Some(points) => Self::of_points(frame, &points, self.domain.child(part)),
                    None => {
                        let corners = child_corners(self.corners, middles, part);
                        Self::of_patch(frame, refined.part(part), corners, self.domain.child(part))
                    }
                })
            }
        }
    }

    /// With the data that decide how distances from it bend.
    fn with_convexity(mut self) -> Self {
        if let Form::Regular(regular) = &mut self.form {
            regular.convexity = Some(regular.convexity());
        }
        self
    }

    /// The longest edge of its triangle.
    fn longest_edge(&self) -> f64 {
        let [a, b, c] = self.corners;
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// Whether it is worth to keep its parts in its place.
    fn is_coarse(&self, level: u32) -> bool {
        match self.form {
            Form::Regular(_) => level == 0 && self.height > FLAT * self.longest_edge(),
            Form::Irregular(_) => level < KEPT_LEVELS,
        }
    }
}

/// A box around points, and how far they are from a triangle at most.
fn hull(points: impl Iterator<Item = DVec3>, [a, b, c]: [DVec3; 3]) -> (Bounds, f64) {
    let (mut bounds, mut squared) = ([a, b, c].into_iter().fold(NO_BOUNDS, grown), 0.0);
    for point in points {
        bounds = grown(bounds, point);
        squared = f64::max(
            squared,
            closest_to_origin(a - point, b - point, c - point).squared,
        );
    }
    (bounds, squared.sqrt())
}

/// The pieces over a control face.
#[derive(Clone, Debug)]
pub(super) struct FacePieces {
    pub(super) pieces: Vec<Piece>,
    /// Triangles between edges and their halves, where pieces were divided: together with the
    /// triangles of the pieces they have the boundary of the face's own triangle.
    pub(super) closing: Vec<[DVec3; 3]>,
}

impl FacePieces {
    pub(crate) fn of(surface: &LimitSurface<'_>, frame: &SurfaceFrame, face: FaceId) -> Self {
        let mut found = Self {
            pieces: Vec::new(),
            closing: Vec::new(),
        };
        found.append(whole(surface, frame, face), (frame, surface.rules()), 0);
        found
    }

    /// A box around all of them. Other triangles are in the hull of their corners.
    pub(super) fn bounds(&self) -> Bounds {
        joined(&self.pieces)
    }

    fn append(&mut self, piece: Piece, (frame, rules): (&SurfaceFrame, &Rules<'_>), level: u32) {
        if !piece.is_coarse(level) {
            self.pieces.push(piece.with_convexity());
            return;
        }
        let parts = piece.parts(frame, rules);
        self.closing.extend(closing(&piece, &parts));
        for part in parts {
            self.append(part, (frame, rules), level + 1);
        }
    }
}

/// The triangles between the edges of a piece and those of its parts.
pub(crate) fn closing(piece: &Piece, parts: &[Piece; 4]) -> [[DVec3; 3]; 3] {
    // Corner i of the middle part is on the edge opposite corner i.
    let middle = parts[3].corners;
    [0, 1, 2].map(|edge| {
        [
            piece.corners[edge],
            piece.corners[(edge + 1) % 3],
            middle[(edge + 2) % 3],
        ]
    })
}

/// All of the surface over a face.
fn whole(surface: &LimitSurface<'_>, frame: &SurfaceFrame, face: FaceId) -> Piece {
    let corners = surface.corner_positions(face);
    let corners = corners.map(|corner| frame.inside(corner));
    Piece::of_patch(frame, surface.patch(face), corners, ParamTriangle::WHOLE)
}

/// A box around the surface over a face and the triangle of its corners, where pieces are not kept: around its four parts, as the hull
/// of all its control points is far wider.
pub(super) fn bounds(surface: &LimitSurface<'_>, frame: &SurfaceFrame, face: FaceId) -> Bounds {
    joined(&whole(surface, frame, face).parts(frame, surface.rules()))
}

fn joined(pieces: &[Piece]) -> Bounds {
    pieces
        .iter()
        .flat_map(|piece| piece.bounds)
        .fold(NO_BOUNDS, grown)
}
