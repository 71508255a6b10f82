//! All places where one ray meets the surface.

use super::pieces::{Form, Piece, control_corner};
use super::planar::{Projection, extent, is_beside, meeting, nearest_on_edges, projection};
use super::{Crossing, Ray, RayOptions};
use crate::facing;
use crate::facing::Facing;
use crate::facing::Viewpoint;
use crate::geometry::SurfaceFrame;
use crate::geometry::box_tree::{Bounds, Search};
use crate::limit_surface::LimitSurface;
use crate::patch::polynomial::{Net, RegularPiece};
use crate::patch::{ParamTriangle, Patch};
use crate::vector::{DVec3, unit_or_zero, vector};

/// The most pieces visited for a ray. The others then count as grazed: a ray may run within a
/// surface that is nowhere flat.
const MOST_PIECES: usize = 100_000;

/// An undecided part is no larger than this many times the tolerance.
const SIZE: f64 = 10.0;

/// Coordinates along a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayFrame {
    /// The ray's point nearest to the middle of the surface.
    base: DVec3,
    axes: [DVec3; 3],
    /// How far along the ray, in units of its direction, the base is, and one unit of the frame.
    start: f64,
    unit: f64,
}

impl RayFrame {
    /// `None` for a ray that has no direction or is not finite.
    pub(crate) fn of(ray: &Ray, scale: &SurfaceFrame) -> Option<Self> {
        let sight = unit_or_zero(vector(ray.direction));
        let origin = scale.inside(vector(ray.origin));
        if sight == DVec3::ZERO || !origin.is_finite() {
            return None;
        }
        let across = unit_or_zero(sight.any_orthogonal_vector());
        let back = -origin.dot(sight);
        let length = greatest_length(vector(ray.direction));
        let unit = scale.size / length;
        let start = back * unit;
        (unit > 0.0 && unit.is_finite() && start.is_finite()).then_some(Self {
            base: origin + back * sight,
            axes: [across, sight.cross(across), sight],
            start,
            unit,
        })
    }

    fn inside(&self, point: DVec3) -> DVec3 {
        let from = point - self.base;
        DVec3::from_array(self.axes.map(|axis| axis.dot(from)))
    }

    /// Parameters of the ray from depths in the frame.
    pub(super) fn parameter(&self, depth: f64) -> f64 {
        self.start + depth * self.unit
    }

    pub(super) fn depth(&self, parameter: f64) -> f64 {
        (parameter - self.start) / self.unit
    }

    /// Where the ray enters a box and where it leaves it.
    fn within(&self, bounds: &Bounds) -> Option<[f64; 2]> {
        let sight = self.axes[2];
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (low, high) = (
                bounds[0][axis] - self.base[axis],
                bounds[1][axis] - self.base[axis],
            );
            if sight[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low / sight[axis], high / sight[axis]);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
        // Boxes have a margin for the rounding here.
        (first <= last).then_some([first, last])
    }
}

/// The length of a vector of any size.
fn greatest_length(v: DVec3) -> f64 {
    let greatest = v.abs().max_element();
    greatest * (v / greatest).length()
}

/// A meeting of the ray with the surface, in the frame's depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) depth: f64,
    pub(super) face: u32,
    pub(super) weights: [f64; 3],
    pub(super) crossing: Crossing,
}

/// A search along a ray.
pub(super) struct RaySearch<'a> {
    surface: &'a LimitSurface<'a>,
    scale: &'a SurfaceFrame,
    pieces: &'a [Piece],
    pub(super) frame: RayFrame,
    sight: Viewpoint,
    /// Depths that count.
    first: f64,
    last: f64,
    /// Nothing behind the first meeting counts.
    is_first_enough: bool,
    tolerance: f64,
    pub(super) found: Vec<Found>,
    /// Pieces that were visited.
    #[doc(hidden)]
    pub looked_at: usize,
}

impl<'a> RaySearch<'a> {
    pub(crate) fn new(
        (surface, scale, pieces): (&'a LimitSurface<'a>, &'a SurfaceFrame, &'a [Piece]),
        frame: RayFrame,
        options: &RayOptions,
        tolerance: f64,
        is_first_enough: bool,
    ) -> Self {
        let [a, b] = [options.from, options.to].map(|parameter| frame.depth(parameter));
        Self {
            surface,
            scale,
            pieces,
            frame,
            sight: Viewpoint::Direction(frame.axes[2].to_array()),
            first: a,
            last: b,
            is_first_enough,
            tolerance,
            found: Vec::new(),
            looked_at: 0,
        }
    }

    fn add(
        &mut self,
        (face, domain): (u32, ParamTriangle),
        at: [f64; 2],
        depth: f64,
        crossing: Crossing,
    ) {
        if depth < self.first || depth > self.last {
            return;
        }
        if self.is_first_enough {
            // A point met twice there is still found twice.
            self.last = self.last.min(depth + self.tolerance);
        }
        self.found.push(Found {
            depth,
            face,
            weights: domain.weights(at),
            crossing,
        });
    }

    /// Whether the hull of a piece's points is beyond the ray's sides, before its start or behind
    /// its end.
    fn is_missed(
        &self,
        points: impl Iterator<Item = DVec3> + Clone,
        corners: Option<[DVec3; 3]>,
    ) -> bool {
        let depths = points.clone().map(|point| point.z);
        let (low, high) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
            (low.min(z), high.max(z))
        });
        high < self.first - self.tolerance
            || low > self.last + self.tolerance
            || is_beside(points, corners)
    }

    /// A regular piece, its points in the ray's frame.
    fn regular(&mut self, piece: &impl RegularPiece, place: (u32, ParamTriangle)) {
        self.looked_at += 1;
        let net = piece.net();
        if self.is_missed(net.points().iter().copied(), Some(net.corners())) {
            return;
        }
        let projection = projection(&net);
        if projection == Projection::Injective
            && let Some(meeting) = meeting(&piece.polynomial(&net), net.corners())
        {
            let crossing = if meeting.is_front {
                Crossing::Entering
            } else {
                Crossing::Leaving
            };
            return self.add(place, meeting.at, meeting.depth, crossing);
        }
        let bulge = || {
            net.off_flat()
                .map(|off| off.abs().max_element())
                .fold(0.0, f64::max)
        };
        let is_small = extent(net.points().iter().copied()) < SIZE * self.tolerance;
        if is_small
            || self.looked_at > MOST_PIECES
            || projection == Projection::EdgeOn && bulge() < self.tolerance
        {
            let (at, depth, distance) = nearest_on_edges(net.corners(), self.tolerance);
            if is_small || self.looked_at > MOST_PIECES || distance <= self.tolerance {
                self.add(place, at, depth, Crossing::Grazing);
            }
            return;
        }
        for (number, part) in piece.parts().iter().enumerate() {
            self.regular(part, (place.0, place.1.child(number)));
        }
    }

    /// A piece that is to be refined.
    fn irregular(&mut self, patch: &Patch, place: (u32, ParamTriangle)) {
        let (frame, scale) = (self.frame, *self.scale);
        let inside = |point: DVec3| frame.inside(scale.inside(point));
        match patch {
            Patch::Regular(points) => return self.regular(&points.moved(inside), place),
            Patch::Bicubic(piece) => return self.regular(&piece.moved(inside), place),
            _ => {}
        }
        self.looked_at += 1;
        let mut points = smallvec::SmallVec::<[DVec3; 32]>::new();
        patch.for_each_hull_point(|point| points.push(inside(point)));
        if self.is_missed(points.iter().copied(), None) {
            return;
        }
        let corner = control_corner(place.1);
        // Other halves of quads at irregular vertices are regular after a step.
        let is_last = corner.is_some() || !matches!(patch, Patch::Quad(_));
        let is_small = is_last && extent(points.iter().copied()) < SIZE * self.tolerance;
        if is_small || self.looked_at > MOST_PIECES {
            let count = points.len() as f64;
            let middle = points.iter().map(|point| point / count).sum::<DVec3>();
            let crossing = match facing::of_patch(patch, self.surface.rules(), &self.sight, 0) {
                Facing::Front => Crossing::Entering,
                Facing::Back => Crossing::Leaving,
                Facing::Undecided => Crossing::Grazing,
            };
            let at = corner.unwrap_or([1.0 / 3.0; 2]);
            return self.add(place, at, middle.z, crossing);
        }
        let refined = patch.refined(self.surface.rules());
        for part in 0..4 {
            self.irregular(&refined.part(part), (place.0, place.1.child(part)));
        }
    }
}

impl Search for RaySearch<'_> {
    fn bound(&self, bounds: &Bounds) -> f64 {
        match self.frame.within(bounds) {
            Some([enters, leaves]) if leaves >= self.first - self.tolerance => enters,
            _ => f64::INFINITY,
        }
    }

    fn limit(&self) -> f64 {
        self.last + self.tolerance
    }

    fn visit(&mut self, item: u32) {
        let pieces = self.pieces;
        let piece = &pieces[item as usize];
        let place = (piece.face, piece.domain);
        let frame = self.frame;
        let inside = |point: DVec3| frame.inside(point);
        match &piece.form {
            Form::Quartic(points) => self.regular(&points.moved(inside), place),
            Form::Bicubic(piece) => self.regular(&piece.moved(inside), place),
            Form::Irregular(patch) => self.irregular(patch, place),
        }
    }
}
