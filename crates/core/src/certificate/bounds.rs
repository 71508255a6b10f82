//! The certificate of one triangle: how far it and a piece of the limit surface can be from each other.
//!
//! Let S be the limit surface over a domain triangle D and T the triangle that stands for it, its corners on those of S.
//! Hull points are points whose convex hull holds a piece of S or of one of its boundary curves: Bézier points of
//! regular pieces, images of the characteristic map's at irregular vertices. Functions that are convex are greatest over
//! the hull at one of its points. Two bounds are taken.
//!
//! **On its own** ([`Deviation::own`]). The distance to the convex set T is convex, so the hull points bound how far S is
//! from T. For the other way let δ bound the distances of the boundary curves to the edges that stand for them and h the
//! height of S over the plane of T. Every point q of T has a point of S within max(δ, h): project S on the plane. If the
//! projection covers q, there is one within h. If it doesn't, the projected boundary does not wind round q, while the
//! boundary of T does; deforming the one into the other, each point moving straight to its foot on its edge, must pass
//! over q. So q lies between some curve point's projection and its foot, and is at most as far from that curve point
//! as its foot is: δ. (A T without area is the union of its edges, for which the curves alone do.)
//!
//! **With its neighbours.** The curve over an edge may leave its chord sideways as fast as the surface leaves the
//! plane; the neighbour then covers what T does not. Let T′ be the triangle beyond edge e, θ the angle between both
//! planes, σ = 2 sin(θ/2). A point at height h over the plane of T, outside e by g, stands within |h| + σg of T′
//! if its foot lies in T′ turned into the plane of T ([`Deviation::height`], [`Deviation::drift`]); |h| + σ max(0, g)
//! is convex. Its foot does lie there where g is at most tan x times its distance along e from either end, x being
//! at most the angles of T′ at e and at most half of what the angles of T at e leave of π, so that T and its three
//! flaps are convex together ([`Deviation::slope`]). For the other way take the pieces of T and its neighbours, each
//! projected on its own plane, and turn the latter into the plane of T. Along the shared curve the two projections
//! differ by at most |h| sin θ + g(1 − cos θ), and a strip of straight lines joins them. The outer curves do not reach
//! over T as long as no curve crosses another edge of its own triangle, which is checked; so what is covered, strips
//! included, winds round each q in T, and the point that covers it stands within |h|(1 + σ²/2) + σg, h and g being
//! those of T or of the neighbour. For a point of a strip take g to be negative inside e. Its curve point is within |h|
//! of one end and, where it stands outside T′ by g′ > 0, within |h′| + σg′ of the other. Where it stands inside both, no
//! farther from it than e is, it stands between the two triangles or beside both, at the distance r from e with
//! max(|h|, |h′|) ≥ r cos(θ/2): 1/cos(θ/2) ≤ 1 + σ²/2 as long as σ² ≤ 2√3. Sharper folds, where both triangles may
//! reach beyond a surface that is near their planes, count on their own, as do edges at the boundary of the mesh, sharp
//! ones, and those whose other triangle does: its own bound holds the distance of the curve from e.
//!
//! **Pieces at irregular vertices.** Let a piece be Ŝ + ρ with |ρ| ≤ R, both functions of the same parameter. With Ŝ
//! in place of S the above holds as it stands, but for gaps of Ŝ where two pieces meet: at S(x) one ends at a(x), the
//! other at b(x), both within R of S(x). So does the segment from a to b, being in the ball; it is no higher than its
//! ends, and filling the gaps with such segments closes what is covered again. Each point of Ŝ and of the fills has S
//! within R: heights and own bounds grow by R, drifts and slopes do not. Three such Ŝ are taken.
//!
//! Inside the surface, at a vertex of valence k with the characteristic map χ ([`crate::patch::characteristic`]), the control
//! points are Pᵢ = p + t₁χᵢ₁ + t₂χᵢ₂ + rᵢ, p being the limit position and t₁, t₂ = (2/k) Σ cos(2πj/k) rⱼ, (2/k) Σ
//! sin(2πj/k) rⱼ the tangents. Weights of control points are at least 0 and their sum is 1, so Ŝ = p + t₁χ₁ + t₂χ₂ and
//! R = max |rᵢ|, which falls by about four from level to level. Ŝ is an affine image, its hull points those of χ: a
//! cone at the vertex, so that slopes stay bounded there. (Any p and t would do.)
//!
//! Beside sharp edges that fade, Ŝ is the piece where they last, and R how far that is away (`lasting_twin` in [`crate::patch`]). As its
//! corners may be R from those of T, T counts as one whose corners were moved ([`Deviation::off`]).
//!
//! Elsewhere Ŝ is the point of T nearest to S, and for curves the nearest of the edge: then R is the own bound, nothing
//! drifts, and there is no slope. That holds for any piece, and helps where slopes are too great. The own bound is then
//! that of a sphere round a corner of T that holds the control points.
//!
//! So the greatest of the least of both bounds over all triangles bounds the distance of mesh and surface, both
//! ways. θ and the neighbours' angles are those of the mesh as it is emitted.

mod irregular;

use super::borders::{ALL, Borders, INSIDE};
use super::deviation::Deviation;
use super::exceeds;
use super::hull_points::{DeviationBound, HullPoint};
use super::sampled::Samples;
use super::sub_triangle::SubTriangle;
use super::triangle_frame::TriangleFrame;
use super::trilinear::{Trilinear, TrilinearFrame};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::extraordinary::{ExtraordinaryPatch, RefinedExtraordinary};
use crate::patch::{Patch, Points, RefinedPatch, Rules};
use crate::vector::{Blend, DVec3};

/// Pieces that reach this many times as far as the target will not pass; bounds of others stay tight, so that they are
/// told apart even if they may not be split.
const HOPELESS: f64 = 1.5;

/// Halvings of a net for the bound of a curve: each takes little of the net along.
const RIM_HALVINGS: usize = 6;

/// When a bound is good enough, and how much may be done to get there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Distance below which a bound is good enough.
    pub(crate) target: f64,
    /// How often a regular piece may be halved.
    pub(crate) halvings: usize,
    /// Which edges have no neighbour.
    pub(crate) open: [bool; 3],
    /// Whether nothing counts but the curves over these.
    pub(crate) rim_alone: bool,
    /// Expected chord of the angles between the triangle and its neighbours.
    pub(crate) chord: f64,
    /// Expected greatest slopes, by edge.
    pub(crate) slopes: [f64; 3],
    /// Whether nobody asks how far off a triangle is that surely misses the target.
    pub(crate) gives_up: bool,
    /// Then the least chord of angles that can count, with slopes no greater than those expected: what is beyond the target with
    /// it is beyond it whatever is still to come.
    pub(crate) least_chord: Option<f64>,
}

impl Effort {
    /// For triangles of flat regions, of whose edges the open ones count alone.
    pub(crate) fn along_rim(target: f64, open: [bool; 3]) -> Self {
        let (chord, slopes) = (0.0, [0.0; 3]);
        Self {
            target,
            halvings: RIM_HALVINGS,
            open,
            rim_alone: true,
            chord,
            slopes,
            gives_up: false,
            least_chord: None,
        }
    }
}

impl Effort {
    fn bound<'f, P: HullPoint>(&self, frame: &'f P::Frame) -> DeviationBound<'f, P> {
        DeviationBound { frame, open: self.open, rim_alone: self.rim_alone }
    }

    /// The triangle's own frame, if points can be looked at from there.
    fn seen_from(&self, frame: &TriangleFrame) -> Option<TrilinearFrame> {
        let has_neighbours = !self.rim_alone && self.open == [false; 3];
        TrilinearFrame::of(frame).filter(|_| has_neighbours)
    }
}

/// A patch whose parts several triangles stand for, and what is derived from it once for all of them.
pub(crate) struct Pieces<'a> {
    patch: &'a Patch,
    /// Its refinement, where somebody has it already.
    known: Option<&'a RefinedPatch<'a>>,
    refined: Option<RefinedPatch<'a>>,
    net: Option<BezierTriangle>,
    samples: Option<Samples>,
}

/// Levels below a leaf whose vertices are sampled where nothing can be certified: over an evenly curved piece the greatest
/// height is met within 2 per cent.
const SAMPLED_LEVELS: usize = 3;

impl<'a> Pieces<'a> {
    pub(crate) fn of(patch: &'a Patch) -> Self {
        Self { patch, known: None, refined: None, net: None, samples: None }
    }

    /// The same for a patch with its refinement.
    pub(crate) fn with_refined(patch: &'a Patch, refined: &'a RefinedPatch<'a>) -> Self {
        Self { known: Some(refined), ..Self::of(patch) }
    }

    /// The patch itself.
    pub(crate) fn patch(&self) -> &'a Patch {
        self.patch
    }

    /// The patch refined once.
    pub(crate) fn refined(&mut self, rules: &'a Rules<'a>) -> &RefinedPatch<'a> {
        match self.known {
            Some(known) => known,
            None => self.refined.get_or_insert_with(|| self.patch.refined(rules)),
        }
    }

    /// The limits of the vertices down to so many levels below the patch, its corners left out.
    pub(crate) fn points(&mut self, levels: usize, rules: &'a Rules<'a>) -> Vec<DVec3> {
        let mut points = Vec::new();
        let refined = self.refined(rules);
        points.extend((0..3).map(|edge| refined.middle(edge).position));
        if levels > 1 {
            let parts = (0..4).map(|child| refined.part(child));
            points.extend(parts.flat_map(|part| Pieces::of(&part).points(levels - 1, rules)));
        }
        points
    }

    /// The deviation of `frame` and the part of the surface that it stands for: the frame's corner `i` belongs to the
    /// part's. Estimated from samples for schemes outside Loop's family.
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
            let samples = self.samples.get_or_insert_with(|| Samples::of(local, SAMPLED_LEVELS, rules));
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
                search.refined(self.refined(rules), child, SubTriangle::Whole, ALL, 1);
            }
            (Patch::Regular(points), _) => {
                let net = self.net.get_or_insert_with(|| BezierTriangle::of(points));
                search.own_net(&NetPart::own(net, part));
            }
            (Patch::Extraordinary(piece), _) => {
                let piece = search.seen(piece);
                search.extraordinary(&piece, part, ALL, 0);
            }
            (Patch::Sectors(_) | Patch::Pole(_) | Patch::SemiSharp(_) | Patch::Mesh(_), _) => {
                if !search.is_settled(self.patch, part, ALL, 0) {
                    search.divided(self.refined(rules), part, ALL, 0);
                }
            }
        }
        search.found
    }
}

/// The net of a part of a regular piece.
pub(crate) struct NetPart<V = DVec3> {
    net: BezierTriangle<V>,
    borders: Borders,
}

impl<V: Blend> NetPart<V> {
    /// A part of a piece with its net; one of a refinement is that part's own net.
    fn of(net: &BezierTriangle<V>, part: SubTriangle, borders: Borders) -> Self {
        match part {
            SubTriangle::Whole | SubTriangle::Child(_) => Self { net: *net, borders },
            SubTriangle::Half { edge, second } => Self { net: net.half(edge, second), borders },
            SubTriangle::Quarter { edge, at_end } => {
                let (net, borders) = quarter(net, edge, at_end, borders);
                Self { net, borders }
            }
        }
    }
}

impl NetPart {
    /// The part of a triangle's own piece.
    pub(crate) fn own(net: &BezierTriangle, part: SubTriangle) -> Self {
        Self::of(net, part, ALL)
    }

    /// The net, whose corners may stand in another order than the part's.
    pub(crate) fn net(&self) -> &BezierTriangle {
        &self.net
    }

    /// The deviation that the points of the net tell, without halving it, and a height that the piece attains.
    pub(crate) fn at_a_glance(&self, frame: &TriangleFrame, open: [bool; 3]) -> (Deviation, f64) {
        fn glance<P: HullPoint>(part: &NetPart, frame: &P::Frame, open: [bool; 3]) -> (Deviation, f64) {
            let bound = DeviationBound::<P> { frame, open, rim_alone: false };
            bound.net(&part.seen::<P>(frame), part.borders)
        }
        match TrilinearFrame::of(frame).filter(|_| open == [false; 3]) {
            Some(frame) => glance::<Trilinear>(self, &frame, open),
            None => glance::<DVec3>(self, frame, open),
        }
    }

    /// The deviation where the net is halved as often as it helps.
    pub(crate) fn deviation(&self, frame: &TriangleFrame, rules: &Rules<'_>, effort: Effort) -> Deviation {
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

    /// The net as the points of a bound.
    fn seen<P: HullPoint>(&self, frame: &P::Frame) -> BezierTriangle<P> {
        BezierTriangle(self.net.0.map(|point| P::of(frame, point)))
    }
}

/// A refined piece, whose parts a bound looks at as they are at hand.
trait Parts<P: HullPoint> {
    fn is_regular(&self, part: usize) -> bool;

    /// Looks at a part, or a part of that.
    fn look(
        &self,
        search: &mut Search<'_, P>,
        part: usize,
        of_part: SubTriangle,
        borders: Borders,
        depth: usize,
    );
}

impl<P: HullPoint> Parts<P> for RefinedPatch<'_> {
    fn is_regular(&self, part: usize) -> bool {
        self.is_regular(part)
    }

    fn look(
        &self,
        search: &mut Search<'_, P>,
        part: usize,
        of_part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        if let Some(points) = self.points(part) {
            search.regular_in_space(&points, of_part, borders);
        } else if let Some(piece) = self.extraordinary(part) {
            let piece = search.seen(&piece);
            search.extraordinary(&piece, of_part, borders, depth);
        } else {
            search.part(&self.part(part), of_part, borders, depth);
        }
    }
}

impl<P: HullPoint> Parts<P> for RefinedExtraordinary<P> {
    fn is_regular(&self, part: usize) -> bool {
        self.is_regular(part)
    }

    fn look(
        &self,
        search: &mut Search<'_, P>,
        part: usize,
        of_part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        match self.points(part) {
            Some(points) => search.regular(&points, of_part, borders),
            None => search.extraordinary(self.own(), of_part, borders, depth),
        }
    }
}

/// The bound of one triangle as it grows, piece by piece.
struct Search<'a, P: HullPoint> {
    bound: DeviationBound<'a, P>,
    rules: &'a Rules<'a>,
    effort: Effort,
    found: Deviation,
}

impl<'a, P: HullPoint> Search<'a, P> {
    fn of(bound: DeviationBound<'a, P>, rules: &'a Rules<'a>, effort: Effort) -> Self {
        Self { bound, rules, effort, found: Deviation::default() }
    }

    /// A piece as it is seen.
    fn seen(&self, piece: &ExtraordinaryPatch) -> ExtraordinaryPatch<P> {
        piece.map(|point| P::of(self.bound.frame, point))
    }

    /// The net of a piece, or of a part of one.
    fn own_net(&mut self, part: &NetPart) {
        self.net(&part.seen(self.bound.frame), part.borders, self.effort.halvings);
    }

    fn part(&mut self, patch: &Patch, part: SubTriangle, borders: Borders, depth: usize) {
        match (patch, part) {
            (_, SubTriangle::Child(child)) => {
                self.refined(&patch.refined(self.rules), child, SubTriangle::Whole, borders, depth + 1);
            }
            (Patch::Regular(points), _) => self.regular_in_space(points, part, borders),
            (Patch::Extraordinary(piece), _) => {
                let piece = self.seen(piece);
                self.extraordinary(&piece, part, borders, depth);
            }
            (Patch::Sectors(_) | Patch::Pole(_) | Patch::SemiSharp(_), _) => {
                if !self.is_settled(patch, part, borders, depth) {
                    self.divided(&patch.refined(self.rules), part, borders, depth);
                }
            }
            // Their points' hull holds nothing.
            (Patch::Mesh(_), _) => self.add(Deviation::alone(f64::INFINITY)),
        }
    }

    /// A part of a refinement, or a part of that: as it is at hand.
    fn refined(
        &mut self,
        refined: &impl Parts<P>,
        child: usize,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        if !self.counts(borders) {
            return;
        }
        refined.look(self, child, part, borders, depth);
    }

    fn regular_in_space(&mut self, points: &Points, part: SubTriangle, borders: Borders) {
        let mut seen = [P::default(); 12];
        seen.iter_mut().zip(points).for_each(|(seen, &point)| *seen = P::of(self.bound.frame, point));
        self.regular(&seen, part, borders);
    }

    fn regular(&mut self, points: &[P; 12], part: SubTriangle, borders: Borders) {
        let net = BezierTriangle::of(points);
        let halvings = self.effort.halvings;
        match part {
            SubTriangle::Whole | SubTriangle::Child(_) => self.net(&net, borders, halvings),
            _ => {
                let part = NetPart::of(&net, part, borders);
                self.net(&part.net, part.borders, halvings);
            }
        }
    }

    /// What a deviation comes to.
    fn value(&self, deviation: &Deviation) -> f64 {
        deviation.bound(self.effort.chord, self.effort.slopes)
    }

    /// The value that is good enough for what is left: less than what stands already adds nothing.
    fn aim(&self) -> f64 {
        self.effort.target.max(self.value(&self.found))
    }

    fn add(&mut self, deviation: Deviation) {
        // A slope that is too great must not spoil what others are good for.
        let counts = deviation.is_within(self.effort.slopes);
        self.found = self.found.max(if counts { deviation } else { Deviation::alone(deviation.own) });
        if let Some(chord) = self.effort.least_chord
            && exceeds(self.found.bound(chord, self.effort.slopes), self.effort.target)
        {
            self.found = Deviation::alone(f64::INFINITY);
        }
    }

    /// Whether a piece with these borders adds anything.
    fn counts(&self, borders: Borders) -> bool {
        let is_rim = |border: u8| border != INSIDE && self.effort.open[border as usize];
        !self.effort.rim_alone || borders.into_iter().any(is_rim)
    }

    fn net(&mut self, net: &BezierTriangle<P>, borders: Borders, halvings: usize) {
        if self.found.own == f64::INFINITY || !self.counts(borders) {
            return;
        }
        let (deviation, attained) = self.bound.net(net, borders);
        if self.effort.gives_up && exceeds(attained, self.effort.target) {
            self.add(Deviation::alone(f64::INFINITY));
            return;
        }
        // What is much too far away for sure stays so however it is divided.
        let is_hopeless = self.effort.target > 0.0 && attained > HOPELESS * self.effort.target;
        if halvings == 0 || is_hopeless || self.value(&deviation) <= self.aim() {
            self.add(deviation);
            return;
        }
        // The longest edge, so that the pieces stay as round as they can be.
        let [a, b, c] = net.corners();
        let lengths = [b - a, c - b, a - c].map(|side| side.length_squared(self.bound.frame));
        let edge =
            (1..3).fold(0, |longest, edge| if lengths[edge] > lengths[longest] { edge } else { longest });
        let halves = net.halves(edge);
        for (half, cut) in halves.iter().zip([(edge + 1) % 3, (edge + 2) % 3]) {
            let mut sides = borders;
            sides[cut] = INSIDE;
            self.net(half, sides, halvings - 1);
        }
    }

    /// A refined piece.
    fn divided(&mut self, refined: &impl Parts<P>, part: SubTriangle, borders: Borders, depth: usize) {
        match part {
            SubTriangle::Whole => {
                let inner = |part: usize| {
                    let mut sides = borders;
                    sides[(part + 1) % 3] = INSIDE;
                    (part, SubTriangle::Whole, sides)
                };
                self.pieces(
                    refined,
                    [inner(0), inner(1), inner(2), (3, SubTriangle::Whole, [INSIDE; 3])],
                    depth,
                );
            }
            SubTriangle::Child(child) => self.pieces(refined, [(child, SubTriangle::Whole, borders)], depth),
            SubTriangle::Half { edge, second } => self.half(refined, edge, second, borders, depth),
            SubTriangle::Quarter { edge, at_end } => self.quarter(refined, edge, at_end, borders, depth),
        }
    }

    /// The pieces that make up a half; see [`SubTriangle::Half`].
    fn half(&mut self, refined: &impl Parts<P>, edge: usize, second: bool, borders: Borders, depth: usize) {
        let (next, last) = ((edge + 1) % 3, (edge + 2) % 3);
        let half = SubTriangle::Half { edge, second };
        let other = SubTriangle::Half { edge, second: !second };
        let (mut whole, mut middle, mut tip) = ([INSIDE; 3], [INSIDE; 3], [INSIDE; 3]);
        (tip[next], tip[last]) = (borders[next], borders[last]);
        whole[edge] = borders[edge];
        let kept = if second {
            whole[next] = borders[next];
            middle[next] = borders[last];
            next
        } else {
            whole[last] = borders[last];
            middle[last] = borders[next];
            edge
        };
        self.pieces(
            refined,
            [(3, other, middle), (kept, SubTriangle::Whole, whole), (last, half, tip)],
            depth,
        );
    }

    /// The pieces that make up a quarter; see [`SubTriangle::Quarter`].
    fn quarter(
        &mut self,
        refined: &impl Parts<P>,
        edge: usize,
        at_end: bool,
        borders: Borders,
        depth: usize,
    ) {
        let (end, tip) = ((edge + 1) % 3, (edge + 2) % 3);
        let (mut corner, mut middle) = ([INSIDE; 3], [INSIDE; 3]);
        let (at, cut) = if at_end {
            (corner[edge], corner[end]) = (borders[2], borders[0]);
            (middle[edge], middle[end]) = (borders[1], borders[2]);
            (end, tip)
        } else {
            (corner[tip], corner[edge]) = (borders[2], borders[0]);
            (middle[tip], middle[edge]) = (borders[0], borders[1]);
            (edge, end)
        };
        let own = (at, SubTriangle::Half { edge: cut, second: !at_end }, corner);
        self.pieces(refined, [(3, SubTriangle::Half { edge: cut, second: at_end }, middle), own], depth);
    }

    /// Pieces of the parts of a refinement: the regular ones first, so that little is left to do for the others.
    fn pieces<const N: usize>(
        &mut self,
        refined: &impl Parts<P>,
        pieces: [(usize, SubTriangle, Borders); N],
        depth: usize,
    ) {
        for regular in [true, false] {
            for (child, part, borders) in pieces {
                if refined.is_regular(child) == regular {
                    self.refined(refined, child, part, borders, depth + 1);
                }
            }
        }
    }
}

/// The net of a quarter, and its borders in the order of the net's edges.
fn quarter<V: Blend>(
    net: &BezierTriangle<V>,
    edge: usize,
    at_end: bool,
    borders: Borders,
) -> (BezierTriangle<V>, Borders) {
    let (end, tip) = ((edge + 1) % 3, (edge + 2) % 3);
    // Away from the other end first, then away from the corner opposite.
    let (quarter, order) = if at_end {
        (net.half(tip, false).half(end, false), [end, tip, edge])
    } else {
        (net.half(end, true).half(tip, true), [edge, end, tip])
    };
    let mut turned = borders;
    order.into_iter().zip(borders).for_each(|(at, border)| turned[at] = border);
    (quarter, turned)
}

#[cfg(test)]
mod tests;
