//! The surface over the control faces in pieces, each with a box that holds it.
//!
//! Coordinates are those of a [`Scale`], in which the control mesh is about as large as 1.

use crate::geometry::box_tree::{Bounds, NO_BOUNDS, grown};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{Patch, Points, Rules};
use crate::vector::{DVec3, diagonal};

/// Refinements of a face towards irregular corners before its pieces are kept as they are.
const KEPT_LEVELS: u32 = 3;

/// Control faces up to which that is done: each takes some kilobytes. Beyond, pieces are refined when they are looked at.
const MOST_DIVIDED: usize = 40_000;

/// What rounding may do to a box, as a part of the surface's size.
const ROUNDING: f64 = 1e-13;

/// Coordinates in which a surface is about as large as 1, so that squares of lengths neither vanish nor overflow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) middle: DVec3,
    pub(super) size: f64,
}

impl Scale {
    pub(super) fn of([low, high]: Bounds) -> Self {
        let size = diagonal(0.5 * low, 0.5 * high);
        Self { middle: 0.5 * low + 0.5 * high, size: if size > 0.0 && size.is_finite() { size } else { 1.0 } }
    }

    pub(super) fn inside(&self, point: DVec3) -> DVec3 {
        (point - self.middle) / self.size
    }
}

/// Where a part lies in the parameters of a face: those of its first corner, and its size, below 0 where it stands on its head.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    corner: [f64; 2],
    size: f64,
}

impl Part {
    pub(super) const WHOLE: Self = Self { corner: [0.0, 0.0], size: 1.0 };

    /// One of the four parts, as [`crate::patch::RefinedPatch`] numbers them.
    pub(super) fn part(self, part: usize) -> Self {
        let half = 0.5 * self.size;
        let [u, v] = self.corner;
        match part {
            0 => Self { corner: [u, v], size: half },
            1 => Self { corner: [u + half, v], size: half },
            2 => Self { corner: [u, v + half], size: half },
            _ => Self { corner: [u + half, v + half], size: -half },
        }
    }

    /// The weights of the part's second and third corner at the one that is a corner of the face, as it is where pieces stay irregular; its
    /// middle's where there is none.
    pub(super) fn control_corner(self) -> [f64; 2] {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let is_control = |at: &[f64; 2]| self.weights(*at).contains(&1.0);
        corners.into_iter().find(is_control).unwrap_or([1.0 / 3.0; 2])
    }

    /// The weights of the face's corners where those of the part's second and third corner are given.
    pub(super) fn weights(self, [u, v]: [f64; 2]) -> [f64; 3] {
        let [u, v] = [self.corner[0] + self.size * u, self.corner[1] + self.size * v];
        [1.0 - u - v, u, v].map(|weight| weight.clamp(0.0, 1.0))
    }
}

/// A piece of the surface.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) face: u32,
    pub(super) part: Part,
    pub(super) form: Form,
}

/// What a piece is made of.
#[derive(Clone, Debug)]
pub(super) enum Form {
    /// The points of a polynomial, scaled.
    Regular(Box<Points>),
    /// What is still to be refined, as it is in the control mesh.
    Irregular(Box<Patch>),
}

/// The pieces of all faces, and their boxes.
pub(super) fn pieces(
    surface: &LimitSurface<'_>,
    scale: &Scale,
    face: FaceId,
    most: usize,
) -> Vec<(Bounds, Piece)> {
    let levels = if most > MOST_DIVIDED { 0 } else { KEPT_LEVELS };
    let (sheet, rules) = surface.sheet(face);
    let mut found = Vec::new();
    append(&mut found, (scale, rules), (face.0, Part::WHOLE), sheet.patch, levels);
    found
}

fn append(
    found: &mut Vec<(Bounds, Piece)>,
    (scale, rules): (&Scale, &Rules<'_>),
    (face, part): (u32, Part),
    patch: Patch,
    levels: u32,
) {
    let piece = |form| Piece { face, part, form };
    let margin = DVec3::splat(ROUNDING);
    let with_margin = |[low, high]: Bounds| [low - margin, high + margin];
    match patch {
        Patch::Regular(points) => {
            let points = points.map(|point| scale.inside(point));
            let bounds = BezierTriangle::of(&points).0.into_iter().fold(NO_BOUNDS, grown);
            found.push((with_margin(bounds), piece(Form::Regular(Box::new(points)))));
        }
        patch if levels == 0 => {
            let mut bounds = NO_BOUNDS;
            patch.for_each_hull_point(|point| bounds = grown(bounds, scale.inside(point)));
            found.push((with_margin(bounds), piece(Form::Irregular(Box::new(patch)))));
        }
        patch => {
            let refined = patch.refined(rules);
            for own in 0..4 {
                append(found, (scale, rules), (face, part.part(own)), refined.part(own), levels - 1);
            }
        }
    }
}
