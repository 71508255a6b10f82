//! The certificate of one triangle: how far it and a piece of the limit surface can be from each other.
//!
//! Let S be the limit surface over a domain triangle D and T the triangle that stands for it, its corners on those of S.
//! Hull points are points whose convex hull holds a piece of S or of one of its boundary curves: Bézier points of
//! regular pieces, control points of small ones at irregular vertices. Functions that are convex are greatest over the
//! hull at one of its points. Two bounds are taken.
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
//! So the greatest of the least of both bounds over all triangles bounds the distance of mesh and surface, both
//! ways. θ and the neighbours' angles are those of the mesh as it is emitted.

use super::facet::Facet;
use super::gauge::{Borders, Deviation, Gauge, INSIDE};
use super::net::Net;
use super::patch::{Patch, RefinedPatch};
use super::rules::Rules;

/// Levels that a piece at an irregular vertex is split at most: it has shrunk by 2⁻⁴⁰ then, below rounding.
const DEEPEST: usize = 40;

/// The whole piece stands for the triangle.
const ALL: Borders = [0, 1, 2];

/// Part of a patch's domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// All of it.
    Whole,
    /// One side of the line from the middle of the edge from corner `edge` to the corner opposite: that of the edge's
    /// start, or of its end. Corners keep their places, the middle takes that of the other end.
    Half {
        /// Number of the edge.
        edge: usize,
        /// The side of the edge's end.
        second: bool,
    },
    /// One of the four parts of a refinement.
    Child(usize),
    /// The quarter between an edge's end, the middle of the next edge and the middle of the edge before.
    Quarter {
        /// The edge, from this corner to the next one.
        edge: usize,
        /// At the edge's end rather than at its start. Corners: the end, the middle of the next edge, the middle
        /// of the edge before.
        at_end: bool,
    },
}

/// When a bound is good enough, and how much may be done to get there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Distance below which a bound is good enough.
    pub(crate) target: f64,
    /// How often a regular piece may be halved.
    pub(crate) halvings: usize,
    /// Which edges have no neighbour.
    pub(crate) open: [bool; 3],
    /// Expected chord of the angles between the triangle and its neighbours.
    pub(crate) chord: f64,
    /// Expected greatest slope.
    pub(crate) slope: f64,
}

/// A patch whose parts several triangles stand for, and what is derived from it once for all of them.
pub(crate) struct Pieces<'a> {
    patch: &'a Patch,
    refined: Option<RefinedPatch<'a>>,
    net: Option<Net>,
}

impl<'a> Pieces<'a> {
    pub(crate) fn of(patch: &'a Patch) -> Self {
        Self { patch, refined: None, net: None }
    }

    /// The patch refined once.
    pub(crate) fn refined(&mut self, rules: &Rules<'_>) -> &RefinedPatch<'a> {
        self.refined.get_or_insert_with(|| self.patch.refined(rules))
    }

    /// The deviation of `facet` and the part of the surface that it stands for: the facet's corner `i` belongs to the
    /// part's.
    pub(crate) fn deviation(
        &mut self,
        part: Part,
        facet: &Facet,
        rules: &Rules<'_>,
        effort: Effort,
    ) -> Deviation {
        let gauge = Gauge { facet, open: effort.open };
        let mut bound = Bound { gauge, rules, effort, found: Deviation::default() };
        match (self.patch, part) {
            (_, Part::Child(child)) => {
                let refined = self.refined.get_or_insert_with(|| self.patch.refined(rules));
                bound.part(&refined.part(child), Part::Whole, ALL, 1);
            }
            (Patch::Regular(points), _) => {
                let net = self.net.get_or_insert_with(|| Net::of(points));
                bound.net_part(net, part, ALL);
            }
            (Patch::Irregular(_), _) => bound.irregular(self.patch, part, ALL, 0),
        }
        bound.found
    }
}

struct Bound<'a> {
    gauge: Gauge<'a>,
    rules: &'a Rules<'a>,
    effort: Effort,
    found: Deviation,
}

impl Bound<'_> {
    fn part(&mut self, patch: &Patch, part: Part, borders: Borders, depth: usize) {
        match (patch, part) {
            (_, Part::Child(child)) => {
                self.part(&patch.refined(self.rules).part(child), Part::Whole, borders, depth + 1);
            }
            (Patch::Regular(points), _) => self.net_part(&Net::of(points), part, borders),
            (Patch::Irregular(_), _) => self.irregular(patch, part, borders, depth),
        }
    }

    fn net_part(&mut self, net: &Net, part: Part, borders: Borders) {
        let halvings = self.effort.halvings;
        match part {
            Part::Half { edge, second } => self.net(&net.half(edge, second), borders, halvings),
            Part::Quarter { edge, at_end } => {
                let (quarter, borders) = quarter(net, edge, at_end, borders);
                self.net(&quarter, borders, halvings);
            }
            Part::Whole | Part::Child(_) => self.net(net, borders, halvings),
        }
    }

    fn is_enough(&self, deviation: &Deviation) -> bool {
        deviation.bound(self.effort.chord, self.effort.slope) <= self.effort.target
    }

    fn net(&mut self, net: &Net, borders: Borders, halvings: usize) {
        let (deviation, attained) = self.gauge.net(net, borders);
        // What is too far away for sure stays so however it is divided.
        if halvings == 0 || attained > self.effort.target || self.is_enough(&deviation) {
            self.found = self.found.max(deviation);
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

    /// The greatest distance over the control points of a piece.
    fn hull(&self, patch: &Patch, borders: Borders) -> f64 {
        let mut greatest = 0.0f64;
        patch.for_each_hull_point(|point| {
            greatest = greatest.max(self.gauge.facet.squared(point));
            for border in borders.into_iter().filter(|&border| border != INSIDE) {
                greatest = greatest.max(self.gauge.facet.squared_to_edge(border as usize, point));
            }
        });
        greatest.sqrt()
    }

    fn irregular(&mut self, patch: &Patch, part: Part, borders: Borders, depth: usize) {
        let hull = self.hull(patch, borders);
        // Less than what stands already adds nothing.
        if hull <= self.effort.target.max(self.found.height) || depth >= DEEPEST {
            let found = Deviation { own: hull, height: hull, ..Deviation::default() };
            self.found = self.found.max(found);
            return;
        }
        let refined = patch.refined(self.rules);
        match part {
            Part::Half { edge, second } => self.half(&refined, edge, second, borders, depth),
            Part::Quarter { edge, at_end } => self.quarter(&refined, edge, at_end, borders, depth),
            Part::Whole | Part::Child(_) => {
                let corners = [0, 1, 2].map(|corner| {
                    let mut sides = borders;
                    sides[(corner + 1) % 3] = INSIDE;
                    (corner, Part::Whole, sides)
                });
                let middle = (3, Part::Whole, [INSIDE; 3]);
                self.pieces(&refined, [middle, corners[0], corners[1], corners[2]], depth);
            }
        }
    }

    /// The pieces that make up a half; see [`Part::Half`].
    fn half(
        &mut self,
        refined: &RefinedPatch<'_>,
        edge: usize,
        second: bool,
        borders: Borders,
        depth: usize,
    ) {
        let (next, last) = ((edge + 1) % 3, (edge + 2) % 3);
        let half = Part::Half { edge, second };
        let other = Part::Half { edge, second: !second };
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
        self.pieces(refined, [(3, other, middle), (kept, Part::Whole, whole), (last, half, tip)], depth);
    }

    /// The pieces that make up a quarter; see [`Part::Quarter`].
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
        let own = (at, Part::Half { edge: cut, second: !at_end }, corner);
        self.pieces(refined, [(3, Part::Half { edge: cut, second: at_end }, middle), own], depth);
    }

    /// Pieces of the parts of a refinement: the regular ones first, so that little is left to do for the others.
    fn pieces<const N: usize>(
        &mut self,
        refined: &RefinedPatch<'_>,
        pieces: [(usize, Part, Borders); N],
        depth: usize,
    ) {
        let patches = pieces.map(|(child, ..)| refined.part(child));
        for regular in [true, false] {
            for (patch, (_, part, borders)) in patches.iter().zip(pieces) {
                if matches!(patch, Patch::Regular(_)) == regular {
                    self.part(patch, part, borders, depth + 1);
                }
            }
        }
    }
}

/// The net of a quarter, and its borders in the order of the net's edges.
fn quarter(net: &Net, edge: usize, at_end: bool, borders: Borders) -> (Net, Borders) {
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
