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
//! differ by at most |h| sin θ + g(1 − cos θ). The outer curves do not reach over T as long as no curve crosses
//! another edge of its own triangle, which is checked; so what is covered winds round each q in T, and the point
//! that covers it stands within |h|(1 + σ²/2) + σg, h and g being those of T or of the neighbour. Edges at the boundary
//! of the mesh have no neighbour and count on their own.
//!
//! So the greatest of the least of both bounds over all triangles bounds the distance of mesh and surface, both
//! ways. θ and the neighbours' angles are those of the mesh as it is emitted.

use super::facet::{Beside, Facet};
use super::net::{EDGES, INNER, Net};
use super::patch::{Patch, RefinedPatch};
use super::rules::Rules;
use crate::vector::DVec3;

/// Levels that a piece at an irregular vertex is split at most: it has shrunk by 2⁻⁴⁰ then, below rounding.
const DEEPEST: usize = 40;

/// For each edge of a piece the edge of the triangle that it is part of, or [`INSIDE`].
type Borders = [u8; 3];

/// The edge lies inside the triangle's piece of surface.
const INSIDE: u8 = 3;

/// The whole piece stands for the triangle.
const ALL: Borders = [0, 1, 2];

/// How far a triangle and its piece of the surface can be from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Deviation {
    /// The bound that needs no neighbours.
    pub(crate) own: f64,
    /// The greatest height over the triangle's plane, and distance to edges without a neighbour.
    pub(crate) height: f64,
    /// How far pieces reach over edges with a neighbour.
    pub(crate) drift: f64,
    /// The greatest ratio of that to the distance from the edge's ends.
    pub(crate) slope: f64,
}

impl Deviation {
    /// The greater of each.
    pub(crate) fn max(self, other: Self) -> Self {
        Self {
            own: self.own.max(other.own),
            height: self.height.max(other.height),
            drift: self.drift.max(other.drift),
            slope: self.slope.max(other.slope),
        }
    }

    /// The bound where the neighbours' planes are turned by angles with this chord (2 sin(θ/2)) at most, and `slope`
    /// is the greatest that is allowed.
    #[inline]
    pub(crate) fn bound(&self, chord: f64, slope: f64) -> f64 {
        if self.slope <= slope {
            self.own.min(self.height * (1.0 + 0.5 * chord * chord) + chord * self.drift)
        } else {
            self.own
        }
    }
}

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

/// The deviation of `facet` and the part of the surface that it stands for: the facet's corner `i` belongs to the part's.
pub(crate) fn deviation(
    patch: &Patch,
    part: Part,
    facet: &Facet,
    rules: &Rules<'_>,
    effort: Effort,
) -> Deviation {
    let mut bound = Bound { facet, rules, effort, found: Deviation::default() };
    bound.part(patch, part, ALL, 0);
    bound.found
}

struct Bound<'a> {
    facet: &'a Facet,
    rules: &'a Rules<'a>,
    effort: Effort,
    found: Deviation,
}

impl Bound<'_> {
    fn part(&mut self, patch: &Patch, part: Part, borders: Borders, depth: usize) {
        let halvings = self.effort.halvings;
        match (patch, part) {
            (Patch::Regular(points), Part::Whole) => self.net(&Net::of(points), borders, halvings),
            (Patch::Regular(points), Part::Half { edge, second }) => {
                let half = Net::of(points).halves(edge)[usize::from(second)];
                self.net(&half, borders, halvings);
            }
            (Patch::Regular(points), Part::Quarter { edge, at_end }) => {
                let (quarter, borders) = quarter(&Net::of(points), edge, at_end, borders);
                self.net(&quarter, borders, halvings);
            }
            (_, Part::Child(child)) => {
                self.part(&patch.refined(self.rules).part(child), Part::Whole, borders, depth + 1);
            }
            (Patch::Irregular(_), _) => self.irregular(patch, part, borders, depth),
        }
    }

    /// The deviation of a net's points.
    fn of_net(&self, net: &Net, borders: Borders) -> Deviation {
        let mut deviation = Deviation::default();
        for at in INNER {
            self.inner_point(net.0[at], &mut deviation);
        }
        for (edge, points) in EDGES.iter().enumerate() {
            let border = borders[edge] as usize;
            if border == INSIDE as usize {
                points[1..4].iter().for_each(|&at| self.inner_point(net.0[at], &mut deviation));
            } else {
                points[1..4].iter().for_each(|&at| self.curve_point(border, net.0[at], &mut deviation));
            }
            // Corners between two edges of the triangle are its own; others belong to one edge or to none.
            let [before, border] = [borders[(edge + 2) % 3], borders[edge]];
            match (before, border) {
                (INSIDE, INSIDE) => self.inner_point(net.0[points[0]], &mut deviation),
                (INSIDE, on) | (on, INSIDE) => {
                    self.curve_point(on as usize, net.0[points[0]], &mut deviation)
                }
                (last, next) if last == next => {
                    self.curve_point(next as usize, net.0[points[0]], &mut deviation)
                }
                _ => {}
            }
        }
        deviation
    }

    /// A hull point of the surface.
    #[inline]
    fn inner_point(&self, point: DVec3, deviation: &mut Deviation) {
        if self.facet.is_flat() {
            self.found_alone(self.facet.squared(point).sqrt(), deviation);
            return;
        }
        let height = self.facet.height(point).abs();
        let mut own = height;
        let mut alone = height;
        for edge in 0..3 {
            let beside = self.facet.beside(edge, point);
            if beside.outside > 0.0 {
                own = f64::INFINITY;
                if self.effort.open[edge] {
                    alone = alone.max(height.hypot(beside.outside));
                } else {
                    self.drifted(edge, beside, deviation);
                }
            }
        }
        if own.is_infinite() {
            own = self.facet.squared(point).sqrt();
            if alone > height {
                alone = alone.max(own);
            }
        }
        deviation.own = deviation.own.max(own);
        deviation.height = deviation.height.max(alone);
    }

    /// A hull point of the curve over an edge of the triangle.
    #[inline]
    fn curve_point(&self, edge: usize, point: DVec3, deviation: &mut Deviation) {
        let own = self.facet.squared_to_edge(edge, point).sqrt();
        if self.facet.is_flat() {
            self.found_alone(own, deviation);
            return;
        }
        deviation.own = deviation.own.max(own);
        if self.effort.open[edge] {
            deviation.height = deviation.height.max(own);
        } else {
            deviation.height = deviation.height.max(self.facet.height(point).abs());
            let beside = self.facet.beside(edge, point);
            if beside.outside > 0.0 {
                self.drifted(edge, beside, deviation);
            }
        }
        for other in [(edge + 1) % 3, (edge + 2) % 3] {
            if self.facet.beside(other, point).outside > 0.0 {
                deviation.slope = f64::INFINITY;
            }
        }
    }

    /// For a triangle that has no plane.
    fn found_alone(&self, distance: f64, deviation: &mut Deviation) {
        let slope = f64::INFINITY;
        *deviation = deviation.max(Deviation { own: distance, height: distance, slope, drift: 0.0 });
    }

    #[inline]
    fn drifted(&self, edge: usize, beside: Beside, deviation: &mut Deviation) {
        let room = beside.along.min(self.facet.length(edge) - beside.along);
        deviation.drift = deviation.drift.max(beside.outside);
        let slope = if room > 0.0 { beside.outside / room } else { f64::INFINITY };
        deviation.slope = deviation.slope.max(slope);
    }

    fn is_enough(&self, deviation: &Deviation) -> bool {
        deviation.bound(self.effort.chord, self.effort.slope) <= self.effort.target
    }

    fn net(&mut self, net: &Net, borders: Borders, halvings: usize) {
        let deviation = self.of_net(net, borders);
        if halvings == 0 || self.is_enough(&deviation) {
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
            greatest = greatest.max(self.facet.squared(point));
            for border in borders.into_iter().filter(|&border| border != INSIDE) {
                greatest = greatest.max(self.facet.squared_to_edge(border as usize, point));
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
        (net.halves(tip)[0].halves(end)[0], [end, tip, edge])
    } else {
        (net.halves(end)[1].halves(tip)[1], [edge, end, tip])
    };
    let mut turned = borders;
    order.into_iter().zip(borders).for_each(|(at, border)| turned[at] = border);
    (quarter, turned)
}
