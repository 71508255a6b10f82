//! The certificate of one triangle: how far it and a piece of the limit surface can be from each other.
//!
//! Let S be the limit surface over a domain triangle D and T the triangle that approximates it, its
//! corners on those of S. Hull points are points whose convex hull holds a piece of S or of one of
//! its boundary curves: Bézier points of regular pieces, images of the characteristic map's at
//! irregular vertices. Functions that are convex are greatest over the hull at one of its points.
//! Two bounds are taken.
//!
//! **On its own** ([`Deviation::own`]). The distance to the convex set T is convex, so the hull
//! points bound how far S is from T. For the other way let δ bound the distances of the boundary
//! curves to their edges and h the height of S over the plane of T. Every point q of T has a point
//! of S within max(δ, h): project S on the plane. If the projection covers q, there is one within
//! h. If it doesn't, the projected boundary does not wind round q, while the boundary of T does;
//! deforming the one into the other, each point moving straight to its base point, the closest one
//! on its edge, must pass over q. So q lies between some curve point's projection and its base
//! point, and is at most as far from that curve point as its base point is: δ. (A T without area is
//! the union of its edges, for which the curves alone do.)
//!
//! **With its neighbours.** The curve over an edge may leave its chord sideways as fast as the
//! surface leaves the plane; the neighbour then covers what T does not. Let T′ be the triangle
//! beyond edge e, θ the angle between both planes, σ = 2 sin(θ/2). A point at height h over the
//! plane of T, outside e by g, is within |h| + σg of T′ if its projection lies in T′ turned into
//! the plane of T; |h| + σ max(0, g) is convex. Its
//! projection lies there where g is at most tan x times its distance along e from either end, x
//! being at most the angles of T′ at e and at most half of what the angles of T at e leave of π, so
//! that T and its three flaps are convex together ([`Deviation::slopes`]). For the other way take
//! the pieces of T and its neighbours, each projected on its own plane, and turn the latter into
//! the plane of T. Along the shared curve the two projections differ by at most |h| sin θ + g(1 −
//! cos θ), and a strip of straight lines joins them. The outer curves do not reach over T as long
//! as no curve crosses another edge of its own triangle, which is checked; so what is covered,
//! strips included, winds round each q in T, and the point that covers it is within |h|(1 + σ²/2) +
//! σg, h and g being those of T or of the neighbour. Where no strip covers q it is within |h|, or within the
//! neighbour's |h| + σg: so σ counts edge by edge, for the curve over the edge and what reaches over it
//! ([`Deviation::edge_heights`], [`Deviation::displacements`]), and the height inside counts as it is. For a point of a strip take g to be negative
//! inside e. Its curve point is within |h| of one end and, where it is outside T′ by g′ > 0, within
//! |h′| + σg′ of the other. Where it is inside both, no farther from it than e is, it is between
//! the two triangles or outside the angle between them, at the distance r from e with max(|h|,
//! |h′|) ≥ r cos(θ/2): 1/cos(θ/2) ≤ 1 + σ²/2 as long as σ² ≤ 2√3. Sharper folds, where both
//! triangles may reach beyond a surface that is near their planes, count on their own, as do edges
//! at the boundary of the mesh, sharp ones, and those whose other triangle does: its own bound
//! holds the distance of the curve from e.
//!
//! **Pieces at irregular vertices.** Let a piece be Ŝ + ρ with |ρ| ≤ R, both functions of the same
//! parameter. With Ŝ in place of S the above holds, except for gaps of Ŝ where two pieces meet: at
//! S(x) one ends at a(x), the other at b(x), both within R of S(x). So does the segment from a to
//! b, being in the ball; it is no higher than its ends, and filling the gaps with such segments
//! closes the cover again. Each point of Ŝ and of the fills has S within R: heights and own bounds
//! grow by R, tangential displacements and slopes do not. Three such Ŝ are taken.
//!
//! Inside the surface, at a vertex of valence k with the characteristic map χ ([`crate::patch::characteristic`]), the control
//! points are Pᵢ = p + t₁χᵢ₁ + t₂χᵢ₂ + rᵢ, p being the limit position and t₁, t₂ = (2/k) Σ cos(2πj/k) rⱼ, (2/k) Σ
//! sin(2πj/k) rⱼ the tangents. Weights of control points are at least 0 and their sum is 1, so Ŝ = p + t₁χ₁ + t₂χ₂ and
//! R = max |rᵢ|, which falls by about four from level to level. The five points beyond the ring are farthest away, but weigh no more than
//! w together: with A = max |rᵢ| of the others and B that of the five it is R = A + w max(0, B − A). Ŝ is an affine image, its hull points those of χ: a
//! cone at the vertex, so that slopes stay bounded there. (Any p and t would do.)
//!
//! At semi-sharp edges, Ŝ is the piece with infinitely sharp ones, and R its distance
//! (`infinitely_sharp_twin` in [`crate::patch`]). As its corners may be R from those of T, T counts as one
//! whose corners were moved ([`Deviation::off`]).
//!
//! Elsewhere Ŝ is the point of T nearest to S, and for curves the nearest of the edge: then R is
//! the own bound, there is no tangential displacement, and no slope. That holds for any piece, and
//! helps where slopes are too great. The own bound is then that of a sphere round a corner of T
//! that holds the control points.
//!
//! So the greatest of the least of both bounds over all triangles bounds the distance of mesh and surface, both
//! ways. θ and the neighbours' angles are those of the mesh as it is emitted.

use super::borders::{ALL, Borders};
use super::deviation::Deviation;
use super::effort::Effort;
use super::hull_points::{DeviationBound, HullPoint};
use super::net_part::NetPart;
use super::sampled::Samples;
use super::search::Search;
use super::sub_triangle::SubTriangle;
use super::triangle_frame::TriangleFrame;
use super::trilinear::{Trilinear, TrilinearFrame};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{Patch, RefinedPatch, Rules};
use crate::vector::DVec3;

/// A patch, parts of which several triangles approximate, and the data derived from it once for all
/// of them.
pub(crate) struct Pieces<'a> {
    patch: &'a Patch,
    /// Its refinement, if it exists already.
    known: Option<&'a RefinedPatch<'a>>,
    refined: Option<RefinedPatch<'a>>,
    net: Option<BezierTriangle>,
    samples: Option<Samples>,
}

impl<'a> Pieces<'a> {
    pub(crate) fn of(patch: &'a Patch) -> Self {
        Self {
            patch,
            known: None,
            refined: None,
            net: None,
            samples: None,
        }
    }

    /// The pieces of a patch with its refinement.
    pub(crate) fn with_refined(patch: &'a Patch, refined: &'a RefinedPatch<'a>) -> Self {
        Self {
            known: Some(refined),
            ..Self::of(patch)
        }
    }

    /// The patch itself.
    pub(crate) fn patch(&self) -> &'a Patch {
        self.patch
    }

    /// The patch refined once.
    pub(crate) fn refined(&mut self, rules: &'a Rules<'a>) -> &RefinedPatch<'a> {
        match self.known {
            Some(known) => known,
            None => self
                .refined
                .get_or_insert_with(|| self.patch.refined(rules)),
        }
    }

    /// The limits of the vertices down to `levels` levels below the patch, its corners left out.
    pub(crate) fn points(&mut self, levels: usize, rules: &'a Rules<'a>) -> Vec<DVec3> {
        let mut points = Vec::new();
        let refined = self.refined(rules);
        points.extend((0..3).map(|edge| refined.middle_as::<DVec3>(edge)));
        if levels > 1 {
            let parts = (0..4).map(|child| refined.part(child));
            points.extend(parts.flat_map(|part| Pieces::of(&part).points(levels - 1, rules)));
        }
        points
    }

    /// The deviation of `frame` and the part of the surface that it approximates: the frame's
    /// corner `i` belongs to the part's. Estimated from samples for schemes of no known family.
    pub(crate) fn deviation(
        &mut self,
        part: SubTriangle,
        frame: &TriangleFrame,
        rules: &'a Rules<'a>,
        effort: Effort,
    ) -> Deviation {
        if !frame.is_finite() {
            return Deviation::alone(f64::INFINITY);
        }
        if let Patch::Mesh(local) = self.patch {
            let samples = self
                .samples
                .get_or_insert_with(|| Samples::of(local, rules));
            return samples.deviation(part, &effort.bound::<DVec3>(frame));
        }
        match effort.seen_from(frame) {
            Some(frame) => self.searched::<Trilinear>(part, &frame, rules, effort),
            None => self.searched::<DVec3>(part, frame, rules, effort),
        }
    }

    fn searched<P: HullPoint>(
        &mut self,
        part: SubTriangle,
        frame: &P::Frame,
        rules: &'a Rules<'a>,
        effort: Effort,
    ) -> Deviation {
        let mut search = Search::<P>::of(effort.bound(frame), rules, effort);
        match (self.patch, part) {
            (_, SubTriangle::Child(child)) => {
                search.refined(self.refined(rules), (child, SubTriangle::Whole, ALL), 1);
            }
            (Patch::Regular(points), _) => {
                let net = self.net.get_or_insert_with(|| BezierTriangle::of(points));
                search.own_net(&NetPart::own(net, part));
            }
            (Patch::Extraordinary(_) | Patch::Bicubic(_) | Patch::Mesh(_), _) => {
                search.part(self.patch, part, ALL, 0);
            }
            (Patch::Sectors(_) | Patch::Pole(_) | Patch::SemiSharp(_) | Patch::Quad(_), _) => {
                if !search.is_settled(self.patch, part, ALL, 0) {
                    search.divided(self.refined(rules), part, ALL, 0);
                }
            }
        }
        search.found
    }
}

/// The deviation by the points of a triangle's own net, without halving it, and a height that the
/// piece attains.
pub(crate) fn at_a_glance(
    net: &BezierTriangle,
    frame: &TriangleFrame,
    open: [bool; 3],
) -> (Deviation, f64) {
    glance(net, ALL, frame, open)
}

fn glance(
    net: &BezierTriangle,
    borders: Borders,
    frame: &TriangleFrame,
    open: [bool; 3],
) -> (Deviation, f64) {
    fn of<P: HullPoint>(
        net: &BezierTriangle,
        borders: Borders,
        frame: &P::Frame,
        open: [bool; 3],
    ) -> (Deviation, f64) {
        let mut seen = BezierTriangle([P::default(); 15]);
        seen.0
            .iter_mut()
            .zip(&net.0)
            .for_each(|(seen, &point)| *seen = P::of(frame, point));
        DeviationBound::<P> {
            frame,
            open,
            rim_alone: false,
        }
        .net(&seen, borders)
    }
    let has_neighbours = open == [false; 3];
    match has_neighbours.then(|| TrilinearFrame::of(frame)).flatten() {
        Some(frame) => of::<Trilinear>(net, borders, &frame, open),
        None => of::<DVec3>(net, borders, frame, open),
    }
}

impl NetPart {
    /// The deviation by the points of the net, without halving it, and a height that the piece
    /// attains.
    pub(crate) fn at_a_glance(&self, frame: &TriangleFrame, open: [bool; 3]) -> (Deviation, f64) {
        glance(&self.net, self.borders, frame, open)
    }

    /// The deviation where the net is halved as often as it helps.
    pub(crate) fn deviation(
        &self,
        frame: &TriangleFrame,
        rules: &Rules<'_>,
        effort: Effort,
    ) -> Deviation {
        fn halved<P: HullPoint>(
            part: &NetPart,
            frame: &P::Frame,
            rules: &Rules<'_>,
            effort: Effort,
        ) -> Deviation {
            let mut search = Search::<P>::of(effort.bound(frame), rules, effort);
            search.own_net(part);
            search.found
        }
        if !frame.is_finite() {
            return Deviation::alone(f64::INFINITY);
        }
        match effort.seen_from(frame) {
            Some(frame) => halved::<Trilinear>(self, &frame, rules, effort),
            None => halved::<DVec3>(self, frame, rules, effort),
        }
    }
}

#[cfg(test)]
mod tests;
