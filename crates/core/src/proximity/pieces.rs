//! The surface over a control face in pieces, each in the hull of points that stand about the triangle of its corners.
//!
//! Distance to a triangle is convex: a piece in the hull of points that are within δ of a triangle is within δ of it, too. Coordinates
//! are those of a [`Frame`], in which the control mesh is about as large as 1.

use super::convexity::Convexity;
use crate::geometry::box_tree::{Bounds, NO_BOUNDS, grown};
use crate::geometry::closest_to_origin;
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{self, Patch, Quartic, Rules, child_corners};
use crate::vector::{DVec3, diagonal, vector};

/// Refinements of a face towards irregular corners before its pieces are kept as they are.
const KEPT_LEVELS: u32 = 3;

/// Regular pieces are quartered once if they leave their triangle by more than this part of their longest edge.
const FLAT: f64 = 0.02;

/// Coordinates that are about as large as 1, so that squares of lengths neither vanish nor overflow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    middle: DVec3,
    size: f64,
}

impl Frame {
    pub(super) fn of([low, high]: Bounds) -> Self {
        let size = diagonal(0.5 * low, 0.5 * high);
        Self { middle: 0.5 * low + 0.5 * high, size: if size > 0.0 && size.is_finite() { size } else { 1.0 } }
    }

    /// A point in the frame.
    pub(super) fn inside(&self, point: [f64; 3]) -> DVec3 {
        self.of_vector(vector(point))
    }

    fn of_vector(&self, point: DVec3) -> DVec3 {
        (point - self.middle) / self.size
    }

    /// A length in the frame.
    pub(super) fn length_within(&self, length: f64) -> f64 {
        length / self.size
    }

    /// A point of the frame, outside.
    pub(super) fn outside(&self, point: DVec3) -> [f64; 3] {
        (self.size * point + self.middle).to_array()
    }

    /// A length of the frame, outside.
    pub(super) fn length_outside(&self, length: f64) -> f64 {
        self.size * length
    }
}

/// Where a part lies in the parameters of a face: those of its first corner, and its size, below 0 where it stands on its head.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    corner: [f64; 2],
    size: f64,
}

impl Part {
    const WHOLE: Self = Self { corner: [0.0, 0.0], size: 1.0 };

    /// Those at the corners and the middle one, as [`patch::RefinedPatch`] numbers them.
    const PARTS: [Self; 4] = [
        Self { corner: [0.0, 0.0], size: 0.5 },
        Self { corner: [0.5, 0.0], size: 0.5 },
        Self { corner: [0.0, 0.5], size: 0.5 },
        Self { corner: [0.5, 0.5], size: -0.5 },
    ];

    fn part(self, part: usize) -> Self {
        let own = Self::PARTS[part];
        Self { corner: self.at(own.corner), size: self.size * own.size }
    }

    /// Where (u, v) of the part is in the face.
    fn at(self, [u, v]: [f64; 2]) -> [f64; 2] {
        [self.corner[0] + self.size * u, self.corner[1] + self.size * v]
    }

    /// The weights of the face's corners at (u, v) of the part.
    pub(super) fn weights(self, at: [f64; 2]) -> [f64; 3] {
        let [u, v] = self.at(at);
        [1.0 - u - v, u, v].map(|weight| weight.clamp(0.0, 1.0))
    }
}

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
    pub(super) part: Part,
    pub(super) form: Form,
}

/// What a piece is made of.
#[derive(Clone, Debug)]
pub(super) enum Form {
    /// A polynomial.
    Regular(Box<RegularPiece>),
    /// What is still to be refined.
    Irregular(Box<Patch>),
}

/// A polynomial, as seen from a point amid it.
#[derive(Clone, Debug)]
pub(super) struct RegularPiece {
    pub(super) origin: DVec3,
    pub(super) quartic: Quartic,
    /// `None` where it is not kept.
    pub(super) convexity: Option<Convexity>,
}

impl RegularPiece {
    pub(super) fn convexity(&self) -> Convexity {
        Convexity::of(&self.quartic.net([0.0, 0.0], 1.0))
    }
}

impl Piece {
    /// Of a net in the frame.
    fn of_net(net: &BezierTriangle, part: Part) -> Self {
        let corners = net.corners();
        let origin = (corners[0] + corners[1] + corners[2]) / 3.0;
        let net = BezierTriangle(net.0.map(|point| point - origin));
        let own = corners.map(|corner| corner - origin);
        let (bounds, height) = hull(net.0.into_iter(), own);
        let piece = RegularPiece { origin, quartic: Quartic::of(&net, 0), convexity: None };
        Self {
            bounds: bounds.map(|corner| corner + origin),
            corners,
            height,
            deviation: deviation(&net),
            part,
            form: Form::Regular(Box::new(piece)),
        }
    }

    fn of_patch(frame: &Frame, patch: Patch, corners: [DVec3; 3], part: Part) -> Self {
        if let Patch::Regular(points) = patch {
            return Self::of_points(frame, &points, part);
        }
        let mut points = Vec::new();
        patch.for_each_hull_point(|point| points.push(frame.of_vector(point)));
        let (bounds, height) = hull(points.iter().copied(), corners);
        let spans = points.iter().flat_map(|point| corners.map(|corner| point.distance(corner)));
        let deviation = spans.fold(0.0, f64::max);
        Self { bounds, corners, height, deviation, part, form: Form::Irregular(Box::new(patch)) }
    }

    fn of_points(frame: &Frame, points: &patch::Points, part: Part) -> Self {
        Self::of_net(&BezierTriangle::of(&points.map(|point| frame.of_vector(point))), part)
    }

    /// The pieces over its four parts.
    pub(super) fn parts(&self, frame: &Frame, rules: &Rules<'_>) -> [Self; 4] {
        match &self.form {
            Form::Regular(regular) => [0, 1, 2, 3].map(|part| {
                let Part { corner, size } = Part::PARTS[part];
                let net = regular.quartic.net(corner, size).0.map(|point| point + regular.origin);
                Self::of_net(&BezierTriangle(net), self.part.part(part))
            }),
            Form::Irregular(patch) => {
                let refined = patch.refined(rules);
                let middles = [0, 1, 2].map(|edge| frame.of_vector(refined.middle(edge).position));
                [0, 1, 2, 3].map(|part| match refined.points(part) {
                    Some(points) => Self::of_points(frame, &points, self.part.part(part)),
                    None => {
                        let corners = child_corners(self.corners, middles, part);
                        Self::of_patch(frame, refined.part(part), corners, self.part.part(part))
                    }
                })
            }
        }
    }

    /// With what decides how distances from it bend.
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
        squared = f64::max(squared, closest_to_origin(a - point, b - point, c - point).squared);
    }
    (bounds, squared.sqrt())
}

/// How far a net is at most from that of its triangle: the greatest distance of points with the same weights.
fn deviation(net: &BezierTriangle) -> f64 {
    let [a, b, c] = net.corners();
    let mut greatest = 0.0;
    let places = (0..5).flat_map(|k| (0..5 - k).map(move |j| (f64::from(j), f64::from(k))));
    for (point, (j, k)) in net.0.iter().zip(places) {
        let flat = 0.25 * ((4.0 - j - k) * a + j * b + k * c);
        greatest = f64::max(greatest, point.distance_squared(flat));
    }
    greatest.sqrt()
}

/// The pieces over a control face.
#[derive(Clone, Debug)]
pub(super) struct FacePieces {
    pub(super) pieces: Vec<Piece>,
    /// Triangles between edges and their halves, where pieces were divided: with those of the pieces they close what the face's own
    /// triangle bounds.
    pub(super) closing: Vec<[DVec3; 3]>,
}

impl FacePieces {
    pub(super) fn of(surface: &LimitSurface<'_>, frame: &Frame, face: FaceId) -> Self {
        let mut found = Self { pieces: Vec::new(), closing: Vec::new() };
        found.append(whole(surface, frame, face), (frame, surface.rules()), 0);
        found
    }

    /// A box around all of them. Other triangles are in the hull of their corners.
    pub(super) fn bounds(&self) -> Bounds {
        joined(&self.pieces)
    }

    fn append(&mut self, piece: Piece, (frame, rules): (&Frame, &Rules<'_>), level: u32) {
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
pub(super) fn closing(piece: &Piece, parts: &[Piece; 4]) -> [[DVec3; 3]; 3] {
    // Corner i of the middle part is on the edge opposite corner i.
    let middle = parts[3].corners;
    [0, 1, 2].map(|edge| [piece.corners[edge], piece.corners[(edge + 1) % 3], middle[(edge + 2) % 3]])
}

/// All of the surface over a face.
fn whole(surface: &LimitSurface<'_>, frame: &Frame, face: FaceId) -> Piece {
    let (sheet, _) = surface.sheet(face);
    let corners = sheet.corners.map(|corner| frame.of_vector(corner));
    Piece::of_patch(frame, sheet.patch, corners, Part::WHOLE)
}

/// A box around the surface over a face and the triangle of its corners, where pieces are not kept: around its four parts, as the hull
/// of all its control points is far wider.
pub(super) fn bounds(surface: &LimitSurface<'_>, frame: &Frame, face: FaceId) -> Bounds {
    joined(&whole(surface, frame, face).parts(frame, surface.rules()))
}

fn joined(pieces: &[Piece]) -> Bounds {
    pieces.iter().flat_map(|piece| piece.bounds).fold(NO_BOUNDS, grown)
}
