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

use super::deviation::{Borders, Deviation, DeviationBound, INSIDE};
use super::exceeds;
use super::sampled::Samples;
use super::sub_triangle::SubTriangle;
use super::triangle_frame::TriangleFrame;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{Patch, RefinedPatch, Rules};
use crate::vector::DVec3;

/// Pieces that reach this many times as far as the target will not pass; bounds of others stay tight, so that they are
/// told apart even if they may not be split.
const HOPELESS: f64 = 1.5;

/// Halvings of a net for the bound of a curve: each takes little of the net along.
const RIM_HALVINGS: usize = 6;

/// The whole piece stands for the triangle.
const ALL: Borders = [0, 1, 2];

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
        let bound = DeviationBound { frame, open: effort.open, rim_alone: effort.rim_alone };
        let mut search = Search { bound, rules, effort, found: Deviation::default() };
        match (self.patch, part) {
            (Patch::Mesh(local), _) => {
                let samples = self.samples.get_or_insert_with(|| Samples::of(local, SAMPLED_LEVELS, rules));
                return samples.deviation(part, &bound);
            }
            (_, SubTriangle::Child(child)) => {
                search.refined(self.refined(rules), child, SubTriangle::Whole, ALL, 1);
            }
            (Patch::Regular(points), _) => {
                let net = self.net.get_or_insert_with(|| BezierTriangle::of(points));
                search.net_part(net, part, ALL);
            }
            (Patch::Sectors(_) | Patch::Extraordinary(_) | Patch::Pole(_) | Patch::SemiSharp(_), _) => {
                if !search.is_settled(self.patch, part, ALL, 0) {
                    search.divided(self.refined(rules), part, ALL, 0);
                }
            }
        }
        search.found
    }
}

/// The net of a part of a regular piece.
pub(crate) struct NetPart {
    net: BezierTriangle,
    borders: Borders,
}

impl NetPart {
    /// A part of a piece with its net; one of a refinement is that part's own net.
    fn of(net: &BezierTriangle, part: SubTriangle, borders: Borders) -> Self {
        match part {
            SubTriangle::Whole | SubTriangle::Child(_) => Self { net: *net, borders },
            SubTriangle::Half { edge, second } => Self { net: net.half(edge, second), borders },
            SubTriangle::Quarter { edge, at_end } => {
                let (net, borders) = quarter(net, edge, at_end, borders);
                Self { net, borders }
            }
        }
    }

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
        DeviationBound { frame, open, rim_alone: false }.net(&self.net, self.borders)
    }

    /// The deviation where the net is halved as often as it helps.
    pub(crate) fn deviation(&self, frame: &TriangleFrame, rules: &Rules<'_>, effort: Effort) -> Deviation {
        if !frame.is_finite() {
            return Deviation::alone(f64::INFINITY);
        }
        let bound = DeviationBound { frame, open: effort.open, rim_alone: effort.rim_alone };
        let mut search = Search { bound, rules, effort, found: Deviation::default() };
        search.net(&self.net, self.borders, effort.halvings);
        search.found
    }
}

/// The bound of one triangle as it grows, piece by piece.
struct Search<'a> {
    bound: DeviationBound<'a>,
    rules: &'a Rules<'a>,
    effort: Effort,
    found: Deviation,
}

impl Search<'_> {
    fn part(&mut self, patch: &Patch, part: SubTriangle, borders: Borders, depth: usize) {
        match (patch, part) {
            (_, SubTriangle::Child(child)) => {
                self.refined(&patch.refined(self.rules), child, SubTriangle::Whole, borders, depth + 1);
            }
            (Patch::Regular(points), _) => self.net_part(&BezierTriangle::of(points), part, borders),
            (Patch::Sectors(_) | Patch::Extraordinary(_) | Patch::Pole(_) | Patch::SemiSharp(_), _) => {
                self.irregular(patch, part, borders, depth);
            }
            // Their points' hull holds nothing.
            (Patch::Mesh(_), _) => self.add(Deviation::alone(f64::INFINITY)),
        }
    }

    /// A part of a refinement, or a part of that: as it is at hand.
    fn refined(
        &mut self,
        refined: &RefinedPatch<'_>,
        child: usize,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        if !self.counts(borders) {
            return;
        }
        if let Some(points) = refined.points(child) {
            self.net_part(&BezierTriangle::of(&points), part, borders);
        } else if let Some(piece) = refined.extraordinary(child) {
            if !self.is_settled_at(piece, part, borders, depth) {
                let refined = RefinedPatch::Extraordinary(piece.refined(self.rules.beta(piece.ring.len())));
                self.divided(&refined, part, borders, depth);
            }
        } else {
            self.part(&refined.part(child), part, borders, depth);
        }
    }

    fn net_part(&mut self, net: &BezierTriangle, part: SubTriangle, borders: Borders) {
        let halvings = self.effort.halvings;
        match part {
            SubTriangle::Whole | SubTriangle::Child(_) => self.net(net, borders, halvings),
            _ => {
                let part = NetPart::of(net, part, borders);
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

    fn net(&mut self, net: &BezierTriangle, borders: Borders, halvings: usize) {
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
        let lengths = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
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
    fn divided(&mut self, refined: &RefinedPatch<'_>, part: SubTriangle, borders: Borders, depth: usize) {
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
    fn half(
        &mut self,
        refined: &RefinedPatch<'_>,
        edge: usize,
        second: bool,
        borders: Borders,
        depth: usize,
    ) {
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
        refined: &RefinedPatch<'_>,
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
        refined: &RefinedPatch<'_>,
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
fn quarter(net: &BezierTriangle, edge: usize, at_end: bool, borders: Borders) -> (BezierTriangle, Borders) {
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
