//! How far a function over a piece is from its linear interpolation: values at the same places, not surfaces.
//!
//! Over a regular piece (and over half of a bicubic one, by a net of degree six) function and interpolation both are Bézier nets, the latter's points being
//! linear in their indices; so is their difference, whose points' lengths bound its own (Farin,
//! "Triangular Bernstein–Bézier patches", 1986). Around an irregular vertex the piece is refined,
//! and the rest at the vertex is bounded by its control points: two convex hulls are nowhere
//! farther from each other than two of their points.

use super::greater;
use super::net::Net;
use super::net_part::NetPart;
use super::sub_triangle::SubTriangle;
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{Patch, Rules, child_corners};
use crate::vector::DVec3;

/// Refinements at most: the rest has shrunk below rounding then.
const DEEPEST: usize = 40;

/// Levels whose vertices are compared where nothing can be certified.
const SAMPLED_LEVELS: usize = 3;

/// Halvings of a net whose bound is too great.
const HALVINGS: usize = 3;

/// The rest at an irregular vertex is good enough at this part of the tolerance.
const NEGLIGIBLE: f64 = 0.125;

/// A function over a piece of the control mesh, and its values at the corners.
#[derive(Clone, Debug)]
pub(crate) struct ParamPatch {
    pub(crate) patch: Patch,
    pub(crate) corners: [DVec3; 3],
}

impl ParamPatch {
    /// The surface over a control face, and the rules by which it is refined.
    pub(crate) fn over<'s, 'a>(
        surface: &'s LimitSurface<'a>,
        face: FaceId,
    ) -> (Self, &'s Rules<'a>) {
        let corners = surface.corner_positions(face);
        let patch = surface.patch(face);
        (Self { patch, corners }, surface.rules())
    }

    /// The bounds over the four parts.
    pub(crate) fn children(&self, rules: &Rules<'_>) -> [Self; 4] {
        let refined = self.patch.refined(rules);
        let middles = [0, 1, 2].map(|edge| refined.middle_as::<DVec3>(edge));
        [0, 1, 2, 3].map(|child| {
            let corners = child_corners(self.corners, middles, child);
            Self {
                patch: refined.part(child),
                corners,
            }
        })
    }

    /// The function's values at the corners of a part, in its order.
    pub(crate) fn corners_of(&self, part: SubTriangle, rules: &Rules<'_>) -> [DVec3; 3] {
        if part == SubTriangle::Whole {
            return self.corners;
        }
        let refined = self.patch.refined(rules);
        part.corners(
            self.corners,
            [0, 1, 2].map(|edge| refined.middle_as::<DVec3>(edge)),
        )
    }

    /// A bound of how far the function is from the linear one with its values at the corners of a part, anywhere there; tight only
    /// above `target`. Of schemes of no known family an estimate from samples.
    pub(crate) fn off_linear(&self, part: SubTriangle, target: f64, rules: &Rules<'_>) -> f64 {
        self.off(
            part,
            self.corners_of(part, rules),
            self.corners,
            target,
            rules,
        )
    }

    /// The bound for the linear function with other values at the part's corners. Where the
    /// function is not regular over a part that is neither all nor a quarter, the bound is by the
    /// linear function with the second values, at the corners of the whole.
    pub(crate) fn off(
        &self,
        part: SubTriangle,
        own: [DVec3; 3],
        whole: [DVec3; 3],
        target: f64,
        rules: &Rules<'_>,
    ) -> f64 {
        let mut search = Search {
            rules,
            target,
            found: 0.0,
        };
        match (&self.patch, part) {
            (_, SubTriangle::Whole) => {
                search.found = greatest_distance(own, self.corners);
                search.patch(&self.patch, own, 0);
            }
            (_, SubTriangle::Child(child)) => {
                search.found = greatest_distance(own, self.corners_of(part, rules));
                search.patch(&self.patch.refined(rules).part(child), own, 1);
            }
            (Patch::Regular(points), _) => {
                let part = NetPart::own(&BezierTriangle::of(points), part);
                search.net(part.net(), own, HALVINGS);
            }
            // Both linear functions differ by no more than at the corners.
            _ => {
                let apart = greatest_distance(own, part.corners(whole, middles(whole)));
                search.target -= apart;
                search.patch(&self.patch, whole, 0);
                search.found += apart;
            }
        }
        search.found
    }
}

/// The greatest distance between points of the same number.
fn greatest_distance(a: [DVec3; 3], b: [DVec3; 3]) -> f64 {
    (0..3).map(|i| a[i].distance(b[i])).fold(0.0, greater)
}

struct Search<'a> {
    rules: &'a Rules<'a>,
    target: f64,
    found: f64,
}

impl Search<'_> {
    /// Less than this adds nothing, or is good enough.
    fn aim(&self) -> f64 {
        greater(self.found, self.target)
    }

    fn patch(&mut self, patch: &Patch, linear: [DVec3; 3], depth: usize) {
        match patch {
            Patch::Regular(points) => {
                return self.net(&BezierTriangle::of(points), linear, HALVINGS);
            }
            Patch::Bicubic(piece) => {
                let net = piece.net(piece.part.corners(), |point| point);
                return self.net(&net, linear, HALVINGS);
            }
            Patch::Mesh(_) => return self.samples(patch, linear, SAMPLED_LEVELS),
            _ => {}
        }
        let mut farthest = 0.0;
        patch.for_each_hull_point(|point| {
            let apart = linear
                .iter()
                .map(|corner| point.distance(*corner))
                .fold(0.0, greater);
            farthest = greater(farthest, apart);
        });
        if depth >= DEEPEST || farthest <= greater(self.found, NEGLIGIBLE * self.target) {
            self.found = greater(self.found, farthest);
            return;
        }
        let refined = patch.refined(self.rules);
        for regular in [true, false] {
            for child in (0..4).filter(|&child| refined.is_regular(child) == regular) {
                self.patch(
                    &refined.part(child),
                    child_corners(linear, middles(linear), child),
                    depth + 1,
                );
            }
        }
    }

    fn net<N: Net<DVec3>>(&mut self, net: &N, linear: [DVec3; 3], halvings: usize) {
        let [a, b, c] = linear;
        let share = 1.0 / N::DEGREE as f64;
        let (mut points, mut apart) = (net.points().iter(), 0.0);
        for k in 0..=N::DEGREE {
            for (j, point) in (0..=N::DEGREE - k).zip(&mut points) {
                let [i, j, k] = [N::DEGREE - j - k, j, k].map(|index| share * index as f64);
                apart = greater(apart, point.distance(i * a + j * b + k * c));
            }
        }
        if halvings == 0 || apart <= self.aim() {
            self.found = greater(self.found, apart);
            return;
        }
        let (edge, next) = (halvings % 3, (halvings + 1) % 3);
        let middle = middles(linear)[edge];
        for (half, lost) in net.halves(edge).iter().zip([next, edge]) {
            let mut own = linear;
            own[lost] = middle;
            self.net(half, own, halvings - 1);
        }
    }

    fn samples(&mut self, patch: &Patch, linear: [DVec3; 3], levels: usize) {
        let refined = patch.refined(self.rules);
        for (edge, middle) in middles(linear).into_iter().enumerate() {
            self.found = greater(
                self.found,
                refined.middle_as::<DVec3>(edge).distance(middle),
            );
        }
        if levels > 1 {
            for child in 0..4 {
                self.samples(
                    &refined.part(child),
                    child_corners(linear, middles(linear), child),
                    levels - 1,
                );
            }
        }
    }
}

/// A linear function in the middles of the edges.
fn middles([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    [a + b, b + c, c + a].map(|sum| 0.5 * sum)
}
